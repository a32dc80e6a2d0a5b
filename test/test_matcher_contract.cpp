// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"
#include "../src/plan/pair_plan.hpp"

#include <functional>
#include <thread>

namespace opencv_test {
namespace {

const int disparities = 24;

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(121, 90), disparities, 7);
    return pair;
}

Ptr<HDPTreeMatcher> createMatcher(bool usePrediction = true, int minDisparity = 0, int numDisparities = disparities)
{
    const Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(minDisparity, numDisparities, HDPTreeMatcher::PRESET_PAPER);
    matcher->setUsePrediction(usePrediction);
    return matcher;
}

//! With and without prediction, and the other presets
const System someSystems[] = { presetPaper, paperSystems[3], presetFast, presetUltrafast, presetQuality, presetTree };

//! Every value is in range, and a whole disparity unless the matcher was asked for others.
void expectDisparities(const Mat& disparity, const HDPTreeMatcher& matcher)
{
    ASSERT_EQ(CV_16SC1, disparity.type());
    const int first = matcher.getMinDisparity(), last = first + matcher.getNumDisparities() - 1;
    for (const short d : Mat_<short>(disparity))
    {
        ASSERT_TRUE(matcher.getUseSubpixel() || d % 16 == 0) << d / 16.;
        ASSERT_TRUE(d >= 16 * first && d <= 16 * last) << d / 16.;
    }
}

////////////////////////////////////////////// parameters //////////////////////////////////////////////

TEST(HDPStereo_MatcherContract, defaults)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_PAPER);
    EXPECT_EQ(0, matcher->getMinDisparity());
    EXPECT_EQ(64, matcher->getNumDisparities());
    EXPECT_EQ(1, matcher->getBlockSize());
    EXPECT_EQ(0, matcher->getSpeckleWindowSize());
    EXPECT_LE(matcher->getDisp12MaxDiff(), 0);
    EXPECT_EQ(createMinimumSpanningTree()->getDefaultName(), matcher->getTreeStrategy()->getDefaultName());
    EXPECT_TRUE(matcher->getUsePrediction());
    EXPECT_FALSE(matcher->getUseMedianPrefilter());
    EXPECT_EQ(3, matcher->getNumLayers());
    EXPECT_EQ(0, matcher->getMaxTopDisparities());
    EXPECT_EQ(0, matcher->getMaxRowOffset());
    EXPECT_FALSE(matcher->getUseLightAlignment());
    EXPECT_EQ(0, matcher->getNoiseThreshold());
    EXPECT_TRUE(matcher->getPredictionModel().empty());
    EXPECT_EQ(HDPTreeMatcher::AUTO, matcher->getDelta0());
    EXPECT_EQ(HDPTreeMatcher::AUTO, matcher->getBeta());
    EXPECT_EQ(25.5, matcher->getGamma());
    EXPECT_EQ(10, matcher->getColorTruncation());
    EXPECT_EQ(2, matcher->getGradientTruncation());
    EXPECT_EQ(0.11, matcher->getColorWeight());
    EXPECT_EQ(HDPTreeMatcher::AUTO, matcher->getDisparityMedianSize());
    EXPECT_EQ(1, matcher->getDisparityMedianPasses());
    EXPECT_EQ((int)HDPTreeMatcher::COST_COLOR_GRADIENT, matcher->getMatchingCost());
    EXPECT_EQ((int)HDPTreeMatcher::PRIOR_SUPPORT_POINTS, matcher->getDisparityPrior());
    EXPECT_EQ(0, matcher->getIntervalMargin());
    EXPECT_FALSE(matcher->getUseSubpixel());
    EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_TREES, matcher->getAggregation());
    EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_TREES, matcher->getTopAggregation());
    EXPECT_EQ(16, matcher->getP1());
    EXPECT_EQ(65, matcher->getP2());
    EXPECT_EQ(1, matcher->getScanlinePasses());
    EXPECT_EQ(0, matcher->getFinestLayer());
    EXPECT_FALSE(matcher->getUseNonLocalRefinement());
    EXPECT_FALSE(matcher->getUseTemporalPrediction());
    EXPECT_FALSE(matcher->getFillOcclusions());

    EXPECT_EQ(serialized(*HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_FAST)),
              serialized(*HDPTreeMatcher::create()));
    EXPECT_EQ(-40, HDPTreeMatcher::create(-40, 100)->getMinDisparity());
    EXPECT_EQ(100, HDPTreeMatcher::create(-40, 100)->getNumDisparities());
    EXPECT_FALSE(matcher->getDefaultName().empty());
    EXPECT_EQ(16, (int)StereoMatcher::DISP_SCALE);
}

//! What a preset sets is all that it sets.
TEST(HDPStereo_MatcherContract, presets_by_setters)
{
    for (const System& system : presets)
        for (const System& other : presets)
        {
            const Ptr<HDPTreeMatcher> configured = createSystem(other, 33, -5);
            configure(*configured, system);
            EXPECT_EQ(serialized(*HDPTreeMatcher::create(-5, 33, system.preset)), serialized(*configured))
                << system.name << " after " << other.name;
        }
}

