// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "other_surfaces.hpp"
#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of findOtherSurfaces().
@param filtered The layer above.
@param unfiltered The same before the median.
@param width Of the rows.
@param others Receives the other surface, or the own one. */
void findOthersOfRow(const DisparityRow& filtered, const DisparityRow& unfiltered, int width, ushort* others);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

inline int farthest(int from, int min, int max) { return max - from >= from - min ? max : min; }

} // namespace

void findOthersOfRow(const DisparityRow& filtered, const DisparityRow& unfiltered, int width, ushort* others)
{
    const ushort *own = filtered.own, *min = filtered.min, *max = filtered.max;
    const ushort *raw = unfiltered.own, *minRaw = unfiltered.min, *maxRaw = unfiltered.max;
    const int distance = otherSurfaceDistance * subpixelScale;
    const auto isOther = [=](int a, int b) { return (int)(std::abs(a - b) >= distance); }; // surface
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * own[x];
        int other = farthest(here, 2 * minRaw[x], 2 * maxRaw[x]);
        const int ofFiltered = farthest(here, 2 * min[x], 2 * max[x]);
        other = choose(isOther(ofFiltered, here), ofFiltered, other);
        other = choose(isOther(2 * raw[x], here), 2 * raw[x], other);
        others[x] = (ushort)choose(isOther(other, here), other, here);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
