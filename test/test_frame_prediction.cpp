// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_video.hpp"
#include "video_oracles.hpp"

namespace opencv_test { namespace {

using namespace hdp;

const int disparities = 48;

FrameKey usualKey()
{
    const FrameKey key = { Size(), 1, 0, (disparities - 1) * subpixelScale };
    return key;
}

//! In pixels: (x, y) was at (x - shift.x, y - shift.y), disparities grow by z times themselves.
CameraMotion someMotion(const Point3d& step)
{
    CameraMotion motion;
    motion.isStill = false;
    motion.forward = Matx44d(1, 0, -step.x, 0.5, 0, 1, -step.y, -0.3, 0, 0, 1, 0, 0, 0, -step.z, 1);
    return motion;
}

//! A map of surfaces with steps between them
Mat someDisparities(Size size, RNG& rng)
{
    Mat disparity(size, CV_16U);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            disparity.at<ushort>(y, x) = (ushort)((x / 13 + y / 11) % 4 * 160 + rng.uniform(0, 40));
    return disparity;
}

void expectWarp(const BackwardMotion& motion, const Mat& disparity, const FrameWarp& warp)
{
    ASSERT_EQ(disparity.size(), warp.size);
    ASSERT_EQ(Size((disparity.cols + 3) / 4, (disparity.rows + 3) / 4), warp.shifts.size());
    for (int i = 0; i < warp.shifts.rows; ++i)
        for (int j = 0; j < warp.shifts.cols; ++j)
        {
            Point shift;
            const bool isKnown = oracle::blockShift(motion, disparity, Point(j, i), shift);
            ASSERT_EQ(isKnown, warp.isKnown(4 * j, 4 * i)) << Point(j, i);
            if (!isKnown)
                continue;
            ASSERT_EQ(shift, Point(warp.shifts.at<Vec2s>(i, j))) << Point(j, i);
        }
}

const Size someSizes[] = { Size(61, 43), Size(64, 48), Size(2, 2), Size(5, 9), Size(98, 3), Size(35, 30) };

TEST(HDPStereo_FrameWarp, oracle)
{
    RNG rng(71);
    FrameWarp warp;
    int known = 0, all = 0;
    for (const Size& size : someSizes)
        for (const Point3d& step : { Point3d(0.2, 0, 0), Point3d(-0.3, 0.25, 0.002), Point3d(0, 0, -0.02) })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << step);
            const Mat disparity = someDisparities(size, rng);
            const BackwardMotion motion(someMotion(step), rng.uniform(-3, 4), disparities - 1);
            findWarp(motion, disparity, warp);
            expectWarp(motion, disparity, warp);
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    known += warp.isKnown(x, y);
                    ++all;
                }
        }
    EXPECT_GE(known, all / 4);
    EXPECT_LE(known, all - all / 20);
}

//! Random shifts, which may lead out of the image
FrameWarp randomWarp(Size size, RNG& rng)
{
    FrameWarp warp;
    warp.size = size;
    warp.shifts.create((size.height + 3) / 4, (size.width + 3) / 4, CV_16SC2);
    rng.fill(warp.shifts, RNG::UNIFORM, -6, 7);
    for (int i = 0; i < warp.shifts.rows; ++i)
        for (int j = 0; j < warp.shifts.cols; ++j)
            if (rng.uniform(0, 8) == 0)
                warp.shifts.at<Vec2s>(i, j) = Vec2s(FrameWarp::unknown, 0);
    return warp;
}

//! Runs have all pixels of a row once, each from where the warp says it was.
TEST(HDPStereo_FrameWarp, runs)
{
    RNG rng(72);
    for (const Size& size : someSizes)
    {
        const FrameWarp warp = randomWarp(size, rng);
        for (int y = 0; y < size.height; ++y)
        {
            std::vector<Point> from(size.width, Point(-1, -1));
            warp.forEachBlock(y, [&](int x, const Point& first, int count) {
                for (int k = 0; k < count; ++k)
                {
                    EXPECT_EQ(Point(-1, -1), from[x + k]);
                    from[x + k] = first + Point(k, 0);
                }
            });
            for (int x = 0; x < size.width; ++x)
            {
                EXPECT_EQ(oracle::movedFrom(warp, x, y), from[x]);
                EXPECT_EQ(warp(x, y), from[x]);
            }
        }
    }
}

