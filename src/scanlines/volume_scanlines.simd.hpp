// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "volume_scanlines.hpp"
#include "winner_fraction.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/sixteen_words.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! The directions from the left and from the right over some rows, to the sums. lines: memory, see
//! VolumeProblem::lineMemory()
void aggregateRows(const VolumeProblem& problem, const Range& rows, short* lines);

//! Those from above and from below over some columns, added to the sums, and the winners
void aggregateColumns(const VolumeProblem& problem, const Range& columns, short* lines);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** Follows a block of scanlines side by side, pixel by pixel: so one does not wait for the minimum of another.

A cost is at most 255, and L(p, d) - C(p, d) at most large(p, q), so L is at most 255 + VolumePenalties::largest = 1055,
L + small at most 1855, and the sum of four directions at most 4220.

Behind the last candidate, to the end of the vector, and before and behind the vectors, L is more than that. */
class LineBlock
{
public:
    typedef SixteenWords Words; // of a chunk of the volume
    static_assert((int)Words::count == (int)CostVolume::chunk, "Pixels have whole ones.");

    //! The pixels of a direction: number i of scanline k is first + i * along + k * across. The edge to it from the
    //! one before is number 2 * pixel + edge.
    struct Direction
    {
        ptrdiff_t first, along, across, edge;
    };
    enum Role
    {
        FIRST,  // begins the sums
        MIDDLE, // adds to them
        LAST    // takes the winners, of scanlines that are side by side in memory
    };

    //! lines: memory for L of the last pixel of each scanline, L of this pixel of each, the sums of a pixel, and zeros
    //! that end with a margin of none, in lines of lineLength()
    LineBlock(const VolumeProblem& problem, int scanlines, int length, short* lines)
        : p_(problem), scanlines_(scanlines), length_(length), lineLength_(problem.lineLength()),
          before_(lines + margin), here_(before_ + scanlines * (ptrdiff_t)lineLength_),
          total_(lines + 2 * scanlines * (ptrdiff_t)lineLength_), padding_(total_ + 2 * lineLength_ - margin)
    {
        std::fill(total_ + lineLength_, padding_, (short)0);
        std::fill(padding_, padding_ + margin, +none);
        for (int k = 0; k < Words::count; ++k)
            lanes_[k] = (short)k;
    }

    template <int role> void follow(const Direction& direction)
    {
        switch (p_.volume.stride() / Words::count) // 2, 3, 4 and 8 of 16 candidates are usual
        {
        case 2:
            return follow<role, 2>(direction);
        case 3:
            return follow<role, 3>(direction);
        case 4:
            return follow<role, 4>(direction);
        case 8:
            return follow<role, 8>(direction);
        default:
            return follow<role, 0>(direction);
        }
    }

private:
    //! vectors: their number per pixel, if the compiler is to know it; else 0
    template <int role, int vectors> void follow(const Direction& direction)
    {
        // Local, as stores may alias all else
        const CostVolume& volume = p_.volume;
        const int stride = vectors > 0 ? vectors * Words::count : volume.stride(),
                  halving = volume.steps == 2; // of whole and fraction
        const uchar *const weights = p_.weights, *const costs = volume.costs.data();
        short *const sums = p_.sums, *const total = total_;
        ushort* const disparity = p_.disparity;
        CV_DbgAssert(volume.intervals.empty() || volume.intervals.isContinuous());
        const DisparityInterval* const intervals = volume.intervals.ptr<DisparityInterval>(); // or none
        const ptrdiff_t lineLength = lineLength_;
        const int scanlines = scanlines_, length = length_, last = volume.numDisparities - 1;
        const Words small = Words::repeat(p_.small);
        short *before = before_, *here = here_;
        int minima[VolumeProblem::maxScanlines] = {}; // of L of the pixel before
        ushort whole[VolumeProblem::maxScanlines];
        short rise[VolumeProblem::maxScanlines], slope[VolumeProblem::maxScanlines];
        const Winners winners = { whole, rise, slope }; // of the pixels side by side
        beginLines();

        for (int i = 0; i < length; ++i)
        {
            const ptrdiff_t first = direction.first + i * direction.along;
            ptrdiff_t pixel = first;
            for (int k = 0; k < scanlines; ++k, pixel += direction.across)
            {
                const ptrdiff_t start = pixel * stride;
                const int large = p_.large[weights[i > 0 ? 2 * pixel + direction.edge : 0]];
                const Pixel own = { costs + start, sums + start, role == LAST ? total : sums + start };
                const int winner =
                    step<role, vectors>(own, small, large, before + k * lineLength, here + k * lineLength, minima[k]);
                if (role == LAST)
                    winners.set(k, total, winner, last, intervals ? intervals + pixel : nullptr);
            }
            if (role == LAST)
                winners.takeDisparities(scanlines, CostVolume::scale, halving, disparity + first);
            std::swap(before, here);
        }
    }

