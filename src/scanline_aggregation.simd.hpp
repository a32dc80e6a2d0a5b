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

/** A sweep over a stripe. Rows are done in blocks of ByteLanes::groups, skewed: at step t group r is at column t - 2 r of
the block's row r, so that the group before has left column t - 2 r of the row above two steps ago, and all groups enter
the next pixel of the layer above at the same steps.

Instead of the costs L(q, d) of the pixel before, a direction carries H(q, d) = max(m + large - L(q, d), 0): 0 stands for
a candidate that q does not have as well as for one not worth to come from. */
class Sweep
{
public:
    Sweep(const ScanlineProblem& problem, ScanlineScratch& scratch)
        : p_(problem), s_(scratch), width_(problem.size.width), upperWidth_(problem.windows->cols),
          steps_(width_ + 2 * (groups - 1)),
          beforeLast_((1 << (std::min<int>(Window::candidates, problem.numDisparities) - 1)) - 1),
          small_(ByteLanes::repeat(problem.penalties.small)), large_(ByteLanes::repeat(problem.penalties.large)),
          zero_(ByteLanes::repeat(0)), windows_(0), upperRow_(-1), entersUpperRow_(false)
    {
        s_.costs.resize((size_t)steps_ * lanes);
        s_.fromRight.resize((size_t)steps_ * lanes);
        s_.fromAbove.assign((size_t)width_ * Window::candidates, 0);
        s_.priors.resize((size_t)upperWidth_ * Window::candidates);
        s_.intoRight.resize((size_t)upperWidth_ * Window::candidates);
        s_.intoLeft.resize((size_t)upperWidth_ * Window::candidates);
        s_.intoBelow.resize((size_t)upperWidth_ * Window::candidates);
        s_.rises.resize((size_t)groups * width_);
        s_.slopes.resize((size_t)groups * width_);
        preparePriorTable();
        prepareOrderTable();
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
        fromLeftAndAbove(y, end, disparity, residual);
    }

private:
    enum
    {
        groups = ByteLanes::groups,
        lanes = groups * 16
    };

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

    //! The prior of a run, by the distance of its first candidate from the predicted disparity
    void preparePriorTable()
    {
        for (int distance = -priorRange; distance < priorRange; ++distance)
            for (int i = 0; i < Window::runLength; ++i)
                priorTable_[distance + priorRange][i] =
                    (uchar)(p_.penalties.prior * std::abs(distance + i * ScanlineProblem::scale) /
                            (2 * ScanlineProblem::scale));
    }

    //! For runs that begin `shift` disparities after another one: which of its candidates are the same ones
    void prepareOrderTable()
    {
        for (int shift = -Window::runLength; shift <= Window::runLength; ++shift)
            for (int run = 0; run < Window::runs; ++run)
                for (int i = 0; i < Window::runLength; ++i)
                {
                    const bool exists = i + shift >= 0 && i + shift < Window::runLength;
                    orderTable_[run][shift + Window::runLength][i] =
                        exists ? (uchar)(run * Window::runLength + i + shift) : (uchar)255;
                }
    }

    //! Which lanes of `from` have the candidates of `to`
    void transition(const Window& from, const Window& to, uchar* order) const
    {
        for (int run = 0; run < Window::runs; ++run)
        {
            uint64 first, second;
            std::memcpy(&first, orderTable_[0][clampShift(to.first[run] - from.first[0])], 8);
            std::memcpy(&second, orderTable_[1][clampShift(to.first[run] - from.first[1])], 8);
            first &= second; // runs do not overlap: at least one of the two is 255
            std::memcpy(order + run * Window::runLength, &first, 8);
        }
    }

    static int clampShift(int shift)
    {
        return std::min(std::max(shift, -Window::runLength), +Window::runLength) + Window::runLength;
    }

