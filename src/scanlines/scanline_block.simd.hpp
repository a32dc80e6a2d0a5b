// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "scanline_aggregation.hpp"
#include "scanline_windows.simd.hpp"
#include "winner_fraction.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

// Grey levels, four of which count as a bit: larger differences are other light or another surface
const int maxContrast = 23;

//! C(p, d) of aggregateScanlines() for the pixels of a block of rows, as a Sweep enters them
class WindowCosts
{
public:
    WindowCosts(const CensusCost& cost, int width)
        : cost_(cost), planeStride_(cost.planeStride()), lastColumn_(width - 1), areLimited_(!cost.limits().isEmpty())
    {
    }

    //! The row of a group
    void enterRow(int group, int row)
    {
        left_[group] = cost_.leftPixels(row);
        right_[group] = cost_.rightPlane(0, row) + lastColumn_;
        if (!areLimited_)
            return;
        leftLimits_[group] = cost_.limits().left(row);
        rightLimits_[group] = cost_.limits().right(row) + lastColumn_;
    }

    //! Those of the candidates at both columns of a step, and ScanlinePenalties::max
    template <int planes> CV_ALWAYS_INLINE void of(const ScanlineWindows& windows, int step, ByteLanes (&cost)[2]) const
    {
        const uchar* left[groups];
        OneRun low;
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = left_[r] + 4 * x;
            low.first[r] = right_[r] - x + windows.first(0, step - r);
        }
        if (windows.isContiguous(step))
        {
            cost[0] = costs<planes, 0>(left, low);
            cost[1] = costs<planes, 1>(left, low);
        }
        else
        {
            TwoRuns both;
            for (int r = 0; r < groups; ++r)
            {
                both.low[r] = low.first[r];
                both.high[r] = right_[r] - 2 * (ptrdiff_t)(step - r) + windows.first(1, step - r);
            }
            cost[0] = costs<planes, 0>(left, both);
            cost[1] = costs<planes, 1>(left, both);
        }
        if (areLimited_)
            limit(windows, step, cost);
        const ByteLanes prior = ByteLanes::load(windows.prior(step));
        cost[0] = prior + cost[0];
        cost[1] = prior + cost[1];
    }

private:
    static const int groups = ByteLanes::groups;

    //! Where the candidates of the groups begin, and those at an offset from there
    struct OneRun
    {
        const uchar* first[groups];
        CV_ALWAYS_INLINE ByteLanes at(ptrdiff_t offset) const { return ByteLanes::load(first, offset); }
    };
    struct TwoRuns
    {
        const uchar *low[groups], *high[groups];
        CV_ALWAYS_INLINE ByteLanes at(ptrdiff_t offset) const { return ByteLanes::loadHalves(low, high, offset); }
    };

    //! Limits the costs at both columns of a step, see CostLimits.
    CV_ALWAYS_INLINE void limit(const ScanlineWindows& windows, int step, ByteLanes (&cost)[2]) const
    {
        const uchar *left[groups], *low[groups], *high[groups];
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = leftLimits_[r] + x;
            low[r] = rightLimits_[r] - x + windows.first(0, step - r);
            high[r] = rightLimits_[r] - x + windows.first(1, step - r);
        }
        cost[0] = cost[0].min(ByteLanes::repeatByte<0>(left)).min(ByteLanes::loadHalves(low, high, 0));
        cost[1] = cost[1].min(ByteLanes::repeatByte<1>(left)).min(ByteLanes::loadHalves(low, high, -1));
    }

    //! At one column, but for the prior; right: a OneRun or TwoRuns
    template <int planes, int column, class Runs>
    CV_ALWAYS_INLINE ByteLanes costs(const uchar* const (&left)[groups], const Runs& right) const
    {
        const int at = 4 * column;
        const ptrdiff_t plane = (ptrdiff_t)planeStride_;
        const ByteLanes grey = ByteLanes::repeatByte<at + CensusCost::greyByte>(left);
        const ByteLanes difference = grey.difference(right.at(planes * plane - column));
        const ByteLanes contrast = difference.min(ByteLanes::repeat(maxContrast)).shiftedRight<2>();
        const ByteLanes first = ByteLanes::repeatByte<at>(left) ^ right.at(-column);
        if (planes == 1)
            return contrast + first.countBits();
        const ByteLanes second = ByteLanes::repeatByte<at + 1>(left) ^ right.at(plane - column);
        if (planes == 2)
            return contrast + first.countBits() + second.countBits();
        const ByteLanes third = ByteLanes::repeatByte<at + 2>(left) ^ right.at(2 * plane - column);
        return contrast + ByteLanes::countBits(first, second, third);
    }

    const CensusCost& cost_;
    const size_t planeStride_; // from a plane of the cost to the next
    const int lastColumn_;
    const bool areLimited_; // by pixels without data
    const uchar *left_[groups], *right_[groups], *leftLimits_[groups], *rightLimits_[groups];
};

