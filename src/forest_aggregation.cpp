// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "forest_aggregation.hpp"

#include <cfloat>
#include <cmath>
#include <mutex>

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// Candidates that are aggregated together: a tree with more is walked in chunks, so memory stays O(pixels).
const int chunk = 8;

// Smaller trees are aggregated by one thread each.
const int largeTree = 1 << 15;

// Work, in aggregated costs, of a task of small trees
const int64 taskWork = 1 << 16;

template <int lanes>
void aggregate(const TreeWalk& walk, int size, const MatchingCost& cost, const EdgeSimilarity& similarity, int first,
               float* aggregated)
{
    cost.evaluate(walk.pixels.data(), size, first, lanes, aggregated);

    for (int i = size - 1; i > 0; --i) // leaves to root
    {
        const float s = similarity.table[walk.weights[i]];
        const float* child = aggregated + (size_t)i * lanes;
        float* parent = aggregated + (size_t)walk.parents[i] * lanes;
        for (int k = 0; k < lanes; ++k)
            parent[k] += s * child[k];
    }
    for (int i = 1; i < size; ++i) // root to leaves
    {
        const float s = similarity.table[walk.weights[i]], own = 1 - s * s;
        float* child = aggregated + (size_t)i * lanes;
        const float* parent = aggregated + (size_t)walk.parents[i] * lanes;
        for (int k = 0; k < lanes; ++k)
            child[k] = s * parent[k] + own * child[k];
    }
}

//! The parabola through the costs of three neighbouring candidates has its minimum this far from the middle one, in
//! 1 / subpixelScale pixels.
int parabolaOffset(float before, float middle, float after)
{
    const float curvature = (before - middle) + (after - middle);
    return curvature > 0 ? cvRound((before - after) / curvature * (subpixelScale / 2)) : 0;
}

struct Winner
{
    float cost;
    ushort disparity;

    bool beats(const Winner& other) const
    {
        return cost < other.cost || (cost == other.cost && disparity < other.disparity);
    }
};

//! A run of candidates that are aggregated together, and those of them that may win. The others are there for the
//! parabola, and may win in the runs before and after.
struct Candidates
{
    int first, count;
    int begin, end;
};

struct Aggregation
{
    const DisparityForest& forest;
    const MatchingCost& cost;
    const EdgeSimilarity similarity;
    const bool subpixel;
    ushort* disparity;

    //! Candidates on each side of a run that are there for the parabola
    static int margin(bool subpixel) { return subpixel ? 1 : 0; }

    static int countRuns(int candidates, bool subpixel)
    {
        const int step = chunk - 2 * margin(subpixel);
        return candidates <= chunk ? 1 : (candidates + step - 1) / step;
    }

    Candidates run(const DisparityInterval& interval, int i) const
    {
        const int first = interval.first, end = interval.last + 1;
        if (end - first <= chunk)
        {
            const Candidates all = { first, end - first, first, end };
            return all;
        }
        const int beside = margin(subpixel), step = chunk - 2 * beside;
        const int begin = first + i * step;
        Candidates some = { std::max(begin - beside, first), 0, begin, std::min(begin + step, end) };
        some.count = std::min(begin + step + beside, end) - some.first;
        return some;
    }

    //! The first of the lowest costs.
    Winner takeWinner(const float* costs, const Candidates& candidates) const
    {
        int winner = candidates.begin - candidates.first;
        float lowest = costs[winner];
        for (int k = winner + 1; k < candidates.end - candidates.first; ++k)
        {
            winner = costs[k] < lowest ? k : winner;
            lowest = std::min(costs[k], lowest);
        }
        int value = candidates.first + winner;
        if (subpixel)
        {
            value *= subpixelScale;
            if (winner > 0 && winner + 1 < candidates.count)
                value += parabolaOffset(costs[winner - 1], lowest, costs[winner + 1]);
        }
        const Winner result = { lowest, (ushort)value };
        return result;
    }

    //! Aggregates some candidates and keeps the winners that beat those of other candidates.
    void takeWinners(const TreeWalk& walk, int size, const Candidates& candidates, std::vector<float>& aggregated,
                     std::vector<float>& lowest, std::vector<ushort>& winner) const
    {
        const int lanes = aggregateTree(walk, size, cost, similarity, candidates.first, candidates.count, aggregated);
        for (int i = 0; i < size; ++i)
        {
            const Winner here = takeWinner(&aggregated[(size_t)i * lanes], candidates);
            const Winner other = { lowest[i], winner[i] };
            if (here.beats(other))
            {
                lowest[i] = here.cost;
                winner[i] = here.disparity;
            }
        }
    }

