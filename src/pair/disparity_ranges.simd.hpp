// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "disparity_ranges.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

// Rows of so many pixels. Of intervals each pixel has two numbers, the first and the last one.

/** Limits in 1 / subpixelScale pixel.
@param limitOfAll In pixels: none is beyond it, and what is no number is as far.
@param isWhole Whether limits are whole pixels. */
void toUnits(const float* limits, int width, int limitOfAll, bool isWhole, bool isLargest, short* units);

//! Limits of the image from this offset on, in 0 .. last
void joinLimits(const short* smallest, const short* largest, int width, int offset, int last, ushort* units);

//! Hulls of 2 x 2 intervals, from two rows of twice the width
void halveIntervals(const ushort* above, const ushort* below, int width, ushort* hulls);

//! From 1 / subpixelScale pixel of the image to candidates of a layer, of which there is none behind the last one
void toCandidates(const ushort* units, int width, int layer, int last, ushort* intervals);

void intersectIntervals(const ushort* intervals, int width, ushort* others);

void moveIntoIntervals(const ushort* intervals, int width, ushort* disparity);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void toUnits(const float* limits, int width, int limitOfAll, bool isWhole, bool isLargest, short* units)
{
    const int unit = isWhole ? subpixelScale : 1, ofAll = limitOfAll * subpixelScale;
    const int first = isLargest ? SHRT_MIN : ofAll, last = isLargest ? ofAll : SHRT_MAX;
    const int sign = isLargest ? -1 : 1; // limits are rounded to the inside: up, if largest ones are negated
    const float scale = (float)(subpixelScale / unit), unlimited = (float)limitOfAll; // both exact
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const float limit = limits[x] == limits[x] ? limits[x] : unlimited;
        const float steps = clamped(limit, (float)SHRT_MIN, (float)SHRT_MAX) * scale;
        units[x] = (short)clamped(sign * cvCeil(sign * steps) * unit, first, last);
    }
}

void joinLimits(const short* smallest, const short* largest, int width, int offset, int last, ushort* units)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        units[2 * x] = (ushort)clamped(smallest[x] - offset, 0, last);
        units[2 * x + 1] = (ushort)clamped(largest[x] - offset, 0, last);
    }
}

void halveIntervals(const ushort* above, const ushort* below, int width, ushort* hulls)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const ushort *const a = above + 4 * x, *const b = below + 4 * x;
        hulls[2 * x] = std::min(std::min(a[0], a[2]), std::min(b[0], b[2]));
        hulls[2 * x + 1] = std::max(std::max(a[1], a[3]), std::max(b[1], b[3]));
    }
}

void toCandidates(const ushort* units, int width, int layer, int last, ushort* intervals)
{
    static_assert(subpixelScale == 1 << 4, "units of a candidate of layer 0");
    const int shift = 4 + layer, mostOfOne = (1 << shift) - 1;
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int first = std::min(units[2 * x] >> shift, last);
        intervals[2 * x] = (ushort)first;
        intervals[2 * x + 1] = (ushort)std::min(std::max((units[2 * x + 1] + mostOfOne) >> shift, first), last);
    }
}

void intersectIntervals(const ushort* intervals, int width, ushort* others)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const ushort* const own = intervals + 2 * x;
        ushort* const other = others + 2 * x;
        const int first = std::max(own[0], other[0]), last = std::min(own[1], other[1]), isEmpty = (int)(last < first);
        other[0] = (ushort)choose(isEmpty, own[0], first);
        other[1] = (ushort)choose(isEmpty, own[1], last);
    }
}

void moveIntoIntervals(const ushort* intervals, int width, ushort* disparity)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const ushort first = (ushort)(intervals[2 * x] * subpixelScale),
                     last = (ushort)(intervals[2 * x + 1] * subpixelScale);
        disparity[x] = std::min(std::max(disparity[x], first), last);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
