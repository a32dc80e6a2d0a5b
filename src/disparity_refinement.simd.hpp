// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "disparity_refinement.hpp"
#include "vectorized.hpp"
#include <cstring>

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! fillOccluded() for one row. shift: log2 of the units of a disparity in one pixel.
void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int shift, OcclusionScratch& scratch);

/** A row of the median of 5 x 5 pixels.
@param rows The rows around it.
@param width Of the rows.
@param sorted Five rows to work in, with two more columns on each side.
@param filtered Receives the row. */
void medianRow(const ushort* const* rows, int width, ushort* const* sorted, ushort* filtered);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The first byte from begin on that has this value, or end
inline int findByte(const uchar* bytes, int begin, int end, uchar value)
{
    const void* found = std::memchr(bytes + begin, value, end - begin);
    return found ? (int)((const uchar*)found - bytes) : end;
}

} // namespace

void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int shift, OcclusionScratch& scratch)
{
    scratch.there.assign(width + 1, UINT_MAX);
    scratch.columns.resize(width);
    scratch.keys.resize(width);
    scratch.visible.resize(width);
    unsigned *there = scratch.there.data(), *keys = scratch.keys.data();
    int* columns = scratch.columns.data();
    uchar* visible = scratch.visible.data();
    const int half = (1 << shift) / 2, pixel = 1 << shift;
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        columns[x] = std::max(x + 1 - ((disparity[x] + half) >> shift), 0);
        keys[x] = ((unsigned)residual[x] << 16) + (0xffffu - disparity[x]); // the nearer one, if equal
    }
    for (int x = 0; x < width; ++x)
        there[columns[x]] = std::min(there[columns[x]], keys[x]);
    HDP_VECTORIZED for (int x = 0; x < width; ++x) keys[x] = there[columns[x]];
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int difference = (int)(0xffff - (keys[x] & 0xffff)) - disparity[x];
        visible[x] = (uchar)((columns[x] > 0) & (difference <= pixel) & (difference >= -pixel));
    }
    for (int begin = findByte(visible, 0, width, 0); begin < width;)
    {
        const int end = findByte(visible, begin, width, 1);
        if (begin > 0 || end < width)
        {
            const ushort before = disparity[begin > 0 ? begin - 1 : end],
                         after = disparity[end < width ? end : begin - 1];
            std::fill(disparity + begin, disparity + end, std::min(before, after));
        }
        begin = findByte(visible, end, width, 0);
    }
}

namespace {

inline void sortPair(ushort& a, ushort& b)
{
    const ushort smaller = std::min(a, b);
    b = std::max(a, b);
    a = smaller;
}

inline void sortThree(ushort& a, ushort& b, ushort& c)
{
    sortPair(a, b);
    sortPair(b, c);
    sortPair(a, b);
}

inline void sortFour(ushort& a, ushort& b, ushort& c, ushort& d)
{
    sortPair(a, b);
    sortPair(c, d);
    sortPair(a, c);
    sortPair(b, d);
    sortPair(b, c);
}

inline void sortFive(ushort& a, ushort& b, ushort& c, ushort& d, ushort& e)
{
    sortFour(a, b, c, d);
    sortPair(d, e);
    sortPair(c, d);
    sortPair(b, c);
    sortPair(a, b);
}

inline ushort medianOfThree(ushort a, ushort b, ushort c)
{
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

} // namespace

void medianRow(const ushort* const* rows, int width, ushort* const* sorted, ushort* filtered)
{
    {
        const ushort *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3], *r4 = rows[4];
        ushort *s0 = sorted[0], *s1 = sorted[1], *s2 = sorted[2], *s3 = sorted[3], *s4 = sorted[4];
        HDP_VECTORIZED for (int x = 0; x < width; ++x)
        {
            ushort a = r0[x], b = r1[x], c = r2[x], d = r3[x], e = r4[x];
            sortFive(a, b, c, d, e);
            s0[x] = a;
            s1[x] = b;
            s2[x] = c;
            s3[x] = d;
            s4[x] = e;
        }
    }
    for (int i = 0; i < 5; ++i) // the border is replicated
    {
        sorted[i][-2] = sorted[i][-1] = sorted[i][0];
        sorted[i][width] = sorted[i][width + 1] = sorted[i][width - 1];
    }
    // Once the columns are sorted, and then the rows, the element in row i and column j is not smaller than
    // (i + 1) (j + 1) elements, itself included, and not larger than (5 - i) (5 - j). That leaves 13 that may be the
    // median: below, dij.
    const ushort *s0 = sorted[0], *s1 = sorted[1], *s2 = sorted[2], *s3 = sorted[3], *s4 = sorted[4];
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        ushort d00 = s0[x - 2], d01 = s0[x - 1], d02 = s0[x], d03 = s0[x + 1], d04 = s0[x + 2];
        ushort d10 = s1[x - 2], d11 = s1[x - 1], d12 = s1[x], d13 = s1[x + 1], d14 = s1[x + 2];
        ushort d20 = s2[x - 2], d21 = s2[x - 1], d22 = s2[x], d23 = s2[x + 1], d24 = s2[x + 2];
        ushort d30 = s3[x - 2], d31 = s3[x - 1], d32 = s3[x], d33 = s3[x + 1], d34 = s3[x + 2];
        ushort d40 = s4[x - 2], d41 = s4[x - 1], d42 = s4[x], d43 = s4[x + 1], d44 = s4[x + 2];
        sortFive(d00, d01, d02, d03, d04); // the compiler leaves out what is not used
        sortFive(d10, d11, d12, d13, d14);
        sortFive(d20, d21, d22, d23, d24);
        sortFive(d30, d31, d32, d33, d34);
        sortFive(d40, d41, d42, d43, d44);
        // Of two on the diagonals beside the middle one, the smaller (larger) has too many above (below) it.
        ushort p = std::max(d03, d30), q = std::max(d12, d21), r = std::min(d14, d41), s = std::min(d23, d32);
        // The median of the nine that are left, of which q <= d22 <= s
        sortThree(p, d04, d40);
        sortThree(r, d13, d31);
        filtered[x] =
            medianOfThree(std::max(std::max(p, r), q), medianOfThree(d04, d13, d22), std::min(std::min(d40, d31), s));
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
