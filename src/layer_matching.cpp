// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "layer_matching.hpp"

#include "scanlines/candidate_windows.hpp"
#include "forest/disparity_prediction.hpp"
#include "map/disparity_refinement.hpp"
#include "pair/image_levels.hpp"
#include "pair/image_pyramid.hpp"
#include "paper/nonlocal_refinement.hpp"
#include "scanlines/sparse_matches.hpp"
#include "video/temporal_prior.hpp"
#include "forest/tree_planes.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const int secondPassMedian = 5;

// Of the census's tolerance: in standard deviations of the noise, and the layer from which on it is at least 1
const double toleratedNoise = 0.45;
const int coarseLayer = 2;

// Of the means that scanlines get, gamma relative to that of the trees alone: scanlines reach farther
const double meanGamma = 0.2;

// Their large penalty, relative to P2, and its gamma, relative to that of the trees
const double meanP2 = 1.3;
const double edgeGamma = 0.7;

// Layers below one without trees
const int repairingLayers = 2;

// ScanlinePenalties::edgeSlope: on the finest layer the edges are those of surfaces, unless they are those of the noise.
const int finestSlope = 5, usualSlope = 3;

// Of the non-local refinement: a stable disparity's largest difference in the left-right check, and gamma, relative to
// that of the cost; with the same gamma the refinement blurs slanted surfaces.
const int stableMaxDiff = 1;
const double refinementGamma = 0.25;

int disparitiesOf(const LayerInput& in, int layer)
{
    return layerDisparities(in.parameters.numDisparities, layer, in.settings.subpixel);
}

int disparitiesOf(const LayerInput& in) { return disparitiesOf(in, in.layer); }

//! Of the layer's map
int largestDisparity(const LayerInput& in) { return hdp::largestDisparity(in.parameters.numDisparities, in.layer); }

//! Of the census. Less is as often noise as texture; on coarse layers, the rounding of the image and shading.
int censusTolerance(const LayerInput& in)
{
    // Faint texture is worth more than noise costs if the noise of several frames averages out. Where nothing moves, the
    // disparities of the last frame are kept anyway.
    if (in.prediction && in.prediction->isMoving() && in.layer < coarseLayer)
        return 0;
    const int tolerance = cvRound(toleratedNoise * greyScale * in.alignment.noise.ofLayer(in.layer));
    return std::min(std::max(tolerance, (int)(in.layer >= coarseLayer)), CensusCost::mostTolerance + 0);
}

void prepareCost(const LayerInput& in, MatchedLayer& matched)
{
    const MatcherParameters& p = in.parameters;
    const LayerImages& images = in.images;
    matched.isCensus = p.matchingCost == HDPTreeMatcher::COST_CENSUS;
    if (matched.isCensus)
        return matched.census.prepare(images.left, images.right, disparitiesOf(in), in.settings.windowSide,
                                      censusTolerance(in));
    const ColorGradientParams params = { (float)p.colorTruncation, (float)p.gradientTruncation, (float)p.colorWeight,
                                         in.settings.windowSide };
    matched.colorGradient.prepare(images.left, images.right, disparitiesOf(in), params);
}

//! P(D_l) of section 3.1
void estimatePrior(const LayerInput& in, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched)
{
    const int disparities = disparitiesOf(in);
    if (in.parameters.disparityPrior == HDPTreeMatcher::PRIOR_UPPER_LAYER)
        return clock.run("disparity prediction",
                         [&] { upperHistogram(in.upper->disparity, disparities, matched.prior); });
    clock.run("support points", [&] {
        Mat left = in.images.left, right = in.images.right;
        if (left.depth() != CV_8U) // greyLevels()
        {
            left.convertTo(left, CV_8U, 1. / greyScale);
            right.convertTo(right, CV_8U, 1. / greyScale);
        }
        // Those of the left image; the authors' program counts those of the right one, too.
        findSupportPoints(left, right, disparities, buffers.supportPoints, buffers.points);
        disparityHistogram(buffers.points, disparities, matched.prior);
    });
}

//! PixelIntv of section 3.1; at the top layer the full range
void predict(const LayerInput& in, LayerBuffers& buffers, MatchedLayer& matched)
{
    const Size size = in.images.guide.size();
    if (in.isTop())
    {
        matched.pixelIntv.create(size, CV_16UC2);
        matched.pixelIntv.setTo(Scalar(0, disparitiesOf(in) - 1));
        return;
    }
    const PairSettings& settings = in.settings;
    const int upperDisparities = disparitiesOf(in, in.layer + 1);
    predictIntervals(*settings.model, in.layer, matched.prior, upperDisparities, settings.delta0 * (1 << in.layer),
                     in.parameters.intervalMargin, buffers.intervals);
    assignIntervals(in.upper->disparity, size, buffers.intervals, matched.pixelIntv);
}

