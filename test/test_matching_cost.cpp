// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/disparity_prediction.hpp"

namespace opencv_test {
namespace {

using hdp::MatchingCost;
using hdp::MatchingCostParams;

const MatchingCostParams paperParams = { false, 10, 2, 0.11f, 1 };

//! What the cost may be off: the library holds gradients in 1/32 levels. For images of one channel that is exact.
double toleranceOf(int channels, const MatchingCostParams& params)
{
    return channels == 1 ? 1e-5 : (1 - params.colorWeight) / 32 + 1e-5;
}

template <int lanes, typename Formula>
void expectFormula(const MatchingCost& cost, const Formula& formula, Size size, int candidates, double tolerance)
{
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int first = 0; first < candidates; first += 3) // any first candidate, not multiples of lanes only
            {
                float costs[lanes];
                const int pixel = y * size.width + x;
                cost.evaluate(&pixel, 1, first, lanes, costs);
                for (int k = 0; k < lanes && first + k < candidates; ++k)
                    ASSERT_NEAR(formula(y, x, first + k), costs[k], tolerance + 1e-6 * costs[k])
                        << lanes << " lanes, y " << y << " x " << x << " candidate " << first + k;
            }
}

void testCost(const Mat& left, const Mat& right, int candidates, const MatchingCostParams& params)
{
    SCOPED_TRACE(testing::Message() << left.size() << ", channels " << left.channels() << ", candidates " << candidates
                                    << ", block " << params.blockSize);
    MatchingCost cost;
    cost.prepare(left, right, candidates, params);
    const oracle::Cost formula(left, right, params);
    const double tolerance = toleranceOf(left.channels(), params);
    expectFormula<4>(cost, formula, left.size(), candidates, tolerance);
    expectFormula<8>(cost, formula, left.size(), candidates, tolerance);
    expectFormula<16>(cost, formula, left.size(), candidates, tolerance);
    expectFormula<32>(cost, formula, left.size(), candidates, tolerance);
}

// channels, blockSize
typedef testing::TestWithParam<tuple<int, int>> HDPStereo_MatchingCost;

TEST_P(HDPStereo_MatchingCost, formula_per_pixel)
{
    MatchingCostParams params = paperParams;
    params.blockSize = get<1>(GetParam());
    const int type = CV_8UC(get<0>(GetParam()));
    RNG rng(4);
    for (const Size& size : { Size(1, 1), Size(1, 5), Size(5, 1), Size(2, 2), Size(23, 9) })
    {
        testCost(randomImage(rng, size, type), randomImage(rng, size, type), 13, params);
        // Small differences, below the truncations
        testCost(randomImage(rng, size, type, 5), randomImage(rng, size, type, 5), size.width + 10, params);
    }
}

TEST_P(HDPStereo_MatchingCost, truncations_and_weight)
{
    const int type = CV_8UC(get<0>(GetParam()));
    RNG rng(5);
    const Mat left = randomImage(rng, Size(15, 6), type, 60), right = randomImage(rng, Size(15, 6), type, 60);
    const float settings[][3] = { { 0, 2, 0.5f }, { 30, 0, 0.5f }, { 30, 25, 0 }, { 30, 25, 1 }, { 1e6f, 150, 0.3f } };
    for (const float* s : settings)
    {
        const MatchingCostParams params = { false, s[0], s[1], s[2], get<1>(GetParam()) };
        testCost(left, right, 9, params);
    }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_MatchingCost,
                        testing::Combine(testing::Values(1, 3), testing::Values(1, 3, 5)));

TEST(HDPStereo_MatchingCostInput, prepared_again_for_another_pair)
{
    RNG rng(6);
    MatchingCost cost;
    for (int type : { CV_8UC3, CV_8UC1, CV_8UC3 })
        for (const Size& size : { Size(20, 8), Size(7, 12) })
        {
            const Mat left = randomImage(rng, size, type), right = randomImage(rng, size, type);
            cost.prepare(left, right, size.width, paperParams);
            expectFormula<8>(cost, oracle::Cost(left, right, paperParams), size, size.width,
                             toleranceOf(left.channels(), paperParams));
        }
}

TEST(HDPStereo_MatchingCostInput, regions_of_interest)
{
    RNG rng(7);
    const Mat left = randomImage(rng, Size(30, 20), CV_8UC3), right = randomImage(rng, Size(30, 20), CV_8UC3);
    testCost(left(Rect(3, 2, 17, 8)), right(Rect(6, 5, 17, 8)), 9, paperParams);
}

//! Edges at the border that differ are not alike, however strong they are.
TEST(HDPStereo_MatchingCostInput, strong_edges_at_the_border)
{
    const Mat left = Mat_<uchar>({ 1, 4 }, { 10, 210, 30, 130 }), right = Mat_<uchar>({ 1, 4 }, { 10, 130, 30, 230 });
    testCost(left, right, 4, paperParams);
}

//////////////////////////////////////////// census ////////////////////////////////////////////

MatchingCostParams censusParams(int blockSize)
{
    MatchingCostParams params = paperParams;
    params.census = true;
    params.blockSize = blockSize;
    return params;
}

//! Images of grey levels, see hdp::greyLevels()
Mat randomLevels(RNG& rng, Size size, int levels = 1021) { return randomImage(rng, size, CV_16UC1, levels); }

void testCensus(const Mat& left, const Mat& right, int candidates, int blockSize)
{
    SCOPED_TRACE(testing::Message() << left.size() << ", candidates " << candidates << ", block " << blockSize);
    MatchingCost cost;
    cost.prepare(left, right, candidates, censusParams(blockSize));
    const oracle::CensusCost formula(left, right, blockSize);
    expectFormula<4>(cost, formula, left.size(), candidates, 0);
    expectFormula<8>(cost, formula, left.size(), candidates, 0);
    expectFormula<16>(cost, formula, left.size(), candidates, 0);
    expectFormula<32>(cost, formula, left.size(), candidates, 0);
}

typedef testing::TestWithParam<int> HDPStereo_CensusCost; // blockSize

TEST_P(HDPStereo_CensusCost, definition_per_pixel)
{
    RNG rng(30);
    for (const Size& size : { Size(1, 1), Size(1, 5), Size(5, 1), Size(2, 2), Size(3, 4), Size(23, 9) })
        for (int levels : { 2, 5, 1021 }) // with few levels many pixels are as dark as the centre
            for (int candidates : { 1, 6, size.width + 10 })
                testCensus(randomLevels(rng, size, levels), randomLevels(rng, size, levels), candidates, GetParam());
}

//! Levels that differ in a quarter, of any brightness
TEST_P(HDPStereo_CensusCost, faint_texture)
{
    const Size size(20, 9);
    RNG rng(36);
    for (int brightness : { 0, 254, 510, 1018 })
        testCensus(randomLevels(rng, size, 3) + brightness, randomLevels(rng, size, 3) + 1018 - brightness, 12,
                   GetParam());
}

TEST_P(HDPStereo_CensusCost, regions_of_interest)
{
    RNG rng(31);
    const Mat left = randomLevels(rng, Size(30, 20)), right = randomLevels(rng, Size(30, 20));
    testCensus(left(Rect(3, 2, 17, 8)), right(Rect(6, 5, 17, 8)), 9, GetParam());
}

//! Every compared pixel differs: the most that the cost can be.
TEST_P(HDPStereo_CensusCost, largest_cost)
{
    const int blockSize = GetParam();
    Mat left(9, 9, CV_16UC1, Scalar::all(400)), right(9, 9, CV_16UC1, Scalar::all(400));
    left.at<ushort>(4, 4) = 800; // brighter than all around, in the right image darker
    right.at<ushort>(4, 4) = 200;
    MatchingCost cost;
    cost.prepare(left, right, 4, censusParams(blockSize));
    float costs[4];
    const int centre = 4 * left.cols + 4;
    cost.evaluate(&centre, 1, 0, 4, costs);
    EXPECT_EQ(blockSize * blockSize / 2, costs[0]);
    testCensus(left, right, 4, blockSize);
}

//! The rows of bytes for those that compare them themselves: as many bits differ as the cost tells; and the grey levels,
//! in whole ones. There are 32 bytes more than candidates.
TEST_P(HDPStereo_CensusCost, planes)
{
    const int blockSize = GetParam(), candidates = 13, behind = 32;
    RNG rng(34);
    for (const Size& size : { Size(1, 1), Size(5, 3), Size(70, 4) })
    {
        const Mat left = randomLevels(rng, size), right = randomLevels(rng, size);
        MatchingCost cost;
        cost.prepare(left, right, candidates, censusParams(blockSize));
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
                        for (int bit = 0; bit < 8; ++bit)
                            different += differences >> bit & 1;
                    }
                    const int level = cost.rightPlane(cost.planes(), y)[size.width - 1 - x + d];
                    if (d < candidates)
                    {
                        ASSERT_EQ(formula(y, x, d), different) << "y " << y << " x " << x << " candidate " << d;
                        ASSERT_EQ(right.at<ushort>(y, std::max(x - d, 0)) / 4, level) << "y " << y << " x " << x - d;
                        ASSERT_EQ(left.at<ushort>(y, x) / 4, cost.leftPixels(y)[4 * x + MatchingCost::greyByte]);
                    }
                }
    }
    MatchingCost color;
    const Mat image(4, 4, CV_8UC3, Scalar::all(0));
    color.prepare(image, image, candidates, paperParams);
    EXPECT_EQ(0, color.planes());
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_CensusCost, testing::Values(3, 5, 7));

