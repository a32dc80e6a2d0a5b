// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "volume_scanlines.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "byte_lanes.simd.hpp"
#endif

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** The directions from the left and from the right, to the sums.
@param problem The layer.
@param rows Some rows.
@param lines Memory to work in, see VolumeProblem::lineMemory(). */
void aggregateRows(const VolumeProblem& problem, const Range& rows, short* lines);

/** The directions from above and from below, added to the sums, and the winners.
@param problem The layer.
@param columns Some columns.
@param lines Memory to work in, see VolumeProblem::lineMemory(). */
void aggregateColumns(const VolumeProblem& problem, const Range& columns, short* lines);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! A vector of 16-bit numbers: universal intrinsics under names that all versions of OpenCV have in common
struct WordLanes
{
#if HDP_LANES_AVX2
    typedef v_int16x16 Vector;
    static WordLanes repeat(int word) { return v256_setall_s16((short)word); }
    static WordLanes load(const short* words) { return v256_load(words); }
    static WordLanes load(const uchar* bytes) { return v_reinterpret_as_s16(v256_load_expand(bytes)); }
#else
    typedef v_int16x8 Vector;
    static WordLanes repeat(int word) { return v_setall_s16((short)word); }
    static WordLanes load(const short* words) { return v_load(words); }
    static WordLanes load(const uchar* bytes) { return v_reinterpret_as_s16(v_load_expand(bytes)); }
#endif
    enum
    {
        count = sizeof(Vector) / sizeof(short)
    };
    Vector v;

    WordLanes(const Vector& vector) : v(vector) {}
    void store(short* words) const { v_store(words, v); }

    WordLanes operator+(const WordLanes& b) const { return v_add_wrap(v, b.v); }
    WordLanes operator-(const WordLanes& b) const { return v_sub_wrap(v, b.v); }
    WordLanes min(const WordLanes& b) const { return v_min(v, b.v); }
    //! Of numbers that are not negative
    int minimum() const
    {
#if HDP_LANES_AVX2
        const __m128i half = _mm_min_epi16(_mm256_castsi256_si128(v.val), _mm256_extracti128_si256(v.val, 1));
        return _mm_cvtsi128_si32(_mm_minpos_epu16(half)) & 0xffff;
#else
        return v_reduce_min(v);
#endif
    }
    Vector equals(const WordLanes& b) const
    {
#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 9 // as in ByteLanes
        return v == b.v;
#else
        return v_eq(v, b.v);
#endif
    }
};

/** Follows a block of scanlines side by side, pixel by pixel: so one does not wait for the minimum of another.

A cost is at most 255, and L(p, d) - C(p, d) at most large(p, q), so L is at most 255 + VolumePenalties::largest = 1055,
L + small at most 1855, and the sum of four directions at most 4220.

The candidates from the last one to the end of the vector have the cost 255, no less than that of the last. By induction
along the scanline they never have a lower L than it: so they change neither it nor the minimum, and never win. */
class LineBlock
{
public:
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
        LAST    // takes the winners
    };

    LineBlock(const VolumeProblem& problem, int scanlines, int length, short* lines)
        : p_(problem), scanlines_(scanlines), length_(length), pitch_(problem.pitch + 2 * margin)
    {
        const WordLanes none = WordLanes::repeat(0x4000); // more than any L, with a penalty still a 16-bit number
        for (int k = 0; k < 2 * scanlines; ++k, lines += pitch_)
            for (int i = 0; i < margin; i += WordLanes::count)
            {
                none.store(lines + i);
                none.store(lines + margin + p_.pitch + i);
            }
        total_ = lines;
        before_ = lines - 2 * scanlines * (ptrdiff_t)pitch_ + margin;
        here_ = before_ + scanlines * (ptrdiff_t)pitch_;
    }

    template <int role> void follow(const Direction& direction)
    {
        // Before the first pixels all L are 0: then it is L = C there, whatever the penalties.
        const WordLanes zero = WordLanes::repeat(0);
        for (int k = 0; k < scanlines_; ++k)
        {
            for (int i = 0; i < p_.pitch; i += WordLanes::count)
                zero.store(before_ + k * (ptrdiff_t)pitch_ + i);
            lowest_[k] = 0;
        }
        for (int i = 0; i < length_; ++i)
        {
            ptrdiff_t pixel = direction.first + i * direction.along;
            for (int k = 0; k < scanlines_; ++k, pixel += direction.across)
            {
                const int large = i > 0 ? p_.large[p_.weights[2 * pixel + direction.edge]] : 0;
                const ptrdiff_t line = k * (ptrdiff_t)pitch_;
                lowest_[k] = step<role>(pixel, before_ + line, lowest_[k], large, here_ + line);
            }
            std::swap(before_, here_);
        }
    }

