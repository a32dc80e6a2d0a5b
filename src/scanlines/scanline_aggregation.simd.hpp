// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "scanline_aggregation.hpp"
#include "../base/grey_levels.hpp"
#include "../base/vectorized.hpp"
#include "winner_fraction.hpp"
#include <cstring>
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#include "scanline_windows.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Aggregates a stripe of the image.
@param problem The layer.
@param stripe Its rows.
@param scratch Memory to work in.
@param followed The same, ScanlineScratch::followedBytes() for each row.
@param disparity As in aggregateScanlines().
@param residual As in aggregateScanlines(). */
void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     uchar* followed, Mat& disparity, Mat& residual);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef CandidateWindow Window;

/** A sweep over a stripe. With the notation of aggregateScanlines(), and m the minimum of L(q, k) over k, a direction
carries what a candidate saves against the large penalty, instead of its cost:

H(q, d) = max(m + large(p, q) - L(q, d), 0), which is also right, 0, for candidates that q does not have.
As min(x, m + large(p, q)) = m + large(p, q) - max(m + large(p, q) - x, 0) for any x,
min(L(q, d), L(q, d - 1) + small, L(q, d + 1) + small, m + large(p, q)) - m = large(p, q) - gain(d) with
gain(d) = max(H(q, d), H(q, d - 1) - small, H(q, d + 1) - small, 0).
Only differences between the candidates of a pixel count, so large may stand for large(p, q) here:
L(p, d) = (C(p, d) + large) - gain(d), and with its minimum m' over the candidates of p and the pixel r after it
H(p, d) = max(large(p, r) - (L(p, d) - m'), 0).

All of these are bytes, and the differences saturate at 0 by themselves. What aggregateScanlines() says, step by step,
is oracle::Scanlines of test/oracles.hpp; the two are compared.

Rows are done in blocks of ByteLanes::groups, skewed: when group r is at column x of the block's row r, group r + 1 is
at column x - 2 of the next row. So it finds what the group before left there a step ago, and all groups enter a
pixel of the layer above, which is two columns wide, at the same step. A step is a pair of columns, for group r those of
pixel t - r of the layer above. Groups that are beside the image compute what nobody reads: all that is stored by column
has a margin. The direction from below is that from above of a sweep upward, which has the lower row of a block in its
first group. */
class Sweep
{
public:
    Sweep(const ScanlineProblem& problem, bool isUpward, ScanlineScratch& scratch)
        : p_(problem), methods_(methodsOf(*problem.cost)), width_(problem.size.width), pairs_((width_ + 1) / 2),
          steps_(pairs_ + groups - 1), planeStride_(problem.cost->planeStride()),
          small_(ByteLanes::repeat(problem.penalties.small)), zero_(ByteLanes::repeat(0)),
          blockCosts_(aligned(scratch.costs)), fromRight_(aligned(scratch.fromRight)),
          fromAbove_(aligned(scratch.fromAbove) + margin * Window::candidates), tables_(problem, groups, scratch),
          windows_(0), upperRow_(-1), entersUpperRow_(false), isUpward_(isUpward)
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

    //! The vertical direction alone, over a block of rows from y on; followed: where to store it, if it is needed
    void follow(int y, uchar* followed)
    {
        enterRows(y, true);
        (this->*methods_.follow)(followed);
    }

    //! All directions and the winners of a block of rows, y to end - 1 at most; fromBelow: what a sweep upward has
    //! stored
    void run(int y, int end, const uchar* fromBelow, Mat& disparity, Mat& residual)
    {
        enterRows(y, false);
        (this->*methods_.fromRight)();
        fromLeftAndAbove(fromBelow);
        for (int r = 0; r < groups && y + r < end; ++r)
            finishRow(r, disparity.ptr<ushort>(y + r), residual.ptr(y + r));
    }

private:
    enum
    {
        groups = ByteLanes::groups,
        lanes = groups * Window::candidates,
        margin = ScanlineScratch::margin,
        hasLimits = 4 // a layout of the costs: the number of planes, and this if they are limited
    };
    static_assert(groups <= (int)ScanlineScratch::maxBlock, "the scratch memory is for larger blocks");

