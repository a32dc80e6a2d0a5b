// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_joiner.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

//! Asks Rule 1 for the order of edges and refuses what is not a permutation.
void orderEdges(const TreeStrategy& strategy, const Mat& weights, std::vector<int>& edges)
{
    std::vector<bool> given(weights.total() * 2);
    for (size_t i = 0; i < edges.size(); ++i)
        given[edges[i]] = true;
    const size_t count = edges.size();
    strategy.orderEdges(weights, edges);
    bool isPermutation = edges.size() == count;
    for (size_t i = 0; isPermutation && i < count; ++i)
    {
        isPermutation = edges[i] >= 0 && (size_t)edges[i] < given.size() && given[edges[i]];
        if (isPermutation)
            given[edges[i]] = false;
    }
    if (!isPermutation)
        CV_Error(Error::StsBadArg, "treeStrategy: orderEdges must leave a permutation of the edges");
}

template <class Strategy>
void tryAll(const Strategy& strategy, const std::vector<int>& edges, const Mat& weights, double beta,
            GrowingTrees& trees, Mat& links)
{
    TreeJoiner<Strategy> joiner(strategy, beta, trees, links);
    for (size_t i = 0; i < edges.size(); ++i)
    {
        joiner.prefetch(edges[std::min(i + joiner.prefetchDistance, edges.size() - 1)]);
        joiner.tryEdge(edges[i], weights.ptr()[edges[i]]);
    }
}

} // namespace

void startTrees(const Mat& pixelIntv, const Range& rows, GrowingTrees& trees)
{
    for (int y = rows.start; y < rows.end; ++y)
    {
        const DisparityInterval* intervals = pixelIntv.ptr<DisparityInterval>(y);
        GrowingTrees::Node* nodes = &trees.nodes[(size_t)y * pixelIntv.cols];
        for (int x = 0; x < pixelIntv.cols; ++x)
        {
            const GrowingTrees::Node node = { -1, intervals[x] };
            nodes[x] = node;
        }
    }
}

void joinInOrder(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta, bool link,
                 GrowingTrees& trees, std::vector<int>& edges, Mat& links)
{
    startTrees(pixelIntv, Range(0, pixelIntv.rows), trees);
    selectEdges(weights, pixelIntv, edges);
    if (const RandomTree* randomTree = dynamic_cast<const RandomTree*>(&strategy)) // Rule 2 without a virtual call
    {
        randomTree->orderEdges(weights, edges);
        tryAll(*randomTree, edges, weights, beta, trees, links);
    }
    else
    {
        trees.maxWeights.assign(pixelIntv.total(), 0);
        orderEdges(strategy, weights, edges);
        tryAll(strategy, edges, weights, beta, trees, links);
    }
    if (link)
        tryAll(MinimumSpanningTree(), edges, weights, beta, trees, links); // its Rule 2: every edge may join
}

}}} // namespace cv::stereo::hdp
