// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "nonlocal_refinement.hpp"

namespace cv {
namespace stereo {
namespace hdp {

Range NonLocalRefinement::candidates(const TreeWalk& walk, const DisparityTree& tree) const
{
    int smallest = INT_MAX, largest = -1;
    for (int i = 0; i < tree.size; ++i)
        if (stable_[walk.pixels[i]])
        {
            const int d = disparity_[walk.pixels[i]];
            smallest = std::min(smallest, d);
            largest = std::max(largest, d);
        }
    if (largest < 0)
        return Range(0, 0);
    return Range(smallest / scale_ - 1, (largest + scale_ - 1) / scale_ + 2);
}

void NonLocalRefinement::evaluate(const int* pixels, int count, int first, int lanes, float* costs) const
{
    const float unit = 1.f / scale_;
    for (int i = 0; i < count; ++i, costs += lanes)
    {
        const float weight = stable_[pixels[i]] ? 1.f : 0.f, difference = first - disparity_[pixels[i]] * unit;
        for (int k = 0; k < lanes; ++k)
            costs[k] = weight * std::abs(difference + k);
    }
}

int NonLocalRefinement::disparity(int pixel, const RunWinner& winner) const
{
    const int own = disparity_[pixel];
    if (winner.lowest == 0 && winner.last == 0) // no cost at all
        return own;
    // The first and the last candidate are above their neighbours but for costs so close to 0 that few bits are left.
    if (winner.before < 0 || winner.after < 0)
        return own;
    if (stable_[pixel] && (own + scale_ / 2) / scale_ == winner.disparity)
        return own;
    const float steeper = std::max(winner.before, winner.after) - winner.lowest; // of the slopes on both sides
    const float difference = winner.before - winner.after;
    return winner.disparity * scale_ + (steeper > 0 ? cvRound(difference / steeper * (scale_ / 2)) : 0);
}

void refineNonLocal(const DisparityForest& forest, const Mat& disparity, int scale, const Mat& stable, double gamma,
                    AggregationBuffers& buffers, Mat& refined)
{
    CV_Assert(disparity.type() == CV_16UC1 && disparity.isContinuous() && disparity.size() == forest.links.size());
    CV_Assert(stable.type() == CV_8UC1 && stable.isContinuous() && stable.size() == disparity.size());
    CV_Assert(refined.data != disparity.data && (scale == 1 || scale % 2 == 0));
    disparity.copyTo(refined);
    takeWinners(forest, NonLocalRefinement(disparity, scale, stable), gamma, buffers, refined);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
