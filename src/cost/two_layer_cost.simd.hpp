// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "two_layer_cost.hpp"
#include "../base/vectorized.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "census_counting.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** TwoLayerCost::evaluate() with a layer below.
@param own The layer's census.
@param below That of the layer below, as four of the layer's size. */
void countTwoLayers(const CensusPlanes& own, const CensusPlanes* below, const int* pixels, int count, int first,
                    int lanes, uchar* cost);

//! Every second byte or pixel of a row
void takeEverySecond(const uchar* from, int count, uchar* taken);
void takeEverySecond(const unsigned* from, int count, unsigned* taken);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

template <int lanes>
void countTwoLayers(const CensusPlanes& own, const CensusPlanes* below, const int* pixels, int count, int first,
                    uchar* cost)
{
    const int block = 32; // pixels, whose costs stay in the cache
    const uchar ownWeight = TwoLayerCost::scale / 2;
    for (int begin = 0; begin < count; begin += block)
    {
        const int size = std::min(block, count - begin);
        uchar* const to = cost + (size_t)begin * lanes;
        evaluateCosts<lanes>(own, pixels + begin, size, first, [=](const uchar* bits, int number, int position) {
            HDP_VECTORIZED for (int k = 0; k < number; ++k) to[position + k] = (uchar)(ownWeight * bits[k]);
        });
        for (int i = 0; i < 4; ++i)
            evaluateCosts<lanes>(below[i], pixels + begin, size, first,
                                 [=](const uchar* bits, int number, int position) {
                HDP_VECTORIZED for (int k = 0; k < number; ++k) to[position + k] = (uchar)(to[position + k] + bits[k]);
            });
    }
}

} // namespace

void countTwoLayers(const CensusPlanes& own, const CensusPlanes* below, const int* pixels, int count, int first,
                    int lanes, uchar* cost)
{
    switch (lanes)
    {
    case 4:
        return countTwoLayers<4>(own, below, pixels, count, first, cost);
    case 8:
        return countTwoLayers<8>(own, below, pixels, count, first, cost);
    case 16:
        return countTwoLayers<16>(own, below, pixels, count, first, cost);
    default:
        return countTwoLayers<32>(own, below, pixels, count, first, cost);
    }
}

void takeEverySecond(const uchar* from, int count, uchar* taken)
{
    HDP_VECTORIZED for (int i = 0; i < count; ++i) taken[i] = from[2 * i];
}

void takeEverySecond(const unsigned* from, int count, unsigned* taken)
{
    HDP_VECTORIZED for (int i = 0; i < count; ++i) taken[i] = from[2 * i];
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