//! What gives the edge weights. The median is that of the M+ systems, and of noisy pairs; as in the authors' program, the
//! cost does not see it.
const Mat& guideOf(const LayerInput& in, MatchedLayer& matched)
{
    if (!in.parameters.useMedianPrefilter && !in.alignment.isNoisy)
        return in.images.guide;
    medianBlur(in.images.guide, matched.guide, 3);
    return matched.guide;
}

//! Section 3.2
void growForest(const LayerInput& in, LayerBuffers& buffers, MatchedLayer& matched)
{
    const MatcherParameters& p = in.parameters;
    buffers.forestLayer = in.layer;
    buildForest(guideOf(in, matched), matched.pixelIntv, *p.treeStrategy, in.settings.beta, !p.usePrediction,
                buffers.forestBuffers, buffers.forest);
}

bool hasTreeScanlines(const LayerInput& in)
{
    const MatcherParameters& p = in.parameters;
    const int aggregation =
        in.isTop() && p.aggregation == HDPTreeMatcher::AGGREGATION_SCANLINES ? p.topAggregation : p.aggregation;
    return p.usePrediction && aggregation == HDPTreeMatcher::AGGREGATION_TREE_SCANLINES;
}

//! Means of costs are smoother, and so is what the last frame predicts: half of P1.
VolumePenalties volumePenalties(const MatcherParameters& p)
{
    const int scale = CostVolume::scale, large = cvRound(scale * meanP2 * p.P2);
    return { scale * p.P1 / 2, std::min(large, +VolumePenalties::largest), p.gamma * edgeGamma };
}

bool hasPrior(const LayerInput& in) { return in.isTop() && in.prediction && hasPrior(in.lastFrame, *in.prediction); }

void preferLastFrame(const LayerInput& in, bool areMeans, CostVolume& volume)
{
    const int side = 1 << (in.layer - in.settings.finestLayer);
    preferLastFrame(in.lastFrame, *in.prediction, side, areMeans, volume);
}

//! Scanlines over the means of the costs in the layer's trees
void aggregateTreeScanlines(const LayerInput& in, LayerBuffers& buffers, MatchedLayer& matched)
{
    const MatcherParameters& p = in.parameters;
    const VolumePenalties penalties = volumePenalties(p);
    aggregateMeans(buffers.forest, matched.cost(), p.gamma * meanGamma, buffers.aggregation, buffers.volume);
    if (hasPrior(in))
        preferLastFrame(in, true, buffers.volume);
    const Mat& weights = buffers.forest.weights;
    aggregateVolume(buffers.volume, weights, penalties, buffers.volumeScanlines, matched.winner);
    if (in.isTop() && preferTreePlanes(buffers.forest, matched.winner, buffers.volume) > 0)
        aggregateVolume(buffers.volume, weights, penalties, buffers.volumeScanlines, matched.winner);
}

//! What follows each winner-takes-all
void finishWinners(const LayerInput& in, StageClock& clock, MatchedLayer& matched)
{
    if (in.settings.subpixel && in.layer > 0) // the last candidate may be beyond the range
        min(matched.winner, largestDisparity(in), matched.winner);
    if (in.parameters.fillOcclusions)
        clock.run("occlusions", [&] {
            matched.census.ofDisparities(matched.winner, matched.residual);
            fillOccluded(matched.winner, matched.residual, in.images.right);
        });
}

//! Sections 3.1 to 3.3
void aggregateTrees(const LayerInput& in, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched)
{
    const MatcherParameters& p = in.parameters;
    if (!in.isTop())
        estimatePrior(in, buffers, clock, matched);
    clock.run("disparity prediction", [&] { predict(in, buffers, matched); });
    clock.run("disparity forest", [&] { growForest(in, buffers, matched); });
    matched.searchRatio = searchRatio(buffers.forest, disparitiesOf(in));
    clock.run("cost aggregation", [&] {
        if (hasTreeScanlines(in))
            return aggregateTreeScanlines(in, buffers, matched);
        aggregateForest(buffers.forest, matched.cost(), p.gamma, in.settings.subpixel, buffers.aggregation,
                        matched.winner);
    });
    finishWinners(in, clock, matched);
}

//! Whether the top layer needs no trees: the last frame brings surfaces where texture is faint, as they would, and the
//! scanlines of the layers below repair the rest.
bool isPredictedByVideo(const LayerInput& in)
{
    return hasPrior(in) && hasTreeScanlines(in) && in.parameters.aggregation == HDPTreeMatcher::AGGREGATION_SCANLINES &&
           in.layer - in.settings.finestLayer >= repairingLayers;
}

