// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "matching_costs.hpp"
#include "oracles.hpp"

namespace opencv_test { namespace {

using hdp::ColorGradientCost;
using hdp::ColorGradientParams;

const ColorGradientParams paperParams = { 10, 2, 0.11f, 1 };

//! What the cost may be off: the library holds gradients in 1/32 levels. For images of one channel that is exact.
double toleranceOf(int channels, const ColorGradientParams& params)
{
    return channels == 1 ? 1e-5 : (1 - params.colorWeight) / 32 + 1e-5;
}

//! cost: may have been prepared for another pair.
void testCost(const Mat& left, const Mat& right, int candidates, const ColorGradientParams& params,
              ColorGradientCost& cost)
{
    SCOPED_TRACE(testing::Message() << left.size() << ", channels " << left.channels() << ", candidates " << candidates
                                    << ", block " << params.blockSize);
    cost.prepare(left, right, candidates, params);
    expectFormula(cost, oracle::ColorGradientCost(left, right, params), left.size(), candidates,
                  toleranceOf(left.channels(), params));
}

void testCost(const Mat& left, const Mat& right, int candidates, const ColorGradientParams& params)
{
    ColorGradientCost cost;
    testCost(left, right, candidates, params, cost);
}

// channels, blockSize
typedef testing::TestWithParam<tuple<int, int>> HDPStereo_ColorGradientCost;

TEST_P(HDPStereo_ColorGradientCost, formula_per_pixel)
{
    ColorGradientParams params = paperParams;
    params.blockSize = get<1>(GetParam());
    const int type = CV_8UC(get<0>(GetParam()));
    RNG rng(4);
    for (const Size& size : { Size(1, 1), Size(1, 5), Size(5, 1), Size(2, 2), Size(23, 9) })
        for (int levels : { 256, 5 }) // small differences are below the truncations
        {
            const Mat left = randomImage(rng, size, type, levels), right = randomImage(rng, size, type, levels);
            testCost(left, right, levels == 256 ? 13 : size.width + 10, params);
        }
}

TEST_P(HDPStereo_ColorGradientCost, truncations_and_weight)
{
    const int type = CV_8UC(get<0>(GetParam()));
    RNG rng(5);
    const Mat left = randomImage(rng, Size(15, 6), type, 60), right = randomImage(rng, Size(15, 6), type, 60);
    const float settings[][3] = { { 0, 2, 0.5f }, { 30, 0, 0.5f }, { 30, 25, 0 }, { 30, 25, 1 }, { 1e6f, 150, 0.3f } };
    for (const float* s : settings)
    {
        const ColorGradientParams params = { s[0], s[1], s[2], get<1>(GetParam()) };
        testCost(left, right, 9, params);
    }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_ColorGradientCost,
                        testing::Combine(testing::Values(1, 3), testing::Values(1, 3, 5)));

TEST(HDPStereo_ColorGradientCostInput, prepared_again_for_another_pair)
{
    RNG rng(6);
    ColorGradientCost cost;
    for (int type : { CV_8UC3, CV_8UC1, CV_8UC3 })
        for (const Size& size : { Size(20, 8), Size(7, 12) })
        {
            const Mat left = randomImage(rng, size, type), right = randomImage(rng, size, type);
            testCost(left, right, size.width, paperParams, cost);
        }
}

TEST(HDPStereo_ColorGradientCostInput, regions_of_interest)
{
    RNG rng(7);
    const Mat left = randomImage(rng, Size(30, 20), CV_8UC3), right = randomImage(rng, Size(30, 20), CV_8UC3);
    testCost(left(Rect(3, 2, 17, 8)), right(Rect(6, 5, 17, 8)), 9, paperParams);
}

//! Edges at the border that differ are not alike, however strong they are.
TEST(HDPStereo_ColorGradientCostInput, strong_edges_at_the_border)
{
    const Mat left = Mat_<uchar>({ 1, 4 }, { 10, 210, 30, 130 }), right = Mat_<uchar>({ 1, 4 }, { 10, 130, 30, 230 });
    testCost(left, right, 4, paperParams);
}

TEST(HDPStereo_ColorGradientCostInput, many_pixels_at_once)
{
    RNG rng(35);
    const Size size(37, 11);
    const Mat left = randomImage(rng, size, CV_8UC3), right = randomImage(rng, size, CV_8UC3);
    ColorGradientCost cost;
    cost.prepare(left, right, 40, paperParams);
    expectManyAtOnce(cost, size);
}

}} // namespace opencv_test
