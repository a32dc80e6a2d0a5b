// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "forest_aggregation.hpp"
#include "forest_aggregation.simd.hpp"
#include "forest/forest_aggregation.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "../base/fits.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

// Costs of a tree that are in memory at once: a tree with more candidates is aggregated in runs of some, so that memory
// stays O(pixels) and in the caches.
const int64 costsAtOnce = 1 << 22;

// Smaller trees are aggregated by one thread each.
const int largeTree = 1 << 15;

// Groups of candidates that a large tree's are divided into
const int maxGroups = 4;

// Work, in aggregated costs, of a task of small trees
const int64 taskWork = 1 << 16;

//! The lanes for a run of candidates: few more than there are, and not too many for the memory
int countLanes(int candidates, int treeSize)
{
    int lanes = 4;
    while (lanes < candidates && lanes < 32 && (lanes < 8 || 2 * lanes * (int64)treeSize <= costsAtOnce))
        lanes *= 2;
    return lanes;
}

Range candidatesOf(const DisparityTree& tree)
{
    return tree.interval.empty() ? Range() : Range(tree.interval.first, tree.interval.last + 1);
}

//! Calls take(run, lanes) for runs of candidates that are in memory at once.
template <typename Take> void forEachRun(const Range& candidates, int treeSize, const Take& take)
{
    for (int first = candidates.start; first < candidates.end;)
    {
        const int lanes = countLanes(candidates.end - first, treeSize);
        const Range run(first, std::min(first + lanes, candidates.end));
        take(run, lanes);
        first = run.end;
    }
}

HDP_DISPATCH(aggregateRun)
HDP_DISPATCH(averageRun)

//! Winner-takes-all over the matching cost
class Matching CV_FINAL : public AggregationProblem
{
public:
    Matching(const MatchingCost& cost, bool subpixel) : cost_(cost), subpixel_(subpixel) {}

    Range candidates(const TreeWalk&, const DisparityTree& tree) const CV_OVERRIDE { return candidatesOf(tree); }

    void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const CV_OVERRIDE
    {
        cost_.evaluate(pixels, count, first, lanes, costs);
    }

    void setDisparities(const int* pixels, const RunWinner* winners, int count, ushort* disparity) const CV_OVERRIDE
    {
        for (int i = 0; i < count; ++i)
            disparity[pixels[i]] = (ushort)(winners[i].candidate * subpixelScale + offset(winners[i]));
    }

private:
    int offset(const RunWinner& winner) const
    {
        const bool hasParabola = winner.before >= 0 && winner.after >= 0;
        return subpixel_ && hasParabola
                   ? cvRound(subpixelScale * parabolaOffset(winner.before, winner.lowest, winner.after))
                   : 0;
    }

    const MatchingCost& cost_;
    const bool subpixel_;
};

//! The candidates of a tree in groups of whole runs: one group, or several of a large tree that are done side by side
struct CandidateGroups
{
    int count;
    Range of[maxGroups];

    CandidateGroups(const Range& candidates, int treeSize)
    {
        const int lanes = countLanes(candidates.size(), treeSize), runs = (candidates.size() + lanes - 1) / lanes;
        count = treeSize >= largeTree ? std::min(runs, maxGroups) : 1;
        const auto firstOf = [&](int group) {
            return std::min(candidates.start + group * runs / count * lanes, candidates.end);
        };
        for (int g = 0; g < count; ++g)
            of[g] = Range(firstOf(g), firstOf(g + 1));
    }

    //! Calls take(group, scratch) for each; own: the scratch of this thread.
    template <typename Take> void forEach(AggregationBuffers& buffers, AggregationScratch& own, const Take& take) const
    {
        if (count == 1)
            return take(0, own);
        parallelFor(count, buffers, take);
    }
};

//! Winners over the sums
struct WinnerAggregation
{
    const DisparityForest& forest;
    const AggregationProblem& problem;
    const EdgeSimilarity similarity;
    ushort* disparity;

    void process(const DisparityTree& tree, AggregationScratch& own, AggregationBuffers& buffers) const
    {
        const TreeWalk& walk = own.walk; // groups use other members of it
        walkTree(forest, tree, own.walk);
        const Range candidates = problem.candidates(walk, tree);
        if (candidates.empty())
            return;
        const CandidateGroups groups(candidates, tree.size);
        own.winners.resize(maxGroups);
        groups.forEach(buffers, own, [&](int g, AggregationScratch& scratch) {
            RunWinner* const winners = grown(own.winners[g], tree.size);
            forEachRun(groups.of[g], tree.size, [&](const Range& run, int lanes) {
                float* const costs = grown(scratch.costs, (size_t)tree.size * lanes);
                problem.evaluate(walk.pixels.data(), tree.size, run.start, lanes, costs);
                const bool joins = run.start > groups.of[g].start;
                dispatched::aggregateRun(walk, tree.size, similarity.table, run, lanes, joins, costs, winners);
            });
        });
        std::vector<RunWinner>& winners = own.winners[0];
        const auto finish = [&](const Range& range) {
            for (int i = range.start; i < range.end; ++i)
                for (int g = 1; g < groups.count; ++g)
                    cpu_baseline::joinWinner(winners[i], own.winners[g][i], groups.of[g].start);
            problem.setDisparities(&walk.pixels[range.start], &winners[range.start], range.size(), disparity);
        };
        const Range all(0, tree.size);
        groups.count > 1 ? parallel_for_(all, finish) : finish(all);
    }
};

