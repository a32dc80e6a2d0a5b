// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "disparity_confidence.hpp"
#include "../base/disparity_units.hpp"
#include "opencv2/core/hal/intrin.hpp"
#include "../base/vectorized.hpp"
#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

// The distance transform goes down the columns, up the columns, and along the rows.

/** Distances to the nearest pixel at a step in the same column that is not below, at most farFromSteps.
@param above,row,below Rows of disparities.
@param width Of the rows.
@param columns To compute.
@param distanceAbove The distances of the row above.
@param distance Receives those of the row. */
void distanceFromAbove(const ushort* above, const ushort* row, const ushort* below, int width, const Range& columns,
                       const uchar* distanceAbove, uchar* distance);

//! Lowers a row's distances where a step below is nearer. distanceBelow: the final ones of the row below.
void distanceFromBelow(const uchar* distanceBelow, const Range& columns, uchar* distance);

/** Squared distances to the nearest pixel at a step, at most those of farFromSteps.
@param distance Distances in the columns.
@param width Of the row.
@param padded Memory for a row, with farFromSteps elements before it and farFromSteps + vectorMargin behind.
@param squares Receives the row. */
void squaredDistanceRow(const uchar* distance, int width, short* padded, short* squares);

/** Twice the census costs of a row's disparities, and twice the means of those of their alternatives.
@param left See CensusCost::leftPixels().
@param right See CensusCost::rightPlane(); of planes that do not exist, any other.
@param planes Their number.
@param disparity The row.
@param numDisparities Of the layer.
@param width Of the row.
@param scratch Of this width.
@param own,others Receive the costs. */
void censusCostRow(const uchar* left, const uchar* const* right, int planes, const ushort* disparity,
                   int numDisparities, int width, CensusScratch& scratch, short* own, short* others);

//! Moves the sums of a window's rows on by one. kept: the row that leaves, replaced by the one that enters.
void slideWindow(const short* entering, int width, short* kept, short* sums);
void slideWindow(const int* entering, int width, int* kept, int* sums);

/** Sums of a row of cells of 2 x 2 pixels: of the differences between two maps, borders replicated.
@param rows Both rows of the map.
@param others Those of the other map; twice the row of the layer above.
@param scale 1, or 2 for the layer above: what its disparities count.
@param width Of the map's rows.
@param otherWidth Of the other map's.
@param max What larger differences count as.
@param cells Receives the row. */
void differenceCells(const ushort* const* rows, const ushort* const* others, int scale, int width, int otherWidth,
                     int max, ushort* cells);

/** P M of disparityConfidence().
@param fromUpper,byMedian Sums over windows, one per cell.
@param width In pixels.
@param agreement Receives the row, and one element more. */
void agreementRow(const int* fromUpper, const int* byMedian, int width, float* agreement);

/** A row of confidences.
@param own,others Sums of the costs over the windows' rows, with half a window of columns more on both sides.
@param squares Squared distances to the nearest pixel at a step.
@param visible Not 0 for pixels that pass the left-right check.
@param agreement P M of disparityConfidence().
@param width Of the row.
@param groups Memory for 2 rows and windows.
@param factors Memory for a row and vectorMargin.
@param confidence Receives the row. */
void confidenceRow(const short* own, const short* others, const short* squares, const uchar* visible,
                   const float* agreement, int width, short* groups, float* factors, uchar* confidence);
void confidenceRow(const int* own, const int* others, const short* squares, const uchar* visible,
                   const float* agreement, int width, int* groups, float* factors, uchar* confidence);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef DisparityConfidence Constants;

} // namespace

void distanceFromAbove(const ushort* above, const ushort* row, const ushort* below, int width, const Range& columns,
                       const uchar* distanceAbove, uchar* distance)
{
    const ushort noStep = Constants::stepHalves * subpixelScale / 2, far = Constants::farFromSteps;
    const auto measure = [=](int x, int left, int right) {
        const ushort inColumn = std::max(difference(row[x], above[x]), difference(row[x], below[x])),
                     inRow = std::max(difference(row[x], row[left]), difference(row[x], row[right]));
        const ushort farther = std::min((ushort)(distanceAbove[x] + 1), far);
        distance[x] = (uchar)(std::max(inColumn, inRow) > noStep ? 0 : farther);
    };
    const int last = width - 1, begin = std::max(columns.start, 1), end = std::min(columns.end, last);
    HDP_VECTORIZED for (int x = begin; x < end; ++x) measure(x, x - 1, x + 1);
    if (columns.start == 0)
        measure(0, 0, std::min(1, last));
    if (columns.end == width)
        measure(last, std::max(last - 1, 0), last);
}