    static uchar* aligned(std::vector<uchar>& stored) { return alignPtr(stored.data(), ScanlineScratch::alignment); }

    //! Those for a layout of the costs
    struct Methods
    {
        void (Sweep::*fromRight)();
        void (Sweep::*follow)(uchar*);
    };
    template <int layout> static Methods methodsOf()
    {
        return { &Sweep::fromRight<layout>, &Sweep::followBlock<layout> };
    }
    static Methods methodsOf(const CensusCost& cost)
    {
        const int planes = cost.planes();
        if (cost.limits().isEmpty())
            return planes == 1 ? methodsOf<1>() : planes == 2 ? methodsOf<2>() : methodsOf<3>();
        return planes == 1   ? methodsOf<hasLimits + 1>()
               : planes == 2 ? methodsOf<hasLimits + 2>()
                             : methodsOf<hasLimits + 3>();
    }

    //! Prepares a block of rows, y in the first group: what follows from the windows, if they are new, from the grey
    //! levels, and the rows' pointers. isFollowed: for the vertical direction alone
    void enterRows(int y, bool isFollowed)
    {
        const int upperRow = std::min(y / 2, p_.windows->rows - 1);
        entersUpperRow_ = upperRow != upperRow_ && windows_;
        if (upperRow != upperRow_)
        {
            const Window* above = windows_;
            windows_ = p_.windows->ptr<Window>(upperRow);
            upperRow_ = upperRow;
            tables_.enter(windows_, above, isFollowed);
        }
        const int forward = isUpward_ ? -1 : 1, lastRow = p_.size.height - 1;
        for (int r = 0; r < groups; ++r)
        {
            const int row = std::min(y + r * forward, lastRow), next = clamped(row + forward, 0, lastRow);
            left_[r] = p_.cost->leftPixels(row);
            right_[r] = p_.cost->rightPlane(0, row) + width_ - 1;
            if (!p_.cost->limits().isEmpty())
            {
                leftLimits_[r] = p_.cost->limits().left(row);
                rightLimits_[r] = p_.cost->limits().right(row) + width_ - 1;
            }
            weighScanlineEdges(p_.left->ptr<ushort>(row), p_.left->ptr<ushort>(next), width_, p_.penalties, edges_[r]);
            if (isUpward_ && y - r > lastRow) // nothing comes from there
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

    //! The candidates' costs C(p, d) + large at both columns of a step
    template <int layout> CV_ALWAYS_INLINE void costs(int step, ByteLanes (&cost)[2]) const
    {
        const int planes = layout & (hasLimits - 1);
        const uchar *left[groups], *low[groups];
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = left_[r] + 4 * x;
            low[r] = right_[r] - x + tables_.first(0, step - r);
        }
        const ByteLanes prior = ByteLanes::load(tables_.prior(step));
        if (tables_.isContiguous(step))
        {
            const auto load = [&](ptrdiff_t offset) { return ByteLanes::load(low, offset); };
            cost[0] = costs<planes, 0>(left, load);
            cost[1] = costs<planes, 1>(left, load);
        }
        else
        {
            const uchar* high[groups];
            for (int r = 0; r < groups; ++r)
                high[r] = right_[r] - 2 * (ptrdiff_t)(step - r) + tables_.first(1, step - r);
            const auto load = [&](ptrdiff_t offset) { return ByteLanes::loadHalves(low, high, offset); };
            cost[0] = costs<planes, 0>(left, load);
            cost[1] = costs<planes, 1>(left, load);
        }
        if (layout & hasLimits)
            limit(step, cost);
        cost[0] = prior + cost[0];
        cost[1] = prior + cost[1];
    }

    //! Limits the costs at both columns of a step, see CostLimits.
    CV_ALWAYS_INLINE void limit(int step, ByteLanes (&cost)[2]) const
    {
        const uchar *left[groups], *low[groups], *high[groups];
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = leftLimits_[r] + x;
            low[r] = rightLimits_[r] - x + tables_.first(0, step - r);
            high[r] = rightLimits_[r] - x + tables_.first(1, step - r);
        }
        cost[0] = cost[0].min(ByteLanes::repeatByte<0>(left)).min(ByteLanes::loadHalves(low, high, 0));
        cost[1] = cost[1].min(ByteLanes::repeatByte<1>(left)).min(ByteLanes::loadHalves(low, high, -1));
    }

