// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prediction.hpp"

#include "../base/vectorized.hpp"
#include "../base/window_sums.hpp"
#include "../pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, maxError, 1, "cells",
            "from a point to where the motion takes it, for it to count: more follows what moves by itself");
HDP_TUNABLE(
    double, noMotion, 1.25, "cells",
    "median error of a motion, above which none is believed: more warps by wrong ones, less loses fast cameras");

// Exposure, on the coarsest level
HDP_TUNABLE(double, sameGain, 0.15, "difference from 1",
            "of the deviations, up to which frames are compared as they are: scenes change by as much");
HDP_TUNABLE(double, sameMean, 10, "grey levels", "of the means, for the same reason");

// What is no cut, on the coarsest level
HDP_TUNABLE(int, cutShare, 60, "percent of the contrast",
            "of changes: less is motion and noise, more is another scene");

// What is the same in two frames
HDP_TUNABLE(double, stillness, 2.5, "grey levels",
            "that the mean around a cell may change: less takes noise for motion");
HDP_TUNABLE(int, minNoise, 3, "grey levels", "that what is the same may change without noise, by rounding and warping");
HDP_TUNABLE(int, noiseFactor, 4, "medians of all changes", "beside that: outliers of noise are as large");
HDP_TUNABLE(int, contrastShare, 70, "percent of the contrast around",
            "around, up to which a change is none, however small the noise: edges move by fractions of a pixel");

// Cells; side of the windows that changes and levels, and contrasts are averaged over
const int changeSide = 3, changeCells = changeSide * changeSide, contrastSide = 5,
          contrastCells = contrastSide * contrastSide;

const int cell = FrameMemory::cell;
const int trackedReach = 4 * cell; // pixels, from a tracked point to the corners of about the square that is compared

//! What levels of one frame are in another one
struct LevelLine
{
    double gain, offset;

    bool isSame() const { return gain == 1 && offset == 0; }
};

//! Of levels between the ends of this frame, in those of the last one; brightened levels are on no line
LevelLine lineOfEnds(const LevelScale& before, const LevelScale& now)
{
    const double levelsOfAll = 256; // from black to white
    if (now.brightness != 1 || before.brightness != 1)
        return { 1, 0 };
    return { now.contrast() / before.contrast(), levelsOfAll * (now.darkest() - before.darkest()) / before.contrast() };
}

/** The same where the exposure has changed as well: if mean and deviation are not about the same between the same ends,
the line that makes them so, unless the ends are others and frames differ more by it: something dark or bright came,
then. Levels are only compared, so they need not be exact. */
LevelLine lineOfExposure(const Mat& before, const Mat& now, const LevelLine& ends)
{
    Scalar meanBefore, deviationBefore, mean, deviation;
    meanStdDev(before, meanBefore, deviationBefore);
    meanStdDev(now, mean, deviation);
    const double exposure = deviationBefore[0] / std::max(ends.gain * deviation[0], 1.);
    if (std::abs(exposure - 1) < sameGain && std::abs(meanBefore[0] - ends.gain * mean[0] - ends.offset) < sameMean)
        return ends;
    const LevelLine exposed = { ends.gain * exposure, meanBefore[0] - ends.gain * exposure * mean[0] };
    const auto difference = [&](const LevelLine& line) {
        Mat changed;
        now.convertTo(changed, CV_8U, line.gain, line.offset);
        return norm(changed, before, NORM_L1);
    };
    return ends.isSame() || difference(exposed) < difference(ends) ? exposed : ends;
}

//! A pyramid in other levels; itself if these are the same
const std::vector<Mat>& relevelled(const std::vector<Mat>& grey, const LevelLine& line, std::vector<Mat>& memory)
{
    if (line.isSame())
        return grey;
    memory.resize(grey.size());
    for (size_t level = 0; level < grey.size(); ++level)
        grey[level].convertTo(memory[level], CV_8U, line.gain, line.offset);
    return memory;
}

//! Whether the square around a tracked pixel shows two surfaces. Outlines have texture, but no motion of their own.
bool isAtStep(const FrameMemory& last, Point pixel)
{
    const int maxStep = maxSourceDistance * subpixelScale / last.key.scale, r = trackedReach;
    const Rect map(Point(), last.disparity.size());
    for (const Point& to : { Point(-r, -r), Point(r, -r), Point(-r, r), Point(r, r) })
        if (map.contains(pixel + to) &&
            std::abs(last.disparity.at<ushort>(pixel + to) - last.disparity.at<ushort>(pixel)) > maxStep)
            return true;
    return false;
}

