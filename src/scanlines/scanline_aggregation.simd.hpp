// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "scanline_aggregation.hpp"
#include "../base/vectorized.hpp"
#include "winner_fraction.hpp"
#include <cstring>
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#include "scanline_windows.simd.hpp"
#include "window_costs.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Aggregates a stripe of the image.
@param problem The layer.
@param stripe Its rows.
@param scratch Memory to work in.
@param stored The same, ScanlineScratch::storedBytes() for each row from the first one of the stripe's reach to its
last, and for one more if their number is odd.
@param disparity As in aggregateScanlines().
@param residual As in aggregateScanlines(). */
void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     uchar* stored, Mat& disparity, Mat& residual);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef CandidateWindow Window;

/** A sweep over a stripe. With the notation of aggregateScanlines(), and m the minimum of L(q, k) over k, a direction
carries what a candidate saves against the large penalty, instead of its cost:

H(q, d) = max(m + large(p, q) - L(q, d), 0), which is also right, 0, for candidates that q does not have.
As min(x, m + large(p, q)) = m + large(p, q) - max(m + large(p, q) - x, 0) for any x,
min(L(q, d), L(q, d - 1) + small, L(q, d + 1) + small, m + large(p, q)) - m = large(p, q) - gain(d) with
gain(d) = max(H(q, d), H(q, d - 1) - small, H(q, d + 1) - small, 0).
Only differences between the candidates of a pixel count, so the largest penalty, K, may stand for large(p, q) here:
L(p, d) = (C(p, d) + K) - gain(d), and with its minimum m' over the candidates of p and the pixel r after it
H(p, d) = max(large(p, r) - (L(p, d) - m'), 0).

All of these are bytes, and the differences saturate at 0 by themselves. What aggregateScanlines() says, step by step,
is oracle::Scanlines of test/oracles.hpp; the two are compared.

A sweep upward computes the costs and follows the directions from below and from the left; it stores the costs and the
sum of both directions. A sweep downward follows those from above and from the right, and takes the winners.

Rows are done in blocks of ByteLanes::groups, the lowest one in the first group, skewed: when that one is at column x,
group r is at column x - 2 r. Upward, from the left to the right, group r finds what the group before left there a step
ago; downward, from the right to the left, what the group behind did. All groups enter a pixel of the layer above, which
is two columns wide, at the same step: a step is a pair of columns, for group r those of pixel t - r of the layer above.
Groups that are beside the image compute what nobody reads: all that is stored by column has a margin. */
class Sweep
{
public:
    Sweep(const ScanlineProblem& problem, bool isUpward, ScanlineScratch& scratch)
        : p_(problem), width_(problem.size.width), pairs_((width_ + 1) / 2), steps_(pairs_ + groups - 1),
          pixelCosts_(*problem.cost, width_), zero_(ByteLanes::repeat(0)),
          vertical_(alignPtr(scratch.vertical.data(), ScanlineScratch::alignment) +
                    ScanlineScratch::margin * Window::candidates),
          tables_(problem, isUpward, groups, scratch), windows_(0), upperRow_(-1), entersUpperRow_(false),
          isUpward_(isUpward)
    {
        for (int r = 0; r < groups; ++r)
        {
            const size_t row = r * (2 * (size_t)pairs_ + 2 * margin) + margin;
            winners_[r] = scratch.winners.data() + row;
            sums_[r] = scratch.winnerSums.data() + row;
            costs_[r] = scratch.winnerCosts.data() + row;
            edges_[r] = scratch.edges.data() + 2 * row;
        }
    }

    //! What a sweep upward does with a block of rows
    enum UpwardStep
    {
        FOLLOW,     //!< follows the direction from below
        AGGREGATE,  //!< all that it can
        STORE_COSTS //!< that alone
    };

    //! A block of rows from y on; stored: receives costs and sums, unless the rows are only followed
    void upward(int y, UpwardStep step, uchar* stored)
    {
        enterRows(y);
        typedef void (Sweep::*Method)(UpwardStep, uchar*);
        const int hasLimits = WindowCosts::hasLimits;
        static const Method all[] = { &Sweep::upward<1>, &Sweep::upward<2>, &Sweep::upward<3> };
        static const Method limited[] = { &Sweep::upward<hasLimits + 1>, &Sweep::upward<hasLimits + 2>,
                                          &Sweep::upward<hasLimits + 3> };
        (this->*(p_.cost->limits().isEmpty() ? all : limited)[p_.cost->planes() - 1])(step, stored);
    }

