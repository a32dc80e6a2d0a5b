// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "census_cost.hpp"
#include "census_cost.simd.hpp"
#include "cost/census_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

// Bytes before and behind a row of the census that may be read; they mean nothing.
const int censusMargin = 16;

// Columns of a census row are computed in groups of this many, and rows from a copy of so many that stays in the
// caches.
const int censusColumns = 32, censusRows = 16;

HDP_DISPATCH(censusRow)
HDP_DISPATCH(censusCostOfRow)
HDP_DISPATCH(evaluateCensusCost)
HDP_DISPATCH(countTwoLayers)

//! From planes, censusRows of each and at last the grey levels, to the first rows of CensusCost::leftPixels()
void mergePlanes(const Mat& planes, int count, Mat pixels)
{
    Mat bytes[4];
    for (int k = 0; k < 4; ++k)
    {
        const int plane = k == CensusCost::greyByte ? count : std::min(k, count - 1); // what there is not means nothing
        bytes[k] = planes.rowRange(plane * censusRows, plane * censusRows + pixels.rows);
    }
    merge(bytes, 4, pixels);
}

} // namespace

void CensusCost::prepare(const Mat& left, const Mat& right, int numDisparities, int blockSize, int tolerance,
                         const PairMasks& masks)
{
    limits_.prepare(masks, numDisparities);
    width_ = left.cols;
    planes_ = blockSize / 2; // as the radius
    prepareImage(left, blockSize / 2, tolerance, false, 0);
    prepareImage(right, blockSize / 2, tolerance, true, numDisparities + costPadding);
    firstLeft_ = left_.ptr() + 4 * censusMargin;
    firstRight_ = right_.ptr() + censusMargin;
    leftStep_ = left_.step;
    rightStep_ = right_.step;
    planeStride_ = right_.step * left.rows;
}

void CensusCost::prepareImage(const Mat& image, int radius, int tolerance, bool isRight, int after)
{
    const int width = image.cols, rows = image.rows;
    const int cols = (int)alignSize(width, censusColumns); // what is computed past the width is overwritten or not read
    if (isRight)
        right_.create((planes_ + 1) * rows, censusMargin + std::max(width + after, cols) + censusMargin, CV_8U);
    else
        left_.create(rows, censusMargin + cols + censusMargin, CV_8UC4);
    parallel_for_(Range(0, (rows + censusRows - 1) / censusRows), [&](const Range& range) {
        Mat flipped, bordered;
        Mat leftPlanes(isRight ? 0 : (planes_ + 1) * censusRows, cols, CV_8U);
        for (int i = range.start; i < range.end; ++i)
        {
            const int first = i * censusRows, end = std::min(first + censusRows, rows);
            const int from = std::max(first - radius, 0), to = std::min(end + radius, rows);
            if (isRight)
                flip(image.rowRange(from, to), flipped, 1);
            copyMakeBorder(isRight ? flipped : image.rowRange(from, to), bordered, from - first + radius,
                           end + radius - to, radius, radius + cols - width, BORDER_REPLICATE | BORDER_ISOLATED);
            for (int y = first; y < end; ++y)
            {
                uchar* row = isRight ? right_.ptr(y) + censusMargin : leftPlanes.ptr(y - first);
                const size_t planeSize = isRight ? right_.step * rows : leftPlanes.step * censusRows;
                const short* grey = bordered.ptr<short>(y - first + radius) + radius; // all levels are below 32768
                dispatched::censusRow(radius, (short)tolerance, grey, (ptrdiff_t)bordered.step1(), isRight, cols, row,
                                      planeSize);
                for (int plane = 0; plane <= planes_ && isRight; ++plane, row += planeSize)
                {
                    std::fill(row - censusMargin, row, row[0]);
                    std::fill(row + width, row - censusMargin + right_.cols, row[width - 1]);
                }
            }
            if (!isRight)
                mergePlanes(leftPlanes, planes_, left_(Rect(censusMargin, first, cols, end - first)));
        }
    });
}

void CensusCost::evaluate(const int* pixels, int count, int first, int lanes, float* cost) const
{
    dispatched::evaluateCensusCost(*this, pixels, count, first, lanes, cost);
    limits_.apply(pixels, count, first, lanes, 1.f, 1, cost);
}

void CensusCost::evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const
{
    dispatched::evaluateCensusCost(*this, pixels, count, first, lanes, cost);
    limits_.apply(pixels, count, first, lanes, (uchar)1, 1, cost);
}

void CensusCost::ofDisparities(const Mat& disparity, Mat& costs) const
{
    costs.create(disparity.size(), CV_8U);
    parallelForRows(disparity.size(), [&](int y) {
        dispatched::censusCostOfRow(*this, y, disparity.ptr<ushort>(y), costs.ptr(y));
        limits_.apply(y, disparity.ptr<ushort>(y), costs.ptr(y));
    });
}

void TwoLayerCost::evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const
{
    if (below_)
    {
        CV_DbgAssert(first % 2 == 0);
        dispatched::countTwoLayers(own_, *below_, pixels, count, first, lanes, cost);
        own_.limits().apply(pixels, count, first, lanes, (uchar)scale, steps(), cost);
        return;
    }
    own_.evaluate(pixels, count, first, lanes, cost);
    const size_t size = (size_t)count * lanes;
    HDP_VECTORIZED for (size_t k = 0; k < size; ++k) cost[k] = (uchar)(scale * cost[k]);
}

}}} // namespace cv::stereo::hdp