//! Means over the trees, to a volume
struct MeanAggregation
{
    const DisparityForest& forest;
    const TwoLayerCost& cost;
    const EdgeSimilarity similarity;
    CostVolume& volume;

    void process(const DisparityTree& tree, AggregationScratch& own, AggregationBuffers& buffers) const
    {
        walkTree(forest, tree, own.walk);
        volume.place(forest, &tree - forest.trees.data(), own.walk.pixels.data());
        if (tree.interval.empty())
            return;
        const MeanNode* const nodes = weighNodes(tree.size, own);
        const CandidateGroups groups(candidatesOf(tree), tree.size);
        groups.forEach(buffers, own, [&](int g, AggregationScratch& scratch) {
            forEachRun(groups.of[g], tree.size, [&](const Range& run, int lanes) {
                const size_t count = (size_t)tree.size * lanes;
                uchar* const costs = grown(scratch.meanCosts, count);
                short* const means = grown(scratch.means, count);
                cost.evaluate(own.walk.pixels.data(), tree.size, run.start, lanes, costs);
                dispatched::averageRun(own.walk, nodes, tree.size, run, lanes, costs, means, volume);
            });
        });
    }

    //! The shares, from the sums of similarities in the same two passes
    const MeanNode* weighNodes(int size, AggregationScratch& own) const
    {
        const TreeWalk& walk = own.walk;
        own.sums.assign(size, 1.f);
        float* const sums = own.sums.data();
        MeanNode* const nodes = grown(own.nodes, size);
        for (int i = size - 1; i > 0; --i)
        {
            float& parent = sums[walk.parents[i]];
            nodes[i].hasChildren = sums[i] > 1 ? -1 : 0;
            nodes[i].hasSibling = parent > 1 ? -1 : 0;
            parent += similarity.table[walk.weights[i]] * sums[i];
        }
        const auto share = [](float part) { return (short)std::min((int)(MeanNode::unit * part), MeanNode::unit - 1); };
        for (int i = size - 1; i > 0; --i)
            nodes[i].toParent = share(similarity.table[walk.weights[i]] * sums[i] / sums[walk.parents[i]]);
        nodes[0] = { 0, 0, (short)(sums[0] > 1 ? -1 : 0), 0 };
        for (int i = 1; i < size; ++i)
        {
            const float s = similarity.table[walk.weights[i]], rest = s * sums[walk.parents[i]];
            sums[i] = rest + (1 - s * s) * sums[i];
            nodes[i].fromParent = share(rest / sums[i]);
        }
        return nodes;
    }
};

//! Calls aggregation.process() for each tree: for large ones with several groups of candidates one by one, for the
//! others in parallel.
template <typename Aggregation> void aggregateTrees(const Aggregation& aggregation, AggregationBuffers& buffers)
{
    const DisparityForest& forest = aggregation.forest;
    // Tasks of about the same work, in the order of the trees
    std::vector<Range> tasks;
    int64 work = taskWork;
    for (int t = 0; t < (int)forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        if (CandidateGroups(candidatesOf(tree), tree.size).count > 1)
        {
            AggregationScratch own = buffers.take();
            aggregation.process(tree, own, buffers);
            buffers.giveBack(std::move(own));
            work = taskWork;
            continue;
        }
        if (work >= taskWork)
        {
            tasks.push_back(Range(t, t));
            work = 0;
        }
        tasks.back().end = t + 1;
        work += (int64)tree.size * tree.interval.size();
    }

    parallelFor((int)tasks.size(), buffers, [&](int i, AggregationScratch& scratch) {
        for (int t = tasks[i].start; t < tasks[i].end; ++t)
            aggregation.process(forest.trees[t], scratch, buffers);
    });
}

} // namespace

EdgeSimilarity::EdgeSimilarity(double gamma)
{
    for (int w = 0; w < 256; ++w)
        table[w] = w > 0 ? (float)std::exp(-w / gamma) : 1.f; // 0 / gamma is none if it is too small for a number
}

void takeWinners(const DisparityForest& forest, const AggregationProblem& problem, double gamma,
                 AggregationBuffers& buffers, Mat& disparity)
{
    const WinnerAggregation aggregation = { forest, problem, EdgeSimilarity(gamma), disparity.ptr<ushort>() };
    aggregateTrees(aggregation, buffers);
}

void aggregateForest(const DisparityForest& forest, const MatchingCost& cost, double gamma, bool subpixel,
                     AggregationBuffers& buffers, Mat& disparity)
{
    disparity.create(forest.links.size(), CV_16U);
    disparity.setTo(Scalar::all(0)); // where there is no candidate
    takeWinners(forest, Matching(cost, subpixel), gamma, buffers, disparity);
}

void aggregateMeans(const DisparityForest& forest, const TwoLayerCost& cost, double gamma, AggregationBuffers& buffers,
                    CostVolume& volume)
{
    volume.create(forest);
    volume.steps = cost.steps();
    const MeanAggregation aggregation = { forest, cost, EdgeSimilarity(gamma), volume };
    aggregateTrees(aggregation, buffers);
}

}}} // namespace cv::stereo::hdp
