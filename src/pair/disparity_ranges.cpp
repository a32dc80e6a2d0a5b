// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_ranges.hpp"

#include "../base/vectorized.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

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
    for (int y = 0; y < half.rows; ++y)
        for (int x = 0; x < half.cols; ++x)
        {
            DisparityInterval hull = { USHRT_MAX, 0 };
            for (int i = 0; i < 4; ++i)
            {
                const DisparityInterval& own = intervals.ptr<DisparityInterval>(2 * y + i / 2)[2 * x + i % 2];
                hull.first = std::min(hull.first, own.first);
                hull.last = std::max(hull.last, own.last);
            }
            half.ptr<DisparityInterval>(y)[x] = hull;
        }
}

void resizeNearest(const Mat& map, Size size, Mat& resized)
{
    if (map.size() == size)
    {
        resized = map;
        return;
    }
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

} // namespace

void expandRanges(const Mat& smallest, const Mat& largest, Size size, Range disparities, bool isWhole,
                  PixelRanges& ranges)
{
    ranges = PixelRanges();
    if (smallest.empty())
        return;
    Mat given[2];
    smallest.convertTo(given[0], CV_32F);
    largest.convertTo(given[1], CV_32F);
    Mat expanded[2];
    for (int i = 0; i < 2; ++i)
    {
        Mat coarse(given[i].size(), CV_16S);
        for (int y = 0; y < coarse.rows; ++y)
            for (int x = 0; x < coarse.cols; ++x)
            {
                const int limit = toUnits(given[i].ptr<float>(y)[x], isWhole, i > 0,
                                          (i > 0 ? disparities.end : disparities.start) * subpixelScale);
                coarse.ptr<short>(y)[x] =
                    saturate_cast<short>(i > 0 ? std::min(limit, disparities.end * subpixelScale)
                                               : std::max(limit, disparities.start * subpixelScale));
            }
        resizeNearest(coarse, size, expanded[i]);
    }
    ranges.smallest = expanded[0];
    ranges.largest = expanded[1];
}

void buildIntervals(const PixelRanges& ranges, int minDisparity, int extension, const std::vector<int>& numDisparities,
                    std::vector<Mat>& intervals)
{
    intervals.resize(ranges.isEmpty() ? 0 : numDisparities.size());
    if (ranges.isEmpty())
        return;
    // In units of the image first, so that layers know fractions
    const int largest = (numDisparities[0] - 1) * subpixelScale, offset = minDisparity * subpixelScale;
    const Size size(ranges.smallest.cols + extension, ranges.smallest.rows);
    Mat units(size, CV_16UC2), half;
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const short *lowest = ranges.smallest.ptr<short>(y), *highest = ranges.largest.ptr<short>(y);
            ushort* const row = units.ptr<ushort>(y);
            for (int x = 0; x < size.width; ++x)
            {
                const int column = std::max(x - extension, 0);
                row[2 * x] = (ushort)clamped(lowest[column] - offset, 0, largest);
                row[2 * x + 1] = (ushort)clamped(highest[column] - offset, 0, largest);
            }
        }
    });
    for (size_t layer = 0; layer < numDisparities.size(); ++layer)
    {
        const int shift = 4 + (int)layer, last = numDisparities[layer] - 1;
        static_assert(subpixelScale == 1 << 4, "units of a candidate of layer 0");
        Mat& ofLayer = intervals[layer];
        ofLayer.create(units.size(), CV_16UC2);
        parallel_for_(Range(0, units.rows), [&](const Range& rows) {
            for (int y = rows.start; y < rows.end; ++y)
            {
                const ushort* const own = units.ptr<ushort>(y);
                ushort* const interval = ofLayer.ptr<ushort>(y);
                HDP_VECTORIZED for (int x = 0; x < units.cols; ++x)
                {
                    const int first = std::min(own[2 * x] >> shift, last);
                    interval[2 * x] = (ushort)first;
                    interval[2 * x + 1] = (ushort)clamped((own[2 * x + 1] + (1 << shift) - 1) >> shift, first, last);
                }
            }
        });
        if (layer + 1 == numDisparities.size())
            break;
        halveIntervals(units, half);
        swap(units, half);
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
    for (int y = 0; y < others.rows; ++y)
        for (int x = 0; x < others.cols; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            DisparityInterval& other = others.ptr<DisparityInterval>(y)[x];
            const DisparityInterval both = { std::max(own.first, other.first), std::min(own.last, other.last) };
            other = both.empty() ? own : both;
        }
}

void moveIntoIntervals(const Mat& intervals, Mat& disparity)
{
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const DisparityInterval* const own = intervals.ptr<DisparityInterval>(y);
            ushort* const row = disparity.ptr<ushort>(y);
            for (int x = 0; x < disparity.cols; ++x)
                row[x] = (ushort)clamped((int)row[x], own[x].first * subpixelScale, own[x].last * subpixelScale);
        }
    });
}

}}} // namespace cv::stereo::hdp