//! Scanlines over the costs as they are, and the last frame's prior
void aggregateWithLastFrame(const LayerInput& in, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched)
{
    buffers.forgetForest();
    matched.searchRatio = 1;
    clock.run("disparity prediction", [&] {
        const DisparityInterval all = { 0, (ushort)(disparitiesOf(in) - 1) };
        buffers.volume.fill(matched.census, in.images.guide.size(), all);
        preferLastFrame(in, false, buffers.volume);
    });
    clock.run("cost aggregation", [&] {
        weighEdges(guideOf(in, matched), matched.weights);
        aggregateVolume(buffers.volume, matched.weights, volumePenalties(in.parameters), buffers.volumeScanlines,
                        matched.winner);
    });
    finishWinners(in, clock, matched);
}

//! Predicted windows instead of trees. Each pass but the first takes its windows from the disparities of the one
//! before, and trusts them more than those of the layer above.
void aggregateScanlines(const LayerInput& in, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched)
{
    const MatcherParameters& p = in.parameters;
    const int disparities = disparitiesOf(in);
    matched.searchRatio = std::min<double>(CandidateWindow::candidates, disparities) / disparities;
    clock.run("disparity prediction",
              [&] { findSparseMatches(matched.census, in.images.left.size(), disparities, matched.matches); });
    for (int pass = 0; pass < p.scanlinePasses; ++pass)
    {
        if (pass > 0)
            clock.run("disparity median", [&] {
                medianDisparity(matched.winner, secondPassMedian, matched.filtered);
                halveDisparity(matched.filtered, matched.lastPass);
                halveDisparity(matched.winner, matched.lastUnfiltered);
            });
        clock.run("disparity prediction", [&] {
            const WindowPrediction prediction = { pass > 0 ? matched.lastPass : in.upper->disparity,
                                                  pass > 0 ? matched.lastUnfiltered : in.upper->unfiltered,
                                                  matched.matches };
            predictWindows(prediction, disparities, matched.windowBuffers, matched.windows);
        });
        clock.run("cost aggregation", [&] {
            const int slope = in.isFinest() && !in.alignment.isNoisy ? finestSlope : usualSlope;
            const ScanlinePenalties penalties = { p.P1, p.P2, slope, pass == 0 ? 1 : 2 };
            // The direction from below costs half as much as the others together: at full size, it waits for the second
            // pass.
            const bool hasFromBelow = in.layer > 0 || pass > 0;
            aggregateScanlines(matched.census, in.images.left, disparities, largestDisparity(in), matched.windows,
                               penalties, hasFromBelow, buffers.scanlines, matched.winner, matched.residual);
        });
        if (p.fillOcclusions)
            clock.run("occlusions", [&] { fillOccluded(matched.winner, matched.residual, in.images.right); });
    }
}

//! Refines the winners over the layer's forest.
void refine(const LayerInput& in, LayerBuffers& buffers, MatchedLayer& matched)
{
    swap(matched.winner, matched.disparity);
    findStable(matched.disparity, stableMaxDiff, matched.stable);
    refineNonLocal(buffers.forest, matched.disparity, matched.stable, in.parameters.gamma * refinementGamma,
                   in.settings.subpixel, buffers.aggregation, matched.winner);
}

//! From the winners to the layer's disparities. The authors' program has this median; the paper has no such filter.
void filter(const LayerInput& in, MatchedLayer& matched)
{
    swap(matched.winner, matched.unfiltered);
    const int size = in.settings.medianSize;
    if (size == 0)
        return matched.unfiltered.copyTo(matched.disparity);
    medianDisparity(matched.unfiltered, size, matched.disparity);
    for (int pass = 1; pass < in.parameters.disparityMedianPasses; ++pass)
    {
        swap(matched.disparity, matched.winner);
        medianDisparity(matched.winner, size, matched.disparity);
    }
    if (in.isFinest() && in.parameters.aggregation == HDPTreeMatcher::AGGREGATION_SCANLINES)
        restoreThinStructures(matched.unfiltered, matched.disparity);
}

} // namespace

Verdict matchLayer(const LayerInput& in, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched)
{
    matched.prior.clear();
    const bool hasTrees = in.parameters.aggregation != HDPTreeMatcher::AGGREGATION_SCANLINES;
    clock.run("matching cost", [&] { prepareCost(in, matched); });
    if (isPredictedByVideo(in))
        aggregateWithLastFrame(in, buffers, clock, matched);
    else if (in.isTop() || hasTrees)
        aggregateTrees(in, buffers, clock, matched);
    else
        aggregateScanlines(in, buffers, clock, matched);
    if (in.parameters.useNonLocalRefinement && hasTrees)
        clock.run("non-local refinement", [&] { refine(in, buffers, matched); });
    Verdict verdict = FIRST;
    if (in.prediction && in.isFinest())
        clock.run("temporal prediction", [&] {
            verdict = joinLastFrame(matched.census, in.lastFrame, *in.prediction, buffers.video, buffers.frame,
                                    matched.winner);
        });
    clock.run("disparity median", [&] { filter(in, matched); });
    return verdict;
}

}}} // namespace cv::stereo::hdp
