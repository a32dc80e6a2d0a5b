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
    for (int begin = findByte(visible, 0, width, 0); begin < width; )
    {
        const int end = findByte(visible, begin, width, 1);
        if (begin > 0 || end < width)
        {
            const ushort before = disparity[begin > 0 ? begin - 1 : end], after = disparity[end < width ? end : begin - 1];
            std::fill(disparity + begin, disparity + end, std::min(before, after));
        }
        begin = findByte(visible, end, width, 0);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
