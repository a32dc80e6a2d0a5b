// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_forest.hpp"
#include "tree_strategy.hpp"

#include <numeric>

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// DT-Rule 1 spares edges of at most this weight.
const int lightEdge = 7;

typedef ForestBuffers::Node Node;

//! w(p, q) of each pixel's edges to the right and below: the largest absolute difference over the channels.
void weighEdges(const Mat& image, Mat& weights)
{
    const int channels = image.channels();
    weights.create(image.size(), CV_8UC2);
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const uchar* p = image.ptr(y);
            const uchar* below = image.ptr(std::min(y + 1, image.rows - 1)); // the pixel itself in the last row
            uchar* weight = weights.ptr(y);
            for (int x = 0; x < image.cols; ++x, p += channels, below += channels, weight += 2)
            {
                const uchar* right = x + 1 < image.cols ? p + channels : p;
                int toRight = 0, toBelow = 0;
                for (int c = 0; c < channels; ++c)
                {
                    toRight = std::max(toRight, std::abs(p[c] - right[c]));
                    toBelow = std::max(toBelow, std::abs(p[c] - below[c]));
                }
                weight[0] = (uchar)toRight;
                weight[1] = (uchar)toBelow;
            }
        }
    });
}

bool intersect(const DisparityInterval& a, const DisparityInterval& b)
{
    return std::max(a.first, b.first) <= std::min(a.last, b.last);
}

//! Calls visit(edge) for the edges of a row, in their order, that DT-Rule 1 leaves: those that are light or join pixels
//! whose intervals intersect.
template <class Visitor> void visitEdges(const Mat& weights, const Mat& pixelIntv, int y, const Visitor& visit)
{
    const int width = weights.cols;
    const bool isLast = y + 1 == weights.rows;
    const uchar* weight = weights.ptr(y);
    const DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
    const DisparityInterval* below = isLast ? 0 : pixelIntv.ptr<DisparityInterval>(y + 1);
    for (int x = 0; x < width; ++x)
    {
        const int edge = 2 * (y * width + x);
        if (x + 1 < width && (weight[2 * x] <= lightEdge || intersect(interval[x], interval[x + 1])))
            visit(edge);
        if (!isLast && (weight[2 * x + 1] <= lightEdge || intersect(interval[x], below[x])))
            visit(edge + 1);
    }
}

//! The edges, by number, that DT-Rule 1 leaves, in the order of their numbers or, stably, of their weights.
void selectEdges(const Mat& weights, const Mat& pixelIntv, bool byWeight, std::vector<int>& edges)
{
    // A counting sort; without weights all edges have one key.
    const int stripes = 16, keys = byWeight ? 256 : 1;
    const uchar* key = weights.ptr();
    const unsigned mask = byWeight ? 255 : 0;
    std::vector<size_t> places(stripes * keys); // numbers of edges, then where the next one goes
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int s = range.start; s < range.end; ++s)
        {
            size_t* place = &places[s * keys];
            for (int y = weights.rows * s / stripes; y < weights.rows * (s + 1) / stripes; ++y)
                visitEdges(weights, pixelIntv, y, [&](int edge) { ++place[key[edge] & mask]; });
        }
    });
    size_t selected = 0;
    for (int k = 0; k < keys; ++k)
        for (int s = 0; s < stripes; ++s)
        {
            const size_t count = places[s * keys + k];
            places[s * keys + k] = selected;
            selected += count;
        }
    edges.resize(selected);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int s = range.start; s < range.end; ++s)
        {
            size_t* place = &places[s * keys];
            for (int y = weights.rows * s / stripes; y < weights.rows * (s + 1) / stripes; ++y)
                visitEdges(weights, pixelIntv, y, [&](int edge) { edges[place[key[edge] & mask]++] = edge; });
        }
    });
}

//! Asks Rule 1 for the order and refuses what is not a permutation.
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

int findRoot(Node* nodes, int i)
{
    while (nodes[i].parent >= 0)
    {
        const int parent = nodes[i].parent;
        if (nodes[parent].parent < 0)
            return parent;
        i = nodes[i].parent = nodes[parent].parent; // path halving
    }
    return i;
}

//! DT-Rule 2: the share of the intervals' intersection in their hull.
bool overlap(const DisparityInterval& a, const DisparityInterval& b, double beta)
{
    if (a.first == b.first && a.last == b.last)
        return !a.empty();
    if (a.empty() || b.empty())
        return false;
    const int both = std::max(std::min(a.last, b.last) - std::max(a.first, b.first) + 1, 0);
    const int hull = std::max(a.last, b.last) - std::min(a.first, b.first) + 1;
    return (double)both / hull >= beta;
}