#define EXPECT_KEEPS(matcher, Name, ...)                                                                               \
    for (const auto value : { __VA_ARGS__ })                                                                           \
    {                                                                                                                  \
        matcher->set##Name(value);                                                                                     \
        EXPECT_EQ(value, matcher->get##Name());                                                                        \
    }

TEST(HDPStereo_MatcherContract, setters_and_getters)
{
    const Ptr<HDPTreeMatcher> matcher = createMatcher();
    EXPECT_KEEPS(matcher, MinDisparity, 5, 0, -128);
    EXPECT_KEEPS(matcher, NumDisparities, 1, 17, 64, 300);
    EXPECT_KEEPS(matcher, BlockSize, 3, 31, 1, 4, 0, -1, INT_MAX, INT_MIN);
    EXPECT_KEEPS(matcher, SpeckleWindowSize, 100, INT_MAX, -1, INT_MIN, 0);
    EXPECT_KEEPS(matcher, SpeckleRange, 2, 4000, INT_MAX, 0);
    EXPECT_KEEPS(matcher, Disp12MaxDiff, 1, 0, -1, INT_MAX);
    EXPECT_KEEPS(matcher, UsePrediction, false, true);
    EXPECT_KEEPS(matcher, UseMedianPrefilter, true, false);
    EXPECT_KEEPS(matcher, NumLayers, 1, 2, 16);
    EXPECT_KEEPS(matcher, MaxTopDisparities, 1, 64, INT_MAX, 0);
    EXPECT_KEEPS(matcher, MaxRowOffset, 1, 64, INT_MAX, 0);
    EXPECT_KEEPS(matcher, UseLightAlignment, true, false);
    EXPECT_KEEPS(matcher, NoiseThreshold, 0., 1e-3, 2.5, 300.);
    EXPECT_KEEPS(matcher, Delta0, 0., 0.064, 0.999, (double)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS(matcher, Beta, 0., 0.6, 1., (double)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS(matcher, Gamma, 1e-3, 25.5, 1e6);
    EXPECT_KEEPS(matcher, ColorTruncation, 0., 7.5, 255.);
    EXPECT_KEEPS(matcher, GradientTruncation, 0., 7.5, 255.);
    EXPECT_KEEPS(matcher, ColorWeight, 0., 0.5, 1.);
    EXPECT_KEEPS(matcher, DisparityMedianSize, 0, 3, 5, 7, (int)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS(matcher, DisparityMedianPasses, 8, 2, 1);
    EXPECT_KEEPS(matcher, MatchingCost, (int)HDPTreeMatcher::COST_CENSUS, (int)HDPTreeMatcher::COST_COLOR_GRADIENT);
    EXPECT_KEEPS(matcher, DisparityPrior, (int)HDPTreeMatcher::PRIOR_UPPER_LAYER,
                 (int)HDPTreeMatcher::PRIOR_SUPPORT_POINTS);
    EXPECT_KEEPS(matcher, IntervalMargin, 64, 1, 0);
    EXPECT_KEEPS(matcher, UseSubpixel, true, false);
    EXPECT_KEEPS(matcher, Aggregation, (int)HDPTreeMatcher::AGGREGATION_SCANLINES,
                 (int)HDPTreeMatcher::AGGREGATION_TREE_SCANLINES, (int)HDPTreeMatcher::AGGREGATION_TREES);
    EXPECT_KEEPS(matcher, TopAggregation, (int)HDPTreeMatcher::AGGREGATION_TREE_SCANLINES,
                 (int)HDPTreeMatcher::AGGREGATION_TREES);
    EXPECT_KEEPS(matcher, P1, 0, 100, 16);
    EXPECT_KEEPS(matcher, P2, 0, 100, 65);
    EXPECT_KEEPS(matcher, ScanlinePasses, 4, 2, 1);
    EXPECT_KEEPS(matcher, FinestLayer, 15, 1, 0);
    EXPECT_KEEPS(matcher, UseNonLocalRefinement, true, false);
    EXPECT_KEEPS(matcher, UseTemporalPrediction, true, false);
    EXPECT_KEEPS(matcher, TreeStrategy, createSegmentTree(), createRandomTree());
    EXPECT_KEEPS(matcher, PredictionModel, DisparityPredictionModel::create(), Ptr<DisparityPredictionModel>());
}

//! AUTO stands for the values that made the paper's tables, by the width of the image.
TEST(HDPStereo_MatcherContract, automatic_values)
{
    for (int width : { 999, 1000 })
        for (bool usePrediction : { false, true })
        {
            const SyntheticPair pair = makeSyntheticPair(Size(width, 24), 40, 8);
            const Ptr<HDPTreeMatcher> automatic = createMatcher(usePrediction, 0, 40);
            const Ptr<HDPTreeMatcher> written = createMatcher(usePrediction, 0, 40);
            const bool isLarge = width >= 1000;
            written->setDelta0(isLarge ? 0.064 : 0.004);
            written->setBeta(isLarge ? 0.6 : 0.95);
            written->setDisparityMedianSize(usePrediction ? 7 : 5);
            written->setPredictionModel(DisparityPredictionModel::createPublished(
                isLarge ? DisparityPredictionModel::PUBLISHED_LARGE : DisparityPredictionModel::PUBLISHED_SMALL));
            expectIdentical(match(*written, pair.left, pair.right), match(*automatic, pair.left, pair.right));
        }
}

struct Change
{
    const char* name;
    void (*set)(HDPTreeMatcher&);
};

// clang-format off
const Change commonChanges[] = {
    { "minDisparity", [](HDPTreeMatcher& m) { m.setMinDisparity(2); } },
    { "numDisparities", [](HDPTreeMatcher& m) { m.setNumDisparities(12); } },
    { "blockSize", [](HDPTreeMatcher& m) { m.setBlockSize(3); } },
    { "disp12MaxDiff", [](HDPTreeMatcher& m) { m.setDisp12MaxDiff(1); } },
    { "speckles", [](HDPTreeMatcher& m) { m.setSpeckleWindowSize(100), m.setSpeckleRange(1); } },
    { "treeStrategy: ST", [](HDPTreeMatcher& m) { m.setTreeStrategy(createSegmentTree(1)); } },
    { "treeStrategy: RT", [](HDPTreeMatcher& m) { m.setTreeStrategy(createRandomTree()); } },
    { "usePrediction", [](HDPTreeMatcher& m) { m.setUsePrediction(false); } },
    { "useMedianPrefilter", [](HDPTreeMatcher& m) { m.setUseMedianPrefilter(true); } },
    { "numLayers", [](HDPTreeMatcher& m) { m.setNumLayers(1); } },
    { "gamma", [](HDPTreeMatcher& m) { m.setGamma(5); } },
    { "disparityMedianSize", [](HDPTreeMatcher& m) { m.setDisparityMedianSize(0); } },
    { "disparityMedianPasses", [](HDPTreeMatcher& m) { m.setDisparityMedianPasses(4); } },
    { "useSubpixel", [](HDPTreeMatcher& m) { m.setUseSubpixel(!m.getUseSubpixel()); } },
    { "finestLayer", [](HDPTreeMatcher& m) { m.setFinestLayer(1 - m.getFinestLayer()); } },
    { "maxTopDisparities", [](HDPTreeMatcher& m) {
        m.setNumLayers(3); // all have 3 layers without a limit, and 2 with one
        m.setMaxTopDisparities(m.getMaxTopDisparities() ? 0 : 64);
    } },
};

//! What has no effect with scanlines
const Change treeChanges[] = {
    { "delta0", [](HDPTreeMatcher& m) { m.setDelta0(0.3); } },
    { "beta", [](HDPTreeMatcher& m) { m.setBeta(0.1); } },
    { "intervalMargin", [](HDPTreeMatcher& m) { m.setIntervalMargin(5); } },
    { "disparityPrior", [](HDPTreeMatcher& m) { m.setDisparityPrior(1 - m.getDisparityPrior()); } },
    { "predictionModel", [](HDPTreeMatcher& m) {
        m.setPredictionModel(DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE));
    } },
    { "useNonLocalRefinement", [](HDPTreeMatcher& m) { m.setUseNonLocalRefinement(true); } },
};

const Change topChanges[] = {
    { "topAggregation", [](HDPTreeMatcher& m) { m.setTopAggregation(2 - m.getTopAggregation()); } },
};

const Change colorAndGradientChanges[] = {
    { "colorTruncation", [](HDPTreeMatcher& m) { m.setColorTruncation(3); } },
    { "gradientTruncation", [](HDPTreeMatcher& m) { m.setGradientTruncation(8); } },
    { "colorWeight", [](HDPTreeMatcher& m) { m.setColorWeight(0.9); } },
    { "matchingCost", [](HDPTreeMatcher& m) { m.setMatchingCost(HDPTreeMatcher::COST_CENSUS), m.setBlockSize(5); } },
};

const Change scanlineChanges[] = {
    { "P1", [](HDPTreeMatcher& m) { m.setP1(3); } },
    { "P2", [](HDPTreeMatcher& m) { m.setP2(90); } },
    { "aggregation", [](HDPTreeMatcher& m) { m.setAggregation(HDPTreeMatcher::AGGREGATION_TREES); } },
};

const Change passesChanges[] = {
    { "scanlinePasses", [](HDPTreeMatcher& m) { m.setScanlinePasses(3); } },
};
// clang-format on

template <size_t count> void expectEffects(const System& system, const Change (&changes)[count], bool expected)
{
    const SyntheticPair& pair = testPair();
    const Mat unchanged = match(*createSystem(system, disparities), pair.left, pair.right);
    for (const Change& change : changes)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        change.set(*matcher);
        EXPECT_EQ(expected, countDifferent(unchanged, match(*matcher, pair.left, pair.right)) > 0)
            << system.name << ", " << change.name;
    }
}

//! Each parameter does something, where the documentation does not say that it does not.
TEST(HDPStereo_MatcherContract, parameters_have_an_effect)
{
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, disparities);
        const bool hasScanlines = matcher->getAggregation() == HDPTreeMatcher::AGGREGATION_SCANLINES;
        expectEffects(preset, commonChanges, true);
        expectEffects(preset, treeChanges, !hasScanlines);
        expectEffects(preset, topChanges, hasScanlines);
        if (matcher->getMatchingCost() == HDPTreeMatcher::COST_COLOR_GRADIENT)
            expectEffects(preset, colorAndGradientChanges, true);
        // Otherwise the top layer alone is matched.
        const bool hasLayers = matcher->getFinestLayer() == 0;
        if (matcher->getAggregation() != HDPTreeMatcher::AGGREGATION_TREES && hasLayers)
            expectEffects(preset, scanlineChanges, true);
        expectEffects(preset, passesChanges, hasScanlines && hasLayers);
    }
}

