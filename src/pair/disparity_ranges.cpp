// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_ranges.hpp"

#include "../base/vectorized.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

// Of values, not references as those of the standard: see CONTRIBUTING.md on SIMD
int lesser(int a, int b) { return a < b ? a : b; }
int greater(int a, int b) { return a > b ? a : b; }

//! A limit in 1 / subpixelScale pixel, whole pixels if isWhole; the limit of all if it is no number
int toUnits(float limit, bool isWhole, bool isLargest, int limitOfAll)
{
    if (std::isnan(limit))
        return limitOfAll;
    const float step = isWhole ? 1.f : (float)subpixelScale,
                steps = clamped(limit, (float)SHRT_MIN, (float)SHRT_MAX) * step; // exact
    return (isLargest ? cvFloor(steps) : cvCeil(steps)) * (isWhole ? subpixelScale : 1);
}

//! Hulls of 2 x 2 intervals
void halveIntervals(const Mat& intervals, Mat& half)
{
    half.create(intervals.rows / 2, intervals.cols / 2, CV_16UC2);
    parallel_for_(Range(0, half.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort *const a = intervals.ptr<ushort>(2 * y), *const b = intervals.ptr<ushort>(2 * y + 1);
            ushort* const hull = half.ptr<ushort>(y);
            HDP_VECTORIZED for (int x = 0; x < half.cols; ++x)
            {
                const int firstA = lesser(a[4 * x], a[4 * x + 2]), firstB = lesser(b[4 * x], b[4 * x + 2]);
                const int lastA = greater(a[4 * x + 1], a[4 * x + 3]), lastB = greater(b[4 * x + 1], b[4 * x + 3]);
                hull[2 * x] = (ushort)lesser(firstA, firstB);
                hull[2 * x + 1] = (ushort)greater(lastA, lastB);
            }
        }
    });
}

void resizeNearest(const Mat& map, Size size, Mat& resized)
{
    resized.create(size, CV_16S);
    for (int y = 0, rowBefore = -1; y < size.height; ++y)
    {
        const int row = (int)((int64)y * map.rows / size.height);
        if (row == rowBefore)
            std::copy_n(resized.ptr<short>(y - 1), size.width, resized.ptr<short>(y));
        else
            for (int x = 0; x < size.width; ++x)
                resized.ptr<short>(y)[x] = map.ptr<short>(row)[(int64)x * map.cols / size.width];
        rowBefore = row;
    }
}

//! Limits of one kind for each pixel, in 1 / subpixelScale pixel; none is beyond the limit of all.
void expandLimits(const Mat& given, int limitOfAll, bool isWhole, bool isLargest, Size size, Mat& expanded)
{
    Mat coarse;
    Mat& limits = given.size() == size ? expanded : coarse;
    if (given.depth() == CV_16S)
        given.convertTo(limits, CV_16S, subpixelScale);
    else
    {
        limits.create(given.size(), CV_16S);
        for (int y = 0; y < limits.rows; ++y)
            for (int x = 0; x < limits.cols; ++x)
                limits.ptr<short>(y)[x] =
                    saturate_cast<short>(toUnits(given.ptr<float>(y)[x], isWhole, isLargest, limitOfAll));
    }
    if (isLargest)
        min(limits, limitOfAll, limits);
    else
        max(limits, limitOfAll, limits);
    if (!coarse.empty())
        resizeNearest(coarse, size, expanded);
}

} // namespace

void expandRanges(const Mat& smallest, const Mat& largest, Size size, Range disparities, bool isWhole,
                  PixelRanges& ranges)
{
    if (smallest.empty())
    {
        ranges = PixelRanges();
        return;
    }
    expandLimits(smallest, disparities.start * subpixelScale, isWhole, false, size, ranges.smallest);
    expandLimits(largest, disparities.end * subpixelScale, isWhole, true, size, ranges.largest);
}

