// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "occlusion_filling.hpp"
#include "left_right_check.hpp"
#include "../base/units.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A row of fillOccluded(), from where it begins on. shift: that many columns farther on in the left image than in the
//! right one
void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int shift, OcclusionScratch& scratch);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

const int minSurface = 4; // columns of a surface at the border of the right image: fewer are there by chance
const int nearBorder = 3; // columns of the right image, from 1 on, that are its border: matches there are off by some

// Of the pixels left of a surface, at most one in so many is the best match of its column, if the surface begins at the
// border: a smaller number takes other surfaces for it
const int pixelsPerBest = 7;
// If the surface hides them, at most one is visible, as some match by chance, and at most one is not behind nearer
// ones: a smaller number takes things farther inside for the border
const int pixelsPerVisible = 8, pixelsPerShown = 4;
static_assert(pixelsPerVisible % pixelsPerShown == 0, "mapToRight() divides them");

const int mostByChance = 3;     // columns between two gaps that are no shorter: more lose thin things
const int minSlopeColumns = 8;  // of the surface at the border, to tell its slope: fewer tell noise
const int maxSlopeColumns = 32; // of it, to be as many as are filled: more are bent

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

//! What is known of a row before surfaces are looked for
struct RowLimits
{
    int border;       // from this pixel on no surface begins at the border of the right image
    int hiding;       // from this pixel on no surface leaves so few columns to what is on its left that it hides it
    int maxDisparity; // of the row
};

//! Maps the pixels of a row to the right image: OcclusionScratch::columns and keys.
inline RowLimits mapToRight(const ushort* disparity, const uchar* residual, int width, int shift,
                            OcclusionScratch& scratch)
{
    int* columns = scratch.columns.data();
    unsigned* keys = scratch.keys.data();
    int border = 0, hiding = 0, maxDisparity = 0;
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int column = std::max(x + 1 + shift - wholeDisparity(disparity[x]), 0);
        columns[x] = column;
        maxDisparity = std::max(maxDisparity, (int)disparity[x]);
        border = std::max(border, column <= nearBorder ? x + 1 : 0);
        // The columns that pixels on the left of x can have: of the visible ones, and of those that are not hidden
        const bool leavesFew = pixelsPerVisible * column <= (1 + pixelsPerVisible / pixelsPerShown) * x;
        hiding = std::max(hiding, leavesFew ? x + 1 : 0);
        keys[x] = ((unsigned)residual[x] << 16) + (0xffffu - disparity[x]); // the nearer one, if equal
    }
    return { border, hiding, maxDisparity };
}

//! Marks the pixels that have the disparity of the best match of their column, but for a pixel.
inline void markBestMatches(const ushort* disparity, int width, OcclusionScratch& scratch)
{
    unsigned *best = scratch.bestKeys.data(), *keys = scratch.keys.data();
    const int* columns = scratch.columns.data();
    uchar* isBest = scratch.isBest.data();
    std::fill(best, best + scratch.bestKeys.size(), UINT_MAX);
    HDP_UNROLLED for (int x = 0; x < width; ++x) best[columns[x]] = std::min(best[columns[x]], keys[x]);
    HDP_VECTORIZED for (int x = 0; x < width; ++x) keys[x] = best[columns[x]];
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int difference = (int)(0xffff - (keys[x] & 0xffff)) - disparity[x];
        isBest[x] = (uchar)((columns[x] > 0) & (difference <= subpixelScale) & (difference >= -subpixelScale));
    }
}

//! Where the part of the row begins that the right image shows: at the last surface of best matches that begins at the
//! border of the right image. One that begins farther inside counts, too, if hardly a pixel before it is a best match.
inline int findBorder(const ushort* disparity, const OcclusionScratch& scratch, int width, int end)
{
    const uchar* isBest = scratch.isBest.data();
    const int* columns = scratch.columns.data();
    int border = 0, bestBefore = 0;
    for (int begin = findByte(isBest, 0, width, 1);
         begin < width && (begin < end || pixelsPerBest * bestBefore < width);)
    {
        const int runEnd = findByte(isBest, begin, width, 0);
        for (int x = begin; x < runEnd; ++x)
        {
            const bool isAtBorder = columns[x] <= nearBorder;
            if (!isAtBorder && (x > begin || pixelsPerBest * bestBefore > x))
                break;
            int surfaceEnd = x + 1;
            while (surfaceEnd < std::min(x + minSurface, runEnd) && !isStep(disparity, surfaceEnd))
                ++surfaceEnd;
            if (surfaceEnd == x + minSurface)
                border = x;
        }
        bestBefore += runEnd - begin;
        begin = findByte(isBest, runEnd, width, 1);
    }
    return border;
}

