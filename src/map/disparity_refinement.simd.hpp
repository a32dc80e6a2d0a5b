// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "disparity_refinement.hpp"
#include "../base/disparity_units.hpp"
#include "../base/vectorized.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! fillOccluded() for one row. scratch: of this width; blank: columns of the right image, from its left border on, that
//! show nothing.
void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int blank, OcclusionScratch& scratch);

/** Compares a row's disparities with the largest ones that map to the same columns of the right image.
@param disparity In 1 / subpixelScale pixel.
@param width Of the row.
@param invalid Disparity of pixels that map to no column, or a value that none has.
@param largest Difference of a visible pixel, in the same units.
@param columns Memory for a row.
@param nearest Memory for a row and one element.
@param visibility Receives a Visibility per pixel. */
void visibilityRow(const ushort* disparity, int width, int invalid, int largest, int* columns, int* nearest,
                   uchar* visibility);
void visibilityRow(const short* disparity, int width, int invalid, int largest, int* columns, int* nearest,
                   uchar* visibility);

/** A row of the median of size x size pixels.
@param rows The `size` rows around it.
@param size 3, 5 or 7.
@param width Of the rows.
@param sorted As many rows to work in, with size / 2 more columns on each side.
@param filtered Receives the row. */
void medianRow(const ushort* const* rows, int size, int width, short* const* sorted, ushort* filtered);

//! Whether one of count disparities before the median is nearer than after it by ThinStructures::minDistance
bool isAnyNearer(const ushort* before, const ushort* after, int count);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

bool isAnyNearer(const ushort* before, const ushort* after, int count)
{
    const ushort least = ThinStructures::minDistance * subpixelScale;
    ushort any = 0;
    HDP_VECTORIZED for (int x = 0; x < count; ++x)
    {
        const ushort nearer = (ushort)(std::max(before[x], after[x]) - after[x]);
        any |= (ushort)(nearer >= least);
    }
    return any != 0;
}

