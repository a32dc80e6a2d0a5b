// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "two_layer_cost.hpp"
#include "two_layer_cost.simd.hpp"
#include "cost/two_layer_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(countTwoLayers)
HDP_DISPATCH(takeEverySecond)

//! Every second pixel of every second row, from column dx and row dy on. Candidate d of column x is number 2 d of
//! column 2 x + dx: the right image is mirrored.
void takePixels(const CensusPlanes& below, int dx, int dy, Mat left, Mat right)
{
    const int width = left.cols, height = left.rows;
    const int first = below.width - 2 * width + 1 - dx,
              inside = (below.width - first) / 2 + 1; // the last is the border
    parallel_for_(Range(0, height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const size_t from = 2 * y + dy;
            const uchar* pixels = below.left + from * below.leftStep;
            dispatched::takeEverySecond(reinterpret_cast<const unsigned*>(pixels) + dx, width, left.ptr<unsigned>(y));
            for (int plane = 0; plane < below.count; ++plane)
            {
                const uchar* bits = below.right + plane * below.rightPlane + from * below.rightStep + first;
                uchar* taken = right.ptr(plane * height + y);
                dispatched::takeEverySecond(bits, inside, taken);
                std::fill(taken + inside, taken + right.cols, taken[inside - 1]);
            }
        }
    });
}

} // namespace

void TwoLayerCost::prepare(const CensusCost& own, const CensusCost* below, int numDisparities)
{
    own_ = &own;
    seesBelow_ = below != nullptr;
    if (!seesBelow_)
        return;
    const Size size = own.size();
    const CensusPlanes& finer = below->data();
    left_.create(4 * size.height, size.width, CV_8UC4);
    right_.create(4 * finer.count * size.height, size.width + numDisparities + costPadding, CV_8U);
    for (int i = 0; i < 4; ++i)
    {
        const Mat left = left_.rowRange(i * size.height, (i + 1) * size.height);
        const Mat right = right_.rowRange(i * finer.count * size.height, (i + 1) * finer.count * size.height);
        takePixels(finer, i % 2, i / 2, left, right);
        below_[i] = {
            size.width, finer.count, left.ptr(), right.ptr(), left.step, right.step, right.step * size.height
        };
    }
}

void TwoLayerCost::evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const
{
    if (seesBelow_)
    {
        dispatched::countTwoLayers(own_->data(), below_, pixels, count, first, lanes, cost);
        if (!own_->limits().isEmpty())
            own_->limits().apply(pixels, count, first, lanes, scale, cost);
        return;
    }
    own_->evaluate(pixels, count, first, lanes, cost);
    const size_t size = (size_t)count * lanes;
    HDP_VECTORIZED for (size_t k = 0; k < size; ++k) cost[k] = (uchar)(scale * cost[k]);
}

}}} // namespace cv::stereo::hdp