//! Tries the edges one after another: Rule 2 and DT-Rule 2.
template <class Strategy>
void joinTrees(const Strategy& strategy, const std::vector<int>& edges, double beta, ForestBuffers& buffers,
               DisparityForest& forest)
{
    const int width = forest.links.cols;
    const uchar* weights = forest.weights.ptr();
    uchar* links = forest.links.ptr();
    Node* nodes = buffers.nodes.data();
    uchar* maxWeights = buffers.maxWeights.data();
    for (size_t i = 0; i < edges.size(); ++i)
    {
        const int edge = edges[i], p = edge >> 1;
        const bool below = (edge & 1) != 0;
        const int q = below ? p + width : p + 1;
        if (nodes[p].parent == nodes[q].parent && nodes[p].parent >= 0)
            continue; // the usual case of late edges, decided without a look at the root
        int a = findRoot(nodes, p), b = findRoot(nodes, q);
        if (a == b || !overlap(nodes[a].interval, nodes[b].interval, beta))
            continue;
        const TreeState stateA = { -nodes[a].parent, maxWeights[a] };
        const TreeState stateB = { -nodes[b].parent, maxWeights[b] };
        if (!strategy.mayJoin(weights[edge], stateA, stateB))
            continue;

        if (stateA.size < stateB.size)
            std::swap(a, b);
        nodes[a].parent += nodes[b].parent;
        nodes[b].parent = a;
        maxWeights[a] = std::max(weights[edge], std::max(stateA.maxWeight, stateB.maxWeight));
        if (strategy.unitesIntervals())
        {
            nodes[a].interval.first = std::min(nodes[a].interval.first, nodes[b].interval.first);
            nodes[a].interval.last = std::max(nodes[a].interval.last, nodes[b].interval.last);
        }
        links[p] |= below ? DisparityForest::BELOW : DisparityForest::RIGHT;
        links[q] |= below ? DisparityForest::ABOVE : DisparityForest::LEFT;
    }
}

} // namespace

void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta, bool link,
                 ForestBuffers& buffers, DisparityForest& forest)
{
    weighEdges(image, forest.weights);
    // Of the library's own strategies the type tells both rules, so that the edges come in order at once and Rule 2 is
    // inlined: the types are final.
    const SegmentTree* segmentTree = dynamic_cast<const SegmentTree*>(&strategy);
    const RandomTree* randomTree = dynamic_cast<const RandomTree*>(&strategy);
    const bool byWeight = segmentTree || dynamic_cast<const MinimumSpanningTree*>(&strategy);
    selectEdges(forest.weights, pixelIntv, byWeight, buffers.edges);
    if (randomTree)
        randomTree->orderEdges(forest.weights, buffers.edges);
    else if (!byWeight)
        orderEdges(strategy, forest.weights, buffers.edges);

    forest.links.create(image.size(), CV_8U);
    forest.links.setTo(Scalar::all(0));
    buffers.maxWeights.assign(image.total(), 0);
    buffers.nodes.resize(image.total());
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const DisparityInterval* intervals = pixelIntv.ptr<DisparityInterval>(y);
            for (int x = 0; x < image.cols; ++x)
            {
                const Node node = { -1, intervals[x] };
                buffers.nodes[(size_t)y * image.cols + x] = node;
            }
        }
    });

    const MinimumSpanningTree everyEdge;
    if (segmentTree)
        joinTrees(*segmentTree, buffers.edges, beta, buffers, forest);
    else if (byWeight || randomTree)
        joinTrees(everyEdge, buffers.edges, beta, buffers, forest);
    else
        joinTrees(strategy, buffers.edges, beta, buffers, forest);
    if (link && strategy.linksTrees())
        joinTrees(everyEdge, buffers.edges, beta, buffers, forest);

    forest.trees.clear();
    for (size_t i = 0; i < buffers.nodes.size(); ++i)
        if (buffers.nodes[i].parent < 0)
        {
            const DisparityTree tree = { (int)i, -buffers.nodes[i].parent, buffers.nodes[i].interval };
            forest.trees.push_back(tree);
        }
}

void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk)
{
    if (walk.pixels.size() < (size_t)tree.size)
    {
        walk.pixels.resize(tree.size);
        walk.parents.resize(tree.size);
        walk.weights.resize(tree.size);
    }
    const int width = forest.links.cols;
    const uchar* links = forest.links.ptr();
    const uchar* weights = forest.weights.ptr();
    const TreeWalk::Step root = { tree.root, 0, 0, 0 };
    walk.pending.assign(1, root);
    for (int i = 0; !walk.pending.empty(); ++i)
    {
        const TreeWalk::Step step = walk.pending.back();
        walk.pending.pop_back();
        const int p = step.pixel;
        walk.pixels[i] = p;
        walk.parents[i] = step.parent;
        walk.weights[i] = step.weight;

        const int children = links[p] & ~step.from;
        if (children & DisparityForest::ABOVE)
        {
            const TreeWalk::Step next = { p - width, i, weights[2 * (p - width) + 1], DisparityForest::BELOW };
            walk.pending.push_back(next);
        }
        if (children & DisparityForest::LEFT)
        {
            const TreeWalk::Step next = { p - 1, i, weights[2 * (p - 1)], DisparityForest::RIGHT };
            walk.pending.push_back(next);
        }
        if (children & DisparityForest::BELOW)
        {
            const TreeWalk::Step next = { p + width, i, weights[2 * p + 1], DisparityForest::ABOVE };
            walk.pending.push_back(next);
        }
        if (children & DisparityForest::RIGHT)
        {
            const TreeWalk::Step next = { p + 1, i, weights[2 * p], DisparityForest::LEFT };
            walk.pending.push_back(next);
        }
    }
}

double searchRatio(const DisparityForest& forest, int numDisparities)
{
    double searched = 0;
    for (size_t t = 0; t < forest.trees.size(); ++t)
        searched += (double)forest.trees[t].size * forest.trees[t].interval.size();
    return searched / ((double)forest.links.total() * numDisparities);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