    void processSmall(const DisparityTree& tree, AggregationScratch& scratch) const
    {
        const DisparityInterval& interval = tree.interval;
        if (interval.empty())
        {
            // An empty interval never joins another one.
            disparity[tree.root] = 0;
            return;
        }
        walkTree(forest, tree, scratch.walk);
        const int* pixels = scratch.walk.pixels.data();
        const int runs = countRuns(interval.size(), subpixel);
        if (runs == 1)
        {
            const Candidates candidates = run(interval, 0);
            const int lanes = aggregateTree(scratch.walk, tree.size, cost, similarity, candidates.first,
                                            candidates.count, scratch.aggregated);
            for (int i = 0; i < tree.size; ++i)
                disparity[pixels[i]] = takeWinner(&scratch.aggregated[(size_t)i * lanes], candidates).disparity;
        }
        else
        {
            scratch.lowest.assign(tree.size, FLT_MAX);
            scratch.winner.assign(tree.size, 0);
            for (int i = 0; i < runs; ++i)
                takeWinners(scratch.walk, tree.size, run(interval, i), scratch.aggregated, scratch.lowest,
                            scratch.winner);
            for (int i = 0; i < tree.size; ++i)
                disparity[pixels[i]] = scratch.winner[i];
        }
    }
};

//! Lends each thread its scratch memory.
class ScratchLoan
{
public:
    ScratchLoan(AggregationBuffers& buffers, std::mutex& mutex) : buffers_(buffers), mutex_(mutex)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        if (buffers_.idle.empty())
            scratch_.reset(new AggregationScratch);
        else
        {
            scratch_ = std::move(buffers_.idle.back());
            buffers_.idle.pop_back();
        }
    }
    ~ScratchLoan()
    {
        std::lock_guard<std::mutex> lock(mutex_);
        buffers_.idle.push_back(std::move(scratch_));
    }
    AggregationScratch& operator*() const { return *scratch_; }

private:
    AggregationBuffers& buffers_;
    std::mutex& mutex_;
    std::unique_ptr<AggregationScratch> scratch_;
};

//! A large tree with many candidates: its runs side by side. A winner is the lowest pair (cost, candidate), which does
//! not depend on the order in which runs end.
void processLarge(const Aggregation& aggregation, const DisparityTree& tree, AggregationBuffers& buffers)
{
    std::mutex mutex;
    ScratchLoan result(buffers, mutex);
    TreeWalk& walk = (*result).walk;
    std::vector<float>& lowest = (*result).lowest;
    std::vector<ushort>& winner = (*result).winner;
    walkTree(aggregation.forest, tree, walk);
    lowest.assign(tree.size, FLT_MAX);
    winner.assign(tree.size, 0);

    std::mutex resultMutex;
    const int runs = Aggregation::countRuns(tree.interval.size(), aggregation.subpixel);
    const auto aggregateRuns = [&](const Range& range) {
        ScratchLoan loan(buffers, mutex);
        AggregationScratch& scratch = *loan;
        scratch.lowest.assign(tree.size, FLT_MAX);
        scratch.winner.assign(tree.size, 0);
        for (int i = range.start; i < range.end; ++i)
            aggregation.takeWinners(walk, tree.size, aggregation.run(tree.interval, i), scratch.aggregated,
                                    scratch.lowest, scratch.winner);
        std::lock_guard<std::mutex> lock(resultMutex);
        for (int i = 0; i < tree.size; ++i)
        {
            const Winner here = { scratch.lowest[i], scratch.winner[i] }, other = { lowest[i], winner[i] };
            if (here.beats(other))
            {
                lowest[i] = here.cost;
                winner[i] = here.disparity;
            }
        }
    };
    // At most 8 at once bounds the memory.
    parallel_for_(Range(0, runs), aggregateRuns, std::min(runs, 8));
    for (int i = 0; i < tree.size; ++i)
        aggregation.disparity[walk.pixels[i]] = winner[i];
}

} // namespace

EdgeSimilarity::EdgeSimilarity(double gamma)
{
    for (int w = 0; w < 256; ++w)
        table[w] = (float)std::exp(-w / gamma);
}

int aggregateTree(const TreeWalk& walk, int size, const MatchingCost& cost, const EdgeSimilarity& similarity, int first,
                  int count, std::vector<float>& aggregated)
{
    const int lanes = count <= 4 ? 4 : 8;
    if (aggregated.size() < (size_t)size * lanes)
        aggregated.resize((size_t)size * lanes);
    if (lanes == 4)
        aggregate<4>(walk, size, cost, similarity, first, aggregated.data());
    else
        aggregate<8>(walk, size, cost, similarity, first, aggregated.data());
    return lanes;
}

void aggregateForest(const DisparityForest& forest, const MatchingCost& cost, double gamma, bool subpixel,
                     AggregationBuffers& buffers, Mat& disparity)
{
    disparity.create(forest.links.size(), CV_16U);
    const Aggregation aggregation = { forest, cost, EdgeSimilarity(gamma), subpixel, disparity.ptr<ushort>() };

    // Tasks of about the same work, in the order of the trees; large trees with many candidates are done one by one.
    std::vector<Range> tasks;
    int64 work = taskWork;
    for (int t = 0; t < (int)forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        if (tree.size >= largeTree && tree.interval.size() > chunk)
        {
            processLarge(aggregation, tree, buffers);
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

    std::mutex mutex;
    parallel_for_(Range(0, (int)tasks.size()), [&](const Range& range) {
        ScratchLoan scratch(buffers, mutex);
        for (int i = range.start; i < range.end; ++i)
            for (int t = tasks[i].start; t < tasks[i].end; ++t)
                aggregation.processSmall(forest.trees[t], *scratch);
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
