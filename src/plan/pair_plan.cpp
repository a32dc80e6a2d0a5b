// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_plan.hpp"

#include "../base/vectorized.hpp"
#include "../pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef HDPTreeMatcher M;

// Pixels, from which on images get what the authors' program has for Middlebury's full size, not its half size
const int largeImageWidth = 1000;

// Candidates. A top layer beyond the second one has no fewer: as many as a window of the scanlines.
const int minTopDisparities = CandidateWindow::candidates;

// Pixels. The maximum side of a window that a cost is averaged over.
const int maxWindow = 31;

HDP_TUNABLE(double, toleratedNoise, 0.45, "standard deviations of the noise",
            "what differs by less is not darker: more loses texture, less takes noise for it");

HDP_TUNABLE(double, guideNoise, 1, "grey levels above the threshold",
            "from which edges are those of a median: less loses edges, more takes noise for them");

HDP_TUNABLE(double, allCandidatesP2, 1.3, "P2",
            "the large penalty of scanlines over all candidates: more drags surfaces across borders, less keeps noise");

// Means over trees
HDP_TUNABLE(double, meanGamma, 0.2, "gamma of the trees' sums",
            "of means that scanlines get, on the first two layers: these carry costs farther by themselves, "
            "and more blurs borders; less on coarser layers, where each step goes farther");
HDP_TUNABLE(double, meanP1, 0.5, "P1",
            "of the top layer, as means are smoother than costs: more flattens slanted surfaces, less keeps noise");
HDP_TUNABLE(double, edgeGamma, 0.7, "gamma of the trees' sums",
            "of the large penalty: more drags surfaces across edges, less breaks textured ones");
HDP_TUNABLE(double, refinementGamma, 0.25, "gamma of the trees' sums",
            "of the non-local refinement: with the same one it blurs slanted surfaces");

HDP_TUNABLE(
    double, rangeBeta, 0.9, "share of the hull",
    "by which ranges of the caller overlap in a tree: more makes small trees, less searches what none may have");

// Scanlines over all candidates
HDP_TUNABLE(int, mostRangeDisparities, 97, "disparities",
            "of layers that are matched over the whole range: more take longer, fewer lose surfaces at their borders");
HDP_TUNABLE(int, rangePriorDistance, 3, "candidates",
            "from what the layer above has, for each of which a cost rises by half a bit: more keeps its errors, less "
            "loses bare surfaces");
HDP_TUNABLE(int, rangeMaxPrior, 2, "halves of a bit", "the most that it rises by, for the same reasons");

// Scanlines over windows
HDP_TUNABLE(int, edgeSlope, 4, "halves of a bit per grey level",
            "by which the large penalty falls at edges: more takes texture for borders, less drags surfaces over them");
HDP_TUNABLE(int, borderSlope, 10, "halves of a bit per grey level",
            "where two surfaces may be: an edge there is most likely their border");
HDP_TUNABLE(
    double, edgeNoise, 4, "standard deviations of the noise",
    "in an edge's weight, the largest of three differences: more loses faint borders, less takes noise for them");
HDP_TUNABLE(
    int, nearerCost, 1, "bits",
    "of another surface that is nearer: the windows of the cost see its edge beyond it; more loses thin things");
HDP_TUNABLE(int, firstPrior, 1, "bits per 2 pixels",
            "from the layer above, which may be wrong: more cannot be repaired, less loses bare surfaces");
HDP_TUNABLE(int, laterPrior, 2, "bits per 2 pixels", "from the pass before, which knows more than the layer above");

HDP_TUNABLE(
    int, smoothnessRadius, 12, "pixels of the layer above",
    "of the window that smoothness is weighed in, on the first layer: more mixes surfaces that differ, less counts "
    "too few steps");

HDP_TUNABLE(double, surfaceDifference, 1.25, "pixels",
            "of the disparities of a surface: less leaves its noise, more rounds small steps");

// The functions get parameters that plan() has completed.

//! The paper's winners, of sums over trees, whatever the layer
bool hasTreeSums(const MatcherParameters& p) { return p.aggregation == M::AGGREGATION_TREES; }

bool isLarge(Size size) { return size.width >= largeImageWidth; }