    //! The direction from above alone, over a block of rows from y on; stored: their costs
    void follow(int y, const uchar* stored)
    {
        enterRows(y);
        ByteLanes before[2] = { zero_, zero_ };
        for (int t = steps_ - 1; t >= 0; --t)
        {
            const ByteLanes small = smallPenalty(t);
            const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
            for (int column = 1; column >= 0; --column)
                fromAbove(ByteLanes::load(stored + storedAt(t, column)), small, toNext[column], t, column,
                          before[column]);
        }
    }

    //! The winners of a block of rows from y on, of which those before end count; stored: their costs and sums
    void downward(int y, int end, const uchar* stored, Mat& disparity, Mat& residual)
    {
        enterRows(y);
        aggregateDownward(stored);
        for (int r = 0; r < groups; ++r)
        {
            const int row = y + groups - 1 - r;
            if (row < end)
                finishRow(r, disparity.ptr<ushort>(row), residual.ptr(row));
        }
    }

private:
    enum
    {
        groups = ByteLanes::groups,
        lanes = groups * Window::candidates,
        margin = ScanlineScratch::margin
    };
    static_assert(groups <= (int)ScanlineScratch::maxBlock, "the scratch memory is for larger blocks");

    //! Prepares a block of rows from y on: tables of the windows, if these are new, edges, and the rows' pointers
    void enterRows(int y)
    {
        const int upperRow = std::min(y / 2, p_.windows->rows - 1);
        entersUpperRow_ = upperRow != upperRow_ && windows_;
        if (upperRow != upperRow_)
        {
            const Window* before = windows_;
            windows_ = p_.windows->ptr<Window>(upperRow);
            upperRow_ = upperRow;
            tables_.enter(windows_, p_.smoothness->ptr(upperRow), before);
        }
        const int forward = isUpward_ ? -1 : 1, lastRow = p_.size.height - 1;
        for (int r = 0; r < groups; ++r)
        {
            const int inBlock = y + groups - 1 - r, row = std::min(inBlock, lastRow);
            const int edgeRow = std::max(std::min(row, row + forward), 0); // its edges below lead to the next row
            pixelCosts_.enterRow(r, row);
            weighScanlineEdges(p_.weights->ptr(row), p_.weights->ptr(edgeRow), tables_.edgePenalties(), width_,
                               p_.penalties.edgeNoise, edges_[r]);
            if (isUpward_ && inBlock > lastRow) // nothing comes from there
                std::memset(edges_[r], 0, 2 * (size_t)width_);
        }
    }

    //! large(p, q) of edges of a step, see weighScanlineEdges(): number `at` from the pixel left of its columns on
    template <int at> CV_ALWAYS_INLINE ByteLanes largePenalty(int step) const
    {
        const uchar* edges[groups];
        for (int r = 0; r < groups; ++r)
            edges[r] = edges_[r] + 4 * (ptrdiff_t)(step - r) - 2;
        return ByteLanes::repeatByte<at>(edges);
    }

    //! small(p) of a step
    CV_ALWAYS_INLINE ByteLanes smallPenalty(int step) const
    {
        const uchar* small[groups];
        for (int r = 0; r < groups; ++r)
            small[r] = tables_.small(step - r);
        return ByteLanes::repeatByte<0>(small);
    }

    //! L(p, d) - m of a direction; cost: C(p, d) + ScanlinePenalties::max; h: H of the pixel before, which becomes that
    //! of this one; large: to the pixel after.
    static CV_ALWAYS_INLINE ByteLanes advance(ByteLanes& h, const ByteLanes& cost, const ByteLanes& small,
                                              const ByteLanes& large)
    {
        const ByteLanes gain = h.max(h.toNext().max(h.toPrevious()) - small);
        const ByteLanes sum = cost - gain;
        const ByteLanes aboveMinimum = sum - sum.minimum();
        h = large - aboveMinimum;
        return aboveMinimum;
    }

