// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A row of medianDisparity(). rows: those around it; sorted: as many to work in, size / 2 columns longer on each side
void medianRow(const ushort* const* rows, int size, int width, short* const* sorted, ushort* filtered);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

// Pixels are less 32768 here: the minimum of two signed words is one instruction of SSE2, of unsigned ones two.

// By value: of references GCC often makes a comparison and two selections instead of one instruction for each.
inline short smaller(short a, short b) { return a < b ? a : b; }
inline short larger(short a, short b) { return a > b ? a : b; }

inline void sortPair(short& a, short& b)
{
    const short first = smaller(a, b);
    b = larger(a, b);
    a = first;
}

//! Moves the largest one to the end, and so on. Shorter networks would hardly save time.
template <int count> CV_ALWAYS_INLINE void sort(short* v)
{
    HDP_UNROLLED for (int i = 0; i < count - 1; ++i) sortPair(v[i], v[i + 1]);
    sort<count - 1>(v);
}
template <> CV_ALWAYS_INLINE void sort<1>(short*) {}

inline short medianOfThree(short a, short b, short c) { return larger(smaller(a, b), smaller(larger(a, b), c)); }

//! The median of kept[0 .. count - 1] and rest[0 .. count - 4]. Kept are more than half of them, so neither the minimum
//! nor the maximum of kept can be the median: both are forgotten, and one of the rest takes their place.
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

// The median of a window of n x n, sorted along rows (i) and columns (j): element (i, j) is not smaller than the
// (i + 1) (j + 1) elements above and on its left, itself among them, and not larger than the (n - i) (n - j) below and
// on its right. If one of the two is more than half of the window, the element cannot be the median but by being equal
// to it: what is near the first and the last corner drops out. So does the smaller of two elements if those that are
// not smaller than either are more than half of the window, and the larger of two the other way round. As many drop out
// below the median as above it, so it is the median of those that remain.

inline short medianOfSorted(const short (&d)[3][3]) { return medianOfThree(d[0][2], d[1][1], d[2][0]); }

inline short medianOfSorted(const short (&d)[5][5])
{
    const short low = larger(d[1][2], d[2][1]), high = smaller(d[2][3], d[3][2]);
    // The median of nine: low <= d[2][2] <= high and two groups of three
    short first[] = { larger(d[0][3], d[3][0]), d[0][4], d[4][0] };
    short second[] = { smaller(d[1][4], d[4][1]), d[1][3], d[3][1] };
    sort<3>(first);
    sort<3>(second);
    return medianOfThree(larger(larger(first[0], second[0]), low), medianOfThree(first[1], second[1], d[2][2]),
                         smaller(smaller(first[2], second[2]), high));
}

//    . . . . a c x      . drops out
//    . . . b d x H      x remains
//    . . x x x G E      a to d: two of a letter, of which the larger remains
//    . b x x x F .      E to H: two of a letter, of which the smaller remains
//    a c x x x . .
//    d x H F . . .
//    x G E . . . .
inline short medianOfSorted(const short (&w)[7][7])
{
    const short a = larger(w[0][4], w[4][0]), b = larger(w[1][3], w[3][1]);
    const short c = larger(w[0][5], w[4][1]), d = larger(w[1][4], w[5][0]);
    const short e = smaller(w[2][6], w[6][2]), f = smaller(w[3][5], w[5][3]);
    const short g = smaller(w[2][5], w[6][1]), h = smaller(w[1][6], w[5][2]);
    short kept[12] = { a, b, w[2][2], c, d, w[2][3], e, f, w[4][4], g, h, w[4][3] };
    const short rest[9] = { w[3][2], w[3][4], w[0][6], w[6][0], w[1][5], w[5][1], w[2][4], w[4][2], w[3][3] };
    return Forgetful<12>::median(kept, rest);
}

template <int size> void sortColumns(const ushort* const* rows, const Range& columns, short* const* sorted)
{
    HDP_VECTORIZED for (int x = columns.start; x < columns.end; ++x)
    {
        short column[size];
        HDP_UNROLLED for (int i = 0; i < size; ++i) column[i] = (short)(rows[i][x] ^ SHRT_MIN);
        sort<size>(column);
        HDP_UNROLLED for (int i = 0; i < size; ++i) sorted[i][x] = column[i];
    }
}

template <int size> void medianOfColumns(const short* const* sorted, const Range& columns, ushort* filtered)
{
    HDP_VECTORIZED for (int x = columns.start; x < columns.end; ++x)
    {
        short window[size][size];
        HDP_UNROLLED for (int i = 0; i < size; ++i)
        {
            HDP_UNROLLED for (int j = 0; j < size; ++j) window[i][j] = sorted[i][x + j - size / 2];
            sort<size>(window[i]); // the columns remain sorted; the compiler leaves out what is not used
        }
        filtered[x] = (ushort)(medianOfSorted(window) ^ SHRT_MIN);
    }
}

template <int size> void medianRow(const ushort* const* rows, int width, short* const* sorted, ushort* filtered)
{
    const int radius = size / 2;
    // Whole vectors, of which the last ones overlap: what is left over would take as long, pixel by pixel.
    const int vectors = 32;
    const Range whole(0, width / vectors * vectors), last(std::max(width - vectors, 0), width);
    sortColumns<size>(rows, whole, sorted);
    sortColumns<size>(rows, last, sorted);
    for (int i = 0; i < size; ++i) // the border is replicated
    {
        std::fill(sorted[i] - radius, sorted[i], sorted[i][0]);
        std::fill(sorted[i] + width, sorted[i] + width + radius, sorted[i][width - 1]);
    }
    medianOfColumns<size>(sorted, whole, filtered);
    medianOfColumns<size>(sorted, last, filtered);
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