    //! Prepares a block of rows from y on: what follows from the windows, if they are new, and the rows' pointers.
    void enterRows(int y)
    {
        const int upperRow = std::min(y / 2, p_.windows->rows - 1);
        entersUpperRow_ = upperRow != upperRow_;
        if (entersUpperRow_)
        {
            const Window* above = windows_;
            windows_ = p_.windows->ptr<Window>(upperRow);
            upperRow_ = upperRow;
            for (int x = 0; x < upperWidth_; ++x)
            {
                const Window& window = windows_[x];
                const size_t at = (size_t)x * Window::candidates;
                for (int run = 0; run < Window::runs; ++run)
                {
                    const int distance = window.first[run] * ScanlineProblem::scale - window.predicted[run];
                    const int index = std::min(std::max(distance, -priorRange), priorRange - 1) + priorRange;
                    std::memcpy(&s_.priors[at + run * Window::runLength], priorTable_[index], Window::runLength);
                }
                for (int i = 0; i < Window::candidates && p_.numDisparities < Window::candidates; ++i)
                    if (i >= p_.numDisparities)
                        s_.priors[at + i] = 255;
                if (x > 0)
                    transition(windows_[x - 1], window, &s_.intoRight[at]);
                if (x + 1 < upperWidth_)
                    transition(windows_[x + 1], window, &s_.intoLeft[at]);
                if (above)
                    transition(above[x], window, &s_.intoBelow[at]);
            }
            entersUpperRow_ = above != 0;
        }
        for (int r = 0; r < groups; ++r)
            for (int plane = 0; plane <= p_.cost->planes(); ++plane)
            {
                left_[plane][r] = p_.cost->leftPlane(plane, std::min(y + r, p_.size.height - 1));
                right_[plane][r] = p_.cost->rightPlane(plane, std::min(y + r, p_.size.height - 1)) + width_ - 1;
            }
    }

    int column(int step, int group) const { return std::min(std::max(step - 2 * group, 0), width_ - 1); }
    int upperColumn(int column) const { return std::min(column / 2, upperWidth_ - 1); }

    //! The candidates' costs C(p, d)
    template <int planes> ByteLanes costs(int step) const
    {
        const uchar *left[planes + 1][groups], *low[planes + 1][groups], *high[planes + 1][groups], *priors[groups];
        for (int r = 0; r < groups; ++r)
        {
            const int x = column(step, r), upperX = upperColumn(x);
            const Window& window = windows_[upperX];
            priors[r] = &s_.priors[(size_t)upperX * Window::candidates];
            for (int plane = 0; plane <= planes; ++plane)
            {
                left[plane][r] = left_[plane][r] + x;
                low[plane][r] = right_[plane][r] - x + window.first[0];
                high[plane][r] = right_[plane][r] - x + window.first[1];
            }
        }
        const ByteLanes grey = ByteLanes::repeat(left[planes]);
        const ByteLanes candidates = ByteLanes::loadHalves(low[planes], high[planes]);
        const ByteLanes contrast = ((grey - candidates) | (candidates - grey)).min(ByteLanes::repeat(31));
        const ByteLanes cost = ByteLanes::load(priors) + contrast.quarter();

        ByteLanes bits[planes];
        for (int plane = 0; plane < planes; ++plane)
            bits[plane] = ByteLanes::loadHalves(low[plane], high[plane]) ^ ByteLanes::repeat(left[plane]);
        if (planes == 1)
            return cost + bits[0].countBits();
        if (planes == 2)
            return cost + bits[0].countBits() + bits[planes - 1].countBits();
        // Sum and carry of three bits: two counts instead of three
        const ByteLanes second = bits[planes > 1 ? 1 : 0], third = bits[planes - 1], difference = bits[0] ^ second;
        const ByteLanes carries = ((bits[0] & second) | (difference & third)).countBits();
        return cost + (difference ^ third).countBits() + (carries + carries);
    }

