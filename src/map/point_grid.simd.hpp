// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "point_grid.hpp"
#include <cmath>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! PointGrid::weigh() for a pixel of some colour. perPixel, perLevel, largest: of the logarithm, as keys have it
void weighPoints(const Point& place, const Vec3b& color, float perPixel, float perLevel, float largest, int reach,
                 Surroundings& seen);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void weighPoints(const Point& place, const Vec3b& color, float perPixel, float perLevel, float largest, int reach,
                 Surroundings& seen)
{
    const int count = (int)seen.index.size(), bits = seen.placeBits, farthest = reach * reach;
    const short x = (short)place.x, y = (short)place.y, blue = color[0], green = color[1], red = color[2];
    const short *const xs = seen.x.data(), *const ys = seen.y.data(), *const blues = seen.channels[0].data(),
                       *const greens = seen.channels[1].data(), *const reds = seen.channels[2].data();
    short *const squared = seen.squared.data(), *const colors = seen.color.data();
    int* const keys = seen.keys.data();
    int lowest = Surroundings::beyondReach;
    const auto difference = [](short a, short b) { return (short)(std::max(a, b) - std::min(a, b)); };
    for (int first = 0; first < count; first += Surroundings::block)
    {
        HDP_VECTORIZED for (int k = 0; k < Surroundings::block; ++k)
        {
            const int i = first + k;
            const short dx = (short)(xs[i] - x), dy = (short)(ys[i] - y);
            squared[i] = (short)((short)(dx * dx) + (short)(dy * dy));
            colors[i] =
                std::max(std::max(difference(blues[i], blue), difference(greens[i], green)), difference(reds[i], red));
        }
        HDP_VECTORIZED for (int k = 0; k < Surroundings::block; ++k) // without branches, so that it can be
        {
            const int i = first + k, isBeyond = (int)(squared[i] > farthest) | (int)(i >= count);
            const float lightness =
                std::sqrt((float)squared[i]) * perPixel + (float)colors[i] * perLevel; // times its scale
            const int key = choose(isBeyond, Surroundings::beyondReach, (int)std::min(largest, lightness) << bits | i);
            keys[i] = key;
            lowest = std::min(lowest, key);
        }
    }
    seen.lowestKey = lowest;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
