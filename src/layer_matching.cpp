// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "layer_matching.hpp"

#include "forest/repeated_surfaces.hpp"
#include "forest/tree_planes.hpp"
#include "map/left_right_check.hpp"
#include "map/map_filters.hpp"
#include "map/occlusion_filling.hpp"
#include "paper/disparity_prediction.hpp"
#include "paper/nonlocal_refinement.hpp"
#include "video/temporal_prior.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, passMedianSize, 5, "pixels",
            "side of the median between passes of the scanlines: larger loses thin structures, smaller keeps outliers");
const int guideMedianSize = 3; // pixels, as in the M+ systems: larger blurs edges

//! Carries out the plan of a layer. result.winners are the layer's disparities from the winner-takes-all to the median.
class LayerMatching
{
public:
    const LayerInput& in_;
    const LayerPlan& plan_;
    LayerScratch& own_;
    SharedScratch& shared_;
    StageClock& clock_;
    LayerResult& result_;

    Verdict run()
    {
        result_.prior.clear();
        if (plan_.method == COST_SCANLINES)
            matchCosts();
        else if (plan_.method == WINDOW_SCANLINES)
            matchWindows();
        else if (plan_.method == RANGE_SCANLINES)
            matchRange();
        else if (!matchTrees())
            return CONTRADICTED;
        if (plan_.trees.refinementGamma > 0)
            clock_.run("non-local refinement", [&] { refine(); });
        Verdict verdict = FIRST;
        if (plan_.isFinest && in_.pair.followsVideo)
            clock_.run("temporal prediction", [&] {
                verdict = joinLastFrame(own_.census, in_.lastFrame, in_.prediction, shared_.video, shared_.frame,
                                        result_.winners);
            });
        clock_.run("disparity median", [&] { filter(); });
        return verdict;
    }

private:
    //! Sections 3.1 to 3.3: over the candidates of disparity trees. Returns false if these contradict the last frame.
    bool matchTrees()
    {
        estimatePrior();
        clock_.run("disparity prediction", [&] { predictCandidates(); });
        clock_.run("disparity forest", [&] { growForest(); });
        result_.searchRatio = searchRatio(shared_.forest, plan_.numDisparities);
        bool agrees = true;
        clock_.run("cost aggregation", [&] {
            if (plan_.method == TREE_SCANLINES)
                agrees = aggregateTreeMeans();
            else
                aggregateForest(shared_.forest, own_.cost(plan_.cost), plan_.trees.gamma, plan_.hasFractions,
                                shared_.sums, result_.winners);
        });
        if (agrees)
            finishWinners();
        return agrees;
    }

    //! P(D_l) of section 3.1
    void estimatePrior()
    {
        if (plan_.trees.prior == UPPER_LAYER)
            clock_.run("disparity prediction",
                       [&] { upperHistogram(in_.upper->disparity, plan_.numDisparities, result_.prior); });
        else if (plan_.trees.prior == SUPPORT_POINTS)
            clock_.run("support points", [&] { priorOfSupportPoints(); });
    }

    //! P(D_l) from support points of the left image; the authors' program counts those of the right one, too.
    void priorOfSupportPoints()
    {
        Mat left = in_.images.left, right = in_.images.right;
        if (left.depth() != CV_8U) // in 1 / greyScale of a level
        {
            left.convertTo(left, CV_8U, 1. / greyScale);
            right.convertTo(right, CV_8U, 1. / greyScale);
        }
        findSupportPoints(left, right, plan_.numDisparities, shared_.supportPointBuffers, shared_.supportPoints);
        disparityHistogram(shared_.supportPoints, plan_.numDisparities, result_.prior);
    }

    //! PixelIntv of section 3.1
    void predictCandidates()
    {
        const TreePlan& trees = plan_.trees;
        const Size size = in_.images.guide.size();
        if (trees.prior == FULL_RANGE)
        {
            own_.pixelIntv.create(size, CV_16UC2);
            own_.pixelIntv.setTo(Scalar(0, plan_.numDisparities - 1));
        }
        else
        {
            predictIntervals(*in_.pair.predictionModel, plan_.layer, result_.prior, trees.upperDisparities, trees.delta,
                             trees.margin, shared_.intervals);
            assignIntervals(in_.upper->disparity, size, shared_.intervals, own_.pixelIntv);
        }
        if (in_.pair.hasRanges && plan_.method == TREE_SUMS)
            intersectIntervals(candidateIntervals(), own_.pixelIntv);
    }

    //! What gives the edge weights. The median is that of the M+ systems, and of noisy pairs; as in the authors'
    //! program, the cost does not see it.
    const Mat& guide()
    {
        if (!plan_.smoothsGuide)
            return in_.images.guide;
        medianBlur(in_.images.guide, own_.guide, guideMedianSize);
        return own_.guide;
    }

    //! Section 3.2
    void growForest()
    {
        shared_.forestLayer = plan_.layer;
        buildForest(guide(), own_.pixelIntv, *in_.pair.treeStrategy, plan_.trees.beta, plan_.trees.linksTrees,
                    shared_.forestBuffers, shared_.forest);
    }

