// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "range_scanlines.hpp"
#include "winner_fraction.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A stripe of aggregateRange()
void aggregateRangeStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch,
                          Mat& disparity);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** The candidates of pixels, in vectors of bytes.
@tparam count Vectors of a pixel, which then stay in registers; 0 for any number. */
template <int count> class RangeLanes
{
public:
    static const int vector = 16 * ByteLanes::groups;
    static const int mostVectors = RangeProblem::mostCandidates / 16;

    //! Those of one pixel
    struct Pixel
    {
        ByteLanes of[count > 0 ? count : +mostVectors];
    };

    static int vectorsOf(const RangeProblem& problem) { return (problem.candidates + vector - 1) / vector; }

    explicit RangeLanes(const RangeProblem& problem) : vectors_(vectorsOf(problem))
    {
        CV_DbgAssert(vectors_ <= mostVectors && (count == 0 || vectors_ == count));
        uchar ends[vector] = {};
        std::fill(ends + (problem.candidates - (vectors_ - 1) * vector), ends + vector, (uchar)UCHAR_MAX);
        tail_ = ByteLanes::load(ends);
    }

    CV_ALWAYS_INLINE int vectors() const { return count > 0 ? count : vectors_; }
    CV_ALWAYS_INLINE ptrdiff_t bytes() const { return (ptrdiff_t)vectors() * vector; }

    CV_ALWAYS_INLINE void load(const uchar* from, Pixel& pixel) const
    {
        const int n = vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k) pixel.of[k] = ByteLanes::load(from + k * vector);
    }
    CV_ALWAYS_INLINE void store(const Pixel& pixel, uchar* to) const
    {
        const int n = vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k) pixel.of[k].store(to + k * vector);
    }
    //! a += b
    CV_ALWAYS_INLINE void add(const Pixel& b, Pixel& a) const
    {
        const int n = vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k) a.of[k] = a.of[k] + b.of[k];
    }
    //! The lowest lane, in all lanes
    CV_ALWAYS_INLINE ByteLanes lowest(const Pixel& pixel) const
    {
        const int n = vectors();
        ByteLanes least = pixel.of[n - 1];
        HDP_UNROLLED for (int k = 0; k < n - 1; ++k) least = least.min(pixel.of[k]);
        return least.minimumOfAll();
    }
    //! Fills the lanes behind the last candidate by 255.
    CV_ALWAYS_INLINE void closeTail(Pixel& pixel) const { pixel.of[vectors() - 1] = pixel.of[vectors() - 1] | tail_; }

private:
    const int vectors_;
    ByteLanes tail_;
};

