// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_forest.hpp"
#include "tree_strategy.hpp"

#include "opencv2/core/hal/intrin.hpp"

#include <functional>

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// DT-Rule 1 spares edges of at most this weight.
const int lightEdge = 7;

typedef ForestBuffers::Node Node;
typedef ForestBuffers::SortedEdges SortedEdges;
typedef ForestBuffers::Stripe Stripe;

//! The largest absolute difference over the channels of two pixels
int difference(const uchar* a, const uchar* b, int channels)
{
    int largest = 0;
    for (int c = 0; c < channels; ++c)
        largest = std::max(largest, std::abs(a[c] - b[c]));
    return largest;
}

#if CV_SIMD128
//! Of 16 pixels
v_uint8x16 differences(const uchar* a, const uchar* b, int channels)
{
    if (channels == 1)
        return v_absdiff(v_load(a), v_load(b));
    v_uint8x16 a0, a1, a2, b0, b1, b2;
    v_load_deinterleave(a, a0, a1, a2);
    v_load_deinterleave(b, b0, b1, b2);
    return v_max(v_max(v_absdiff(a0, b0), v_absdiff(a1, b1)), v_absdiff(a2, b2));
}
#endif

//! w(p, q) of each pixel's edges to the right and below.
void weighEdges(const Mat& image, Mat& weights)
{
    const int channels = image.channels(), width = image.cols;
    weights.create(image.size(), CV_8UC2);
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const uchar* row = image.ptr(y);
            const uchar* next = image.ptr(std::min(y + 1, image.rows - 1)); // the last row itself below it
            uchar* weight = weights.ptr(y);
            int x = 0;
#if CV_SIMD128
            for (; x + 16 < width; x += 16)
            {
                const uchar *p = row + x * channels, *right = p + channels, *below = next + x * channels;
                v_store_interleave(weight + 2 * x, differences(p, right, channels), differences(p, below, channels));
            }
#endif
            for (; x < width; ++x)
            {
                const uchar *p = row + x * channels, *right = x + 1 < width ? p + channels : p;
                weight[2 * x] = (uchar)difference(p, right, channels);
                weight[2 * x + 1] = (uchar)difference(p, next + x * channels, channels);
            }
        }
    });
}

bool intersect(const DisparityInterval& a, const DisparityInterval& b)
{
    return std::max(a.first, b.first) <= std::min(a.last, b.last);
}

bool equal(const DisparityInterval& a, const DisparityInterval& b) { return (a.first == b.first) & (a.last == b.last); }

//! Whether the four pixels to the right of and below this one search the same disparities. It has such neighbours.
bool isUniform(const DisparityInterval* interval, const DisparityInterval* below)
{
    // Numbers, not bool, as without branches it is vectorised
    const int first = interval[0].first, last = interval[0].last;
    const int differences = (first ^ interval[1].first) | (first ^ below[0].first) | (first ^ below[1].first) |
                            (last ^ interval[1].last) | (last ^ below[0].last) | (last ^ below[1].last);
    return differences == 0 && first <= last;
}

//! The edges of a row of pixels under DT-Rule 1.
class EdgeRow
{
public:
    static const ushort none = 256; // more than any weight

    // right[x], below[x]: the weight of an edge, none if there is no such edge; uniform[x]: 0 or 1, isUniform();
    // x = -1 .. width
    ushort *right, *below, *uniform;

    explicit EdgeRow(int width) : width_(width), buffer_(3 * (width + 2))
    {
        right = &buffer_[1];
        below = right + width + 2;
        uniform = below + width + 2;
    }

    //! Row y, which may be outside.
    void load(const Mat& weights, const Mat& pixelIntv, int y)
    {
        const int width = width_, padded = width + 2;
        std::fill(buffer_.begin(), buffer_.begin() + 2 * padded, none + 0);
        std::fill(buffer_.begin() + 2 * padded, buffer_.end(), (ushort)0);
        if (y < 0 || y >= weights.rows)
            return;
        const uchar* weight = weights.ptr(y);
        const DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
        for (int x = 0; x + 1 < width; ++x)
        {
            const bool isKept = (weight[2 * x] <= lightEdge) | intersect(interval[x], interval[x + 1]);
            right[x] = isKept ? (ushort)weight[2 * x] : none;
        }
        if (y + 1 == weights.rows)
            return;
        const DisparityInterval* next = pixelIntv.ptr<DisparityInterval>(y + 1);
        for (int x = 0; x < width; ++x)
        {
            const bool isKept = (weight[2 * x + 1] <= lightEdge) | intersect(interval[x], next[x]);
            below[x] = isKept ? (ushort)weight[2 * x + 1] : none;
        }
        for (int x = 0; x + 1 < width; ++x)
            uniform[x] = isUniform(interval + x, next + x);
    }

private:
    int width_;
    std::vector<ushort> buffer_;
};

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