TEST(HDPStereo_TemporalSources, oracle)
{
    RNG rng(73);
    VideoScratch scratch;
    Mat sources;
    int counts[4] = { 0 };
    for (const Size& size : someSizes)
        for (int noise : { 1, 4, 20, 90 })
            for (bool isStill : { false, true })
            {
                SCOPED_TRACE(testing::Message() << size << ", noise " << noise << (isStill ? ", still" : ""));
                const FrameWarp warp = randomWarp(size, rng);
                const Size cells(size.width / 2, size.height / 2);
                const Mat before = patchyImage(rng, cells, CV_8UC1, 7);
                Mat now = isStill ? before.clone() : oracle::warpedGrey(before, warp);
                const Rect atRest(cells.width / 2, 0, cells.width / 4, cells.height);
                if (!atRest.empty())
                    before(atRest).copyTo(now(atRest));
                Mat change = randomImage(rng, cells, CV_8UC1, noise);
                change(Rect(0, 0, cells.width / 3, cells.height)).setTo(0);
                now += change;
                findSources(before, now, isStill ? nullptr : &warp, scratch, sources);
                expectIdentical(oracle::findSources(before, now, isStill ? nullptr : &warp), sources);
                for (int i = 0; i < sources.rows; ++i)
                    for (int j = 0; j < sources.cols; ++j)
                        ++counts[sources.at<uchar>(i, j)];
            }
    for (int count : counts)
        EXPECT_GE(count, 200);
}

//! What a frame leaves if its disparities are the true ones
FrameMemory remember(const SyntheticFrame& frame, const FramePrediction& prediction, int frames)
{
    FrameMemory memory;
    memory.frames = frames;
    memory.key = prediction.key;
    memory.motion = prediction.motion;
    memory.levels = prediction.levels;
    frame.truth.convertTo(memory.disparity, CV_16U, subpixelScale);
    for (const Mat& level : prediction.grey)
        memory.grey.push_back(level.clone());
    return memory;
}

Mat greyOf(const SyntheticFrame& frame) { return oracle::greyLevels(frame.left); }

std::vector<Board> someBoards()
{
    const Board near = { Rect2d(40, 40, 70, 50), 30.6, 3 }, far = { Rect2d(120, 20, 60, 80), 18.45, 4 };
    return { near, far };
}