void checkCombinations(const MatcherParameters& p, Size size, bool hasPrior)
{
    const int64 min = ((int64)p.minDisparity - 1) * M::DISP_SCALE;
    const int64 max = ((int64)p.minDisparity + p.numDisparities - 1) * M::DISP_SCALE;
    if (min < SHRT_MIN || max > SHRT_MAX)
        CV_Error(
            Error::StsOutOfRange,
            format("minDisparity - 1 and minDisparity + numDisparities - 1 must be in %d..%d, as CV_16S has them times "
                   "%d; minDisparity is %d and numDisparities %d",
                   SHRT_MIN / M::DISP_SCALE, SHRT_MAX / M::DISP_SCALE, (int)M::DISP_SCALE, p.minDisparity,
                   p.numDisparities));
    const char* const needsCensus = !hasTreeSums(p)           ? "an aggregation by scanlines"
                                    : p.fillOcclusions        ? "fillOcclusions"
                                    : p.useTemporalPrediction ? "useTemporalPrediction"
                                    : hasPrior                ? "setPriorDisparity()"
                                                              : nullptr;
    if (needsCensus && p.matchingCost != M::COST_CENSUS)
        CV_Error(Error::StsBadArg, format("matchingCost must be COST_CENSUS for %s", needsCensus));
    if (p.speckleWindowSize > 0 && size.area() > INT_MAX / speckleBytes)
        CV_Error(Error::StsOutOfRange,
                 format("speckleWindowSize must be <= 0 for images of more than %d pixels", INT_MAX / speckleBytes));
}

//! The model of the predicted intervals; it has a layer less than the pyramid.
Ptr<DisparityPredictionModel> modelOf(const MatcherParameters& p, Size size)
{
    if (p.aggregation == M::AGGREGATION_SCANLINES)
        return Ptr<DisparityPredictionModel>();
    if (p.predictionModel)
        return p.predictionModel;
    return DisparityPredictionModel::createPublished(isLarge(size) ? DisparityPredictionModel::PUBLISHED_LARGE
                                                                   : DisparityPredictionModel::PUBLISHED_SMALL);
}

//! Number of layers of the pyramid
int countLayers(const MatcherParameters& p, Size size, const Ptr<DisparityPredictionModel>& model)
{
    if (!p.usePrediction)
        return 1;
    const int maxLayers = model ? model->getNumLayers() + 1 : INT_MAX;
    const int chosen = chooseLayers(p.numDisparities, p.numLayers, p.maxTopDisparities, maxLayers);
    int layers = 1; // each has at least a pixel
    while (layers < chosen && std::min(size.width, size.height) >> layers > 0)
        ++layers;
    if (model && model->getNumLayers() < layers - 1)
        CV_Error(Error::StsOutOfRange, format("predictionModel must have numLayers - 1 = %d layers, not %d", layers - 1,
                                              model->getNumLayers()));
    return layers;
}

//! Columns that are added on the left of the images, for the first ones to have their matches at negative disparities
int countExtension(const MatcherParameters& p, Size size, int type, int layers)
{
    const int missing = std::min(-p.minDisparity, p.numDisparities);
    const int extension = missing > 0 ? (int)alignSize(missing, 1 << (layers - 1)) : 0;
    const int64 width = (int64)size.width + extension;
    if (width > maxSide || width * size.height * (int64)CV_ELEM_SIZE(type) > INT_MAX)
        CV_Error(Error::StsOutOfRange,
                 format("minDisparity must not be %d for an image of %d x %d: %d columns are added to it",
                        p.minDisparity, size.width, size.height, extension));
    return extension;
}

CostPlan planCost(const MatcherParameters& p)
{
    CostPlan cost;
    cost.isCensus = p.matchingCost == M::COST_CENSUS;
    // Values that are not odd and positive count as with cv::StereoSGBM.
    const int side = p.blockSize > 0 ? p.blockSize / 2 * 2 + 1 : 5;
    cost.windowSide = cost.isCensus ? clamped(side, 3, 7) : std::min(side, maxWindow);
    if (!cost.isCensus)
        cost.colorGradient = { (float)p.colorTruncation, (float)p.gradientTruncation, (float)p.colorWeight,
                               cost.windowSide };
    return cost;
}

