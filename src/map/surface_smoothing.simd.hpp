// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "map_filters.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of smoothSurfaces().
@param rows Those up to smoothingRadius pixels away; that in the middle has as many elements more on both sides.
@param width Of the rows.
@param likeness The most that disparities of a surface differ.
@param smoothed Receives the row. */
void smoothRow(const ushort* const* rows, int width, ushort likeness, ushort* smoothed);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! What two opposite pixels add to the sum of differences from the one in the middle
CV_ALWAYS_INLINE ushort addPair(ushort first, ushort second, ushort own, ushort likeness)
{
    const ushort larger = std::max(difference(first, own), difference(second, own));
    return (ushort)(larger <= likeness ? first + second - 2 * own : 0);
}

} // namespace

void smoothRow(const ushort* const* rows, int width, ushort likeness, ushort* smoothed)
{
    const int radius = smoothingRadius, count = 4 * radius;
    const ushort bias = (ushort)(count * likeness); // so that no sum is negative
    const ushort* const own = rows[radius];
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        ushort sum = (ushort)(bias + count / 2);
        HDP_UNROLLED for (int k = 0; k < radius; ++k)
        {
            sum = (ushort)(sum + addPair(rows[k][x], rows[2 * radius - k][x], own[x], likeness));
            sum = (ushort)(sum + addPair(own[x - k - 1], own[x + k + 1], own[x], likeness));
        }
        smoothed[x] = (ushort)(own[x] + sum / count - likeness);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
