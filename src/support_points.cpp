// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "support_points.hpp"

#include "opencv2/core/hal/intrin.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

const int gridStep = 4;
const int corner = 2;              // descriptors are compared at (+-corner, +-corner) of a point
const int reach = 3;               // of a descriptor: 2 for its samples, 1 for their gradients
const int margin = corner + reach; // of a point to the border
const int smallestRange = 10;      // a point with fewer possible disparities has no reliable match
const int minTexture = 10;
const float uniqueness = 0.95f;
const int maxLeftRightDifference = 2;
const int neighbourhood = 4; // in grid places
const int maxNeighbourDifference = 4;
const int minSupporters = 4;
const int descriptorSize = 16;

//! A quarter of the 3 x 3 Sobel derivatives of grey in x and y, around 128, in 8 bit.
void sobelGradients(const Mat& grey, Mat& gradients)
{
    gradients.create(grey.size(), CV_8UC2);
    parallel_for_(Range(0, grey.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            if (y == 0 || y == grey.rows - 1)
                continue; // no descriptor reaches there
            const uchar *above = grey.ptr(y - 1), *row = grey.ptr(y), *below = grey.ptr(y + 1);
            uchar* gradient = gradients.ptr(y);
            for (int x = 1; x < grey.cols - 1; ++x)
            {
                const int dx =
                    above[x + 1] - above[x - 1] + 2 * (row[x + 1] - row[x - 1]) + below[x + 1] - below[x - 1];
                const int dy = below[x - 1] - above[x - 1] + 2 * (below[x] - above[x]) + below[x + 1] - above[x + 1];
                gradient[2 * x] = saturate_cast<uchar>((dx >> 2) + 128);
                gradient[2 * x + 1] = saturate_cast<uchar>((dy >> 2) + 128);
            }
        }
    });
}

//! The 16 gradients around (x, y): 12 of the horizontal, 4 of the vertical ones.
void describe(const Mat& gradients, int y, int x, uchar* descriptor)
{
    static const schar horizontal[12][2] = { { 0, -2 }, { -2, -1 }, { 0, -1 }, { 2, -1 }, { -1, 0 }, { 0, 0 },
                                             { 0, 0 },  { 1, 0 },   { -2, 1 }, { 0, 1 },  { 2, 1 },  { 0, 2 } };
    static const schar vertical[4][2] = { { 0, -1 }, { -1, 0 }, { 1, 0 }, { 0, 1 } };
    for (int i = 0; i < 12; ++i)
        descriptor[i] = gradients.ptr(y + horizontal[i][1])[2 * (x + horizontal[i][0])];
    for (int i = 0; i < 4; ++i)
        descriptor[12 + i] = gradients.ptr(y + vertical[i][1])[2 * (x + vertical[i][0]) + 1];
}

//! The descriptors of all columns of a row that have one.
void describeRow(const Mat& gradients, int y, std::vector<uchar>& descriptors)
{
    descriptors.resize((size_t)gradients.cols * descriptorSize);
    for (int x = reach; x < gradients.cols - reach; ++x)
        describe(gradients, y, x, &descriptors[(size_t)x * descriptorSize]);
}

bool hasTexture(const Mat& gradients, int y, int x)
{
    uchar descriptor[descriptorSize];
    describe(gradients, y, x, descriptor);
    int texture = 0;
    for (int i = 0; i < descriptorSize; ++i)
        texture += std::abs(descriptor[i] - 128);
    return texture >= minTexture;
}

//! L1 distances of a descriptor to `count` others that follow one another, forwards (step 1) or backwards (step -1).
void compare(const uchar* descriptor, const uchar* others, int step, int count, ushort* distances)
{
#if CV_SIMD128
    const v_uint8x16 reference = v_load(descriptor);
    for (int d = 0; d < count; ++d, others += step * descriptorSize)
        distances[d] = (ushort)v_reduce_sad(reference, v_load(others));
#else
    for (int d = 0; d < count; ++d, others += step * descriptorSize)
    {
        int distance = 0;
        for (int i = 0; i < descriptorSize; ++i)
            distance += std::abs(descriptor[i] - others[i]);
        distances[d] = (ushort)distance;
    }
#endif
}

//! The largest dissimilarity that is too close to the lowest one for a unique match.
int largestClose(int lowest)
{
    int closest = (int)(lowest / uniqueness) + 1;
    while ((float)lowest < uniqueness * (float)closest)
        --closest;
    return closest;
}

