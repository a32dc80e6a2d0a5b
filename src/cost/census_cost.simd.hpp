// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "census_cost.hpp"
#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#include <cstring>
#include <type_traits>

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
    const int radius = window.radius, block = 256;
    const short tolerance = (short)window.tolerance;
    // Bits of the last plane that compare nothing stand for the centre, which is not darker than itself.
    ptrdiff_t offsets[24] = { 0 };
    int bits = 0;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if ((dx + dy) % 2 != 0)
                offsets[bits++] = dy * window.step + (mirrored ? -dx : dx);
    short words[block]; // of a byte: without this memory the compiler narrows each comparison
    for (int bit = 0; bit < bits; bit += 8, census += planeSize)
        for (int begin = 0; begin < cols; begin += block)
        {
            const int count = std::min(block, cols - begin);
            const ptrdiff_t* const offset = offsets + bit;
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
            uchar* const to = census + begin;
            HDP_VECTORIZED for (int x = 0; x < count; ++x) to[x] = (uchar)words[x];
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

//! A byte in each of a word's; words are of as many bytes as there are candidates, up to 8.
template <typename Word> inline Word repeated(unsigned byte) { return (Word)-1 / 255 * byte; }

//! The number of bits set in each 4 bits
template <typename Word> inline Word countInNibbles(Word bits)
{
    bits -= (bits >> 1) & repeated<Word>(0x55);
    return (bits & repeated<Word>(0x33)) + ((bits >> 2) & repeated<Word>(0x33));
}

//! The number of bits set in each byte of 1 to 3 words
template <int count, typename Word> inline Word countInBytes(Word a, Word b, Word c)
{
    // Sum and carry of three bits: two counts instead of three
    const Word nibbles = count == 1   ? countInNibbles(a)
                         : count == 2 ? countInNibbles(a) + countInNibbles(b)
                                      : countInNibbles(a ^ b ^ c) + 2 * countInNibbles((a & b) | ((a ^ b) & c));
    return (nibbles & repeated<Word>(0x0f)) + ((nibbles >> 4) & repeated<Word>(0x0f));
}

template <int lanes, int count, typename T>
void evaluateCosts(const CensusPlanes& planes, const int* pixels, int size, int first, T* cost)
{
    typedef typename std::conditional<lanes == 4, unsigned, uint64>::type Word;
    // Bits are counted in all words of a block at once, in order to fill vectors.
    const int block = lanes > 16 ? 1 : 32, words = lanes / (int)sizeof(Word);
    const double rowsPerPixel = 1. / planes.width;
    Word differences[count][block * words], bits[block * words];
    for (int begin = 0; begin < size; begin += block)
    {
        const int pixelCount = block == 1 ? 1 : std::min(block, size - begin);
        for (int i = 0; i < pixelCount; ++i)
        {
            const int p = pixels[begin + i], y = rowOf(p, rowsPerPixel), x = p - y * planes.width;
            const uchar* left = planes.left + y * planes.leftStep + 4 * x;
            const uchar* right = planes.right + y * planes.rightStep + (planes.width - 1 - x + first);
            for (int plane = 0; plane < count; ++plane, ++left, right += planes.rightPlane)
            {
                const Word pixel = repeated<Word>(*left);
                HDP_VECTORIZED for (int k = 0; k < words; ++k)
                {
                    Word candidates;
                    std::memcpy(&candidates, right + k * sizeof(Word), sizeof(Word));
                    differences[plane][i * words + k] = candidates ^ pixel;
                }
            }
        }
        HDP_VECTORIZED for (int k = 0; k < pixelCount * words; ++k) bits[k] = countInBytes<count>(
            differences[0][k], differences[count > 1 ? 1 : 0][k], differences[count > 2 ? 2 : 0][k]);
        const uchar* const counted = reinterpret_cast<const uchar*>(bits);
        T* const to = cost + (size_t)begin * lanes;
        HDP_VECTORIZED for (int k = 0; k < pixelCount * lanes; ++k) to[k] = counted[k];
    }
}

template <int lanes> struct EvaluateTask
{
    template <typename T> static void run(const CensusPlanes& planes, const int* pixels, int size, int first, T* cost)
    {
        const auto evaluate = planes.count == 3   ? &evaluateCosts<lanes, 3, T>
                              : planes.count == 2 ? &evaluateCosts<lanes, 2, T>
                                                  : &evaluateCosts<lanes, 1, T>;
        evaluate(planes, pixels, size, first, cost);
    }
};

} // namespace

void evaluateCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, float* cost)
{
    runTask<EvaluateTask>(lanes, planes, pixels, count, first, cost);
}

void countCensusCost(const CensusPlanes& planes, const int* pixels, int count, int first, int lanes, uchar* cost)
{
    runTask<EvaluateTask>(lanes, planes, pixels, count, first, cost);
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
    const auto costs = planes.count == 3 ? &costOfRow<3> : planes.count == 2 ? &costOfRow<2> : &costOfRow<1>;
    costs(planes, y, disparity, cost);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
