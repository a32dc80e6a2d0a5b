// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "scanline_aggregation.hpp"
#include "vectorized.hpp"
#include <cstring>

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Aggregates a stripe of the image.
@param problem The layer.
@param above First row of the direction from above, even.
@param rows Rows of the result, from an even one on.
@param scratch Memory to work in.
@param disparity As in aggregateScanlines().
@param residual As in aggregateScanlines(). */
void aggregateStripe(const ScanlineProblem& problem, int above, const Range& rows, ScanlineScratch& scratch,
                     Mat& disparity, Mat& residual);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef CandidateWindow Window;

#include "byte_lanes.simd.hpp"

/** A sweep over a stripe. Rows are done in blocks of ByteLanes::groups, skewed: when group r is at column x of the
block's row r, group r + 1 is at column x - 2 of the next row, so that it finds what the group before left there two steps
ago, and all groups enter a pixel of the layer above, which is two columns wide, at the same step.

Instead of the costs L(q, d) of the pixel before, a direction carries H(q, d) = max(m + large - L(q, d), 0): 0 stands for
a candidate that q does not have as well as for one not worth to come from.

A step is a pair of columns, those of pixel T - r of the layer above for group r. Groups that are beside the image compute
what nobody reads: all that is stored by column has a margin. */
class Sweep
{
public:
    Sweep(const ScanlineProblem& problem, ScanlineScratch& scratch)
        : p_(problem), s_(scratch), width_(problem.size.width), pairs_((width_ + 1) / 2), steps_(pairs_ + groups - 1),
          leftStride_(problem.cost->planeStride(false)), rightStride_(problem.cost->planeStride(true)),
          small_(ByteLanes::repeat(problem.penalties.small)), large_(ByteLanes::repeat(problem.penalties.large)),
          zero_(ByteLanes::repeat(0)), windows_(0), upperRow_(-1), entersUpperRow_(false)
    {
        const size_t columns = (size_t)width_ + 2 * margin + 1, upperColumns = (size_t)pairs_ + 2 * margin;
        s_.costs.resize((size_t)steps_ * 2 * lanes);
        s_.fromRight.resize((size_t)steps_ * 2 * lanes);
        s_.fromAbove.assign(columns * Window::candidates, 0);
        s_.columns.assign(upperColumns, Column()); // also the margins' addresses are valid
        s_.priors.resize(upperColumns * Window::candidates);
        s_.intoRight.resize(upperColumns * Window::candidates);
        s_.intoLeft.resize(upperColumns * Window::candidates);
        s_.intoBelow.resize(upperColumns * Window::candidates);
        s_.disparities.resize(groups * columns);
        s_.rises.resize(groups * columns);
        s_.slopes.resize(groups * columns);
        s_.residuals.resize(groups * columns);
        for (int r = 0; r < groups; ++r)
        {
            const size_t row = r * columns + margin;
            disparities_[r] = &s_.disparities[row];
            rises_[r] = &s_.rises[row];
            slopes_[r] = &s_.slopes[row];
            residuals_[r] = &s_.residuals[row];
        }
        preparePriorTable();
        prepareOrderTables();
    }

    //! The direction from above alone, over a block of rows from y on.
    void warmUp(int y)
    {
        enterRows(y);
        dispatchPlanes([&](std::integral_constant<int, 1>) { warmUpBlock<1>(); },
                       [&](std::integral_constant<int, 2>) { warmUpBlock<2>(); },
                       [&](std::integral_constant<int, 3>) { warmUpBlock<3>(); });
    }

    //! All directions and the winners of a block of rows, y to end - 1 at most.
    void run(int y, int end, Mat& disparity, Mat& residual)
    {
        enterRows(y);
        dispatchPlanes([&](std::integral_constant<int, 1>) { fromRight<1>(); },
                       [&](std::integral_constant<int, 2>) { fromRight<2>(); },
                       [&](std::integral_constant<int, 3>) { fromRight<3>(); });
        fromLeftAndAbove();
        for (int r = 0; r < groups && y + r < end; ++r)
        {
            addSubpixel(r, disparity.ptr<ushort>(y + r));
            std::memcpy(residual.ptr(y + r), residuals_[r], width_);
        }
    }

private:
    enum
    {
        groups = ByteLanes::groups,
        lanes = groups * 16,
        margin = 2 * groups
    };
    typedef ScanlineScratch::Column Column;

    template <class One, class Two, class Three>
    void dispatchPlanes(const One& one, const Two& two, const Three& three) const
    {
        if (p_.cost->planes() == 1)
            one(std::integral_constant<int, 1>());
        else if (p_.cost->planes() == 2)
            two(std::integral_constant<int, 2>());
        else
            three(std::integral_constant<int, 3>());
    }