//! layer: its place and its own number of disparities are known, not those that are compared.
LayerMethod methodOf(const MatcherParameters& p, const LayerPlan& layer)
{
    if (hasTreeSums(p))
        return TREE_SUMS;
    if (layer.isTop)
        return p.topAggregation == M::AGGREGATION_TREE_SCANLINES ? TREE_SCANLINES
               : p.topAggregation == M::AGGREGATION_SCANLINES    ? COST_SCANLINES
                                                                 : TREE_SUMS;
    return !layer.isFinest && layer.numDisparities <= mostRangeDisparities ? RANGE_SCANLINES : WINDOW_SCANLINES;
}

TreePlan planTrees(const MatcherParameters& p, const LayerPlan& layer, Size size)
{
    TreePlan trees;
    if (!layer.isTop)
    {
        trees.prior = p.disparityPrior == M::PRIOR_UPPER_LAYER ? UPPER_LAYER : SUPPORT_POINTS;
        trees.upperDisparities = layerDisparities(p.numDisparities, layer.layer + 1, layer.hasFractions);
        // The values of the authors' program; the paper's text has those of large and small images the other way round.
        const double delta0 = p.delta0 != M::AUTO ? p.delta0 : isLarge(size) ? 0.064 : 0.004;
        trees.delta = delta0 * (1 << layer.layer);
        trees.margin = p.intervalMargin;
        trees.beta = p.beta != M::AUTO ? p.beta : isLarge(size) ? 0.6 : 0.95;
    }
    trees.linksTrees = !p.usePrediction;
    trees.gamma = layer.method == TREE_SCANLINES ? p.gamma * meanGamma / std::max(layer.layer, 1) : p.gamma;
    if (p.useNonLocalRefinement && hasTreeSums(p))
        trees.refinementGamma = p.gamma * refinementGamma;
    return trees;
}

//! For means of trees, for costs with what the last frame predicts, which are as smooth, and for costs as they are
VolumePenalties planVolume(const MatcherParameters& p, const LayerPlan& layer)
{
    const int scale = CostVolume::scale, large = cvRound(scale * allCandidatesP2 * p.P2);
    const int steps = layer.seesBelow ? 2 : 1; // candidates per pixel of disparity
    return { cvRound(scale * meanP1 * p.P1 / steps), std::min(large, +VolumePenalties::largest), p.gamma * edgeGamma };
}

RangePenalties planRange(const MatcherParameters& p)
{
    const auto halfBits = [](double bits) { return std::min(cvRound(2 * bits), +RangePenalties::largest); };
    RangePenalties penalties;
    penalties.small = halfBits(p.P1 / 2.); // candidates are half a pixel apart
    penalties.large = halfBits(allCandidatesP2 * p.P2);
    penalties.leastLarge = halfBits(p.P1); // another surface is nowhere cheaper than a step of a pixel
    penalties.gamma = p.gamma * edgeGamma;
    penalties.priorDistance = rangePriorDistance;
    penalties.maxPrior = rangeMaxPrior;
    return penalties;
}

//! A pass before another one would gain nothing on coarser layers.
std::vector<ScanlinePenalties> planPasses(const MatcherParameters& p, bool isFinest)
{
    std::vector<ScanlinePenalties> passes;
    for (int i = 0; i < (isFinest ? p.scanlinePasses : 1); ++i)
        passes.push_back({ p.P1, p.P2, edgeSlope, borderSlope, i == 0 ? firstPrior : laterPrior, nearerCost, 0 });
    return passes;
}

//! The window is the same in pixels of the image on each layer. What only predicts another layer is left nearer to what
//! is usual: that one cannot do without what it loses.
SmoothnessPlan planSmoothness(const LayerPlan& layer)
{
    const int one = SmoothnessWeight::one, radius = std::max(smoothnessRadius >> layer.layer, 1);
    if (layer.isFinest)
        return { radius, SmoothnessWeight::min, SmoothnessWeight::max };
    return { radius, one * 3 / 4, one * 5 / 4 };
}