// Less by this is the parent of a frozen root; an image has fewer pixels.
const int frozen = 1 << 30;

// How many edges before its turn an edge is prefetched
const int ahead = 12;

//! Whether Rule 2 asks for the state of the trees
template <class Strategy> struct NeedsState
{
    static const bool value = true;
};

template <> struct NeedsState<MinimumSpanningTree>
{
    static const bool value = false;
};

//! Tries edges: Rule 2 and DT-Rule 2.
template <class Strategy> class TreeJoiner
{
public:
    enum Outcome
    {
        CONNECTED, // The edge's ends are in the same tree now
        REJECTED,
        UNDECIDED // One of the trees is frozen
    };

    TreeJoiner(const Strategy& strategy, double beta, ForestBuffers& buffers, DisparityForest& forest)
        : strategy_(strategy), beta_(beta), width_(forest.links.cols), links_(forest.links.ptr()),
          nodes_(buffers.nodes.data()), maxWeights_(buffers.maxWeights.data())
    {
    }

    Outcome tryEdge(int edge, int weight)
    {
        const int p = edge >> 1, below = edge & 1, q = below ? p + width_ : p + 1;
        const int a = findNearRoot(p), b = findNearRoot(q);
        if (a == b)
            return CONNECTED;
        const Node nodeA = nodes_[a], nodeB = nodes_[b];
        if (std::min(nodeA.parent, nodeB.parent) < -frozen)
            return UNDECIDED;
        const bool isEqual = equal(nodeA.interval, nodeB.interval);
        if (isEqual ? nodeA.interval.empty() : !overlap(nodeA.interval, nodeB.interval))
            return REJECTED;
        uchar maxWeight = 0;
        if (NeedsState<Strategy>::value)
        {
            const TreeState stateA = { -nodeA.parent, maxWeights_[a] }, stateB = { -nodeB.parent, maxWeights_[b] };
            if (!strategy_.mayJoin(weight, stateA, stateB))
                return REJECTED;
            maxWeight = std::max((uchar)weight, std::max(stateA.maxWeight, stateB.maxWeight));
        }

        // The larger tree's root stays, p's if they are equal. A branch would often be mispredicted.
        const int change = (a ^ b) & -(int)(nodeA.parent > nodeB.parent), root = a ^ change, joined = b ^ change;
        nodes_[root].parent = nodeA.parent + nodeB.parent;
        nodes_[joined].parent = root;
        if (NeedsState<Strategy>::value)
            maxWeights_[root] = maxWeight;
        if (!isEqual && strategy_.unitesIntervals())
            nodes_[root].interval = hull(nodeA.interval, nodeB.interval);
        links_[p] |= (uchar)(below ? DisparityForest::BELOW : DisparityForest::RIGHT);
        links_[q] |= (uchar)(below ? DisparityForest::ABOVE : DisparityForest::LEFT);
        return CONNECTED;
    }

    //! Hints that an edge is going to be tried.
    void prefetch(int edge) const
    {
#ifdef __GNUC__
        __builtin_prefetch(nodes_ + (edge >> 1));
        __builtin_prefetch(nodes_ + (edge >> 1) + width_);
#else
        (void)edge;
#endif
    }

private:
    //! Most roots are at most two steps away: these are taken without branches.
    int findNearRoot(int i)
    {
        int node = i;
        for (int step = 0; step < 2; ++step)
        {
            const int parent = nodes_[node].parent, isRoot = parent >> 31;
            node = (node & isRoot) | (parent & ~isRoot);
        }
        return nodes_[node].parent < 0 ? node : nodes_[i].parent = findRoot(nodes_, node);
    }

    static DisparityInterval hull(const DisparityInterval& a, const DisparityInterval& b)
    {
        const DisparityInterval interval = { std::min(a.first, b.first), std::max(a.last, b.last) };
        return interval;
    }

    //! DT-Rule 2: the share of the intervals' intersection in their hull.
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

//! The order in which edges are tried, of strategies that sort them by weight
uint64 orderOf(int edge, int weight) { return ((uint64)weight << 32) | (unsigned)edge; }

int edgeOf(uint64 order) { return (int)(order & 0xffffffffu); }

/** Kruskal's algorithm for a stripe of the image's rows. The trees, and their roots, are those that come from trying
all edges of the image one after another, in less time:

- Stripes are processed side by side. A tree is frozen, and edges to it stay undecided until all stripes are done, from
  the moment when an edge to another stripe or to a frozen tree may change it: so every decision depends on what it
  would depend on in the whole image. An edge whose ends are in one tree needs no decision.
- Of the four edges around a square of pixels, the last one connects what is connected when its turn comes, if
  none of the others was rejected. In squares of equal intervals, where this is rare, it is left out at first, and
  restored when one of the others is rejected.
- An edge that comes before all others of both its ends joins single pixels, so it need not wait for its turn. */
template <class Strategy> class StripeJoiner
{
public:
    //! borders: the stripes' first rows, ascending
    StripeJoiner(const Strategy& strategy, double beta, const Mat& pixelIntv, const std::vector<int>& borders,
                 const Range& rows, ForestBuffers& buffers, DisparityForest& forest, Stripe& stripe)
        : joiner_(strategy, beta, buffers, forest), pixelIntv_(pixelIntv), weights_(forest.weights), borders_(borders),
          rows_(rows), first_(rows.start * pixelIntv.cols), last_(rows.end * pixelIntv.cols),
          nodes_(buffers.nodes.data()), stripe_(stripe), isWhole_(&stripe == &buffers.stripes.back())
    {
        stripe.undecided.edges.clear();
        stripe.restored.clear();
        stripe.frozen.clear();
        stripe.rejected.clear();
        stripe.everRestored.clear();
    }

    //! Makes every pixel a tree, and joins those that are each other's first.
    void start()
    {
        const int width = pixelIntv_.cols;
        for (int y = rows_.start; y < rows_.end; ++y)
        {
            const DisparityInterval* intervals = pixelIntv_.ptr<DisparityInterval>(y);
            for (int x = 0; x < width; ++x)
            {
                const Node node = { -1, intervals[x] };
                nodes_[y * width + x] = node;
            }
        }

        // The row above the stripe is there for its edges to below.
        const int begin = std::max(rows_.start - 1, 0);
        EdgeRow above(width), row(width), below(width);
        load(begin - 1, above);
        load(begin, row);
        std::vector<uchar> uses(2 * width);
        std::vector<int> firsts(2 * width);
        stripe_.selected.resize((size_t)(rows_.end - begin) * 2 * width);
        int count = 0;
        for (int y = begin; y < rows_.end; ++y)
        {
            load(y + 1, below);
            chooseUses(above, row, below, uses.data());
            const int edge = 2 * y * width;
            const bool isAbove = y < rows_.start, leaves = isAbove || y + 1 == rows_.end;
            int firstsCount = 0;
            for (int i = 0; i < 2 * width; ++i) // without branches, which would often be mispredicted
            {
                firsts[firstsCount] = i;
                firstsCount += uses[i] / FIRST;
            }
            for (int f = 0; f < firstsCount; ++f)
            {
                const int i = firsts[f];
                const bool waits = leaves && (isAbove || i % 2 == 1);
                const bool isDone = !waits && joiner_.tryEdge(edge + i, weights_.ptr()[edge + i]) == joiner_.CONNECTED;
                uses[i] = isDone ? UNUSED : TRIED;
            }
            if (isAbove)
                for (int i = 0; i < 2 * width; i += 2)
                    uses[i] = UNUSED;
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
        sortEdges();
    }

    //! Tries what start() left.
    void joinSorted() { join(stripe_.sorted); }

    //! Tries what stripes left undecided. This one covers all of them.
    void joinUndecided(const Stripe* stripes, int count)
    {
        SortedEdges& sorted = stripe_.sorted;
        sorted.edges.clear();
        for (int w = 0; w < 256; ++w)
        {
            for (int s = 0; s < count; ++s)
            {
                const SortedEdges& undecided = stripes[s].undecided;
                const std::vector<int>::const_iterator edges = undecided.edges.begin();
                sorted.edges.insert(sorted.edges.end(), edges + beginOf(undecided, w), edges + undecided.ends[w]);
            }
            sorted.ends[w] = (int)sorted.edges.size();
        }
        for (int s = 0; s < count; ++s)
        {
            for (int root : stripes[s].frozen)
                nodes_[root].parent += frozen;
            stripe_.everRestored.insert(stripe_.everRestored.end(), stripes[s].everRestored.begin(),
                                        stripes[s].everRestored.end());
        }
        std::sort(stripe_.everRestored.begin(), stripe_.everRestored.end());
        join(sorted);
    }

private:
    enum Use
    {
        UNUSED,
        TRIED,
        FIRST
    };

    // A Rule 2 that looks at the trees rejects so many edges that leaving some out does not pay.
    static const bool leavesOut = !NeedsState<Strategy>::value;

    //! Whether a row and the one below it are in different stripes
    bool isDivided(int y) const { return std::binary_search(borders_.begin(), borders_.end(), y + 1); }

    void load(int y, EdgeRow& row) const
    {
        row.load(weights_, pixelIntv_, y);
        if (isDivided(y)) // nothing is left out there
            std::fill(row.uniform, row.uniform + pixelIntv_.cols, (ushort)0);
    }

    static int beginOf(const SortedEdges& sorted, int weight) { return weight > 0 ? sorted.ends[weight - 1] : 0; }

    //! Uses of a row's edges, to the right and below in turns. Edges of equal weight are tried by rows, and of a
    //! pixel's that to the right comes first.
    void chooseUses(const EdgeRow& above, const EdgeRow& row, const EdgeRow& below, uchar* uses) const
    {
        // Through an array of the stack, of which the compiler knows that it does not overlap others
        const int width = pixelIntv_.cols, block = 64;
        ushort use[2][block];
        for (int begin = 0; begin < width; begin += block)
        {
            const int count = std::min(block, width - begin);
            const ushort *r = row.right + begin, *b = row.below + begin, *u = row.uniform + begin;
            const ushort *rightAbove = above.right + begin, *belowAbove = above.below + begin;
            const ushort *rightBelow = below.right + begin, *belowBelow = below.below + begin;
            const ushort* uniformAbove = above.uniform + begin;
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

    static ushort useOf(ushort weight, int isFirst, int isLast)
    {
        return (ushort)((weight < EdgeRow::none) *
                        (isFirst * FIRST + (1 - isFirst) * (1 - (isLast & leavesOut)) * TRIED));
    }

    //! A counting sort.
    void sortEdges()
    {
        const uchar* weights = weights_.ptr();
        int places[256] = { 0 }, sum = 0; // numbers of edges, then where the next one goes
        for (int edge : stripe_.selected)
            ++places[weights[edge]];
        for (int w = 0; w < 256; ++w)
        {
            const int count = places[w];
            places[w] = sum;
            sum += count;
            stripe_.sorted.ends[w] = sum;
        }
        stripe_.sorted.edges.resize(sum);
        for (int edge : stripe_.selected)
            stripe_.sorted.edges[places[weights[edge]]++] = edge;
    }

    void join(SortedEdges& sorted)
    {
        sorted.edges.resize(sorted.edges.size() + ahead);
        for (int w = 0; w < 256; ++w)
        {
            const int* edges = sorted.edges.data() + beginOf(sorted, w);
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
                    joiner_.prefetch(edges[ahead]);
                    edge = *edges++;
                }
                else
                    break;
                process(edge, w);
            }
            stripe_.undecided.ends[w] = (int)stripe_.undecided.edges.size();
        }
    }

    bool isInside(int pixel) const { return pixel >= first_ && pixel < last_; }

    void process(int edge, int weight)
    {
        const int p = edge >> 1, q = (edge & 1) ? p + pixelIntv_.cols : p + 1;
        if (p < first_ || q >= last_)
        {
            freeze(isInside(p) ? p : q);
            if (isInside(p)) // else the stripe above has it
                stripe_.undecided.edges.push_back(edge);
            return;
        }
        const typename TreeJoiner<Strategy>::Outcome outcome = joiner_.tryEdge(edge, weight);
        if (outcome == joiner_.CONNECTED)
            return;
        if (outcome == joiner_.UNDECIDED)
        {
            freeze(p);
            freeze(q);
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

    //! Freezes the tree of a pixel.
    void freeze(int pixel)
    {
        const int root = findRoot(nodes_, pixel);
        if (nodes_[root].parent >= -frozen)
        {
            nodes_[root].parent -= frozen;
            stripe_.frozen.push_back(root);
        }
    }

    //! An edge was rejected of the square to the right of and below a pixel: its last edge has to be tried if it was
    //! left out, and only once, at its turn: in a stripe or, if it was not restored there, at last.
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

    //! Whether an edge was restored already when its stripe was processed
    bool wasRestored(int edge) const
    {
        return isWhole_ && std::binary_search(stripe_.everRestored.begin(), stripe_.everRestored.end(), edge);
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
        while (nextRestored_ == order) // it may have been restored for two squares
        {
            std::pop_heap(stripe_.restored.begin(), stripe_.restored.end(), std::greater<uint64>());
            stripe_.restored.pop_back();
            nextRestored_ = stripe_.restored.empty() ? UINT64_MAX : stripe_.restored[0];
        }
        if (!isWhole_)
            stripe_.everRestored.push_back(edgeOf(order));
        return edgeOf(order);
    }

    TreeJoiner<Strategy> joiner_;
    const Mat& pixelIntv_;
    const Mat& weights_;
    const std::vector<int>& borders_;
    const Range rows_;
    const int first_, last_; // pixels
    Node* const nodes_;
    Stripe& stripe_;
    const bool isWhole_;               // the last, which covers all stripes
    uint64 nextRestored_ = UINT64_MAX; // the first of stripe_.restored
};

//! Kruskal's algorithm with edges by weight, and the second pass that links what Rule 2 left apart.
template <class Strategy>
void joinByWeight(const Strategy& strategy, const Mat& pixelIntv, double beta, bool link, ForestBuffers& buffers,
                  DisparityForest& forest)
{
    const int height = pixelIntv.rows;
    const int stripes = std::max(std::min(std::min(getNumThreads(), 4), height / 4), 1);
    std::vector<int> borders;
    for (int s = 0; s < stripes; ++s)
        borders.push_back((int)((int64)height * s / stripes));
    buffers.stripes.resize(stripes + 1);
    if (NeedsState<Strategy>::value)
        buffers.maxWeights.assign(pixelIntv.total(), 0);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int s = range.start; s < range.end; ++s)
        {
            const Range rows(borders[s], s + 1 < stripes ? borders[s + 1] : height);
            StripeJoiner<Strategy> joiner(strategy, beta, pixelIntv, borders, rows, buffers, forest,
                                          buffers.stripes[s]);
            joiner.start();
            joiner.joinSorted();
        }
    });
    StripeJoiner<Strategy> all(strategy, beta, pixelIntv, borders, Range(0, height), buffers, forest,
                               buffers.stripes[stripes]);
    all.joinUndecided(buffers.stripes.data(), stripes);

    if (!link)
        return;
    std::vector<uint64> rejected;
    for (const Stripe& stripe : buffers.stripes)
    {
        const size_t count = rejected.size();
        rejected.insert(rejected.end(), stripe.rejected.begin(), stripe.rejected.end());
        std::inplace_merge(rejected.begin(), rejected.begin() + count, rejected.end());
    }
    const MinimumSpanningTree everyEdge;
    TreeJoiner<MinimumSpanningTree> joiner(everyEdge, beta, buffers, forest);
    for (uint64 order : rejected)
        joiner.tryEdge(edgeOf(order), forest.weights.ptr()[edgeOf(order)]);
}

//! The edges, by number, that DT-Rule 1 leaves.
void selectEdges(const Mat& weights, const Mat& pixelIntv, std::vector<int>& edges)
{
    const int width = weights.cols;
    EdgeRow row(width);
    edges.clear();
    for (int y = 0; y < weights.rows; ++y)
    {
        row.load(weights, pixelIntv, y);
        for (int x = 0; x < width; ++x)
        {
            const int edge = 2 * (y * width + x);
            if (row.right[x] != EdgeRow::none)
                edges.push_back(edge);
            if (row.below[x] != EdgeRow::none)
                edges.push_back(edge + 1);
        }
    }
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

//! Tries edges one after another.
template <class Strategy>
void joinInOrder(const Strategy& strategy, const std::vector<int>& edges, double beta, ForestBuffers& buffers,
                 DisparityForest& forest)
{
    const uchar* weights = forest.weights.ptr();
    TreeJoiner<Strategy> joiner(strategy, beta, buffers, forest);
    for (size_t i = 0; i < edges.size(); ++i)
    {
        joiner.prefetch(edges[std::min(i + ahead, edges.size() - 1)]);
        joiner.tryEdge(edges[i], weights[edges[i]]);
    }
}

//! Kruskal's algorithm with edges in the order of any strategy.
void joinInAnyOrder(const TreeStrategy& strategy, const Mat& pixelIntv, double beta, bool link, ForestBuffers& buffers,
                    DisparityForest& forest)
{
    for (int y = 0; y < pixelIntv.rows; ++y)
        for (int x = 0; x < pixelIntv.cols; ++x)
        {
            const Node node = { -1, pixelIntv.ptr<DisparityInterval>(y)[x] };
            buffers.nodes[(size_t)y * pixelIntv.cols + x] = node;
        }
    buffers.maxWeights.assign(pixelIntv.total(), 0);
    selectEdges(forest.weights, pixelIntv, buffers.edges);
    const MinimumSpanningTree everyEdge;
    if (const RandomTree* randomTree = dynamic_cast<const RandomTree*>(&strategy))
    {
        randomTree->orderEdges(forest.weights, buffers.edges);
        joinInOrder(everyEdge, buffers.edges, beta, buffers, forest);
    }
    else
    {
        orderEdges(strategy, forest.weights, buffers.edges);
        joinInOrder(strategy, buffers.edges, beta, buffers, forest);
    }
    if (link)
        joinInOrder(everyEdge, buffers.edges, beta, buffers, forest);
}

} // namespace

void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta, bool link,
                 ForestBuffers& buffers, DisparityForest& forest)
{
    forest.trees.clear(); // those of other links must not be walked if the strategy throws
    weighEdges(image, forest.weights);
    forest.links.create(image.size(), CV_8U);
    forest.links.setTo(Scalar::all(0));
    buffers.nodes.resize(image.total());
    // Of the library's own strategies the type tells both rules, so that the edges come in order at once and Rule 2 is
    // inlined: the types are final.
    const bool links = link && strategy.linksTrees();
    if (const MinimumSpanningTree* minimumSpanningTree = dynamic_cast<const MinimumSpanningTree*>(&strategy))
        joinByWeight(*minimumSpanningTree, pixelIntv, beta, links, buffers, forest);
    else if (const SegmentTree* segmentTree = dynamic_cast<const SegmentTree*>(&strategy))
        joinByWeight(*segmentTree, pixelIntv, beta, links, buffers, forest);
    else
        joinInAnyOrder(strategy, pixelIntv, beta, links, buffers, forest);
    for (size_t i = 0; i < buffers.nodes.size(); ++i)
        if (buffers.nodes[i].parent < 0)
        {
            const DisparityTree tree = { (int)i, -buffers.nodes[i].parent, buffers.nodes[i].interval };
            forest.trees.push_back(tree);
        }
}

