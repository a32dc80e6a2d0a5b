// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"

#include "../src/pair/block_smoothing.hpp"
#include "../src/pair/image_levels.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

using hdp::BlockGrid;

Mat compress(const Mat& image, int quality)
{
    std::vector<uchar> bytes;
    cv::imencode(".jpg", image, bytes, { cv::IMWRITE_JPEG_QUALITY, quality });
    return cv::imdecode(bytes, IMREAD_UNCHANGED);
}

Mat greyOf(const Mat& image)
{
    Mat grey;
    hdp::greyLevels(image, hdp::LevelScale(), grey);
    return grey;
}

//! Shaded, with texture that is as faint as noise
Mat bareWall(Size size, int seed)
{
    RNG rng(seed);
    Mat wall(size, CV_8U);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            wall.at<uchar>(y, x) = (uchar)(90 + 60 * x / size.width + 30 * y / size.height + rng.uniform(0, 3));
    return wall;
}

TEST(HDPStereo_BlockSmoothing, finds_where_blocks_begin)
{
    const Mat wall = bareWall(Size(240, 160), 1), compressed = compress(wall, 40);
    EXPECT_EQ(0, hdp::findBlocks(greyOf(wall)).step);
    for (int cut = 0; cut < BlockGrid::side; ++cut)
    {
        const BlockGrid grid = hdp::findBlocks(greyOf(compressed.colRange(cut, 230)));
        EXPECT_EQ((BlockGrid::side - cut) % BlockGrid::side, grid.begin);
        EXPECT_GE(grid.step, hdp::greyScale / 4);
        EXPECT_LE(grid.step, 5 * hdp::greyScale);
    }
}

//! Of levels that were stretched after the compression, as if they were not
TEST(HDPStereo_BlockSmoothing, blocks_of_any_contrast)
{
    const Mat grey = greyOf(compress(bareWall(Size(240, 160), 1), 40));
    const BlockGrid grid = hdp::findBlocks(grey);
    double darkest;
    cv::minMaxLoc(grey, &darkest);
    for (int gain = 2; gain <= 4; gain *= 2)
    {
        const BlockGrid stretched = hdp::findBlocks(Mat((grey - darkest) * gain), gain);
        EXPECT_EQ(grid.begin, stretched.begin);
        EXPECT_NEAR(gain * grid.step, stretched.step, 1e-9);
    }
}

TEST(HDPStereo_BlockSmoothing, finds_none_in_other_images)
{
    RNG rng(2);
    for (const Size size : { Size(1, 1), Size(5, 9), Size(9, 5), Size(300, 200) })
    {
        EXPECT_EQ(0, hdp::findBlocks(greyOf(randomImage(rng, size, CV_8UC1))).step);
        EXPECT_EQ(0, hdp::findBlocks(greyOf(randomImage(rng, size, CV_8UC1, 4))).step);
        EXPECT_EQ(0, hdp::findBlocks(greyOf(patchyImage(rng, size, CV_8UC3))).step);
        EXPECT_EQ(0, hdp::findBlocks(greyOf(patchyImage(rng, size, CV_8UC1, 8))).step);
        EXPECT_EQ(0, hdp::findBlocks(Mat(size, CV_16U, Scalar(200))).step);
    }
    EXPECT_EQ(0, hdp::findBlocks(greyOf(makeSyntheticPair(Size(320, 240), 64, 1).left)).step);
}

//! Levels of floor((x + slant y + phase) / period), as a faint slope has them, with some noise
Mat contours(Size size, int period, int slant, int phase, int noise, RNG& rng)
{
    Mat wall(size, CV_8U);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const int changed = noise > 0 && rng.uniform(0, 100) < noise;
            wall.at<uchar>(y, x) = (uchar)(60 + (x + slant * y + phase) / period + changed);
        }
    return wall;
}

