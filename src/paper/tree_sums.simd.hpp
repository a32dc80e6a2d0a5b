// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "tree_sums.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Aggregates the costs of a run of candidates over a tree in two passes, and takes the winners.
@param similarity Table of S of neighbours, by the edge's weight.
@param lanes 4, 8, 16 or 32, and not less than there are candidates.
@param joins Whether winners holds those of the candidates before the run; it receives those of all then.
@param costs M of pixel i and the k-th candidate at [i * lanes + k]; receives C. Others mean nothing. */
void aggregateRun(const TreeWalk& walk, int size, const float* similarity, const Range& run, int lanes, bool joins,
                  float* costs, RunWinner* winners);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

const float noCost = -1;

// Nodes that are worked on together, so that what was computed last is still in the cache
const int block = 64;

//! Leaves to root: what comes from the node's own subtree
template <int lanes> void passUp(const TreeWalk& walk, int size, const float* similarity, float* costs)
{
    const int* parents = walk.parents.data();
    const uchar* weights = walk.weights.data();
    for (int i = size - 1; i > 0; --i)
    {
        const float s = similarity[weights[i]];
        const float* child = costs + (size_t)i * lanes;
        float* parent = costs + (size_t)parents[i] * lanes;
        HDP_FOR_LANES(k, lanes) parent[k] += s * child[k];
    }
}

//! Root to leaves: what comes from the rest of the tree
template <int lanes> void passDown(const TreeWalk& walk, int begin, int end, const float* similarity, float* costs)
{
    const int* parents = walk.parents.data();
    const uchar* weights = walk.weights.data();
    for (int i = std::max(begin, 1); i < end; ++i)
    {
        const float s = similarity[weights[i]], rest = 1 - s * s;
        float* child = costs + (size_t)i * lanes;
        const float* parent = costs + (size_t)parents[i] * lanes;
        HDP_FOR_LANES(k, lanes) child[k] = s * parent[k] + rest * child[k];
    }
}

//! Joins the winner of a run with that of the next one, whose first candidate is start.
inline void joinWinner(RunWinner& winner, const RunWinner& next, int start)
{
    if (winner.candidate == start - 1)
        winner.after = next.first;
    if (next.lowest < winner.lowest) // a tie is won by the lower candidate
    {
        winner.before = next.candidate == start ? winner.last : next.before;
        winner.lowest = next.lowest;
        winner.after = next.after;
        winner.candidate = next.candidate;
    }
    winner.last = next.last;
}

// Costs are not negative, so their bits are in the order of their values, and integers have a minimum to vectorise.
#ifdef __GNUC__
typedef int CostBits __attribute__((__may_alias__));
#else
typedef int CostBits;
#endif

//! The position of the first of the lowest costs; bits that are set in excluded make a cost the highest.
template <int lanes> inline int findLowest(const float* costs, const int* excluded)
{
    const CostBits* bits = reinterpret_cast<const CostBits*>(costs);
    int lowest = INT_MAX, position = lanes;
    HDP_VECTORIZED for (int k = 0; k < lanes; ++k) lowest = std::min(lowest, bits[k] | excluded[k]);
    HDP_VECTORIZED for (int k = 0; k < lanes; ++k) position =
        std::min(position, (bits[k] | excluded[k]) == lowest ? k : lanes);
    return position;
}

template <int lanes> void takeWinners(const float* costs, int size, const Range& run, bool joins, RunWinner* winners)
{
    const int count = run.end - run.start;
    int excluded[lanes];
    HDP_VECTORIZED for (int k = 0; k < lanes; ++k) excluded[k] = k < count ? 0 : INT_MAX;
    for (int i = 0; i < size; ++i, costs += lanes)
    {
        const int k = findLowest<lanes>(costs, excluded), candidate = run.start + k;
        const float lowest = costs[k], first = costs[0], last = costs[count - 1];
        const float before = k > 0 ? costs[k - 1] : noCost, after = k + 1 < count ? costs[k + 1] : noCost;
        const RunWinner here = { lowest, before, after, first, last, candidate };
        if (joins)
            joinWinner(winners[i], here, run.start);
        else
            winners[i] = here;
    }
}

//! aggregateRun()
template <int lanes> struct AggregateTask
{
    static void run(const TreeWalk& walk, int size, const float* similarity, const Range& run, bool joins, float* costs,
                    RunWinner* winners)
    {
        passUp<lanes>(walk, size, similarity, costs);
        for (int begin = 0; begin < size; begin += block)
        {
            const int end = std::min(begin + block, size);
            passDown<lanes>(walk, begin, end, similarity, costs);
            takeWinners<lanes>(costs + (size_t)begin * lanes, end - begin, run, joins, winners + begin);
        }
    }
};

} // namespace

void aggregateRun(const TreeWalk& walk, int size, const float* similarity, const Range& run, int lanes, bool joins,
                  float* costs, RunWinner* winners)
{
    runTask<AggregateTask>(lanes, walk, size, similarity, run, joins, costs, winners);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
