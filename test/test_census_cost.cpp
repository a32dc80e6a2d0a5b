// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "matching_costs.hpp"
#include "oracles.hpp"
#include "../src/base/units.hpp"

namespace opencv_test { namespace {

using hdp::CensusCost;

//! Images of grey levels, see hdp::greyLevels()
Mat randomLevels(RNG& rng, Size size, int levels = 1021) { return randomImage(rng, size, CV_16UC1, levels); }

//! cost: may have been prepared for another pair.
void testCost(const Mat& left, const Mat& right, int candidates, int blockSize, CensusCost& cost, int tolerance = 0)
{
    SCOPED_TRACE(testing::Message() << left.size() << ", candidates " << candidates << ", block " << blockSize
                                    << ", tolerance " << tolerance);
    cost.prepare(left, right, candidates, blockSize, tolerance);
    expectFormula(cost, oracle::CensusCost(left, right, blockSize, tolerance), left.size(), candidates, 0);
}

void testCost(const Mat& left, const Mat& right, int candidates, int blockSize, int tolerance = 0)
{
    CensusCost cost;
    testCost(left, right, candidates, blockSize, cost, tolerance);
}

typedef testing::TestWithParam<int> HDPStereo_CensusCost; // blockSize

TEST_P(HDPStereo_CensusCost, definition_per_pixel)
{
    RNG rng(30);
    for (const Size& size : { Size(1, 1), Size(1, 5), Size(5, 1), Size(2, 2), Size(3, 4), Size(23, 9) })
        for (int levels : { 2, 5, 1021 }) // with few levels many pixels are as dark as the centre
            for (int candidates : { 1, 6, size.width + 10 })
            {
                const Mat left = randomLevels(rng, size, levels), right = randomLevels(rng, size, levels);
                testCost(left, right, candidates, GetParam());
            }
}

//! Levels that differ in a quarter, of any brightness
TEST_P(HDPStereo_CensusCost, faint_texture)
{
    const Size size(20, 9);
    RNG rng(36);
    for (int brightness : { 0, 254, 510, 1018 })
    {
        const Mat left = randomLevels(rng, size, 3) + brightness,
                  right = randomLevels(rng, size, 3) + 1018 - brightness;
        testCost(left, right, 12, GetParam());
    }
}

//! Levels below the tolerance, too, and the largest one, with which all pixels are alike
TEST_P(HDPStereo_CensusCost, tolerance)
{
    const Size size(23, 11);
    RNG rng(37);
    for (int levels : { 4, 1021 })
        for (int tolerance : { 1, 3, 40, (int)CensusCost::mostTolerance })
            testCost(randomLevels(rng, size, levels), randomLevels(rng, size, levels), 9, GetParam(), tolerance);
}

TEST_P(HDPStereo_CensusCost, regions_of_interest)
{
    RNG rng(31);
    const Mat left = randomLevels(rng, Size(30, 20)), right = randomLevels(rng, Size(30, 20));
    testCost(left(Rect(3, 2, 17, 8)), right(Rect(6, 5, 17, 8)), 9, GetParam());
}

//! Every compared pixel differs: the most that the cost can be.
TEST_P(HDPStereo_CensusCost, largest_cost)
{
    const int blockSize = GetParam();
    Mat left(9, 9, CV_16UC1, Scalar::all(400)), right(9, 9, CV_16UC1, Scalar::all(400));
    left.at<ushort>(4, 4) = 800; // brighter than all around, in the right image darker
    right.at<ushort>(4, 4) = 200;
    CensusCost cost;
    cost.prepare(left, right, 4, blockSize);
    float costs[4];
    const int centre = 4 * left.cols + 4;
    cost.evaluate(&centre, 1, 0, 4, costs);
    EXPECT_EQ(blockSize * blockSize / 2, costs[0]);
    testCost(left, right, 4, blockSize);
}

//! The rows of bytes that others compare: as many bits differ as the cost tells, in each plane as many as of its
//! comparisons; and grey levels, in whole ones. There are 32 bytes more than candidates.
TEST_P(HDPStereo_CensusCost, planes)
{
    const int blockSize = GetParam(), candidates = 13, behind = 32;
    RNG rng(34);
    for (const Size& size : { Size(1, 1), Size(5, 3), Size(70, 4) })
    {
        const Mat left = randomLevels(rng, size), right = randomLevels(rng, size);
        CensusCost cost;
        cost.prepare(left, right, candidates, blockSize);
        ASSERT_EQ(blockSize == 7 ? 3 : blockSize == 5 ? 2 : 1, cost.planes());
        const oracle::CensusCost formula(left, right, blockSize);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                for (int d = 0; d < candidates + behind; ++d)
                {
                    int different = 0;
                    for (int plane = 0; plane < cost.planes(); ++plane)
                    {
                        const int differences =
                            cost.leftPixels(y)[4 * x + plane] ^ cost.rightPlane(plane, y)[size.width - 1 - x + d];
                        int ofPlane = 0;
                        for (int bit = 0; bit < 8; ++bit)
                            ofPlane += differences >> bit & 1;
                        if (d < candidates)
                        {
                            ASSERT_EQ(formula.count(y, x, d, plane, cost.planes()), ofPlane)
                                << "y " << y << " x " << x << " candidate " << d << " plane " << plane;
                        }
                        different += ofPlane;
                    }
                    const int level = cost.rightPlane(cost.planes(), y)[size.width - 1 - x + d];
                    if (d < candidates)
                    {
                        ASSERT_EQ(formula(y, x, d), different) << "y " << y << " x " << x << " candidate " << d;
                        ASSERT_EQ(right.at<ushort>(y, std::max(x - d, 0)) / 4, level) << "y " << y << " x " << x - d;
                        ASSERT_EQ(left.at<ushort>(y, x) / 4, cost.leftPixels(y)[4 * x + CensusCost::greyByte]);
                    }
                }
    }
}

TEST_P(HDPStereo_CensusCost, many_pixels_at_once)
{
    RNG rng(35);
    const Size size(37, 11);
    const Mat left = randomLevels(rng, size), right = randomLevels(rng, size);
    CensusCost cost;
    cost.prepare(left, right, 40, GetParam());
    expectManyAtOnce(cost, size);
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_CensusCost, testing::Values(3, 5, 7));

TEST(HDPStereo_CensusCostInput, prepared_again_for_another_pair)
{
    RNG rng(33);
    CensusCost cost;
    for (int blockSize : { 7, 3, 5 })
        for (const Size& size : { Size(20, 8), Size(7, 12) })
        {
            const Mat left = randomLevels(rng, size), right = randomLevels(rng, size);
            testCost(left, right, size.width, blockSize, cost);
        }
}

//! A monotone change of one image's grey levels changes nothing.
TEST(HDPStereo_CensusCostInput, census_is_the_same_for_any_exposure)
{
    const int candidates = 11, count = 400; // of grey levels
    RNG rng(32);
    const Size size(25, 14);
    const Mat left = randomLevels(rng, size, count), right = randomLevels(rng, size, count);
    std::vector<ushort> levels;
    for (int i = 0, level = 0; i < count; ++i, level += rng.uniform(1, 3))
        levels.push_back((ushort)level);
    Mat exposed = right.clone();
    for (ushort& level : Mat_<ushort>(exposed))
        level = levels[level];
    ASSERT_GT(countDifferent(right, exposed), 0);
    for (int blockSize : { 3, 5, 7 })
    {
        CensusCost before, after;
        before.prepare(left, right, candidates, blockSize);
        after.prepare(left, exposed, candidates, blockSize);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                float expected[8], actual[8];
                const int pixel = y * size.width + x;
                before.evaluate(&pixel, 1, 3, 8, expected);
                after.evaluate(&pixel, 1, 3, 8, actual);
                for (int k = 0; k < 8; ++k)
                    ASSERT_EQ(expected[k], actual[k]) << "y " << y << " x " << x << " candidate " << 3 + k;
            }
    }
}

TEST(HDPStereo_CensusCostInput, of_disparities)
{
    RNG rng(48);
    const Size size(37, 21);
    const int numDisparities = 50;
    const Mat left = randomImage(rng, size, CV_16UC1, 1021), right = randomImage(rng, size, CV_16UC1, 1021);
    for (int blockSize : { 3, 5, 7 })
    {
        CensusCost cost;
        cost.prepare(left, right, numDisparities, blockSize);
        const oracle::CensusCost census(left, right, blockSize);
        Mat disparity = randomImage(rng, size, CV_16UC1, (numDisparities - 1) * hdp::subpixelScale + 1), costs;
        cost.ofDisparities(disparity, costs);
        Mat expected(size, CV_8UC1);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                expected.at<uchar>(y, x) = (uchar)census(y, x, hdp::wholeDisparity(disparity.at<ushort>(y, x)));
        expectIdentical(expected, costs);
    }
}

}} // namespace opencv_test