void distanceFromBelow(const uchar* distanceBelow, const Range& columns, uchar* distance)
{
    const int begin = columns.start, end = columns.end;
    HDP_VECTORIZED for (int x = begin; x < end; ++x) distance[x] = std::min(distance[x], (uchar)(distanceBelow[x] + 1));
}

void squaredDistanceRow(const uchar* distance, int width, short* padded, short* squares)
{
    const int block = 32, group = 9, far = Constants::farFromSteps;
    static_assert(block <= vectorMargin && (far - 1) % group == 0, "blocks end inside padded, groups at far - 1");
    std::fill(padded - far, padded, (short)(far * far));
    std::fill(padded + width, padded + width + far + vectorMargin, (short)(far * far));
    HDP_VECTORIZED for (int x = 0; x < width; ++x) padded[x] = (short)(distance[x] * distance[x]);
    for (int start = 0; start < width; start += block)
    {
        const short* inColumns = padded + start;
        short nearest[block];
        std::memcpy(nearest, inColumns, sizeof(nearest));
        for (int first = 1; first < far; first += group)
        {
            short max = 0;
            for (int k = 0; k < block; ++k)
                max = std::max(max, nearest[k]);
            if (first * first >= max) // columns as far as these are not nearer
                break;
            for (int dx = first; dx < first + group; ++dx)
            {
                const short square = (short)(dx * dx);
                HDP_VECTORIZED for (int k = 0; k < block; ++k) nearest[k] =
                    std::min(nearest[k], (short)(std::min(inColumns[k - dx], inColumns[k + dx]) + square));
            }
        }
        std::memcpy(squares + start, nearest, sizeof(short) * std::min(block, width - start));
    }
}

namespace {

//! The number of bits set in each 4 bits of a word
inline unsigned countInNibbles(unsigned bits)
{
    bits -= (bits >> 1) & 0x55555555;
    return (bits & 0x33333333) + ((bits >> 2) & 0x33333333);
}

//! The sum of a word's groups of 4 bits, the two highest ones left out
inline short sumOfNibbles(unsigned nibbles)
{
    const unsigned bytes = (nibbles & 0x0f0f0f) + ((nibbles >> 4) & 0x0f0f0f);
    return (short)((bytes + (bytes >> 8) + (bytes >> 16)) & 0xff);
}

} // namespace

void censusCostRow(const uchar* left, const uchar* const* right, int planes, const ushort* disparity,
                   int numDisparities, int width, CensusScratch& scratch, short* own, short* others)
{
    unsigned *words = scratch.words.data(), *winner = scratch.winner.data(), *before = scratch.before.data(),
             *after = scratch.after.data();
    const uchar *plane0 = right[0], *plane1 = right[1], *plane2 = right[2];
    HDP_VECTORIZED for (int x = 0; x < width; ++x) words[x] =
        (unsigned)plane0[x] | (unsigned)plane1[x] << 8 | (unsigned)plane2[x] << 16;

    // Columns of the right image, which is mirrored; those outside of it are its first one.
    short *ofWinner = scratch.ofWinner.data(), *ofBefore = scratch.ofBefore.data(), *ofAfter = scratch.ofAfter.data();
    const short first = (short)(width - 1), lastCandidate = (short)(numDisparities - 1);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const short candidate = (short)wholeDisparity(disparity[x]);
        const Alternatives<short> alternatives(candidate, lastCandidate);
        ofWinner[x] = std::min((short)(first - x + candidate), first);
        ofBefore[x] = std::min((short)(first - x + alternatives.before), first);
        ofAfter[x] = std::min((short)(first - x + alternatives.after), first);
    }
    for (int x = 0; x < width; ++x, left += 4)
    {
        const unsigned pixel = left[0] | (unsigned)left[1] << 8 | (unsigned)left[2] << 16 | (unsigned)left[3] << 24;
        winner[x] = pixel ^ words[ofWinner[x]];
        before[x] = pixel ^ words[ofBefore[x]];
        after[x] = pixel ^ words[ofAfter[x]];
    }
    const unsigned mask = 0xffffff >> (8 * (3 - planes));
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        own[x] = (short)(2 * sumOfNibbles(countInNibbles(winner[x] & mask)));
        others[x] = sumOfNibbles(countInNibbles(before[x] & mask) + countInNibbles(after[x] & mask));
    }
}

namespace {

//! A cell that has a pixel of the layer above, or 2 x 2 pixels of a map of the same size
template <int scale>
inline ushort differenceCell(const ushort* const* rows, const ushort* const* others, int cell, ushort max)
{
    int sum = 0;
    HDP_UNROLLED for (int i = 0; i < 2; ++i)
    {
        HDP_UNROLLED for (int j = 0; j < 2; ++j)
        {
            const ushort other = (ushort)(scale * others[i][scale == 2 ? cell : 2 * cell + j]);
            sum += std::min(difference(rows[i][2 * cell + j], other), max);
        }
    }
    return (ushort)sum;
}

template <int scale>
void wholeCells(const ushort* const* rows, const ushort* const* others, int count, ushort max, ushort* cells)
{
    const ushort* const r[2] = { rows[0], rows[1] };
    const ushort* const o[2] = { others[0], others[1] };
    HDP_VECTORIZED for (int x = 0; x < count; ++x) cells[x] = differenceCell<scale>(r, o, x, max);
}

} // namespace

