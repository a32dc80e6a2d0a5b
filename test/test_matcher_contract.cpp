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

namespace opencv_test { namespace {

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
    change(*matcher, [&](Params& p) { p.usePrediction = usePrediction; });
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
        ASSERT_TRUE(matcher.getParams().useSubpixel || d % 16 == 0) << d / 16.;
        ASSERT_TRUE(d >= 16 * first && d <= 16 * last) << d / 16.;
    }
}

////////////////////////////////////////////// parameters //////////////////////////////////////////////

TEST(HDPStereo_MatcherContract, defaults)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_PAPER);
    const Params params = matcher->getParams();
    EXPECT_EQ(0, matcher->getMinDisparity());
    EXPECT_EQ(64, matcher->getNumDisparities());
    EXPECT_EQ(1, matcher->getBlockSize());
    EXPECT_EQ(0, matcher->getSpeckleWindowSize());
    EXPECT_LE(matcher->getDisp12MaxDiff(), 0);
    EXPECT_EQ(createMinimumSpanningTree()->getDefaultName(), matcher->getTreeStrategy()->getDefaultName());
    EXPECT_TRUE(params.usePrediction);
    EXPECT_FALSE(params.useMedianPrefilter);
    EXPECT_EQ(3, params.numLayers);
    EXPECT_EQ(0, params.maxTopDisparities);
    EXPECT_EQ(0, matcher->getMaxRowOffset());
    EXPECT_FALSE(matcher->getUseLightAlignment());
    EXPECT_EQ(0, matcher->getNoiseThreshold());
    EXPECT_TRUE(params.predictionModel.empty());
    EXPECT_EQ(HDPTreeMatcher::AUTO, params.delta0);
    EXPECT_EQ(HDPTreeMatcher::AUTO, params.beta);
    EXPECT_EQ(25.5, params.gamma);
    EXPECT_EQ(10, params.colorTruncation);
    EXPECT_EQ(2, params.gradientTruncation);
    EXPECT_EQ(0.11, params.colorWeight);
    EXPECT_EQ(HDPTreeMatcher::AUTO, params.disparityMedianSize);
    EXPECT_EQ((int)HDPTreeMatcher::COST_COLOR_GRADIENT, params.matchingCost);
    EXPECT_EQ((int)HDPTreeMatcher::PRIOR_SUPPORT_POINTS, params.disparityPrior);
    EXPECT_EQ(0, params.intervalMargin);
    EXPECT_FALSE(params.useSubpixel);
    EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_TREES, params.aggregation);
    EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_TREES, params.topAggregation);
    EXPECT_EQ(16, params.P1);
    EXPECT_EQ(65, params.P2);
    EXPECT_EQ(1, params.scanlinePasses);
    EXPECT_EQ(0, params.finestLayer);
    EXPECT_FALSE(params.useNonLocalRefinement);
    EXPECT_FALSE(matcher->getUseTemporalPrediction());
    EXPECT_FALSE(params.fillOcclusions);

    EXPECT_EQ(serialized(*HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_FAST)),
              serialized(*HDPTreeMatcher::create()));
    EXPECT_EQ(-40, HDPTreeMatcher::create(-40, 100)->getMinDisparity());
    EXPECT_EQ(100, HDPTreeMatcher::create(-40, 100)->getNumDisparities());
    EXPECT_FALSE(matcher->getDefaultName().empty());
    EXPECT_EQ(16, (int)StereoMatcher::DISP_SCALE);
}

