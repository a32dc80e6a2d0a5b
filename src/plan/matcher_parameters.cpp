// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "matcher_parameters.hpp"
#include "../base/named_values.hpp"

#include "../forest/disparity_forest.hpp"
#include "../scanlines/scanline_aggregation.hpp"

#include <cmath>

// The parameters by name: presets, valid values, files.

namespace cv { namespace stereo {

namespace {

typedef HDPTreeMatcher M;

const int maxPenalty = hdp::ScanlinePenalties::max;

bool isIn(int value, int first, int last) { return first <= value && value <= last; }
bool isNotNegative(double value) { return std::isfinite(value) && value >= 0; }

// The lists, in the order of a file: name, value, whether it is valid, and the valid values in words. Parameters and
// Visitor may be constant.

//! What only cv::StereoMatcher has
template <typename Parameters, typename Visitor> void visitRange(Parameters& p, const Visitor& visit)
{
    visit("minDisparity", p.minDisparity);
    visit("numDisparities", p.numDisparities, p.numDisparities >= 0, ">= 0");
    visit("speckleWindowSize", p.speckleWindowSize);
    visit("speckleRange", p.speckleRange, p.speckleRange >= 0, ">= 0");
    visit("disp12MaxDiff", p.disp12MaxDiff);
}

//! HDPTreeMatcher::Params, but for what is not a number
template <typename Parameters, typename Visitor> void visitParams(Parameters& p, const Visitor& visit)
{
    visit("disparityDepth", p.disparityDepth, p.disparityDepth == CV_16S || p.disparityDepth == CV_32F,
          "CV_16S or CV_32F");
    visit("useTemporalPrediction", p.useTemporalPrediction);
    visit("maxRowOffset", p.maxRowOffset, p.maxRowOffset >= 0, ">= 0");
    visit("useLightAlignment", p.useLightAlignment);
    visit("noiseThreshold", p.noiseThreshold, isNotNegative(p.noiseThreshold), "finite and >= 0");
    visit("usePrediction", p.usePrediction);
    visit("numLayers", p.numLayers, isIn(p.numLayers, 1, 16), "in 1..16");
    visit("maxTopDisparities", p.maxTopDisparities, p.maxTopDisparities >= 0, ">= 0");
    visit("finestLayer", p.finestLayer, isIn(p.finestLayer, 0, 15), "in 0..15");
    visit("matchingCost", p.matchingCost, isIn(p.matchingCost, M::COST_COLOR_GRADIENT, M::COST_CENSUS),
          "COST_COLOR_GRADIENT or COST_CENSUS");
    visit("blockSize", p.blockSize);
    visit("colorTruncation", p.colorTruncation, isNotNegative(p.colorTruncation), "finite and >= 0");
    visit("gradientTruncation", p.gradientTruncation, isNotNegative(p.gradientTruncation), "finite and >= 0");
    visit("colorWeight", p.colorWeight, p.colorWeight >= 0 && p.colorWeight <= 1, "in [0, 1]");
    const auto isAggregation = [](int a) { return isIn(a, M::AGGREGATION_TREES, M::AGGREGATION_TREE_SCANLINES); };
    const char* const aggregations = "AGGREGATION_TREES, AGGREGATION_SCANLINES or AGGREGATION_TREE_SCANLINES";
    visit("aggregation", p.aggregation, isAggregation(p.aggregation), aggregations);
    visit("topAggregation", p.topAggregation, isAggregation(p.topAggregation), aggregations);
    visit("gamma", p.gamma, isNotNegative(p.gamma) && p.gamma > 0, "finite and > 0");
    visit("useMedianPrefilter", p.useMedianPrefilter);
    visit("disparityPrior", p.disparityPrior, isIn(p.disparityPrior, M::PRIOR_SUPPORT_POINTS, M::PRIOR_UPPER_LAYER),
          "PRIOR_SUPPORT_POINTS or PRIOR_UPPER_LAYER");
    visit("delta0", p.delta0, p.delta0 == M::AUTO || (p.delta0 >= 0 && p.delta0 < 1), "in [0, 1) or AUTO");
    visit("beta", p.beta, p.beta == M::AUTO || (p.beta >= 0 && p.beta <= 1), "in [0, 1] or AUTO");
    visit("intervalMargin", p.intervalMargin, isIn(p.intervalMargin, 0, 64), "in 0..64");
    visit("P1", p.P1, isIn(p.P1, 0, maxPenalty), "in 0..100");
    visit("P2", p.P2, isIn(p.P2, 0, maxPenalty), "in 0..100");
    visit("scanlinePasses", p.scanlinePasses, isIn(p.scanlinePasses, 1, 4), "in 1..4");
    visit("useSubpixel", p.useSubpixel);
    const int side = p.disparityMedianSize;
    visit("disparityMedianSize", p.disparityMedianSize,
          side == M::AUTO || side == 0 || side == 3 || side == 5 || side == 7, "0, 3, 5, 7 or AUTO");
    visit("fillOcclusions", p.fillOcclusions);
    visit("useNonLocalRefinement", p.useNonLocalRefinement);
}

void checkParams(const M::Params& params)
{
    visitParams(params, hdp::ValueChecker{ "" });
    if (!params.treeStrategy)
        CV_Error(Error::StsNullPtr, "treeStrategy must not be empty");
}

Ptr<TreeStrategy> readStrategy(const FileNode& fn, const Ptr<TreeStrategy>& own)
{
    if (!fn.isMap() || !fn["strategy"].isString())
        CV_Error(Error::StsParseError, "treeStrategy must name a strategy");
    const String name = (String)fn["strategy"];
    const Ptr<TreeStrategy> strategy = hdp::createTreeStrategy(name);
    if (strategy)
    {
        strategy->read(fn);
        return strategy;
    }
    if (!own || name != own->getDefaultName()) // only the caller can create it
        CV_Error(Error::StsParseError, "treeStrategy: set a strategy named " + name + " before reading");
    return own;
}

} // namespace

HDPTreeMatcher::Params::Params(int preset)
{
    if (preset < PRESET_PAPER || preset > PRESET_TREE)
        CV_Error(Error::StsOutOfRange, format("preset must be one of HDPTreeMatcher::PRESET_*, %d..%d, not %d; "
                                              "it is no blockSize, which setBlockSize() sets",
                                              (int)PRESET_PAPER, (int)PRESET_TREE, preset));
    const bool isPaper = preset == PRESET_PAPER, isTree = preset == PRESET_TREE, isQuality = preset == PRESET_QUALITY;

    disparityDepth = CV_16S;
    useTemporalPrediction = false;

    maxRowOffset = isPaper ? 0 : 64;
    useLightAlignment = !isPaper;
    noiseThreshold = isPaper ? 0 : 2;

    usePrediction = true;
    numLayers = isQuality || isTree ? 2 : 3; // PAPER: as in the authors' program; "L = 3" in the paper would be four
    // Between the numbers that users choose, such as 96, 128 and 256: one disparity more has the same layers.
    maxTopDisparities = isPaper ? 0 : isTree ? 90 : isQuality ? 55 : 45;
    finestLayer = preset == PRESET_ULTRAFAST ? 1 : 0;

    matchingCost = isPaper ? COST_COLOR_GRADIENT : COST_CENSUS;
    blockSize = isPaper ? 1 : 7;
    colorTruncation = 10; // these three, and the gamma of PAPER, are from the authors' program; the paper has no values
    gradientTruncation = 2;
    colorWeight = 0.11;

    aggregation = isPaper ? AGGREGATION_TREES : AGGREGATION_SCANLINES;
    topAggregation = isPaper ? AGGREGATION_TREES : AGGREGATION_TREE_SCANLINES;
    treeStrategy = isPaper ? createMinimumSpanningTree() : createSegmentTree(); // planes need segments
    gamma = isPaper ? 25.5 : 20;
    useMedianPrefilter = false;

    // TREE: better than the paper's for the census, if aggregation becomes AGGREGATION_TREES
    disparityPrior = isTree ? PRIOR_UPPER_LAYER : PRIOR_SUPPORT_POINTS;
    delta0 = isTree ? 0.02 : (double)AUTO;
    beta = isTree ? 0.9 : (double)AUTO;
    intervalMargin = isTree ? 2 : 0;

    P1 = 16;
    P2 = 65;
    scanlinePasses = isQuality ? 2 : 1;

    useSubpixel = !isPaper;
    disparityMedianSize = isPaper ? (int)AUTO : isQuality ? 7 : 5;
    fillOcclusions = !isPaper;
    useNonLocalRefinement = false;
}

void HDPTreeMatcher::Params::write(FileStorage& fs) const
{
    visitParams(*this, hdp::ValueWriter{ fs });
    CV_Assert(treeStrategy);
    fs.startWriteStruct("treeStrategy", FileNode::MAP);
    fs << "strategy" << treeStrategy->getDefaultName();
    treeStrategy->write(fs);
    fs.endWriteStruct();
    if (predictionModel)
    {
        fs.startWriteStruct("predictionModel", FileNode::MAP);
        predictionModel->write(fs);
        fs.endWriteStruct();
    }
}

void HDPTreeMatcher::Params::read(const FileNode& fn)
{
    if (!fn.isMap())
        CV_Error(Error::StsParseError, "parameters must be a map");
    Params params(PRESET_PAPER);
    visitParams(params, hdp::ValueReader{ fn, "", true });
    if (!fn["treeStrategy"].empty())
        params.treeStrategy = readStrategy(fn["treeStrategy"], treeStrategy);
    if (!fn["predictionModel"].empty())
    {
        params.predictionModel = DisparityPredictionModel::create();
        params.predictionModel->read(fn["predictionModel"]);
    }
    checkParams(params);
    *this = params;
}

namespace hdp {

void checkParameters(const MatcherParameters& parameters)
{
    visitRange(parameters, ValueChecker{ "" });
    checkParams(parameters);
}

void writeParameters(const MatcherParameters& parameters, FileStorage& fs)
{
    visitRange(parameters, ValueWriter{ fs });
    parameters.write(fs);
}

MatcherParameters readParameters(const FileNode& fn, const Ptr<TreeStrategy>& ownStrategy)
{
    MatcherParameters parameters;
    visitRange(parameters, ValueReader{ fn, "", true });
    parameters.treeStrategy = ownStrategy; // for files that name it
    parameters.read(fn);
    visitRange(parameters, ValueChecker{ "" });
    return parameters;
}

} // namespace hdp

}} // namespace cv::stereo
