// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "map_filters.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! Squared slopes of a row of grey levels, borders replicated, in 1 / SlopeScale::perNoise^2 of the squared noise
void squareSlopes(const ushort* levels, int width, const SlopeScale& scale, ushort* squares);

/** Precisions of a row. It adds up the windows itself, as sumOverWindows() takes longer.
@param squares Rows of squareSlopes() one after the other, those of the window around the row in any order.
@param sums Memory of width + precisionSide elements.
@param disparity Of the row; USHRT_MAX has a precision of zero. */
void precisionRow(const ushort* squares, int width, ushort* sums, const ushort* disparity, ushort* precision);

//! A row of a pass of smoothSurfaces(). own, precision: in maps that go on as far as the pairs are away
void smoothRow(const ushort* own, const ushort* precision, int width, const SmoothingPairs& pairs, ushort* smoothed);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

CV_ALWAYS_INLINE ushort squaredSlope(ushort left, ushort right, const SlopeScale& scale)
{
    const ushort change = std::min(difference(left, right), scale.mostChange);
    const ushort slope = (ushort)((ushort)(change * scale.factor) >> 8);
    return (ushort)(slope * slope);
}

//! v[0] + v[step] + .. of the elements on one side of a window
CV_ALWAYS_INLINE ushort windowSum(const ushort* v, ptrdiff_t step)
{
    ushort sum = v[0];
    HDP_UNROLLED for (int k = 1; k < precisionSide; ++k) sum = (ushort)(sum + v[k * step]);
    return sum;
}

} // namespace

void squareSlopes(const ushort* levels, int width, const SlopeScale& scale, ushort* squares)
{
    const SlopeScale own = scale;
    squares[0] = squaredSlope(levels[0], levels[std::min(1, width - 1)], own);
    HDP_VECTORIZED for (int x = 1; x < width - 1; ++x) squares[x] = squaredSlope(levels[x - 1], levels[x + 1], own);
    squares[width - 1] = squaredSlope(levels[std::max(width - 2, 0)], levels[width - 1], own);
}

void precisionRow(const ushort* squares, int width, ushort* sums, const ushort* disparity, ushort* precision)
{
    const int radius = precisionSide / 2, unit = SlopeScale::perNoise * SlopeScale::perNoise;
    const ushort noise = precisionSide * precisionSide * unit / 2;
    ushort* const columns = sums + radius;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) columns[x] = windowSum(squares + x, width);
    std::fill_n(sums, radius, columns[0]);
    std::fill_n(columns + width, radius, columns[width - 1]);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const ushort slopes = (ushort)(std::max(windowSum(sums + x, 1), noise) - noise);
        const ushort own = std::max<ushort>((ushort)(slopes / unit), 1);
        precision[x] = disparity[x] == USHRT_MAX ? 0 : own;
    }
}

void smoothRow(const ushort* own, const ushort* precision, int width, const SmoothingPairs& pairs, ushort* smoothed)
{
    const ushort like = pairs.like;
    const ptrdiff_t step = pairs.step;
    ushort limits[SmoothingPairs::count];
    std::copy_n(pairs.limits, SmoothingPairs::count, limits);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const ushort base = (ushort)(own[x] - like); // what is less or more than 2 * like from it is another surface
        const ushort ownWeight = std::max<ushort>(precision[x], 1);
        ushort weights = 0, sum = (ushort)(like * ownWeight);
        HDP_UNROLLED for (int k = 0; k < SmoothingPairs::count; ++k)
        {
            const ptrdiff_t distance = step << k;
            const ushort before = (ushort)(own[x - distance] - base), after = (ushort)(own[x + distance] - base);
            const ushort weight = std::min(std::min(precision[x - distance], precision[x + distance]), limits[k]);
            const ushort counted = std::max(before, after) <= (ushort)(2 * like) ? weight : 0;
            weights = (ushort)(weights + counted);
            sum = (ushort)(sum + (ushort)(counted * (ushort)(before + after)));
        }
        const ushort all = (ushort)(ownWeight + 2 * weights);
        const ushort rounded = (ushort)(sum + all / 2);
        smoothed[x] = (ushort)(base + (int)((float)rounded / (float)all)); // exact: below 2^16
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
