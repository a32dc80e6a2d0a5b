// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "support_points.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A quarter of the 3 x 3 Sobel derivatives of a row in x and y, around 128, in 8 bit; not at its ends.
@param above,row,below The row between its neighbours.
@param width Their length.
@param horizontal,vertical Receive the derivatives. */
void sobelGradients(const uchar* above, const uchar* row, const uchar* below, int width, uchar* horizontal,
                    uchar* vertical);

/** Matches the points of a part of the grid by descriptors.
@param gradients Of both images.
@param numDisparities Number of candidates.
@param rows,columns The part, in grid places, each point at least SupportPointGrid::margin pixels from the border.
@param buffer Of SupportPointGrid::bufferSize(columns.size(), numDisparities).
@param disparities Of grid place (0, 0); receives those of points with a match that passes the left-right check.
@param step From a row of disparities to the next one. */
void matchPoints(const GradientPair& gradients, int numDisparities, const Range& rows, const Range& columns,
                 short* buffer, short* disparities, size_t step);

/** Leaves out the points of a row that too few of their neighbours support.
@param row Disparities, or SupportPointGrid::noMatch, which is also in the SupportPointGrid::neighbourhood places
before and behind the row.
@param step From a row of disparities to the next one.
@param above,below Number of rows before and behind this one that have neighbours.
@param width Number of points.
@param points Receives the disparity or -1. */
void keepSupported(const short* row, ptrdiff_t step, int above, int below, int width, short* points);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef SupportPointGrid Grid;

const int smallestRange = 10; // a point with fewer possible disparities has no reliable match
const int minTexture = 10;
const float uniqueness = 0.95f;
const int maxLeftRightDifference = 2;
const int maxNeighbourDifference = 4;
const int minSupporters = 4;

//! The gradients at a pixel; the image is mirrored if mirror is -1.
template <int mirror> struct PixelGradients
{
    PixelGradients(const GradientPair& gradients, int y, int x)
    {
        const int side = mirror < 0;
        const ptrdiff_t at = y * gradients.step + (mirror < 0 ? gradients.width - 1 - x : x);
        step = gradients.step;
        horizontal = gradients.horizontal[side] + at;
        vertical = gradients.vertical[side] + at;
    }

    //! The sum of f(i-th gradient of the descriptor, of the pixel k places further on)
    template <typename F> int sum(int k, const F& f) const
    {
        const uchar *h = horizontal + k, *v = vertical + k;
        const int m = mirror;
        return f(0, h[-2 * step]) + f(1, h[-step - 2 * m]) + f(2, h[-step]) + f(3, h[-step + 2 * m]) + f(4, h[-m]) +
               2 * f(5, h[0]) + f(6, h[m]) + f(7, h[step - 2 * m]) + f(8, h[step]) + f(9, h[step + 2 * m]) +
               f(10, h[2 * step]) + f(11, v[-step]) + f(12, v[-m]) + f(13, v[m]) + f(14, v[step]);
    }

    const uchar *horizontal, *vertical;
    ptrdiff_t step;
};

template <int mirror> bool hasTexture(const PixelGradients<mirror>& pixel)
{
    return pixel.sum(0, [](int, uchar gradient) { return difference(gradient, (uchar)128); }) >= minTexture;
}

//! L1 distances of a descriptor to those of Grid::lanes pixels of the other image, which follow one another.
template <int mirror>
void compare(const PixelGradients<mirror>& pixel, const PixelGradients<-mirror>& others, short* distances)
{
    uchar own[15];
    pixel.sum(0, [&](int i, uchar gradient) { return own[i] = gradient; });
    HDP_VECTORIZED for (int k = 0; k < Grid::lanes; ++k) distances[k] =
        (short)others.sum(k, [&](int i, uchar gradient) { return difference(own[i], gradient); });
}

//! The largest dissimilarity that is too close to the lowest one for a unique match.
inline int largestClose(int lowest)
{
    int closest = (int)(lowest / uniqueness) + 1;
    while ((float)lowest < uniqueness * (float)closest)
        --closest;
    return closest;
}

struct Match
{
    int disparity, dissimilarity;
};