    //! Scanlines over the means of the costs in the layer's trees. Returns false, without any, if these contradict the
    //! last frame.
    bool aggregateTreeMeans()
    {
        const DisparityForest& forest = shared_.forest;
        CostVolume& volume = shared_.volume;
        aggregateMeans(forest, TwoLayerCost(own_.census, in_.below), plan_.numDisparities, plan_.trees.gamma,
                       shared_.means, volume);
        excludeBeyondRanges();
        if (plan_.checksLastFrame)
        {
            predictFromLastFrame();
            if (refusesLastFrame(volume, shared_.predicted))
                return false;
        }
        if (plan_.prefersLastFrame)
            preferPredicted(shared_.predicted, volume);
        preferLargestSurfaces(own_.census, volume);
        scanVolume(forest.weights);
        takeTreePlanes(forest, volume, result_.winners);
        return true;
    }

    void excludeBeyondRanges()
    {
        if (in_.pair.hasRanges)
            excludeCandidates(candidateIntervals(), shared_.volume);
    }

    //! Winners of the volume; weights: see weighEdges()
    void scanVolume(const Mat& weights)
    {
        aggregateVolume(shared_.volume, weights, plan_.volumePenalties, shared_.volumeSums, result_.winners);
    }

    //! DisparityInterval of each pixel, in the candidates that are compared; empty without ranges
    Mat candidateIntervals() const { return in_.pair.hasRanges ? in_.known.candidates[plan_.layer] : Mat(); }

    void predictFromLastFrame()
    {
        const int side = 1 << (plan_.layer - in_.pair.finest().layer);
        predictDisparities(in_.lastFrame, in_.prediction, side, in_.images.guide.size(), shared_.predicted);
    }

    //! Scanlines over the costs as they are, and what the last frame predicts
    void matchCosts()
    {
        shared_.forest = DisparityForest();
        shared_.forestLayer = -1;
        result_.searchRatio = 1;
        if (plan_.prefersLastFrame)
            clock_.run("disparity prediction", [&] { predictFromLastFrame(); });
        clock_.run("cost aggregation", [&] {
            shared_.volume.fill(TwoLayerCost(own_.census, in_.below), in_.images.guide.size(), plan_.numDisparities);
            excludeBeyondRanges();
            if (plan_.prefersLastFrame)
                preferPredicted(shared_.predicted, shared_.volume);
            weighEdges(guide(), own_.edgeWeights);
            scanVolume(own_.edgeWeights);
        });
        finishWinners();
    }

    //! Scanlines over all candidates, which are those of the layer below
    void matchRange()
    {
        result_.searchRatio = 1;
        clock_.run("cost aggregation", [&] {
            weighEdges(guide(), own_.edgeWeights);
            aggregateRange(*in_.below, plan_.frame, plan_.numDisparities, in_.upper->disparity, own_.edgeWeights,
                           candidateIntervals(), plan_.rangePenalties, shared_.rangeScanlines, result_.winners);
        });
        finishWinners();
    }

    //! What all winners go through: the range, what is known beforehand, occlusions
    void finishWinners()
    {
        if (plan_.hasFractions && plan_.layer > 0) // whose last candidate may be beyond the range
            min(result_.winners, plan_.maxDisparity, result_.winners);
        joinWithPrior();
        if (plan_.fillsOcclusions || !plan_.isFinest)
            findResidual();
        if (plan_.fillsOcclusions)
            fillOcclusions(result_.residual);
    }

    //! For occlusions, and for the layer below
    void findResidual()
    {
        if (plan_.cost.isCensus)
            clock_.run("matching cost", [&] {
                own_.census.ofDisparities(result_.winners, result_.residual);
                excludeMissing(result_.residual);
            });
    }

    //! Gives pixels without data the largest cost, with which they win no column of the right image.
    void excludeMissing(Mat& residual) const
    {
        if (!in_.images.masks.isEmpty())
            residual.setTo(Scalar(UCHAR_MAX), pixelsWithData(in_.images.masks.left) == 0);
    }

    //! residual: of the winners
    void fillOcclusions(const Mat& residual)
    {
        clock_.run("occlusions", [&] { fillOccluded(result_.winners, residual, in_.images.masks); });
    }