//! A monotone change of one image's grey levels changes nothing.
TEST(HDPStereo_MatchingCostInput, census_is_the_same_for_any_exposure)
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
        MatchingCost before, after;
        before.prepare(left, right, candidates, censusParams(blockSize));
        after.prepare(left, exposed, candidates, censusParams(blockSize));
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

//! Pixels in any order, several times, as a tree's walk may have them
TEST(HDPStereo_MatchingCostInput, many_pixels_at_once)
{
    RNG rng(35);
    const Size size(37, 11);
    for (const MatchingCostParams& params : { paperParams, censusParams(3), censusParams(5), censusParams(7) })
    {
        const int type = params.census ? CV_16UC1 : CV_8UC3;
        MatchingCost cost;
        cost.prepare(randomImage(rng, size, type), randomImage(rng, size, type), 40, params);
        std::vector<int> pixels(500);
        for (int& pixel : pixels)
            pixel = rng.uniform(0, size.area());
        for (int lanes : { 4, 8, 16, 32 })
        {
            std::vector<float> all(pixels.size() * lanes), one(lanes);
            cost.evaluate(pixels.data(), (int)pixels.size(), 5, lanes, all.data());
            for (size_t i = 0; i < pixels.size(); ++i)
            {
                cost.evaluate(&pixels[i], 1, 5, lanes, one.data());
                for (int k = 0; k < lanes; ++k)
                    ASSERT_EQ(one[k], all[i * lanes + k]) << lanes << " lanes, pixel " << pixels[i];
            }
        }
    }
}

