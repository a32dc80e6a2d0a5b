// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef ForestBuffers::Node Node;
typedef ForestBuffers::Stripe Stripe;

const int maxStripes = 4, minStripeRows = 4;

// A frozen tree is not joined with others for now. The parent of its root is smaller by frozenMark, which is more than
// any image has pixels.
const int frozenMark = 1 << 30;

bool isFrozen(int parentOfRoot) { return parentOfRoot < -frozenMark; }

/** Tries edges in a stripe of rows.

An edge to another stripe is left undecided, and freezes its tree: from its turn on, what the tree would be joined with
is not known. An edge to a frozen tree is left undecided, too, and freezes the other tree. So each decision sees the
same trees as without stripes. */
class StripeJoiner
{
public:
    //! rule2: none if every edge may join; rows: of the stripe
    StripeJoiner(const TreeStrategy* rule2, double beta, const Range& rows, ForestBuffers& buffers, Stripe& stripe,
                 DisparityForest& forest)
        : rule2_(rule2), unitesIntervals_(!rule2 || rule2->unitesIntervals()), weights_(forest.weights.ptr()),
          beta_(beta), width_(forest.links.cols), begin_(rows.start * width_), end_(rows.end * width_),
          nodes_(buffers.nodes.data()), maxWeights_(buffers.maxWeights.data()), links_(forest.links.ptr()),
          stripe_(stripe)
    {
    }

    void tryEdges(const std::vector<int>& edges)
    {
        const int ahead = 12; // edges to prefetch before the one whose turn it is
        const size_t last = edges.size() - 1;
        for (size_t i = 0; i < edges.size(); ++i)
        {
            prefetch(edges[std::min(i + ahead, last)]);
            const int p = firstPixel(edges[i]), q = secondPixel(edges[i], width_);
            if (p < begin_)
                freezeTree(q); // the edge is undecided in the stripe above
            else if (q >= end_)
                leaveUndecided(edges[i], p, p);
            else if (!decide(edges[i], p, q))
                leaveUndecided(edges[i], p, q);
        }
    }

private:
    //! Joins the trees at an edge's ends if the rules allow it; false if one of them is frozen.
    bool decide(int edge, int p, int q)
    {
        const int a = findNearRoot(p), b = findNearRoot(q);
        if (a == b)
            return true;
        const Node nodeA = nodes_[a], nodeB = nodes_[b];
        if (isFrozen(std::min(nodeA.parent, nodeB.parent)))
            return false;
        const bool isEqual = (nodeA.interval.first == nodeB.interval.first) & // without a branch
                             (nodeA.interval.last == nodeB.interval.last);
        if (isEqual ? nodeA.interval.empty() : !overlap(nodeA.interval, nodeB.interval))
            return true;
        const TreeState stateA = { -nodeA.parent, maxWeights_[a] }, stateB = { -nodeB.parent, maxWeights_[b] };
        const uchar weight = weights_[edge];
        if (rule2_ && !rule2_->mayJoin(weight, stateA, stateB))
            return true;

        // The larger tree's root stays, p's if they are of one size. A branch would often be mispredicted.
        const int change = (a ^ b) & -(int)(nodeA.parent > nodeB.parent), root = a ^ change, joined = b ^ change;
        nodes_[root].parent = nodeA.parent + nodeB.parent;
        nodes_[joined].parent = root;
        maxWeights_[root] = std::max(weight, std::max(stateA.maxWeight, stateB.maxWeight));
        // Otherwise TreeIntv stays that of the larger tree: the segment trees of the authors' program do not update it.
        if (!isEqual && unitesIntervals_)
            nodes_[root].interval = hull(nodeA.interval, nodeB.interval);
        links_[p] |= (uchar)(edge & 1 ? TreeLink::BELOW : TreeLink::RIGHT);
        links_[q] |= (uchar)(edge & 1 ? TreeLink::ABOVE : TreeLink::LEFT);
        return true;
    }

    void leaveUndecided(int edge, int p, int q)
    {
        freezeTree(p);
        freezeTree(q);
        stripe_.undecidedEdges.push_back(edge);
    }

    void freezeTree(int pixel)
    {
        const int root = findRoot(pixel);
        if (!isFrozen(nodes_[root].parent))
        {
            nodes_[root].parent -= frozenMark;
            stripe_.frozenRoots.push_back(root);
        }
    }