//! The motion is that of the camera, and the rest follows from it, in used memory as in new one.
TEST(HDPStereo_FramePrediction, continued)
{
    const Size size(203, 131);
    VideoScratch scratch;
    FramePrediction prediction;
    for (const Point3d& step : { Point3d(0.15, 0, 0), Point3d(0.05, -0.06, 0.0008), Point3d(0, 0, -0.002) })
    {
        SCOPED_TRACE(testing::Message() << step);
        SyntheticVideo video(size, 10.3, 2);
        const SyntheticFrame first = video.render(0, someBoards()), second = video.render(1, someBoards(), step);
        predictFrame(greyOf(first), hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
        ASSERT_EQ(FIRST, prediction.verdict);
        ASSERT_TRUE(prediction.motion.isStill);
        ASSERT_FALSE(prediction.isMoving());
        const FrameMemory last = remember(first, prediction, 1);

        predictFrame(greyOf(second), hdp::LevelScale(), usualKey(), last, scratch, prediction);
        ASSERT_EQ(CONTINUED, prediction.verdict);
        ASSERT_TRUE(prediction.isMoving());
        EXPECT_TRUE(prediction.key == usualKey());
        for (int i = 0; i < 100; ++i)
        {
            const double x = 10 + i % 10 * 20 - size.width / 2, y = 10 + i / 10 * 11 - size.height / 2,
                         d = 10.3 + i % 20;
            const Vec4d p = prediction.motion.forward * Vec4d(x + size.width / 2, y + size.height / 2, d, 1);
            const double s = 1 / (1 - step.z * d);
            EXPECT_NEAR(s * (x - step.x * d) + size.width / 2, p[0] / p[3], 1);
            EXPECT_NEAR(s * (y - step.y * d) + size.height / 2, p[1] / p[3], 1);
        }
        expectWarp(prediction.backward, last.disparity, prediction.warp);
        expectIdentical(oracle::findSources(last.grey[0], prediction.grey[0], &prediction.warp), prediction.sources);

        FramePrediction again;
        VideoScratch fresh;
        predictFrame(greyOf(second), hdp::LevelScale(), usualKey(), last, fresh, again);
        EXPECT_EQ(prediction.motion.forward, again.motion.forward);
        expectIdentical(prediction.sources, again.sources);
    }
}

//! Another exposure of the whole frame changes neither verdict nor motion; what is remembered are its own levels.
TEST(HDPStereo_FramePrediction, exposure)
{
    SyntheticVideo video(Size(203, 131), 10.3, 2);
    const SyntheticFrame first = video.render(0, someBoards()),
                         second = video.render(1, someBoards(), Point3d(0.15, 0, 0));
    VideoScratch scratch;
    FramePrediction prediction, darker;
    predictFrame(greyOf(first), hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
    const FrameMemory last = remember(first, prediction, 1);
    predictFrame(greyOf(second), hdp::LevelScale(), usualKey(), last, scratch, prediction);
    const Mat left = greyOf(second);
    for (double gain : { 0.7, 0.55, 0.3 })
    {
        const Mat dark = left * gain;
        predictFrame(dark, hdp::LevelScale(), usualKey(), last, scratch, darker);
        ASSERT_EQ(CONTINUED, darker.verdict) << gain;
        EXPECT_LE(cvtest::norm(prediction.motion.forward, darker.motion.forward, NORM_INF), 0.5) << gain;
        EXPECT_GE(countNonZero(darker.sources), 0.9 * countNonZero(prediction.sources)) << gain;
        Mat own;
        oracle::halve(dark).convertTo(own, CV_8U, 0.25);
        expectIdentical(own, darker.grey[0]);
    }
}

//! A frame that is brightened twice as much as the last one
TEST(HDPStereo_FramePrediction, brightness)
{
    SyntheticVideo video(Size(203, 131), 10.3, 2);
    const Mat first = greyOf(video.render(0, someBoards())) * 0.5,
              second = greyOf(video.render(1, someBoards(), Point3d(0.15, 0, 0))) * 0.4;
    VideoScratch scratch;
    FramePrediction prediction, brighter;
    predictFrame(first, hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
    const FrameMemory last = remember(video.render(0, someBoards()), prediction, 1);
    predictFrame(second, hdp::LevelScale(), usualKey(), last, scratch, prediction);
    ASSERT_EQ(CONTINUED, prediction.verdict);
    predictFrame(second * 2, hdp::LevelScale(), usualKey(), last, scratch, brighter);
    EXPECT_EQ(CONTINUED, brighter.verdict);
    EXPECT_LE(cvtest::norm(prediction.motion.forward, brighter.motion.forward, NORM_INF), 0.5);
    EXPECT_GE(countNonZero(brighter.sources), 0.9 * countNonZero(prediction.sources));
}

//! A frame whose levels are stretched, or are so no longer, as something dark or bright came or went
TEST(HDPStereo_FramePrediction, contrast)
{
    SyntheticVideo video(Size(203, 131), 10.3, 2);
    const Mat first = greyOf(video.render(0, someBoards())),
              second = greyOf(video.render(1, someBoards(), Point3d(0.15, 0, 0)));
    hdp::LevelScale scale;
    scale.black = 20 * 256;
    scale.white = 180 * 256; // stretched by 1.6
    const auto stretched = [](const Mat& image) { return Mat((cv::min(image, 720) - 80) * 1.6); };
    VideoScratch scratch;
    FramePrediction prediction;
    for (const bool isStretched : { false, true })
    {
        const Mat before = isStretched ? stretched(first) : first, now = isStretched ? second : stretched(second);
        predictFrame(before, isStretched ? scale : hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
        FrameMemory last = remember(video.render(0, someBoards()), prediction, 1);
        predictFrame(now, isStretched ? hdp::LevelScale() : scale, usualKey(), last, scratch, prediction);
        EXPECT_EQ(CONTINUED, prediction.verdict) << isStretched;
        EXPECT_GE(countNonZero(prediction.sources), 0.9 * prediction.sources.total()) << isStretched;
    }
}

//! Something bright comes before a faint scene: the levels of the scene stay as they are, whatever mean and deviation are
TEST(HDPStereo_FramePrediction, a_lamp_comes)
{
    SyntheticVideo video(Size(203, 131), 10.3, 0.5);
    const SyntheticFrame frame = video.render(0, someBoards());
    const auto faint = [](const Mat& image) { return Mat(image * 0.1 + 400); };
    const Mat before = faint(greyOf(frame)), next = faint(greyOf(video.render(1, someBoards())));
    hdp::LevelScale scale;
    scale.black = 80 * 256;
    scale.white = 144 * 256;
    const auto stretched = [](const Mat& image) { return Mat((cv::min(image, 576) - 320) * 4); };
    Mat lit = next.clone();
    lit(Rect(60, 40, 12, 12)).setTo(960);
    VideoScratch scratch;
    FramePrediction prediction;
    for (const bool comes : { true, false })
    {
        predictFrame(comes ? stretched(before) : lit, comes ? scale : hdp::LevelScale(), usualKey(), FrameMemory(),
                     scratch, prediction);
        const FrameMemory last = remember(frame, prediction, 1);
        predictFrame(comes ? lit : stretched(before), comes ? hdp::LevelScale() : scale, usualKey(), last, scratch,
                     prediction);
        EXPECT_EQ(CONTINUED, prediction.verdict) << comes;
        EXPECT_GE(countNonZero(prediction.sources), 0.9 * prediction.sources.total()) << comes;
    }
}

TEST(HDPStereo_FramePrediction, camera_at_rest)
{
    SyntheticVideo video(Size(203, 131), 10.3, 2);
    const SyntheticFrame first = video.render(0, someBoards()), second = video.render(1, someBoards());
    VideoScratch scratch;
    FramePrediction prediction;
    predictFrame(greyOf(first), hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
    const FrameMemory last = remember(first, prediction, 1);
    predictFrame(greyOf(second), hdp::LevelScale(), usualKey(), last, scratch, prediction);
    EXPECT_EQ(CONTINUED, prediction.verdict);
    EXPECT_FALSE(prediction.isMoving());
    EXPECT_EQ(Matx44d::eye(), prediction.motion.forward);
    expectIdentical(oracle::findSources(last.grey[0], prediction.grey[0], nullptr), prediction.sources);
}

//! The image in cells with 8 bits, halved until it is at most 160 wide
TEST(HDPStereo_FramePrediction, pyramid)
{
    RNG rng(74);
    for (const Size& size : { Size(900, 41), Size(323, 200), Size(7, 5), Size(2, 2), Size(1, 5) })
    {
        FramePrediction prediction;
        VideoScratch scratch;
        const Mat left = randomImage(rng, size, CV_16UC1, 1021);
        predictFrame(left, hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
        EXPECT_EQ(FIRST, prediction.verdict);
        if (size.width < 2)
            continue;
        Mat expected;
        oracle::halve(left).convertTo(expected, CV_8U, 0.25);
        for (size_t level = 0; level < prediction.grey.size(); ++level)
        {
            if (level > 0)
                expected = oracle::halve(expected);
            expectIdentical(expected, prediction.grey[level]);
            EXPECT_EQ(expected.cols <= 160, level + 1 == prediction.grey.size());
        }
    }
}

//! Any other key or size, and nothing at all
TEST(HDPStereo_FramePrediction, first)
{
    const Size size(120, 80);
    SyntheticVideo video(size, 10, 2);
    const SyntheticFrame frame = video.render(0);
    VideoScratch scratch;
    FramePrediction prediction;
    predictFrame(greyOf(frame), hdp::LevelScale(), usualKey(), FrameMemory(), scratch, prediction);
    FrameMemory last = remember(frame, prediction, 3);
    const auto verdictOf = [&](const Mat& left, const FrameKey& key) {
        predictFrame(left, hdp::LevelScale(), key, last, scratch, prediction);
        return prediction.verdict;
    };
    EXPECT_EQ(CONTINUED, verdictOf(greyOf(frame), usualKey()));
    FrameKey others[] = { usualKey(), usualKey(), usualKey() };
    others[0].scale = 2;
    others[1].minDisparity = -1;
    others[2].maxDisparity += subpixelScale;
    for (const FrameKey& other : others)
    {
        EXPECT_EQ(FIRST, verdictOf(greyOf(frame), other));
        EXPECT_TRUE(prediction.key == other);
    }
    EXPECT_EQ(FIRST, verdictOf(greyOf(frame).rowRange(0, 70), usualKey()));
    EXPECT_EQ(CONTINUED, verdictOf(greyOf(frame), usualKey()));
    last.clear();
    EXPECT_EQ(FIRST, verdictOf(greyOf(frame), usualKey()));
}

//! Faint images have no points, and so no motion: what is left is how much they change.
TEST(HDPStereo_FramePrediction, cut)
{
    RNG rng(75);
    VideoScratch scratch;
    FramePrediction before, now;
    int cuts = 0;
    const int pairs = 100;
    for (int i = 0; i < pairs; ++i)
    {
        const Size size(40, 30);
        Mat left(size, CV_16UC1), next(size, CV_16UC1);
        const int slope = rng.uniform(1, 9), change = rng.uniform(0, 80), faint = rng.uniform(1, 5);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                left.at<ushort>(y, x) = (ushort)(100 + slope * x + rng.uniform(0, faint));
                next.at<ushort>(y, x) = (ushort)(left.at<ushort>(y, x) + (x % 40 < 20 ? change : 0));
            }
        predictFrame(left, hdp::LevelScale(), usualKey(), FrameMemory(), scratch, before);
        SyntheticFrame frame;
        frame.truth = Mat(size, CV_32F, Scalar(5));
        predictFrame(next, hdp::LevelScale(), usualKey(), remember(frame, before, 1), scratch, now);
        const bool isCut = oracle::isCut(before.grey.back(), now.grey.back());
        EXPECT_EQ(isCut ? FIRST : CONTINUED, now.verdict) << i;
        cuts += isCut;
    }
    EXPECT_GE(cuts, pairs / 5);
    EXPECT_LE(cuts, pairs - pairs / 5);
}

}} // namespace opencv_test