//! What a preset sets is all that it sets.
TEST(HDPStereo_MatcherContract, presets_are_params)
{
    for (const System& system : presets)
        for (const System& other : presets)
        {
            const Ptr<HDPTreeMatcher> configured = createSystem(other, 33, -5);
            configured->setParams(paramsOf(system));
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

#define EXPECT_KEEPS_FIELD(matcher, field, ...)                                                                        \
    for (const auto value : { __VA_ARGS__ })                                                                           \
    {                                                                                                                  \
        change(*matcher, [&](Params& p) { p.field = value; });                                                         \
        EXPECT_EQ(value, matcher->getParams().field);                                                                  \
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
    EXPECT_KEEPS_FIELD(matcher, usePrediction, false, true);
    EXPECT_KEEPS_FIELD(matcher, useMedianPrefilter, true, false);
    EXPECT_KEEPS_FIELD(matcher, numLayers, 1, 2, 16);
    EXPECT_KEEPS_FIELD(matcher, maxTopDisparities, 1, 64, INT_MAX, 0);
    EXPECT_KEEPS(matcher, MaxRowOffset, 1, 64, INT_MAX, 0);
    EXPECT_KEEPS(matcher, UseLightAlignment, true, false);
    EXPECT_KEEPS(matcher, NoiseThreshold, 0., 1e-3, 2.5, 300.);
    EXPECT_KEEPS_FIELD(matcher, delta0, 0., 0.064, 0.999, (double)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS_FIELD(matcher, beta, 0., 0.6, 1., (double)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS_FIELD(matcher, gamma, 1e-3, 25.5, 1e6);
    EXPECT_KEEPS_FIELD(matcher, colorTruncation, 0., 7.5, 255.);
    EXPECT_KEEPS_FIELD(matcher, gradientTruncation, 0., 7.5, 255.);
    EXPECT_KEEPS_FIELD(matcher, colorWeight, 0., 0.5, 1.);
    EXPECT_KEEPS_FIELD(matcher, disparityMedianSize, 0, 3, 5, 7, (int)HDPTreeMatcher::AUTO);
    EXPECT_KEEPS_FIELD(matcher, matchingCost, (int)HDPTreeMatcher::COST_CENSUS,
                       (int)HDPTreeMatcher::COST_COLOR_GRADIENT);
    EXPECT_KEEPS_FIELD(matcher, disparityPrior, (int)HDPTreeMatcher::PRIOR_UPPER_LAYER,
                       (int)HDPTreeMatcher::PRIOR_SUPPORT_POINTS);
    EXPECT_KEEPS_FIELD(matcher, intervalMargin, 64, 1, 0);
    EXPECT_KEEPS_FIELD(matcher, useSubpixel, true, false);
    EXPECT_KEEPS_FIELD(matcher, aggregation, (int)HDPTreeMatcher::AGGREGATION_SCANLINES,
                       (int)HDPTreeMatcher::AGGREGATION_TREE_SCANLINES, (int)HDPTreeMatcher::AGGREGATION_TREES);
    EXPECT_KEEPS_FIELD(matcher, topAggregation, (int)HDPTreeMatcher::AGGREGATION_TREE_SCANLINES,
                       (int)HDPTreeMatcher::AGGREGATION_TREES);
    EXPECT_KEEPS_FIELD(matcher, P1, 0, 100, 16);
    EXPECT_KEEPS_FIELD(matcher, P2, 0, 100, 65);
    EXPECT_KEEPS_FIELD(matcher, scanlinePasses, 4, 2, 1);
    EXPECT_KEEPS_FIELD(matcher, finestLayer, 15, 1, 0);
    EXPECT_KEEPS_FIELD(matcher, useNonLocalRefinement, true, false);
    EXPECT_KEEPS(matcher, UseTemporalPrediction, true, false);
    EXPECT_KEEPS(matcher, TreeStrategy, createSegmentTree(), createRandomTree());
    EXPECT_KEEPS_FIELD(matcher, predictionModel, DisparityPredictionModel::create(), Ptr<DisparityPredictionModel>());
}

//! The accessors that are left, and the fields of Params that they stand for
TEST(HDPStereo_MatcherContract, setters_are_shortcuts_to_params)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create();
    const Ptr<TreeStrategy> strategy = createRandomTree();
    matcher->setBlockSize(3);
    matcher->setDisparityDepth(CV_32F);
    matcher->setUseTemporalPrediction(true);
    matcher->setMaxRowOffset(5);
    matcher->setUseLightAlignment(false);
    matcher->setNoiseThreshold(1.5);
    matcher->setTreeStrategy(strategy);
    const Params params = matcher->getParams();
    EXPECT_EQ(3, params.blockSize);
    EXPECT_EQ(CV_32F, params.disparityDepth);
    EXPECT_TRUE(params.useTemporalPrediction);
    EXPECT_EQ(5, params.maxRowOffset);
    EXPECT_FALSE(params.useLightAlignment);
    EXPECT_EQ(1.5, params.noiseThreshold);
    EXPECT_EQ(strategy.get(), params.treeStrategy.get());

    matcher->setMinDisparity(-3);
    matcher->setParams(Params());
    EXPECT_EQ(7, matcher->getBlockSize());
    EXPECT_EQ(CV_16S, matcher->getDisparityDepth());
    EXPECT_FALSE(matcher->getUseTemporalPrediction());
    EXPECT_EQ(64, matcher->getMaxRowOffset());
    EXPECT_TRUE(matcher->getUseLightAlignment());
    EXPECT_EQ(2, matcher->getNoiseThreshold());
    EXPECT_NE(strategy.get(), matcher->getTreeStrategy().get());
    EXPECT_EQ(-3, matcher->getMinDisparity()) << "no field of Params";
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
            change(*written, [&](Params& p) {
                p.delta0 = isLarge ? 0.064 : 0.004;
                p.beta = isLarge ? 0.6 : 0.95;
                p.disparityMedianSize = usePrediction ? 7 : 5;
                p.predictionModel = DisparityPredictionModel::createPublished(
                    isLarge ? DisparityPredictionModel::PUBLISHED_LARGE : DisparityPredictionModel::PUBLISHED_SMALL);
            });
            expectIdentical(match(*written, pair.left, pair.right), match(*automatic, pair.left, pair.right));
        }
}

struct Change
{
    const char* name;
    std::function<void(HDPTreeMatcher&)> set;
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
    { "usePrediction", inParams([](Params& p) { p.usePrediction = false; }) },
    { "useMedianPrefilter", inParams([](Params& p) { p.useMedianPrefilter = true; }) },
    { "numLayers", inParams([](Params& p) { p.numLayers = 1; }) },
    { "gamma", inParams([](Params& p) { p.gamma = 5; }) },
    { "disparityMedianSize", inParams([](Params& p) { p.disparityMedianSize = 0; }) },
    { "useSubpixel", inParams([](Params& p) { p.useSubpixel = !p.useSubpixel; }) },
    { "finestLayer", inParams([](Params& p) { p.finestLayer = 1 - p.finestLayer; }) },
    { "maxTopDisparities", inParams([](Params& p) {
        p.numLayers = 3; // all have 3 layers without a limit, and 2 with one
        p.maxTopDisparities = p.maxTopDisparities ? 0 : 64;
    }) },
};

//! For trees below the top layer
const Change intervalChanges[] = {
    { "delta0", inParams([](Params& p) { p.delta0 = 0.3; }) },
    { "beta", inParams([](Params& p) { p.beta = 0.1; }) },
    { "intervalMargin", inParams([](Params& p) { p.intervalMargin = 5; }) },
    { "disparityPrior", inParams([](Params& p) { p.disparityPrior = 1 - p.disparityPrior; }) },
    { "predictionModel", inParams([](Params& p) {
        p.predictionModel = DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
    }) },
};

const Change refinementChanges[] = {
    { "useNonLocalRefinement", inParams([](Params& p) { p.useNonLocalRefinement = true; }) },
};

const Change topChanges[] = {
    { "topAggregation", inParams([](Params& p) { p.topAggregation = 2 - p.topAggregation; }) },
};

const Change colorAndGradientChanges[] = {
    { "colorTruncation", inParams([](Params& p) { p.colorTruncation = 3; }) },
    { "gradientTruncation", inParams([](Params& p) { p.gradientTruncation = 8; }) },
    { "colorWeight", inParams([](Params& p) { p.colorWeight = 0.9; }) },
    { "matchingCost", inParams([](Params& p) { p.matchingCost = HDPTreeMatcher::COST_CENSUS, p.blockSize = 5; }) },
};

const Change scanlineChanges[] = {
    { "P1", inParams([](Params& p) { p.P1 = 3; }) },
    { "P2", inParams([](Params& p) { p.P2 = 90; }) },
    { "aggregation", inParams([](Params& p) { p.aggregation = HDPTreeMatcher::AGGREGATION_TREES; }) },
};

const Change passesChanges[] = {
    { "scanlinePasses", inParams([](Params& p) { p.scanlinePasses = 3; }) },
};
// clang-format on

//! numLayers: 0: those of the system
template <size_t count>
void expectEffects(const System& system, const Change (&changes)[count], bool expected, int numLayers = 0)
{
    const SyntheticPair& pair = testPair();
    const auto create = [&] {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, disparities);
        if (numLayers > 0)
            change(*matcher, [&](Params& p) { p.numLayers = numLayers, p.maxTopDisparities = 0; });
        return matcher;
    };
    const Mat unchanged = match(*create(), pair.left, pair.right);
    for (const Change& each : changes)
    {
        const Ptr<HDPTreeMatcher> matcher = create();
        each.set(*matcher);
        EXPECT_EQ(expected, countDifferent(unchanged, match(*matcher, pair.left, pair.right)) > 0)
            << system.name << ", " << each.name;
    }
}

//! Each parameter does something, where the documentation does not say that it does not.
TEST(HDPStereo_MatcherContract, parameters_have_an_effect)
{
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, disparities);
        const int aggregation = matcher->getParams().aggregation;
        const bool hasSums = aggregation == HDPTreeMatcher::AGGREGATION_TREES;
        expectEffects(preset, commonChanges, true);
        expectEffects(preset, intervalChanges, hasSums, 3);
        expectEffects(preset, refinementChanges, hasSums);
        expectEffects(preset, topChanges, !hasSums);
        if (matcher->getParams().matchingCost == HDPTreeMatcher::COST_COLOR_GRADIENT)
            expectEffects(preset, colorAndGradientChanges, true);
        // Otherwise the top layer alone is matched.
        const bool hasLayers = matcher->getParams().finestLayer == 0;
        if (!hasSums && hasLayers)
            expectEffects(preset, scanlineChanges, true);
        expectEffects(preset, passesChanges, !hasSums && hasLayers);
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
            change(*matcher, [&](Params& p) {
                p.useSubpixel = useSubpixel;
                p.disparityMedianSize = 0;
            });
            const Mat unfiltered = match(*matcher, pair.left, pair.right);

            Mat expected;
            unfiltered.convertTo(expected, CV_16U);
            oracle::median(expected, size).convertTo(expected, CV_16S);
            change(*matcher, [&](Params& p) { p.disparityMedianSize = size; });
            expectIdentical(expected, match(*matcher, pair.left, pair.right));
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

//! The result takes the place of an image, whose memory has another size.
TEST_P(HDPStereo_MatcherPreset, umat_in_place)
{
    const SyntheticPair& pair = testPair();
    const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam(), disparities);
    const Mat expected = match(*matcher, pair.left, pair.right);
    for (int image = 0; image < 2; ++image)
    {
        UMat images[2];
        pair.left.copyTo(images[0]);
        pair.right.copyTo(images[1]);
        matcher->compute(images[0], images[1], images[image]);
        expectIdentical(expected, images[image].getMat(ACCESS_READ));
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
        change(*matcher, [&](Params& p) {
            p.predictionModel = model;
            p.maxTopDisparities = 0;
        });
        for (int layers = 1; layers <= 16; ++layers)
        {
            change(*matcher, [&](Params& p) { p.numLayers = layers; });
            expectDisparities(match(*matcher, pair.left, pair.right), *matcher);
            std::vector<double> ratios;
            ratios = matcher->getFindings().searchRatios;
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
        const Mat wrong = cv::abs(inside - 16 * shift) >
                          (matcher->getParams().useSubpixel ? 8 << matcher->getParams().finestLayer : 0);
        // Where the finest layer has half the rows, a mistake of the layers above it takes more of them.
        const int share = matcher->getParams().finestLayer > 0 ? 30 : 100;
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
            // Half a pixel of the finest layer
            const bool hasScanlines = matcher->getParams().aggregation != HDPTreeMatcher::AGGREGATION_TREES;
            const int tolerance = hasScanlines ? 8 << matcher->getParams().finestLayer : 0;
            const int share = !system.usePrediction ? 200 : matcher->getParams().useSubpixel ? 25 : 33;
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
                // Half of a window at the border sees nothing, and of few columns that is many.
                const int mostWrong = (int)wrong.rows * shift / (shift < 16 ? 8 : 20);
                EXPECT_LE(cv::countNonZero(wrong.colRange(0, shift)), mostWrong);
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
            change(*matcher, [&](Params& p) {
                p.disparityMedianSize = 0; // leaves speckles
            });
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
                reused->setParams(paramsOf(system));
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
    ratios = matcher->getFindings().searchRatios;
    EXPECT_TRUE(ratios.empty());

    match(*matcher, pair.left, pair.right);
    ratios = matcher->getFindings().searchRatios;
    ASSERT_EQ(3u, ratios.size());
    EXPECT_EQ(1, ratios[2]) << "the top layer searches the full range";
    for (int layer = 0; layer < 2; ++layer)
        EXPECT_TRUE(ratios[layer] > 0 && ratios[layer] < 1) << ratios[layer];

    change(*matcher, [&](Params& p) { p.usePrediction = false; });
    match(*matcher, pair.left, pair.right);
    ratios = matcher->getFindings().searchRatios;
    EXPECT_EQ(std::vector<double>(1, 1.), ratios);
}

//! At least two, or three that leave the top one 16 disparities or more, and so many that it has 45 or less, 55 or 90
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
                for (int limit = (isTree      ? 90
                                  : isQuality ? 55
                                              : 45)
                                 << (expected - 1);
                     numDisparities > limit; limit *= 2)
                    ++expected;
            }
            const int numLayers = matcher->getParams().numLayers, limit = matcher->getParams().maxTopDisparities;
            ASSERT_EQ(expected, hdp::chooseLayers(numDisparities, numLayers, limit, 16))
                << preset.name << ", " << numDisparities << " disparities";
            ASSERT_EQ(std::min(expected, 4), hdp::chooseLayers(numDisparities, numLayers, limit, 4));
            for (int usual : { 64, 96, 128, 192, 256, 384, 512, 1024 }) // one more is matched alike
                if (numDisparities == usual && limit > 0)
                {
                    EXPECT_EQ(expected, hdp::chooseLayers(usual + 1, numLayers, limit, 16)) << preset.name << usual;
                }
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
            const int layers = hdp::chooseLayers(numDisparities, matcher->getParams().numLayers,
                                                 matcher->getParams().maxTopDisparities, 16);
            std::vector<double> ratios, ofLayers(layers, 1.);
            const int finest = matcher->getParams().finestLayer;
            for (int layer = 0; layer < layers - 1; ++layer) // 16 candidates, or all while there are few
            {
                const int all = cvCeil((numDisparities - 1) / std::pow(2., layer)) + 1;
                ofLayers[layer] = layer < finest ? 0 : layer > finest && all <= 97 ? 1 : std::min(1., 16. / all);
            }
            match(*matcher, image, image);
            ratios = matcher->getFindings().searchRatios;
            EXPECT_EQ(ofLayers, ratios);

            match(*matcher, small, small);
            ratios = matcher->getFindings().searchRatios;
            EXPECT_EQ((size_t)std::min(layers, 4), ratios.size()) << "9 x 8 pixels halved 3 times are 1 x 1";
            change(*matcher, [&](Params& p) { p.usePrediction = false; });
            match(*matcher, image, image);
            ratios = matcher->getFindings().searchRatios;
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
            ratios = matcher->getFindings().searchRatios;
            Mat upper;
            for (int layer = (int)ratios.size() - 1; layer >= matcher->getParams().finestLayer; --layer)
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
            if (matcher->getParams().finestLayer == 0)
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
        ratios = matcher.getFindings().searchRatios;
        stages = matcher.getFindings().stages;
        times = matcher.getFindings().stageTimes;
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
        change(*matcher, [&](Params& p) {
            p.aggregation = HDPTreeMatcher::AGGREGATION_TREES;
            p.predictionModel = noLayers;
        });
        matcher->compute(pair.left, pair.right, disparity);
    },
                                };
    for (const std::function<void()>& compute : bad)
    {
        matcher->setParams(paramsOf(system));
        matcher->setMinDisparity(0);
        change(*matcher, [&](Params& p) { p.predictionModel = Ptr<DisparityPredictionModel>(); });
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
    stages = matcher->getFindings().stages;
    times = matcher->getFindings().stageTimes;
    EXPECT_TRUE(stages.empty() && times.empty());
    for (int repetition = 0; repetition < 2; ++repetition)
    {
        const int64 start = cv::getTickCount();
        match(*matcher, pair.left, pair.right);
        const double all = (double)(cv::getTickCount() - start) * 1000 / cv::getTickFrequency();
        again = stages;
        stages = matcher->getFindings().stages;
        times = matcher->getFindings().stageTimes;
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

}} // namespace opencv_test