namespace {

//! The first byte from begin on that has this value, or end
inline int findByte(const uchar* bytes, int begin, int end, uchar value)
{
    if (begin >= end) // also tells GCC that the length below is not negative
        return end;
    const void* found = std::memchr(bytes + begin, value, (size_t)(end - begin));
    return found ? (int)((const uchar*)found - bytes) : end;
}

//! Whether a surface ends between a pixel and the one before
inline bool isStep(const ushort* disparity, int x) { return std::abs(disparity[x] - disparity[x - 1]) > subpixelScale; }

const int nearBorder = 3; // columns of the right image, from 1 on, that count as its border

//! Where the part of the row begins that the right image shows: at the last visible surface that begins at the border of
//! the right image. One that begins farther inside counts, too, if hardly a pixel before it is visible.
//! reach: from this column on no surface begins there.
int findBorder(const ushort* disparity, const OcclusionScratch& scratch, int width, int reach)
{
    const int surface = 4; // columns, at least
    const int hidden = 7;  // pixels before it per visible one, at least
    const uchar* visible = scratch.visible.data();
    const int* columns = scratch.columns.data();
    int border = 0, visibleBefore = 0;
    for (int begin = findByte(visible, 0, width, 1);
         begin < width && (begin < reach || hidden * visibleBefore < width);)
    {
        const int runEnd = findByte(visible, begin, width, 0);
        for (int x = begin; x < runEnd; ++x)
        {
            const bool isAtBorder = columns[x] <= nearBorder;
            if (!isAtBorder && (x > begin || hidden * visibleBefore > x))
                break;
            int end = x + 1;
            while (end < std::min(x + surface, runEnd) && !isStep(disparity, end))
                ++end;
            if (end == x + surface)
                border = x;
        }
        visibleBefore += runEnd - begin;
        begin = findByte(visible, runEnd, width, 1);
    }
    return border;
}

/** Where the part of the row begins that the right image shows, if matches by chance have won columns of it: at the last
surface that leaves hardly a column to what is on its left. Nearer pixels hide farther ones, whatever the residuals are.
@param border What findBorder() has found.
@param reach From this column on no surface leaves so few columns. */
int findHidingSurface(const ushort* disparity, OcclusionScratch& scratch, int width, int blank, int border, int reach)
{
    const int surface = 4; // columns, at least
    const int shown = 8;   // pixels before it per visible one, at least
    const int hidden = 4;  // three of so many are hidden, at least
    const int* columns = scratch.columns.data();
    int last = reach - 1;
    while (last > border && !isStep(disparity, last))
        --last;
    if (last <= border)
        return border;

    const int end = std::min(2 * last + surface, width); // surfaces farther on are not so near that they hide much
    int* nearest = scratch.nearest.data();
    std::fill(nearest, nearest + width + 1, 0);
    for (int x = 0; x < end; ++x)
        nearest[columns[x]] = std::max(nearest[columns[x]], (int)disparity[x]);
    uchar* isHidden = scratch.shown.data();
    HDP_VECTORIZED for (int x = 0; x < end; ++x) isHidden[x] =
        (uchar)((columns[x] == 0) | (nearest[columns[x]] - disparity[x] > subpixelScale));
    int visibleBefore = isHidden[0] == 0 && columns[0] > blank, hiddenBefore = isHidden[0];
    for (int x = 1; x <= last && x + surface <= end; ++x)
    {
        const bool isEnough = shown * visibleBefore <= x && hidden * hiddenBefore >= (hidden - 1) * x;
        if (isEnough && x > border && (isHidden[x - 1] || isStep(disparity, x)))
        {
            int next = x;
            while (next < x + surface && !isHidden[next] && (next == x || !isStep(disparity, next)))
                ++next;
            if (next == x + surface)
                border = x;
        }
        hiddenBefore += isHidden[x];
        visibleBefore += !isHidden[x] && columns[x] > blank;
    }
    return border;
}

//! Continues the surface that begins at this column to the left border, half as steep as it is: most surfaces are bent.
//! largest: disparity of the row.
void continueSurface(ushort* disparity, const uchar* shown, int begin, int width, int largest)
{
    const int least = 8, most = 32; // columns, as many as are filled, that tell the slope
    const int last = std::min(width, begin + std::min(std::max(begin, least + 0), most + 0));
    int end = begin + 1;
    while (end < last && shown[end] && !isStep(disparity, end))
        ++end;
    const int half = (end - begin) / 2;
    if (2 * half < least)
        return std::fill(disparity, disparity + begin, disparity[begin]);
    int rise = 0; // between the halves, times half
    for (int x = begin; x < begin + half; ++x)
        rise += disparity[x + half] - disparity[x];
    const int first = disparity[begin], scale = 2 * half * half;
    for (int x = 0; x < begin; ++x)
    {
        const int fall = std::abs(rise) * (begin - x), steps = (fall + scale / 2) / scale;
        disparity[x] = (ushort)std::min(std::max(first + (rise > 0 ? -steps : steps), 0), largest);
    }
}

} // namespace

void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int blank, OcclusionScratch& scratch)
{
    unsigned *there = scratch.there.data(), *keys = scratch.keys.data();
    int* columns = scratch.columns.data();
    uchar *visible = scratch.visible.data(), *shown = scratch.shown.data();
    std::fill(there, there + width + 1, UINT_MAX);
    int reach = 0, hidingReach = 0, largest = 0;
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int column = std::max(x + 1 - wholeDisparity(disparity[x]), 0);
        columns[x] = column;
        largest = std::max(largest, (int)disparity[x]);
        reach = std::max(reach, column <= nearBorder ? x + 1 : 0);
        hidingReach = std::max(hidingReach, 8 * (column - blank) <= 3 * x ? x + 1 : 0);
        keys[x] = ((unsigned)residual[x] << 16) + (0xffffu - disparity[x]); // the nearer one, if equal
    }
    for (int x = 0; x < width; ++x)
        there[columns[x]] = std::min(there[columns[x]], keys[x]);
    HDP_VECTORIZED for (int x = 0; x < width; ++x) keys[x] = there[columns[x]];
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int difference = (int)(0xffff - (keys[x] & 0xffff)) - disparity[x];
        visible[x] = (uchar)((columns[x] > 0) & (difference <= subpixelScale) & (difference >= -subpixelScale));
    }
    const int border = findBorder(disparity, scratch, width, reach);
    std::fill(visible, visible + findHidingSurface(disparity, scratch, width, blank, border, hidingReach), (uchar)0);
    shown[0] = visible[0];
    shown[width - 1] = visible[width - 1];
    HDP_VECTORIZED for (int x = 1; x < width - 1; ++x) shown[x] = visible[x] & (visible[x - 1] | visible[x + 1]);
    for (int begin = findByte(shown, 0, width, 0); begin < width;)
    {
        const int end = findByte(shown, begin, width, 1);
        if (begin == 0 && end < width)
            continueSurface(disparity, shown, end, width, largest);
        else if (begin > 0)
            std::fill(disparity + begin, disparity + end,
                      std::min(disparity[begin - 1], disparity[end < width ? end : begin - 1]));
        begin = findByte(shown, end, width, 0);
    }
}