/** C(p, h) of aggregateRange(), computed where it is needed.
@tparam count As of RangeLanes. */
template <int count> class RangeCosts
{
public:
    typedef RangeLanes<count> Lanes;
    typedef typename Lanes::Pixel Pixel;
    static const int parts = 3; // of a cost, of pixels (0, 0), (1, 1) and (1, 0) of the four below

    //! What gives those of a row of pixels
    struct Row
    {
        // Of the first pixel's parts
        const uchar *left[parts], *right[parts], *leftLimits[parts], *rightLimits[parts];
        const ushort* upper;
        const DisparityInterval* intervals; // or none

        const DisparityInterval* interval(int x) const { return intervals ? intervals + x : nullptr; }
    };

    explicit RangeCosts(const RangeProblem& problem) : p_(problem), lanes_(problem) {}

    Row row(int y) const
    {
        Row row = {};
        row.intervals = p_.intervals.empty() ? nullptr : p_.intervals.ptr<DisparityInterval>(y);
        const CensusCost& below = p_.below;
        const int last = below.size().width - 1;
        for (int i = 0; i < parts; ++i)
        {
            const int plane = i % below.planes(), dx = i > 0, yBelow = 2 * y + (i == 1);
            row.left[i] = below.leftPixels(yBelow) + 4 * dx + plane;
            row.right[i] = below.rightPlane(plane, yBelow) + last - dx;
            if (below.limits().isEmpty())
                continue;
            row.leftLimits[i] = below.limits().left(yBelow) + dx;
            row.rightLimits[i] = below.limits().right(yBelow) + last - dx;
        }
        row.upper = p_.upper.ptr<ushort>(std::min(y / 2, p_.upper.rows - 1));
        return row;
    }

    //! Those of a pixel
    CV_ALWAYS_INLINE void of(const Row& row, int x, Pixel& costs) const
    {
        lanes_.load(prior(row, x), costs);
        if (row.leftLimits[0])
            addLimitedBits(row, x, costs);
        else
            addBits(row, x, costs);
        if (row.intervals)
            excludeOthers(row.intervals[x], costs);
        lanes_.closeTail(costs);
    }

private:
    //! Of the candidates, from the layer above
    CV_ALWAYS_INLINE const uchar* prior(const Row& row, int x) const
    {
        const int lastUpper = p_.upper.cols - 1, unit = subpixelScale / 4; // of a candidate in the layer above
        const int predicted = (row.upper[std::min(x / 2, lastUpper)] + unit / 2) / unit;
        return p_.priors.data() + p_.candidates - std::min(predicted, p_.candidates);
    }

    //! Where part i of the census of a pixel differs, for some candidates from number k on
    CV_ALWAYS_INLINE ByteLanes differences(const Row& row, int i, int x, int k) const
    {
        return ByteLanes::repeat(row.left[i][8 * x]) ^ ByteLanes::load(row.right[i] - 2 * x + k);
    }

    CV_ALWAYS_INLINE void addBits(const Row& row, int x, Pixel& costs) const
    {
        const int n = lanes_.vectors();
        HDP_UNROLLED for (int k = 0; k < n; ++k)
        {
            const int at = k * Lanes::vector;
            const ByteLanes bits = ByteLanes::countBits(differences(row, 0, x, at), differences(row, 1, x, at),
                                                        differences(row, 2, x, at));
            costs.of[k] = costs.of[k] + (bits + bits);
        }
    }

    //! Where some pixels have no data: without any, nothing is predicted either.
    void addLimitedBits(const Row& row, int x, Pixel& costs) const
    {
        for (int k = 0; k < lanes_.vectors(); ++k)
        {
            const int at = k * Lanes::vector;
            ByteLanes bits = ByteLanes::repeat(0), haveData = bits, limit = ByteLanes::repeat(CostLimits::none);
            for (int i = 0; i < parts; ++i)
            {
                const ByteLanes hasData = ByteLanes::repeat(row.leftLimits[i][2 * x]);
                haveData = haveData | hasData;
                bits = bits + (differences(row, i, x, at).countBits() & hasData);
                limit = limit.min(ByteLanes::load(row.rightLimits[i] - 2 * x + at));
            }
            bits = bits.min(limit);
            costs.of[k] = (costs.of[k] & haveData) + (bits + bits);
        }
    }

    //! Candidates that are not in the interval
    CV_ALWAYS_INLINE void excludeOthers(const DisparityInterval& interval, Pixel& costs) const
    {
        const int n = lanes_.vectors(), first = std::min<int>(interval.first, p_.candidates),
                  end = std::min<int>(std::max(interval.last + 1, first), p_.candidates);
        const uchar *const before = p_.excludedBefore(first), *const behind = p_.excludedFrom(end);
        HDP_UNROLLED for (int k = 0; k < n; ++k)
        {
            const ptrdiff_t at = k * Lanes::vector;
            costs.of[k] = costs.of[k] | ByteLanes::load(before + at) | ByteLanes::load(behind + at);
        }
    }

    const RangeProblem& p_;
    const Lanes lanes_;
};

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
        const int height = rows.size(), bit = 2; // costs are halves of it
        enterBlock(rows, stripe);
        for (int x = width_ - 1; x >= 0; --x)
            for (int r = 0; r < height; ++r)
                followFromRight(rows_[r], x);
        for (int t = 0; t < width_ + height - 1; ++t)
        {
            const Range active(std::max(t - width_ + 1, 0), std::min(t + 1, height));
            for (int r = active.start; r < active.end; ++r)
                rows_[r].winner = finishPixel(rows_[r], t - r);
            for (int r = active.start; r < active.end; ++r)
                rows_[r].winners.set(t - r, rows_[r].sums, rows_[r].winner, p_.candidates - 1,
                                     rows_[r].costRow.interval(t - r));
        }
        for (int r = 0; r < height; ++r)
            rows_[r].winners.takeDisparities(width_, bit, 1, disparity.ptr<ushort>(rows.start + r));
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
        Winners winners;
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
            rows_[r] = { costs_.row(y),
                         edges(y, 0),
                         y > stripe.reach.start ? edges(y - 1, 1) : nullptr,
                         own_.costs(r),
                         own_.beside(r),
                         own_.sums(r),
                         own_.below(y - stripe.rows.start),
                         { own_.whole.data() + first, own_.rise.data() + first, own_.slope.data() + first },
                         0 };
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

    //! The direction from the right at a pixel: adds its E to that from below.
    CV_ALWAYS_INLINE void followFromRight(const Row& row, int x)
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
