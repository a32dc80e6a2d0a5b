// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_TASKS_HPP
#define OPENCV_HDPSTEREO_TREE_TASKS_HPP

#include "../base/parallel_for.hpp"
#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

// How the trees of a forest, and the candidates of large ones, are shared between threads

// Costs of a tree that are in memory at once: a tree with more candidates is aggregated in runs of some, so that memory
// stays O(pixels) and in the caches.
const int64 costsAtOnce = 1 << 22;

// Smaller trees are aggregated by one thread each.
const int largeTree = 1 << 15;

// The most groups that the candidates of a large tree are divided into
const int maxGroups = 4;

// Work, in aggregated costs, of a task of small trees
const int64 taskWork = 1 << 16;

//! The lanes for a run of candidates: few more than there are, and not too many for the memory
inline int countLanes(int candidates, int treeSize)
{
    if (candidates >= 64 && treeSize < largeTree) // as many of a large one are two tasks
        return 64;
    int lanes = 4;
    while (lanes < candidates && lanes < 32 && (lanes < 8 || 2 * lanes * (int64)treeSize <= costsAtOnce))
        lanes *= 2;
    return lanes;
}

inline Range candidatesOf(const DisparityTree& tree)
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
    template <typename Scratch, typename Take>
    void forEach(ScratchPool<Scratch>& buffers, Scratch& own, const Take& take) const
    {
        if (count == 1)
            return take(0, own);
        parallelFor(count, buffers, take);
    }
};

//! Calls aggregation.process() for each tree: for large ones with several groups of candidates one by one, for the
//! others in parallel.
template <typename Scratch, typename Aggregation>
void aggregateTrees(const Aggregation& aggregation, ScratchPool<Scratch>& buffers)
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
            Scratch own = buffers.take();
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

    parallelFor((int)tasks.size(), buffers, [&](int i, Scratch& scratch) {
        for (int t = tasks[i].start; t < tasks[i].end; ++t)
            aggregation.process(forest.trees[t], scratch, buffers);
    });
}

}}} // namespace cv::stereo::hdp

#endif