    //! The prior of a run, or of two runs that follow one another, by the distance of its first candidate from the
    //! predicted disparity
    void preparePriorTable()
    {
        for (int distance = -priorRange; distance < priorRange; ++distance)
            for (int i = 0; i < Window::candidates; ++i)
                priorTable_[distance + priorRange][i] =
                    (uchar)(p_.penalties.prior * std::abs(distance + i * ScanlineProblem::scale) /
                            (2 * ScanlineProblem::scale));
    }

    const uchar* priorOf(const Window& own, int run) const
    {
        const int distance = own.first[run] * ScanlineProblem::scale - own.predicted[run];
        return priorTable_[std::min(std::max(distance, -priorRange), priorRange - 1) + priorRange];
    }

    //! Which lanes have the candidates of a run, or of two that follow one another, that begins `shift` disparities
    //! after another one of the same length: 255 for those that do not exist
    void prepareOrderTables()
    {
        for (int i = 0; i < 3 * Window::candidates; ++i)
        {
            const int lane = i - Window::candidates, high = i - 2 * Window::runLength;
            pairOrder_[i] = lane >= 0 && lane < Window::candidates ? (uchar)lane : (uchar)255;
            for (int run = 0; run < Window::runs; ++run)
                runOrder_[run][i] =
                    high >= 0 && high < Window::runLength ? (uchar)(run * Window::runLength + high) : (uchar)255;
        }
    }

    static int clampShift(int shift, int length) { return std::min(std::max(shift, -length), length); }

    //! Which lanes of `from` have the candidates of `to`
    void transition(const Window& from, const Window& to, uchar* order) const
    {
        if (from.isContiguous() && to.isContiguous())
        {
            const int shift = clampShift(to.first[0] - from.first[0], Window::candidates);
            std::memcpy(order, pairOrder_ + Window::candidates + shift, Window::candidates);
            return;
        }
        for (int run = 0; run < Window::runs; ++run)
        {
            uint64 lanesOf[Window::runs];
            for (int other = 0; other < Window::runs; ++other)
            {
                const int shift = clampShift(to.first[run] - from.first[other], Window::runLength);
                std::memcpy(&lanesOf[other], runOrder_[other] + 2 * Window::runLength + shift, Window::runLength);
            }
            lanesOf[0] &= lanesOf[1]; // runs do not overlap: at least one of the two is 255
            std::memcpy(order + run * Window::runLength, &lanesOf[0], Window::runLength);
        }
    }

    //! An odd last column belongs to the pixel of the layer above that the one before belongs to.
    const Window& window(const Window* row, int x) const { return row[std::min(x, p_.windows->cols - 1)]; }

    //! Prepares a block of rows from y on: what follows from the windows, if they are new, and the rows' pointers.
    void enterRows(int y)
    {
        const int upperRow = std::min(y / 2, p_.windows->rows - 1);
        entersUpperRow_ = upperRow != upperRow_ && windows_;
        if (upperRow != upperRow_)
        {
            const Window* above = windows_;
            windows_ = p_.windows->ptr<Window>(upperRow);
            upperRow_ = upperRow;
            for (int x = 0; x < pairs_; ++x)
                enterWindow(x, above);
        }
        for (int r = 0; r < groups; ++r)
        {
            const int row = std::min(y + r, p_.size.height - 1);
            left_[r] = p_.cost->leftPlane(0, row);
            right_[r] = p_.cost->rightPlane(0, row) + width_ - 1;
        }
    }

    void enterWindow(int x, const Window* above)
    {
        const Window& own = window(windows_, x);
        const size_t at = (size_t)(x + margin) * Window::candidates;
        uchar* prior = &s_.priors[at];
        if (own.isContiguous() && own.predicted[0] == own.predicted[1])
            std::memcpy(prior, priorOf(own, 0), Window::candidates);
        else
            for (int run = 0; run < Window::runs; ++run)
                std::memcpy(prior + run * Window::runLength, priorOf(own, run), Window::runLength);
        // Lanes that have candidates on both sides
        const int last = std::min<int>(Window::candidates, p_.numDisparities) - 1;
        const int inner = (own.isContiguous() ? 0x7ffe : 0x7e7e) & ((1 << last) - 1);
        for (int i = last + 1; i < Window::candidates; ++i)
            prior[i] = 255;
        const Column column = { { own.first[0], own.first[1] }, (ushort)inner };
        s_.columns[x + margin] = column;
        transition(window(windows_, std::max(x - 1, 0)), own, &s_.intoRight[at]);
        transition(window(windows_, x + 1), own, &s_.intoLeft[at]);
        if (above)
            transition(window(above, x), own, &s_.intoBelow[at]);
    }