//! The same if matches by chance are the best ones of their columns: at the last surface that hides what is on its
//! left, whatever the residuals are. border: what findBorder() has found; limit: RowLimits::hiding
inline int findHidingSurface(const ushort* disparity, OcclusionScratch& scratch, int width, int border, int limit)
{
    const int* columns = scratch.columns.data();
    int last = limit - 1;
    while (last > border && !isStep(disparity, last))
        --last;
    if (last <= border)
        return border;

    // Surfaces farther on are not so near that they hide much.
    const int end = std::min(2 * last + minSurface, width);
    uchar* visibility = scratch.visibility.data();
    testVisibility(disparity, columns, end, (int)scratch.nearest.size() - 1, subpixelScale, scratch.nearest.data(),
                   visibility);
    const auto isHidden = [=](int x) { return visibility[x] != VISIBLE; };
    int visibleBefore = 0, hiddenBefore = 0;
    for (int x = 0; x <= last && x + minSurface <= end; ++x)
    {
        const bool hides = pixelsPerVisible * visibleBefore <= x && pixelsPerShown * (x - hiddenBefore) <= x;
        if (hides && x > border && (isHidden(x - 1) || isStep(disparity, x)))
        {
            int next = x;
            while (next < x + minSurface && !isHidden(next) && (next == x || !isStep(disparity, next)))
                ++next;
            if (next == x + minSurface)
                border = x;
        }
        hiddenBefore += isHidden(x);
        visibleBefore += !isHidden(x);
    }
    return border;
}

//! Continues the surface that begins at this pixel to the left border, half as steep as it is: most surfaces are bent.
inline void continueSurface(ushort* disparity, const uchar* isShown, int begin, int width, int maxDisparity)
{
    const int last = std::min(width, begin + clamped(begin, minSlopeColumns, maxSlopeColumns));
    int end = begin + 1;
    while (end < last && isShown[end] && !isStep(disparity, end))
        ++end;
    const int half = (end - begin) / 2;
    if (2 * half < minSlopeColumns)
        return std::fill(disparity, disparity + begin, disparity[begin]);
    int rise = 0; // between the halves, times half
    for (int x = begin; x < begin + half; ++x)
        rise += disparity[x + half] - disparity[x];
    const int first = disparity[begin], scale = 2 * half * half;
    for (int x = 0; x < begin; ++x)
    {
        const int fall = std::abs(rise) * (begin - x), steps = (fall + scale / 2) / scale;
        disparity[x] = (ushort)clamped(first + (rise > 0 ? -steps : steps), 0, maxDisparity);
    }
}

//! The end of a gap that begins at this pixel. Few pixels between two gaps that are no shorter match by chance: they do
//! not end it.
inline int findGapEnd(const uchar* isShown, int begin, int width)
{
    int end = findByte(isShown, begin, width, 1);
    for (;;)
    {
        const int next = findByte(isShown, end, std::min(end + mostByChance + 1, width), 0), pixels = next - end;
        if (next >= width || pixels > std::min(mostByChance, end - begin))
            return end;
        const int nextEnd = findByte(isShown, next, width, 1);
        if (pixels > nextEnd - next)
            return end;
        end = nextEnd;
    }
}

//! Gives the pixels that are not shown the farther one of the disparities on both sides.
inline void fillGaps(ushort* disparity, const uchar* isShown, int width, int maxDisparity)
{
    for (int begin = findByte(isShown, 0, width, 0); begin < width;)
    {
        const int end = findGapEnd(isShown, begin, width);
        if (begin == 0 && end < width)
            continueSurface(disparity, isShown, end, width, maxDisparity);
        else if (begin > 0)
            std::fill(disparity + begin, disparity + end,
                      std::min(disparity[begin - 1], disparity[end < width ? end : begin - 1]));
        begin = findByte(isShown, end, width, 0);
    }
}

} // namespace

void fillOccludedRow(ushort* disparity, const uchar* residual, int width, int shift, OcclusionScratch& scratch)
{
    const RowLimits limits = mapToRight(disparity, residual, width, shift, scratch);
    markBestMatches(disparity, width, scratch);
    const int border = findBorder(disparity, scratch, width, limits.border);
    uchar* const isShown = scratch.isBest.data();
    std::fill(isShown, isShown + findHidingSurface(disparity, scratch, width, border, limits.hiding), (uchar)0);
    fillGaps(disparity, isShown, width, limits.maxDisparity);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
