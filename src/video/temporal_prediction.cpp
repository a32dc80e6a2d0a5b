// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prediction.hpp"

#include "../base/grey_levels.hpp"
#include "../pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef VideoFollowing T;

const int cell = FrameMemory::cell;

void buildGrey(const Mat& left, Mat& halved, std::vector<Mat>& grey)
{
    halveImage(left, halved);
    grey.resize(std::max<size_t>(grey.size(), 1));
    halved.convertTo(grey[0], CV_8U, 1. / greyScale);
    buildPyramid({ grey[0] }, trackingLevels(halved.cols), grey);
}

//! From the last frame to this one, in pixels of the layer. The camera most likely moves on as it did.
CameraMotion findMotion(const FrameMemory& last, const std::vector<Mat>& now, std::vector<TrackedPoint>& points)
{
    const double anyError = 4.5; // in cells: points of a first guess may be this far from it
    const double smallError = 1; // in cells: of a guess that is good, and of points that are near the motion
    const std::vector<Mat>& before = last.grey;
    const Size size = now[0].size();
    choosePoints(before, points);
    for (TrackedPoint& point : points)
    {
        const ushort disparity = last.disparity.at<ushort>(cell * (int)point.before.y, cell * (int)point.before.x);
        point.disparity = (disparity / (double)subpixelScale + last.key.minDisparity) / cell;
    }
    movePoints(scaled(last.motion, 1. / cell), size, points);
    trackNearby(before, now, points);
    CameraMotion motion = fitMotion(points, size, anyError);
    if (motion.error > smallError)
    {
        trackPoints(before, now, points);
        motion = fitMotion(points, size, anyError);
    }
    movePoints(motion, size, points);
    trackNearby(before, now, points);
    return scaled(fitMotion(points, size, smallError), cell);
}

//! Whether this frame shows another scene: on the coarsest level, about as much changed as there is contrast.
bool isCut(const std::vector<Mat>& greyBefore, const FramePrediction& p)
{
    const int level = (int)p.grey.size() - 1, side = cell << level;
    const Mat &before = greyBefore[level], &now = p.grey[level];
    const int mean = cvRound(cv::mean(now)[0]);
    int64 known = 0, change = 0, contrast = 0;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            Point at(x, y);
            if (!p.motion.isStill)
            {
                const Point centre(x * side + side / 2, y * side + side / 2);
                if (!p.warp.isKnown(centre.x, centre.y))
                    continue;
                at = p.warp(centre.x, centre.y) / side;
                at = Point(std::min(at.x, before.cols - 1), std::min(at.y, before.rows - 1));
            }
            ++known;
            change += std::abs(now.ptr(y)[x] - before.ptr(at.y)[at.x]);
            contrast += std::abs(now.ptr(y)[x] - mean);
        }
    return 4 * known < (int64)now.total() || (change > T::cutNoise * known && 100 * change > T::cutShare * contrast);
}

} // namespace

void predictFrame(const Mat& left, const FrameKey& key, const FrameMemory& last, VideoScratch& scratch,
                  FramePrediction& p)
{
    p.verdict = FIRST;
    p.key = key;
    p.motion = CameraMotion();
    if (std::min(left.cols, left.rows) < cell)
        return;
    buildGrey(left, scratch.halved, p.grey);
    if (last.isEmpty() || last.disparity.size() != left.size() || !(last.key == key))
        return;
    p.motion = findMotion(last, p.grey, scratch.points);
    p.backward = BackwardMotion(p.motion, key.minDisparity, (double)key.maxDisparity / subpixelScale);
    if (!p.motion.isStill)
        findWarp(p.backward, last.disparity, p.warp);
    if (isCut(last.grey, p))
    {
        p.motion = CameraMotion();
        return;
    }
    findSources(last.grey[0], p.grey[0], p.motion.isStill ? nullptr : &p.warp, scratch, p.sources);
    p.verdict = CONTINUED;
}

}}} // namespace cv::stereo::hdp
