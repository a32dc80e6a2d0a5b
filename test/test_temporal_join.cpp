// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "video_oracles.hpp"

namespace opencv_test { namespace {

using namespace hdp;

const int candidates = 24;

//! A random frame after a random one, of a pair whose matches are known
struct RandomFrames
{
    Mat left, right, measured;
    FrameMemory last;
    FramePrediction prediction;

    //! wrong: share of the last disparities that are anything
    RandomFrames(Size size, bool isStill, int scale, int frames, double wrong, RNG& rng)
        : left(randomImage(rng, size, CV_16UC1, 40)), right(left.clone()), measured(size, CV_16U)
    {
        const int maxDisparity = (candidates - 1) * subpixelScale;
        last.frames = frames;
        last.disparity.create(size, CV_16U);
        last.detail.create(size, CV_8U);
        prediction.verdict = CONTINUED;
        prediction.key.scale = scale;
        prediction.key.maxDisparity = maxDisparity;
        prediction.motion.isStill = isStill;
        if (!isStill)
        {
            prediction.motion.forward(0, 3) = rng.uniform(-3, 4);
            prediction.motion.forward(3, 2) = rng.uniform(-0.002, 0.002);
        }
        prediction.backward = BackwardMotion(prediction.motion, 0, candidates - 1);
        prediction.grey.push_back(randomImage(rng, Size(7, 5), CV_8UC1));
        const int base = rng.uniform(0, maxDisparity / 2);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int surface = base + (x / 9 + y / 7) % 3 * 40;
                measured.at<ushort>(y, x) = disparity(surface, 0.05, maxDisparity, rng);
                last.disparity.at<ushort>(y, x) = disparity(surface, wrong, maxDisparity, rng);
                const int count = rng.uniform(0, 16); // of frames, and GUESS
                last.detail.at<uchar>(y, x) =
                    (uchar)(rng.uniform(last.disparity.at<ushort>(y, x) ? 0 : 8, 16) * 16 + count);
                if (x >= surface / subpixelScale)
                    right.at<ushort>(y, x - surface / subpixelScale) = left.at<ushort>(y, x);
            }
        move(size, rng);
    }

private:
    static ushort disparity(int surface, double wrong, int maxDisparity, RNG& rng)
    {
        const bool isWrong = rng.uniform(0., 1.) < wrong;
        return (ushort)(isWrong ? rng.uniform(0, maxDisparity + 1)
                                : std::min(std::max(surface + rng.uniform(-10, 11), 0), maxDisparity));
    }

    //! Shifts of a few pixels, some unknown, and sources
    void move(Size size, RNG& rng)
    {
        FrameWarp& warp = prediction.warp;
        warp.size = size;
        warp.shifts.create((size.height + 3) / 4, (size.width + 3) / 4, CV_16SC2);
        rng.fill(warp.shifts, RNG::UNIFORM, -3, 4);
        for (int i = 0; i < warp.shifts.rows; ++i)
            for (int j = 0; j < warp.shifts.cols; ++j)
                if (rng.uniform(0, 10) == 0)
                    warp.shifts.at<Vec2s>(i, j) = Vec2s(FrameWarp::unknown, 0);
        prediction.sources.create(size.height / 2, size.width / 2, CV_8U);
        for (int i = 0; i < prediction.sources.rows; ++i)
            for (int j = 0; j < prediction.sources.cols; ++j)
            {
                const bool mayMove = !prediction.motion.isStill && oracle::isKnown(warp, 2 * j, 2 * i);
                prediction.sources.at<uchar>(i, j) =
                    (uchar)(rng.uniform(0, 4) & (mayMove ? SAME_PLACE | MOVED_PLACE : +SAME_PLACE));
            }
    }
};

//! In memory of other sizes, too
TEST(HDPStereo_TemporalJoin, oracle)
{
    RNG rng(61);
    VideoScratch scratch;
    FrameMemory next;
    int counts[CONTRADICTED + 1] = { 0 };
    for (int i = 0; i < 240; ++i)
    {
        const Size size = i % 5 ? Size(rng.uniform(2, 60), rng.uniform(2, 45)) : Size(rng.uniform(60, 90), 80);
        const bool isStill = i % 3 == 0;
        const int blockSize = 3 + 2 * (i % 4 % 3), scale = 1 << i % 3, frames = 1 + i % 2 * 3;
        const double wrong = rng.uniform(0., 0.8);
        SCOPED_TRACE(cv::format("%d: %d x %d, block %d", i, size.width, size.height, blockSize));
        const RandomFrames random(size, isStill, scale, frames, wrong, rng);
        const oracle::CensusCost census(random.left, random.right, blockSize);
        oracle::TemporalJoin expected;
        const int comparisons = blockSize * blockSize / 2;
        const bool contradicts = expected(census, comparisons, random.last, random.prediction, random.measured);

        CensusCost cost;
        cost.prepare(random.left, random.right, candidates, blockSize);
        Mat disparity = random.measured.clone();
        const Verdict verdict = joinLastFrame(cost, random.last, random.prediction, scratch, next, disparity);
        ++counts[verdict];
        ASSERT_EQ(contradicts ? CONTRADICTED : CONTINUED, verdict);
        ASSERT_EQ(contradicts, next.isEmpty());
        expectIdentical(contradicts ? random.measured : expected.disparity, disparity);
        if (contradicts)
            continue;
        expectIdentical(expected.disparity, next.disparity);
        expectIdentical(expected.detail, next.detail);
        expectIdentical(random.prediction.grey[0], next.grey[0]);
        EXPECT_EQ(frames + 1, next.frames);
        EXPECT_TRUE(next.key == random.prediction.key);
        EXPECT_EQ(random.prediction.motion.forward, next.motion.forward);
    }
    EXPECT_GE(counts[CONTINUED], 40);
    EXPECT_GE(counts[CONTRADICTED], 20);
}

//! A first frame is remembered as it is; one of less than a cell is not.
TEST(HDPStereo_TemporalJoin, first)
{
    RNG rng(62);
    for (const Size& size : { Size(23, 14), Size(2, 2), Size(1, 9), Size(9, 1) })
    {
        RandomFrames random(size, true, 1, 3, 0, rng);
        random.prediction.verdict = FIRST;
        CensusCost cost;
        VideoScratch scratch;
        FrameMemory next;
        Mat disparity = random.measured.clone();
        EXPECT_EQ(FIRST, joinLastFrame(cost, random.last, random.prediction, scratch, next, disparity));
        expectIdentical(random.measured, disparity);
        const bool isRemembered = std::min(size.width, size.height) >= FrameMemory::cell;
        EXPECT_EQ(isRemembered ? 1 : 0, next.frames);
        if (!isRemembered)
            continue;
        expectIdentical(random.measured, next.disparity);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int measured = random.measured.at<ushort>(y, x), detail = next.detail.at<uchar>(y, x);
                EXPECT_EQ(measured * FrameMemory::scale / subpixelScale, FrameMemory::finer(measured, detail));
                EXPECT_EQ(1, detail & FrameMemory::countMask);
                EXPECT_EQ((measured + 8) / 16 > x, (detail & FrameMemory::GUESS) != 0);
            }
    }
}

}} // namespace opencv_test