    //! Clears the groups that are beside the image.
    ByteLanes clearOutside(const ByteLanes& h, int step, int column) const
    {
        uchar cleared[lanes];
        h.store(cleared);
        for (int r = 0; r < groups; ++r)
        {
            const int x = 2 * (step - r) + column;
            if (x < 0 || x >= width_)
                std::fill_n(cleared + r * Window::candidates, +Window::candidates, (uchar)0);
        }
        return ByteLanes::load(cleared);
    }

    //! Where the costs at a column of a step are stored; their sums follow them.
    static ptrdiff_t storedAt(int step, int column) { return ((ptrdiff_t)step * 2 + column) * 2 * lanes; }

    template <int layout> void upward(UpwardStep upwardStep, uchar* stored)
    {
        ByteLanes h = zero_, before[2] = { zero_, zero_ }, cost[2];
        for (int t = 0; t < steps_; ++t)
        {
            pixelCosts_.of<layout>(tables_, t, cost);
            const ByteLanes small = smallPenalty(t);
            ByteLanes sum[2] = { zero_, zero_ };
            if (upwardStep != STORE_COSTS)
            {
                const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
                for (int column = 0; column < 2; ++column)
                    sum[column] = fromBelow(cost[column], small, toNext[column], t, column, before[column]);
            }
            if (upwardStep == FOLLOW)
                continue;
            if (upwardStep == AGGREGATE)
            {
                const ByteLanes toRight[2] = { largePenalty<2>(t), largePenalty<4>(t) };
                h = h.permute(ByteLanes::load(tables_.intoSide(t)));
                for (int column = 0; column < 2; ++column)
                    sum[column] = sum[column] + advance(h, cost[column], small, toRight[column]);
                if (t + 1 < groups)
                    h = clearOutside(h, t, 1);
            }
            for (int column = 0; column < 2; ++column)
            {
                cost[column].store(stored + storedAt(t, column));
                sum[column].store(stored + storedAt(t, column) + lanes);
            }
        }
    }

    void aggregateDownward(const uchar* stored)
    {
        ByteLanes h = zero_, before[2] = { zero_, zero_ };
        for (int t = steps_ - 1; t >= 0; --t)
        {
            h = h.permute(ByteLanes::load(tables_.intoSide(t)));
            const ByteLanes small = smallPenalty(t);
            const ByteLanes toLeft[2] = { largePenalty<0>(t), largePenalty<2>(t) };
            const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
            for (int column = 1; column >= 0; --column)
            {
                const uchar* const costs = stored + storedAt(t, column);
                const ByteLanes cost = ByteLanes::load(costs);
                const ByteLanes fromRight = advance(h, cost, small, toLeft[column]);
                if (t + 1 >= pairs_)
                    h = clearOutside(h, t, column);
                const ByteLanes sum = ByteLanes::load(costs + lanes) + fromRight +
                                      fromAbove(cost, small, toNext[column], t, column, before[column]);
                takeWinners(sum, t, column, costs);
            }
        }
    }

    //! Where a column of a group at a step has H of the row before its block
    uchar* verticalAt(int group, int step, int column) const
    {
        return vertical_ + (2 * (ptrdiff_t)(step - group) + column) * Window::candidates;
    }

    //! The direction from below: before holds H of the last step's columns; large: to the next row
    ByteLanes fromBelow(const ByteLanes& cost, const ByteLanes& small, const ByteLanes& large, int t, int column,
                        ByteLanes& before)
    {
        before = ByteLanes::shiftInFirst(verticalAt(0, t, column), before);
        if (entersUpperRow_) // only the row that the block begins with may
            before = before.permute(ByteLanes::first(tables_.intoNext(t)));
        const ByteLanes direction = advance(before, cost, small, large);
        before.storeLast(verticalAt(groups - 1, t, column));
        return direction;
    }

    //! The same from above
    ByteLanes fromAbove(const ByteLanes& cost, const ByteLanes& small, const ByteLanes& large, int t, int column,
                        ByteLanes& before)
    {
        before = ByteLanes::shiftInLast(before, verticalAt(groups - 1, t, column));
        if (entersUpperRow_)
            before = before.permute(ByteLanes::last(tables_.intoNext(t - groups + 1)));
        const ByteLanes direction = advance(before, cost, small, large);
        before.storeFirst(verticalAt(0, t, column));
        return direction;
    }