/** A block of ByteLanes::groups rows in a sweep. With the notation of aggregateScanlines(), and m the minimum of
L(q, k) over k, a direction carries what a candidate saves against the large penalty, instead of its cost:

H(q, d) = max(m + large(p, q) - L(q, d), 0), which is also right, 0, for candidates that q does not have.
As min(x, m + large(p, q)) = m + large(p, q) - max(m + large(p, q) - x, 0) for any x,
min(L(q, d), L(q, d - 1) + small, L(q, d + 1) + small, m + large(p, q)) - m = large(p, q) - gain(d) with
gain(d) = max(H(q, d), H(q, d - 1) - small, H(q, d + 1) - small, 0).
Only differences between the candidates of a pixel count, so the largest penalty, K, may stand for large(p, q) here:
L(p, d) = (C(p, d) + K) - gain(d), and with its minimum m' over the candidates of p and the pixel r after it
H(p, d) = max(large(p, r) - (L(p, d) - m'), 0).

All of these are bytes, and the differences saturate at 0 by themselves. What aggregateScanlines() says, step by step,
is oracle::Scanlines of test/oracles.hpp; the two are compared.

The rows are skewed, the lowest one in the first group: when that one is at column x, group r is at column x - 2 r.
Upward, from the left to the right, group r finds what the group before left there a step ago; downward, from the right
to the left, what the group behind did. All groups enter a pixel of the layer above, which is two columns wide, at the
same step: a step is a pair of columns, for group r those of pixel t - r of the layer above. Groups that are beside the
image compute what nobody reads: all that is stored by column has a margin. */
class ScanlineBlock
{
public:
    typedef CandidateWindow Window;
    static const int groups = ByteLanes::groups;

    //! What the directions carry from step to step: H of the pixel beside, and of the columns of the row before
    struct Carried
    {
        ByteLanes side, before[2];
        Carried() : side(ByteLanes::repeat(0)), before{ side, side } {}
    };

    static int countSteps(int width) { return (width + 1) / 2 + groups - 1; }

    //! vertical: H of the row before the block, from column 0 on
    ScanlineBlock(const ScanlineProblem& problem, bool isUpward, uchar* vertical, ScanlineScratch::Block& scratch)
        : p_(problem), width_(problem.size.width), pairs_((width_ + 1) / 2), costs_(*problem.cost, width_),
          vertical_(vertical), tables_(nullptr), small_(nullptr), intoSide_(nullptr), intoNext_(nullptr),
          changesWindows_(false), isUpward_(isUpward)
    {
        for (int r = 0; r < groups; ++r)
        {
            const size_t row = r * (2 * (size_t)pairs_ + 2 * margin) + margin;
            winners_[r] = scratch.winners.data() + row;
            before_[r] = scratch.winnerSums[0].data() + row;
            sums_[r] = scratch.winnerSums[1].data() + row;
            after_[r] = scratch.winnerSums[2].data() + row;
            winnerCosts_[r] = scratch.winnerCosts.data() + row;
            edges_[r] = scratch.edges.data() + 2 * row;
        }
    }

