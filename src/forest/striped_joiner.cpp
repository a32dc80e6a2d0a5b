// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "striped_joiner.hpp"

#include <functional>

namespace cv { namespace stereo { namespace hdp {

namespace {

const int maxStripes = 4;
const int minStripeRows = 4;

/** Joins the trees in a stripe of rows. The result is that of trying all edges of the image one after the other, but it
takes less time:

- Stripes are processed side by side. An edge to another stripe waits until all stripes are done, and freezes its tree:
  from its turn on, what the tree would be joined with is not known. An edge to a frozen tree waits as well, and freezes
  the other tree. So each decision sees the same trees as without stripes. An edge whose ends are in one tree already
  needs no decision.
- The last of the four edges around a square of pixels finds its ends connected, if none of the other three was
  rejected. In a square of equal intervals, where edges are seldom rejected, it is left out at first, and restored when
  one of the others is rejected.
- An edge that comes before all other edges of both its ends joins single pixels. It need not wait for its turn. */
template <class Strategy> class StripeJoiner
{
public:
    //! borders: the stripes' first rows, ascending; rows: of this one. isLast: the joiner has all rows and tries what
    //! the others have left.
    StripeJoiner(const Strategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta,
                 const std::vector<int>& borders, const Range& rows, GrowingTrees& trees, JoinerStripe& stripe,
                 bool isLast, Mat& links)
        : joiner_(strategy, beta, trees, links), weights_(weights), pixelIntv_(pixelIntv), borders_(borders),
          rows_(rows), first_(rows.start * pixelIntv.cols), end_(rows.end * pixelIntv.cols), trees_(trees),
          nodes_(trees.nodes.data()), stripe_(stripe), isLast_(isLast)
    {
        stripe.undecided.edges.clear();
        stripe.frozen.clear();
        stripe.rejected.clear();
        stripe.restored.clear();
        stripe.everRestored.clear();
    }

    //! Makes every pixel a tree and tries the edges that need not wait for their turn; selects those that do.
    void start()
    {
        startTrees(pixelIntv_, rows_, trees_);

        const int width = pixelIntv_.cols;
        const int begin = std::max(rows_.start - 1, 0); // the edges from the row above the stripe lead into it
        EdgeRow above(width), row(width), below(width);
        load(begin - 1, above);
        load(begin, row);
        std::vector<uchar> uses(2 * width);
        std::vector<int> atOnce(2 * width);
        stripe_.selected.resize((size_t)(rows_.end - begin) * 2 * width);
        int count = 0;
        for (int y = begin; y < rows_.end; ++y)
        {
            load(y + 1, below);
            chooseUses(above, row, below, uses.data());
            const int edge = 2 * y * width;
            const bool isAbove = y < rows_.start, isBorder = isAbove || y + 1 == rows_.end;
            int atOnceCount = 0;
            for (int i = 0; i < 2 * width; ++i) // without branches, which would often be mispredicted
            {
                atOnce[atOnceCount] = i;
                atOnceCount += uses[i] / AT_ONCE;
            }
            for (int k = 0; k < atOnceCount; ++k)
            {
                const int i = atOnce[k];
                const bool isOutside = isBorder && (isAbove || i % 2 == 1);
                const bool isDone =
                    !isOutside && joiner_.tryEdge(edge + i, weights_.ptr()[edge + i]) == joiner_.CONNECTED;
                uses[i] = isDone ? LEFT_OUT : IN_TURN;
            }
            if (isAbove) // its edges to the right are those of the stripe above
                for (int i = 0; i < 2 * width; i += 2)
                    uses[i] = LEFT_OUT;
            int* selected = &stripe_.selected[count];
            int selectedCount = 0;
            for (int i = 0; i < 2 * width; ++i)
            {
                selected[selectedCount] = edge + i;
                selectedCount += uses[i];
            }
            count += selectedCount;
            std::swap(above, row);
            std::swap(row, below);
        }
        stripe_.selected.resize(count);
        sortByWeight(weights_, stripe_.selected, stripe_.sorted);
    }

    //! Tries the edges that start() selected.
    void joinSelected() { join(stripe_.sorted); }

    //! Tries the edges that the stripes left undecided. This joiner has all rows.
    void joinUndecided(const JoinerStripe* stripes, int count)
    {
        SortedEdges& sorted = stripe_.sorted;
        sorted.edges.clear();
        for (int w = 0; w < 256; ++w)
        {
            for (int s = 0; s < count; ++s)
            {
                const SortedEdges& undecided = stripes[s].undecided;
                const std::vector<int>::const_iterator edges = undecided.edges.begin();
                sorted.edges.insert(sorted.edges.end(), edges + undecided.begin(w), edges + undecided.ends[w]);
            }
            sorted.ends[w] = (int)sorted.edges.size();
        }
        for (int s = 0; s < count; ++s)
        {
            for (int root : stripes[s].frozen)
                nodes_[root].parent += frozenMark;
            stripe_.everRestored.insert(stripe_.everRestored.end(), stripes[s].everRestored.begin(),
                                        stripes[s].everRestored.end());
        }
        std::sort(stripe_.everRestored.begin(), stripe_.everRestored.end());
        join(sorted);
    }

private:
    //! When an edge is tried. The code computes with the numbers.
    enum Use
    {
        LEFT_OUT, // not at all, unless it is restored
        IN_TURN,
        AT_ONCE
    };

    // A Rule 2 that looks at the trees rejects so many edges that leaving some out does not pay.
    static const bool leavesOut = !AsksForState<Strategy>::value;

    //! Whether a row and the one below it are in different stripes
    bool isDivided(int y) const { return std::binary_search(borders_.begin(), borders_.end(), y + 1); }

    void load(int y, EdgeRow& row) const
    {
        row.load(weights_, pixelIntv_, y);
        if (isDivided(y)) // no edge of these squares is left out
            std::fill(row.uniform, row.uniform + pixelIntv_.cols, (ushort)0);
    }

    //! Uses of a row's edges, by number. The order of edges of one weight is that of their numbers: row by row, and for
    //! each pixel the edge to the right before the one below.
    void chooseUses(const EdgeRow& above, const EdgeRow& row, const EdgeRow& below, uchar* uses) const
    {
        // Through an array on the stack, of which the compiler knows that it does not overlap the others
        const int width = pixelIntv_.cols, block = 64;
        ushort use[2][block];
        for (int begin = 0; begin < width; begin += block)
        {
            const int count = std::min(block, width - begin);
            const ushort *r = row.right + begin, *b = row.below + begin, *u = row.uniform + begin;
            const ushort *rightAbove = above.right + begin, *belowAbove = above.below + begin;
            const ushort *rightBelow = below.right + begin, *belowBelow = below.below + begin;
            const ushort* uniformAbove = above.uniform + begin;
            // The edge to the right is the first one of the square below it, and the last one of the square above.
            for (int x = 0; x < count; ++x)
            {
                const ushort w = r[x];
                const ushort square = std::max(std::max(b[x], b[x + 1]), rightBelow[x]);
                const ushort squareAbove = std::max(std::max(rightAbove[x], belowAbove[x]), belowAbove[x + 1]);
                const ushort before = std::min(std::min(belowAbove[x], belowAbove[x + 1]), r[x - 1]);
                const ushort after = std::min(std::min(b[x], b[x + 1]), r[x + 1]);
                use[0][x] = useOf(w, (w < before) & (w <= after),
                                  ((w > square) & u[x]) | ((w >= squareAbove) & uniformAbove[x]));
            }
            // The edge below is the second one of the square on its right, and the third one of the square on its left.
            for (int x = 0; x < count; ++x)
            {
                const ushort w = b[x];
                const ushort square = std::max(b[x + 1], rightBelow[x]), squareLeft = std::max(r[x - 1], b[x - 1]);
                const ushort before = std::min(std::min(belowAbove[x], r[x - 1]), r[x]);
                const ushort after = std::min(std::min(rightBelow[x - 1], rightBelow[x]), belowBelow[x]);
                use[1][x] = useOf(w, (w < before) & (w <= after),
                                  ((w >= r[x]) & (w > square) & u[x]) |
                                      ((w >= squareLeft) & (w > rightBelow[x - 1]) & u[x - 1]));
            }
            for (int x = 0; x < count; ++x)
            {
                uses[2 * (begin + x)] = (uchar)use[0][x];
                uses[2 * (begin + x) + 1] = (uchar)use[1][x];
            }
        }
    }

    //! isFirst: before all other edges of both its ends; isLast: after the other edges of a uniform square.
    static ushort useOf(ushort weight, int isFirst, int isLast)
    {
        return (ushort)((weight < EdgeRow::none) *
                        (isFirst * AT_ONCE + (1 - isFirst) * (1 - (isLast & leavesOut)) * IN_TURN));
    }

    //! Tries edges, and those that are restored meanwhile, each when its turn comes.
    void join(SortedEdges& sorted)
    {
        sorted.edges.resize(sorted.edges.size() + joiner_.prefetchDistance);
        for (int w = 0; w < 256; ++w)
        {
            const int* edges = sorted.edges.data() + sorted.begin(w);
            const int* end = sorted.edges.data() + sorted.ends[w];
            for (;;)
            {
                int edge;
                if (nextRestored_ < orderOf(0, w + 1) && (edges == end || nextRestored_ <= orderOf(*edges, w)))
                {
                    edge = takeRestored();
                    if (edges != end && edge == *edges)
                        ++edges;
                }
                else if (edges != end)
                {
                    joiner_.prefetch(edges[joiner_.prefetchDistance]);
                    edge = *edges++;
                }
                else
                    break;
                process(edge, w);
            }
            stripe_.undecided.ends[w] = (int)stripe_.undecided.edges.size();
        }
    }

    bool isInside(int pixel) const { return pixel >= first_ && pixel < end_; }

    void process(int edge, int weight)
    {
        const int p = firstPixel(edge), q = secondPixel(edge, pixelIntv_.cols);
        if (p < first_ || q >= end_) // it leads to another stripe
        {
            freezeTree(isInside(p) ? p : q);
            if (isInside(p)) // otherwise it is in the list of the stripe above
                stripe_.undecided.edges.push_back(edge);
            return;
        }
        const typename TreeJoiner<Strategy>::Outcome outcome = joiner_.tryEdge(edge, weight);
        if (outcome == joiner_.CONNECTED)
            return;
        if (outcome == joiner_.UNDECIDED)
        {
            freezeTree(p);
            freezeTree(q);
            stripe_.undecided.edges.push_back(edge);
        }
        else
        {
            stripe_.rejected.push_back(orderOf(edge, weight));
            if (leavesOut)
            {
                restoreLast(p, orderOf(edge, weight));
                restoreLast((edge & 1) ? p - 1 : p - pixelIntv_.cols, orderOf(edge, weight));
            }
        }
    }

    void freezeTree(int pixel)
    {
        const int root = findRoot(nodes_, pixel);
        if (!isFrozen(nodes_[root].parent))
        {
            nodes_[root].parent -= frozenMark;
            stripe_.frozen.push_back(root);
        }
    }

    //! Restores the last edge of the square to the right of and below a pixel, if it was left out: another one of the
    //! square was rejected. The last joiner must not restore again what was restored in a stripe.
    void restoreLast(int pixel, uint64 rejected)
    {
        const int width = pixelIntv_.cols, y = pixel / width, x = pixel % width;
        if (pixel < 0 || y + 1 == pixelIntv_.rows || x + 1 == width || isDivided(y) ||
            !isUniform(pixelIntv_.ptr<DisparityInterval>(y) + x, pixelIntv_.ptr<DisparityInterval>(y + 1) + x))
            return;
        uint64 last = 0;
        for (int edge : { 2 * pixel, 2 * pixel + 1, 2 * (pixel + 1) + 1, 2 * (pixel + width) })
            last = std::max(last, orderOf(edge, weights_.ptr()[edge]));
        if (last > rejected && !wasRestored(edgeOf(last)))
            restore(last);
    }

    bool wasRestored(int edge) const
    {
        return isLast_ && std::binary_search(stripe_.everRestored.begin(), stripe_.everRestored.end(), edge);
    }

    void restore(uint64 order)
    {
        stripe_.restored.push_back(order);
        std::push_heap(stripe_.restored.begin(), stripe_.restored.end(), std::greater<uint64>());
        nextRestored_ = stripe_.restored[0];
    }

    int takeRestored()
    {
        const uint64 order = nextRestored_;
        while (nextRestored_ == order) // two squares may have restored it
        {
            std::pop_heap(stripe_.restored.begin(), stripe_.restored.end(), std::greater<uint64>());
            stripe_.restored.pop_back();
            nextRestored_ = stripe_.restored.empty() ? UINT64_MAX : stripe_.restored[0];
        }
        if (!isLast_)
            stripe_.everRestored.push_back(edgeOf(order));
        return edgeOf(order);
    }

    TreeJoiner<Strategy> joiner_;
    const Mat& weights_;
    const Mat& pixelIntv_;
    const std::vector<int>& borders_;
    const Range rows_;
    const int first_, end_; // pixels
    GrowingTrees& trees_;
    GrowingTrees::Node* const nodes_;
    JoinerStripe& stripe_;
    const bool isLast_;
    uint64 nextRestored_ = UINT64_MAX; // the first of stripe_.restored
};

//! Tries edges that Rule 2 rejected once more, in order and without it.
void linkTrees(const std::vector<JoinerStripe>& stripes, const Mat& weights, double beta, GrowingTrees& trees,
               Mat& links)
{
    std::vector<uint64> rejected;
    for (const JoinerStripe& stripe : stripes)
    {
        const size_t count = rejected.size();
        rejected.insert(rejected.end(), stripe.rejected.begin(), stripe.rejected.end());
        std::inplace_merge(rejected.begin(), rejected.begin() + count, rejected.end());
    }
    const MinimumSpanningTree everyEdge;
    TreeJoiner<MinimumSpanningTree> joiner(everyEdge, beta, trees, links);
    for (uint64 order : rejected)
        joiner.tryEdge(edgeOf(order), weights.ptr()[edgeOf(order)]);
}

template <class Strategy>
void joinInStripes(const Strategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta, GrowingTrees& trees,
                   std::vector<JoinerStripe>& stripes, Mat& links)
{
    const int height = pixelIntv.rows;
    // The number of threads decides how fast it goes, not what comes out.
    const int count = std::max(std::min(std::min(getNumThreads(), maxStripes), height / minStripeRows), 1);
    std::vector<int> borders;
    for (int s = 0; s < count; ++s)
        borders.push_back((int)((int64)height * s / count));
    stripes.resize(count + 1);
    if (AsksForState<Strategy>::value)
        trees.maxWeights.assign(pixelIntv.total(), 0);
    parallel_for_(Range(0, count), [&](const Range& range) {
        for (int s = range.start; s < range.end; ++s)
        {
            const Range rows(borders[s], s + 1 < count ? borders[s + 1] : height);
            StripeJoiner<Strategy> joiner(strategy, weights, pixelIntv, beta, borders, rows, trees, stripes[s], false,
                                          links);
            joiner.start();
            joiner.joinSelected();
        }
    });
    StripeJoiner<Strategy> last(strategy, weights, pixelIntv, beta, borders, Range(0, height), trees, stripes[count],
                                true, links);
    last.joinUndecided(stripes.data(), count);
}

} // namespace

void joinByWeight(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta, bool link,
                  GrowingTrees& trees, std::vector<JoinerStripe>& stripes, Mat& links)
{
    // Rule 2 of the library's own classes is inlined.
    if (const MinimumSpanningTree* minimumSpanningTree = dynamic_cast<const MinimumSpanningTree*>(&strategy))
        joinInStripes(*minimumSpanningTree, weights, pixelIntv, beta, trees, stripes, links);
    else if (const SegmentTree* segmentTree = dynamic_cast<const SegmentTree*>(&strategy))
        joinInStripes(*segmentTree, weights, pixelIntv, beta, trees, stripes, links);
    else
        joinInStripes(strategy, weights, pixelIntv, beta, trees, stripes, links);
    if (link)
        linkTrees(stripes, weights, beta, trees, links);
}

}}} // namespace cv::stereo::hdp