    //! Scanlines over windows of candidates. The first pass takes them from the layer above, each other one from the
    //! pass before.
    void matchWindows()
    {
        const double windowed = std::min<double>(CandidateWindow::candidates, plan_.numDisparities);
        result_.searchRatio = windowed / plan_.numDisparities;
        clock_.run("cost aggregation", [&] {
            weighEdges(guide(), own_.edgeWeights);
            weighSmoothness(in_.upper->disparity, in_.upper->residual, own_.census.comparisons(), plan_.smoothness,
                            own_.smoothness);
        });
        for (const ScanlinePenalties& penalties : plan_.passes)
        {
            predictPass(&penalties == &plan_.passes.front());
            clock_.run("cost aggregation", [&] {
                aggregateScanlines(own_.census, own_.edgeWeights, plan_.frame, plan_.numDisparities, plan_.maxDisparity,
                                   own_.windows, own_.smoothness, penalties, shared_.scanlines, result_.winners,
                                   own_.passResidual);
            });
            joinWithPrior();
            if (!plan_.isFinest)
                findResidual(); // without the costs of windows for what is far from predicted
            if (plan_.fillsOcclusions)
            {
                excludeMissing(own_.passResidual);
                fillOcclusions(own_.passResidual);
            }
        }
    }

    void predictPass(bool isFirst)
    {
        if (!isFirst)
            clock_.run("disparity median", [&] {
                medianDisparity(result_.winners, passMedianSize, own_.filtered);
                halveDisparity(own_.filtered, own_.halved);
                halveDisparity(result_.winners, own_.halvedWinners);
            });
        clock_.run("disparity prediction", [&] {
            const Mat& upper = isFirst ? in_.upper->disparity : own_.halved;
            const Mat& unfiltered = isFirst ? in_.upper->winners : own_.halvedWinners;
            findOtherSurfaces(upper, unfiltered, own_.others);
            predictWindows(upper, own_.others, plan_.numDisparities, own_.windows);
            if (in_.pair.hasRanges)
                restrictWindows(in_.known.hulls[plan_.layer], plan_.numDisparities, own_.windows);
        });
    }

    //! Over the layer's forest
    void refine()
    {
        findStable(result_.winners, own_.stable);
        refineNonLocal(shared_.forest, result_.winners, own_.stable, plan_.trees.refinementGamma, plan_.hasFractions,
                       shared_.sums, own_.refined);
        swap(own_.refined, result_.winners);
    }

    //! From the winners to the layer's disparities. The authors' program has this median; the paper has no such filter.
    void filter()
    {
        if (plan_.medianSize > 0)
            medianDisparity(result_.winners, plan_.medianSize, result_.disparity);
        else
            result_.winners.copyTo(result_.disparity);
        if (plan_.restoresThinStructures)
            restoreThinStructures(result_.winners, result_.disparity);
        if (plan_.votesAtEdges)
            filterWhereData(1, [&](const Mat& map) { voteAtEdges(in_.images.colours, map, result_.disparity); });
        if (plan_.surfaceDifference > 0)
            filterWhereData(0, [&](const Mat& map) {
                smoothSurfaces(in_.images.left, plan_.noise, plan_.surfaceDifference, map, result_.disparity);
            });
        if (!plan_.isFinest) // whose map outputDisparity() moves into the ranges
            keepIntervals(result_.disparity);
    }

    //! What a prior says stays in the ranges; other winners need not yet, see filter().
    void joinWithPrior()
    {
        if (!in_.pair.hasPrior)
            return;
        clock_.run("prior", [&] {
            Mat joined = result_.winners.clone();
            joinPrior(in_.known.points[plan_.layer], in_.images.colours, own_.census, plan_.layer, plan_.maxDisparity,
                      joined);
            const Mat isChanged = joined != result_.winners;
            keepIntervals(joined);
            joined.copyTo(result_.winners, isChanged);
        });
    }

    void keepIntervals(Mat& disparity) const
    {
        if (in_.pair.hasRanges)
            moveIntoIntervals(in_.known.intervals[plan_.layer], disparity);
    }

    //! Filters the map. The filter sees USHRT_MAX for pixels without data: these, and those up to reach pixels away
    //! from them, keep their disparities.
    template <typename Filter> void filterWhereData(int reach, const Filter& filter)
    {
        swap(result_.disparity, own_.filtered);
        if (in_.images.masks.isEmpty())
            return filter(own_.filtered);
        const Mat hasData = pixelsWithData(in_.images.masks.left);
        own_.filtered.copyTo(own_.masked);
        own_.masked.setTo(Scalar(USHRT_MAX), hasData == 0);
        filter(own_.masked);
        Mat isFiltered;
        erode(hasData, isFiltered, Mat(), Point(-1, -1), reach); // by a pixel, so many times
        own_.filtered.copyTo(result_.disparity, isFiltered == 0);
    }
};

} // namespace

void prepareCost(const LayerPlan& plan, const LayerImages& images, LayerScratch& own)
{
    const CostPlan& cost = plan.cost;
    if (cost.isCensus)
        return own.census.prepare(images.left, images.right, plan.numDisparities, cost.windowSide, cost.tolerance,
                                  images.masks);
    own.colorGradient.prepare(images.left, images.right, plan.numDisparities, cost.colorGradient, images.masks);
}

Verdict matchLayer(const LayerInput& input, LayerScratch& own, SharedScratch& shared, StageClock& clock,
                   LayerResult& result)
{
    return LayerMatching{ input, input.plan, own, shared, clock, result }.run();
}

}}} // namespace cv::stereo::hdp