    int findRoot(int pixel)
    {
        while (nodes_[pixel].parent >= 0)
        {
            const int parent = nodes_[pixel].parent;
            if (nodes_[parent].parent < 0)
                return parent;
            pixel = nodes_[pixel].parent = nodes_[parent].parent; // path halving
        }
        return pixel;
    }

    //! findRoot(), without branches for the most frequent case of a root that is at most two steps away
    int findNearRoot(int pixel)
    {
        int node = pixel;
        for (int step = 0; step < 2; ++step)
        {
            const int parent = nodes_[node].parent, isRoot = parent >> 31; // all bits or none
            node = (node & isRoot) | (parent & ~isRoot);
        }
        return nodes_[node].parent < 0 ? node : nodes_[pixel].parent = findRoot(node);
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

    static DisparityInterval hull(const DisparityInterval& a, const DisparityInterval& b)
    {
        return { std::min(a.first, b.first), std::max(a.last, b.last) };
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

    const TreeStrategy* const rule2_;
    const bool unitesIntervals_;
    const uchar* const weights_;
    const double beta_;
    const int width_, begin_, end_; // of a row; pixels of the stripe
    Node* const nodes_;
    uchar* const maxWeights_;
    uchar* const links_;
    Stripe& stripe_;
};

//! Makes every pixel of some rows a tree.
void startTrees(const Mat& pixelIntv, const Range& rows, ForestBuffers& buffers)
{
    for (int y = rows.start; y < rows.end; ++y)
    {
        const DisparityInterval* intervals = pixelIntv.ptr<DisparityInterval>(y);
        const size_t first = (size_t)y * pixelIntv.cols;
        for (int x = 0; x < pixelIntv.cols; ++x)
        {
            buffers.nodes[first + x] = { -1, intervals[x] };
            buffers.maxWeights[first + x] = 0;
        }
    }
}

//! Asks Rule 1 for the order of the edges of some rows and refuses what is not a permutation.
void orderEdges(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, const Range& rows,
                std::vector<int>& edges)
{
    selectEdges(weights, pixelIntv, rows, edges);
    if (strategy.ordersByWeight())
        return sortByWeight(weights, edges);
    std::vector<uchar> isMissing(weights.total() * 2);
    for (int edge : edges)
        isMissing[edge] = 1;
    const size_t count = edges.size();
    strategy.orderEdges(weights, edges);
    const auto isFound = [&](int edge) {
        return edge >= 0 && (size_t)edge < isMissing.size() && isMissing[edge]-- > 0;
    };
    if (edges.size() != count || !std::all_of(edges.begin(), edges.end(), isFound))
        CV_Error(Error::StsBadArg, "treeStrategy: orderEdges must leave a permutation of the edges");
}

//! Joins the trees that the rules allow. forest: has the weights of the edges, and links that are 0; receives these.
void joinTrees(const TreeStrategy& strategy, const Mat& pixelIntv, double beta, bool link, ForestBuffers& buffers,
               DisparityForest& forest)
{
    const int height = pixelIntv.rows;
    const Mat& weights = forest.weights;
    std::vector<Stripe>& stripes = buffers.stripes;
    buffers.nodes.resize(pixelIntv.total());
    buffers.maxWeights.resize(pixelIntv.total());
    // The number of threads decides how fast it goes, not what comes out. Other orders are not those of a stripe.
    const int maxCount = strategy.ordersByWeight() ? std::min(getNumThreads(), +maxStripes) : 1;
    const int count = std::max(std::min(maxCount, height / minStripeRows), 1);
    grown(stripes, (size_t)count + 1); // a small layer leaves the memory of the large ones
    parallelFor(count, [&](int s) {
        Stripe& stripe = stripes[s];
        const Range rows((int)((int64)height * s / count), (int)((int64)height * (s + 1) / count));
        stripe.undecidedEdges.clear();
        stripe.frozenRoots.clear();
        startTrees(pixelIntv, rows, buffers);
        orderEdges(strategy, weights, pixelIntv, rows, stripe.edges);
        StripeJoiner(&strategy, beta, rows, buffers, stripe, forest).tryEdges(stripe.edges);
    });

    const Range all(0, height);
    Stripe& whole = stripes[count];
    whole.edges.clear();
    for (int s = 0; s < count; ++s)
    {
        const Stripe& stripe = stripes[s];
        whole.edges.insert(whole.edges.end(), stripe.undecidedEdges.begin(), stripe.undecidedEdges.end());
        for (int root : stripe.frozenRoots)
            buffers.nodes[root].parent += frozenMark;
    }
    sortByWeight(weights, whole.edges); // those of one weight are by number already
    StripeJoiner(&strategy, beta, all, buffers, whole, forest).tryEdges(whole.edges);
    if (!link || !strategy.linksTrees())
        return;
    if (count > 1)
        orderEdges(strategy, weights, pixelIntv, all, stripes[0].edges);
    StripeJoiner(nullptr, beta, all, buffers, whole, forest).tryEdges(stripes[0].edges);
}

} // namespace

void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta, bool link,
                 ForestBuffers& buffers, DisparityForest& forest)
{
    forest.trees.clear(); // those of other links must not be walked if the strategy throws
    weighEdges(image, forest.weights);
    forest.links.create(image.size(), CV_8U);
    forest.links.setTo(Scalar::all(0));
    joinTrees(strategy, pixelIntv, beta, link, buffers, forest);
    for (size_t i = 0; i < buffers.nodes.size(); ++i)
        if (buffers.nodes[i].parent < 0)
            forest.trees.push_back({ (int)i, -buffers.nodes[i].parent, buffers.nodes[i].interval });
}

