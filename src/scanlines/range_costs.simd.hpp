// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "range_scanlines.hpp"
#include "../base/byte_lanes.simd.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/** The candidates of pixels, in vectors of bytes.
@tparam count Vectors of a pixel, which then stay in registers; 0 for any number. */
template <int count> class RangeLanes
{
public:
    enum
    {
        vector = 16 * ByteLanes::groups,
        mostVectors = RangeProblem::mostCandidates / 16
    };

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
        std::fill(ends + problem.candidates - (vectors_ - 1) * vector, ends + vector, (uchar)UCHAR_MAX);
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

    //! What gives those of a row of pixels
    struct Row
    {
        const uchar *left[2], *right[2], *leftLimits[2], *rightLimits[2]; // of the first pixel of two rows below
        const ushort* upper;
        const DisparityInterval* intervals;
    };

    explicit RangeCosts(const RangeProblem& problem) : p_(problem), lanes_(problem) {}

    Row row(int y) const
    {
        Row row = {};
        row.intervals = p_.intervals.empty() ? nullptr : p_.intervals.ptr<DisparityInterval>(y);
        const CensusCost& below = p_.below;
        const int last = below.size().width - 1;
        for (int i = 0; i < 2; ++i)
        {
            row.left[i] = below.leftPixels(2 * y + i);
            row.right[i] = below.rightPlane(0, 2 * y + i) + last;
            if (below.limits().isEmpty())
                continue;
            row.leftLimits[i] = below.limits().left(2 * y + i);
            row.rightLimits[i] = below.limits().right(2 * y + i) + last;
        }
        row.upper = p_.upper.ptr<ushort>(std::min(y / 2, p_.upper.rows - 1));
        return row;
    }

    //! Those of a pixel
    CV_ALWAYS_INLINE void of(const Row& row, int x, Pixel& costs) const
    {
        if (row.leftLimits[0])
            ofMasked(row, x, costs);
        else
        {
            lanes_.load(prior(row, x), costs);
            addCensus(row, 0, x, costs);
            addCensus(row, 1, x, costs);
        }
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

    //! C'(q, .) of the pixel q of row number i below, added to the costs
    CV_ALWAYS_INLINE void addCensus(const Row& row, int i, int x, Pixel& costs) const
    {
        const int n = lanes_.vectors(), xBelow = 2 * x + i, planes = p_.below.planes();
        const size_t stride = p_.below.planeStride();
        const uchar *const left = row.left[i] + 4 * xBelow, *const right = row.right[i] - xBelow;
        if (planes == 3)
        {
            const ByteLanes first = ByteLanes::repeat(left[0]), second = ByteLanes::repeat(left[1]),
                            third = ByteLanes::repeat(left[2]);
            HDP_UNROLLED for (int k = 0; k < n; ++k)
            {
                const uchar* const from = right + k * Lanes::vector;
                costs.of[k] = costs.of[k] + ByteLanes::countBits(first ^ ByteLanes::load(from),
                                                                 second ^ ByteLanes::load(from + stride),
                                                                 third ^ ByteLanes::load(from + 2 * stride));
            }
            return;
        }
        for (int plane = 0; plane < planes; ++plane)
        {
            const ByteLanes census = ByteLanes::repeat(left[plane]);
            const uchar* const from = right + plane * stride;
            HDP_UNROLLED for (int k = 0; k < n; ++k) costs.of[k] =
                costs.of[k] + (census ^ ByteLanes::load(from + k * Lanes::vector)).countBits();
        }
    }

    //! Where some pixels have no data
    void ofMasked(const Row& row, int x, Pixel& costs) const
    {
        const int n = lanes_.vectors();
        lanes_.load(prior(row, x), costs);
        for (int i = 0; i < 2; ++i)
        {
            Pixel below;
            std::fill_n(below.of, n, ByteLanes::repeat(0));
            addCensus(row, i, x, below);
            const ByteLanes left = ByteLanes::repeat(row.leftLimits[i][2 * x + i]);
            const uchar* const right = row.rightLimits[i] - (2 * x + i);
            for (int k = 0; k < n; ++k)
                below.of[k] = below.of[k].min(left).min(ByteLanes::load(right + k * Lanes::vector));
            lanes_.add(below, costs);
        }
    }

    //! Candidates that are not in the interval
    CV_ALWAYS_INLINE void excludeOthers(const DisparityInterval& interval, Pixel& costs) const
    {
        const int n = lanes_.vectors(), first = std::min<int>(interval.first, p_.candidates),
                  end = std::min<int>(std::max(interval.last + 1, first), p_.candidates);
        const uchar *const before = p_.insideFrom(first), *const behind = p_.outsideFrom(end);
        HDP_UNROLLED for (int k = 0; k < n; ++k)
        {
            const ptrdiff_t at = k * Lanes::vector;
            costs.of[k] = costs.of[k] | ByteLanes::load(before + at) | ByteLanes::load(behind + at);
        }
    }

    const RangeProblem& p_;
    const Lanes lanes_;
};

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