//! Passes of the median filter over disparities that no other layer depends on
TEST(HDPStereo_MatcherContract, median_passes_are_medians_of_medians)
{
    const SyntheticPair& pair = testPair();
    for (bool useSubpixel : { false, true })
        for (int size : { 3, 5, 7 })
        {
            SCOPED_TRACE(testing::Message() << "size " << size << (useSubpixel ? ", sub-pixel" : ""));
            const Ptr<HDPTreeMatcher> matcher = createMatcher(false);
            matcher->setUseSubpixel(useSubpixel);
            matcher->setDisparityMedianSize(0);
            matcher->setDisparityMedianPasses(3); // of nothing
            const Mat unfiltered = match(*matcher, pair.left, pair.right);
            matcher->setDisparityMedianPasses(1);
            expectIdentical(unfiltered, match(*matcher, pair.left, pair.right));

            Mat expected;
            unfiltered.convertTo(expected, CV_16U);
            matcher->setDisparityMedianSize(size);
            for (int passes = 1; passes <= 8; ++passes)
            {
                expected = oracle::median(expected, size);
                Mat expectedDisparity;
                expected.convertTo(expectedDisparity, CV_16S);
                matcher->setDisparityMedianPasses(passes);
                expectIdentical(expectedDisparity, match(*matcher, pair.left, pair.right));
            }
        }
}

////////////////////////////////////////////// images //////////////////////////////////////////////

TEST(HDPStereo_MatcherContract, output_type_size_and_range)
{
    const SyntheticPair& pair = testPair();
    for (const System& system : allSystems())
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        const Mat disparity = match(*matcher, pair.left, pair.right);
        EXPECT_EQ(pair.left.size(), disparity.size());
        expectDisparities(disparity, *matcher);
    }
}