    /** Enters a block of rows.
    @param y The upper one of them. Those below the image repeat its last row.
    @param tables Of the row of windows that the block lies in.
    @param changesWindows Whether the block entered before lies in another one, so candidates have to be permuted. */
    void enter(int y, const ScanlineWindows& tables, bool changesWindows)
    {
        tables_ = &tables;
        small_ = tables.small();
        intoSide_ = tables.intoSide();
        intoNext_ = tables.intoNext();
        changesWindows_ = changesWindows;
        const int forward = isUpward_ ? -1 : 1, lastRow = p_.size.height - 1;
        for (int r = 0; r < groups; ++r)
        {
            const int inBlock = y + groups - 1 - r, row = std::min(inBlock, lastRow);
            const int edgeRow = std::max(std::min(row, row + forward), 0); // its edges below lead to the next row
            costs_.enterRow(r, row);
            tables.edgePenalties(p_.weights->ptr(row), p_.weights->ptr(edgeRow), edges_[r]);
            if (isUpward_ && inBlock > lastRow) // with large penalties of 0, nothing comes from there
                std::memset(edges_[r], 0, 2 * (size_t)width_);
        }
    }

    //! Stores the costs of steps.
    void storeCosts(const Range& steps, uchar* stored) const
    {
        const int planes = p_.cost->planes();
        const auto store = planes == 3   ? &ScanlineBlock::storeCosts<3>
                           : planes == 2 ? &ScanlineBlock::storeCosts<2>
                                         : &ScanlineBlock::storeCosts<1>;
        (this->*store)(steps, stored);
    }

    /** A step of the direction from below or from above, and if it is to sum, of that from the left or from the right.
    Then the sum of both is stored upward, and downward the winners are taken of all four.
    @param stored Costs, and behind them sums. */
    template <bool isUpward, bool sums> CV_ALWAYS_INLINE void follow(int t, Carried& h, uchar* stored) const
    {
        const ByteLanes small = smallPenalty(t);
        const int firstToSide = isUpward ? 2 : 0;
        const ByteLanes toSide[2] = { largePenalty<firstToSide>(t), largePenalty<firstToSide + 2>(t) };
        const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
        if (sums)
            h.side = h.side.permute(ByteLanes::load(ScanlineWindows::ofStep(intoSide_, t)));
        const int first = isUpward ? 0 : 1, second = 1 - first; // columns, known to the compiler
        followColumn<isUpward, sums, first>(t, small, toSide[first], toNext[first], h, stored);
        followColumn<isUpward, sums, second>(t, small, toSide[second], toNext[second], h, stored);
    }

    //! Disparities and residuals of the winners; rows from y on, of which those before end count
    void finish(int y, int end, Mat& disparity, Mat& residual) const
    {
        for (int r = 0; r < groups; ++r)
        {
            const int row = y + groups - 1 - r;
            if (row < end)
                finishRow(r, disparity.ptr<ushort>(row), residual.ptr(row));
        }
    }

private:
    static const int lanes = groups * Window::candidates;
    static const int margin = ScanlineScratch::margin;
    static_assert(groups <= (int)ScanlineScratch::maxRows, "the scratch memory is for larger blocks");

    template <int planes> void storeCosts(const Range& steps, uchar* stored) const
    {
        for (int t = steps.start; t < steps.end; ++t)
        {
            ByteLanes cost[2];
            costs_.of<planes>(*tables_, t, cost);
            for (int column = 0; column < 2; ++column)
                cost[column].store(stored + storedAt(t, column));
        }
    }

    //! large(p, q) of a step's edges, see ScanlineWindows::edgePenalties(): number `at` from the pixel left of them on
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
            small[r] = small_ + (step - r);
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

    //! Where a column of a group at a step has H of the row before its block
    CV_ALWAYS_INLINE uchar* verticalAt(int group, int step, int column) const
    {
        return vertical_ + (2 * (ptrdiff_t)(step - group) + column) * Window::candidates;
    }

    //! The direction from the row before, below or above. before: H of the last step's columns, of which a group takes
    //! that of the group before it, in this row then; the first one of these takes it from memory, and only that may
    //! enter another row of windows. The last one leaves its own there. large: to the next row
    template <bool isUpward>
    CV_ALWAYS_INLINE ByteLanes followRows(const ByteLanes& cost, const ByteLanes& small, const ByteLanes& large, int t,
                                          int column, ByteLanes& before) const
    {
        uchar *const lowest = verticalAt(0, t, column), *const highest = verticalAt(groups - 1, t, column);
        before = isUpward ? ByteLanes::shiftInFirst(lowest, before) : ByteLanes::shiftInLast(before, highest);
        if (changesWindows_)
            before =
                before.permute(isUpward ? ByteLanes::orderOfFirst(ScanlineWindows::ofStep(intoNext_, t))
                                        : ByteLanes::orderOfLast(ScanlineWindows::ofStep(intoNext_, t - groups + 1)));
        const ByteLanes direction = advance(before, cost, small, large);
        if (isUpward)
            before.storeLast(highest);
        else
            before.storeFirst(lowest);
        return direction;
    }