LayerPlan planLayer(const MatcherParameters& p, Size size, int layer, int layers, int finest)
{
    LayerPlan plan;
    plan.layer = layer;
    plan.isTop = layer == layers - 1;
    plan.isFinest = layer == finest;
    plan.hasFractions = p.useSubpixel || !hasTreeSums(p);
    plan.numDisparities = layerDisparities(p.numDisparities, layer, plan.hasFractions);
    plan.maxDisparity = std::min(largestDisparity(p.numDisparities, layer), (plan.numDisparities - 1) * subpixelScale);
    plan.cost = planCost(p);
    plan.method = methodOf(p, plan);
    const bool hasVolume = plan.method == TREE_SCANLINES || plan.method == COST_SCANLINES;
    plan.seesBelow = (hasVolume && !plan.isFinest) || plan.method == RANGE_SCANLINES;
    if (plan.seesBelow)
        plan.numDisparities = layerDisparities(p.numDisparities, layer - 1, false);
    if (plan.method == WINDOW_SCANLINES)
    {
        plan.passes = planPasses(p, plan.isFinest);
        plan.smoothness = planSmoothness(plan);
    }
    else
        plan.smoothsGuide = p.useMedianPrefilter;
    if (plan.method == TREE_SUMS || plan.method == TREE_SCANLINES)
        plan.trees = planTrees(p, plan, size);
    if (hasVolume)
        plan.volumePenalties = planVolume(p, plan);
    if (plan.method == RANGE_SCANLINES)
        plan.rangePenalties = planRange(p);
    plan.fillsOcclusions = p.fillOcclusions;
    // As in the authors' program; the paper says that nothing is refined.
    plan.medianSize = p.disparityMedianSize != M::AUTO ? p.disparityMedianSize : p.usePrediction ? 7 : 5;
    const bool isFiltered = plan.medianSize > 0, isOfScanlines = isFiltered && !hasTreeSums(p);
    plan.restoresThinStructures = plan.isFinest && isOfScanlines;
    plan.votesAtEdges = layer == 0 && plan.cost.isCensus && isFiltered;
    // On the finest layer in pixels of the image, which it is the map of; others only predict.
    if (isOfScanlines && plan.cost.isCensus && (plan.isFinest || !plan.isTop))
        plan.surfaceDifference = (int)(surfaceDifference * subpixelScale) >> (plan.isFinest ? layer : 0);
    return plan;
}

//! What differs by less is as often noise as texture. Where several frames have agreed, their noise averages out, and
//! faint texture is worth more.
int censusTolerance(const LayerPlan& layer, const LayerNoise& noise, bool isPredicted)
{
    if (isPredicted)
        return 0;
    const int least = !layer.isFinest; // rounded means and faint shading are no texture
    const int tolerance = cvRound(toleratedNoise * greyScale * noise.ofLayer(layer.layer));
    return clamped(tolerance, least, +CensusCost::mostTolerance);
}

//! What is known of the range of disparities; empty: nothing
Range knownRange(Size size, const PairModel& model, const PairInputs& inputs)
{
    return model.empty() ? rangeOf(inputs, size.width)
                         : Range(model.minDisparity, model.minDisparity + model.numDisparities);
}

//! The parameters without those that depend on others. known: the range where they have none, a single disparity if
//! that is empty
MatcherParameters completed(MatcherParameters p, const Range& known)
{
    if (p.numDisparities == 0)
        p = known.empty() ? withRange(p, 0, 1) : withRange(p, known.start, known.size());
    if (p.aggregation == M::AGGREGATION_TREE_SCANLINES) // an older name for these two values together
    {
        p.aggregation = M::AGGREGATION_SCANLINES;
        p.topAggregation = M::AGGREGATION_TREE_SCANLINES;
    }
    if (!p.usePrediction) // there are no layers, and the plain tree algorithm matches the image
        p.aggregation = M::AGGREGATION_TREES;
    return p;
}

} // namespace

int chooseLayers(int numDisparities, int numLayers, int maxTopDisparities, int maxLayers)
{
    if (maxTopDisparities == 0)
        return numLayers;
    int layers = numLayers;
    const auto topDisparities = [&](int count) { return layerDisparities(numDisparities, count - 1, false); };
    while (layers > 2 && topDisparities(layers) < minTopDisparities)
        --layers;
    while (layers < maxLayers && topDisparities(layers) > maxTopDisparities &&
           topDisparities(layers + 1) >= minTopDisparities)
        ++layers;
    return layers;
}