TEST(HDPStereo_MatcherContract, kinds_of_arrays)
{
    const SyntheticPair& pair = testPair();
    for (const System& system : someSystems)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        const Mat left = pair.left.clone(), right = pair.right.clone();
        const Mat expected = match(*matcher, left, right);
        expectIdentical(pair.left, left); // the input is only read
        expectIdentical(pair.right, right);

        // Not continuous
        Mat canvas(Size(left.cols + 40, 2 * left.rows + 30), CV_8UC3, Scalar(1, 200, 90));
        Mat leftRegion = canvas(Rect(Point(7, 3), left.size())),
            rightRegion = canvas(Rect(Point(20, 110), left.size()));
        left.copyTo(leftRegion);
        right.copyTo(rightRegion);
        expectIdentical(expected, match(*matcher, leftRegion, rightRegion));

        expectIdentical(expected, match(*matcher, Mat3b(left), Mat3b(right)));

        // Output kept where it is
        Mat_<short> preallocated(left.size());
        const uchar* const data = preallocated.data;
        matcher->compute(left, right, preallocated);
        EXPECT_EQ(data, preallocated.data);
        expectIdentical(expected, preallocated);
        Mat frame(left.rows + 10, left.cols + 10, CV_16SC1, Scalar(77));
        Mat inFrame = frame(Rect(Point(5, 5), left.size()));
        matcher->compute(left, right, inFrame);
        expectIdentical(expected, frame(Rect(Point(5, 5), left.size())));
        frame(Rect(Point(5, 5), left.size())).setTo(77);
        EXPECT_EQ(0, cv::countNonZero(frame != 77)) << "written around the region";

        // Output of another type or size
        Mat other(3, 5, CV_32FC2);
        matcher->compute(left, right, other);
        expectIdentical(expected, other);

        // Output in the place of an input
        Mat both = left.clone();
        matcher->compute(both, right, both);
        expectIdentical(expected, both);
    }
}

//! What is around a region does not matter, in one channel no more than in three.
TEST(HDPStereo_MatcherContract, regions_of_grey_images)
{
    const Mat left = oracle::grey(testPair().left), right = oracle::grey(testPair().right);
    for (const System& system : allSystems())
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        const Rect part(9, 5, 80, 60);
        expectIdentical(match(*matcher, left(part).clone(), right(part).clone()),
                        match(*matcher, left(part), right(part)));
    }
}

typedef testing::TestWithParam<System> HDPStereo_MatcherPreset;

TEST_P(HDPStereo_MatcherPreset, umat)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities);
    const Mat expected = match(*matcher, pair.left, pair.right);
    for (int repetition = 0; repetition < 2; ++repetition)
    {
        UMat disparity;
        {
            UMat left, right; // released while the matcher lives on
            pair.left.copyTo(left);
            pair.right.copyTo(right);
            matcher->compute(left, right, disparity);
            expectIdentical(expected, match(*matcher, left, right));
            left.setTo(Scalar::all(0)); // and free to be used
            EXPECT_GT(countDifferent(expected, match(*matcher, left, right)), 0);
        }
        expectIdentical(expected, disparity.getMat(ACCESS_READ));
    }
}

//! What a caller does to its images after compute() is none of the matcher's business.
TEST_P(HDPStereo_MatcherPreset, keeps_no_hold_of_the_input)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities);
    Mat left = pair.left.clone(), right = pair.right.clone();
    const Mat expected = match(*matcher, left, right);
    EXPECT_EQ(1, left.u->refcount) << "the matcher still refers to the left image";
    EXPECT_EQ(1, right.u->refcount) << "the matcher still refers to the right image";
    left.setTo(Scalar::all(0));
    right.setTo(Scalar::all(255));
    expectIdentical(expected, match(*matcher, pair.left, pair.right));
    EXPECT_EQ(0, cv::countNonZero(left.reshape(1)));
    EXPECT_EQ(0, cv::countNonZero(right.reshape(1) != 255));
}

TEST(HDPStereo_MatcherContract, one_channel_equals_three_equal_ones)
{
    Mat left, right;
    cv::cvtColor(testPair().left, left, COLOR_BGR2GRAY);
    cv::cvtColor(testPair().right, right, COLOR_BGR2GRAY);
    Mat lefts[] = { left, left, left }, rights[] = { right, right, right };
    Mat left3, right3;
    cv::merge(lefts, 3, left3);
    cv::merge(rights, 3, right3);
    for (const System& system : allSystems())
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        const Mat one = match(*matcher, left, right), three = match(*matcher, left3, right3);
        // The mean over the channels is not exact in float.
        EXPECT_LE(countDifferent(one, three), (int)one.total() / 200);
    }
}

TEST(HDPStereo_MatcherContract, sizes_and_numbers_of_disparities)
{
    const Size sizes[] = { Size(1, 1), Size(1, 2),   Size(2, 1),   Size(1, 50),  Size(50, 1),
                           Size(2, 2), Size(3, 3),   Size(2, 50),  Size(50, 2),  Size(4, 4),
                           Size(5, 7), Size(11, 11), Size(12, 13), Size(33, 21), Size(64, 31) };
    RNG rng(28);
    for (const System& system : allSystems())
        for (const Size& size : sizes)
            for (int type : { CV_8UC1, CV_8UC3 })
                for (int count : { 1, 2, 7, 15, 16, 17, 300 })
                {
                    SCOPED_TRACE(testing::Message() << system.name << ", " << size << ", " << count << " disparities");
                    const Ptr<HDPTreeMatcher> matcher = createSystem(system, count);
                    const Mat disparity = match(*matcher, patchyImage(rng, size, type), patchyImage(rng, size, type));
                    ASSERT_EQ(size, disparity.size());
                    expectDisparities(disparity, *matcher);
                }
}

TEST(HDPStereo_MatcherContract, any_number_of_layers)
{
    const SyntheticPair& pair = testPair();
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    for (int layer = 0; layer < 15; ++layer)
        model->addLayer(std::vector<double>(1, 0.2), std::vector<double>(1, 1.5), std::vector<double>(1, 1.));
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, disparities);
        matcher->setPredictionModel(model);
        matcher->setMaxTopDisparities(0);
        for (int layers = 1; layers <= 16; ++layers)
        {
            matcher->setNumLayers(layers);
            expectDisparities(match(*matcher, pair.left, pair.right), *matcher);
            std::vector<double> ratios;
            matcher->getSearchRatios(ratios);
            EXPECT_EQ((size_t)std::min(layers, 7), ratios.size()) << "121 x 90 pixels halved 6 times are 1 x 1";
        }
    }
}