//! The lowest of `count` dissimilarities, each the sum of those of four corners; -1 if it is not unique: if another
//! one, that was not the lowest so far itself, is close to it, or there is no such other one.
int uniqueMinimum(const ushort* const corners[4], int count, std::vector<short>& dissimilarities)
{
    dissimilarities.resize(count);
    const ushort *c0 = corners[0], *c1 = corners[1], *c2 = corners[2], *c3 = corners[3];
    short* sums = dissimilarities.data();
    short lowest = SHRT_MAX; // 4 * 16 * 255 fits
    for (int d = 0; d < count; ++d)
    {
        sums[d] = (short)(c0[d] + c1[d] + c2[d] + c3[d]);
        lowest = std::min(lowest, sums[d]);
    }

    const int closest = largestClose(lowest);
    short close = 0;
    for (int d = 0; d < count; ++d)
        close = (short)(close + (sums[d] <= (short)closest));

    const int winner = (int)(std::find(sums, sums + count, lowest) - sums);
    if (close == 1 && winner + 1 < count)
        return winner;
    short lowestSoFar = SHRT_MAX;
    bool hasSecond = false;
    for (int d = 0; d < count; ++d)
    {
        if (sums[d] < lowestSoFar)
            lowestSoFar = sums[d];
        else if (sums[d] <= closest)
            return -1;
        else
            hasSecond = true;
    }
    return hasSecond ? winner : -1;
}

/** Matches the points of some rows of the grid.

A corner of a left point is also one of its neighbours', so the distances of a row of corners to all candidates are
computed once, and kept for the next row of points. */
class PointMatcher
{
public:
    PointMatcher(const Mat gradients[2], int numDisparities)
        : left_(gradients[0]), right_(gradients[1]), width_(left_.cols), numDisparities_(numDisparities)
    {
    }

    void matchRow(int y, short* disparities)
    {
        if (belowY_ == y - corner)
            std::swap(above_, below_);
        else
            prepareCorners(y - corner, above_);
        prepareCorners(y + corner, below_);
        belowY_ = y + corner;

        for (int x = firstPoint(); x <= width_ - 1 - margin; x += gridStep)
        {
            const int disparity = matchLeft(y, x);
            if (disparity >= 0 && matchesBack(y, x - disparity, disparity))
                disparities[x / gridStep] = (short)disparity;
        }
    }

    static int firstPoint() { return (margin + gridStep - 1) / gridStep * gridStep; }

private:
    struct CornerRow
    {
        std::vector<uchar> left, right; // descriptors of each column
        std::vector<ushort> distances;  // of each corner on the grid to each candidate
    };

    //! Number of candidates for a point with this many columns towards the side where its matches are.
    int candidates(int columns) const
    {
        const int largest = std::min(numDisparities_ - 1, columns - margin);
        return largest < smallestRange ? 0 : largest + 1;
    }

    void prepareCorners(int y, CornerRow& row) const
    {
        describeRow(left_, y, row.left);
        describeRow(right_, y, row.right);
        const int corners = width_ / gridStep + 1;
        row.distances.resize((size_t)corners * numDisparities_);
        for (int i = 0; i < corners; ++i)
        {
            const int x = i * gridStep + corner;
            if (x >= reach && x < width_ - reach)
                compare(&row.left[(size_t)x * descriptorSize], &row.right[(size_t)x * descriptorSize], -1,
                        std::min(numDisparities_, x - reach + 1), &row.distances[(size_t)i * numDisparities_]);
        }
    }

    int matchLeft(int y, int x)
    {
        const int count = candidates(x);
        if (count == 0 || !hasTexture(left_, y, x))
            return -1;
        const size_t before = (size_t)(x / gridStep - 1) * numDisparities_, behind = before + numDisparities_;
        const ushort* const corners[4] = { &above_.distances[before], &above_.distances[behind],
                                           &below_.distances[before], &below_.distances[behind] };
        return uniqueMinimum(corners, count, dissimilarities_);
    }

