// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prior.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxRefused, 10, "percent of the predicted pixels",
            "whose costs may contradict: more believes wrong motions, less begins anew where much moves by itself");
HDP_TUNABLE(int, maxPenalty, 6, "bits",
            "of disparities other than the predicted one: more keeps errors, less adds noise");

//! Whether more than one pair has shown a disparity
bool isConfirmed(const FrameMemory& last, int x, int y)
{
    const int detail = last.detail.ptr(y)[x];
    return (detail & FrameMemory::GUESS) == 0 && (detail & FrameMemory::countMask) > 1;
}

//! The disparity that the last frame predicts for a pixel, in pixels; negative if there is none
float predict(const FrameMemory& last, const FramePrediction& p, int x, int y)
{
    const float unit = 1.f / subpixelScale, unmoved = last.disparity.at<ushort>(y, x) * unit, none = -1;
    const int cell = FrameMemory::cell, i = std::min(y / cell, p.sources.rows - 1);
    const int sources = p.sources.ptr(i)[std::min(x / cell, p.sources.cols - 1)];
    if (!(sources & MOVED_PLACE))
        return sources != 0 && isConfirmed(last, x, y) ? unmoved : none;
    if (!p.warp.isKnown(x, y)) // as an odd last row or column may be
        return none;
    const Point from = p.warp(x, y);
    const float moved = p.backward.change.now(last.disparity.at<ushort>(from) * unit, (float)x, (float)y);
    const bool isClear = !(sources & SAME_PLACE) || p.key.scale * std::abs(moved - unmoved) <= maxSourceDistance;
    return isClear && isConfirmed(last, from.x, from.y) ? moved : none;
}

} // namespace

bool predictsDisparities(const FrameMemory& last, const FramePrediction& prediction)
{
    return prediction.isMoving() && last.frames > 1;
}

void predictDisparities(const FrameMemory& last, const FramePrediction& prediction, int side, const Size& size,
                        Mat& predicted)
{
    predicted.create(size, CV_32F);
    parallelForRows(size, [&](int y) {
        const int centreY = std::min(y * side + side / 2, last.disparity.rows - 1);
        float* const row = predicted.ptr<float>(y);
        for (int x = 0; x < size.width; ++x)
        {
            const int centreX = std::min(x * side + side / 2, last.disparity.cols - 1);
            const float disparity = predict(last, prediction, centreX, centreY);
            row[x] = disparity < 0 ? -1 : disparity / side;
        }
    });
}

bool refusesLastFrame(const CostVolume& volume, Mat& predicted)
{
    const int64 known = countNonZero(predicted >= 0);
    parallelForRows(volume.size, [&](int y) {
        float* const row = predicted.ptr<float>(y);
        for (int x = 0; x < volume.size.width; ++x)
            if (row[x] >= 0 && isContradicted(y * volume.size.width + x, row[x], volume))
                row[x] = -1;
    });
    const int64 refused = known - countNonZero(predicted >= 0);
    return 100 * refused > maxRefused * known;
}

void preferPredicted(const Mat& predicted, CostVolume& volume)
{
    parallelForRows(volume.size, [&](int y) {
        const float* const row = predicted.ptr<float>(y);
        for (int x = 0; x < volume.size.width; ++x)
            if (row[x] >= 0)
                preferDisparity(y * volume.size.width + x, row[x], CostVolume::scale * maxPenalty, volume);
    });
}

}}} // namespace cv::stereo::hdp
