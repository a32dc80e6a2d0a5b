// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "range_scanlines.hpp"
#include "../base/vectorized.hpp"
#include "winner_fraction.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Aggregates a stripe of the layer.
@param problem The layer.
@param stripe Its rows.
@param scratch Memory to work in.
@param disparity As in aggregateRange(). */
void aggregateRangeStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch,
                          Mat& disparity);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** The directions over a stripe. Rows of a block are followed side by side, each a column behind the one above it: so
none waits for the minimum of another.
@tparam count Vectors of a pixel's candidates, which then stay in registers; 0 for any number. */
template <int count> class RangeSweep
{
public:
    RangeSweep(const RangeProblem& problem, RangeScratch& scratch)
        : p_(problem), own_(scratch), width_(problem.size.width), vectors_(count > 0 ? count : vectorsOf(problem)),
          planes_(problem.below.planes()), small_(ByteLanes::repeat(problem.small)), vertical_(scratch.vertical())
    {
        CV_DbgAssert(vectors_ == vectorsOf(problem) && vectors_ <= mostVectors);
        const ptrdiff_t tail = bytes() - problem.candidates;
        uchar marked[3 * vector] = {};
        marked[vector] = UCHAR_MAX;
        beforeFirst_ = ByteLanes::load(marked + vector);
        afterLast_ = ByteLanes::load(marked + 1);
        std::fill_n(marked + 3 * vector - tail, tail, (uchar)UCHAR_MAX);
        tail_ = ByteLanes::load(marked + 2 * vector);
    }

    static int vectorsOf(const RangeProblem& problem) { return (problem.candidates + vector - 1) / vector; }

    //! From below, over the rows of a stripe's reach; those of the stripe are kept.
    void followUpward(const ScanlineStripe& stripe)
    {
        const uchar* before = own_.vertical();
        for (int y = stripe.reach.end - 1; y >= stripe.rows.start; --y)
        {
            uchar* const here = y < stripe.rows.end ? own_.below(y - stripe.rows.start) : own_.vertical();
            followVertical(y, y + 1 < stripe.reach.end ? edges(y, 1) : nullptr, before, here);
            before = here;
        }
    }

    //! From above, over the rows of its reach before a stripe
    void warmUp(const ScanlineStripe& stripe)
    {
        for (int y = stripe.reach.start; y < stripe.rows.start; ++y)
            followVertical(y, y > stripe.reach.start ? edges(y - 1, 1) : nullptr, own_.vertical(), own_.vertical());
    }

    //! All directions of a block of rows, and their winners
    void run(const Range& rows, const ScanlineStripe& stripe, Mat& disparity)
    {
        const int height = rows.size();
        enterBlock(rows, stripe);
        for (int x = width_ - 1; x >= 0; --x)
            for (int r = 0; r < height; ++r)
                followRight(r, x);
        for (int t = 0; t < width_ + height - 1; ++t)
        {
            const Range active(std::max(t - width_ + 1, 0), std::min(t + 1, height));
            for (int r = active.start; r < active.end; ++r)
                row_[r].winner = finishPixel(r, t - r);
            for (int r = active.start; r < active.end; ++r)
                setWinner(r, t - r);
        }
        for (int r = 0; r < height; ++r)
            takeDisparities(r, disparity.ptr<ushort>(rows.start + r));
    }

private:
    enum
    {
        vector = 16 * ByteLanes::groups,
        mostVectors = 64,
        block = RangeScratch::block
    };

    //! The candidates of a pixel
    struct Pixel
    {
        ByteLanes lanes[count > 0 ? count : +mostVectors];
    };

    //! What gives the costs of a row of pixels
    struct CostRow
    {
        const uchar *left[2], *right[2], *leftLimits[2], *rightLimits[2]; // of the first pixel of two rows below
        const ushort* upper;
        const DisparityInterval* intervals;
    };

    //! A row of a block
    struct BlockRow
    {
        CostRow costRow;
        const uchar *toRight, *toAbove;       // edges of the first column; to the row above: or none
        uchar *costs, *beside, *sums, *below; // see RangeScratch
        ushort* whole;
        short *rise, *slope;
        int winner; // of the last pixel
    };

    CostRow costRow(int y) const
    {
        CostRow row = {};
        for (int i = 0; i < 2; ++i)
        {
            const int lastBelow = p_.below.size().width - 1;
            row.left[i] = p_.below.leftPixels(2 * y + i);
            row.right[i] = p_.below.rightPlane(0, 2 * y + i) + lastBelow;
            if (p_.below.limits().isEmpty())
                continue;
            row.leftLimits[i] = p_.below.limits().left(2 * y + i);
            row.rightLimits[i] = p_.below.limits().right(2 * y + i) + lastBelow;
        }
        row.upper = p_.upper.ptr<ushort>(std::min(y / 2, p_.upper.rows - 1));
        row.intervals = p_.intervals.empty() ? nullptr : p_.intervals.ptr<DisparityInterval>(y);
        return row;
    }

    //! The edges of a row to the right or to the row below, see weighEdges()
    const uchar* edges(int y, int below) const { return p_.weights.ptr(y) + below; }

    void enterBlock(const Range& rows, const ScanlineStripe& stripe)
    {
        for (int r = 0; r < rows.size(); ++r)
        {
            const int y = rows.start + r;
            const ptrdiff_t first = r * (ptrdiff_t)width_;
            const BlockRow row = { costRow(y),
                                   edges(y, 0),
                                   y > stripe.reach.start ? edges(y - 1, 1) : nullptr,
                                   own_.costs(r),
                                   own_.beside(r),
                                   own_.sums(r),
                                   own_.below(y - stripe.rows.start),
                                   own_.whole.data() + first,
                                   own_.rise.data() + first,
                                   own_.slope.data() + first,
                                   0 };
            row_[r] = row;
        }
    }

    //! C'(., h) of one of the two pixels below, whose right neighbours are `right` in each plane
    CV_ALWAYS_INLINE void addCosts(const uchar* left, const uchar* right, Pixel& costs) const
    {
        const int n = vectors();
        const size_t stride = p_.below.planeStride();
        if (planes_ == 3)
        {
            const ByteLanes first = ByteLanes::repeat(left[0]), second = ByteLanes::repeat(left[1]),
                            third = ByteLanes::repeat(left[2]);
            HDP_UNROLLED for (int k = 0; k < n; ++k)
            {
                const uchar* const candidates = right + k * vector;
                costs.lanes[k] =
                    costs.lanes[k] + ByteLanes::countBits(first ^ ByteLanes::load(candidates),
                                                          second ^ ByteLanes::load(candidates + stride),
                                                          third ^ ByteLanes::load(candidates + 2 * stride));
            }
            return;
        }
        for (int plane = 0; plane < planes_; ++plane)
        {
            const ByteLanes census = ByteLanes::repeat(left[plane]);
            const uchar* const candidates = right + plane * stride;
            HDP_UNROLLED for (int k = 0; k < n; ++k) costs.lanes[k] =
                costs.lanes[k] + (census ^ ByteLanes::load(candidates + k * vector)).countBits();
        }
    }

    //! C(p, h) of a pixel
    CV_ALWAYS_INLINE void costsOf(const CostRow& row, int x, Pixel& costs) const
    {
        const int n = vectors();
        const int lastUpper = p_.upper.cols - 1, unit = subpixelScale / 4; // of a candidate in the layer above
        const int predicted = (row.upper[std::min(x / 2, lastUpper)] + unit / 2) / unit;
        const uchar* const prior = p_.priors.data() + p_.candidates - std::min(predicted, p_.candidates);
        if (row.leftLimits[0] || row.intervals)
            return restrictedCosts(row, x, prior, costs);
        HDP_UNROLLED for (int k = 0; k < n; ++k) costs.lanes[k] = ByteLanes::load(prior + k * vector);
        addCosts(row.left[0] + 8 * x, row.right[0] - 2 * x, costs);
        addCosts(row.left[1] + 8 * x + 4, row.right[1] - 2 * x - 1, costs);
        costs.lanes[n - 1] = costs.lanes[n - 1] | tail_;
    }

    //! The same where some pixels have no data or not all candidates
    void restrictedCosts(const CostRow& row, int x, const uchar* prior, Pixel& costs) const
    {
        const int n = vectors();
        for (int k = 0; k < n; ++k)
            costs.lanes[k] = ByteLanes::load(prior + k * vector);
        for (int i = 0; i < 2; ++i)
        {
            Pixel below;
            std::fill_n(below.lanes, vectors(), ByteLanes::repeat(0));
            addCosts(row.left[i] + 4 * (2 * x + i), row.right[i] - 2 * x - i, below);
            if (row.leftLimits[i])
                limit(row, i, 2 * x + i, below);
            for (int k = 0; k < n; ++k)
                costs.lanes[k] = costs.lanes[k] + below.lanes[k];
        }
        if (row.intervals)
            excludeOthers(row.intervals[x], costs);
        costs.lanes[n - 1] = costs.lanes[n - 1] | tail_;
    }

    void limit(const CostRow& row, int i, int xBelow, Pixel& costs) const
    {
        const ByteLanes left = ByteLanes::repeat(row.leftLimits[i][xBelow]);
        const uchar* const right = row.rightLimits[i] - xBelow;
        const int n = vectors();
        for (int k = 0; k < n; ++k)
            costs.lanes[k] = costs.lanes[k].min(left).min(ByteLanes::load(right + k * vector));
    }

    void excludeOthers(const DisparityInterval& interval, Pixel& costs) const
    {
        uchar* const bytes = own_.sums(0);
        store(costs, bytes);
        const int first = std::min<int>(interval.first, p_.candidates), end = interval.last + 1;
        std::fill_n(bytes, first, (uchar)UCHAR_MAX);
        if (end < p_.candidates)
            std::fill(bytes + end, bytes + p_.candidates, (uchar)UCHAR_MAX);
        load(bytes, costs);
    }

    CV_ALWAYS_INLINE void load(const uchar* from, Pixel& pixel) const
    {
        const int n = vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k) pixel.lanes[k] = ByteLanes::load(from + k * vector);
    }
    CV_ALWAYS_INLINE void store(const Pixel& pixel, uchar* to) const
    {
        const int n = vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k) pixel.lanes[k].store(to + k * vector);
    }
    CV_ALWAYS_INLINE ByteLanes lowest(const Pixel& pixel) const
    {
        const int n = vectors();
        ByteLanes least = pixel.lanes[0];
        HDP_UNROLLED for (int k = 1; k < n; ++k) least = least.min(pixel.lanes[k]);
        return least.minimumOfAll();
    }

    /** E of a pixel in a direction, from its costs and E of the pixel before. No edge: there is none before.
    @param edge Its weight. */
    CV_ALWAYS_INLINE void step(const Pixel& costs, const uchar* before, const uchar* edge, Pixel& e) const
    {
        const ByteLanes jump = ByteLanes::repeat(edge ? p_.large[*edge] : 0);
        const int last = vectors() - 1;
        HDP_UNROLLED for (int k = 0; k <= last; ++k)
        {
            ByteLanes lower = ByteLanes::load(before + k * vector - 1),
                      higher = ByteLanes::load(before + k * vector + 1);
            if (k == 0)
                lower = lower | beforeFirst_;
            if (k == last)
                higher = higher | afterLast_;
            const ByteLanes beside = lower.min(higher) + small_;
            e.lanes[k] = costs.lanes[k] + ByteLanes::load(before + k * vector).min(beside).min(jump);
        }
        const ByteLanes least = lowest(e);
        HDP_UNROLLED for (int k = 0; k <= last; ++k) e.lanes[k] = e.lanes[k] - least;
        e.lanes[last] = e.lanes[last] | tail_;
    }

    //! E of a row of pixels from above or below. edges: to the row before, or none
    void followVertical(int y, const uchar* edges, const uchar* before, uchar* here) const
    {
        const CostRow row = costRow(y);
        for (int x = 0; x < width_; ++x, before += bytes(), here += bytes())
        {
            Pixel costs, e;
            costsOf(row, x, costs);
            step(costs, before, edges ? edges + 2 * x : nullptr, e);
            store(e, here);
        }
    }

    //! From the right: adds E to that from below.
    CV_ALWAYS_INLINE void followRight(int r, int x)
    {
        const int n = vectors();
        const BlockRow& row = row_[r];
        Pixel costs, e;
        costsOf(row.costRow, x, costs);
        store(costs, row.costs + x * bytes());
        step(costs, row.beside, x + 1 < width_ ? row.toRight + 2 * x : nullptr, e);
        store(e, row.beside);
        uchar* const sums = row.below + x * bytes();
        HDP_UNROLLED for (int k = 0; k < n; ++k)(e.lanes[k] + ByteLanes::load(sums + k * vector))
            .store(sums + k * vector);
    }

    //! From the left and from above; returns the winner.
    CV_ALWAYS_INLINE int finishPixel(int r, int x)
    {
        const int n = vectors();
        const BlockRow& row = row_[r];
        Pixel costs, fromLeft, fromAbove, sums;
        load(row.costs + x * bytes(), costs);
        step(costs, row.beside, x > 0 ? row.toRight + 2 * x - 2 : nullptr, fromLeft);
        store(fromLeft, row.beside);
        uchar* const above = vertical_ + x * bytes();
        step(costs, above, row.toAbove ? row.toAbove + 2 * x : nullptr, fromAbove);
        store(fromAbove, above);
        load(row.below + x * bytes(), sums);
        HDP_UNROLLED for (int k = 0; k < n; ++k) sums.lanes[k] =
            sums.lanes[k] + (fromLeft.lanes[k] + fromAbove.lanes[k]);
        store(sums, row.sums);
        const ByteLanes least = lowest(sums);
        for (int k = 0; k < n; ++k)
        {
            const int lane = sums.lanes[k].firstEqual(least);
            if (lane >= 0)
                return std::min(k * vector + lane, p_.candidates - 1);
        }
        return 0;
    }

    void setWinner(int r, int x)
    {
        const BlockRow& row = row_[r];
        const int winner = row.winner;
        const WinnerSlope beside = slopeOfWinner(row.sums, winner, p_.candidates - 1);
        row.whole[x] = (ushort)winner;
        row.rise[x] = (short)beside.rise;
        row.slope[x] = (short)beside.slope;
    }

    void takeDisparities(int r, ushort* disparity) const
    {
        const int bit = 2; // costs are halves of it
        const ushort* const whole = own_.whole.data() + (size_t)r * width_;
        const short *const rise = own_.rise.data() + (size_t)r * width_, *const slope =
                                                                             own_.slope.data() + (size_t)r * width_;
        HDP_VECTORIZED for (int x = 0; x < width_; ++x) disparity[x] =
            disparityOfSums(whole[x], rise[x], slope[x], bit, 1);
    }

    //! Of the candidates of a pixel, a number that the compiler knows
    CV_ALWAYS_INLINE int vectors() const { return count > 0 ? count : vectors_; }
    CV_ALWAYS_INLINE ptrdiff_t bytes() const { return (ptrdiff_t)vectors() * vector; }

    const RangeProblem& p_;
    RangeScratch& own_;
    const int width_, vectors_, planes_;
    const ByteLanes small_;
    ByteLanes beforeFirst_, afterLast_, tail_; // 255 in lanes that no candidate is in
    uchar* const vertical_;                    // see RangeScratch
    BlockRow row_[block];
};

template <int count>
void sweepStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch, Mat& disparity)
{
    const Range& rows = stripe.rows;
    RangeSweep<count> sweep(problem, scratch);
    sweep.followUpward(stripe);
    sweep.warmUp(stripe);
    for (int y = rows.start; y < rows.end; y += RangeScratch::block)
        sweep.run(Range(y, std::min(y + RangeScratch::block, rows.end)), stripe, disparity);
}

} // namespace

void aggregateRangeStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch,
                          Mat& disparity)
{
    static void (*const sweeps[])(const RangeProblem&, const ScanlineStripe&, RangeScratch&,
                                  Mat&) = { sweepStripe<1>, sweepStripe<2>, sweepStripe<3>, sweepStripe<4> };
    const int vectors = RangeSweep<0>::vectorsOf(problem);
    const auto sweep = vectors <= 4   ? sweeps[vectors - 1]
                       : vectors == 8 ? sweepStripe<8> // of 16 bytes: 128 candidates, as four of 32
                                      : sweepStripe<0>;
    sweep(problem, stripe, scratch, disparity);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
