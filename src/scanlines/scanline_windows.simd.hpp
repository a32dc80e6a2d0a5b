// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "scanline_aggregation.hpp"
#include "../base/vectorized.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/** What scanlines need to know of the windows of a row of the layer above, from column to column: where the candidates
begin, their prior, and which lane of the window before has the same disparity. A step is two columns of the layer, a
column of the layer above. */
class ScanlineWindows
{
public:
    typedef CandidateWindow Window;
    typedef ScanlineScratch::Column Column;

    //! groups: rows of a block
    ScanlineWindows(const ScanlineProblem& problem, int groups, ScanlineScratch& scratch)
        : p_(problem), groups_(groups), pairs_((problem.size.width + 1) / 2), columns_(scratch.columns.data() + margin),
          priors_(firstStep(scratch.priors)), intoRight_(firstStep(scratch.intoRight)),
          intoLeft_(firstStep(scratch.intoLeft)), intoBelow_(firstStep(scratch.intoBelow))
    {
        for (int run = 0; run < Window::runs; ++run)
        {
            first_[run] = scratch.first[run].data();
            orders_[run] = scratch.orders[run].data() + scratch.orders[run].size() / 2;
        }
        preparePriorTable();
    }

    //! Enters a row of windows. above: the row before, if there is one; isFollowed: for the vertical direction alone
    void enter(const Window* row, const Window* above, bool isFollowed)
    {
        // Bytes may alias everything but what is local.
        const uchar* const orders[Window::runs] = { orders_[0], orders_[1] };
        // An odd last column belongs to the pixel of the layer above that the one before belongs to.
        const int pairs = pairs_, lastWindow = p_.windows->cols - 1;
        const int lanesUsed = p_.validCandidates();
        Column* column = columns_;
        short *firstOfLow = first_[0], *firstOfHigh = first_[1];
        uchar *prior = priors_, *intoRight = intoRight_, *intoLeft = intoLeft_ + Window::candidates,
              *intoBelow = intoBelow_;
        Window before = row[0];
        bool wasContiguous = false; // the window before
        for (int x = 0; x < pairs; ++x)
        {
            const Window own = row[std::min(x, lastWindow)];
            const bool isContiguous = own.isContiguous();
            column->first[0] = own.first[0];
            column->first[1] = own.first[1];
            column->isContiguous = isContiguous & (groups_ == 1 || wasContiguous);
            firstOfLow[0] = firstOfLow[1] = own.first[0];
            firstOfHigh[0] = firstOfHigh[1] = own.first[1];

            for (int run = 0; run < Window::runs; ++run)
                std::memcpy(prior + run * Window::runLength, priorOf(own, run), Window::runLength);
            for (int i = lanesUsed; i < Window::candidates; ++i)
                prior[i] = 255;

            if (!isFollowed)
            {
                transition(orders, before, own, intoRight);
                transition(orders, own, before, intoLeft);
            }
            if (above)
                transition(orders, above[std::min(x, lastWindow)], own, intoBelow);

            ++column;
            firstOfLow += 2;
            firstOfHigh += 2;
            prior -= Window::candidates;
            intoRight -= Window::candidates;
            intoLeft -= Window::candidates;
            intoBelow -= Window::candidates;
            before = own;
            wasContiguous = isContiguous;
        }
    }

    const Column& column(int step) const { return columns_[step]; }
    //! The first disparity of a run, by column of the layer
    const short* first(int run) const { return first_[run]; }
    //! With the large penalty, which is a part of all costs in a sweep
    const uchar* prior(int step) const { return ofStep(priors_, step); }
    //! Orders of lanes, 255 for candidates that the window before does not have: from the left, from the right, and
    //! from the row before
    const uchar* intoRight(int step) const { return ofStep(intoRight_, step); }
    const uchar* intoLeft(int step) const { return ofStep(intoLeft_, step); }
    const uchar* intoBelow(int step) const { return ofStep(intoBelow_, step); }

private:
    enum
    {
        margin = ScanlineScratch::margin,
        priorRange = 3 * Window::candidates / 2 * subpixelScale
    };

    //! The prior of a run, by the distance of its first candidate from the predicted disparity; with the large penalty,
    //! which is a part of all costs in a sweep.
    void preparePriorTable()
    {
        for (int distance = -priorRange; distance < priorRange; ++distance)
            for (int i = 0; i < Window::runLength; ++i)
                priorTable_[distance + priorRange][i] =
                    (uchar)(p_.penalties.large +
                            p_.penalties.prior * std::abs(distance + i * subpixelScale) / (2 * subpixelScale));
    }

    const uchar* priorOf(const Window& own, int run) const
    {
        const int distance = own.first[run] * subpixelScale - own.predicted[run];
        return priorTable_[clamped(distance, -priorRange, priorRange - 1) + priorRange];
    }

    //! Which lanes of `from` have the candidates of `to`
    static void transition(const uchar* const (&orders)[Window::runs], const Window& from, const Window& to,
                           uchar* order)
    {
        for (int run = 0; run < Window::runs; ++run)
        {
            uint64 lanesOf[Window::runs];
            for (int other = 0; other < Window::runs; ++other)
                std::memcpy(&lanesOf[other], orders[other] + to.first[run] - from.first[other], Window::runLength);
            lanesOf[0] &= lanesOf[1]; // runs do not overlap: at least one of the two is 255
            std::memcpy(order + run * Window::runLength, &lanesOf[0], Window::runLength);
        }
    }

    //! What is stored for the pixels of the layer above lies from right to left, as in the groups of a step.
    uchar* firstStep(std::vector<uchar>& stored) const
    {
        return stored.data() + (ptrdiff_t)(pairs_ - 1 + margin) * Window::candidates;
    }
    static const uchar* ofStep(const uchar* firstStep, int step)
    {
        return firstStep - (ptrdiff_t)step * Window::candidates;
    }

    const ScanlineProblem& p_;
    const int groups_, pairs_; // pairs of columns
    // The scratch memory, from column or step 0 on
    Column* const columns_;
    uchar *const priors_, *const intoRight_, *const intoLeft_, *const intoBelow_;
    short* first_[Window::runs];
    const uchar* orders_[Window::runs]; // of a run, by the distance of the candidates
    uchar priorTable_[2 * priorRange][Window::runLength];
};

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
