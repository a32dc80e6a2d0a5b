// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "scanline_aggregation.hpp"
#include "../base/byte_lanes.simd.hpp"
#include "../base/vectorized.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/** What scanlines need to know of the windows of a row of the layer above, from column to column: where the candidates
begin, their prior and penalties, and which lane of the window before has the same disparity. A step is two columns of
the layer, a column of the layer above. */
class ScanlineWindows
{
public:
    typedef CandidateWindow Window;

    //! orders: see ScanlineScratch
    ScanlineWindows(const ScanlineProblem& problem, bool isUpward, const std::vector<uchar> (&orders)[Window::runs],
                    ScanlineScratch::Windows& scratch)
        : p_(problem), isUpward_(isUpward), pairs_((problem.size.width + 1) / 2),
          isContiguous_(scratch.isContiguous.data() + margin), small_(scratch.small.data() + margin),
          slopes_(scratch.slopes.data()), large_(scratch.large.data()), least_(scratch.least.data()),
          priors_(firstStep(scratch.priors)), intoSide_(firstStep(scratch.intoSide)),
          intoNext_(firstStep(scratch.intoNext))
    {
        for (int run = 0; run < Window::runs; ++run)
        {
            first_[run] = scratch.first[run].data() + margin;
            distance_[run] = scratch.distance[run].data();
            firstOfColumn_[run] = scratch.firstOfColumn[run].data();
            orders_[run] = orders[run].data() + orders[run].size() / 2;
        }
    }

    //! Enters a row of windows, and its weights. before: the one entered before it, if there is one
    void enter(const Window* row, const uchar* weights, const Window* before)
    {
        enterColumns(row);
        enterPenalties(weights);
        if (isUpward_)
            enterPriors(weights);
        enterSide(row);
        if (before)
            enterNext(row, before);
    }

    //! The first disparity of a run, and whether there is one, here and in the other rows of the block in the same step
    int first(int run, int step) const { return first_[run][step]; }
    bool isContiguous(int step) const { return isContiguous_[step] != 0; }
    //! The first disparity of a run, by column of the layer
    const short* firstOfColumn(int run) const { return firstOfColumn_[run]; }
    //! The small penalty, by column of the layer above
    const uchar* small() const { return small_; }
    //! With ScanlinePenalties::max, which is a part of all costs in a sweep
    const uchar* prior(int step) const { return ofStep(priors_, step); }
    //! Orders of lanes, 255 for candidates that the window before does not have: from the left in a sweep upward, from
    //! the right in one downward, and from the row before. Of the first step; see ofStep().
    const uchar* intoSide() const { return intoSide_; }
    const uchar* intoNext() const { return intoNext_; }
    /** large(p, q) between each pixel of a row of the layer and its neighbours to the right and in the next row.
    @param row Weights of the row's edges, of which those to the right are read.
    @param toNext Weights of those between it and the next row, which are those below of the upper one.
    @param edges Receives two penalties per pixel. */
    void edgePenalties(const uchar* row, const uchar* toNext, uchar* edges) const
    {
        const uchar *const slopes = slopes_, *const large = large_, *const least = least_;
        const ushort noise = (ushort)p_.penalties.edgeNoise;
        const int width = p_.size.width;
        const auto penalty = [&](ushort weight, int x) {
            const ushort fall = (ushort)((ushort)((ushort)(std::max(weight, noise) - noise) * slopes[x]) / 2);
            return (uchar)std::max((ushort)(std::max<ushort>(large[x], fall) - fall), (ushort)least[x]);
        };
        HDP_VECTORIZED for (int x = 0; x < width; ++x)
        {
            edges[2 * x] = penalty(row[2 * x], x);
            edges[2 * x + 1] = penalty(toNext[2 * x + 1], x);
        }
        edges[2 * width - 2] = 0; // there is no pixel
    }

