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
    static const int parts = 3; // of a cost, of pixels (0, 0), (1, 1) and (1, 0) of the four below

    //! What gives those of a row of pixels
    struct Row
    {
        // Of the first pixel's parts
        const uchar *left[parts], *right[parts], *leftLimits[parts], *rightLimits[parts];
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

    //! Where some pixels have no data
    void addLimitedBits(const Row& row, int x, Pixel& costs) const
    {
        for (int k = 0; k < lanes_.vectors(); ++k)
        {
            const int at = k * Lanes::vector;
            ByteLanes bits = ByteLanes::repeat(0), limit = ByteLanes::repeat(CostLimits::none);
            for (int i = 0; i < parts; ++i)
            {
                const ByteLanes hasData = ByteLanes::repeat(row.leftLimits[i][2 * x]);
                bits = bits + (differences(row, i, x, at).countBits() & hasData);
                limit = limit.min(ByteLanes::load(row.rightLimits[i] - 2 * x + at));
            }
            bits = bits.min(limit);
            costs.of[k] = costs.of[k] + (bits + bits);
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

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
