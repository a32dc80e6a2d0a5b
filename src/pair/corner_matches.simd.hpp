// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "corner_matches.hpp"
#include "../base/vectorized.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** The structure tensors of the pixels of a row: sums over their windows of tensorSide x tensorSide pixels.
@param first First pixel of the first of count windows, in rows that are step pixels apart.
@param columns Memory for 3 * (count + tensorSide - 1) numbers.
@param sums Receives the sums of X * X, where X and Y are gradients over two pixels, then those of X * Y and Y * Y. */
void structureTensors(const ushort* first, size_t step, int count, int* columns, int* sums);

/** What the correlations of the windows that begin in a row have in common.
@param first,step As of structureTensors().
@param columns Memory for 2 * (count + searchSide - 1) numbers.
@param sums,scales Receive theirs, see SearchWindows. */
void windowSums(const ushort* first, size_t step, int count, int* columns, int* sums, float* scales);

/** The normalised cross-correlation of a window with those of an area: -1 to 1, row by row; 0 without texture.
@param left,step First pixel of the window, and pixels from a row to the next.
@param sum,scale Of the window, see windowSums(). */
void correlate(const ushort* left, size_t step, int sum, float scale, const SearchArea& area, float* correlations);

//! The left window of trackCornerMatches(). left: its first pixel; step: from a row to the next, in pixels
void cutWindow(const ushort* left, size_t step, TrackedWindow& window);

//! Sums of a right window with the left one. right: the pixel above and left of the first one's place; fx, fy:
//! fractions of the place, in 1 / 2^fractionBits of a pixel
RightSums trackingSums(const ushort* right, size_t step, int fx, int fy, const TrackedWindow& window);

//! The sums of CornerMatching::trackHeight rows of both windows; arguments as of trackingSums()
void sumRows(const ushort* right, size_t step, int fx, int fy, const TrackedWindow& window, RowSums* rows);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

static const short middle = 512; // of levels up to 1023: windowSums() and correlate() subtract it

void structureTensors(const ushort* first, size_t step, int count, int* columns, int* sums)
{
    const int width = count + CornerMatching::tensorSide - 1;
    HDP_VECTORIZED for (int i = 0; i < width; ++i)
    {
        int xx = 0, xy = 0, yy = 0;
        for (int y = 0; y < CornerMatching::tensorSide; ++y)
        {
            const ushort *const row = first + y * step, *const above = row - step, *const below = row + step;
            const short dx = (short)(row[i + 1] - row[i - 1]), dy = (short)(below[i] - above[i]);
            xx += dx * dx;
            xy += dx * dy;
            yy += dy * dy;
        }
        columns[i] = xx;
        columns[width + i] = xy;
        columns[2 * width + i] = yy;
    }
    for (int k = 0; k < 3; ++k)
    {
        const int* const column = columns + k * width;
        HDP_VECTORIZED for (int i = 0; i < count; ++i)
        {
            int sum = 0;
            for (int x = 0; x < CornerMatching::tensorSide; ++x)
                sum += column[i + x];
            sums[k * count + i] = sum;
        }
    }
}

// Levels count from the middle, so that all numbers have 32 bits: |level| <= 512, and n^2 512^2 < 2^31 for n pixels.
void windowSums(const ushort* first, size_t step, int count, int* columns, int* sums, float* scales)
{
    const int side = CornerMatching::searchSide, pixels = side * side, width = count + side - 1;
    int *const columnSums = columns, *const columnSquares = columns + width;
    HDP_VECTORIZED for (int i = 0; i < width; ++i)
    {
        int sum = 0, square = 0;
        for (int y = 0; y < CornerMatching::searchSide; ++y)
        {
            const short value = (short)(first[y * step + i] - middle);
            sum += value;
            square += value * value;
        }
        columnSums[i] = sum;
        columnSquares[i] = square;
    }
    HDP_VECTORIZED for (int i = 0; i < count; ++i)
    {
        int sum = 0, square = 0;
        for (int x = 0; x < CornerMatching::searchSide; ++x)
        {
            sum += columnSums[i + x];
            square += columnSquares[i + x];
        }
        sums[i] = sum;
        const int variance = square * pixels - sum * sum;
        scales[i] = variance > 0 ? 1 / std::sqrt((float)variance) : 0.f;
    }
}