    //! What is stored for the pixels of the layer above lies from right to left, as in the groups of a step.
    static CV_ALWAYS_INLINE const uchar* ofStep(const uchar* firstStep, int step)
    {
        return firstStep - (ptrdiff_t)step * Window::candidates;
    }

private:
    static const int margin = ScanlineScratch::margin;
    static const int mostDistance = 3 * Window::candidates / 2 * subpixelScale; // of a candidate from its prediction

    // Bytes may alias everything but what is local.

    //! Where the candidates begin
    void enterColumns(const Window* windows) const
    {
        const int pairs = pairs_, length = Window::runLength;
        const short* const members = windows->first; // first, then predicted
        for (int run = 0; run < Window::runs; ++run)
        {
            short *const first = first_[run], *const distance = distance_[run];
            HDP_VECTORIZED for (int x = 0; x < pairs; ++x)
            {
                const short begin = members[4 * x + run];
                const int predicted = (ushort)members[4 * x + Window::runs + run];
                first[x] = begin;
                distance[x] = (short)clamped(begin * subpixelScale - predicted, -mostDistance, mostDistance - 1);
            }
            short* const firstOfColumn = firstOfColumn_[run];
            HDP_VECTORIZED for (int x = 0; x < pairs; ++x) firstOfColumn[2 * x] = firstOfColumn[2 * x + 1] = first[x];
        }
        const short *const low = first_[0], *const high = first_[1]; // 0 in the column before
        uchar* const isContiguous = isContiguous_;
        const bool isSingle = ByteLanes::groups == 1;
        HDP_VECTORIZED for (int x = 0; x < pairs; ++x) isContiguous[x] =
            (uchar)((high[x] - low[x] == length) & (isSingle | (high[x - 1] - low[x - 1] == length)));
        uchar* const slopes = slopes_;
        const uchar edgeSlope = (uchar)p_.penalties.edgeSlope, borderSlope = (uchar)p_.penalties.borderSlope;
        HDP_VECTORIZED for (int x = 0; x < pairs; ++x) slopes[2 * x] = slopes[2 * x + 1] =
            high[x] - low[x] == length ? edgeSlope : borderSlope;
    }

    //! small(p) and large(p); weights: SmoothnessWeight by column of the layer above
    void enterPenalties(const uchar* weights) const
    {
        const int pairs = pairs_;
        uchar *const small = small_, *const large = large_, *const least = least_;
        const ushort ofSmall = (ushort)p_.penalties.small, ofLarge = (ushort)p_.penalties.large;
        const auto weighed = [](ushort penalty, ushort weight) {
            const ushort product = (ushort)(penalty * weight + SmoothnessWeight::one / 2);
            return (uchar)std::min<ushort>(product / SmoothnessWeight::one, ScanlinePenalties::max);
        };
        HDP_VECTORIZED for (int x = 0; x < pairs; ++x) small[x] = weighed(ofSmall, weights[x]);
        HDP_VECTORIZED for (int x = 0; x < pairs; ++x)
        {
            const uchar own = weighed(ofLarge, weights[x]);
            large[2 * x] = large[2 * x + 1] = own;
            least[2 * x] = least[2 * x + 1] = std::min(small[x], own);
        }
    }

    void enterPriors(const uchar* weights) const
    {
        uchar* const priors = priors_;
        const short *const low = first_[0], *const high = first_[1];
        const short *const ofLow = distance_[0], *const ofHigh = distance_[1];
        const int pairs = pairs_, lanesUsed = p_.validCandidates();
        const ushort ofPrior = (ushort)p_.penalties.prior;
        const uchar ofNearer = (uchar)p_.penalties.nearer;
        for (int x = 0; x < pairs; ++x)
        {
            const ushort slope = (ushort)(ofPrior * weights[x]);
            const bool isNearer = high[x] - low[x] > Window::runLength;
            uchar* const prior = priors - (ptrdiff_t)x * Window::candidates;
            enterPrior(ofLow[x], slope, 0, prior);
            enterPrior(ofHigh[x], slope, isNearer ? ofNearer : 0, prior + Window::runLength);
        }
        if (lanesUsed < Window::candidates)
            for (int x = 0; x < pairs; ++x)
                std::fill_n(priors - (ptrdiff_t)x * Window::candidates + lanesUsed, Window::candidates - lanesUsed,
                            (uchar)255);
    }

