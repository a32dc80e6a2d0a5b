// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_JOINER_HPP
#define OPENCV_HDPSTEREO_TREE_JOINER_HPP

#include "forest_edges.hpp"
#include "tree_strategy.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Trees under construction: a union-find structure over the pixels
struct GrowingTrees
{
    struct Node
    {
        int parent;                 // another pixel of the tree; of a root: minus the tree's number of pixels
        DisparityInterval interval; // of a root: TreeIntv
    };
    std::vector<Node> nodes;       // by pixel
    std::vector<uchar> maxWeights; // by root: TreeState::maxWeight, if a strategy asks for it
};

//! Makes every pixel of some rows a tree.
void startTrees(const Mat& pixelIntv, const Range& rows, GrowingTrees& trees);

//! The root of a pixel's tree
inline int findRoot(GrowingTrees::Node* nodes, int pixel)
{
    while (nodes[pixel].parent >= 0)
    {
        const int parent = nodes[pixel].parent;
        if (nodes[parent].parent < 0)
            return parent;
        pixel = nodes[pixel].parent = nodes[parent].parent; // path halving
    }
    return pixel;
}

// A frozen tree is not joined with others for now. The parent of its root is smaller by frozenMark, which is more than
// any image has pixels.
const int frozenMark = 1 << 30;

inline bool isFrozen(int parentOfRoot) { return parentOfRoot < -frozenMark; }

//! Whether Rule 2 of a strategy looks at the trees; otherwise every edge may join.
template <class Strategy> struct AsksForState
{
    static const bool value = true;
};

template <> struct AsksForState<MinimumSpanningTree>
{
    static const bool value = false;
};

template <> struct AsksForState<RandomTree>
{
    static const bool value = false;
};

/** Decides on one edge after the other, by Rule 2 and DT-Rule 2, and joins the trees at its ends.
@tparam Strategy Of Rule 2: one of the final classes of the library, which is inlined, or TreeStrategy. */
template <class Strategy> class TreeJoiner
{
public:
    enum Outcome
    {
        CONNECTED, // the edge's ends are in one tree now
        REJECTED,
        UNDECIDED // one of the trees is frozen
    };

    // Edges to prefetch before the one whose turn it is
    static const int prefetchDistance = 12;

    //! beta: threshold of DT-Rule 2; links: CV_8UC1, continuous, receives the bits of TreeLink.
    TreeJoiner(const Strategy& strategy, double beta, GrowingTrees& trees, Mat& links)
        : strategy_(strategy), beta_(beta), width_(links.cols), links_(links.ptr()), nodes_(trees.nodes.data()),
          maxWeights_(trees.maxWeights.data())
    {
    }

    Outcome tryEdge(int edge, int weight)
    {
        const int p = firstPixel(edge), q = secondPixel(edge, width_), isBelow = edge & 1;
        const int a = findNearRoot(p), b = findNearRoot(q);
        if (a == b)
            return CONNECTED;
        const Node nodeA = nodes_[a], nodeB = nodes_[b];
        if (isFrozen(std::min(nodeA.parent, nodeB.parent)))
            return UNDECIDED;
        const bool isEqual = (nodeA.interval.first == nodeB.interval.first) & // without a branch
                             (nodeA.interval.last == nodeB.interval.last);
        if (isEqual ? nodeA.interval.empty() : !overlap(nodeA.interval, nodeB.interval))
            return REJECTED;
        uchar maxWeight = 0;
        if (AsksForState<Strategy>::value)
        {
            const TreeState stateA = { -nodeA.parent, maxWeights_[a] }, stateB = { -nodeB.parent, maxWeights_[b] };
            if (!strategy_.mayJoin(weight, stateA, stateB))
                return REJECTED;
            maxWeight = std::max((uchar)weight, std::max(stateA.maxWeight, stateB.maxWeight));
        }

        // The larger tree's root stays, p's if they are of one size. A branch would often be mispredicted.
        const int change = (a ^ b) & -(int)(nodeA.parent > nodeB.parent), root = a ^ change, joined = b ^ change;
        nodes_[root].parent = nodeA.parent + nodeB.parent;
        nodes_[joined].parent = root;
        if (AsksForState<Strategy>::value)
            maxWeights_[root] = maxWeight;
        // Otherwise TreeIntv stays that of the larger tree: the segment trees of the authors' program do not update it.
        if (!isEqual && strategy_.unitesIntervals())
            nodes_[root].interval = hull(nodeA.interval, nodeB.interval);
        links_[p] |= (uchar)(isBelow ? TreeLink::BELOW : TreeLink::RIGHT);
        links_[q] |= (uchar)(isBelow ? TreeLink::ABOVE : TreeLink::LEFT);
        return CONNECTED;
    }

    //! Hints that an edge is going to be tried.
    void prefetch(int edge) const
    {
#ifdef __GNUC__
        __builtin_prefetch(nodes_ + firstPixel(edge));
        __builtin_prefetch(nodes_ + firstPixel(edge) + width_);
#else
        (void)edge;
#endif
    }

private:
    typedef GrowingTrees::Node Node;

    //! findRoot(), without branches for the most frequent case of a root that is at most two steps away
    int findNearRoot(int pixel)
    {
        int node = pixel;
        for (int step = 0; step < 2; ++step)
        {
            const int parent = nodes_[node].parent, isRoot = parent >> 31; // all bits or none
            node = (node & isRoot) | (parent & ~isRoot);
        }
        return nodes_[node].parent < 0 ? node : nodes_[pixel].parent = findRoot(nodes_, node);
    }

    static DisparityInterval hull(const DisparityInterval& a, const DisparityInterval& b)
    {
        const DisparityInterval interval = { std::min(a.first, b.first), std::max(a.last, b.last) };
        return interval;
    }

    //! DT-Rule 2: |intersection| / |union| >= beta. For the union the authors' program takes the hull, so that TreeIntv
    //! is always one interval.
    bool overlap(const DisparityInterval& a, const DisparityInterval& b) const
    {
        if (a.empty() || b.empty())
            return false;
        const int both = std::max(std::min(a.last, b.last) - std::max(a.first, b.first) + 1, 0);
        return (double)both / hull(a, b).size() >= beta_;
    }

    const Strategy& strategy_;
    const double beta_;
    const int width_;
    uchar* const links_;
    Node* const nodes_;
    uchar* const maxWeights_;
};

/** Kruskal's algorithm with the order of edges that a strategy gives.
@param strategy Rule 1 and Rule 2.
@param weights From weighEdges().
@param pixelIntv CV_16UC2 of the same size.
@param beta Threshold of DT-Rule 2.
@param link Whether to join what Rule 2 left apart, by a second pass without it.
@param trees Receives the trees; trees.nodes has the size of the image.
@param edges Memory to work in.
@param links CV_8UC1 zeros of the same size; receives the bits of TreeLink. */
void joinInOrder(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta, bool link,
                 GrowingTrees& trees, std::vector<int>& edges, Mat& links);

}}} // namespace cv::stereo::hdp

#endif
