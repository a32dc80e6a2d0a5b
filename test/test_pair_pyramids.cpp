// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/pair/image_levels.hpp"
#include "../src/pair/pair_pyramids.hpp"

namespace opencv_test { namespace {

//! The image with more columns on the left, moved: extended(x) = image(x - extension - shift), the nearest column where
//! there is none.
Mat moved(const Mat& image, int extension, int shift)
{
    Mat result(image.rows, image.cols + extension, image.type());
    for (int x = 0; x < result.cols; ++x)
        image.col(oracle::clamped(x - extension - shift, image.cols)).copyTo(result.col(x));
    return result;
}

//! A picture whose levels are below a limit
Mat darkImage(RNG& rng, Size size, int type, int levels)
{
    if (CV_MAT_DEPTH(type) == CV_16U)
        return randomImage(rng, size, type, levels * 256);
    return randomImage(rng, size, type, levels);
}

//! The same level in all channels
Mat withoutColours(const Mat& image)
{
    std::vector<Mat> channels;
    Mat grey;
    split(image, channels);
    merge(std::vector<Mat>(channels.size(), channels[0]), grey);
    return grey;
}

TEST(HDPStereo_PairPyramids, layers_of_both_images)
{
    RNG rng(52);
    for (int round = 0; round < 48; ++round)
    {
        const int types[] = { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 }, type = types[round % 4];
        const int levels = round % 3 == 0 ? 256 : round % 3 == 1 ? 110 : 50;
        const Size size(rng.uniform(9, 40), rng.uniform(9, 40));
        const int minDisparity = rng.uniform(-8, 9), extension = minDisparity < 0 ? rng.uniform(0, 3) * 4 : 0;
        const hdp::PyramidPlan plan = { minDisparity, extension, 3, round % 5 != 0, false, 0, round % 5 != 0 };
        SCOPED_TRACE(testing::Message() << "round " << round << ", type " << type << ", " << size);
        Mat left = darkImage(rng, size, type, levels), right = darkImage(rng, size, type, levels);
        const bool isGrey = left.channels() == 1 || round % 7 == 0;
        if (isGrey && left.channels() > 1)
            left = withoutColours(left);
        const Mat extendedLeft = moved(left, plan.extension, 0);
        const Mat extendedRight = moved(right, plan.extension, plan.minDisparity);

        hdp::LevelScale scale(hdp::bitsInUse(left, right));
        Mat grey[2], buffer[2];
        if (plan.isCensus)
            hdp::findEnds(left, right, hdp::PairMasks(), scale);
        hdp::greyLevels(extendedLeft, scale, grey[0]);
        hdp::greyLevels(extendedRight, scale, grey[1]);
        if (plan.isCensus)
            scale.brightness = hdp::findBrightness(grey[0], grey[1]);
        hdp::greyLevels(extendedLeft, scale, grey[0]);
        hdp::greyLevels(extendedRight, scale, grey[1]);
        Mat colours = hdp::byteLevels(extendedLeft, scale, buffer[0]).clone();
        Mat costs[2] = { plan.isCensus ? grey[0] : colours,
                         plan.isCensus ? grey[1] : hdp::byteLevels(extendedRight, scale, buffer[1]).clone() };

        hdp::PairPyramids pyramids;
        std::vector<hdp::LayerImages> images;
        hdp::buildPairPyramids(left, right, hdp::PairMasks(), plan, pyramids, images);
        EXPECT_EQ(scale.brightness, pyramids.levels.scale.brightness);
        EXPECT_EQ(scale.black, pyramids.levels.scale.black);
        EXPECT_EQ(scale.white, pyramids.levels.scale.white);
        ASSERT_EQ((size_t)plan.layers, images.size());
        for (const hdp::LayerImages& layer : images)
        {
            expectIdentical(colours, layer.colours);
            expectIdentical(plan.isCensus && isGrey ? costs[0] : colours, layer.guide);
            expectIdentical(costs[0], layer.left);
            expectIdentical(costs[1], layer.right);
            colours = oracle::halve(colours);
            costs[0] = oracle::halve(costs[0]);
            costs[1] = oracle::halve(costs[1]);
        }
    }
}

}} // namespace opencv_test
