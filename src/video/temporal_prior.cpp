// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prior.hpp"

#include "../base/tunable.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

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

} // namespace

bool hasPrior(const FrameMemory& last, const FramePrediction& prediction)
{
    return prediction.isMoving() && last.frames > 1;
}

void preferLastFrame(const FrameMemory& last, const FramePrediction& prediction, int side, bool areMeans,
                     CostVolume& volume)
{
    const Size size = last.disparity.size();
    const CostPreference preference(CostVolume::scale * (areMeans ? maxPenaltyOfMeans : maxPenalty));
    parallel_for_(Range(0, volume.size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < volume.size.width; ++x)
            {
                const int own = y * volume.size.width + x;
                const int centreX = std::min(x * side + side / 2, size.width - 1);
                const int centreY = std::min(y * side + side / 2, size.height - 1);
                float disparity;
                if (predict(last, prediction, centreX, centreY, disparity) &&
                    !(areMeans && CostPreference::isContradicted(own, disparity / side, volume)))
                    preference.apply(own, disparity / side, volume);
            }
    });
}

}}} // namespace cv::stereo::hdp