    //! At one column, but for the prior; load: gives the candidates of a plane.
    template <int planes, int column, class Load>
    CV_ALWAYS_INLINE ByteLanes costs(const uchar* const (&left)[groups], const Load& load) const
    {
        const int at = 4 * column;
        const auto ofPlane = [&](int plane) { return load((ptrdiff_t)(plane * planeStride_) - column); };
        const ByteLanes grey = ByteLanes::repeatByte<at + CensusCost::greyByte>(left), candidates = ofPlane(planes);
        const ByteLanes contrast = grey.difference(candidates).min(ByteLanes::repeat(ScanlineContrast::max)).quarter();
        const ByteLanes first = ByteLanes::repeatByte<at>(left) ^ ofPlane(0);
        if (planes == 1)
            return contrast + first.countBits();
        const ByteLanes second = ByteLanes::repeatByte<at + 1>(left) ^ ofPlane(1);
        if (planes == 2)
            return contrast + first.countBits() + second.countBits();
        const ByteLanes third = ByteLanes::repeatByte<at + 2>(left) ^ ofPlane(2);
        // Sum and carry of three bits: two counts instead of three
        const ByteLanes difference = first ^ second;
        const ByteLanes carries = ((first & second) | (difference & third)).countBits();
        return contrast + (difference ^ third).countBits() + (carries + carries);
    }

    //! L(p, d) - m of a direction; cost: C(p, d) + large; h: H of the pixel before, which becomes that of this one;
    //! large: to the pixel after.
    ByteLanes advance(ByteLanes& h, const ByteLanes& cost, const ByteLanes& large) const
    {
        const ByteLanes gain = h.max(h.toNext().max(h.toPrevious()) - small_);
        const ByteLanes sum = cost - gain;
        const ByteLanes aboveMinimum = sum - sum.minimum();
        h = large - aboveMinimum;
        return aboveMinimum;
    }

    //! Clears the groups that are beside the image.
    ByteLanes clearOutside(const ByteLanes& h, int step, int column) const
    {
        static const uchar inside[16] = {
            255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255
        };
        static const uchar outside[16] = { 0 };
        const uchar* mask[groups];
        for (int r = 0; r < groups; ++r)
        {
            const int x = 2 * (step - r) + column;
            mask[r] = x >= 0 && x < width_ ? inside : outside;
        }
        return h & ByteLanes::load(mask, 0);
    }

    template <int layout> void fromRight()
    {
        ByteLanes h = zero_, cost[2];
        for (int t = steps_ - 1; t >= 0; --t)
        {
            costs<layout>(t, cost);
            uchar* costs = blockCosts_ + (size_t)t * 2 * lanes;
            uchar* directions = fromRight_ + (size_t)t * 2 * lanes;
            h = h.permute(ByteLanes::load(tables_.intoLeft(t)));
            const ByteLanes large[2] = { largePenalty<0>(t), largePenalty<2>(t) };
            for (int column = 1; column >= 0; --column)
            {
                const ByteLanes direction = advance(h, cost[column], large[column]);
                if (t + 1 >= pairs_)
                    h = clearOutside(h, t, column);
                cost[column].store(costs + column * lanes);
                direction.store(directions + column * lanes);
            }
        }
    }

    //! The direction from above: before holds H of the last step's columns; large: to the next row
    ByteLanes fromAbove(const ByteLanes& cost, const ByteLanes& large, int t, int column, ByteLanes& before)
    {
        uchar* above = fromAbove_ + (ptrdiff_t)(2 * t + column) * Window::candidates;
        ByteLanes h = ByteLanes::shiftIn(above, before);
        if (entersUpperRow_) // only the block's first row may
            h = h.permute(ByteLanes::first(tables_.intoBelow(t)));
        const ByteLanes direction = advance(h, cost, large);
        before = h;
        h.storeLast(above - 2 * (groups - 1) * Window::candidates);
        return direction;
    }

    //! Where a direction at a column of a step is stored; there is room for a step more at both ends.
    static ptrdiff_t storedAt(int step, int column) { return ((ptrdiff_t)(step + 1) * 2 + column) * lanes; }

