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

/** The directions over a stripe. Rows are followed in blocks, side by side: so one does not wait for the minimum of
another. */
class RangeSweep
{
public:
    RangeSweep(const RangeProblem& problem, RangeScratch& scratch)
        : p_(problem), own_(scratch), width_(problem.size.width), costBytes_(problem.costBytes()),
          small_(ByteLanes::repeat(problem.small))
    {
        for (int r = 0; r <= block; ++r)
            above_[r] = own_.line(problem, r);
        for (int r = 0; r < block; ++r)
        {
            right_[r] = own_.line(problem, block + 1 + r);
            left_[r] = own_.line(problem, 2 * block + 1 + r);
        }
    }

    //! From below, over the rows of a stripe's reach; those of the stripe are kept.
    void followUpward(const ScanlineStripe& stripe)
    {
        begin(above_[0]);
        Line before = above_[0];
        for (int y = stripe.reach.end - 1; y >= stripe.rows.start; --y)
        {
            const Line here = y < stripe.rows.end ? below(y - stripe.rows.start) : above_[1];
            followVertical(y, 1, before, here);
            before = here;
            std::swap(above_[0], above_[1]);
        }
    }

    //! From above, over the rows of its reach before a stripe
    void warmUp(const ScanlineStripe& stripe)
    {
        begin(above_[0]);
        for (int y = stripe.reach.start; y < stripe.rows.start; ++y)
        {
            followVertical(y, 1 - 2 * width_, above_[0], above_[1]);
            std::swap(above_[0], above_[1]);
        }
    }

    //! All directions of a block of rows, and their winners; first: of the stripe
    void run(const Range& rows, int first, Mat& disparity)
    {
        const int count = rows.size();
        for (int r = 0; r < count; ++r)
        {
            computeCosts(rows.start + r, costs(r));
            begin(left_[r], 1);
            beginPixel(right_[r], width_);
        }
        for (int x = width_ - 1; x >= 0; --x)
            for (int r = 0; r < count; ++r)
                step(costs(r, x), x + 1 < width_ ? largeOf(rows.start + r, x, 0) : 0, right_[r], x + 1, right_[r], x);
        for (int x = 0; x < width_; ++x)
            for (int r = 0; r < count; ++r)
                finishPixel(rows.start + r, x, r, below(rows.start + r - first));
        for (int r = 0; r < count; ++r)
            takeDisparities(r, disparity.ptr<ushort>(rows.start + r));
        std::swap(above_[0], above_[count]);
    }

private:
    typedef RangeScratch::Line Line;
    enum
    {
        vector = 16 * ByteLanes::groups,
        block = RangeScratch::block
    };

    uchar* costs(int r, int x = 0) const { return own_.costs.data() + ((size_t)r * width_ + x) * costBytes_; }
    Line below(int row) const { return own_.line(p_, 3 * block + 1 + row); }
    uchar* at(const Line& line, int x) const { return line.costs + x * (size_t)(costBytes_ + RangeProblem::row); }

    //! L of what is before the first pixel: L = C follows, whatever the penalties are.
    void beginPixel(const Line& line, int x) const
    {
        std::fill_n(at(line, x), costBytes_, (uchar)0);
        line.minima[x] = 0;
    }
    void begin(const Line& line, int pixels) const
    {
        for (int x = 0; x < pixels; ++x)
            beginPixel(line, x);
    }
    void begin(const Line& line) const { begin(line, width_); }

    //! C(p, h) of a row
    void computeCosts(int y, uchar* costs) const
    {
        const int planes = p_.below.planes();
        if (p_.below.limits().isEmpty())
            planes == 1   ? computeCosts<1, false>(y, costs)
            : planes == 2 ? computeCosts<2, false>(y, costs)
                          : computeCosts<3, false>(y, costs);
        else
            planes == 1   ? computeCosts<1, true>(y, costs)
            : planes == 2 ? computeCosts<2, true>(y, costs)
                          : computeCosts<3, true>(y, costs);
        if (!p_.intervals.empty())
            excludeOthers(p_.intervals.ptr<DisparityInterval>(y), costs);
    }