PairPlan plan(const MatcherParameters& parameters, Size size, int type, const PairModel& model,
              const PairInputs& inputs)
{
    PairPlan plan;
    const Range known = parameters.numDisparities > 0 ? Range() : knownRange(size, model, inputs);
    plan.looksForRange = parameters.numDisparities == 0 && known.empty();
    MatcherParameters p = completed(parameters, known);
    checkCombinations(p, size, inputs.hasPrior());
    plan.hasRanges = inputs.limit(Range(p.minDisparity, p.minDisparity + p.numDisparities));
    if (plan.hasRanges) // the layer above was matched within them, and support points take as long as without
        p.disparityPrior = M::PRIOR_UPPER_LAYER;
    plan.size = size;
    plan.numDisparities = p.numDisparities;
    plan.treeStrategy = p.treeStrategy;
    // A tile is matched as the image that it is a part of.
    const Size whole = model.empty() ? size : Size(model.width, model.height);
    plan.predictionModel = modelOf(p, whole);
    const int layers = countLayers(p, whole, plan.predictionModel);
    checkPairModelOf(model, size, type, layers);
    const int finest = std::min(p.finestLayer, layers - 1);
    const bool isCensus = p.matchingCost == M::COST_CENSUS, isFloat = CV_MAT_DEPTH(type) == CV_32F;
    const int extension = countExtension(p, size, isFloat ? CV_16UC1 : type, layers); // see completePair()
    plan.pyramids = { p.minDisparity, extension,           layers, isCensus, p.noiseThreshold > 0,
                      whole.width,    isCensus && !isFloat };
    plan.alignment = { p.numDisparities, p.maxRowOffset, p.useLightAlignment, p.noiseThreshold, finest };
    plan.given = toGivenPair(model, plan.pyramids, size);
    plan.hasPrior = inputs.hasPrior();
    plan.followsVideo = p.useTemporalPrediction;
    for (int layer = layers - 1; layer >= finest; --layer)
    {
        plan.layers.push_back(planLayer(p, whole, layer, layers, finest));
        plan.layers.back().frame = plan.given.frame.ofLayer(layer);
    }
    if (plan.hasRanges && plan.top().method == TREE_SUMS)
        plan.layers.front().trees.beta = rangeBeta;
    const int speckleRange = p.speckleWindowSize > 0 ? p.speckleRange : 0;
    plan.output = { p.minDisparity,  extension,           finest,      !p.useSubpixel,
                    p.disp12MaxDiff, p.speckleWindowSize, speckleRange };
    return plan;
}

PairPlan adapt(const PairPlan& plan, const PairFindings& findings, const VideoFindings& video)
{
    PairPlan adapted = plan;
    const bool hasNoisyGuide = plan.alignment.excessNoise(findings.noise) >= guideNoise;
    for (LayerPlan& layer : adapted.layers)
    {
        // With what the last frame predicts, the layer above has its disparities from many frames.
        if (video.predictsDisparities && layer.method == RANGE_SCANLINES)
            layer.rangePenalties.maxPrior = RangePenalties::mostPrior;
        if (video.predictsDisparities && layer.method == WINDOW_SCANLINES)
            layer.smoothness.least = SmoothnessWeight::one;
        if (layer.cost.isCensus)
            layer.cost.tolerance = censusTolerance(layer, findings.noise, video.predictsDisparities);
        for (ScanlinePenalties& penalties : layer.passes)
            penalties.edgeNoise = saturate_cast<uchar>(edgeNoise * findings.noise.ofLayer(layer.layer));
        if (layer.surfaceDifference > 0)
            layer.noise = findings.noise.ofLayer(layer.layer);
        layer.smoothsGuide |= layer.method != WINDOW_SCANLINES && hasNoisyGuide;
    }
    LayerPlan& top = adapted.layers.front();
    top.checksLastFrame = video.verdict == CONTINUED && top.method == TREE_SCANLINES;
    top.prefersLastFrame = video.predictsDisparities && (top.method == TREE_SCANLINES || top.method == COST_SCANLINES);
    return adapted;
}

}}} // namespace cv::stereo::hdp