//! The lowest of `count` dissimilarities; disparity -1 if it is not unique: if another one, that was not the lowest so
//! far itself, is close to it, or there is no such other one.
inline Match uniqueMinimum(const short* dissimilarities, int count)
{
    short lowest = SHRT_MAX;
    for (int d = 0; d < count; ++d)
        lowest = std::min(lowest, dissimilarities[d]);
    const short closest = (short)largestClose(lowest);
    short firstClose = SHRT_MAX, lastClose = 0;
    for (int d = 0; d < count; ++d)
    {
        // Masks, as compilers make branches of conditions here
        const short position = (short)d, notClose = (short)(dissimilarities[d] <= closest ? 0 : SHRT_MAX);
        firstClose = std::min(firstClose, (short)(position | notClose));
        lastClose = std::max(lastClose, (short)(position & ~notClose));
    }

    // Those that are not close do not matter for whether a close one was the lowest so far.
    const Match none = { -1, lowest };
    short lowestSoFar = dissimilarities[firstClose];
    for (int d = firstClose + 1; d <= lastClose; ++d)
    {
        if (dissimilarities[d] < lowestSoFar)
            lowestSoFar = dissimilarities[d];
        else if (dissimilarities[d] <= closest)
            return none;
    }
    // The last close one is the lowest. One behind it was not the lowest so far.
    bool hasSecond = lastClose + 1 < count;
    for (int d = 1; d < count && !hasSecond; ++d)
        hasSecond = dissimilarities[d] >= dissimilarities[d - 1]; // the lowest one before, as there was no second one
    const Match match = { lastClose, lowest };
    return hasSecond ? match : none;
}

/** Matches the points of a part of the grid.

A corner of a left point is also one of its neighbours', so the distances of a row of corners to all candidates are
computed once, and kept for the next row of points. */
class PointMatcher
{
public:
    PointMatcher(const GradientPair& gradients, int numDisparities, const Range& columns, short* buffer)
        : gradients_(gradients), numDisparities_(numDisparities), columns_(columns),
          stride_(Grid::bufferRow(numDisparities)), above_(buffer),
          below_(above_ + (columns.size() + 1) * (size_t)stride_),
          corner_(below_ + (columns.size() + 1) * (size_t)stride_), dissimilarities_(corner_ + Grid::lanes)
    {
    }

    void compareCorners(int y)
    {
        std::swap(above_, below_);
        for (int i = 0; i <= columns_.size(); ++i)
        {
            const int x = (columns_.start + i) * Grid::spacing - Grid::corner;
            const int count = std::min(numDisparities_, x - Grid::reach + 1);
            const PixelGradients<1> own(gradients_, y, x);
            for (int d = 0; d < count; d += Grid::lanes)
                compare(own, PixelGradients<-1>(gradients_, y, x - d), below_ + i * (size_t)stride_ + d);
        }
    }

    //! The disparity of a point, or Grid::noMatch
    int match(int y, int column)
    {
        const int x = column * Grid::spacing, count = candidates(x);
        if (count == 0 || !hasTexture(PixelGradients<1>(gradients_, y, x)))
            return Grid::noMatch;
        const size_t at = (size_t)(column - columns_.start) * stride_;
        const short *c0 = above_ + at, *c1 = c0 + stride_, *c2 = below_ + at, *c3 = c2 + stride_;
        short* sums = dissimilarities_;
        HDP_VECTORIZED for (int d = 0; d < count; ++d) sums[d] = (short)(c0[d] + c1[d] + c2[d] + c3[d]);
        const Match left = uniqueMinimum(sums, count);
        return left.disparity >= 0 && matchesBack(y, x - left.disparity, left) ? left.disparity : Grid::noMatch;
    }

private:
    //! Number of candidates for a point with this many columns towards the side where its matches are.
    int candidates(int columns) const
    {
        const int largest = std::min(numDisparities_ - 1, columns - Grid::margin);
        return largest < smallestRange ? 0 : largest + 1;
    }

