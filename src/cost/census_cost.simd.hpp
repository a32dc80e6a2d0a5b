// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "census_cost.hpp"
#include "../base/disparity_units.hpp"
#include "../base/grey_levels.hpp"
#include "../base/vectorized.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "census_counting.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of the left image: the census transform, a bit for each pixel of the checkerboard around the centre, set if it
is clearly darker, and the grey levels.
@param window The window.
@param grey The first pixel of the row, levels times greyScale; it has a border of the radius, and may be read up to
column cols.
@param cols Columns to compute.
@param planes Memory for a row of 3 planes, cols bytes each.
@param pixels Receives the row, see CensusCost::leftPixels(). */
void leftCensusRow(const CensusWindow& window, const short* grey, int cols, uchar* planes, uchar* pixels);

/** A row of the right image, as leftCensusRow(). The image is mirrored, and so is its window then, so that its bits are
the same ones.
@param row Receives the row, see CensusCost::rightPlane().
@param planeSize From a plane to the next. */
void rightCensusRow(const CensusWindow& window, const short* grey, int cols, uchar* row, size_t planeSize);

//! CensusCost::evaluate()
void evaluateCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, float* cost);

//! The same in bytes
void countCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, uchar* cost);

//! CensusCost::ofDisparities() for row y
void censusCostOfRow(const CensusPlanes& planes, int y, const ushort* disparity, uchar* cost);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! Returns the number of planes.
int censusRow(const CensusWindow& window, const short* grey, bool mirrored, int cols, uchar* census, size_t planeSize)
{
    const int radius = window.radius;
    const short tolerance = (short)window.tolerance;
    // Bits of the last plane that compare nothing stand for the centre, which is not darker than itself.
    ptrdiff_t offsets[24] = { 0 };
    int bits = 0;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if ((dx + dy) % 2 != 0)
                offsets[bits++] = dy * window.step + (mirrored ? -dx : dx);
    for (int bit = 0; bit < bits; bit += 8, census += planeSize)
    {
        const ptrdiff_t* offset = offsets + bit;
        const short *p0 = grey + offset[0], *p1 = grey + offset[1], *p2 = grey + offset[2], *p3 = grey + offset[3],
                    *p4 = grey + offset[4], *p5 = grey + offset[5], *p6 = grey + offset[6], *p7 = grey + offset[7];
        HDP_VECTORIZED for (int x = 0; x < cols; ++x)
        {
            // Word by word, so that they are narrowed once
            const short centre = (short)(grey[x] - tolerance);
            short byte = (short)(p0[x] < centre ? 1 : 0);
            byte = (short)(byte | (short)(p1[x] < centre ? 2 : 0));
            byte = (short)(byte | (short)(p2[x] < centre ? 4 : 0));
            byte = (short)(byte | (short)(p3[x] < centre ? 8 : 0));
            byte = (short)(byte | (short)(p4[x] < centre ? 16 : 0));
            byte = (short)(byte | (short)(p5[x] < centre ? 32 : 0));
            byte = (short)(byte | (short)(p6[x] < centre ? 64 : 0));
            byte = (short)(byte | (short)(p7[x] < centre ? 128 : 0));
            census[x] = (uchar)byte;
        }
    }
    return (bits + 7) / 8;
}

} // namespace

void leftCensusRow(const CensusWindow& window, const short* grey, int cols, uchar* planes, uchar* pixels)
{
    const int count = censusRow(window, grey, false, cols, planes, cols);
    const uchar *second = planes + (count > 1 ? cols : 0), *third = planes + (count > 2 ? 2 * cols : 0);
    HDP_VECTORIZED for (int x = 0; x < cols; ++x)
    {
        pixels[4 * x] = planes[x];
        pixels[4 * x + 1] = second[x];
        pixels[4 * x + 2] = third[x];
        pixels[4 * x + CensusCost::greyByte] = (uchar)(grey[x] / greyScale);
    }
}

void rightCensusRow(const CensusWindow& window, const short* grey, int cols, uchar* row, size_t planeSize)
{
    row += censusRow(window, grey, true, cols, row, planeSize) * planeSize;
    HDP_VECTORIZED for (int x = 0; x < cols; ++x) row[x] = (uchar)(grey[x] / greyScale);
}

namespace {

template <typename T>
void evaluateCosts(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, T* cost)
{
    const auto store = [=](const uchar* bits, int number, int position) {
        T* const to = cost + position;
        HDP_VECTORIZED for (int k = 0; k < number; ++k) to[k] = bits[k];
    };
    switch (lanes)
    {
    case 4:
        return evaluateCosts<4>(planes, pixels, count, first, store);
    case 8:
        return evaluateCosts<8>(planes, pixels, count, first, store);
    case 16:
        return evaluateCosts<16>(planes, pixels, count, first, store);
    default:
        return evaluateCosts<32>(planes, pixels, count, first, store);
    }
}

} // namespace

void evaluateCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, float* cost)
{
    evaluateCosts(planes, pixels, count, first, lanes, cost);
}

void countCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, uchar* cost)
{
    evaluateCosts(planes, pixels, count, first, lanes, cost);
}

namespace {

template <int count> void costOfRow(const CensusPlanes& planes, int y, const ushort* disparity, uchar* cost)
{
    const int block = 64;
    const uchar* left = planes.left + y * planes.leftStep;
    const uchar* right = planes.right + y * planes.rightStep + planes.width - 1;
    unsigned differences[block];
    for (int begin = 0; begin < planes.width; begin += block)
    {
        const int size = std::min(block, planes.width - begin);
        for (int i = 0, x = begin; i < size; ++i, ++x)
            differences[i] =
                censusDifference<count>(left + 4 * x, right - x + wholeDisparity(disparity[x]), planes.rightPlane);
        HDP_VECTORIZED for (int i = 0; i < size; ++i) cost[begin + i] = (uchar)countCensusBits(differences[i]);
    }
}

} // namespace

void censusCostOfRow(const CensusPlanes& planes, int y, const ushort* disparity, uchar* cost)
{
    if (planes.count == 3)
        costOfRow<3>(planes, y, disparity, cost);
    else if (planes.count == 2)
        costOfRow<2>(planes, y, disparity, cost);
    else
        costOfRow<1>(planes, y, disparity, cost);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