    //! A row of the layer below
    struct RowBelow
    {
        const uchar *left, *right, *leftLimits, *rightLimits; // of its first pixel

        RowBelow(const CensusCost& cost, int y)
            : left(cost.leftPixels(y)), right(cost.rightPlane(0, y) + cost.size().width - 1), leftLimits(nullptr),
              rightLimits(nullptr)
        {
            if (cost.limits().isEmpty())
                return;
            leftLimits = cost.limits().left(y);
            rightLimits = cost.limits().right(y) + cost.size().width - 1;
        }
    };

    //! A pixel of it; what is stored elsewhere meanwhile does not change it.
    template <int planes, bool hasLimits> struct PixelBelow
    {
        ByteLanes left[planes], leftLimit;
        const uchar *right[planes], *rightLimits;

        CV_ALWAYS_INLINE PixelBelow(const RowBelow& row, int x, size_t planeStride)
        {
            for (int k = 0; k < planes; ++k)
            {
                left[k] = ByteLanes::repeat(row.left[4 * x + k]);
                right[k] = row.right - x + k * planeStride;
            }
            if (!hasLimits)
                return;
            leftLimit = ByteLanes::repeat(row.leftLimits[x]);
            rightLimits = row.rightLimits - x;
        }

        //! C' of some candidates from d on
        CV_ALWAYS_INLINE ByteLanes costs(int d) const
        {
            ByteLanes cost = (left[0] ^ ByteLanes::load(right[0] + d)).countBits();
            for (int k = 1; k < planes; ++k)
                cost = cost + (left[k] ^ ByteLanes::load(right[k] + d)).countBits();
            return hasLimits ? cost.min(leftLimit).min(ByteLanes::load(rightLimits + d)) : cost;
        }
    };

    template <int planes, bool hasLimits> void computeCosts(int y, uchar* costs) const
    {
        const RowBelow first(p_.below, 2 * y), last(p_.below, 2 * y + 1);
        const size_t planeStride = p_.below.planeStride();
        const ushort* const upper = p_.upper.ptr<ushort>(std::min(y / 2, p_.upper.rows - 1));
        const uchar* const priors = p_.priors.data() + p_.candidates;
        const int width = width_, candidates = p_.candidates, costBytes = costBytes_, lastUpper = p_.upper.cols - 1,
                  unit = subpixelScale / 4; // of a candidate in the layer above
        for (int x = 0; x < width; ++x, costs += costBytes)
        {
            const int predicted = (upper[std::min(x / 2, lastUpper)] + unit / 2) / unit;
            const uchar* const prior = priors - std::min(predicted, candidates);
            const PixelBelow<planes, hasLimits> a(first, 2 * x, planeStride), b(last, 2 * x + 1, planeStride);
            for (int d = 0; d < costBytes; d += vector)
                (a.costs(d) + b.costs(d) + ByteLanes::load(prior + d)).store(costs + d);
            std::fill(costs + candidates, costs + costBytes, (uchar)UCHAR_MAX);
        }
    }

    void excludeOthers(const DisparityInterval* intervals, uchar* costs) const
    {
        const int candidates = p_.candidates;
        for (int x = 0; x < width_; ++x, costs += costBytes_)
        {
            std::fill(costs, costs + std::min<int>(intervals[x].first, candidates), (uchar)UCHAR_MAX);
            std::fill(costs + std::min(intervals[x].last + 1, candidates), costs + candidates, (uchar)UCHAR_MAX);
        }
    }

    //! L of a pixel in a direction, from that of the pixel before
    CV_ALWAYS_INLINE void step(const uchar* costs, int large, const Line& before, int xBefore, const Line& line,
                               int x) const
    {
        const int least = before.minima[xBefore], count = costBytes_;
        const uchar* const from = at(before, xBefore);
        uchar* const here = at(line, x);
        const ByteLanes leastOfAll = ByteLanes::repeat(least), jump = ByteLanes::repeat(std::min(least + large, 255)),
                        small = small_;
        ByteLanes minimum = ByteLanes::repeat(UCHAR_MAX);
        for (int d = 0; d < count; d += vector)
        {
            const ByteLanes beside = ByteLanes::load(from + d - 1).min(ByteLanes::load(from + d + 1)) + small;
            const ByteLanes best = ByteLanes::load(from + d).min(beside).min(jump);
            const ByteLanes l = ByteLanes::load(costs + d) + (best - leastOfAll);
            l.store(here + d);
            minimum = minimum.min(l);
        }
        line.minima[x] = (uchar)minimum.lowest();
    }

