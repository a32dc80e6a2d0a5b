// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "two_layer_cost.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#include <cstring>
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! TwoLayerCost::evaluate() with a layer below
void countTwoLayers(const CensusPlanes& own, const CensusPlanes& below, const int* pixels, int count, int first,
                    int lanes, uchar* cost);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! A pixel of the left image, and its candidates in the first plane of the right one
struct PixelCensus
{
    const uchar *left, *right;

    PixelCensus(const CensusPlanes& census, int y, int x, int first)
        : left(census.left + y * census.leftStep + 4 * x),
          right(census.right + y * census.rightStep + (census.width - 1 - x + first))
    {
    }

    //! C of some candidates from number k on
    template <int planes> CV_ALWAYS_INLINE ByteLanes costs(size_t rightPlane, int k) const
    {
        ByteLanes sum = (ByteLanes::repeat(left[0]) ^ ByteLanes::load(right + k)).countBits();
        for (int plane = 1; plane < planes; ++plane)
            sum = sum + (ByteLanes::repeat(left[plane]) ^ ByteLanes::load(right + plane * rightPlane + k)).countBits();
        return sum;
    }

    //! C(floor(h / 2)) + C(ceil(h / 2)) of candidates h, from number 2 * k on
    template <int planes> CV_ALWAYS_INLINE ByteLanes costsOfHalves(size_t rightPlane, int k) const
    {
        ByteLanes sum = ByteLanes::repeat(0);
        for (int plane = 0; plane < planes; ++plane)
        {
            const ByteLanes pixel = ByteLanes::repeat(left[plane]);
            const uchar* const from = right + plane * rightPlane + k;
            sum = sum + (pixel ^ ByteLanes::loadInTurns(from, from)).countBits() +
                  (pixel ^ ByteLanes::loadInTurns(from, from + 1)).countBits();
        }
        return sum;
    }
};

template <int planes>
void countTwoLayers(const CensusPlanes& own, const CensusPlanes& below, const int* pixels, int count, int first,
                    int lanes, uchar* cost)
{
    const double rowsPerPixel = 1. / own.width;
    const int vector = 16 * ByteLanes::groups;
    for (int i = 0; i < count; ++i, cost += lanes)
    {
        const int y = rowOf(pixels[i], rowsPerPixel), x = pixels[i] - y * own.width;
        const PixelCensus pixel(own, y, x, first / 2);
        const PixelCensus a(below, 2 * y, 2 * x, first), b(below, 2 * y, 2 * x + 1, first);
        const PixelCensus c(below, 2 * y + 1, 2 * x, first), d(below, 2 * y + 1, 2 * x + 1, first);
        for (int k = 0; k < lanes; k += vector)
        {
            const size_t plane = below.rightPlane;
            const ByteLanes sum = a.costs<planes>(plane, k) + b.costs<planes>(plane, k) + c.costs<planes>(plane, k) +
                                  d.costs<planes>(plane, k);
            const ByteLanes all =
                pixel.costsOfHalves<planes>(own.rightPlane, k / 2) + sum + (sum + ByteLanes::repeat(1)).half();
            if (lanes >= vector)
            {
                all.store(cost + k);
                continue;
            }
            uchar stored[vector];
            all.store(stored);
            std::memcpy(cost, stored, lanes);
        }
    }
}

} // namespace

void countTwoLayers(const CensusPlanes& own, const CensusPlanes& below, const int* pixels, int count, int first,
                    int lanes, uchar* cost)
{
    const auto countCosts = own.count == 3   ? &countTwoLayers<3>
                            : own.count == 2 ? &countTwoLayers<2>
                                             : &countTwoLayers<1>;
    countCosts(own, below, pixels, count, first, lanes, cost);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
