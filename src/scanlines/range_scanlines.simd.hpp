// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "range_scanlines.hpp"
#include "../base/vectorized.hpp"
#include "winner_fraction.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "range_costs.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A stripe of aggregateRange()
void aggregateRangeStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch,
                          Mat& disparity);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** The directions over a stripe. Rows of a block are followed side by side, each a column behind the one above it: so
none waits for the minimum of another.
@tparam count As of RangeLanes. */
template <int count> class RangeSweep
{
public:
    RangeSweep(const RangeProblem& problem, RangeScratch& scratch)
        : p_(problem), own_(scratch), width_(problem.size.width), lanes_(problem), costs_(problem),
          small_(ByteLanes::repeat(problem.small)), vertical_(scratch.vertical())
    {
        uchar marked[2 * Lanes::vector] = {};
        marked[Lanes::vector] = UCHAR_MAX;
        beforeFirst_ = ByteLanes::load(marked + Lanes::vector);
        afterLast_ = ByteLanes::load(marked + 1);
    }

    //! From below, over the rows of a stripe's reach; those of the stripe are kept.
    void followUpward(const ScanlineStripe& stripe)
    {
        const uchar* before = vertical_;
        for (int y = stripe.reach.end - 1; y >= stripe.rows.start; --y)
        {
            uchar* const here = y < stripe.rows.end ? own_.below(y - stripe.rows.start) : vertical_;
            followVertical(y, y + 1 < stripe.reach.end ? edges(y, 1) : nullptr, before, here);
            before = here;
        }
    }

    //! From above, over the rows of its reach before a stripe
    void warmUp(const ScanlineStripe& stripe)
    {
        for (int y = stripe.reach.start; y < stripe.rows.start; ++y)
            followVertical(y, y > stripe.reach.start ? edges(y - 1, 1) : nullptr, vertical_, vertical_);
    }

    //! All directions of a block of rows, and their winners
    void run(const Range& rows, const ScanlineStripe& stripe, Mat& disparity)
    {
        const int height = rows.size();
        enterBlock(rows, stripe);
        for (int x = width_ - 1; x >= 0; --x)
            for (int r = 0; r < height; ++r)
                followRight(rows_[r], x);
        for (int t = 0; t < width_ + height - 1; ++t)
        {
            const Range active(std::max(t - width_ + 1, 0), std::min(t + 1, height));
            for (int r = active.start; r < active.end; ++r)
                rows_[r].winner = finishPixel(rows_[r], t - r);
            for (int r = active.start; r < active.end; ++r)
                setWinner(rows_[r], t - r);
        }
        for (int r = 0; r < height; ++r)
            takeDisparities(rows_[r], disparity.ptr<ushort>(rows.start + r));
    }

private:
    typedef RangeLanes<count> Lanes;
    typedef typename Lanes::Pixel Pixel;

    //! A row of a block
    struct Row
    {
        typename RangeCosts<count>::Row costRow;
        const uchar *toRight, *toAbove;       // edges of the first column; to the row above: or none
        uchar *costs, *beside, *sums, *below; // see RangeScratch
        ushort* whole;
        short *rise, *slope;
        int winner; // of the last pixel
    };

    //! The edges of a row to the right or to the row below, see weighEdges()
    const uchar* edges(int y, int below) const { return p_.weights.ptr(y) + below; }

    void enterBlock(const Range& rows, const ScanlineStripe& stripe)
    {
        for (int r = 0; r < rows.size(); ++r)
        {
            const int y = rows.start + r;
            const ptrdiff_t first = r * (ptrdiff_t)width_;
            const Row row = { costs_.row(y),
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
            rows_[r] = row;
        }
    }

    //! E of a pixel in a direction, from its costs and E of the pixel before. edge: between the two; none if there is
    //! no pixel before
    CV_ALWAYS_INLINE void step(const Pixel& costs, const uchar* before, const uchar* edge, Pixel& e) const
    {
        const ByteLanes large = ByteLanes::repeat(edge ? p_.large[*edge] : 0);
        const int last = lanes_.vectors() - 1;
        HDP_UNROLLED for (int k = 0; k <= last; ++k)
        {
            const uchar* const from = before + k * Lanes::vector;
            ByteLanes lower = ByteLanes::load(from - 1), higher = ByteLanes::load(from + 1);
            if (k == 0)
                lower = lower | beforeFirst_;
            if (k == last)
                higher = higher | afterLast_;
            const ByteLanes beside = lower.min(higher) + small_;
            e.of[k] = costs.of[k] + ByteLanes::load(from).min(beside).min(large);
        }
        const ByteLanes least = lanes_.lowest(e);
        HDP_UNROLLED for (int k = 0; k <= last; ++k) e.of[k] = e.of[k] - least;
        lanes_.closeTail(e);
    }

    //! E of a row of pixels from above or below. edges: to the row before, or none
    void followVertical(int y, const uchar* edges, const uchar* before, uchar* here) const
    {
        const typename RangeCosts<count>::Row row = costs_.row(y);
        const ptrdiff_t bytes = lanes_.bytes();
        for (int x = 0; x < width_; ++x, before += bytes, here += bytes)
        {
            Pixel costs, e;
            costs_.of(row, x, costs);
            step(costs, before, edges ? edges + 2 * x : nullptr, e);
            lanes_.store(e, here);
        }
    }

    //! From the right: adds E to that from below.
    CV_ALWAYS_INLINE void followRight(const Row& row, int x)
    {
        uchar* const below = row.below + x * lanes_.bytes();
        Pixel costs, e, sums;
        costs_.of(row.costRow, x, costs);
        lanes_.store(costs, row.costs + x * lanes_.bytes());
        step(costs, row.beside, x + 1 < width_ ? row.toRight + 2 * x : nullptr, e);
        lanes_.store(e, row.beside);
        lanes_.load(below, sums);
        lanes_.add(e, sums);
        lanes_.store(sums, below);
    }

    //! From the left and from above; returns the winner.
    CV_ALWAYS_INLINE int finishPixel(const Row& row, int x)
    {
        const ptrdiff_t at = x * lanes_.bytes();
        Pixel costs, fromLeft, fromAbove, sums;
        lanes_.load(row.costs + at, costs);
        step(costs, row.beside, x > 0 ? row.toRight + 2 * x - 2 : nullptr, fromLeft);
        lanes_.store(fromLeft, row.beside);
        step(costs, vertical_ + at, row.toAbove ? row.toAbove + 2 * x : nullptr, fromAbove);
        lanes_.store(fromAbove, vertical_ + at);
        lanes_.load(row.below + at, sums);
        lanes_.add(fromLeft, sums);
        lanes_.add(fromAbove, sums);
        lanes_.store(sums, row.sums);
        const ByteLanes least = lanes_.lowest(sums);
        for (int k = 0; k < lanes_.vectors(); ++k)
        {
            const int lane = sums.of[k].firstEqual(least);
            if (lane >= 0)
                return k * Lanes::vector + lane; // lanes without a candidate have 255, and come last
        }
        return 0;
    }

    void setWinner(const Row& row, int x) const
    {
        const WinnerSlope beside = slopeOfWinner(row.sums, row.winner, p_.candidates - 1);
        row.whole[x] = (ushort)row.winner;
        row.rise[x] = (short)beside.rise;
        row.slope[x] = (short)beside.slope;
    }

    void takeDisparities(const Row& row, ushort* disparity) const
    {
        const int bit = 2; // costs are halves of it
        const ushort* const whole = row.whole;
        const short *const rise = row.rise, *const slope = row.slope;
        HDP_VECTORIZED for (int x = 0; x < width_; ++x) disparity[x] =
            disparityOfSums(whole[x], rise[x], slope[x], bit, 1);
    }

    const RangeProblem& p_;
    RangeScratch& own_;
    const int width_;
    const Lanes lanes_;
    const RangeCosts<count> costs_;
    const ByteLanes small_;
    ByteLanes beforeFirst_, afterLast_; // 255 in the lane that no candidate is beside
    uchar* const vertical_;             // see RangeScratch
    Row rows_[RangeScratch::block];
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
    const int vectors = RangeLanes<0>::vectorsOf(problem);
#ifdef HDP_SANITIZED
    const auto sweep = vectors == 2 ? sweepStripe<2> : sweepStripe<0>;
#else
    static void (*const sweeps[])(const RangeProblem&, const ScanlineStripe&, RangeScratch&,
                                  Mat&) = { sweepStripe<1>, sweepStripe<2>, sweepStripe<3>, sweepStripe<4> };
    const auto sweep = vectors <= 4   ? sweeps[vectors - 1]
                       : vectors == 8 ? sweepStripe<8> // of 16 bytes: 128 candidates, as four of 32
                                      : sweepStripe<0>;
#endif
    sweep(problem, stripe, scratch, disparity);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
