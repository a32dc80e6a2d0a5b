// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "support_points.hpp"

#include "opencv2/core/hal/intrin.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

// In pixels but where it is said
const int spacing = 4;
const int corner = 2;              // descriptors are compared at (+-corner, +-corner) of a point
const int reach = 3;               // of a descriptor: 2 for its samples, 1 for their gradients
const int margin = corner + reach; // of a point to the border
const int neighbourhood = 4;       // of points that support one another, in grid places
const int descriptorSize = 16;

const int minRange = 10; // a point with no more possible disparities has no reliable match
const int minTexture = 10;
const float uniqueness = 0.95f;
const int maxLeftRightDifference = 2;
const int maxNeighbourDifference = 4;
const int minSupporters = 4;

//! The descriptors of the pixels of an image that are far enough from its border, in even rows: those of points and
//! their corners.
void describe(const Mat& grey, SupportPointBuffers& buffers, Mat& descriptors)
{
    Mat &horizontal = buffers.horizontal, &vertical = buffers.vertical;
    // A quarter, rounded down, around 128
    Sobel(grey, buffers.derivative, CV_16S, 1, 0);
    buffers.derivative.convertTo(horizontal, CV_8U, 0.25, 128 - 0.375);
    Sobel(grey, buffers.derivative, CV_16S, 0, 1);
    buffers.derivative.convertTo(vertical, CV_8U, 0.25, 128 - 0.375);
    descriptors.create((grey.rows + 1) / 2, grey.cols * descriptorSize, CV_8U);
    parallelFor(descriptors.rows, [&](int row) {
        const int y = 2 * row;
        if (y < reach || y >= grey.rows - reach)
            return;
        const ptrdiff_t step = horizontal.step;
        for (int x = reach; x < grey.cols - reach; ++x)
        {
            const uchar *h = horizontal.ptr(y) + x, *v = vertical.ptr(y) + x;
            const uchar samples[descriptorSize] = { h[-2 * step], h[-step - 2], h[-step],    h[-step + 2],
                                                    h[-1],        h[0],         h[0],        h[1],
                                                    h[step - 2],  h[step],      h[step + 2], h[2 * step],
                                                    v[-step],     v[-1],        v[1],        v[step] };
            std::copy(samples, samples + descriptorSize, descriptors.ptr(row) + x * descriptorSize);
        }
    });
}

//! Matches points of one image with the other one.
struct PointMatcher
{
    const Mat (&descriptors)[2];
    const Size size;
    const int numDisparities;

    //! The disparity of a point of the left image whose match is unique and leads back to it, or -1
    int match(int x, int y) const
    {
        const int disparity = bestDisparity(0, x, y);
        if (disparity < 0)
            return -1;
        const int back = bestDisparity(1, x - disparity, y);
        return back >= 0 && std::abs(back - disparity) <= maxLeftRightDifference ? disparity : -1;
    }

    const uchar* descriptor(int side, int x, int y) const { return descriptors[side].ptr(y / 2) + x * descriptorSize; }

    //! The disparity of a point of the left (side 0) or right image, or -1 if it has no unique match
    int bestDisparity(int side, int x, int y) const
    {
        if (x < margin || x >= size.width - margin || y < margin || y >= size.height - margin)
            return -1;
        const int last = std::min(numDisparities - 1, side == 0 ? x - margin : size.width - 1 - margin - x);
        const int texture = (int)v_reduce_sad(v_load(descriptor(side, x, y)), v_setall_u8(128)); // 128: no gradient
        if (last < minRange || texture < minTexture)
            return -1;
        const uchar *own[4], *others[4];
        for (int i = 0; i < 4; ++i)
        {
            const int u = x + (i % 2 ? corner : -corner), v = y + (i < 2 ? -corner : corner);
            own[i] = descriptor(side, u, v);
            others[i] = descriptor(1 - side, u, v);
        }
        const ptrdiff_t next = side == 0 ? -descriptorSize : descriptorSize;
        int lowest = INT_MAX, second = INT_MAX, best = -1; // second: of those that were not the lowest so far
        for (int d = 0; d <= last; ++d)
        {
            int sum = 0;
            for (int i = 0; i < 4; ++i)
                sum += (int)v_reduce_sad(v_load(own[i]), v_load(others[i] + d * next)); // of 16 bytes
            if (sum < lowest)
            {
                lowest = sum;
                best = d;
            }
            else
                second = std::min(second, sum);
        }
        return second < INT_MAX && (float)lowest < uniqueness * (float)second ? best : -1;
    }
};

//! Whether enough of the points around one, itself among them, have its disparity
bool isSupported(const Mat& matches, int y, int x)
{
    const int own = matches.at<short>(y, x);
    int supporters = 0;
    for (int v = std::max(y - neighbourhood, 0); v <= std::min(y + neighbourhood, matches.rows - 1); ++v)
        for (int u = std::max(x - neighbourhood, 0); u <= std::min(x + neighbourhood, matches.cols - 1); ++u)
        {
            const int other = matches.at<short>(v, u);
            supporters += other >= 0 && std::abs(other - own) <= maxNeighbourDifference;
        }
    return supporters >= minSupporters;
}

} // namespace

void findSupportPoints(const Mat& left, const Mat& right, int numDisparities, SupportPointBuffers& buffers, Mat& points)
{
    const Mat images[] = { left, right };
    for (int side = 0; side < 2; ++side)
    {
        if (left.channels() == 3)
            cvtColor(images[side], buffers.grey, COLOR_BGR2GRAY);
        describe(left.channels() == 3 ? buffers.grey : images[side], buffers, buffers.descriptors[side]);
    }
    const PointMatcher matcher = { buffers.descriptors, left.size(), numDisparities };
    Mat& matches = buffers.matches;
    matches.create((left.rows + spacing - 1) / spacing, (left.cols + spacing - 1) / spacing, CV_16S);
    points.create(matches.size(), CV_16S);
    parallelFor(matches.rows, [&](int y) {
        for (int x = 0; x < matches.cols; ++x)
            matches.at<short>(y, x) = (short)matcher.match(spacing * x, spacing * y);
    });
    for (int y = 0; y < matches.rows; ++y)
        for (int x = 0; x < matches.cols; ++x)
        {
            const short match = matches.at<short>(y, x);
            points.at<short>(y, x) = match >= 0 && isSupported(matches, y, x) ? match : (short)-1;
        }
}

void disparityHistogram(const Mat& points, int numDisparities, std::vector<double>& histogram)
{
    histogram.assign(numDisparities, 0);
    for (const short disparity : Mat_<short>(points))
        if (disparity >= 0 && disparity < numDisparities)
            ++histogram[disparity];
    if (countNonZero(histogram) == 0)
        histogram.assign(numDisparities, 1);
}

}}} // namespace cv::stereo::hdp