    //! The large penalty of an edge of a pixel, which is `edge` from twice its number, see weighEdges()
    int largeOf(int y, int x, int edge) const
    {
        return p_.large[p_.weights.ptr()[2 * (y * (ptrdiff_t)width_ + x) + edge]];
    }

    void followVertical(int y, int edge, const Line& before, const Line& here)
    {
        computeCosts(y, costs(0));
        const bool isInside = edge > 0 ? y + 1 < p_.size.height : y > 0;
        for (int x = 0; x < width_; ++x)
            step(costs(0, x), isInside ? largeOf(y, x, edge) : 0, before, x, here, x);
    }

    //! From the left and from above, and the winner
    void finishPixel(int y, int x, int r, const Line& below)
    {
        const Line &left = left_[r], &right = right_[r], &above = above_[r + 1];
        const int to = (x + 1) & 1;
        step(costs(r, x), x > 0 ? largeOf(y, x, -2) : 0, left, x & 1, left, to);
        step(costs(r, x), y > 0 ? largeOf(y, x, 1 - 2 * width_) : 0, above_[r], x, above, x);
        const uchar* const lines[] = { at(left, to), at(right, x), at(above, x), at(below, x) };
        const ByteLanes minima[] = { ByteLanes::repeat(left.minima[to]), ByteLanes::repeat(right.minima[x]),
                                     ByteLanes::repeat(above.minima[x]), ByteLanes::repeat(below.minima[x]) };
        uchar* const sums = own_.sums.data();
        const int count = costBytes_;
        ByteLanes minimum = ByteLanes::repeat(UCHAR_MAX);
        for (int d = 0; d < count; d += vector)
        {
            const auto excess = [&](int i) { return ByteLanes::load(lines[i] + d) - minima[i]; };
            const ByteLanes sum = (excess(0) + excess(1)) + (excess(2) + excess(3));
            sum.store(sums + d);
            minimum = minimum.min(sum);
        }
        setWinner(std::min(positionOf(minimum.lowest()), p_.candidates - 1), r, x);
    }

    //! Of the first sum that is this
    int positionOf(int lowest) const
    {
        const uchar* const sums = own_.sums.data();
        const ByteLanes searched = ByteLanes::repeat(lowest);
        for (int d = 0; d < costBytes_; d += vector)
        {
            const int lane = ByteLanes::load(sums + d).firstEqual(searched);
            if (lane >= 0)
                return d + lane;
        }
        return 0;
    }

    void setWinner(int winner, int r, int x)
    {
        const WinnerSlope beside = slopeOfWinner(own_.sums.data(), winner, p_.candidates - 1);
        const size_t i = (size_t)r * width_ + x;
        own_.whole[i] = (ushort)winner;
        own_.rise[i] = (short)beside.rise;
        own_.slope[i] = (short)beside.slope;
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

    const RangeProblem& p_;
    RangeScratch& own_;
    const int width_, costBytes_;
    const ByteLanes small_;
    Line above_[block + 1], right_[block], left_[block];
};

} // namespace

void aggregateRangeStripe(const RangeProblem& problem, const ScanlineStripe& stripe, RangeScratch& scratch,
                          Mat& disparity)
{
    const Range& rows = stripe.rows;
    RangeSweep sweep(problem, scratch);
    sweep.followUpward(stripe);
    sweep.warmUp(stripe);
    for (int y = rows.start; y < rows.end; y += RangeScratch::block)
        sweep.run(Range(y, std::min(y + RangeScratch::block, rows.end)), rows.start, disparity);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