    //! Whether the unique match of a right point is at most maxLeftRightDifference from the match that led to it.
    bool matchesBack(int y, int x, const Match& left)
    {
        const int count = candidates(gradients_.width - 1 - x);
        if (count == 0 || !hasTexture(PixelGradients<-1>(gradients_, y, x)))
            return false;
        // The match is a candidate of the right point, too, so the lowest dissimilarity is not above that of the match,
        // and what is close to it is not above this.
        const int largest = largestClose(left.dissimilarity);
        compareBack(y, x, count, largest);
        // If the last candidate may be the lowest one, it matters how those before are ordered.
        if (dissimilarities_[count - 1] <= largest)
            compareBack(y, x, count, SHRT_MAX);
        const int disparity = uniqueMinimum(dissimilarities_, count).disparity;
        return disparity >= 0 && std::abs(disparity - left.disparity) <= maxLeftRightDifference;
    }

    //! The dissimilarities of a right point to its candidates; of those above `largest` something above it.
    void compareBack(int y, int x, int count, int largest)
    {
        for (int first = 0; first < count; first += Grid::lanes)
        {
            short* sums = dissimilarities_ + first;
            for (int i = 0; i < 4; ++i)
            {
                const int u = x + (i % 2 ? Grid::corner : -Grid::corner);
                const int v = y + (i < 2 ? -Grid::corner : Grid::corner);
                const PixelGradients<-1> own(gradients_, v, u);
                const PixelGradients<1> others(gradients_, v, u + first);
                compare(own, others, i == 0 ? sums : corner_);
                if (i > 0)
                    HDP_VECTORIZED for (int k = 0; k < Grid::lanes; ++k) sums[k] = (short)(sums[k] + corner_[k]);
                short lowest = SHRT_MAX;
                for (int k = 0; k < Grid::lanes; ++k)
                    lowest = std::min(lowest, sums[k]);
                if (lowest > largest)
                    break;
            }
        }
    }

    const GradientPair& gradients_;
    const int numDisparities_;
    const Range columns_;
    const int stride_;
    short *above_, *below_; // distances of each corner of the row to each candidate
    short* corner_;
    short* dissimilarities_; // 4 * 16 * 255 fits
};

} // namespace

void sobelGradients(const uchar* above, const uchar* row, const uchar* below, int width, uchar* horizontal,
                    uchar* vertical)
{
    HDP_VECTORIZED for (int x = 1; x < width - 1; ++x)
    {
        const short dx =
            (short)(above[x + 1] - above[x - 1] + 2 * (row[x + 1] - row[x - 1]) + below[x + 1] - below[x - 1]);
        const short dy = (short)(below[x - 1] - above[x - 1] + 2 * (below[x] - above[x]) + below[x + 1] - above[x + 1]);
        horizontal[x] = (uchar)std::max(0, std::min(255, (dx >> 2) + 128));
        vertical[x] = (uchar)std::max(0, std::min(255, (dy >> 2) + 128));
    }
}

void matchPoints(const GradientPair& gradients, int numDisparities, const Range& rows, const Range& columns,
                 short* buffer, short* disparities, size_t step)
{
    PointMatcher matcher(gradients, numDisparities, columns, buffer);
    matcher.compareCorners(rows.start * Grid::spacing - Grid::corner);
    for (int y = rows.start; y < rows.end; ++y)
    {
        matcher.compareCorners(y * Grid::spacing + Grid::corner);
        for (int x = columns.start; x < columns.end; ++x)
            disparities[y * step + x] = (short)matcher.match(y * Grid::spacing, x);
    }
}

void keepSupported(const short* row, ptrdiff_t step, int above, int below, int width, short* points)
{
    std::fill(points, points + width, (short)0);
    for (int v = -above; v <= below; ++v)
        for (int u = -Grid::neighbourhood; u <= Grid::neighbourhood; ++u)
        {
            const short* neighbours = row + v * step + u;
            HDP_VECTORIZED for (int x = 0; x < width; ++x)
            {
                const ushort difference = (ushort)(neighbours[x] - row[x] + maxNeighbourDifference);
                points[x] = (short)(points[x] + (difference <= 2 * maxNeighbourDifference));
            }
        }
    HDP_VECTORIZED for (int x = 0; x < width; ++x) points[x] =
        points[x] >= minSupporters && row[x] >= 0 ? row[x] : (short)-1;
}

#endif
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
