// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "census_cost.hpp"
#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of an image: the planes of its census, which have a bit for each pixel of the checkerboard around the centre,
set if it is clearly darker, and behind them that of the grey levels in 8 bits.
@param radius Of the window, 1 to 3 pixels.
@param tolerance See CensusCost::prepare().
@param grey The first pixel of the row, levels times greyScale; it has a border of the radius, and may be read up to
column cols.
@param step From a row to the next, in elements.
@param mirrored Whether the image is mirrored: so is the window then, so that the bits are the same ones.
@param row Receives the row of the first plane. */
void censusRow(int radius, short tolerance, const short* grey, ptrdiff_t step, bool mirrored, int cols, uchar* row,
               size_t planeSize);

//! CensusCost::evaluate(), in floats or bytes
template <typename T>
void evaluateCensusCost(const CensusCost& census, const int* pixels, int count, int first, int lanes, T* cost);

//! TwoLayerCost::evaluate() with a layer below
void countTwoLayers(const CensusCost& own, const CensusCost& below, const int* pixels, int count, int first, int lanes,
                    uchar* cost);

//! CensusCost::ofDisparities() for row y
void censusCostOfRow(const CensusCost& census, int y, const ushort* disparity, uchar* cost);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void censusRow(int radius, short tolerance, const short* grey, ptrdiff_t step, bool mirrored, int cols, uchar* row,
               size_t planeSize)
{
    const int planes = radius, block = 256;
    // Bits that compare nothing stand for the centre, which is not darker than itself.
    ptrdiff_t offsets[24] = { 0 };
    int bits = 0;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if ((dx + dy) % 2 != 0)
            {
                offsets[bits % planes * 8 + bits / planes] = dy * step + (mirrored ? -dx : dx);
                ++bits;
            }
    short words[block]; // of a byte: without this memory the compiler narrows each comparison
    for (int plane = 0; plane < planes; ++plane, row += planeSize)
        for (int begin = 0; begin < cols; begin += block)
        {
            const int count = std::min(block, cols - begin);
            const ptrdiff_t* const offset = offsets + 8 * plane;
            const short* const own = grey + begin;
            const short *p0 = own + offset[0], *p1 = own + offset[1], *p2 = own + offset[2], *p3 = own + offset[3],
                        *p4 = own + offset[4], *p5 = own + offset[5], *p6 = own + offset[6], *p7 = own + offset[7];
            HDP_VECTORIZED for (int x = 0; x < count; ++x)
            {
                const short centre = (short)(own[x] - tolerance);
                short word = (short)(p0[x] < centre ? 1 : 0);
                word = (short)(word | (short)(p1[x] < centre ? 2 : 0));
                word = (short)(word | (short)(p2[x] < centre ? 4 : 0));
                word = (short)(word | (short)(p3[x] < centre ? 8 : 0));
                word = (short)(word | (short)(p4[x] < centre ? 16 : 0));
                word = (short)(word | (short)(p5[x] < centre ? 32 : 0));
                word = (short)(word | (short)(p6[x] < centre ? 64 : 0));
                word = (short)(word | (short)(p7[x] < centre ? 128 : 0));
                words[x] = word;
            }
            uchar* const to = row + begin;
            HDP_VECTORIZED for (int x = 0; x < count; ++x) to[x] = (uchar)words[x];
        }
    HDP_VECTORIZED for (int x = 0; x < cols; ++x) row[x] = (uchar)(grey[x] / greyScale);
}

namespace {

//! A pixel of the left image, and its candidates in the first plane of the right one
struct PixelCensus
{
    const uchar *left, *right;

    PixelCensus(const CensusCost& census, int y, int x, int first)
        : left(census.leftPixels(y) + 4 * x), right(census.rightPlane(0, y) + (census.size().width - 1 - x + first))
    {
    }

