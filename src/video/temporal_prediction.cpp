// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prediction.hpp"
#include "temporal_prediction.simd.hpp"
#include "video/temporal_prediction.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

#include "../base/grey_levels.hpp"
#include "../pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef VideoFollowing T;

HDP_DISPATCH(stepBack)
HDP_DISPATCH(changeBlocks)

void buildGrey(const Mat& left, TemporalState& s)
{
    std::vector<Mat>& pyramid = s.next.grey;
    halveImage(left, s.halved);
    pyramid.resize(trackingLevels(s.halved.cols));
    s.halved.convertTo(pyramid[0], CV_8U, 1. / greyScale);
    for (size_t level = 1; level < pyramid.size(); ++level)
        halveImage(pyramid[level - 1], pyramid[level]);
}

//! From the last frame to this one. The camera most likely moves on as it did.
void findMotion(TemporalState& s)
{
    const std::vector<Mat>&before = s.last.grey, &now = s.next.grey;
    const Size cells = now[0].size();
    choosePoints(before, s.points);
    for (TrackedPoint& point : s.points)
    {
        const int x = T::cell * (int)point.before.x, y = T::cell * (int)point.before.y;
        const double disparity = s.last.disparity.at<ushort>(y, x) / (double)subpixelScale + s.layer.minDisparity;
        point.disparity = disparity / T::cell;
    }
    const double anyError = 4.5, smallError = 1; // in cells
    trackPoints(before, now, scaled(s.motion, 1. / T::cell), s.points);
    CameraMotion motion = fitMotion(s.points, cells, anyError);
    if (motion.error > smallError)
    {
        trackPoints(before, now, s.points);
        motion = fitMotion(s.points, cells, anyError);
    }
    trackPoints(before, now, motion, s.points);
    s.motion = scaled(fitMotion(s.points, cells, smallError), T::cell);
}

//! Where blocks were depends on their disparities, and these on where they were: from what the last frame had at the
//! same place, some steps lead to both.
void findShifts(TemporalState& s)
{
    const Size size = s.last.disparity.size();
    const int steps = 4, maxLastStep = 2, count = (size.width + T::block - 1) / T::block;
    s.shifts.create((size.height + T::block - 1) / T::block, count, CV_16SC2);
    parallel_for_(Range(0, s.shifts.rows), [&](const Range& rows) {
        std::vector<float> disparity(count);
        std::vector<ushort> before(count);
        std::vector<int> atX(count), atY(count), lastStep(count), state(count);
        for (int i = rows.start; i < rows.end; ++i)
        {
            const int y = std::min(i * T::block + T::block / 2, size.height - 1);
            const BlockRow row = { y,          size.width, count,           disparity.data(),
                                   atX.data(), atY.data(), lastStep.data(), state.data() };
            for (int j = 0; j < count; ++j)
            {
                atX[j] = row.centre(j);
                atY[j] = y;
                disparity[j] = s.last.disparity.ptr<ushort>(y)[atX[j]] / (float)subpixelScale;
                state[j] = BlockRow::MOVING;
            }
            for (int step = 0; step < steps && !dispatched::stepBack(s.backward, size, step == 0, row); ++step)
            {
                for (int j = 0; j < count; ++j)
                    before[j] = s.last.disparity.ptr<ushort>(atY[j])[atX[j]];
                dispatched::changeBlocks(s.backward.change(), before.data(), row);
            }
            Vec2s* const shifts = s.shifts.ptr<Vec2s>(i);
            for (int j = 0; j < count; ++j)
            {
                const bool isFound = state[j] != BlockRow::OUTSIDE && lastStep[j] <= maxLastStep;
                shifts[j] = isFound ? Vec2s((short)(atX[j] - row.centre(j)), (short)(atY[j] - y))
                                    : Vec2s((short)TemporalState::noShift, 0);
            }
        }
    });
}

//! Whether this frame shows another scene: on the coarsest level, about as much changed as there is contrast.
bool isCut(const TemporalState& s)
{
    const int level = (int)s.next.grey.size() - 1, side = T::cell << level;
    const Mat &before = s.last.grey[level], &now = s.next.grey[level];
    const int mean = cvRound(cv::mean(now)[0]);
    int64 known = 0, change = 0, contrast = 0;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            Point at(x, y);
            if (!s.motion.isStill)
            {
                const int px = x * side + side / 2, py = y * side + side / 2;
                const Vec2s& shift = s.shifts.ptr<Vec2s>(py / T::block)[px / T::block];
                if (shift[0] == TemporalState::noShift)
                    continue;
                at = shifted(px, py, shift, s.last.disparity.size()) / side;
                at = Point(std::min(at.x, before.cols - 1), std::min(at.y, before.rows - 1));
            }
            ++known;
            change += std::abs(now.ptr(y)[x] - before.ptr(at.y)[at.x]);
            contrast += std::abs(now.ptr(y)[x] - mean);
        }
    return 4 * known < (int64)now.total() || (change > T::cutNoise * known && 100 * change > T::cutShare * contrast);
}

//! Whether there is a last frame, and it shows the same scene
bool isContinued(const Mat& left, const TemporalLayer& layer, TemporalState& s)
{
    if (s.last.disparity.size() != left.size() || !(s.layer == layer))
        return false;
    findMotion(s);
    s.backward = BackwardMotion(s.motion, layer.minDisparity, (double)layer.largest / subpixelScale);
    if (!s.motion.isStill)
        findShifts(s);
    return !isCut(s);
}

} // namespace

void followVideo(const Mat& left, const TemporalLayer& layer, TemporalState& s)
{
    if (std::min(left.cols, left.rows) < T::cell)
        return s.clear();
    buildGrey(left, s);
    if (isContinued(left, layer, s))
        ++s.age;
    else
        s.clear();
    s.layer = layer;
}

}}} // namespace cv::stereo::hdp