//! From the last frame to this one, in pixels of the layer. Points are looked for where the last motion leads, or, if
//! that fails, around where they were; and once more where this motion leads, as some were not found.
CameraMotion findMotion(const FrameMemory& last, const std::vector<Mat>& now, std::vector<TrackedPoint>& points)
{
    const std::vector<Mat>& before = last.grey;
    const Size size = now[0].size();
    choosePoints(before, points);
    const auto isUnusable = [&](const TrackedPoint& point) { return isAtStep(last, cell * Point(point.before)); };
    points.erase(std::remove_if(points.begin(), points.end(), isUnusable), points.end());
    for (TrackedPoint& point : points)
    {
        const ushort disparity = last.disparity.at<ushort>(cell * Point(point.before));
        point.disparity = (disparity / (double)subpixelScale + last.key.minDisparity) / cell;
    }
    movePoints(scaled(last.motion, 1. / cell), size, points);
    trackPoints(before, now, FROM_GUESS, points);
    CameraMotion motion = fitMotion(points, size, maxError);
    if (motion.error > maxError)
    {
        trackPoints(before, now, FROM_BEFORE, points);
        motion = fitMotion(points, size, maxError);
    }
    movePoints(motion, size, points);
    trackPoints(before, now, FROM_GUESS, points);
    return scaled(fitMotion(points, size, maxError), cell);
}

//! Whether this frame shows another scene: on the coarsest level, what was in the last frame changed by more than a
//! share of the contrast.
bool isCut(const FrameMemory& last, const std::vector<Mat>& greyNow, const FrameWarp* warp)
{
    const int level = (int)greyNow.size() - 1, side = cell << level;
    const Mat &before = last.grey[level], &now = greyNow[level];
    const int mean = cvRound(cv::mean(now)[0]);
    int64 change = 0, contrast = 0;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            Point at(x, y);
            if (warp)
            {
                const Point centre(x * side + side / 2, y * side + side / 2);
                if (!warp->isKnown(centre.x, centre.y))
                    continue;
                at = (*warp)(centre.x, centre.y) / side; // beyond, if an odd last row or column was left out
                at = Point(std::min(at.x, before.cols - 1), std::min(at.y, before.rows - 1));
            }
            change += std::abs(now.ptr(y)[x] - before.ptr(at.y)[at.x]);
            contrast += std::abs(now.ptr(y)[x] - mean);
        }
    return 100 * change > cutShare * contrast;
}

//! The median of a CV_8UC1 image
int medianLevel(const Mat& image)
{
    int counts[256] = { 0 };
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            ++counts[image.ptr(y)[x]];
    int level = 0;
    for (int64 sum = counts[0]; 2 * sum < (int64)image.total(); sum += counts[level])
        ++level;
    return level;
}

//! How far each cell is from the mean around it
void findContrast(const Mat& image, VideoScratch& scratch)
{
    Mat &levels = scratch.changes, &sums = scratch.contrasts; // memory that findSources() fills after this
    image.convertTo(levels, CV_16U, contrastCells);
    sumOverWindows(image, contrastSide, CV_16U, sums);
    absdiff(levels, sums, sums);
    sums.convertTo(scratch.contrast, CV_8U, 1. / contrastCells, -0.48); // rounded down: 24 / 25 becomes 0
}

//! The last frame as this one would show it if nothing moved but the camera: a place between cells has the mean of
//! those that it touches. What was not in the last frame is taken from the same place.
void warpGrey(const Mat& before, const FrameWarp& warp, Mat& warped)
{
    static_assert(cell == 2, "Pixels are half cells.");
    const int lastX = cell * before.cols - cell, lastY = cell * before.rows - cell;
    const uchar* const levels = before.data; // local, as stores may alias the Mat
    const size_t step = before.step;
    warped.create(before.size(), CV_8U);
    parallelForRows(before.size(), [&](int y) {
        uchar* const row = warped.ptr(y);
        const Vec2s* const shifts = warp.ofRow(cell * y);
        warp.forEachBlock(cell * y, [=](int x, const Point& place, int count) {
            const Point from = shifts[x / FrameWarp::block][0] != FrameWarp::unknown ? place : Point(x, cell * y);
            const int fromY = std::min(from.y, lastY);
            const uchar *above = levels + fromY / cell * step, *below = levels + (fromY + 1) / cell * step;
            for (int k = x % cell; k < count && x + k < lastX + cell; k += cell)
            {
                const int fromX = std::min(from.x + k, lastX), left = fromX / cell, right = (fromX + 1) / cell;
                row[(x + k) / cell] = (uchar)((above[left] + above[right] + below[left] + below[right] + 2) >> 2);
            }
        });
    });
}

} // namespace