namespace {

//! As cvRound(disparity / 16.), for vectors: of two that are equally near the even one
inline int roundedDisparity(int disparity)
{
    static_assert(subpixelScale == 1 << 4, "divided by a shift, so that negative ones are rounded as others");
    return (disparity + subpixelScale / 2 - 1 + ((disparity >> 4) & 1)) >> 4;
}

template <typename T>
void visibilityOf(const T* disparity, int width, int invalid, int largest, int* columns, int* nearest,
                  uchar* visibility)
{
    const int none = width; // column of the pixels that map to none
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int column = x - roundedDisparity(disparity[x]);
        columns[x] = column >= 0 && column < width ? column : none;
    }
    HDP_VECTORIZED for (int x = 0; x <= width; ++x) nearest[x] = SHRT_MIN;
    for (int x = 0; x < width; ++x)
        if (disparity[x] != invalid)
            nearest[columns[x]] = std::max(nearest[columns[x]], (int)disparity[x]);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int column = columns[x], inside = nearest[column] - disparity[x] > largest ? OCCLUDED : VISIBLE;
        visibility[x] = (uchar)(column == none ? OUTSIDE : inside);
    }
}

} // namespace

void visibilityRow(const ushort* disparity, int width, int invalid, int largest, int* columns, int* nearest,
                   uchar* visibility)
{
    visibilityOf(disparity, width, invalid, largest, columns, nearest, visibility);
}

void visibilityRow(const short* disparity, int width, int invalid, int largest, int* columns, int* nearest,
                   uchar* visibility)
{
    visibilityOf(disparity, width, invalid, largest, columns, nearest, visibility);
}