    struct Pixel
    {
        const uchar* costs;
        const short* sums;
        short* into; // the new sums
    };

    //! L of a disparity that is no candidate: more than any other, and four of them and a penalty fit into 16 bits.
    static const short none = 0x1f00;

    //! The first pixels have L = C, whatever the penalties; the margins stay as they are.
    void beginLines()
    {
        std::fill(before_ - margin, here_ - margin + scanlines_ * (ptrdiff_t)lineLength_, +none);
        for (int k = 0; k < scanlines_; ++k)
            std::fill_n(before_ + k * (ptrdiff_t)lineLength_, p_.volume.numDisparities, (short)0);
    }

    //! L of a pixel, from that of the pixel before; in the last direction, returns the first of the lowest sums.
    //! minimumOfAll: of L of the pixel before; receives this one's
    template <int role, int vectors>
    CV_ALWAYS_INLINE int step(const Pixel& own, const Words& small, int large, const short* before, short* here,
                              int& minimumOfAll) const
    {
        const Words least = Words::repeat(minimumOfAll), jump = Words::repeat(minimumOfAll + large);
        Words minimum = Words::repeat(none), lowestSum = Words::repeat(SHRT_MAX), position = lowestSum;
        const int count = vectors > 0 ? vectors * Words::count : p_.volume.stride();
        const short* const padding = padding_ - p_.volume.numDisparities;
        for (int d = 0; d < count; d += Words::count)
        {
            const Words beside = Words::load(before + d - 1).min(Words::load(before + d + 1)) + small;
            const Words best = Words::load(before + d).min(beside).min(jump);
            Words l = Words::load(own.costs + d) + (best - least);
            if (vectors == 0 || d == count - Words::count)
                l = l.max(Words::load(padding + d));
            l.store(here + d);
            minimum = minimum.min(l);
            const Words sum = role == FIRST ? l : Words::load(own.sums + d) + l;
            sum.store(own.into + d);
            if (role != LAST)
                continue;
            position = position.whereNotGreater(lowestSum, sum, Words::repeat(d));
            lowestSum = lowestSum.min(sum);
        }
        minimumOfAll = minimum.minimum();
        if (role != LAST)
            return 0;
        // Where the lowest sum is higher than that of all: no position
        const Words lowest = Words::repeat(lowestSum.minimum());
        const Words number = position + Words::load(lanes_);
        return number.whereNotGreater(lowestSum, lowest, Words::repeat(SHRT_MAX)).minimum();
    }

    static const int margin = VolumeProblem::margin;
    short lanes_[Words::count]; // 0, 1, ..
    const VolumeProblem& p_;
    const int scanlines_, length_, lineLength_;
    short *const before_, *const here_; // L of a pixel of each scanline, by disparity
    short* const total_;                // the sums of a pixel over all directions
    short* const padding_;              // none, behind zeros for all candidates
};

} // namespace

void aggregateRows(const VolumeProblem& problem, const Range& rows, short* lines)
{
    const int width = problem.volume.size.width;
    const ptrdiff_t first = rows.start * (ptrdiff_t)width;
    const LineBlock::Direction fromLeft = { first, 1, width, -2 }, fromRight = { first + width - 1, -1, width, 0 };
    LineBlock block(problem, rows.size(), width, lines);
    block.follow<LineBlock::FIRST>(fromLeft);
    block.follow<LineBlock::MIDDLE>(fromRight);
}

void aggregateColumns(const VolumeProblem& problem, const Range& columns, short* lines)
{
    const ptrdiff_t width = problem.volume.size.width, height = problem.volume.size.height, last = (height - 1) * width;
    const LineBlock::Direction fromAbove = { columns.start, width, 1, 1 - 2 * width },
                               fromBelow = { columns.start + last, -width, 1, 1 };
    LineBlock block(problem, columns.size(), (int)height, lines);
    block.follow<LineBlock::MIDDLE>(fromAbove);
    block.follow<LineBlock::LAST>(fromBelow);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