void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk)
{
    if (walk.weights.size() < (size_t)tree.size) // the last to grow: if there was no memory, the others may be larger
    {
        walk.pixels.resize(tree.size);
        walk.parents.resize(tree.size);
        walk.weights.resize(tree.size);
    }
    if (walk.pending.empty())
        walk.pending.resize(64);
    const int width = forest.links.cols;
    const uchar* links = forest.links.ptr();
    const uchar* weights = forest.weights.ptr();
    // Where the edge to the parent is, from twice the pixel's number, by the side on which the parent is
    const int edgeFrom[] = { 0, 0, 1, 0, -2, 0, 0, 0, 1 - 2 * width };

    int* pixels = walk.pixels.data();
    int* parents = walk.parents.data();
    uchar* edges = walk.weights.data();
    TreeWalk::Step* pending = walk.pending.data();
    size_t capacity = walk.pending.size();
    const TreeWalk::Step root = { tree.root, 0, 0 };
    pending[0] = root;
    size_t count = 1;
    for (int i = 0; count > 0; ++i)
    {
        const TreeWalk::Step step = pending[--count];
        const int p = step.pixel;
        pixels[i] = p;
        parents[i] = step.parent;
        edges[i] = weights[2 * p + edgeFrom[step.from]];

        // All four neighbours are written, but only children count: which they are is hard to foresee.
        if (count + 4 > capacity)
        {
            capacity *= 2;
            walk.pending.resize(capacity);
            pending = walk.pending.data();
        }
        const int children = links[p] & ~step.from;
        const TreeWalk::Step above = { p - width, i, DisparityForest::BELOW };
        const TreeWalk::Step left = { p - 1, i, DisparityForest::RIGHT };
        const TreeWalk::Step below = { p + width, i, DisparityForest::ABOVE };
        const TreeWalk::Step right = { p + 1, i, DisparityForest::LEFT };
        pending[count] = above;
        count += (children / DisparityForest::ABOVE) & 1;
        pending[count] = left;
        count += (children / DisparityForest::LEFT) & 1;
        pending[count] = below;
        count += (children / DisparityForest::BELOW) & 1;
        pending[count] = right;
        count += (children / DisparityForest::RIGHT) & 1;
    }
    walk.weights[0] = 0;
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
