// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "tree_means.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** The means of a run of candidates over a tree, see aggregateMeans().
@param costs M of pixel i and the k-th candidate at [i * lanes + k], times CostVolume::scale. Others mean nothing.
@param means Memory for as many. */
void averageRun(const TreeWalk& walk, const MeanNode* nodes, int size, const Range& run, int lanes, const uchar* costs,
                short* means, CostVolume& volume);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The share of a difference, rounded; as the instruction that multiplies and rounds does it
inline short shareOf(short difference, short share)
{
    static_assert(MeanNode::unit == 1 << 15, "bits that are shifted out");
    return (short)((((int)difference * share >> 14) + 1) >> 1);
}

inline short meanOf(uchar cost) { return (short)(cost * (MeanNode::meanScale / CostVolume::scale)); }

//! From the leaves to the root: U, and the sums for those of the parents in place of theirs
template <int lanes>
void averageUp(const int* parents, const MeanNode* nodes, int size, const uchar* costs, short* means)
{
    for (int i = size - 1; i >= 0; --i)
    {
        const MeanNode& node = nodes[i];
        const short toParent = node.toParent, hasChildren = node.hasChildren, hasSibling = node.hasSibling;
        const uchar* const ownCosts = costs + (size_t)i * lanes;
        const uchar* const parentCosts = costs + (size_t)parents[i] * lanes;
        short* const own = means + (size_t)i * lanes;
        short* const parent = means + (size_t)parents[i] * lanes;
        short mean[lanes];
        HDP_VECTORIZED for (int k = 0; k < lanes; ++k)
        {
            mean[k] = (short)(meanOf(ownCosts[k]) + (own[k] & hasChildren));
            own[k] = mean[k];
        }
        if (i > 0)
            HDP_VECTORIZED for (int k = 0; k < lanes; ++k) parent[k] =
                (short)((parent[k] & hasSibling) + shareOf((short)(mean[k] - meanOf(parentCosts[k])), toParent));
    }
}

//! From the root to the leaves: V, rounded
template <int lanes> inline void averageDown(const short* parent, short fromParent, short* own, uchar* rounded)
{
    const int unit = MeanNode::meanScale / CostVolume::scale;
    HDP_VECTORIZED for (int k = 0; k < lanes; ++k)
    {
        const short mean = (short)(own[k] + shareOf((short)(parent[k] - own[k]), fromParent));
        own[k] = mean;
        rounded[k] = (uchar)((ushort)(mean + unit / 2) / unit);
    }
}

//! averageRun()
template <int lanes> struct AverageTask
{
    static void run(const TreeWalk& walk, const MeanNode* nodes, int size, const Range& run, const uchar* costs,
                    short* means, CostVolume& volume)
    {
        const int* const parents = walk.parents.data();
        averageUp<lanes>(parents, nodes, size, costs, means);
        uchar* const stored = volume.costs.data() + run.start;
        CV_DbgAssert(run.start + lanes <= volume.stride()); // the last ones are padding
        for (int i = 0; i < size; ++i)
            averageDown<lanes>(means + (size_t)parents[i] * lanes, nodes[i].fromParent, means + (size_t)i * lanes,
                               stored + volume.start(walk.pixels[i]));
    }
};

} // namespace

void averageRun(const TreeWalk& walk, const MeanNode* nodes, int size, const Range& run, int lanes, const uchar* costs,
                short* means, CostVolume& volume)
{
    runTask<AverageTask>(lanes, walk, nodes, size, run, costs, means, volume);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