TEST(HDPStereo_BlockSmoothing, contours_of_a_slope_are_none)
{
    RNG rng(5);
    for (int period : { 8, 16, 24, 40 })
        for (int slant = 0; slant <= 4; ++slant)
            for (int phase = 0; phase < BlockGrid::side; ++phase)
                for (int noise : { 0, 3 })
                {
                    const Mat wall = contours(Size(320, 240), period, slant, phase, noise, rng);
                    SCOPED_TRACE(testing::Message() << "period " << period << ", slant " << slant << ", " << phase);
                    EXPECT_EQ(0, hdp::findBlocks(greyOf(wall)).step);
                    EXPECT_EQ(0, hdp::findBlocks(greyOf(wall.t())).step);
                }
}

//! The mean of steps between flat pixels at one column in eight, and the ratio to those at the others
Vec2d meanStep(const Mat& image, int begin)
{
    double sums[2] = { 0, 0 }, numbers[2] = { 0, 0 };
    for (int y = 0; y < image.rows; ++y)
        for (int x = 3; x + 2 < image.cols; ++x)
        {
            const auto change = [&](int at) {
                return std::abs((double)image.at<ushort>(y, at) - image.at<ushort>(y, at - 1));
            };
            if (change(x - 2) > 2 || change(x - 1) > 2 || change(x + 1) > 2 || change(x + 2) > 2 || change(x) > 80)
                continue;
            const int isOther = x % BlockGrid::side != begin;
            sums[isOther] += change(x);
            numbers[isOther] += 1;
        }
    const double mean = sums[0] / std::max(numbers[0], 1.);
    return Vec2d(mean, numbers[0] < 64 ? 0 : mean / std::max(sums[1] / std::max(numbers[1], 1.), 1. / 64));
}

//! The more is changed inside of blocks, the less sure they are: no jump
TEST(HDPStereo_BlockSmoothing, weak_blocks_count_less)
{
    int seen[3] = { 0, 0, 0 }; // none, weak and sure ones
    for (int seed = 0; seed < 8; ++seed)
        for (double step = 1; step < 16; step += 0.5)
        {
            RNG rng(seed);
            const int begin = seed, size = 32; // all rows and columns tell
            Mat grey(size, size, CV_16U), levels(size, size, CV_64F);
            rng.fill(levels, RNG::UNIFORM, 0, 2 * step);
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x)
                    grey.at<ushort>(y, x) =
                        (ushort)(500 + levels.at<double>((y + 8 - begin) / 8, (x + 8 - begin) / 8) + rng.uniform(0, 3));
            const Vec2d across = meanStep(grey, begin), down = meanStep(grey.t(), begin);
            const double share = std::min(std::max((std::min(across[1], down[1]) - 4.5) / 1.5, 0.), 1.);
            const BlockGrid grid = hdp::findBlocks(grey);
            EXPECT_TRUE(share == 0 || grid.begin == begin);
            EXPECT_NEAR(share * across[0], grid.step, 1e-9) << "seed " << seed << ", step " << step;
            ++seen[share == 0 ? 0 : share < 1 ? 1 : 2];
        }
    EXPECT_TRUE(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
}

//! Between strips of texture, contours one level apart are all that there is.
TEST(HDPStereo_BlockSmoothing, contours_are_matched)
{
    const int numDisparities = 32;
    for (int preset : { +HDPTreeMatcher::PRESET_FAST, +HDPTreeMatcher::PRESET_QUALITY })
        for (int seed = 0; seed < 8; ++seed)
        {
            RNG rng(seed);
            const Size size(400, 240);
            const int disparity = rng.uniform(2, numDisparities - 2);
            Mat wall = contours(size + Size(numDisparities, 0), 8, 0, seed, 0, rng);
            for (int x = 0; x + 16 <= wall.cols; x += 96)
            {
                const Mat strip = wall.colRange(x, x + 16);
                strip += randomImage(rng, strip.size(), CV_8U, 40);
            }
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, preset);
            Mat map;
            match(*matcher, wall.colRange(0, size.width), wall.colRange(disparity, disparity + size.width))
                .colRange(numDisparities, size.width)
                .convertTo(map, CV_32F, 1. / 16);
            EXPECT_LE(countNonZero(abs(map - disparity) >= 1), 0.005 * map.total())
                << "preset " << preset << ", disparity " << disparity << ", phase " << seed;
        }
}