    template <int layout> void followBlock(uchar* followed)
    {
        ByteLanes before[2] = { zero_, zero_ }, cost[2];
        for (int t = 0; t < steps_; ++t)
        {
            costs<layout>(t, cost);
            const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
            for (int column = 0; column < 2; ++column)
            {
                const ByteLanes direction = fromAbove(cost[column], toNext[column], t, column, before[column]);
                if (followed)
                    direction.store(followed + storedAt(t, column));
            }
        }
    }

    void fromLeftAndAbove(const uchar* fromBelow)
    {
        ByteLanes h = zero_, before[2] = { zero_, zero_ };
        for (int t = 0; t < steps_; ++t)
        {
            const uchar* costs = blockCosts_ + (size_t)t * 2 * lanes;
            const uchar* directions = fromRight_ + (size_t)t * 2 * lanes;
            h = h.permute(ByteLanes::load(tables_.intoRight(t)));
            const ByteLanes toRight[2] = { largePenalty<2>(t), largePenalty<4>(t) };
            const ByteLanes toNext[2] = { largePenalty<3>(t), largePenalty<5>(t) };
            for (int column = 0; column < 2; ++column)
            {
                const ByteLanes cost = ByteLanes::load(costs + column * lanes);
                const ByteLanes fromLeft = advance(h, cost, toRight[column]);
                const ByteLanes sum = fromLeft + ByteLanes::load(directions + column * lanes) +
                                      fromAbove(cost, toNext[column], t, column, before[column]) +
                                      loadFromBelow(fromBelow, t, column);
                takeWinners(sum, t, column, costs + column * lanes);
            }
            if (t + 1 < groups)
                h = clearOutside(h, t, 1);
        }
    }

    //! In a sweep upward, group groups - 1 - r has had the row of group r.
    static ByteLanes loadFromBelow(const uchar* fromBelow, int t, int column)
    {
        const uchar* of[groups];
        for (int r = 0; r < groups; ++r)
        {
            const int other = groups - 1 - r;
            of[r] = fromBelow + storedAt(t - r + other, column) + other * Window::candidates;
        }
        return ByteLanes::load(of, 0);
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
        const float blunt = p_.shape.blunt, sharp = p_.shape.sharp;
        const int last = p_.validCandidates() - 1, large = p_.penalties.large, maxDisparity = p_.maxDisparity;
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
        HDP_VECTORIZED for (int x = 0; x < width_; ++x) residual[x] = (uchar)(costs[x] - large);
    }

    const ScanlineProblem& p_;
    const Methods methods_;
    const int width_, pairs_, steps_; // columns, pairs of them, and steps over all groups
    const size_t planeStride_;        // from a plane of the cost to the next
    const ByteLanes small_, zero_;
    // The scratch memory, from column or step 0 on
    uchar *const blockCosts_, *const fromRight_, *const fromAbove_;
    uchar *winners_[groups], *costs_[groups], *edges_[groups];
    unsigned* sums_[groups];
    ScanlineWindows tables_;
    const Window* windows_; // of the block's row of the upper layer
    int upperRow_;          // that row
    bool entersUpperRow_;   // whether it is not that of the block before
    const bool isUpward_;
    const uchar *left_[groups], *right_[groups], *leftLimits_[groups], *rightLimits_[groups];
};

} // namespace

void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     uchar* followed, Mat& disparity, Mat& residual)
{
    const int block = ByteLanes::groups;
    const Range &rows = stripe.rows, &reach = stripe.reach;
    const auto ofBlock = [&](int y) {
        return followed + (y - rows.start) * ScanlineScratch::followedBytes(problem.size.width);
    };
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep upward(problem, true, scratch);
    for (int y = (reach.end + 1) / 2 * 2 - block; y >= rows.start; y -= block)
        upward.follow(y + block - 1, y < rows.end ? ofBlock(y) : nullptr);
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep downward(problem, false, scratch);
    for (int y = reach.start; y < rows.start; y += block)
        downward.follow(y, nullptr);
    for (int y = rows.start; y < rows.end; y += block)
        downward.run(y, rows.end, ofBlock(y), disparity, residual);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
