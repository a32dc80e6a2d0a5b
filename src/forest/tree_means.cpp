// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_means.hpp"
#include "tree_means.simd.hpp"
#include "forest/tree_means.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "tree_tasks.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(averageRun)

//! Means over the trees, to a volume
struct MeanAggregation
{
    const DisparityForest& forest;
    const TwoLayerCost& cost;
    const EdgeSimilarity similarity;
    CostVolume& volume;

    void process(const DisparityTree& tree, MeanScratch& own, MeanBuffers& buffers) const
    {
        walkTree(forest, tree, own.walk);
        const int start = volume.treeStarts[&tree - forest.trees.data()];
        std::copy_n(own.walk.pixels.data(), tree.size, &volume.treePixels[start]);
        const MeanNode* const nodes = weighNodes(tree.size, own);
        const CandidateGroups groups(candidatesOf(tree), tree.size);
        groups.forEach(buffers, own, [&](int g, MeanScratch& scratch) {
            forEachRun(groups.of[g], tree.size, [&](const Range& run, int lanes) {
                const size_t count = (size_t)tree.size * lanes;
                uchar* const costs = grown(scratch.costs, count);
                short* const means = grown(scratch.means, count);
                cost.evaluate(own.walk.pixels.data(), tree.size, run.start, lanes, costs);
                dispatched::averageRun(own.walk, nodes, tree.size, run, lanes, costs, means, volume);
            });
        });
    }

    //! The shares, from the sums of similarities in the same two passes
    const MeanNode* weighNodes(int size, MeanScratch& own) const
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

} // namespace

void aggregateMeans(const DisparityForest& forest, const TwoLayerCost& cost, int numDisparities, double gamma,
                    MeanBuffers& buffers, CostVolume& volume)
{
    volume.create(forest.links.size(), numDisparities, cost.steps());
    volume.treePixels.resize(volume.size.area());
    volume.treeStarts.clear();
    int start = 0;
    for (const DisparityTree& tree : forest.trees)
    {
        CV_DbgAssert(candidatesOf(tree) == Range(0, numDisparities));
        volume.treeStarts.push_back(start);
        start += tree.size;
    }
    const MeanAggregation aggregation = { forest, cost, EdgeSimilarity(gamma), volume };
    aggregateTrees(aggregation, buffers);
}

}}} // namespace cv::stereo::hdp