////////////////////////////////////////////// disparities //////////////////////////////////////////////

TEST(HDPStereo_MatcherContract, one_disparity)
{
    const SyntheticPair& pair = testPair();
    for (const System& system : someSystems)
        for (int minDisparity : { -7, 0, 9 })
        {
            const Mat disparity = match(*createSystem(system, 1, minDisparity), pair.left, pair.right);
            EXPECT_EQ(0, cv::countNonZero(disparity != 16 * minDisparity));
        }
}

TEST(HDPStereo_MatcherContract, more_than_256_disparities)
{
    RNG rng(29);
    const int shift = 300;
    const Mat canvas =
        patchyImage(rng, Size(640 + shift, 96), CV_8UC3, 16); // patches of two pixels in the fourth layer
    const Mat left = canvas.colRange(0, 640), right = canvas.colRange(shift, 640 + shift);
    for (const System& system : someSystems)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, 400);
        const Mat inside = match(*matcher, left, right).colRange(shift + 20, 640);
        // Sub-pixel: the winner may lean to the side whose costs are lower, by half a pixel of the finest layer.
        const Mat wrong =
            cv::abs(inside - 16 * shift) > (matcher->getUseSubpixel() ? 8 << matcher->getFinestLayer() : 0);
        // Where the finest layer has half the rows, a mistake of the layers above it takes more of them.
        const int share = matcher->getFinestLayer() > 0 ? 30 : 100;
        EXPECT_LE(cv::countNonZero(wrong), (int)inside.total() / share) << system.name;
    }
}

//! The right image moved by k columns, and the range with it: the same disparities + k, but for what the borders do.
TEST(HDPStereo_MatcherContract, min_disparity_shifts_the_range)
{
    const SyntheticPair pair = makeSyntheticPair(Size(240, 100), disparities, 9);
    for (const System& system : someSystems)
    {
        const Mat expected = match(*createSystem(system, disparities), pair.left, pair.right);
        for (int k : { 1, 6, 16, -1, -6, -16 })
        {
            SCOPED_TRACE(testing::Message() << system.name << " by " << k);
            Mat moved(pair.right.size(), pair.right.type());
            for (int x = 0; x < moved.cols; ++x)
                pair.right.col(std::max(0, std::min(x + k, moved.cols - 1))).copyTo(moved.col(x));
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities, k);
            const Mat disparity = match(*matcher, pair.left, moved);
            expectDisparities(disparity, *matcher);
            const Range inside(disparities + 20, moved.cols - 36);
            const Mat difference = disparity.colRange(inside) - expected.colRange(inside);
            // The columns that only one of the pairs has, or that are added, count in P(D_l), and so reach every pixel.
            // The squares of the sparse matches begin with the added columns.
            // Half a pixel of the finest layer
            const bool hasScanlines = matcher->getAggregation() != HDPTreeMatcher::AGGREGATION_TREES;
            const int tolerance = hasScanlines ? 8 << matcher->getFinestLayer() : 0;
            const int share = !system.usePrediction ? 200 : matcher->getUseSubpixel() ? 25 : 33;
            EXPECT_LE(cv::countNonZero(cv::abs(difference - 16 * k) > tolerance), (int)difference.total() / share);
        }
    }
}

//! With negative disparities the first columns of the left image have their matches, too, far from 0 as well.
TEST(HDPStereo_MatcherContract, negative_disparities_up_to_the_left_border)
{
    RNG rng(37);
    const int width = 300;
    for (const int shift : { 14, 64 })
    {
        const Mat canvas = patchyImage(rng, Size(width + shift, 120), CV_8UC3, 8);
        const Mat left = canvas.colRange(shift, width + shift), right = canvas.colRange(0, width);
        for (const System& system : allSystems())
            for (int minDisparity : { -shift - 17, -shift - 3 })
            {
                SCOPED_TRACE(testing::Message() << system.name << " from " << minDisparity);
                const Ptr<HDPTreeMatcher> matcher = createSystem(system, 32, minDisparity);
                const Mat wrong = cv::abs(match(*matcher, left, right) + 16 * shift) > 16;
                EXPECT_LE(cv::countNonZero(wrong.colRange(0, shift)), (int)wrong.rows * shift / 20);
                Mat confidence, trees, intervals;
                matcher->getConfidence(confidence);
                EXPECT_EQ(left.size(), confidence.size());
                EXPECT_GE(cv::mean(confidence.colRange(shift, width - shift - 64))[0], 100);
                matcher->getForest(trees, intervals);
                EXPECT_EQ(left.cols * trees.rows / left.rows, trees.cols); // of a layer of the image alone
                EXPECT_EQ(trees.size(), intervals.size());
            }
    }
}

TEST(HDPStereo_MatcherContract, equal_images_have_disparity_0)
{
    const Mat left = testPair().left;
    for (const System& system : allSystems())
        for (int minDisparity : { 0, -4 })
        {
            const bool isPaper = system.preset == HDPTreeMatcher::PRESET_PAPER;
            const Mat disparity = match(*createSystem(system, disparities, minDisparity), left, left);
            const int tolerance = isPaper ? 0 : 8; // sub-pixel
            EXPECT_LE(cv::countNonZero(cv::abs(disparity) > tolerance), (int)disparity.total() / 50)
                << system.name << " from " << minDisparity;
        }
}

////////////////////////////////////////////// filters //////////////////////////////////////////////

