// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prior.hpp"

#include "../base/tunable.hpp"

#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxRefused, 10, "percent of the predicted pixels",
            "whose costs may contradict: more believes wrong motions, less begins anew where much moves by itself");
HDP_TUNABLE(int, maxPenalty, 6, "bits",
            "of disparities other than the predicted one: more keeps errors, less adds noise");
HDP_TUNABLE(int, maxPenaltyOfMeans, 3, "bits", "the same over means, which vary less and contradict more clearly");

//! The disparity that the last frame predicts for a pixel, in pixels; false if there is none.
bool predict(const FrameMemory& last, const FramePrediction& p, int x, int y, float& disparity)
{
    const float unit = 1.f / subpixelScale, unmoved = last.disparity.ptr<ushort>(y)[x] * unit;
    const int cell = FrameMemory::cell, i = std::min(y / cell, p.sources.rows - 1);
    const int sources = p.sources.ptr(i)[std::min(x / cell, p.sources.cols - 1)];
    disparity = unmoved;
    if (!(sources & MOVED_PLACE))
        return sources != 0;
    const DisparityChange& change = p.backward.change();
    const Point from = p.warp(x, y);
    disparity = change.now(last.disparity.ptr<ushort>(from.y)[from.x] * unit, change.ofX * x + change.ofRow(y));
    return !(sources & SAME_PLACE) || p.key.scale * std::abs(disparity - unmoved) <= TemporalSources::maxDistance;
}

//! Calls take(pixel, disparity) for the pixels of a row of the volume that the last frame predicts a disparity for.
template <typename Take>
void forEachPredicted(const FrameMemory& last, const FramePrediction& prediction, int side, const Size& size, int y,
                      const Take& take)
{
    const int centreY = std::min(y * side + side / 2, last.disparity.rows - 1);
    for (int x = 0; x < size.width; ++x)
    {
        float disparity;
        if (predict(last, prediction, std::min(x * side + side / 2, last.disparity.cols - 1), centreY, disparity))
            take(y * size.width + x, disparity / side);
    }
}

} // namespace

bool hasPrior(const FrameMemory& last, const FramePrediction& prediction)
{
    return prediction.isMoving() && last.frames > 1;
}

bool contradictsLastFrame(const FrameMemory& last, const FramePrediction& prediction, int side,
                          const CostVolume& volume)
{
    std::vector<int> predicted(volume.size.height), refused(volume.size.height);
    parallel_for_(Range(0, volume.size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            forEachPredicted(last, prediction, side, volume.size, y, [&](int own, float disparity) {
                ++predicted[y];
                refused[y] += CostPreference::isContradicted(own, disparity, volume);
            });
    });
    const int64 all = std::accumulate(predicted.begin(), predicted.end(), (int64)0);
    return 100 * std::accumulate(refused.begin(), refused.end(), (int64)0) > maxRefused * all;
}

void preferLastFrame(const FrameMemory& last, const FramePrediction& prediction, int side, bool areMeans,
                     CostVolume& volume)
{
    const CostPreference preference(CostVolume::scale * (areMeans ? maxPenaltyOfMeans : maxPenalty));
    parallel_for_(Range(0, volume.size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            forEachPredicted(last, prediction, side, volume.size, y, [&](int own, float disparity) {
                if (!(areMeans && CostPreference::isContradicted(own, disparity, volume)))
                    preference.apply(own, disparity, volume);
            });
    });
}

}}} // namespace cv::stereo::hdp