void correlate(const ushort* left, size_t step, int sum, float scale, const SearchArea& area, float* correlations)
{
    const int side = CornerMatching::searchSide, pixels = side * side, lanes = SearchArea::minColumns;
    short window[CornerMatching::searchSide * CornerMatching::searchSide];
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            window[y * side + x] = (short)(left[y * step + x] - middle);
    for (int row = 0; row < SearchArea::rows; ++row, correlations += area.columns)
    {
        const int* const sums = area.sums + row * area.sumStep;
        const float* const scales = area.scales + row * area.sumStep;
        for (int end = lanes;; end = std::min(end + lanes, area.columns)) // the last ones perhaps twice
        {
            const int first = end - lanes;
            int products[lanes] = {};
            for (int y = 0; y < side; ++y)
            {
                const short* const l = window + y * side;
                const ushort* const r = area.pixels + (row + y) * area.step + first;
                HDP_FOR_LANES(k, lanes)
                {
                    int product = 0;
                    for (int x = 0; x < CornerMatching::searchSide; ++x)
                        product += l[x] * (short)r[k + x];
                    products[k] += product;
                }
            }
            HDP_FOR_LANES(k, lanes)
            {
                const int product = products[k] - sum * middle;
                // The difference has 32 bits, what it is of has not.
                const int covariance = (int)((unsigned)product * pixels - (unsigned)sum * (unsigned)sums[first + k]);
                correlations[first + k] = (float)covariance * scale * scales[first + k];
            }
            if (end == area.columns)
                break;
        }
    }
}

void cutWindow(const ushort* left, size_t step, TrackedWindow& window)
{
    for (int y = 0; y < CornerMatching::trackHeight; ++y)
    {
        const ushort* const row = left + y * step;
        const ushort *const above = row - step, *const below = row + step;
        short* const l = window.values + y * CornerMatching::trackWidth;
        short* const gx = window.gradientX + y * CornerMatching::trackWidth;
        short* const gy = window.gradientY + y * CornerMatching::trackWidth;
        HDP_VECTORIZED for (int x = 0; x < CornerMatching::trackWidth; ++x)
        {
            l[x] = (short)row[x];
            gx[x] = (short)(row[x + 1] - row[x - 1]);
            gy[x] = (short)(below[x] - above[x]);
        }
    }
    TrackedWindow::Sums sums = {};
    HDP_VECTORIZED for (int i = 0; i < TrackedWindow::pixels; ++i)
    {
        const short l = window.values[i], x = window.gradientX[i], y = window.gradientY[i];
        sums.l += l;
        sums.ll += l * l;
        sums.x += x;
        sums.y += y;
        sums.xx += x * x;
        sums.xy += x * y;
        sums.yy += y * y;
        sums.lx += l * x;
        sums.ly += l * y;
    }
    window.sums = sums;
}

//! A window of the right image, whose pixels are between those of the image
static void mixPixels(const ushort* right, size_t step, int fx, int fy, short* values)
{
    const int bits = CornerMatching::fractionBits, half = 1 << (2 * bits - 1);
    const short w11 = (short)(fx * fy), w10 = (short)((fy << bits) - w11), w01 = (short)((fx << bits) - w11),
                w00 = (short)(2 * half - w11 - w10 - w01);
    for (int y = 0; y < CornerMatching::trackHeight; ++y)
    {
        const ushort *const a = right + y * step, *const b = a + step;
        short* const row = values + y * CornerMatching::trackWidth;
        HDP_VECTORIZED for (int x = 0; x < CornerMatching::trackWidth; ++x) row[x] =
            (short)((w00 * (short)a[x] + w01 * (short)a[x + 1] + w10 * (short)b[x] + w11 * (short)b[x + 1] + half) >>
                    (2 * bits));
    }
}

RightSums trackingSums(const ushort* right, size_t step, int fx, int fy, const TrackedWindow& window)
{
    short values[TrackedWindow::pixels];
    mixPixels(right, step, fx, fy, values);
    RightSums sums = {};
    HDP_VECTORIZED for (int i = 0; i < TrackedWindow::pixels; ++i)
    {
        const short r = values[i];
        sums.r += r;
        sums.rr += r * r;
        sums.lr += window.values[i] * r;
        sums.xr += window.gradientX[i] * r;
        sums.yr += window.gradientY[i] * r;
    }
    return sums;
}

void sumRows(const ushort* right, size_t step, int fx, int fy, const TrackedWindow& window, RowSums* rows)
{
    short values[TrackedWindow::pixels];
    mixPixels(right, step, fx, fy, values);
    for (int y = 0; y < CornerMatching::trackHeight; ++y)
    {
        const short* const left = window.values + y * CornerMatching::trackWidth;
        const short* const own = values + y * CornerMatching::trackWidth;
        RowSums sums = {};
        HDP_VECTORIZED for (int x = 0; x < CornerMatching::trackWidth; ++x)
        {
            sums.l += left[x];
            sums.r += own[x];
            sums.ll += left[x] * left[x];
            sums.rr += own[x] * own[x];
            sums.lr += left[x] * own[x];
        }
        rows[y] = sums;
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