namespace {

// In what follows pixels are less 32768: the smaller of two signed words is one instruction of SSE2, of unsigned ones two.

inline void sortPair(short& a, short& b)
{
    const short smaller = std::min(a, b);
    b = std::max(a, b);
    a = smaller;
}

inline void sortThree(short& a, short& b, short& c)
{
    sortPair(a, b);
    sortPair(b, c);
    sortPair(a, b);
}

inline void sortFour(short& a, short& b, short& c, short& d)
{
    sortPair(a, b);
    sortPair(c, d);
    sortPair(a, c);
    sortPair(b, d);
    sortPair(b, c);
}

inline void sort(short (&v)[3]) { sortThree(v[0], v[1], v[2]); }

inline void sort(short (&v)[5])
{
    sortFour(v[0], v[1], v[2], v[3]);
    sortPair(v[3], v[4]);
    sortPair(v[2], v[3]);
    sortPair(v[1], v[2]);
    sortPair(v[0], v[1]);
}

inline void sort(short (&v)[7])
{
    sortFour(v[0], v[1], v[2], v[3]);
    sortThree(v[4], v[5], v[6]);
    // Batcher's merging of four and three
    sortPair(v[0], v[4]);
    sortPair(v[1], v[5]);
    sortPair(v[2], v[6]);
    sortPair(v[2], v[4]);
    sortPair(v[3], v[5]);
    sortPair(v[1], v[2]);
    sortPair(v[3], v[4]);
    sortPair(v[5], v[6]);
}

inline short medianOfThree(short a, short b, short c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

//! The median of kept[0 .. count - 1] and rest[0 .. count - 4]: the smallest and the largest of kept cannot be it.
template <int count> struct Forgetful
{
    static CV_ALWAYS_INLINE short median(short* kept, const short* rest)
    {
        HDP_UNROLLED for (int i = 0; i < count / 2; ++i) sortPair(kept[i], kept[count - 1 - i]);
        HDP_UNROLLED for (int i = 1; i < (count + 1) / 2; ++i) sortPair(kept[0], kept[i]);
        HDP_UNROLLED for (int i = count / 2; i < count - 1; ++i) sortPair(kept[i], kept[count - 1]);
        kept[0] = *rest;
        return Forgetful<count - 1>::median(kept, rest + 1);
    }
};
template <> struct Forgetful<3>
{
    static CV_ALWAYS_INLINE short median(short* kept, const short*) { return medianOfThree(kept[0], kept[1], kept[2]); }
};

// The median of a window, sorted by rows and columns. The element in row i and column j is not smaller than
// (i + 1) (j + 1) elements, itself included, and not larger than (size - i) (size - j), which leaves some diagonals. Of
// two on the outer ones the smaller, or larger, may have too many above, or below, it.

inline short medianOfSorted(const short (&d)[3][3]) { return medianOfThree(d[0][2], d[1][1], d[2][0]); }

inline short medianOfSorted(const short (&d)[5][5])
{
    const short low = std::max(d[1][2], d[2][1]), high = std::min(d[2][3], d[3][2]);
    // The median of nine: low <= d[2][2] <= high and two groups of three
    short a = std::max(d[0][3], d[3][0]), b = d[0][4], c = d[4][0];
    short e = std::min(d[1][4], d[4][1]), f = d[1][3], g = d[3][1];
    sortThree(a, b, c);
    sortThree(e, f, g);
    return medianOfThree(std::max(std::max(a, e), low), medianOfThree(b, f, d[2][2]), std::min(std::min(c, g), high));
}

inline short medianOfSorted(const short (&d)[7][7])
{
    short kept[12] = { std::max(d[0][4], d[4][0]), std::max(d[1][3], d[3][1]), d[2][2],
                       std::max(d[0][5], d[4][1]), std::max(d[5][0], d[1][4]), d[2][3],
                       std::min(d[2][6], d[6][2]), std::min(d[3][5], d[5][3]), d[4][4],
                       std::min(d[6][1], d[2][5]), std::min(d[1][6], d[5][2]), d[4][3] };
    const short rest[9] = { d[3][2], d[3][4], d[0][6], d[6][0], d[1][5], d[5][1], d[2][4], d[4][2], d[3][3] };
    return Forgetful<12>::median(kept, rest);
}

//! Sorts each column of the rows.
template <int size>
void sortColumns(const ushort* const (&rows)[size], const Range& columns, short* const (&sorted)[size])
{
    HDP_VECTORIZED for (int x = columns.start; x < columns.end; ++x)
    {
        short column[size];
        HDP_UNROLLED for (int i = 0; i < size; ++i) column[i] = (short)(rows[i][x] ^ SHRT_MIN);
        sort(column);
        HDP_UNROLLED for (int i = 0; i < size; ++i) sorted[i][x] = column[i];
    }
}

template <int size> void medianOfColumns(const short* const (&sorted)[size], const Range& columns, ushort* filtered)
{
    HDP_VECTORIZED for (int x = columns.start; x < columns.end; ++x)
    {
        short window[size][size];
        HDP_UNROLLED for (int i = 0; i < size; ++i)
        {
            HDP_UNROLLED for (int j = 0; j < size; ++j) window[i][j] = sorted[i][x + j - size / 2];
            sort(window[i]); // the columns remain sorted; the compiler leaves out what is not used
        }
        filtered[x] = (ushort)(medianOfSorted(window) ^ SHRT_MIN);
    }
}

template <int size> void medianRow(const ushort* const* rows, int width, short* const* sorted, ushort* filtered)
{
    const int radius = size / 2;
    const ushort* r[size];
    short* s[size];
    const short* columns[size];
    for (int i = 0; i < size; ++i)
    {
        r[i] = rows[i];
        columns[i] = s[i] = sorted[i];
    }
    // Whole vectors, of which the last ones overlap: what is left over would take as long, pixel by pixel.
    const int vectors = 32;
    const Range whole(0, width / vectors * vectors), last(std::max(width - vectors, 0), width);
    sortColumns(r, whole, s);
    sortColumns(r, last, s);
    for (int i = 0; i < size; ++i) // the border is replicated
    {
        std::fill(s[i] - radius, s[i], s[i][0]);
        std::fill(s[i] + width, s[i] + width + radius, s[i][width - 1]);
    }
    medianOfColumns(columns, whole, filtered);
    medianOfColumns(columns, last, filtered);
}

} // namespace

void medianRow(const ushort* const* rows, int size, int width, short* const* sorted, ushort* filtered)
{
    if (size == 3)
        medianRow<3>(rows, width, sorted, filtered);
    else if (size == 5)
        medianRow<5>(rows, width, sorted, filtered);
    else
        medianRow<7>(rows, width, sorted, filtered);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
