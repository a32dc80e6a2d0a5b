// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "two_layer_cost.hpp"
#include "two_layer_cost.simd.hpp"
#include "cost/two_layer_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(countTwoLayers)

} // namespace

void TwoLayerCost::prepare(const CensusCost& own, const CensusCost* below)
{
    own_ = &own;
    below_ = below;
}

void TwoLayerCost::evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const
{
    if (below_)
    {
        CV_DbgAssert(first % 2 == 0);
        dispatched::countTwoLayers(own_->data(), below_->data(), pixels, count, first, lanes, cost);
        own_->limits().apply(pixels, count, first, lanes, (uchar)scale, steps(), cost);
        return;
    }
    own_->evaluate(pixels, count, first, lanes, cost);
    const size_t size = (size_t)count * lanes;
    HDP_VECTORIZED for (size_t k = 0; k < size; ++k) cost[k] = (uchar)(scale * cost[k]);
}

}}} // namespace cv::stereo::hdp