void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk)
{
    const int width = forest.links.cols;
    const uchar* links = forest.links.ptr();
    const uchar* weights = forest.weights.ptr();
    // By the side on which the parent of pixel p is: the number of the edge to it, less 2 * p
    const int edgeOffsets[] = { 0, 0, 1, 0, -2, 0, 0, 0, 1 - 2 * width };

    int* const pixels = grown(walk.pixels, tree.size);
    int* const parents = grown(walk.parents, tree.size);
    uchar* const edges = grown(walk.weights, tree.size);
    size_t capacity = 64;
    TreeWalk::Step* pending = grown(walk.pending, capacity);
    pending[0] = { tree.root, 0, 0 };
    size_t count = 1;
    for (int i = 0; count > 0; ++i)
    {
        // One by one: what was written in parts a moment ago is slow to read at once.
        const TreeWalk::Step& step = pending[--count];
        const int p = step.pixel, parent = step.parent, parentLink = step.parentLink;
        pixels[i] = p;
        parents[i] = parent;
        edges[i] = weights[2 * p + edgeOffsets[parentLink]];

        // All four neighbours are written and only children are counted: branches would often be mispredicted.
        if (count + 4 > capacity)
            pending = grown(walk.pending, capacity *= 2);
        const int children = links[p] & ~parentLink;
        pending[count] = { p - width, i, TreeLink::BELOW };
        count += (children / TreeLink::ABOVE) & 1;
        pending[count] = { p - 1, i, TreeLink::RIGHT };
        count += (children / TreeLink::LEFT) & 1;
        pending[count] = { p + width, i, TreeLink::ABOVE };
        count += (children / TreeLink::BELOW) & 1;
        pending[count] = { p + 1, i, TreeLink::LEFT };
        count += (children / TreeLink::RIGHT) & 1;
    }
    walk.weights[0] = 0;
}

void drawForest(const DisparityForest& forest, Mat& trees, Mat& intervals)
{
    trees.create(forest.links.size(), CV_32S);
    intervals.create(forest.links.size(), CV_16UC2);
    TreeWalk walk;
    for (size_t t = 0; t < forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        walkTree(forest, tree, walk);
        for (int i = 0; i < tree.size; ++i)
        {
            trees.ptr<int>()[walk.pixels[i]] = (int)t;
            intervals.ptr<DisparityInterval>()[walk.pixels[i]] = tree.interval;
        }
    }
}

double searchRatio(const DisparityForest& forest, int numDisparities)
{
    double searched = 0;
    for (const DisparityTree& tree : forest.trees)
        searched += (double)tree.size * tree.interval.size();
    return searched / ((double)forest.links.total() * numDisparities);
}

}}} // namespace cv::stereo::hdp