void differenceCells(const ushort* const* rows, const ushort* const* others, int scale, int width, int otherWidth,
                     int max, ushort* cells)
{
    const int whole = std::min(width / 2, otherWidth);
    if (scale == 2)
        wholeCells<2>(rows, others, whole, (ushort)max, cells);
    else
        wholeCells<1>(rows, others, whole, (ushort)max, cells);
    for (int cell = whole; 2 * cell < width; ++cell) // what is left
    {
        int sum = 0;
        for (int i = 0; i < 2; ++i)
            for (int x = 2 * cell; x < 2 * cell + 2; ++x)
            {
                const int column = std::min(x, width - 1), other = std::min(column / scale, otherWidth - 1);
                sum += std::min(std::abs(rows[i][column] - scale * others[i][other]), max);
            }
        cells[cell] = (ushort)sum;
    }
}

void agreementRow(const int* fromUpper, const int* byMedian, int width, float* agreement)
{
    // Sums of differences of 1 / halved pixels
    const int unit = 4 * subpixelScale / Constants::halved;
    const float upper = (float)(unit * Constants::upperWindow * Constants::upperWindow),
                median = (float)(unit * Constants::medianWindow * Constants::medianWindow);
    const int cells = (width + 1) / 2;
    HDP_VECTORIZED for (int x = 0; x < cells; ++x)
    {
        const float factor = upper * median / ((upper + (float)fromUpper[x]) * (median + (float)byMedian[x]));
        agreement[2 * x] = factor;
        agreement[2 * x + 1] = factor;
    }
}

namespace {

template <typename T> void slide(const T* entering, int width, T* kept, T* sums)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        sums[x] = (T)(sums[x] + entering[x] - kept[x]);
        kept[x] = entering[x];
    }
}

//! Square roots of count values, and of up to three behind them
void takeSquareRoots(float* values, int count)
{
    for (int i = 0; i < count; i += 4)
        v_store(values + i, v_sqrt(v_load(values + i)));
}

template <typename T>
void confidences(const T* own, const T* others, const short* squares, const uchar* visible, const float* agreement,
                 int width, T* groups, float* factors, uchar* confidence)
{
    const int group = 3, count = 7, window = Constants::window, far = Constants::farFromSteps;
    static_assert(group * count == window, "a window's sum is that of some groups of columns");
    const int span = width + window - group;
    T *ownGroups = groups, *otherGroups = groups + span;
    HDP_VECTORIZED for (int x = 0; x < span; ++x)
    {
        ownGroups[x] = (T)(own[x] + own[x + 1] + own[x + 2]);
        otherGroups[x] = (T)(others[x] + others[x + 1] + others[x + 2]);
    }
    HDP_VECTORIZED for (int x = 0; x < width; ++x) factors[x] = squares[x];
    takeSquareRoots(factors, width);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        T c = 0, a = 0;
        HDP_UNROLLED for (int i = 0; i < count; ++i)
        {
            c = (T)(c + ownGroups[x + group * i]);
            a = (T)(a + otherGroups[x + group * i]);
        }
        const float s = factors[x] / far, u = (float)std::max(a - c, 0) / (float)std::max(a + c, 1);
        factors[x] = s * u;
    }
    takeSquareRoots(factors, width);
    HDP_VECTORIZED for (int x = 0; x < width; ++x) factors[x] *= agreement[x];
    takeSquareRoots(factors, width);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const float v = visible[x] ? 1.f : 1.f / Constants::hiddenDivisor;
        confidence[x] = (uchar)(int)(255 * v * factors[x] + 0.5f);
    }
}

} // namespace

void slideWindow(const short* entering, int width, short* kept, short* sums) { slide(entering, width, kept, sums); }

void slideWindow(const int* entering, int width, int* kept, int* sums) { slide(entering, width, kept, sums); }

void confidenceRow(const short* own, const short* others, const short* squares, const uchar* visible,
                   const float* agreement, int width, short* groups, float* factors, uchar* confidence)
{
    confidences(own, others, squares, visible, agreement, width, groups, factors, confidence);
}

void confidenceRow(const int* own, const int* others, const short* squares, const uchar* visible,
                   const float* agreement, int width, int* groups, float* factors, uchar* confidence)
{
    confidences(own, others, squares, visible, agreement, width, groups, factors, confidence);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