TEST_P(HDPStereo_MatcherPreset, disp12MaxDiff_marks_occluded_pixels)
{
    const SyntheticPair& pair = testPair();
    for (int minDisparity : { -5, 0 })
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities - minDisparity, minDisparity);
        const short invalid = (short)(16 * (minDisparity - 1));
        const Mat unfiltered = match(*matcher, pair.left, pair.right);
        EXPECT_EQ(0, cv::countNonZero(unfiltered == invalid));
        for (int maxDiff : { 0, -1, INT_MAX })
        {
            matcher->setDisp12MaxDiff(maxDiff);
            expectIdentical(unfiltered, match(*matcher, pair.left, pair.right));
        }

        matcher->setDisp12MaxDiff(1);
        const Mat filtered = match(*matcher, pair.left, pair.right);
        const Mat rejected = filtered != unfiltered;
        EXPECT_EQ(0, cv::countNonZero((filtered != invalid) & rejected)) << "changed to something else";
        const int count = cv::countNonZero(rejected);
        EXPECT_GT(count, 100);
        // At least half of them are occluded or wrong.
        int justified = 0;
        for (int y = 0; y < rejected.rows; ++y)
            for (int x = 0; x < rejected.cols; ++x)
                justified += rejected.at<uchar>(y, x) &&
                             (!pair.visible.at<uchar>(y, x) ||
                              std::abs(unfiltered.at<short>(y, x) / 16. - pair.truth.at<float>(y, x)) >= 2);
        EXPECT_GE(2 * justified, count);
    }
}

TEST_P(HDPStereo_MatcherPreset, speckles_as_filterSpeckles_removes_them)
{
    const SyntheticPair& pair = testPair();
    for (int minDisparity : { -5, 0 })
        for (int maxDiff : { -1, 1 })
        {
            const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities - minDisparity, minDisparity);
            matcher->setDisparityMedianSize(0); // leaves speckles
            matcher->setDisp12MaxDiff(maxDiff);
            Mat expected = match(*matcher, pair.left, pair.right);
            const Mat unfiltered = expected.clone();
            cv::filterSpeckles(expected, 16 * (minDisparity - 1), 60, 16 * 2);
            ASSERT_GT(countDifferent(unfiltered, expected), 0);
            matcher->setSpeckleWindowSize(60);
            matcher->setSpeckleRange(2);
            expectIdentical(expected, match(*matcher, pair.left, pair.right));
        }
}

//! cv::StereoSGBM takes any int as the window's size, and ranges that are larger than any disparity.
TEST(HDPStereo_MatcherContract, speckle_parameters_of_any_size)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createSystem(presetFast, disparities);
    const Mat unfiltered = match(*matcher, pair.left, pair.right);
    matcher->setSpeckleRange(1);
    for (int off : { 0, -1, INT_MIN })
    {
        matcher->setSpeckleWindowSize(off);
        expectIdentical(unfiltered, match(*matcher, pair.left, pair.right));
    }
    matcher->setSpeckleWindowSize(unfiltered.total() / 2);
    EXPECT_GT(countDifferent(unfiltered, match(*matcher, pair.left, pair.right)), 0);
    for (int range : { disparities, 2047, 2048, 4000, INT_MAX }) // all pixels are one speckle
    {
        matcher->setSpeckleRange(range);
        expectIdentical(unfiltered, match(*matcher, pair.left, pair.right));
    }
}

////////////////////////////////////////////// reproducible //////////////////////////////////////////////

class ThreadCount
{
public:
    ThreadCount() : before_(cv::getNumThreads()) {}
    ~ThreadCount() { cv::setNumThreads(before_); }

private:
    int before_;
};

TEST(HDPStereo_MatcherContract, any_number_of_threads)
{
    const ThreadCount restore;
    const SyntheticPair pair = makeSyntheticPair(Size(131, 270), 40, 10); // two stripes of scanlines
    for (const System& system : allSystems())
    {
        Mat expected;
        for (int threads : { 1, 2, 3, 8 })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", " << threads << " threads");
            cv::setNumThreads(threads);
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, 40);
            matcher->setDisp12MaxDiff(2);
            matcher->setSpeckleWindowSize(20);
            matcher->setSpeckleRange(1);
            const Mat disparity = match(*matcher, pair.left, pair.right);
            if (threads == 1)
                expected = disparity;
            expectIdentical(expected, disparity);
        }
    }
}

TEST(HDPStereo_MatcherContract, reused_equals_fresh)
{
    const SyntheticPair whole = makeSyntheticPair(Size(140, 270), 20, 13);
    const Ptr<HDPTreeMatcher> reused = createMatcher();
    int i = 0;
    for (const Size& size :
         { Size(90, 60), Size(31, 80), Size(2, 2), Size(40, 261), Size(90, 60), Size(131, 77), Size(1, 1) })
        for (const System& system : allSystems())
            for (bool inColor : { true, false })
            {
                SCOPED_TRACE(testing::Message() << system.name << ", " << size << (inColor ? ", colour" : ", grey"));
                const Rect part(Point(i % 5, i % 7), size);
                Mat left = whole.left(part), right = whole.right(part);
                if (!inColor)
                {
                    cv::cvtColor(left, left, COLOR_BGR2GRAY);
                    cv::cvtColor(right, right, COLOR_BGR2GRAY);
                }
                const int numDisparities = 10 + ++i % 13;
                configure(*reused, system);
                reused->setNumDisparities(numDisparities);
                const Mat disparity = match(*reused, left, right);
                expectIdentical(match(*createSystem(system, numDisparities), left, right), disparity);
                expectIdentical(disparity, match(*reused, left, right));
            }
}

TEST(HDPStereo_MatcherContract, matchers_share_nothing)
{
    const SyntheticPair& pair = testPair();
    const std::vector<System> systems = allSystems();
    std::vector<Mat> expected, actual(systems.size());
    std::vector<std::thread> threads;
    for (const System& system : systems)
        expected.push_back(match(*createSystem(system, disparities), pair.left, pair.right));
    for (size_t i = 0; i < systems.size(); ++i)
    {
        const System& system = systems[i];
        Mat& result = actual[i];
        threads.push_back(std::thread([&system, &pair, &result] {
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
            for (int repetition = 0; repetition < 3; ++repetition)
                matcher->compute(pair.left, pair.right, result);
        }));
    }
    for (std::thread& thread : threads)
        thread.join();
    for (size_t i = 0; i < systems.size(); ++i)
    {
        SCOPED_TRACE(systems[i].name);
        expectIdentical(expected[i], actual[i]);
    }
}