    //! L(p, d) - m of a direction; h: H of the pixel before, which becomes that of this one.
    ByteLanes step(ByteLanes& h, const ByteLanes& cost) const
    {
        const ByteLanes gain = h.max(h.toNext().max(h.toPrevious()) - small_);
        const ByteLanes sum = cost + large_ - gain;
        const ByteLanes aboveMinimum = sum - sum.minimum();
        h = large_ - aboveMinimum;
        return aboveMinimum;
    }

    //! H in the order of the pixel's own candidates, when all groups have come from another pixel of the upper layer
    ByteLanes reorder(const ByteLanes& h, int step, const std::vector<uchar>& orders) const
    {
        const uchar* order[groups];
        for (int r = 0; r < groups; ++r)
            order[r] = &orders[(size_t)upperColumn(column(step, r)) * Window::candidates];
        return h.permute(ByteLanes::load(order));
    }

    //! Leaves the groups as they are that are inside of the image at a step, and clears the others.
    ByteLanes clearOutside(const ByteLanes& h, int step) const
    {
        static const uchar inside[16] = {
            255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255
        };
        static const uchar outside[16] = { 0 };
        const uchar* mask[groups];
        for (int r = 0; r < groups; ++r)
            mask[r] = step - 2 * r >= 0 && step - 2 * r < width_ ? inside : outside;
        return h & ByteLanes::load(mask);
    }

    template <int planes> void fromRight()
    {
        const int lastEntered =
            2 * upperWidth_ - 1; // the last column that has another pixel of the upper layer after it
        ByteLanes h = zero_;
        for (int t = steps_ - 1; t >= 0; --t)
        {
            const ByteLanes cost = costs<planes>(t);
            if (t % 2 == 1)
                h = enterLeft(h, t, lastEntered);
            const ByteLanes direction = step(h, cost);
            if (t >= width_)
                h = clearOutside(h, t);
            cost.store(&s_.costs[(size_t)t * lanes]);
            direction.store(&s_.fromRight[(size_t)t * lanes]);
        }
    }

    ByteLanes enterLeft(const ByteLanes& h, int step, int lastEntered) const
    {
        const uchar* order[groups];
        for (int r = 0; r < groups; ++r)
        {
            const int x = column(step, r);
            order[r] = x % 2 == 1 && x < lastEntered ? &s_.intoLeft[(size_t)(x / 2) * Window::candidates] : identity();
        }
        return h.permute(ByteLanes::load(order));
    }

    ByteLanes enterRight(const ByteLanes& h, int step) const
    {
        const uchar* order[groups];
        for (int r = 0; r < groups; ++r)
        {
            const int x = column(step, r);
            order[r] = x > 0 && x / 2 < upperWidth_ ? &s_.intoRight[(size_t)(x / 2) * Window::candidates] : identity();
        }
        return h.permute(ByteLanes::load(order));
    }

    //! From the block above: only its first row may enter another row of the upper layer.
    ByteLanes enterBelow(const ByteLanes& h, int step) const
    {
        const uchar* order[groups];
        order[0] = &s_.intoBelow[(size_t)upperColumn(column(step, 0)) * Window::candidates];
        for (int r = 1; r < groups; ++r)
            order[r] = identity();
        return h.permute(ByteLanes::load(order));
    }

