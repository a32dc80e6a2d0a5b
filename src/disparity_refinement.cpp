// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_refinement.hpp"
#include "disparity_refinement.simd.hpp"
#include "disparity_refinement.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "vectorized.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

void dispatchFill(ushort* disparity, const uchar* residual, int width, OcclusionScratch& scratch)
{
    CV_CPU_DISPATCH(fillOccludedRow, (disparity, residual, width, scratch), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchMedian(const ushort* const* rows, int size, int width, short* const* sorted, ushort* filtered)
{
    CV_CPU_DISPATCH(medianRow, (rows, size, width, sorted, filtered), CV_CPU_DISPATCH_MODES_ALL);
}

//! What the right image has at a pixel's match
enum Match
{
    VISIBLE,
    OCCLUDED, // a nearer pixel
    OUTSIDE   // nothing, it ends before
};

/** Compares each disparity with the largest one that maps to the same column of the right image.
@param disparity CV_16SC1 or CV_16UC1 (T), in 1 / subpixelScale pixel.
@param maxDiff Largest difference, in pixels, of a visible pixel.
@param invalid Disparity of pixels that map to no column, or a value that none has.
@param visit Called with row, column and Match of each pixel, from left to right, rows side by side. */
template <typename T, typename Visit>
void checkLeftRight(const Mat& disparity, int maxDiff, int invalid, const Visit& visit)
{
    const int64 largestDifference = (int64)maxDiff * subpixelScale;
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        std::vector<int> nearest(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            const T* row = disparity.ptr<T>(y);
            const auto column = [&](int x) { return x - cvRound(row[x] / (double)subpixelScale); };
            std::fill(nearest.begin(), nearest.end(), SHRT_MIN);
            for (int x = 0; x < disparity.cols; ++x)
            {
                const int right = column(x);
                if (row[x] != invalid && right >= 0 && right < disparity.cols)
                    nearest[right] = std::max<int>(nearest[right], row[x]);
            }
            for (int x = 0; x < disparity.cols; ++x)
            {
                const int right = column(x);
                const bool isInside = right >= 0 && right < disparity.cols;
                visit(y, x, !isInside ? OUTSIDE : nearest[right] - row[x] > largestDifference ? OCCLUDED : VISIBLE);
            }
        }
    });
}

} // namespace

void medianDisparity(const Mat& disparity, int size, Mat& filtered)
{
    filtered.create(disparity.size(), CV_16U);
    parallel_for_(Range(0, disparity.rows), [&](const Range& range) {
        const int radius = size / 2, width = disparity.cols;
        Mat buffer(size, width + 2 * radius, CV_16S);
        std::vector<short*> sorted(size);
        std::vector<const ushort*> rows(size);
        for (int i = 0; i < size; ++i)
            sorted[i] = buffer.ptr<short>(i) + radius;
        for (int y = range.start; y < range.end; ++y)
        {
            for (int i = 0; i < size; ++i)
                rows[i] = disparity.ptr<ushort>(std::min(std::max(y + i - radius, 0), disparity.rows - 1));
            dispatchMedian(rows.data(), size, width, sorted.data(), filtered.ptr<ushort>(y));
        }
    });
}

void fillOccluded(Mat& disparity, const Mat& residual)
{
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        OcclusionScratch scratch(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
            dispatchFill(disparity.ptr<ushort>(y), residual.ptr(y), disparity.cols, scratch);
    });
}

void upsampleDisparity(const Mat& upper, Size size, Mat& disparity)
{
    disparity.create(size, CV_16U);
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const auto clampRow = [&](int row) { return std::min(std::max(row, 0), upper.rows - 1); };
            const ushort* own = upper.ptr<ushort>(clampRow(y / 2));
            const ushort* beside = upper.ptr<ushort>(clampRow(y % 2 ? y / 2 + 1 : y / 2 - 1));
            ushort* row = disparity.ptr<ushort>(y);
            const auto mean = [&](int x, int next) {
                const int d = own[x];
                const auto sameSurface = [&](int other) { return std::abs(other - d) <= subpixelScale ? other : d; };
                return (ushort)((9 * d + 3 * sameSurface(own[next]) + 3 * sameSurface(beside[x]) +
                                 sameSurface(beside[next]) + 4) /
                                8);
            };
            const int last = upper.cols - 1;
            HDP_VECTORIZED for (int x = 1; x < last; ++x)
            {
                row[2 * x] = mean(x, x - 1);
                row[2 * x + 1] = mean(x, x + 1);
            }
            row[0] = mean(0, 0);
            if (size.width > 1)
                row[1] = mean(0, std::min(1, last));
            for (int x = std::max(2 * last, 2); x < size.width; ++x) // a last odd column is that pixel's, too
                row[x] = mean(last, x % 2 ? last : x / 2 - 1);
        }
    });
}

void rejectOccluded(Mat& disparity, int maxDiff, short invalid)
{
    const auto reject = [&](int y, int x, Match match) {
        if (match == OCCLUDED)
            disparity.at<short>(y, x) = invalid;
    };
    checkLeftRight<short>(disparity, maxDiff, invalid, reject);
}

void findStable(const Mat& disparity, int maxDiff, Mat& stable)
{
    stable.create(disparity.size(), CV_8U);
    const auto mark = [&](int y, int x, Match match) { stable.at<uchar>(y, x) = match == VISIBLE ? 255 : 0; };
    const int none = -1; // all are valid
    checkLeftRight<ushort>(disparity, maxDiff, none, mark);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