////////////////////////////////////////////// reports //////////////////////////////////////////////

TEST(HDPStereo_MatcherContract, search_ratios)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createMatcher();
    std::vector<double> ratios(3, 7.);
    matcher->getSearchRatios(ratios);
    EXPECT_TRUE(ratios.empty());

    match(*matcher, pair.left, pair.right);
    matcher->getSearchRatios(ratios);
    ASSERT_EQ(3u, ratios.size());
    EXPECT_EQ(1, ratios[2]) << "the top layer searches the full range";
    for (int layer = 0; layer < 2; ++layer)
        EXPECT_TRUE(ratios[layer] > 0 && ratios[layer] < 1) << ratios[layer];

    matcher->setUsePrediction(false);
    match(*matcher, pair.left, pair.right);
    matcher->getSearchRatios(ratios);
    EXPECT_EQ(std::vector<double>(1, 1.), ratios);
}

//! At least two, or three that leave the top one 16 disparities or more, and so many that it has 32 or less, 48 or 64
TEST(HDPStereo_MatcherContract, number_of_layers)
{
    for (const System& preset : presets)
        for (int numDisparities = 1; numDisparities <= 4096; ++numDisparities)
        {
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, numDisparities);
            int expected = 3;
            if (preset.preset != HDPTreeMatcher::PRESET_PAPER)
            {
                const bool isQuality = preset.preset == HDPTreeMatcher::PRESET_QUALITY;
                const bool isTree = preset.preset == HDPTreeMatcher::PRESET_TREE;
                expected = !isQuality && !isTree && numDisparities > 60 ? 3 : 2;
                for (int limit = (isTree      ? 64
                                  : isQuality ? 48
                                              : 32)
                                 << (expected - 1);
                     numDisparities > limit; limit *= 2)
                    ++expected;
            }
            const int numLayers = matcher->getNumLayers(), limit = matcher->getMaxTopDisparities();
            ASSERT_EQ(expected, hdp::chooseLayers(numDisparities, numLayers, limit, 16))
                << preset.name << ", " << numDisparities << " disparities";
            ASSERT_EQ(std::min(expected, 4), hdp::chooseLayers(numDisparities, numLayers, limit, 4));
        }
    for (int numLayers : { 1, 2, 16 })
        EXPECT_EQ(numLayers, hdp::chooseLayers(1024, numLayers, 0, 16)) << "no limit";
    EXPECT_EQ(1, hdp::chooseLayers(64, 1, 64, 16));
    EXPECT_EQ(2, hdp::chooseLayers(65, 1, 64, 16));
    EXPECT_EQ(3, hdp::chooseLayers(64, 1, 1, 16)) << "16 disparities";
    EXPECT_EQ(2, hdp::chooseLayers(60, 1, 1, 16));
    EXPECT_EQ(1, hdp::chooseLayers(30, 1, 1, 16)) << "15 in a second layer";
    EXPECT_EQ(2, hdp::chooseLayers(1, 16, INT_MAX, 16));
}

//! The image has so many layers, and no more than it has pixels for; without prediction one.
TEST(HDPStereo_MatcherContract, layers_of_an_image)
{
    const Mat image(65, 80, CV_8UC1, Scalar(7)), small(9, 8, CV_8UC1, Scalar(7));
    for (const System& system : { presetFast, presetUltrafast, presetQuality })
        for (int numDisparities : { 1, 5, 64, 129, 257, 1024, 2048 })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", " << numDisparities << " disparities");
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
            const int layers =
                hdp::chooseLayers(numDisparities, matcher->getNumLayers(), matcher->getMaxTopDisparities(), 16);
            std::vector<double> ratios, ofLayers(layers, 1.);
            for (int layer = 0; layer < layers - 1; ++layer) // 16 candidates
                ofLayers[layer] = layer < matcher->getFinestLayer()
                                      ? 0
                                      : std::min(1., 16. / (cvCeil((numDisparities - 1) / std::pow(2., layer)) + 1));
            match(*matcher, image, image);
            matcher->getSearchRatios(ratios);
            EXPECT_EQ(ofLayers, ratios);

            match(*matcher, small, small);
            matcher->getSearchRatios(ratios);
            EXPECT_EQ((size_t)std::min(layers, 4), ratios.size()) << "9 x 8 pixels halved 3 times are 1 x 1";
            matcher->setUsePrediction(false);
            match(*matcher, image, image);
            matcher->getSearchRatios(ratios);
            EXPECT_EQ(std::vector<double>(1, 1.), ratios);
        }
}

//! The finest layer's disparities are those of the result, and each layer has half the size of the one below.
TEST(HDPStereo_MatcherContract, disparities_of_layers)
{
    const SyntheticPair& pair = testPair();
    for (const System& preset : presets)
        for (int minDisparity : { 0, -5, 3 })
        {
            SCOPED_TRACE(testing::Message() << preset.name << " from " << minDisparity);
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, disparities, minDisparity);
            Mat ofLayer(3, 3, CV_8UC1);
            matcher->getLayerDisparity(0, ofLayer);
            EXPECT_TRUE(ofLayer.empty());
            matcher->setDisparityDepth(CV_32F);
            const Mat disparity = match(*matcher, pair.left, pair.right);
            std::vector<double> ratios;
            matcher->getSearchRatios(ratios);
            Mat upper;
            for (int layer = (int)ratios.size() - 1; layer >= matcher->getFinestLayer(); --layer)
            {
                matcher->getLayerDisparity(layer, ofLayer);
                ASSERT_EQ(CV_32FC1, ofLayer.type());
                ASSERT_EQ(Size(pair.left.cols >> layer, pair.left.rows >> layer), ofLayer.size());
                double least, most;
                cv::minMaxLoc(ofLayer, &least, &most);
                EXPECT_TRUE(least >= 0 && most <= (disparities - 1) / std::pow(2., layer)) << least << " .. " << most;
                if (!upper.empty()) // most of the pixels have about twice the disparity of the pixel above them
                {
                    Mat predicted;
                    cv::resize(upper * 2, predicted, ofLayer.size(), 0, 0, INTER_NEAREST);
                    EXPECT_LE(cv::countNonZero(cv::abs(predicted - ofLayer) > 2), (int)ofLayer.total() / 4);
                }
                upper = ofLayer.clone();
            }
            if (matcher->getFinestLayer() == 0)
            {
                expectIdentical(disparity, Mat(ofLayer + minDisparity));
            }
            else
            {
                matcher->getLayerDisparity(0, ofLayer);
                EXPECT_TRUE(ofLayer.empty()) << "of a layer that was not matched";
            }
            matcher->getLayerDisparity((int)ratios.size(), ofLayer);
            EXPECT_TRUE(ofLayer.empty()) << "of more layers than there are";
        }
}

