// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "support_points.hpp"

#include "support_points.simd.hpp"
#include "paper/support_points.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef SupportPointGrid Grid;

// Parts of the grid that are matched as a whole: long runs of rows share their corners, and what is kept of few columns
// stays in the cache.
const int rowsAtOnce = 16, columnsAtOnce = 32;

HDP_DISPATCH(sobelGradients)
HDP_DISPATCH(matchPoints)
HDP_DISPATCH(keepSupported)

//! The gradients of an image, or of it mirrored
void prepareGradients(const Mat& grey, bool mirrored, Mat& horizontal, Mat& vertical)
{
    horizontal.create(grey.rows, grey.cols + Grid::lanes, CV_8U);
    vertical.create(horizontal.size(), CV_8U);
    parallel_for_(Range(1, std::max(grey.rows - 1, 1)), [&](const Range& rows) { // no descriptor reaches the others
        for (int y = rows.start; y < rows.end; ++y)
            dispatched::sobelGradients(grey.ptr(y - 1), grey.ptr(y), grey.ptr(y + 1), grey.cols, horizontal.ptr(y),
                                       vertical.ptr(y));
        if (mirrored)
            for (const Mat& gradients : { horizontal, vertical })
            {
                Mat image = gradients(rows, Range(0, grey.cols));
                flip(image, image, 1);
            }
    });
}

//! Matches all points that are far enough from the border.
void matchGrid(const GradientPair& gradients, int height, int numDisparities, Mat& matches)
{
    const int first = (Grid::margin + Grid::spacing - 1) / Grid::spacing;
    const int lastRow = (height - 1 - Grid::margin) / Grid::spacing;
    const int lastColumn = (gradients.width - 1 - Grid::margin) / Grid::spacing;
    if (std::min(height, gradients.width) <= 2 * Grid::margin || lastRow < first || lastColumn < first)
        return;
    const auto matchParts = [&](const Range& parts) {
        std::vector<short> buffer(Grid::bufferSize(columnsAtOnce, numDisparities));
        for (int part = parts.start; part < parts.end; ++part)
        {
            const int top = first + part * rowsAtOnce;
            const Range rows(top, std::min(top + rowsAtOnce, lastRow + 1));
            for (int left = first; left <= lastColumn; left += columnsAtOnce)
                dispatched::matchPoints(gradients, numDisparities, rows,
                                        Range(left, std::min(left + columnsAtOnce, lastColumn + 1)), buffer.data(),
                                        matches.ptr<short>() + Grid::neighbourhood, matches.step1());
        }
    };
    parallel_for_(Range(0, (lastRow - first) / rowsAtOnce + 1), matchParts);
}

} // namespace

void findSupportPoints(const Mat& left, const Mat& right, int numDisparities, SupportPointBuffers& buffers, Mat& points)
{
    const Mat images[] = { left, right };
    GradientPair gradients;
    for (int side = 0; side < 2; ++side)
    {
        if (left.channels() == 3)
            cvtColor(images[side], buffers.grey[side], COLOR_BGR2GRAY);
        prepareGradients(left.channels() == 3 ? buffers.grey[side] : images[side], side == 1, buffers.horizontal[side],
                         buffers.vertical[side]);
        gradients.horizontal[side] = buffers.horizontal[side].ptr();
        gradients.vertical[side] = buffers.vertical[side].ptr();
    }
    gradients.step = buffers.horizontal[0].step;
    gradients.width = left.cols;

    const int rows = (left.rows + Grid::spacing - 1) / Grid::spacing;
    const int cols = (left.cols + Grid::spacing - 1) / Grid::spacing;
    Mat& matches = buffers.matches;
    matches.create(rows, cols + 2 * Grid::neighbourhood, CV_16S);
    matches.setTo(Scalar::all(Grid::noMatch));
    matchGrid(gradients, left.rows, numDisparities, matches);

    points.create(rows, cols, CV_16S);
    parallel_for_(Range(0, rows), [&](const Range& range) {
        for (int y = range.start; y < range.end; ++y)
            dispatched::keepSupported(matches.ptr<short>(y) + Grid::neighbourhood, (ptrdiff_t)matches.step1(),
                                      std::min(y, +Grid::neighbourhood), std::min(rows - 1 - y, +Grid::neighbourhood),
                                      cols, points.ptr<short>(y));
    });
}

void disparityHistogram(const Mat& points, int numDisparities, std::vector<double>& histogram)
{
    histogram.assign(numDisparities, 0);
    bool found = false;
    for (int y = 0; y < points.rows; ++y)
        for (int x = 0; x < points.cols; ++x)
        {
            const int disparity = points.at<short>(y, x);
            if (disparity >= 0 && disparity < numDisparities)
            {
                ++histogram[disparity];
                found = true;
            }
        }
    if (!found)
        histogram.assign(numDisparities, 1);
}

}}} // namespace cv::stereo::hdp
