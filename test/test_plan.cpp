// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "helpers.hpp"
#include "plan_text.hpp"
#include "../src/base/units.hpp"
#include "../src/pair/image_pyramid.hpp"

namespace opencv_test { namespace {

using hdp::LayerPlan;
using hdp::MatcherParameters;
using hdp::PairPlan;

typedef HDPTreeMatcher M;
typedef void (*Change)(MatcherParameters&);

const Size imageSize(640, 480);

std::string planText(const MatcherParameters& parameters) { return textOf(hdp::plan(parameters, imageSize, CV_8UC3)); }

MatcherParameters parametersOf(int preset)
{
    MatcherParameters p = MatcherParameters(preset);
    p.numDisparities = 128;
    return p;
}

void keep(MatcherParameters&) {}
void withoutPrediction(MatcherParameters& p) { p.usePrediction = false; }
void withScanlines(MatcherParameters& p)
{
    p.matchingCost = M::COST_CENSUS;
    p.aggregation = M::AGGREGATION_SCANLINES;
}
void withTreeSums(MatcherParameters& p) { p.aggregation = p.topAggregation = M::AGGREGATION_TREES; }
void withTreesBelow(MatcherParameters& p) { p.aggregation = M::AGGREGATION_TREES; }
void withColorGradient(MatcherParameters& p) { p = parametersOf(M::PRESET_PAPER); }
void withCensus(MatcherParameters& p) { p.matchingCost = M::COST_CENSUS; }
void withoutSpeckleFilter(MatcherParameters& p) { p.speckleWindowSize = 0; }

struct Row
{
    const char* rule;
    Change context, change;
};

//! What the documentation of HDPTreeMatcher says to be without effect
const Row withoutEffect[] = {
    { "no prediction: numLayers", withoutPrediction, [](MatcherParameters& p) { p.numLayers = 5; } },
    { "no prediction: maxTopDisparities", withoutPrediction, [](MatcherParameters& p) { p.maxTopDisparities = 16; } },
    { "no prediction: finestLayer", withoutPrediction, [](MatcherParameters& p) { p.finestLayer = 2; } },
    { "no prediction: aggregation", withoutPrediction,
      [](MatcherParameters& p) { p.aggregation = (p.aggregation + 1) % 3; } },
    { "no prediction: topAggregation", withoutPrediction,
      [](MatcherParameters& p) { p.topAggregation = M::AGGREGATION_TREE_SCANLINES - p.topAggregation; } },
    { "no prediction: P1", withoutPrediction, [](MatcherParameters& p) { p.P1 = 5; } },
    { "no prediction: scanlinePasses", withoutPrediction, [](MatcherParameters& p) { p.scanlinePasses = 4; } },
    { "no prediction: disparityPrior", withoutPrediction,
      [](MatcherParameters& p) { p.disparityPrior = 1 - p.disparityPrior; } },
    { "no prediction: delta0", withoutPrediction, [](MatcherParameters& p) { p.delta0 = 0.3; } },
    { "no prediction: beta", withoutPrediction, [](MatcherParameters& p) { p.beta = 0.3; } },
    { "no prediction: intervalMargin", withoutPrediction, [](MatcherParameters& p) { p.intervalMargin = 7; } },
    { "scanlines: predictionModel", withScanlines,
      [](MatcherParameters& p) { p.predictionModel = DisparityPredictionModel::create(); } },
    { "scanlines: disparityPrior", withScanlines,
      [](MatcherParameters& p) { p.disparityPrior = 1 - p.disparityPrior; } },
    { "scanlines: delta0", withScanlines, [](MatcherParameters& p) { p.delta0 = 0.3; } },
    { "scanlines: beta", withScanlines, [](MatcherParameters& p) { p.beta = 0.3; } },
    { "scanlines: intervalMargin", withScanlines, [](MatcherParameters& p) { p.intervalMargin = 7; } },
    { "scanlines: useNonLocalRefinement", withScanlines,
      [](MatcherParameters& p) { p.useNonLocalRefinement = true; } },
    { "tree sums: P1 and P2", withTreeSums,
      [](MatcherParameters& p) {
          p.P1 = 5;
          p.P2 = 33;
      } },
    { "tree sums: scanlinePasses", withTreeSums, [](MatcherParameters& p) { p.scanlinePasses = 4; } },
    { "trees below: topAggregation", withTreesBelow,
      [](MatcherParameters& p) { p.topAggregation = M::AGGREGATION_TREE_SCANLINES - p.topAggregation; } },
    { "census: truncations and weight", withCensus,
      [](MatcherParameters& p) {
          p.colorTruncation = 3;
          p.gradientTruncation = 1;
          p.colorWeight = 0.5;
      } },
    { "census: blockSize above 7", withCensus,
      [](MatcherParameters& p) { p.blockSize = p.blockSize >= 7 ? 21 : p.blockSize; } },
    { "no speckle filter: speckleRange", withoutSpeckleFilter, [](MatcherParameters& p) { p.speckleRange = 3; } },
    { "disp12MaxDiff below 1 and a depth", keep, [](MatcherParameters& p) { p.disparityDepth = CV_32F; } },
};

TEST(HDPStereo_Plan, what_is_documented_to_have_no_effect_has_none)
{
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
        for (const Row& row : withoutEffect)
        {
            SCOPED_TRACE(format("preset %d, %s", preset, row.rule));
            MatcherParameters p = parametersOf(preset);
            row.context(p);
            if (p.matchingCost == M::COST_CENSUS && row.context == withCensus && preset == M::PRESET_PAPER)
                p.blockSize = 7;
            const std::string before = planText(p);
            row.change(p);
            EXPECT_EQ(before, planText(p));
        }
}

TEST(HDPStereo_Plan, layers_have_at_least_one_pixel)
{
    const auto layersOf = [](const Size& size, int numLayers) {
        MatcherParameters p = parametersOf(M::PRESET_FAST);
        p.numLayers = numLayers;
        p.maxTopDisparities = 0;
        return (int)hdp::plan(p, size, CV_8UC1).layers.size();
    };
    EXPECT_EQ(1, layersOf(Size(1, 1), 3));
    EXPECT_EQ(1, layersOf(Size(100, 1), 3));
    EXPECT_EQ(2, layersOf(Size(2, 3), 16));
    EXPECT_EQ(2, layersOf(Size(3, 100), 3));
    EXPECT_EQ(3, layersOf(Size(4, 4), 3));
    EXPECT_EQ(3, layersOf(Size(640, 480), 3));
    EXPECT_EQ(1, layersOf(Size(640, 480), 1));
}

//! Where each parameter matters
const Row withEffect[] = {
    { "minDisparity", keep, [](MatcherParameters& p) { p.minDisparity = -5; } },
    { "numDisparities", keep, [](MatcherParameters& p) { p.numDisparities = 100; } },
    { "blockSize", keep, [](MatcherParameters& p) { p.blockSize = 3; } },
    { "speckleWindowSize", keep, [](MatcherParameters& p) { p.speckleWindowSize = 10; } },
    { "speckleRange", [](MatcherParameters& p) { p.speckleWindowSize = 10; },
      [](MatcherParameters& p) { p.speckleRange = 2; } },
    { "disp12MaxDiff", keep, [](MatcherParameters& p) { p.disp12MaxDiff = 2; } },
    { "maxRowOffset", keep, [](MatcherParameters& p) { p.maxRowOffset = 5; } },
    { "useLightAlignment", keep, [](MatcherParameters& p) { p.useLightAlignment = !p.useLightAlignment; } },
    { "noiseThreshold", keep, [](MatcherParameters& p) { p.noiseThreshold = 5; } },
    { "usePrediction", keep, withoutPrediction },
    { "useMedianPrefilter", keep, [](MatcherParameters& p) { p.useMedianPrefilter = true; } },
    { "numLayers", [](MatcherParameters& p) { p.maxTopDisparities = 0; },
      [](MatcherParameters& p) { p.numLayers = p.numLayers == 2 ? 1 : 2; } },
    { "maxTopDisparities", withScanlines, [](MatcherParameters& p) { p.maxTopDisparities = 20; } },
    { "delta0", withTreesBelow, [](MatcherParameters& p) { p.delta0 = 0.3; } },
    { "beta", withTreesBelow, [](MatcherParameters& p) { p.beta = 0.3; } },
    { "gamma", keep, [](MatcherParameters& p) { p.gamma = 11; } },
    { "colorTruncation", withColorGradient, [](MatcherParameters& p) { p.colorTruncation = 3; } },
    { "gradientTruncation", withColorGradient, [](MatcherParameters& p) { p.gradientTruncation = 3; } },
    { "colorWeight", withColorGradient, [](MatcherParameters& p) { p.colorWeight = 0.5; } },
    { "disparityMedianSize", keep, [](MatcherParameters& p) { p.disparityMedianSize = 3; } },
    { "matchingCost", withTreesBelow,
      [](MatcherParameters& p) {
          p.fillOcclusions = false;
          p.matchingCost = 1 - p.matchingCost;
      } },
    { "disparityPrior", withTreesBelow, [](MatcherParameters& p) { p.disparityPrior = 1 - p.disparityPrior; } },
    { "intervalMargin", withTreesBelow, [](MatcherParameters& p) { p.intervalMargin = 7; } },
    { "useSubpixel", keep, [](MatcherParameters& p) { p.useSubpixel = !p.useSubpixel; } },
    { "aggregation", withCensus, [](MatcherParameters& p) { p.aggregation = 1 - p.aggregation; } },
    { "topAggregation", withScanlines,
      [](MatcherParameters& p) { p.topAggregation = M::AGGREGATION_TREE_SCANLINES - p.topAggregation; } },
    { "topAggregation: scanlines", withScanlines,
      [](MatcherParameters& p) { p.topAggregation = M::AGGREGATION_SCANLINES; } },
    { "P1", withScanlines, [](MatcherParameters& p) { p.P1 = 3; } },
    { "P2", withScanlines, [](MatcherParameters& p) { p.P2 = 33; } },
    { "finestLayer", keep, [](MatcherParameters& p) { p.finestLayer = 1 - p.finestLayer; } },
    { "scanlinePasses", withScanlines, [](MatcherParameters& p) { p.scanlinePasses = 3; } },
    { "fillOcclusions", withCensus, [](MatcherParameters& p) { p.fillOcclusions = !p.fillOcclusions; } },
    { "useNonLocalRefinement", withTreesBelow, [](MatcherParameters& p) { p.useNonLocalRefinement = true; } },
    { "useTemporalPrediction", withCensus, [](MatcherParameters& p) { p.useTemporalPrediction = true; } },
    { "treeStrategy", keep, [](MatcherParameters& p) { p.treeStrategy = createRandomTree(); } },
    { "predictionModel", withTreesBelow,
      [](MatcherParameters& p) {
          p.predictionModel = DisparityPredictionModel::create();
          for (int i = 0; i < 7; ++i)
              p.predictionModel->addLayer({ 0 }, { 1 }, { 1 });
      } },
};

TEST(HDPStereo_Plan, every_parameter_has_an_effect)
{
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
        for (const Row& row : withEffect)
        {
            SCOPED_TRACE(format("preset %d, %s", preset, row.rule));
            MatcherParameters p = parametersOf(preset);
            row.context(p);
            const std::string before = planText(p);
            row.change(p);
            EXPECT_NE(before, planText(p));
        }
}

TEST(HDPStereo_Plan, a_range_that_is_not_set)
{
    PairModel model;
    model.width = model.tileWidth = imageSize.width;
    model.height = model.tileHeight = imageSize.height;
    model.minDisparity = -9;
    model.numDisparities = 77;
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
    {
        MatcherParameters unset = parametersOf(preset), set = unset;
        unset.minDisparity = INT_MAX; // has no meaning
        unset.numDisparities = 0;
        set.minDisparity = model.minDisparity;
        set.numDisparities = model.numDisparities;
        EXPECT_TRUE(hdp::plan(unset, imageSize, CV_8UC3).looksForRange) << preset;
        EXPECT_FALSE(hdp::plan(set, imageSize, CV_8UC3).looksForRange) << preset;
        const PairPlan ofModel = hdp::plan(unset, imageSize, CV_8UC3, model);
        EXPECT_FALSE(ofModel.looksForRange) << preset;
        EXPECT_EQ(textOf(hdp::plan(set, imageSize, CV_8UC3, model)), textOf(ofModel)) << preset;

        hdp::PairInputs inputs;
        Mat smallest(2, 3, CV_32F, Scalar(-8.5)), largest(2, 3, CV_32F, Scalar(40));
        largest.at<float>(1, 1) = 66.5f;
        hdp::setRange(smallest, largest, inputs);
        const PairPlan ofRanges = hdp::plan(unset, imageSize, CV_8UC3, PairModel(), inputs);
        EXPECT_FALSE(ofRanges.looksForRange) << preset;
        EXPECT_EQ(textOf(hdp::plan(set, imageSize, CV_8UC3, PairModel(), inputs)), textOf(ofRanges)) << preset;
        smallest.at<float>(0, 2) = std::numeric_limits<float>::quiet_NaN();
        hdp::setRange(smallest, largest, inputs);
        EXPECT_TRUE(hdp::plan(unset, imageSize, CV_8UC3, PairModel(), inputs).looksForRange) << preset;
    }
}

TEST(HDPStereo_Plan, ranges_of_all_pixels)
{
    const auto rangeOf = [](double smallest, double largest, int width) {
        hdp::PairInputs inputs;
        hdp::setRange(Mat(1, 1, CV_32F, Scalar(smallest)), Mat(1, 1, CV_32F, Scalar(largest)), inputs);
        return hdp::rangeOf(inputs, width);
    };
    EXPECT_EQ(Range(-3, 9), rangeOf(-2.5, 7.5, 100));
    EXPECT_EQ(Range(-99, 100), rangeOf(-2000, 2000, 100)) << "no pixel has others";
    EXPECT_EQ(Range(99, 100), rangeOf(300, 310, 100)) << "nor any of these";
    EXPECT_EQ(Range(-99, -98), rangeOf(-310, -300, 100));
    EXPECT_EQ(Range(-2047, 2048), rangeOf(-1e9, 1e9, 5000)) << "as CV_16S has";
    EXPECT_TRUE(rangeOf(std::numeric_limits<double>::infinity() * -1, 3, 100).empty()) << "is not limited";
    EXPECT_TRUE(hdp::rangeOf(hdp::PairInputs(), 100).empty());
}

//! What is known of a pair is used on all layers, or nowhere.
TEST(HDPStereo_Plan, inputs)
{
    hdp::PairInputs ranges, prior, masks;
    const float unlimited = std::numeric_limits<float>::quiet_NaN();
    // All pixels but one may have all disparities.
    const auto limitOne = [&ranges, unlimited](float smallest, float largest) {
        Mat first(2, 3, CV_32F, Scalar(unlimited)), last = first.clone();
        first.at<float>(1, 2) = smallest;
        last.at<float>(1, 2) = largest;
        hdp::setRange(first, last, ranges);
    };
    prior.prior = prior.sigma = Mat(imageSize, CV_32F, Scalar(3));
    masks.leftMask = Mat(imageSize, CV_8U, Scalar(0));
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
    {
        SCOPED_TRACE(preset);
        MatcherParameters p = parametersOf(preset);
        const std::string without = planText(p);
        EXPECT_EQ(without, textOf(hdp::plan(p, imageSize, CV_8UC3, PairModel(), masks))) << "masks are no decision";
        for (float beyond : { 0.f, 1000.f, unlimited })
        {
            limitOne(-beyond, 127 + beyond);
            EXPECT_EQ(without, textOf(hdp::plan(p, imageSize, CV_8UC3, PairModel(), ranges))) << "that limit nothing";
        }
        limitOne(unlimited, 126);
        EXPECT_TRUE(hdp::plan(p, imageSize, CV_8UC3, PairModel(), ranges).hasRanges);
        limitOne(1, unlimited);
        const PairPlan withRanges = hdp::plan(p, imageSize, CV_8UC3, PairModel(), ranges);
        EXPECT_TRUE(withRanges.hasRanges);
        EXPECT_FALSE(withRanges.hasPrior);
        EXPECT_NE(without, textOf(withRanges));
        for (const hdp::LayerPlan& layer : withRanges.layers)
            EXPECT_NE(hdp::SUPPORT_POINTS, layer.trees.prior);
        if (p.matchingCost != M::COST_CENSUS)
        {
            expectRejected([&] { hdp::plan(p, imageSize, CV_8UC3, PairModel(), prior); }, "setPriorDisparity()");
            p.matchingCost = M::COST_CENSUS;
        }
        PairPlan withPrior = hdp::plan(p, imageSize, CV_8UC3, PairModel(), prior);
        EXPECT_TRUE(withPrior.hasPrior);
        EXPECT_FALSE(withPrior.hasRanges);
        withPrior.hasPrior = false;
        EXPECT_EQ(planText(p), textOf(withPrior)) << "nothing else";
    }
}

//! Without prediction there are no layers, and the plain tree algorithm matches the image.
TEST(HDPStereo_Plan, without_prediction)
{
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
    {
        SCOPED_TRACE(preset);
        MatcherParameters p = parametersOf(preset);
        p.usePrediction = false;
        const PairPlan plan = hdp::plan(p, imageSize, CV_8UC3);
        ASSERT_EQ(1u, plan.layers.size());
        const LayerPlan& layer = plan.finest();
        EXPECT_EQ(0, layer.layer);
        EXPECT_EQ(hdp::TREE_SUMS, layer.method);
        EXPECT_TRUE(layer.trees.linksTrees);
        EXPECT_FALSE(layer.restoresThinStructures);
        EXPECT_EQ(p.useSubpixel, layer.hasFractions);
        EXPECT_EQ(p.numDisparities, layer.numDisparities);
        p.useNonLocalRefinement = true;
        EXPECT_GT(hdp::plan(p, imageSize, CV_8UC3).finest().trees.refinementGamma, 0);
        p.fillOcclusions = false;
        p.matchingCost = M::COST_COLOR_GRADIENT;
        EXPECT_NO_THROW(hdp::plan(p, imageSize, CV_8UC3)) << "trees can be grown over any cost";
    }
}

//! Layers below look up what is predicted of each candidate.
TEST(HDPStereo_Plan, maps_have_no_disparity_beyond_the_candidates)
{
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
        for (const bool useSubpixel : { false, true })
            for (int numDisparities = 1; numDisparities < 140; ++numDisparities)
            {
                MatcherParameters p = parametersOf(preset);
                p.useSubpixel = useSubpixel;
                p.numDisparities = numDisparities;
                for (const LayerPlan& layer : hdp::plan(p, imageSize, CV_8UC3).layers)
                    ASSERT_LT(hdp::wholeDisparity(layer.maxDisparity),
                              hdp::layerDisparities(numDisparities, layer.layer, layer.hasFractions))
                        << preset << ", " << numDisparities << ", layer " << layer.layer;
            }
}

TEST(HDPStereo_Plan, methods_of_the_presets)
{
    const hdp::LayerMethod tops[] = { hdp::TREE_SUMS, hdp::TREE_SCANLINES, hdp::TREE_SCANLINES, hdp::TREE_SCANLINES,
                                      hdp::TREE_SCANLINES };
    const hdp::LayerMethod finest[] = { hdp::TREE_SUMS, hdp::WINDOW_SCANLINES, hdp::WINDOW_SCANLINES,
                                        hdp::WINDOW_SCANLINES, hdp::WINDOW_SCANLINES };
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
    {
        const PairPlan plan = hdp::plan(parametersOf(preset), imageSize, CV_8UC3);
        EXPECT_EQ(tops[preset], plan.top().method) << preset;
        EXPECT_EQ(finest[preset], plan.finest().method) << preset;
        for (size_t i = 1; i < plan.layers.size(); ++i)
            EXPECT_EQ(plan.layers[i - 1].layer - 1, plan.layers[i].layer);
        EXPECT_EQ(preset == M::PRESET_ULTRAFAST, plan.finest().layer == 1);
    }
}

TEST(HDPStereo_Plan, means_of_trees_are_for_the_top_layer)
{
    for (int numDisparities : { 128, 192, 256 })
    {
        MatcherParameters p = parametersOf(M::PRESET_TREE);
        p.numDisparities = numDisparities;
        const PairPlan plan = hdp::plan(p, Size(1280, 960), CV_8UC3);
        EXPECT_EQ(hdp::TREE_SCANLINES, plan.top().method);
        for (size_t i = 1; i < plan.layers.size(); ++i)
        {
            const bool hasFew = !plan.layers[i].isFinest && numDisparities == 192;
            EXPECT_EQ(hasFew ? hdp::RANGE_SCANLINES : hdp::WINDOW_SCANLINES, plan.layers[i].method) << numDisparities;
        }
        const std::string expected = planText(p);
        p.aggregation = M::AGGREGATION_TREE_SCANLINES; // another name
        EXPECT_EQ(expected, planText(p));
        p.topAggregation = M::AGGREGATION_TREES;
        EXPECT_EQ(expected, planText(p)) << "without effect then";
        p.aggregation = M::AGGREGATION_TREES;
        EXPECT_EQ(hdp::TREE_SUMS, hdp::plan(p, Size(1280, 960), CV_8UC3).finest().method);
    }
}

//! Between the top layer and the finest one: all candidates while there are few, in halves of a pixel
TEST(HDPStereo_Plan, whole_range_of_coarse_layers)
{
    for (int numDisparities : { 64, 128, 193, 194, 256, 600 })
    {
        MatcherParameters p = parametersOf(M::PRESET_FAST);
        p.numDisparities = numDisparities;
        const PairPlan plan = hdp::plan(p, Size(1280, 960), CV_8UC3);
        ASSERT_LE(3u, plan.layers.size());
        for (size_t i = 1; i < plan.layers.size(); ++i)
        {
            const hdp::LayerPlan& layer = plan.layers[i];
            const int disparities = ((numDisparities - 2) >> layer.layer) + 2; // the last one may have a fraction
            const bool isWhole = !layer.isFinest && disparities <= 97;
            EXPECT_EQ(isWhole ? hdp::RANGE_SCANLINES : hdp::WINDOW_SCANLINES, layer.method) << numDisparities;
            EXPECT_EQ(isWhole, layer.seesBelow) << "where the candidates are those of the layer below";
            EXPECT_EQ(isWhole, layer.passes.empty());
            EXPECT_EQ(isWhole, layer.rangePenalties.large > layer.rangePenalties.leastLarge);
            const hdp::LayerPlan followed = hdp::adapt(plan, hdp::PairFindings(), { hdp::CONTINUED, true }).layers[i];
            EXPECT_EQ(isWhole, layer.rangePenalties.maxPrior < followed.rangePenalties.maxPrior)
                << "many frames know more";
            EXPECT_EQ(isWhole, layer.smoothness.least == followed.smoothness.least) << "likewise";
            EXPECT_EQ(isWhole ? 1 : 12 >> layer.layer, layer.smoothness.radius) << "one size in the image";
            EXPECT_EQ(layer.isFinest, layer.smoothness.least == +hdp::SmoothnessWeight::min);
            EXPECT_EQ(layer.isFinest, layer.smoothness.most == +hdp::SmoothnessWeight::max);
        }
    }
}

//! Noise of the image
hdp::PairFindings withNoise(double deviation)
{
    hdp::PairFindings findings;
    findings.noise.deviation = deviation;
    return findings;
}

const hdp::VideoFindings single = { hdp::FIRST, false };

TEST(HDPStereo_Plan, adapts_to_noise)
{
    const PairPlan plan = hdp::plan(parametersOf(M::PRESET_FAST), imageSize, CV_8UC3);
    const PairPlan quiet = hdp::adapt(plan, withNoise(0), single);
    EXPECT_EQ(0, quiet.finest().cost.tolerance);
    EXPECT_EQ(1, quiet.top().cost.tolerance) << "rounding and shading";
    const PairPlan some = hdp::adapt(plan, withNoise(2), single), much = hdp::adapt(plan, withNoise(4), single);
    EXPECT_LT(0, some.finest().cost.tolerance);
    EXPECT_LT(some.finest().cost.tolerance, much.finest().cost.tolerance);
    EXPECT_FALSE(some.top().smoothsGuide);
    EXPECT_TRUE(much.top().smoothsGuide) << "much above the threshold";
    EXPECT_EQ(0, quiet.finest().passes[0].edgeNoise);
    EXPECT_LT(0, some.finest().passes[0].edgeNoise);
    EXPECT_LT(some.finest().passes[0].edgeNoise, much.finest().passes[0].edgeNoise);
    EXPECT_EQ(255, hdp::adapt(plan, withNoise(1e4), single).finest().passes[0].edgeNoise);
    EXPECT_EQ(2, some.finest().noise) << "for surfaces that are smoothed";
    EXPECT_EQ(0, some.top().noise);
    EXPECT_EQ(20, some.finest().surfaceDifference) << "1.25 pixels";
    EXPECT_EQ(0, some.top().surfaceDifference) << "planes of trees";
    EXPECT_EQ(hdp::CensusCost::mostTolerance + 0, hdp::adapt(plan, withNoise(1e4), single).finest().cost.tolerance);

    MatcherParameters p = parametersOf(M::PRESET_FAST);
    p.noiseThreshold = 0;
    EXPECT_FALSE(hdp::adapt(hdp::plan(p, imageSize, CV_8UC3), withNoise(50), single).top().smoothsGuide);
}

TEST(HDPStereo_Plan, smooths_the_more_the_noisier_a_pair_is)
{
    MatcherParameters p = parametersOf(M::PRESET_FAST);
    const auto smoothing = [&](double noise) {
        return hdp::plan(p, imageSize, CV_8UC3).alignment.smoothing(withNoise(noise).noise);
    };
    EXPECT_EQ(0, smoothing(0));
    EXPECT_EQ(0, smoothing(2));
    int last = 0;
    for (double noise = 2.25; noise <= 4; noise += 0.25)
    {
        EXPECT_LT(last, smoothing(noise)) << noise;
        EXPECT_LE(smoothing(noise), last + 8) << noise << ", without a cliff";
        last = smoothing(noise);
    }
    EXPECT_EQ(hdp::mostSmoothing, smoothing(1e4));
    p.noiseThreshold = 1;
    EXPECT_EQ(0, smoothing(1));
    EXPECT_LT(0, smoothing(1.5));
    p.noiseThreshold = 0;
    EXPECT_EQ(0, smoothing(1e4));
}

//! The threshold is one of the finest layer's noise, whichever layer the image's size lets matches be followed to.
TEST(HDPStereo_Plan, noise_threshold_does_not_depend_on_the_size)
{
    for (const int preset : { (int)M::PRESET_FAST, (int)M::PRESET_ULTRAFAST })
    {
        const hdp::AlignmentPlan alignment = hdp::plan(parametersOf(preset), imageSize, CV_8UC3).alignment;
        for (double noise = 0.4; noise < 8; noise += 0.25) // of the finest layer
            for (int layer = 0; layer < 3; ++layer)
            {
                const hdp::LayerNoise finest = { noise, alignment.finestLayer };
                const hdp::LayerNoise seen = { finest.ofLayer(layer), layer };
                EXPECT_NEAR(alignment.smoothing(finest), alignment.smoothing(seen), 1)
                    << noise << " seen in layer " << layer;
            }
    }
}

TEST(HDPStereo_Plan, adapts_to_a_video)
{
    const hdp::VideoFindings videos[] = { { hdp::FIRST, false }, { hdp::CONTINUED, false }, { hdp::CONTINUED, true } };
    for (const int preset :
         { (int)M::PRESET_FAST, (int)M::PRESET_ULTRAFAST, (int)M::PRESET_QUALITY, (int)M::PRESET_TREE })
    {
        MatcherParameters p = parametersOf(preset);
        p.useTemporalPrediction = true;
        const PairPlan plan = hdp::plan(p, imageSize, CV_8UC3);
        EXPECT_TRUE(plan.followsVideo);
        for (const hdp::VideoFindings& video : videos)
        {
            SCOPED_TRACE(format("preset %d, verdict %d, prior %d", preset, video.verdict, video.predictsDisparities));
            PairPlan adapted = hdp::adapt(plan, withNoise(2), video);
            EXPECT_EQ(video.verdict == hdp::CONTINUED, adapted.top().checksLastFrame);
            EXPECT_EQ(video.predictsDisparities, adapted.top().prefersLastFrame);
            EXPECT_EQ(video.predictsDisparities, adapted.finest().cost.tolerance == 0)
                << "faint texture counts in several frames";
            const PairPlan alone = hdp::adapt(plan, withNoise(2), single);
            adapted.layers.front().checksLastFrame = adapted.layers.front().prefersLastFrame = false;
            for (size_t i = 0; i < alone.layers.size(); ++i)
            {
                adapted.layers[i].cost.tolerance = alone.layers[i].cost.tolerance;
                adapted.layers[i].rangePenalties.maxPrior = alone.layers[i].rangePenalties.maxPrior;
                adapted.layers[i].smoothness = alone.layers[i].smoothness;
            }
            EXPECT_EQ(textOf(alone), textOf(adapted)) << "else as a single frame";
        }
    }
}

TEST(HDPStereo_Plan, adapting_changes_nothing_else)
{
    for (int preset = M::PRESET_PAPER; preset <= M::PRESET_TREE; ++preset)
    {
        const PairPlan plan = hdp::plan(parametersOf(preset), imageSize, CV_8UC3);
        PairPlan adapted = hdp::adapt(plan, hdp::PairFindings(), single);
        for (size_t i = 0; i < plan.layers.size(); ++i)
            adapted.layers[i].cost.tolerance = plan.layers[i].cost.tolerance;
        EXPECT_EQ(textOf(plan), textOf(adapted)) << preset;
    }
}

}} // namespace opencv_test