    //! Of a run whose first candidate is so far from what was predicted; slope: of the prior, with its weight
    static CV_ALWAYS_INLINE void enterPrior(short distance, ushort slope, uchar nearer, uchar* prior)
    {
        const int unit = 2 * subpixelScale * SmoothnessWeight::one, shifted = (1 << 16) / unit;
        const uchar ofAll = (uchar)(ScanlinePenalties::max + nearer);
        ushort lanes[Window::runLength];
        HDP_VECTORIZED for (int i = 0; i < Window::runLength; ++i)
        {
            const short away = (short)(distance + i * subpixelScale);
            const ushort shiftedAway = (ushort)((ushort)std::max(away, (short)-away) * shifted);
            lanes[i] = (ushort)(((unsigned)shiftedAway * slope) >> 16);
        }
        HDP_VECTORIZED for (int i = 0; i < Window::runLength; ++i) prior[i] = (uchar)(ofAll + lanes[i]);
    }

    //! The lanes of a window
    struct Lanes
    {
        const uchar* of[Window::runs]; // that of a disparity, or 255, for each run

        Lanes(const Window& window, const uchar* low, const uchar* high)
            : of{ low - window.first[0], high - window.first[1] }
        {
        }

        //! Which of them have the candidates of `to`
        CV_ALWAYS_INLINE void order(const Window& to, uchar* order) const
        {
            for (int run = 0; run < Window::runs; ++run)
            {
                uint64 lanes[Window::runs];
                for (int own = 0; own < Window::runs; ++own)
                    std::memcpy(&lanes[own], of[own] + to.first[run], Window::runLength);
                lanes[0] &= lanes[1]; // runs do not overlap: at least one of the two is 255
                std::memcpy(order + run * Window::runLength, &lanes[0], Window::runLength);
            }
        }
    };

    //! The windows before, along a row, have the lanes in a sweep upward, and those behind in one downward.
    void enterSide(const Window* row)
    {
        const uchar *const low = orders_[0], *const high = orders_[1];
        uchar* const intoSide = intoSide_;
        const bool isUpward = isUpward_;
        Window before = row[0];
        Lanes lanesBefore(before, low, high);
        for (int x = 0, pairs = pairs_; x < pairs; ++x)
        {
            uchar* const here = intoSide - (ptrdiff_t)x * Window::candidates;
            const Lanes lanes(row[x], low, high);
            if (isUpward)
                lanesBefore.order(row[x], here);
            else
                lanes.order(before, here + Window::candidates);
            before = row[x];
            lanesBefore = lanes;
        }
    }

    void enterNext(const Window* row, const Window* rowBefore)
    {
        const uchar *const low = orders_[0], *const high = orders_[1];
        uchar* const intoNext = intoNext_;
        for (int x = 0, pairs = pairs_; x < pairs; ++x)
            Lanes(rowBefore[x], low, high).order(row[x], intoNext - (ptrdiff_t)x * Window::candidates);
    }

    uchar* firstStep(std::vector<uchar>& stored) const
    {
        return stored.data() + (ptrdiff_t)(pairs_ - 1 + margin) * Window::candidates;
    }

    const ScanlineProblem& p_;
    const bool isUpward_;
    const int pairs_; // of columns
    // The scratch memory, from column or step 0 on
    short *first_[Window::runs], *distance_[Window::runs], *firstOfColumn_[Window::runs];
    uchar *const isContiguous_, *const small_, *const slopes_, *const large_, *const least_;
    uchar *const priors_, *const intoSide_, *const intoNext_;
    const uchar* orders_[Window::runs]; // of a run, by the distance of the candidates
};

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