    //! C of some candidates from number k on, of the pixel so many columns to the right
    template <int planes, int column = 0> CV_ALWAYS_INLINE ByteLanes costs(size_t planeStep, int k) const
    {
        const int at = 4 * column;
        const uchar* const from = right - column + k;
        const ByteLanes first = ByteLanes::repeatByte<at>(left) ^ ByteLanes::load(from);
        if (planes == 1)
            return first.countBits();
        const ByteLanes second = ByteLanes::repeatByte<at + 1>(left) ^ ByteLanes::load(from + planeStep);
        if (planes == 2)
            return first.countBits() + second.countBits();
        const ByteLanes third = ByteLanes::repeatByte<at + 2>(left) ^ ByteLanes::load(from + 2 * planeStep);
        return ByteLanes::countBits(first, second, third);
    }
};

//! Costs of pixels. costOf(y, x, k): those of some candidates of a pixel from number k on
template <int lanes, typename T, typename CostOf>
CV_ALWAYS_INLINE void evaluatePixels(int width, const int* pixels, int count, T* cost, const CostOf& costOf)
{
    const int vector = 16 * ByteLanes::groups;
    const double rowsPerPixel = 1. / width;
    const bool areStored = sizeof(T) == 1 && lanes >= vector; // as they are
    uchar bytes[lanes > vector ? lanes : vector];
    for (int i = 0; i < count; ++i, cost += lanes)
    {
        const int y = rowOf(pixels[i], rowsPerPixel), x = pixels[i] - y * width;
        uchar* const to = areStored ? reinterpret_cast<uchar*>(cost) : bytes;
        for (int k = 0; k < lanes; k += vector)
            costOf(y, x, k).store(to + k);
        HDP_VECTORIZED for (int k = 0; k < lanes && !areStored; ++k) cost[k] = bytes[k];
    }
}

template <int planes> struct CensusCosts
{
    //! Those of the layer
    template <int lanes> struct OfLayer
    {
        template <typename T>
        static void run(const CensusCost& census, const int* pixels, int count, int first, T* cost)
        {
            evaluatePixels<lanes>(census.size().width, pixels, count, cost, [&](int y, int x, int k) {
                return PixelCensus(census, y, x, first).costs<planes>(census.planeStride(), k);
            });
        }
    };

    //! Those of the layer and the one below
    template <int lanes> struct OfTwoLayers
    {
        static void run(const CensusCost& own, const CensusCost& below, const int* pixels, int count, int first,
                        uchar* cost)
        {
            evaluatePixels<lanes>(own.size().width, pixels, count, cost, [&](int y, int x, int k) {
                const size_t plane = below.planeStride();
                const PixelCensus upper(below, 2 * y, 2 * x, first), lower(below, 2 * y + 1, 2 * x, first);
                const ByteLanes ofOwn = PixelCensus(own, y, x, first / 2).costs<planes>(own.planeStride(), k / 2);
                const ByteLanes sum = upper.costs<planes>(plane, k) + upper.costs<planes, 1>(plane, k) +
                                      lower.costs<planes>(plane, k) + lower.costs<planes, 1>(plane, k);
                return ofOwn.sumsOfHalves() + sum + (sum + ByteLanes::repeat(1)).shiftedRight<1>();
            });
        }
    };
};

template <int planes> void costOfRow(const CensusCost& census, int y, const ushort* disparity, uchar* cost)
{
    const int block = 64;
    const int width = census.size().width;
    const uchar* left = census.leftPixels(y);
    const uchar* right = census.rightPlane(0, y) + width - 1;
    unsigned differences[block];
    for (int begin = 0; begin < width; begin += block)
    {
        const int size = std::min(block, width - begin);
        for (int i = 0, x = begin; i < size; ++i, ++x)
            differences[i] =
                censusDifference<planes>(left + 4 * x, right - x + wholeDisparity(disparity[x]), census.planeStride());
        HDP_VECTORIZED for (int i = 0; i < size; ++i) cost[begin + i] = (uchar)countCensusBits(differences[i]);
    }
}

} // namespace

template <typename T>
void evaluateCensusCost(const CensusCost& census, const int* pixels, int count, int first, int lanes, T* cost)
{
    if (census.planes() == 3)
        runTask<CensusCosts<3>::OfLayer>(lanes, census, pixels, count, first, cost);
    else if (census.planes() == 2)
        runTask<CensusCosts<2>::OfLayer>(lanes, census, pixels, count, first, cost);
    else
        runTask<CensusCosts<1>::OfLayer>(lanes, census, pixels, count, first, cost);
}

template void evaluateCensusCost(const CensusCost&, const int*, int, int, int, float*);
template void evaluateCensusCost(const CensusCost&, const int*, int, int, int, uchar*);

void countTwoLayers(const CensusCost& own, const CensusCost& below, const int* pixels, int count, int first, int lanes,
                    uchar* cost)
{
    if (own.planes() == 3)
        runTask<CensusCosts<3>::OfTwoLayers>(lanes, own, below, pixels, count, first, cost);
    else if (own.planes() == 2)
        runTask<CensusCosts<2>::OfTwoLayers>(lanes, own, below, pixels, count, first, cost);
    else
        runTask<CensusCosts<1>::OfTwoLayers>(lanes, own, below, pixels, count, first, cost);
}

void censusCostOfRow(const CensusCost& census, int y, const ushort* disparity, uchar* cost)
{
    const auto costs = census.planes() == 3 ? &costOfRow<3> : census.planes() == 2 ? &costOfRow<2> : &costOfRow<1>;
    costs(census, y, disparity, cost);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