//! Blocks of one level each, but for small changes
Mat blocks(Size size, int begin, RNG& rng)
{
    const int side = BlockGrid::side;
    Mat grey(size, CV_16U), levels(size.height / side + 2, size.width / side + 2, CV_16U);
    for (int i = 0; i < (int)levels.total(); ++i)
        levels.at<ushort>(i / levels.cols, i % levels.cols) =
            (ushort)(500 + rng.uniform(0, 16) + (rng.uniform(0, 8) == 0 ? 60 : 0)); // some edges of a scene
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            grey.at<ushort>(y, x) =
                (ushort)(levels.at<ushort>(y / side, (x + side - begin) / side) + rng.uniform(0, 2));
    return grey;
}

//! From the formula
void makeRamps(Mat& grey, int begin, double mean)
{
    const Mat before = grey.clone();
    for (int y = 0; y < grey.rows; ++y)
        for (int x = 4; x + 4 <= grey.cols; ++x)
        {
            if (x % BlockGrid::side != begin)
                continue;
            const ushort* const row = before.ptr<ushort>(y);
            const double beside = 0.5 * (row[x - 1] - row[x - 2] + row[x + 1] - row[x]),
                         step = row[x] - row[x - 1] - beside;
            if (std::abs(step) >= 4 * mean)
                continue;
            for (int i = 0; i < 4; ++i)
            {
                const int part = cvFloor(step * (7 - 2 * i) / 16 + 0.5);
                grey.at<ushort>(y, x - 1 - i) = (ushort)(row[x - 1 - i] + part);
                grey.at<ushort>(y, x + i) = (ushort)(row[x + i] - part);
            }
        }
}

TEST(HDPStereo_BlockSmoothing, steps_become_ramps)
{
    RNG rng(3);
    for (int begin = 0; begin < BlockGrid::side; ++begin)
    {
        Mat left = blocks(Size(203, 70), begin, rng), right = blocks(left.size(), (begin + 3) % BlockGrid::side, rng);
        ASSERT_GT(hdp::findBlocks(left).step, 0);
        ASSERT_GT(hdp::findBlocks(right).step, 0);
        Mat expectedLeft = left.clone(), expectedRight = right.clone();
        makeRamps(expectedLeft, begin, hdp::findBlocks(left).step);
        makeRamps(expectedRight, (begin + 3) % BlockGrid::side, hdp::findBlocks(right).step);
        hdp::smoothBlocks(left, right, hdp::findBlocks(left), hdp::findBlocks(right));
        expectIdentical(expectedLeft, left);
        expectIdentical(expectedRight, right);
    }
}

TEST(HDPStereo_BlockSmoothing, needs_blocks_in_both_images)
{
    RNG rng(4);
    const Mat some = blocks(Size(200, 100), 0, rng), none = randomImage(rng, some.size(), CV_16UC1, 1000);
    Mat left = some.clone(), right = none.clone();
    hdp::smoothBlocks(left, right, hdp::findBlocks(left), hdp::findBlocks(right));
    hdp::smoothBlocks(right, left, hdp::findBlocks(right), hdp::findBlocks(left));
    expectIdentical(some, left);
    expectIdentical(none, right);
}

//! Faint texture, which the compression leaves little of: 25 in place of 40 percent
TEST(HDPStereo_BlockSmoothing, compressed_pairs_match_better)
{
    double with = 0, without = 0;
    for (int seed = 1; seed <= 4; ++seed)
    {
        const SyntheticPair pair = makeSlantedPlane(Size(480, 360), 64, seed);
        const Mat left = compress(pair.left * 0.2 + Scalar::all(80), 30),
                  right = compress(pair.right * 0.2 + Scalar::all(80), 30);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
        with += badPixels(match(*matcher, left, right), pair.truth, pair.visible, 2);
        matcher->setNoiseThreshold(0);
        without += badPixels(match(*matcher, left, right), pair.truth, pair.visible, 2);
    }
    EXPECT_LE(with, 0.7 * without);
}

}} // namespace opencv_test
