// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "other_surfaces.hpp"
#include "sparse_matches.hpp"
#include "../base/disparity_units.hpp"
#include "../base/vectorized.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** The usual other surfaces of a row, see findOtherSurfaces().
@param filtered The layer above.
@param unfiltered The same before the median.
@param matches The match in each pixel's square, or SparseMatches::noMatch.
@param width Of the rows.
@param others Receives the other surface, or the own one. */
void findUsualSurfaces(const DisparityRow& filtered, const DisparityRow& unfiltered, const ushort* matches, int width,
                       ushort* others);

//! The minimum and maximum of each block of a row of them, as SurfaceBuffers::blocks has them; rows: of the map, step
//! elements apart
void findBlockExtremes(const ushort* disparity, size_t step, int rows, int width, ushort* extremes);

/** The costs of two surfaces.
@param left The first pixel of the window, see CensusCost::leftPixels().
@param low The first one of the first surface's candidates in the first plane, see CensusCost::rightPlane().
@param high That of the second surface.
@param planes The census.
@param costs Receives the lowest costs of both. */
void lowestRunCosts(const uchar* left, const uchar* low, const uchar* high, const CensusPlanes& planes, int* costs);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

inline int farthest(int from, int min, int max) { return max - from >= from - min ? max : min; }

} // namespace

void findUsualSurfaces(const DisparityRow& filtered, const DisparityRow& unfiltered, const ushort* matches, int width,
                       ushort* others)
{
    const ushort *own = filtered.own, *min = filtered.min, *max = filtered.max;
    const ushort *raw = unfiltered.own, *minRaw = unfiltered.min, *maxRaw = unfiltered.max;
    const int distance = OtherSurface::distance * subpixelScale;
    const auto isOther = [=](int a, int b) { return (int)(std::abs(a - b) >= distance); }; // surface
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * own[x], match = matches[x];
        int other = farthest(here, 2 * minRaw[x], 2 * maxRaw[x]);
        const int ofFiltered = farthest(here, 2 * min[x], 2 * max[x]);
        other = choose(isOther(ofFiltered, here), ofFiltered, other);
        other = choose((match != SparseMatches::noMatch) & isOther(match, here), match, other);
        other = choose(isOther(2 * raw[x], here), 2 * raw[x], other);
        others[x] = (ushort)choose(isOther(other, here), other, here);
    }
}

void findBlockExtremes(const ushort* disparity, size_t step, int rows, int width, ushort* extremes)
{
    const int side = OtherSurface::block, columns = 64;
    ushort lowest[columns], highest[columns];
    for (int begin = 0; begin < width; begin += columns)
    {
        const int count = std::min(columns, width - begin);
        const ushort* row = disparity + begin;
        for (int x = 0; x < count; ++x)
            lowest[x] = highest[x] = row[x];
        for (int y = 1; y < rows; ++y)
        {
            row += step;
            HDP_VECTORIZED for (int x = 0; x < count; ++x)
            {
                lowest[x] = std::min(lowest[x], row[x]);
                highest[x] = std::max(highest[x], row[x]);
            }
        }
        for (int x = 0; x < count; x += side)
        {
            ushort least = lowest[x], most = highest[x];
            for (int u = x + 1; u < std::min(x + side, count); ++u)
            {
                least = std::min(least, lowest[u]);
                most = std::max(most, highest[u]);
            }
            extremes[0] = least;
            extremes[1] = most;
            extremes += 4;
        }
    }
}

namespace {

//! The census costs of a pixel of the window
template <int planes, int pixel>
CV_ALWAYS_INLINE ByteLanes costOf(const uchar* const* left, const uchar* const* low, const uchar* const* high,
                                  size_t rightPlane)
{
    const auto ofPlane = [=](int plane) {
        return ByteLanes::loadHalves(low, high, (ptrdiff_t)(plane * rightPlane) - pixel);
    };
    ByteLanes cost = (ByteLanes::repeatByte<4 * pixel>(left) ^ ofPlane(0)).countBits();
    if (planes > 1)
        cost = cost + (ByteLanes::repeatByte<4 * pixel + 1>(left) ^ ofPlane(1)).countBits();
    if (planes > 2)
        cost = cost + (ByteLanes::repeatByte<4 * pixel + 2>(left) ^ ofPlane(2)).countBits();
    return cost;
}

template <int planes>
void lowestRunCosts(const uchar* left, const uchar* low, const uchar* high, const CensusPlanes& census, int* costs)
{
    const int groups = ByteLanes::groups, runLength = 8;
    static_assert(OtherSurface::window == 4 && OtherSurface::window % groups == 0, "rows of a group, pixels of a row");
    const uchar *leftRows[groups], *lowRows[groups], *highRows[groups];
    ByteLanes sum = ByteLanes::repeat(0);
    for (int y = 0; y < OtherSurface::window; y += groups)
    {
        for (int r = 0; r < groups; ++r)
        {
            leftRows[r] = left + (y + r) * census.leftStep;
            lowRows[r] = low + (y + r) * census.rightStep;
            highRows[r] = high + (y + r) * census.rightStep;
        }
        const size_t plane = census.rightPlane;
        sum = sum + costOf<planes, 0>(leftRows, lowRows, highRows, plane) +
              costOf<planes, 1>(leftRows, lowRows, highRows, plane);
        sum = sum + costOf<planes, 2>(leftRows, lowRows, highRows, plane) +
              costOf<planes, 3>(leftRows, lowRows, highRows, plane);
    }
    uchar sums[groups * 2 * runLength];
    sum.store(sums);
    for (int run = 0; run < 2; ++run)
    {
        int lowest = UCHAR_MAX;
        for (int k = run * runLength; k < (run + 1) * runLength; ++k)
        {
            int all = sums[k];
            for (int r = 1; r < groups; ++r)
                all += sums[r * 2 * runLength + k];
            lowest = std::min(lowest, all);
        }
        costs[run] = lowest;
    }
}

} // namespace

void lowestRunCosts(const uchar* left, const uchar* low, const uchar* high, const CensusPlanes& planes, int* costs)
{
    switch (planes.count)
    {
    case 1:
        return lowestRunCosts<1>(left, low, high, planes, costs);
    case 2:
        return lowestRunCosts<2>(left, low, high, planes, costs);
    default:
        return lowestRunCosts<3>(left, low, high, planes, costs);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
