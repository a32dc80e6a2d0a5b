// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_refinement.hpp"
#include "disparity_refinement.simd.hpp"
#include "map/disparity_refinement.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "../base/grey_levels.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(fillOccludedRow)

//! The number of columns, from the left border on, that are black
int countBlank(const ushort* grey, int width)
{
    const int black = 2 * greyScale; // at most, as JPEG leaves it
    return (int)(std::find_if(grey, grey + width, [=](ushort level) { return level > black; }) - grey);
}

HDP_DISPATCH(medianRow)
HDP_DISPATCH(isAnyNearer)
HDP_DISPATCH(visibilityRow)

/** Compares each disparity with the largest one that maps to the same column of the right image.
@param disparity CV_16SC1 or CV_16UC1 (T), in 1 / subpixelScale pixel.
@param maxDiff Largest difference, in pixels, of a visible pixel.
@param invalid Disparity of pixels that map to no column, or a value that none has.
@param visit Called with each row and the Visibility of its pixels, rows side by side. */
template <typename T, typename Visit>
void checkLeftRight(const Mat& disparity, int maxDiff, int invalid, const Visit& visit)
{
    const int largest = (int)std::min<int64>((int64)maxDiff * subpixelScale, INT_MAX);
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        std::vector<int> columns(disparity.cols), nearest(disparity.cols + 1);
        std::vector<uchar> visibility(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            dispatched::visibilityRow(disparity.ptr<T>(y), disparity.cols, invalid, largest, columns.data(),
                                      nearest.data(), visibility.data());
            visit(y, visibility.data());
        }
    });
}

//! Whether enough pixels around this one have its disparity
bool isInStructure(const Mat& disparity, int y, int x)
{
    const int radius = ThinStructures::window / 2, maxDifference = ThinStructures::maxDifference * subpixelScale;
    const Range rows(std::max(y - radius, 0), std::min(y + radius + 1, disparity.rows));
    const Range columns(std::max(x - radius, 0), std::min(x + radius + 1, disparity.cols));
    const int own = disparity.at<ushort>(y, x);
    int count = 0;
    for (int v = rows.start; v < rows.end; ++v)
    {
        const ushort* row = disparity.ptr<ushort>(v);
        for (int u = columns.start; u < columns.end; ++u)
            count += std::abs(row[u] - own) <= maxDifference;
    }
    return 100 * count >= ThinStructures::minShare * rows.size() * columns.size();
}

} // namespace

void medianDisparity(const Mat& disparity, int size, Mat& filtered)
{
    filtered.create(disparity.size(), CV_16U);
    parallel_for_(Range(0, disparity.rows), [&](const Range& range) {
        const int radius = size / 2, width = disparity.cols;
        Mat buffer(size, width + 2 * radius, CV_16S);
        std::vector<short*> sorted(size);
        std::vector<const ushort*> rows(size);
        for (int i = 0; i < size; ++i)
            sorted[i] = buffer.ptr<short>(i) + radius;
        for (int y = range.start; y < range.end; ++y)
        {
            for (int i = 0; i < size; ++i)
                rows[i] = disparity.ptr<ushort>(std::min(std::max(y + i - radius, 0), disparity.rows - 1));
            dispatched::medianRow(rows.data(), size, width, sorted.data(), filtered.ptr<ushort>(y));
        }
    });
}

void restoreThinStructures(const Mat& unfiltered, Mat& disparity)
{
    const int minDistance = ThinStructures::minDistance * subpixelScale;
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* before = unfiltered.ptr<ushort>(y);
            ushort* row = disparity.ptr<ushort>(y);
            for (int begin = 0; begin < disparity.cols; begin += ThinStructures::columns)
            {
                // Hardly a group of columns has any.
                const int end = std::min(begin + ThinStructures::columns, disparity.cols);
                if (!dispatched::isAnyNearer(before + begin, row + begin, end - begin))
                    continue;
                for (int x = begin; x < end; ++x)
                    if (before[x] - row[x] >= minDistance && isInStructure(unfiltered, y, x))
                        row[x] = before[x];
            }
        }
    });
}

void fillOccluded(Mat& disparity, const Mat& residual, const Mat& right)
{
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        OcclusionScratch scratch(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            const int blank = right.empty() ? 0 : countBlank(right.ptr<ushort>(y), right.cols);
            dispatched::fillOccludedRow(disparity.ptr<ushort>(y), residual.ptr(y), disparity.cols, blank, scratch);
        }
    });
}

void upsampleDisparity(const Mat& upper, Size size, Mat& disparity)
{
    disparity.create(size, CV_16U);
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const auto clampRow = [&](int row) { return std::min(std::max(row, 0), upper.rows - 1); };
            const ushort* own = upper.ptr<ushort>(clampRow(y / 2));
            const ushort* beside = upper.ptr<ushort>(clampRow(y % 2 ? y / 2 + 1 : y / 2 - 1));
            ushort* row = disparity.ptr<ushort>(y);
            const auto mean = [&](int x, int next) {
                const int d = own[x];
                const auto sameSurface = [&](int other) { return std::abs(other - d) <= subpixelScale ? other : d; };
                return (ushort)((9 * d + 3 * sameSurface(own[next]) + 3 * sameSurface(beside[x]) +
                                 sameSurface(beside[next]) + 4) /
                                8);
            };
            const int last = upper.cols - 1;
            HDP_VECTORIZED for (int x = 1; x < last; ++x)
            {
                row[2 * x] = mean(x, x - 1);
                row[2 * x + 1] = mean(x, x + 1);
            }
            row[0] = mean(0, 0);
            if (size.width > 1)
                row[1] = mean(0, std::min(1, last));
            for (int x = std::max(2 * last, 2); x < size.width; ++x) // a last odd column is that pixel's, too
                row[x] = mean(last, x % 2 ? last : x / 2 - 1);
        }
    });
}

void rejectOccluded(Mat& disparity, int maxDiff, short invalid)
{
    const auto reject = [&](int y, const uchar* visibility) {
        short* row = disparity.ptr<short>(y);
        for (int x = 0; x < disparity.cols; ++x)
            if (visibility[x] == OCCLUDED)
                row[x] = invalid;
    };
    checkLeftRight<short>(disparity, maxDiff, invalid, reject);
}

void findStable(const Mat& disparity, int maxDiff, Mat& stable)
{
    stable.create(disparity.size(), CV_8U);
    const auto mark = [&](int y, const uchar* visibility) {
        uchar* row = stable.ptr(y);
        const int width = stable.cols; // for vectors: bytes that are written could otherwise be those of the number
        HDP_VECTORIZED for (int x = 0; x < width; ++x) row[x] = visibility[x] == VISIBLE ? 255 : 0;
    };
    const int none = -1; // all are valid
    checkLeftRight<ushort>(disparity, maxDiff, none, mark);
}

}}} // namespace cv::stereo::hdp