void predictFrame(const Mat& left, const LevelScale& levels, const FrameKey& key, const FrameMemory& last,
                  VideoScratch& scratch, FramePrediction& p)
{
    p.verdict = FIRST;
    p.key = key;
    p.levels = levels;
    p.motion = CameraMotion();
    if (std::min(left.cols, left.rows) < cell)
        return;
    halveImage(left, scratch.halved);
    p.grey.resize(std::max<size_t>(p.grey.size(), 1));
    scratch.halved.convertTo(p.grey[0], CV_8U, 1. / greyScale);
    buildPyramid({ p.grey[0] }, trackingLevels(scratch.halved.size()), p.grey);
    if (last.isEmpty() || last.disparity.size() != left.size() || !(last.key == key))
        return;
    const LevelLine ends = lineOfEnds(last.levels, levels),
                    exposure = lineOfExposure(last.grey.back(), p.grey.back(), ends);
    const CameraMotion motion = findMotion(last, relevelled(p.grey, exposure, scratch.exposed), scratch.points);
    if (motion.error > noMotion * cell)
        return;
    // Without common points, another exposure cannot be told from another scene.
    const bool hasPoints = (int)scratch.points.size() >= CameraMotion::minPoints;
    const std::vector<Mat>& grey = relevelled(p.grey, hasPoints ? exposure : ends, scratch.exposed);
    p.backward = BackwardMotion(motion, key.minDisparity, (double)key.maxDisparity / subpixelScale);
    const FrameWarp* const warp = motion.isStill ? nullptr : &p.warp;
    if (warp)
        findWarp(p.backward, last.disparity, p.warp);
    if (isCut(last, grey, warp))
        return;
    findSources(last.grey[0], grey[0], warp, scratch, p.sources);
    p.motion = motion;
    p.verdict = CONTINUED;
}

void findSources(const Mat& before, const Mat& now, const FrameWarp* warp, VideoScratch& scratch, Mat& sources)
{
    if (warp)
        warpGrey(before, *warp, scratch.warped);
    absdiff(now, warp ? scratch.warped : before, scratch.change);
    findContrast(now, scratch);
    sumOverWindows(scratch.change, changeSide, CV_16U, scratch.changes);
    sumOverWindows(scratch.contrast, contrastSide, CV_16U, scratch.contrasts);
    if (warp)
    {
        subtract(now, before, scratch.difference, noArray(), CV_16S);
        sumOverWindows(scratch.difference, changeSide, CV_16S, scratch.differences);
        absdiff(now, before, scratch.unmovedChange);
        sumOverWindows(scratch.unmovedChange, changeSide, CV_16U, scratch.unmovedChanges);
    }
    const int noise = changeCells * (minNoise + noiseFactor * medianLevel(scratch.change));
    const int maxChange = (int)(changeCells * stillness), share = contrastShare * changeCells;
    sources.create(now.size(), CV_8U);
    parallelForRows(now.size(), [&](int y) {
        const ushort *changes = scratch.changes.ptr<ushort>(y), *contrasts = scratch.contrasts.ptr<ushort>(y);
        const int cells = now.cols, maxNoise = noise; // local, as stores may alias all else
        uchar* const ofRow = sources.ptr(y);
        HDP_VECTORIZED for (int x = 0; x < cells; ++x) ofRow[x] =
            (changes[x] <= maxNoise) | (100 * contrastCells * changes[x] <= share * contrasts[x]);
        if (!warp)
            return; // 1 is SAME_PLACE
        const short* differences = scratch.differences.ptr<short>(y);
        const ushort* unmovedChanges = scratch.unmovedChanges.ptr<ushort>(y);
        HDP_VECTORIZED for (int x = 0; x < cells; ++x)
        {
            const int isSame = (std::abs(differences[x]) <= maxChange) & (unmovedChanges[x] <= changes[x]);
            ofRow[x] = (uchar)(ofRow[x] * MOVED_PLACE + isSame * SAME_PLACE);
        }
        const Vec2s* const shifts = warp->ofRow(cell * y);
        for (int x = 0; x < cells; ++x)
        {
            const bool isKnown = shifts[cell * x / FrameWarp::block][0] != FrameWarp::unknown;
            ofRow[x] &= SAME_PLACE | MOVED_PLACE * isKnown;
        }
    });
}

}}} // namespace cv::stereo::hdp
