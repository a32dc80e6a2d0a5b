// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/video/temporal_prior.hpp"

namespace opencv_test { namespace {

using namespace hdp;

const int candidates = 20, flatCost = 60; // of all candidates, in units of the volume
const int side = 4;                       // of the volume's pixels
const Size layerSize(64, 48);

//! A volume whose costs are all the same
CostVolume flatVolume(Size size)
{
    CostVolume volume;
    volume.create(size, candidates, 1);
    volume.costs.assign(volume.total(), (uchar)flatCost);
    return volume;
}

//! What the last frame's disparity adds to the cost of a candidate
int penalty(double disparity, int candidate, int largest = 6 * CostVolume::scale)
{
    return std::min(std::max(cvRound(CostVolume::scale * (std::abs(candidate - disparity) - 1)), 0), largest);
}

//! The third frame of a video: everything moved to the left by a cell, and nothing else is known to be as it was.
struct MovedVideo
{
    explicit MovedVideo(ushort disparity)
    {
        last.frames = 2;
        last.disparity = Mat(layerSize, CV_16U, Scalar(disparity));
        last.detail = Mat(layerSize, CV_8U, Scalar(2)); // frames
        next.verdict = CONTINUED;
        next.key.scale = 1;
        next.key.maxDisparity = side * candidates * subpixelScale;
        next.motion.isStill = false;
        next.motion.forward(0, 3) = -FrameMemory::cell;
        next.backward = BackwardMotion(next.motion, 0, side * candidates);
        next.warp.size = layerSize;
        next.warp.shifts = Mat(layerSize / (int)FrameWarp::block, CV_16SC2, Scalar(FrameMemory::cell, 0));
        next.sources = Mat(layerSize / (int)FrameMemory::cell, CV_8U, Scalar(0));
    }
    FrameMemory last;
    FramePrediction next;
};

//! As a layer does it; means over trees are asked first.
void prefer(const MovedVideo& video, bool areMeans, CostVolume& volume)
{
    Mat predicted;
    predictDisparities(video.last, video.next, side, volume.size, predicted);
    const bool isRefused = areMeans && refusesLastFrame(volume, predicted);
    EXPECT_FALSE(isRefused);
    preferPredicted(predicted, volume);
}

void expectCosts(const CostVolume& volume, int x, int y, double disparity)
{
    const uchar* costs = &volume.costs[volume.start(y * volume.size.width + x)];
    for (int k = 0; k < candidates; ++k)
        EXPECT_EQ(flatCost + (disparity < 0 ? 0 : penalty(disparity, k)), costs[k]) << Point(x, y) << ", " << k;
}

//! In columns of the volume: where the motion leads, at the same place, at both with one disparity or with two, new
TEST(HDPStereo_TemporalPrior, sources)
{
    const double moved = 10, unmoved = 5, nearby = 10.5; // in pixels of the volume
    const int places[] = { MOVED_PLACE, SAME_PLACE, MOVED_PLACE | SAME_PLACE, MOVED_PLACE | SAME_PLACE, 0 };
    const double there[] = { unmoved, unmoved, nearby, unmoved, unmoved },
                 expected[] = { moved, unmoved, moved, -1, -1 };
    MovedVideo video(0);
    for (int i = 0; i < 5; ++i)
    {
        const int x = 3 * i * side + side / 2, half = side / 2; // one column of the volume in three is looked at
        video.next.sources.colRange((x - half) / FrameMemory::cell, (x + half) / FrameMemory::cell).setTo(places[i]);
        video.last.disparity.col(x).setTo(there[i] * side * subpixelScale);
        video.last.disparity.col(x + FrameMemory::cell).setTo(moved * side * subpixelScale);
    }
    for (bool areMeans : { false, true })
    {
        CostVolume volume = flatVolume(layerSize / side);
        prefer(video, areMeans, volume);
        for (int y = 0; y < volume.size.height; ++y)
            for (int i = 0; i < 5; ++i)
                expectCosts(volume, 3 * i, y, expected[i]);
    }
}

//! What only one pair has had, or none has shown, predicts nothing, neither at the same place nor where the motion leads.
TEST(HDPStereo_TemporalPrior, unconfirmed)
{
    for (int count : { 1, 5 | FrameMemory::GUESS })
        for (int place : { SAME_PLACE, MOVED_PLACE })
        {
            MovedVideo video(10 * side * subpixelScale);
            video.next.sources.setTo(place);
            const int x = 5, from = x * side + side / 2 + (place == MOVED_PLACE ? FrameMemory::cell : 0);
            video.last.detail.col(from).setTo(FrameMemory::detailOf(15, count));
            Mat predicted;
            predictDisparities(video.last, video.next, side, layerSize / side, predicted);
            for (int y = 0; y < predicted.rows; ++y)
                for (int k = 0; k < predicted.cols; ++k)
                    EXPECT_EQ(k == x ? -1 : 10, predicted.at<float>(y, k)) << Point(k, y);
        }
}

//! Means that contradict stay, other costs do not.
TEST(HDPStereo_TemporalPrior, contradiction)
{
    MovedVideo video(10 * side * subpixelScale);
    video.next.sources.setTo(MOVED_PLACE);
    for (bool areMeans : { false, true })
    {
        CostVolume volume = flatVolume(layerSize / side);
        volume.costs[15] = (uchar)(flatCost - CostVolume::contradiction - 1);
        const std::vector<uchar> before = volume.costs;
        prefer(video, areMeans, volume);
        for (int k = 0; k < candidates; ++k)
            EXPECT_EQ(before[k] + (areMeans ? 0 : penalty(10, k)), volume.costs[k]) << k;
        expectCosts(volume, 1, 0, 10);
    }
}

//! The costs of more than a tenth of the predicted pixels refuse the last frame; what is not predicted has no say.
TEST(HDPStereo_TemporalPrior, contradicted_frame)
{
    MovedVideo video(10 * side * subpixelScale);
    video.next.sources.rowRange(0, 12).setTo(MOVED_PLACE); // 96 pixels of the volume
    const auto contradicts = [&](int refused, int rise, bool areBeside) {
        CostVolume volume = flatVolume(layerSize / side);
        for (int i = 0; i < refused; ++i)
            volume.costs[volume.start(i + (areBeside ? 96 : 0)) + 3] = (uchar)(flatCost - rise);
        Mat predicted;
        predictDisparities(video.last, video.next, side, volume.size, predicted);
        return refusesLastFrame(volume, predicted);
    };
    const int rise = CostVolume::contradiction + 1;
    EXPECT_FALSE(contradicts(0, rise, false));
    EXPECT_FALSE(contradicts(9, rise, false));
    EXPECT_TRUE(contradicts(10, rise, false));
    EXPECT_FALSE(contradicts(96, rise - 1, false)) << "by less";
    EXPECT_FALSE(contradicts(96, rise, true)) << "of pixels that are not predicted";
    video.next.motion.isStill = true;
    video.next.sources.rowRange(0, 12).setTo(SAME_PLACE);
    EXPECT_TRUE(contradicts(10, rise, false)) << "a camera at rest";
}

//! None before a second pair has agreed, and none if nothing moves.
TEST(HDPStereo_TemporalPrior, predictsDisparities)
{
    for (int frames : { 1, 2, 3 })
        for (bool isStill : { false, true })
            for (Verdict verdict : { FIRST, CONTINUED })
            {
                MovedVideo video(0);
                video.last.frames = frames;
                video.next.motion.isStill = isStill;
                video.next.verdict = verdict;
                EXPECT_EQ(frames > 1 && !isStill && verdict == CONTINUED, predictsDisparities(video.last, video.next));
            }
}

TEST(HDPStereo_CostVolume, prefer)
{
    const int largest = 12;
    CostVolume volume = flatVolume(Size(3, 1));
    const auto costsOf = [&](int pixel) { return &volume.costs[volume.start(pixel)]; };
    costsOf(2)[0] = 250;
    const std::vector<uchar> before = volume.costs;
    for (int pixel : { 0, 2 })
        preferDisparity(pixel, 7.25, largest, volume);
    for (int k = 0; k < candidates; ++k)
    {
        const int rise = penalty(7.25, k, largest);
        EXPECT_EQ(flatCost + rise, costsOf(0)[k]);
        EXPECT_EQ(before[volume.start(1) + k], costsOf(1)[k]) << "of another pixel";
        EXPECT_EQ(std::min(before[volume.start(2) + k] + rise, 255), costsOf(2)[k]);
    }
    preferDisparity(0, 1e6, largest, volume); // beyond the candidates, whose costs all rise by as much
    EXPECT_EQ(flatCost + largest + largest, costsOf(0)[0]);
    EXPECT_EQ(flatCost + largest + largest, costsOf(0)[candidates - 1]);

    volume.costs = before;
    volume.steps = 2; // candidates per pixel of disparity
    preferDisparity(0, 7.25 / 2, largest, volume);
    for (int k = 0; k < candidates; ++k)
        EXPECT_EQ(flatCost + penalty(7.25, k, largest), costsOf(0)[k]);
}

//! More candidates than 16 bits hold units of
TEST(HDPStereo_CostVolume, prefer_of_many)
{
    const int many = 9000, largest = 12;
    const float disparity = 8123.25f;
    CostVolume volume;
    volume.create(Size(1, 1), many, 1);
    volume.costs.assign(volume.total(), (uchar)flatCost);
    preferDisparity(0, disparity, largest, volume);
    for (int k = 0; k < many; ++k)
        ASSERT_EQ(flatCost + penalty(disparity, k, largest), volume.costs[k]) << k;
}

TEST(HDPStereo_CostVolume, contradicts)
{
    CostVolume volume = flatVolume(Size(2, 1));
    const int best = 15;
    uchar* const costs = &volume.costs[0];
    costs[best] = (uchar)(flatCost - CostVolume::contradiction);
    EXPECT_FALSE(isContradicted(0, 7.25f, volume));
    costs[best] = (uchar)(flatCost - CostVolume::contradiction - 1);
    EXPECT_TRUE(isContradicted(0, 7.25f, volume));
    EXPECT_TRUE(isContradicted(0, 1e6, volume)) << "beyond the candidates";
    EXPECT_TRUE(isContradicted(0, -1e6, volume)) << "beyond the candidates";
    EXPECT_FALSE(isContradicted(0, best - 0.5f, volume)) << "the nearest candidate is the best";
    EXPECT_TRUE(isContradicted(0, best - 0.6f, volume));
    EXPECT_FALSE(isContradicted(1, 7.25f, volume)) << "another pixel";
}

//! In memory that held a larger volume before, too
TEST(HDPStereo_CostVolume, fill)
{
    RNG rng(5);
    CostVolume volume;
    for (int blockSize : { 7, 5, 3 })
        for (const Size& imageSize : { Size(70, 5), Size(9, 4) })
        {
            const int count = imageSize.width / 2 + 1;
            Mat left(imageSize, CV_16UC1), right(imageSize, CV_16UC1);
            rng.fill(left, RNG::UNIFORM, 0, 5);
            rng.fill(right, RNG::UNIFORM, 0, 5);
            CensusCost ofLayer;
            ofLayer.prepare(left, right, count, blockSize);
            const TwoLayerCost cost(ofLayer, nullptr);
            const oracle::CensusCost census(left, right, blockSize);
            volume.fill(cost, imageSize, count);
            EXPECT_EQ(imageSize, volume.size);
            EXPECT_EQ(count, volume.numDisparities);
            ASSERT_LE(volume.total(), volume.costs.size());
            for (int pixel = 0; pixel < imageSize.area(); ++pixel)
            {
                const Point at(pixel % imageSize.width, pixel / imageSize.width);
                for (int k = 0; k < count; ++k)
                    ASSERT_EQ(CostVolume::scale * census(at.y, at.x, k), volume.costs[volume.start(pixel) + k])
                        << at << ", " << k;
            }
        }
}

}} // namespace opencv_test