void buildIntervals(const PixelRanges& ranges, int minDisparity, int extension, const std::vector<int>& numDisparities,
                    std::vector<Mat>& units, std::vector<Mat>& intervals)
{
    intervals.resize(ranges.isEmpty() ? 0 : numDisparities.size());
    units.resize(intervals.size());
    if (ranges.isEmpty())
        return;
    // In units of the image first, so that layers know fractions
    const int largest = (numDisparities[0] - 1) * subpixelScale, offset = minDisparity * subpixelScale;
    const int columns = ranges.smallest.cols;
    const Size size(columns + extension, ranges.smallest.rows);
    units[0].create(size, CV_16UC2);
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const short *lowest = ranges.smallest.ptr<short>(y), *highest = ranges.largest.ptr<short>(y);
            ushort* const row = units[0].ptr<ushort>(y);
            ushort* const own = row + 2 * extension;
            HDP_VECTORIZED for (int x = 0; x < columns; ++x)
            {
                own[2 * x] = (ushort)lesser(greater(lowest[x] - offset, 0), largest);
                own[2 * x + 1] = (ushort)lesser(greater(highest[x] - offset, 0), largest);
            }
            for (int x = 0; x < 2 * extension; ++x)
                row[x] = own[x % 2];
        }
    });
    for (size_t layer = 0; layer < numDisparities.size(); ++layer)
    {
        const int shift = 4 + (int)layer, last = numDisparities[layer] - 1;
        static_assert(subpixelScale == 1 << 4, "units of a candidate of layer 0");
        if (layer > 0)
            halveIntervals(units[layer - 1], units[layer]);
        const Mat& exact = units[layer];
        Mat& ofLayer = intervals[layer];
        ofLayer.create(exact.size(), CV_16UC2);
        parallel_for_(Range(0, exact.rows), [&](const Range& rows) {
            for (int y = rows.start; y < rows.end; ++y)
            {
                const ushort* const own = exact.ptr<ushort>(y);
                ushort* const interval = ofLayer.ptr<ushort>(y);
                HDP_VECTORIZED for (int x = 0; x < exact.cols; ++x)
                {
                    const int first = lesser(own[2 * x] >> shift, last);
                    const int end = (own[2 * x + 1] + (1 << shift) - 1) >> shift;
                    interval[2 * x] = (ushort)first;
                    interval[2 * x + 1] = (ushort)lesser(greater(end, first), last);
                }
            }
        });
    }
}

void doubleIntervals(const Mat& intervals, int candidates, Mat& doubled)
{
    doubled.create(intervals.size(), CV_16UC2);
    for (int y = 0; y < intervals.rows; ++y)
        for (int x = 0; x < intervals.cols; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            const int first = std::min(2 * own.first, candidates - 1),
                      last = std::min(2 * own.last + 1, candidates - 1);
            doubled.ptr<DisparityInterval>(y)[x] = { (ushort)first, (ushort)last };
        }
}

void intersectIntervals(const Mat& intervals, Mat& others)
{
    parallel_for_(Range(0, others.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* const own = intervals.ptr<ushort>(y);
            ushort* const other = others.ptr<ushort>(y);
            HDP_VECTORIZED for (int x = 0; x < others.cols; ++x)
            {
                const int first = greater(own[2 * x], other[2 * x]), last = lesser(own[2 * x + 1], other[2 * x + 1]);
                const bool isEmpty = last < first;
                other[2 * x] = (ushort)(isEmpty ? own[2 * x] : first);
                other[2 * x + 1] = (ushort)(isEmpty ? own[2 * x + 1] : last);
            }
        }
    });
}

void moveIntoIntervals(const Mat& intervals, Mat& disparity)
{
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* const own = intervals.ptr<ushort>(y);
            ushort* const row = disparity.ptr<ushort>(y);
            HDP_VECTORIZED for (int x = 0; x < disparity.cols; ++x)
            {
                const int first = own[2 * x] * subpixelScale, last = own[2 * x + 1] * subpixelScale;
                row[x] = (ushort)lesser(greater(row[x], first), last);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