    //! The winners' lanes, sums with those beside them, and costs
    void takeWinners(const ByteLanes& sum, int t, int column, const uchar* costs)
    {
        unsigned lane[groups];
        sum.findMinimum(lane);
        uchar sums[lanes + 4];
        sum.store(sums + 1);
        for (int r = 0; r < groups; ++r)
        {
            const int x = 2 * (t - r) + column;
            winners_[r][x] = (uchar)lane[r];
            std::memcpy(&sums_[r][x], sums + r * 16 + lane[r], sizeof(unsigned));
            costs_[r][x] = costs[r * 16 + lane[r]];
        }
    }

    //! How far to the right an unsigned is to be shifted for the byte in place i of its memory
    static int shiftOfByte(int i)
    {
        const unsigned one = 1;
        uchar first;
        std::memcpy(&first, &one, 1);
        return 8 * (first == 1 ? i : 3 - i); // a constant for the compiler
    }

    //! A row's disparities, with winnerFraction(), and residuals
    void finishRow(int group, ushort* disparity, uchar* residual) const
    {
        const float blunt = p_.blunt, sharp = p_.sharp;
        const int last = p_.validCandidates() - 1, maxDisparity = p_.maxDisparity;
        const short *firstOfLow = tables_.firstOfColumn(0), *firstOfHigh = tables_.firstOfColumn(1);
        const uchar *winners = winners_[group], *costs = costs_[group];
        const unsigned* sums = sums_[group];
        const int toBefore = shiftOfByte(0), toSum = shiftOfByte(1), toAfter = shiftOfByte(2);
        HDP_VECTORIZED for (int x = 0; x < width_; ++x)
        {
            const int lane = winners[x], low = firstOfLow[x], high = firstOfHigh[x] - Window::runLength;
            const int whole = lane + (lane < Window::runLength ? low : high);
            const int before = sums[x] >> toBefore & 255, sum = sums[x] >> toSum & 255,
                      after = sums[x] >> toAfter & 255;
            // Whether there are candidates on both sides
            const int isInner =
                ((((lane + 1) & (Window::runLength - 1)) > 1) | (low == high)) & (lane > 0) & (lane < last);
            const float slope = (float)std::max(std::max(before, after) - sum, 1);
            const float rise = (float)((before - after) & -isInner);
            const int tip = whole * subpixelScale + subpixelUnits(winnerFraction(rise, slope, blunt, sharp));
            disparity[x] = (ushort)clamped(tip, 0, maxDisparity);
        }
        HDP_VECTORIZED for (int x = 0; x < width_; ++x) residual[x] = (uchar)(costs[x] - ScanlinePenalties::max);
    }

    const ScanlineProblem& p_;
    const int width_, pairs_, steps_; // columns, pairs of them, and steps over all groups
    WindowCosts pixelCosts_;
    const ByteLanes zero_;
    // The scratch memory, from column 0 on
    uchar* const vertical_; // H of the row before the block
    uchar *winners_[groups], *costs_[groups], *edges_[groups];
    unsigned* sums_[groups];
    ScanlineWindows tables_;
    const Window* windows_; // of the block's row of the upper layer
    int upperRow_;          // that row
    bool entersUpperRow_;   // whether it is not that of the block before
    const bool isUpward_;
};

} // namespace

void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     uchar* stored, Mat& disparity, Mat& residual)
{
    const int block = ByteLanes::groups;
    const Range &rows = stripe.rows, &reach = stripe.reach;
    const auto ofBlock = [&](int y) {
        return stored + (y - reach.start) * ScanlineScratch::storedBytes(problem.size.width);
    };
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep upward(problem, true, scratch);
    int y = (reach.end + 1) / 2 * 2 - block;
    for (; y >= rows.end; y -= block)
        upward.upward(y, Sweep::FOLLOW, nullptr);
    for (; y >= rows.start; y -= block)
        upward.upward(y, Sweep::AGGREGATE, ofBlock(y));
    for (; y >= reach.start; y -= block)
        upward.upward(y, Sweep::STORE_COSTS, ofBlock(y));
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep downward(problem, false, scratch);
    for (y = reach.start; y < rows.start; y += block)
        downward.follow(y, ofBlock(y));
    for (; y < rows.end; y += block)
        downward.downward(y, rows.end, ofBlock(y), disparity, residual);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
