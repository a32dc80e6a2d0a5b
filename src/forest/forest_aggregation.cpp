// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "forest_aggregation.hpp"
#include "forest_aggregation.simd.hpp"
#include "forest/forest_aggregation.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "../base/parabola.hpp"

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

    Range candidates(const TreeWalk&, const DisparityTree& tree) const CV_OVERRIDE
    {
        return tree.interval.empty() ? Range() : Range(tree.interval.first, tree.interval.last + 1);
    }

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

//! Winners over the sums
struct WinnerAggregation
{
    const DisparityForest& forest;
    const AggregationProblem& problem;
    const EdgeSimilarity similarity;
    ushort* disparity;

    //! The winners of some candidates, run by run
    void takeWinners(const TreeWalk& walk, int size, const Range& candidates, std::vector<float>& costs,
                     std::vector<RunWinner>& winners) const
    {
        if (winners.size() < (size_t)size)
            winners.resize(size);
        forEachRun(candidates, size, [&](const Range& run, int lanes) {
            if (costs.size() < (size_t)size * lanes)
                costs.resize((size_t)size * lanes);
            problem.evaluate(walk.pixels.data(), size, run.start, lanes, costs.data());
            const bool joins = run.start > candidates.start;
            dispatched::aggregateRun(walk, size, similarity.table, run, lanes, joins, costs.data(), winners.data());
        });
    }

    void processSmall(const DisparityTree& tree, AggregationScratch& scratch) const
    {
        walkTree(forest, tree, scratch.walk);
        const Range candidates = problem.candidates(scratch.walk, tree);
        if (candidates.empty())
            return;
        takeWinners(scratch.walk, tree.size, candidates, scratch.costs, scratch.winners);
        problem.setDisparities(scratch.walk.pixels.data(), scratch.winners.data(), tree.size, disparity);
    }

    //! Groups of candidates side by side
    void processLarge(const DisparityTree& tree, AggregationBuffers& buffers) const
    {
        TreeWalk& walk = buffers.ofThread.getRef().walk; // groups use other members of it
        walkTree(forest, tree, walk);
        const Range candidates = problem.candidates(walk, tree);
        if (candidates.empty())
            return;

        // Whole runs for each group
        const int lanes = countLanes(candidates.size(), tree.size);
        const int runs = (candidates.size() + lanes - 1) / lanes, count = std::min(runs, maxGroups);
        const auto firstOf = [&](int group) {
            return std::min(candidates.start + group * runs / count * lanes, candidates.end);
        };
        std::vector<std::vector<RunWinner>>& groups = buffers.groups;
        groups.resize(maxGroups);
        parallelFor(count, [&](int g) {
            std::vector<float>& costs = buffers.ofThread.getRef().costs;
            takeWinners(walk, tree.size, Range(firstOf(g), firstOf(g + 1)), costs, groups[g]);
        });

        parallel_for_(Range(0, tree.size), [&](const Range& range) {
            for (int i = range.start; i < range.end; ++i)
                for (int g = 1; g < count; ++g)
                    cpu_baseline::joinWinner(groups[0][i], groups[g][i], firstOf(g));
            problem.setDisparities(&walk.pixels[range.start], &groups[0][range.start], range.size(), disparity);
        });
    }
};

//! Calls processLarge() for each large tree with many candidates, one by one, and processSmall() for the others, in
//! parallel.
template <typename Aggregation> void aggregateTrees(const Aggregation& aggregation, AggregationBuffers& buffers)
{
    const DisparityForest& forest = aggregation.forest;
    // Tasks of about the same work, in the order of the trees
    std::vector<Range> tasks;
    int64 work = taskWork;
    for (int t = 0; t < (int)forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        const int candidates = tree.interval.size();
        if (tree.size >= largeTree && candidates > countLanes(candidates, tree.size)) // several runs, side by side
        {
            aggregation.processLarge(tree, buffers);
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

    parallelFor((int)tasks.size(), [&](int i) {
        AggregationScratch& scratch = buffers.ofThread.getRef();
        for (int t = tasks[i].start; t < tasks[i].end; ++t)
            aggregation.processSmall(forest.trees[t], scratch);
    });
}

//! Means over the trees, to a volume
struct MeanAggregation
{
    const DisparityForest& forest;
    const TwoLayerCost& cost;
    const EdgeSimilarity similarity;
    CostVolume& volume;

    size_t numberOf(const DisparityTree& tree) const { return &tree - forest.trees.data(); }

    //! The shares, from the sums of similarities in the same two passes
    void weighNodes(const TreeWalk& walk, int size, MeanBuffers& buffers) const
    {
        buffers.sums.assign(size, 1.f);
        if (buffers.nodes.size() < (size_t)size)
            buffers.nodes.resize(size);
        float* const sums = buffers.sums.data();
        MeanNode* const nodes = buffers.nodes.data();
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
    }

    void takeMeans(const TreeWalk& walk, int size, const MeanNode* nodes, const Range& run, int lanes,
                   MeanBuffers& buffers) const
    {
        const size_t count = (size_t)size * lanes;
        if (buffers.means.size() < count) // the last to grow, as in walkTree()
        {
            buffers.costs.resize(count);
            buffers.means.resize(count);
        }
        cost.evaluate(walk.pixels.data(), size, run.start, lanes, buffers.costs.data());
        dispatched::averageRun(walk, nodes, size, run, lanes, buffers.costs.data(), buffers.means.data(), volume);
    }

    void processSmall(const DisparityTree& tree, AggregationScratch& scratch) const
    {
        walkTree(forest, tree, scratch.walk);
        volume.place(forest, numberOf(tree), scratch.walk.pixels.data());
        if (tree.interval.empty())
            return;
        weighNodes(scratch.walk, tree.size, scratch.means);
        forEachRun(Range(tree.interval.first, tree.interval.last + 1), tree.size, [&](const Range& run, int lanes) {
            takeMeans(scratch.walk, tree.size, scratch.means.nodes.data(), run, lanes, scratch.means);
        });
    }

    void processLarge(const DisparityTree& tree, AggregationBuffers& buffers) const
    {
        AggregationScratch& whole = buffers.ofThread.getRef(); // groups use other members of it
        const TreeWalk& walk = whole.walk;
        walkTree(forest, tree, whole.walk);
        volume.place(forest, numberOf(tree), walk.pixels.data());
        weighNodes(walk, tree.size, whole.means);
        const int first = tree.interval.first, end = tree.interval.last + 1;
        const int lanes = countLanes(end - first, tree.size);
        const int runs = (end - first + lanes - 1) / lanes, groups = std::min(runs, maxGroups);
        parallelFor(groups, [&](int group) {
            for (int i = runs * group / groups; i < runs * (group + 1) / groups; ++i)
            {
                const Range run(first + i * lanes, std::min(first + (i + 1) * lanes, end));
                takeMeans(walk, tree.size, whole.means.nodes.data(), run, lanes, buffers.ofThread.getRef().means);
            }
        });
    }
};

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