//! What there is to ask after compute(), but for its disparities
struct Reports
{
    Mat confidence, trees, intervals;
    std::vector<Mat> layers;
    std::vector<std::vector<double>> priors;
    std::vector<double> ratios, times;
    std::vector<String> stages;

    explicit Reports(const HDPTreeMatcher& matcher) : layers(3), priors(3)
    {
        matcher.getConfidence(confidence);
        matcher.getForest(trees, intervals);
        matcher.getSearchRatios(ratios);
        matcher.getStageTimes(stages, times);
        for (int layer = 0; layer < 3; ++layer)
        {
            matcher.getLayerDisparity(layer, layers[layer]);
            matcher.getLayerPrior(layer, priors[layer]);
        }
    }

    size_t empty() const
    {
        size_t count =
            confidence.empty() + trees.empty() + intervals.empty() + ratios.empty() + stages.empty() + times.empty();
        for (int layer = 0; layer < 3; ++layer)
            count += layers[layer].empty() + priors[layer].empty();
        return count;
    }
};

//! Nothing is left of the pair before, whatever compute() has thrown for.
TEST_P(HDPStereo_MatcherPreset, no_reports_after_an_exception)
{
    const SyntheticPair& pair = testPair();
    const System& system = GetParam();
    const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
    const size_t all = 12;
    EXPECT_EQ(all, Reports(*matcher).empty()) << "before the first pair";
    const Ptr<DisparityPredictionModel> noLayers = DisparityPredictionModel::create();
    Mat disparity;
    Mat_<double> fixedType;
    const std::function<void()> bad[] = {
        [&] { matcher->compute(pair.left, Mat(), disparity); },
        [&] { matcher->compute(pair.left, pair.right.rowRange(0, 9), disparity); },
        [&] { matcher->compute(pair.left, pair.right, fixedType); },
        [&] {
        matcher->setMinDisparity(INT_MAX);
        matcher->compute(pair.left, pair.right, disparity);
        },
        [&] {
        matcher->setAggregation(HDPTreeMatcher::AGGREGATION_TREES);
        matcher->setPredictionModel(noLayers);
        matcher->compute(pair.left, pair.right, disparity);
    },
                                };
    for (const std::function<void()>& compute : bad)
    {
        configure(*matcher, system);
        matcher->setMinDisparity(0);
        matcher->setPredictionModel(Ptr<DisparityPredictionModel>());
        match(*matcher, pair.left, pair.right);
        EXPECT_LE(Reports(*matcher).empty(), 5u);
        EXPECT_THROW(compute(), cv::Exception);
        EXPECT_EQ(all, Reports(*matcher).empty());
    }
}

TEST(HDPStereo_MatcherContract, arrays_that_are_not_needed)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createMatcher();
    for (int repetition = 0; repetition < 2; ++repetition) // before and after compute()
    {
        Mat trees, intervals, both[2];
        EXPECT_NO_THROW(matcher->getForest(trees, noArray()));
        EXPECT_NO_THROW(matcher->getForest(noArray(), intervals));
        EXPECT_NO_THROW(matcher->getForest(noArray(), noArray()));
        matcher->getForest(both[0], both[1]);
        EXPECT_EQ(repetition == 0, trees.empty() && intervals.empty());
        if (repetition > 0)
        {
            expectIdentical(both[0], trees);
            expectIdentical(both[1], intervals);
        }
        match(*matcher, pair.left, pair.right);
    }
    std::vector<double> prior;
    EXPECT_THROW(matcher->getLayerDisparity(-1, noArray()), cv::Exception);
    EXPECT_THROW(matcher->getLayerPrior(-1, prior), cv::Exception);
}

TEST_P(HDPStereo_MatcherPreset, stage_times)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities);
    std::vector<String> stages(2, "none"), again;
    std::vector<double> times(3, 7.);
    matcher->getStageTimes(stages, times);
    EXPECT_TRUE(stages.empty() && times.empty());
    for (int repetition = 0; repetition < 2; ++repetition)
    {
        const int64 start = cv::getTickCount();
        match(*matcher, pair.left, pair.right);
        const double all = (double)(cv::getTickCount() - start) * 1000 / cv::getTickFrequency();
        again = stages;
        matcher->getStageTimes(stages, times);
        ASSERT_EQ(stages.size(), times.size());
        EXPECT_GE(stages.size(), 5u);
        double sum = 0;
        for (size_t i = 0; i < stages.size(); ++i)
        {
            EXPECT_FALSE(stages[i].empty());
            EXPECT_EQ(1, std::count(stages.begin(), stages.end(), stages[i])) << stages[i];
            EXPECT_GE(times[i], 0) << stages[i];
            sum += times[i];
        }
        EXPECT_TRUE(sum > 0 && sum <= all + 0.1) << sum << " of " << all << " ms";
    }
    EXPECT_EQ(again, stages);
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_MatcherPreset, testing::ValuesIn(presets));

} // namespace
} // namespace opencv_test