//! An object changes between the costs.
TEST(HDPStereo_MatchingCostInput, prepared_again_for_another_cost)
{
    RNG rng(33);
    MatchingCost cost;
    for (int repetition = 0; repetition < 2; ++repetition)
        for (int type : { CV_8UC3, CV_8UC1 })
            for (const Size& size : { Size(20, 8), Size(7, 12) })
            {
                const Mat left = randomImage(rng, size, type), right = randomImage(rng, size, type);
                cost.prepare(left, right, size.width, paperParams);
                expectFormula<8>(cost, oracle::Cost(left, right, paperParams), size, size.width,
                                 toleranceOf(left.channels(), paperParams));
                const Mat leftGrey = oracle::greyLevels(left), rightGrey = oracle::greyLevels(right);
                cost.prepare(leftGrey, rightGrey, size.width, censusParams(5));
                expectFormula<8>(cost, oracle::CensusCost(leftGrey, rightGrey, 5), size, size.width, 0);
            }
}

TEST(HDPStereo_MatchingCostCensus, of_one_candidate_a_pixel)
{
    RNG rng(48);
    const Size size(37, 21);
    const int numDisparities = 50;
    const Mat left = randomImage(rng, size, CV_16UC1, 1021), right = randomImage(rng, size, CV_16UC1, 1021);
    for (int blockSize : { 3, 5, 7 })
    {
        const hdp::MatchingCostParams params = { true, 0, 0, 0, blockSize };
        hdp::MatchingCost cost;
        cost.prepare(left, right, numDisparities, params);
        const oracle::CensusCost census(left, right, blockSize);
        Mat disparity = randomImage(rng, size, CV_16UC1, (numDisparities - 1) * hdp::subpixelScale + 1), costs;
        cost.censusCosts(disparity, costs);
        Mat expected(size, CV_8UC1);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                expected.at<uchar>(y, x) = (uchar)census(y, x, hdp::wholeDisparity(disparity.at<ushort>(y, x)));
        expectIdentical(expected, costs);
    }
}

} // namespace
} // namespace opencv_test