    //! What is stored for each pixel of the layer above, of the pixels that a step is at
    ByteLanes ofStep(const std::vector<uchar>& stored, int step) const
    {
        const uchar* bytes[groups];
        for (int r = 0; r < groups; ++r)
            bytes[r] = &stored[0] + (ptrdiff_t)(step - r + margin) * Window::candidates;
        return ByteLanes::load(bytes);
    }

    //! The candidates' costs C(p, d) at both columns of a step
    template <int planes> void costs(int step, ByteLanes (&cost)[2]) const
    {
        const uchar *left[groups], *low[groups], *high[groups];
        for (int r = 0; r < groups; ++r)
        {
            const Column& column = s_.columns[step - r + margin];
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = left_[r] + x;
            low[r] = right_[r] - x + column.first[0];
            high[r] = right_[r] - x + column.first[1];
        }
        const ByteLanes prior = ofStep(s_.priors, step);
        cost[0] = prior + costs<planes>(left, low, high);
        for (int r = 0; r < groups; ++r)
        {
            ++left[r];
            --low[r];
            --high[r];
        }
        cost[1] = prior + costs<planes>(left, low, high);
    }

    template <int planes>
    ByteLanes costs(const uchar* const (&left)[groups], const uchar* const (&low)[groups],
                    const uchar* const (&high)[groups]) const
    {
        const ByteLanes grey = ByteLanes::repeat(left, planes * leftStride_);
        const ByteLanes candidates = ByteLanes::loadHalves(low, high, planes * rightStride_);
        const ByteLanes contrast = ((grey - candidates) | (candidates - grey)).min(ByteLanes::repeat(31)).quarter();
        ByteLanes bits[planes];
        for (int plane = 0; plane < planes; ++plane)
            bits[plane] =
                ByteLanes::loadHalves(low, high, plane * rightStride_) ^ ByteLanes::repeat(left, plane * leftStride_);
        if (planes == 1)
            return contrast + bits[0].countBits();
        if (planes == 2)
            return contrast + bits[0].countBits() + bits[planes - 1].countBits();
        // Sum and carry of three bits: two counts instead of three
        const ByteLanes second = bits[planes > 1 ? 1 : 0], third = bits[planes - 1], difference = bits[0] ^ second;
        const ByteLanes carries = ((bits[0] & second) | (difference & third)).countBits();
        return contrast + (difference ^ third).countBits() + (carries + carries);
    }

    //! L(p, d) - m of a direction; h: H of the pixel before, which becomes that of this one.
    ByteLanes advance(ByteLanes& h, const ByteLanes& cost) const
    {
        const ByteLanes gain = h.max(h.toNext().max(h.toPrevious()) - small_);
        const ByteLanes sum = cost + large_ - gain;
        const ByteLanes aboveMinimum = sum - sum.minimum();
        h = large_ - aboveMinimum;
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
        return h & ByteLanes::load(mask);
    }

    template <int planes> void fromRight()
    {
        ByteLanes h = zero_, cost[2];
        for (int t = steps_ - 1; t >= 0; --t)
        {
            costs<planes>(t, cost);
            uchar* costs = &s_.costs[(size_t)t * 2 * lanes];
            uchar* directions = &s_.fromRight[(size_t)t * 2 * lanes];
            h = h.permute(ofStep(s_.intoLeft, t));
            for (int column = 1; column >= 0; --column)
            {
                const ByteLanes direction = advance(h, cost[column]);
                if (t + 1 >= pairs_)
                    h = clearOutside(h, t, column);
                cost[column].store(costs + column * lanes);
                direction.store(directions + column * lanes);
            }
        }
    }

    //! The direction from above: before holds H of the last step's columns.
    ByteLanes fromAbove(const ByteLanes& cost, int t, int column, ByteLanes& before)
    {
        uchar* above = &s_.fromAbove[0] + (ptrdiff_t)(2 * t + column + margin) * Window::candidates;
        ByteLanes h = ByteLanes::shiftIn(above, before);
        if (entersUpperRow_) // only the block's first row may
            h = h.permute(ByteLanes::first(&s_.intoBelow[0] + (ptrdiff_t)(t + margin) * Window::candidates));
        const ByteLanes direction = advance(h, cost);
        before = h;
        h.storeLast(above - 2 * (groups - 1) * Window::candidates);
        return direction;
    }