private:
    //! L of a pixel, from that of the pixel before and its minimum; returns the minimum.
    template <int role> int step(ptrdiff_t pixel, const short* before, int lowest, int large, short* here) const
    {
        const uchar* const costs = p_.costs + pixel * p_.pitch;
        short* const sums = p_.sums + pixel * p_.pitch;
        const WordLanes small = WordLanes::repeat(p_.small), least = WordLanes::repeat(lowest),
                        jump = WordLanes::repeat(lowest + large), none = WordLanes::repeat(SHRT_MAX);
        WordLanes minimum = none, lowestSum = none;
        for (int d = 0; d < p_.pitch; d += WordLanes::count)
        {
            const WordLanes beside = WordLanes::load(before + d - 1).min(WordLanes::load(before + d + 1)) + small;
            const WordLanes best = WordLanes::load(before + d).min(beside).min(jump);
            const WordLanes l = WordLanes::load(costs + d) + (best - least);
            l.store(here + d);
            minimum = minimum.min(l);
            const WordLanes sum = role == FIRST ? l : WordLanes::load(sums + d) + l;
            sum.store((role == LAST ? total_ : sums) + d);
            if (role == LAST)
                lowestSum = lowestSum.min(sum);
        }
        if (role == LAST)
            p_.disparity[pixel] = disparityOf(total_, lowestSum.minimum());
        return minimum.minimum();
    }

    //! The disparity of the first candidate with the lowest sum
    ushort disparityOf(const short* sums, int lowest) const
    {
        const WordLanes searched = WordLanes::repeat(lowest);
        int first = 0;
        while (!v_check_any(WordLanes::load(sums + first).equals(searched)))
            first += WordLanes::count;
        const int d = first + v_scan_forward(WordLanes::load(sums + first).equals(searched));
        if (d == 0 || d + 1 >= p_.numDisparities)
            return (ushort)(d * subpixelScale);
        const int before = sums[d - 1], after = sums[d + 1], slope = std::max(std::max(before, after) - lowest, 1);
        return (ushort)(d * subpixelScale + cvRound((before - after) * (subpixelScale / 2) / (float)slope));
    }

    enum
    {
        margin = VolumeProblem::margin
    };
    const VolumeProblem& p_;
    const int scanlines_, length_, pitch_;
    short *before_, *here_; // L of a pixel of each scanline
    short* total_;          // the sums of a pixel over all directions
    int lowest_[VolumeProblem::maxScanlines];
};

} // namespace

void aggregateRows(const VolumeProblem& problem, const Range& rows, short* lines)
{
    const int width = problem.size.width;
    const ptrdiff_t first = rows.start * (ptrdiff_t)width;
    const LineBlock::Direction fromLeft = { first, 1, width, -2 }, fromRight = { first + width - 1, -1, width, 0 };
    LineBlock block(problem, rows.size(), width, lines);
    block.follow<LineBlock::FIRST>(fromLeft);
    block.follow<LineBlock::MIDDLE>(fromRight);
}

void aggregateColumns(const VolumeProblem& problem, const Range& columns, short* lines)
{
    const ptrdiff_t width = problem.size.width, height = problem.size.height, last = (height - 1) * width;
    const LineBlock::Direction fromAbove = { columns.start, width, 1, 1 - 2 * width },
                               fromBelow = { columns.start + last, -width, 1, 1 };
    LineBlock block(problem, columns.size(), (int)height, lines);
    block.follow<LineBlock::MIDDLE>(fromAbove);
    block.follow<LineBlock::LAST>(fromBelow);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