    //! Whether the unique match of a right point is at most maxLeftRightDifference from the disparity.
    bool matchesBack(int y, int x, int disparity)
    {
        const int count = candidates(width_ - 1 - x);
        const int first = std::max(disparity - maxLeftRightDifference, 0);
        const int last = std::min(disparity + maxLeftRightDifference, count - 1);
        if (first > last || !hasTexture(right_, y, x))
            return false;
        int lowest = INT_MAX;
        for (int d = first; d <= last; ++d)
            lowest = std::min(lowest, dissimilarity(x, d));

        // Only candidates that are close to the lowest one can stand against it, and those are few: one corner rules
        // out most of the others.
        const int closest = largestClose(lowest);
        distances_.resize(count);
        const size_t at = (size_t)(x - corner) * descriptorSize;
        compare(&above_.right[at], &above_.left[at], 1, count, distances_.data());
        int winner = -1, lowestSoFar = INT_MAX;
        for (int d = 0; d < count; ++d)
        {
            if (distances_[d] > closest)
                continue;
            const int here = dissimilarity(x, d);
            if (here < lowestSoFar && here <= closest)
            {
                lowestSoFar = here;
                winner = d;
            }
            else if (here <= closest)
                return false;
        }
        // A later candidate than the winner is the second one; if there is none, an earlier one must not have been the
        // lowest so far.
        return winner >= first && winner <= last && (winner + 1 < count || !areDescending(x, count));
    }

    //! Of a right point and a candidate.
    int dissimilarity(int x, int d) const
    {
        int sum = 0;
        for (int i = 0; i < 4; ++i)
        {
            const CornerRow& row = i < 2 ? above_ : below_;
            const size_t at = (size_t)(x + (i % 2 ? corner : -corner)) * descriptorSize;
            ushort distance;
            compare(&row.right[at], &row.left[at + (size_t)d * descriptorSize], 1, 1, &distance);
            sum += distance;
        }
        return sum;
    }

    bool areDescending(int x, int count) const
    {
        for (int d = 1; d < count; ++d)
            if (dissimilarity(x, d) >= dissimilarity(x, d - 1))
                return false;
        return true;
    }

    const Mat &left_, &right_;
    const int width_, numDisparities_;
    CornerRow above_, below_;
    int belowY_ = -1;
    std::vector<ushort> distances_;
    std::vector<short> dissimilarities_;
};

//! Leaves out the points that too few of their neighbours support.
void keepConsistent(const Mat& candidates, Mat& points)
{
    points.create(candidates.size(), CV_16S);
    parallel_for_(Range(0, points.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            for (int x = 0; x < points.cols; ++x)
            {
                const int disparity = candidates.at<short>(y, x);
                int supporters = 0;
                if (disparity >= 0)
                    for (int v = std::max(y - neighbourhood, 0); v <= std::min(y + neighbourhood, points.rows - 1); ++v)
                    {
                        const short* row = candidates.ptr<short>(v);
                        for (int u = std::max(x - neighbourhood, 0); u <= std::min(x + neighbourhood, points.cols - 1);
                             ++u)
                            supporters += row[u] >= 0 && std::abs(row[u] - disparity) <= maxNeighbourDifference;
                    }
                points.at<short>(y, x) = (short)(supporters >= minSupporters ? disparity : -1);
            }
        }
    });
}

} // namespace

void findSupportPoints(const Mat& left, const Mat& right, int numDisparities, SupportPointBuffers& buffers, Mat& points)
{
    const Mat images[] = { left, right };
    for (int side = 0; side < 2; ++side)
    {
        if (left.channels() == 3)
            cvtColor(images[side], buffers.grey[side], COLOR_BGR2GRAY);
        sobelGradients(left.channels() == 3 ? buffers.grey[side] : images[side], buffers.gradients[side]);
    }

    Mat& candidates = buffers.candidates;
    candidates.create((left.rows + gridStep - 1) / gridStep, (left.cols + gridStep - 1) / gridStep, CV_16S);
    candidates.setTo(Scalar::all(-1));
    const int first = PointMatcher::firstPoint() / gridStep;
    const int last = (left.rows - 1 - margin) / gridStep; // may be negative or before the first
    const auto matchRows = [&](const Range& rows) {
        PointMatcher matcher(buffers.gradients, numDisparities);
        for (int y = rows.start; y < rows.end; ++y)
            matcher.matchRow(y * gridStep, candidates.ptr<short>(y));
    };
    if (first <= last && left.cols > 2 * margin)
        parallel_for_(Range(first, last + 1), matchRows, 16); // long runs of rows share their corners
    keepConsistent(candidates, points);
}

void disparityHistogram(const Mat& points, int numDisparities, std::vector<double>& histogram)
{
    histogram.assign(numDisparities, 0);
    bool found = false;
    for (int y = 0; y < points.rows; ++y)
        for (int x = 0; x < points.cols; ++x)
        {
            const int disparity = points.at<short>(y, x);
            if (disparity > 0 && disparity < numDisparities)
            {
                ++histogram[disparity];
                found = true;
            }
        }
    if (!found)
        histogram.assign(numDisparities, 1);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