    static const uchar* identity()
    {
        static const uchar order[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
        return order;
    }

    //! The direction from above: before holds H of the last two steps.
    ByteLanes fromAbove(const ByteLanes& cost, int t, ByteLanes (&before)[2])
    {
        uchar* above = &s_.fromAbove[0];
        ByteLanes h = ByteLanes::shiftIn(above + (size_t)column(t, 0) * Window::candidates, before[1]);
        if (entersUpperRow_)
            h = enterBelow(h, t);
        const ByteLanes direction = step(h, cost);
        before[1] = before[0];
        before[0] = h;
        const int last = t - 2 * (groups - 1);
        if (last >= 0)
            h.storeLast(above + (size_t)last * Window::candidates);
        return direction;
    }

    template <int planes> void warmUpBlock()
    {
        ByteLanes before[2] = { zero_, zero_ };
        for (int t = 0; t < steps_; ++t)
            fromAbove(costs<planes>(t), t, before);
    }

    void fromLeftAndAbove(int y, int end, Mat& disparity, Mat& residual)
    {
        ushort* rows[groups];
        uchar* residuals[groups];
        for (int r = 0; r < groups; ++r)
        {
            rows[r] = y + r < end ? disparity.ptr<ushort>(y + r) : 0;
            residuals[r] = y + r < end ? residual.ptr(y + r) : 0;
        }
        ByteLanes h = zero_, before[2] = { zero_, zero_ };
        for (int t = 0; t < steps_; ++t)
        {
            const ByteLanes cost = ByteLanes::load(&s_.costs[(size_t)t * lanes]);
            if (t % 2 == 0)
                h = enterRight(h, t);
            const ByteLanes fromLeft = step(h, cost);
            if (t < 2 * (groups - 1))
                h = clearOutside(h, t);
            const ByteLanes sum =
                fromLeft + ByteLanes::load(&s_.fromRight[(size_t)t * lanes]) + fromAbove(cost, t, before);

            unsigned lowest[groups];
            sum.findEqual(sum.minimum(), lowest);
            uchar sums[lanes + 2]; // one more on each side to read
            sum.store(sums + 1);
            for (int r = 0; r < groups; ++r)
            {
                const int x = t - 2 * r;
                if (x < 0 || x >= width_ || !rows[r])
                    continue;
                const int lane = firstBit(lowest[r]);
                takeWinner(windows_[upperColumn(x)], sums + 1 + r * 16, lane, rows[r][x], s_.rises[r * width_ + x],
                           s_.slopes[r * width_ + x]);
                residuals[r][x] = s_.costs[(size_t)t * lanes + r * 16 + lane];
            }
        }
        for (int r = 0; r < groups; ++r)
            if (rows[r])
                addSubpixel(&s_.rises[r * width_], &s_.slopes[r * width_], rows[r]);
    }

    //! The winner in whole pixels, and the two lines of opposite slope through its sum and those beside it: their slope
    //! and how much the sum before is above the one after.
    void takeWinner(const Window& window, const uchar* sums, int lane, ushort& disparity, short& rise,
                    short& slope) const
    {
        disparity =
            (ushort)((window.first[lane / Window::runLength] + lane % Window::runLength) * ScanlineProblem::scale);
        // Lanes with a candidate on each side
        const int inner = (window.isContiguous() ? 0x7ffe : 0x7e7e) & beforeLast_;
        const int before = sums[lane - 1], after = sums[lane + 1];
        rise = (short)((before - after) * (inner >> lane & 1));
        slope = (short)std::max(std::max(before, after) - sums[lane], 1);
    }

    void addSubpixel(const short* rises, const short* slopes, ushort* disparity) const
    {
        const float wholes = 12582912; // 1.5 * 2^23: sums with it are whole numbers, rounded to the nearest
        HDP_VECTORIZED for (int x = 0; x < width_; ++x)
        {
            const float offset = (float)rises[x] * (ScanlineProblem::scale / 2) / (float)slopes[x];
            disparity[x] = (ushort)(disparity[x] + (int)((offset + wholes) - wholes));
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
    const int width_, upperWidth_, steps_;
    const int beforeLast_; // bits of the lanes before that of the last candidate there is
    const ByteLanes small_, large_, zero_;
    const Window* windows_; // of the block's row of the upper layer
    int upperRow_;          // that row
    bool entersUpperRow_;   // whether it is not that of the block before
    const uchar *left_[4][groups], *right_[4][groups];
    uchar priorTable_[2 * priorRange][Window::runLength];
    uchar orderTable_[Window::runs][2 * Window::runLength + 1][Window::runLength];
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