    template <bool isUpward, bool sums, int column>
    CV_ALWAYS_INLINE void followColumn(int t, const ByteLanes& small, const ByteLanes& toSide, const ByteLanes& toNext,
                                       Carried& h, uchar* stored) const
    {
        uchar* const costs = stored + storedAt(t, column);
        const ByteLanes cost = ByteLanes::load(costs);
        const ByteLanes vertical = followRows<isUpward>(cost, small, toNext, t, column, h.before[column]);
        if (!sums)
            return;
        const ByteLanes sum = vertical + advance(h.side, cost, small, toSide);
        if (isUpward ? (t + 1 < groups && column == 1) : t + 1 >= pairs_)
            h.side = clearOutside(h.side, t, column);
        if (isUpward)
            sum.store(costs + lanes);
        else
            takeWinners(ByteLanes::load(costs + lanes) + sum, t, column, costs);
    }

    //! The winners' lanes, sums with those beside them, and costs
    CV_ALWAYS_INLINE void takeWinners(const ByteLanes& sum, int t, int column, const uchar* costs) const
    {
        unsigned lane[groups];
        sum.findMinimum(lane);
        uchar sums[lanes + 2]; // the first and the last one of any value
        sum.store(sums + 1);
        for (int r = 0; r < groups; ++r)
        {
            const int x = 2 * (t - r) + column;
            winners_[r][x] = (uchar)lane[r];
            const int winner = r * Window::candidates + lane[r];
            before_[r][x] = sums[winner];
            sums_[r][x] = sums[winner + 1];
            after_[r][x] = sums[winner + 2];
            winnerCosts_[r][x] = costs[winner];
        }
    }

    //! Writes the disparities, with winnerFraction(), and residuals of a group's row. costs are above the residuals by
    //! ScanlinePenalties::max.
    void finishRow(int group, ushort* disparity, uchar* residual) const
    {
        const float blunt = p_.blunt, sharp = p_.sharp;
        const int last = p_.validCandidates() - 1, maxDisparity = p_.maxDisparity;
        const short *firstOfLow = tables_->firstOfColumn(0), *firstOfHigh = tables_->firstOfColumn(1);
        const uchar *winners = winners_[group], *costs = winnerCosts_[group];
        const uchar *const befores = before_[group], *const sums = sums_[group], *const afters = after_[group];
        HDP_VECTORIZED for (int x = 0; x < width_; ++x)
        {
            const int lane = winners[x], low = firstOfLow[x], high = firstOfHigh[x] - Window::runLength;
            const int whole = lane + (lane < Window::runLength ? low : high);
            const int before = befores[x], sum = sums[x], after = afters[x];
            // Whether there are candidates on both sides: the lane is not at the end of a run, or the runs are one
            const int isInner =
                ((((lane + 1) & (Window::runLength - 1)) > 1) | (low == high)) & (lane > 0) & (lane < last);
            const float slope = (float)std::max(std::max(before, after) - sum, 1);
            const float rise = (float)((before - after) & -isInner);
            const int subpixel = whole * subpixelScale + subpixelUnits(winnerFraction(rise, slope, blunt, sharp));
            disparity[x] = (ushort)clamped(subpixel, 0, maxDisparity);
        }
        HDP_VECTORIZED for (int x = 0; x < width_; ++x) residual[x] = (uchar)(costs[x] - ScanlinePenalties::max);
    }

    const ScanlineProblem& p_;
    const int width_, pairs_; // columns, and pairs of them
    WindowCosts costs_;
    // The scratch memory, from column 0 on
    uchar* const vertical_;
    uchar *winners_[groups], *winnerCosts_[groups], *before_[groups], *sums_[groups], *after_[groups], *edges_[groups];
    const ScanlineWindows* tables_;
    const uchar *small_, *intoSide_, *intoNext_; // of the first step
    bool changesWindows_;                        // whether tables_ are not those of the block before
    const bool isUpward_;
};

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
