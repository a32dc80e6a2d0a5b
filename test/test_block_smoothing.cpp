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
    hdp::greyLevels(image, 8, grey);
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

//! Blocks of one level each, but for small changes
Mat blocks(Size size, int begin, RNG& rng)
{
    Mat grey(size, CV_16U);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0, level = 0; x < size.width; ++x)
        {
            if (x == 0 || x % BlockGrid::side == begin)
                level = 500 + rng.uniform(0, 16) + (rng.uniform(0, 8) == 0 ? 60 : 0); // some edges of a scene
            grey.at<ushort>(y, x) = (ushort)(level + rng.uniform(0, 2));
        }
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

//! Faint texture, which the compression leaves little of
TEST(HDPStereo_BlockSmoothing, compressed_pairs_match_better)
{
    double with = 0, without = 0;
    for (int seed = 1; seed <= 4; ++seed)
    {
        const SyntheticPair pair = makeSlantedPlane(Size(480, 360), 64, seed);
        const Mat left = compress(pair.left * 0.1 + Scalar::all(100), 40),
                  right = compress(pair.right * 0.1 + Scalar::all(100), 40);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
        with += badPixels(match(*matcher, left, right), pair.truth, pair.visible, 2);
        matcher->setNoiseThreshold(0);
        without += badPixels(match(*matcher, left, right), pair.truth, pair.visible, 2);
    }
    EXPECT_LE(with, 0.85 * without);
}

}} // namespace opencv_test
