// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "census_cost.hpp"
#include "census_cost.simd.hpp"
#include "cost/census_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

// Bytes before and behind a row of the census that may be read; they mean nothing.
const int censusMargin = 16;

// Columns of a census row are computed in groups of this many, and rows from a copy of so many that stays in the
// caches.
const int censusColumns = 32, censusRows = 16;

HDP_DISPATCH(leftCensusRow)
HDP_DISPATCH(rightCensusRow)
HDP_DISPATCH(censusCostOfRow)
HDP_DISPATCH(evaluateCensusCost)
HDP_DISPATCH(countCensusCost)

} // namespace

void CensusCost::prepare(const Mat& left, const Mat& right, int numDisparities, int blockSize, int tolerance,
                         const PairMasks& masks)
{
    limits_.prepare(masks, numDisparities);
    planes_.width = left.cols;
    planes_.count = (blockSize * blockSize / 2 + 7) / 8;
    prepareImage(left, blockSize / 2, tolerance, false, 0);
    prepareImage(right, blockSize / 2, tolerance, true, numDisparities + costPadding);
    planes_.left = left_.ptr() + 4 * censusMargin;
    planes_.right = right_.ptr() + censusMargin;
    planes_.leftStep = left_.step;
    planes_.rightStep = right_.step;
    planes_.rightPlane = right_.step * left.rows;
}

void CensusCost::prepareImage(const Mat& image, int radius, int tolerance, bool isRight, int after)
{
    const int width = image.cols, planes = planes_.count, rows = image.rows;
    const int cols = (int)alignSize(width, censusColumns); // what is computed past the width is overwritten or not read
    if (isRight)
        right_.create((planes + 1) * rows, censusMargin + std::max(width + after, cols) + censusMargin, CV_8U);
    else
        left_.create(rows, censusMargin + cols + censusMargin, CV_8UC4);
    parallel_for_(Range(0, (rows + censusRows - 1) / censusRows), [&](const Range& range) {
        Mat bordered(censusRows + 2 * radius, cols + 2 * radius, CV_16S); // all levels are below 32768
        const CensusWindow window = { radius, tolerance, (ptrdiff_t)bordered.step1() };
        std::vector<uchar> leftPlanes(isRight ? 0 : 3 * cols);
        for (int i = range.start; i < range.end; ++i)
        {
            const int first = i * censusRows, end = std::min(first + censusRows, rows);
            copyBordered(image, 0, first - radius, radius, radius + cols - width, isRight,
                         bordered.rowRange(0, end - first + 2 * radius));
            for (int y = first; y < end; ++y)
            {
                const short* grey = bordered.ptr<short>(y - first + radius) + radius;
                if (!isRight)
                {
                    dispatched::leftCensusRow(window, grey, cols, leftPlanes.data(), left_.ptr(y) + 4 * censusMargin);
                    continue;
                }
                dispatched::rightCensusRow(window, grey, cols, right_.ptr(y) + censusMargin, right_.step * rows);
                for (int plane = 0; plane <= planes; ++plane)
                {
                    uchar* row = right_.ptr(plane * rows + y) + censusMargin;
                    std::fill(row - censusMargin, row, row[0]);
                    std::fill(row + width, right_.ptr(plane * rows + y) + right_.cols, row[width - 1]);
                }
            }
        }
    });
}

void CensusCost::evaluate(const int* pixels, int count, int first, int lanes, float* cost) const
{
    dispatched::evaluateCensusCost(planes_, pixels, count, first, lanes, cost);
    limits_.apply(pixels, count, first, lanes, 1.f, 1, cost);
}

void CensusCost::evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const
{
    dispatched::countCensusCost(planes_, pixels, count, first, lanes, cost);
    limits_.apply(pixels, count, first, lanes, (uchar)1, 1, cost);
}

void CensusCost::ofDisparities(const Mat& disparity, Mat& costs) const
{
    costs.create(disparity.size(), CV_8U);
    parallelFor(disparity.rows, [&](int y) {
        dispatched::censusCostOfRow(planes_, y, disparity.ptr<ushort>(y), costs.ptr(y));
        limits_.apply(y, disparity.ptr<ushort>(y), costs.ptr(y));
    });
}

}}} // namespace cv::stereo::hdp