    template <int planes> void warmUpBlock()
    {
        ByteLanes before[2] = { zero_, zero_ }, cost[2];
        for (int t = 0; t < steps_; ++t)
        {
            costs<planes>(t, cost);
            for (int column = 0; column < 2; ++column)
                fromAbove(cost[column], t, column, before[column]);
        }
    }

    void fromLeftAndAbove()
    {
        ByteLanes h = zero_, before[2] = { zero_, zero_ };
        for (int t = 0; t < steps_; ++t)
        {
            const uchar* costs = &s_.costs[(size_t)t * 2 * lanes];
            const uchar* directions = &s_.fromRight[(size_t)t * 2 * lanes];
            h = h.permute(ofStep(s_.intoRight, t));
            for (int column = 0; column < 2; ++column)
            {
                const ByteLanes cost = ByteLanes::load(costs + column * lanes);
                const ByteLanes fromLeft = advance(h, cost);
                const ByteLanes sum = fromLeft + ByteLanes::load(directions + column * lanes) +
                                      fromAbove(cost, t, column, before[column]);
                takeWinners(sum, t, column, costs + column * lanes);
            }
            if (t + 1 < groups)
                h = clearOutside(h, t, 1);
        }
    }

    //! The winners in whole pixels, and the two lines of opposite slope through their sums and those beside them: their
    //! slope and how much the sum before is above the one after.
    void takeWinners(const ByteLanes& sum, int t, int column, const uchar* costs)
    {
        unsigned lowest[groups];
        sum.findEqual(sum.minimum(), lowest);
        uchar stored[lanes + 2]; // one more on each side to read
        sum.store(stored + 1);
        for (int r = 0; r < groups; ++r)
        {
            const int lane = firstBit(lowest[r]), upperX = t - r, x = 2 * upperX + column;
            const Column& candidates = s_.columns[upperX + margin];
            const uchar* sums = stored + 1 + r * 16 + lane;
            const int before = sums[-1], after = sums[1];
            disparities_[r][x] = (ushort)((candidates.first[lane / Window::runLength] + lane % Window::runLength) *
                                          ScanlineProblem::scale);
            rises_[r][x] = (short)((before - after) & -(candidates.inner >> lane & 1));
            slopes_[r][x] = (short)(std::max(before, after) - sums[0]);
            residuals_[r][x] = costs[r * 16 + lane];
        }
    }

    void addSubpixel(int group, ushort* disparity) const
    {
        const float wholes = 12582912; // 1.5 * 2^23: sums with it are whole numbers, rounded to the nearest
        const ushort* disparities = disparities_[group];
        const short *rises = rises_[group], *slopes = slopes_[group];
        HDP_VECTORIZED for (int x = 0; x < width_; ++x)
        {
            const float slope = (float)std::max<short>(slopes[x], 1);
            const float offset = (float)rises[x] * (ScanlineProblem::scale / 2) / slope;
            disparity[x] = (ushort)(disparities[x] + (int)((offset + wholes) - wholes));
        }
    }

    static int firstBit(unsigned bits)
    {
#if defined(__GNUC__)
        return __builtin_ctz(bits);
#else
        int bit = 0;
        while ((bits >> bit & 1) == 0)
            ++bit;
        return bit;
#endif
    }

    enum
    {
        priorRange = 3 * Window::candidates / 2 * ScanlineProblem::scale
    };

    const ScanlineProblem& p_;
    ScanlineScratch& s_;
    const int width_, pairs_, steps_;       // columns, pairs of them, and steps over all groups
    const size_t leftStride_, rightStride_; // from a plane of the cost to the next
    const ByteLanes small_, large_, zero_;
    const Window* windows_; // of the block's row of the upper layer
    int upperRow_;          // that row
    bool entersUpperRow_;   // whether it is not that of the block before
    const uchar *left_[groups], *right_[groups];
    ushort* disparities_[groups];
    short *rises_[groups], *slopes_[groups];
    uchar* residuals_[groups];
    uchar priorTable_[2 * priorRange][Window::candidates];
    uchar pairOrder_[3 * Window::candidates], runOrder_[Window::runs][3 * Window::candidates];
};

} // namespace

void aggregateStripe(const ScanlineProblem& problem, int above, const Range& rows, ScanlineScratch& scratch,
                     Mat& disparity, Mat& residual)
{
    Sweep sweep(problem, scratch);
    for (int y = above; y < rows.start; y += ByteLanes::groups)
        sweep.warmUp(y);
    for (int y = rows.start; y < rows.end; y += ByteLanes::groups)
        sweep.run(y, rows.end, disparity, residual);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
