// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_ranges.hpp"
#include "disparity_ranges.simd.hpp"
#include "pair/disparity_ranges.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(toUnits)
HDP_DISPATCH(joinLimits)
HDP_DISPATCH(halveIntervals)
HDP_DISPATCH(toCandidates)
HDP_DISPATCH(intersectIntervals)
HDP_DISPATCH(moveIntoIntervals)

//! Where the centre of a pixel of length pixels lies in a row of count larger ones
int nearest(int pixel, int length, int count) { return (int)((2 * (int64)pixel + 1) * count / (2 * length)); }

void resizeNearest(const Mat& map, Size size, Mat& resized)
{
    std::vector<int> columns;
    for (int x = 0; x < size.width; ++x)
        columns.push_back(nearest(x, size.width, map.cols));
    resized.create(size, CV_16S);
    parallelForRows(resized.size(), [&](int y) {
        const short* const row = map.ptr<short>(nearest(y, size.height, map.rows));
        for (int x = 0; x < size.width; ++x)
            resized.ptr<short>(y)[x] = row[columns[x]];
    });
}

//! Limits of one kind for each pixel, in 1 / subpixelScale pixel; none is beyond the limit of all, in pixels.
void expandLimits(const Mat& given, int limitOfAll, bool isWhole, bool isLargest, Size size, Mat& expanded)
{
    Mat coarse;
    Mat& limits = given.size() == size ? expanded : coarse;
    limits.create(given.size(), CV_16S);
    parallelForRows(limits.size(), [&](int y) {
        dispatched::toUnits(given.ptr<float>(y), limits.cols, limitOfAll, isWhole, isLargest, limits.ptr<short>(y));
    });
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
    expandLimits(smallest, disparities.start, isWhole, false, size, ranges.smallest);
    expandLimits(largest, disparities.end, isWhole, true, size, ranges.largest);
    ranges.hasEmpty = countNonZero(ranges.smallest > ranges.largest) > 0;
}

void halveIntervals(const Mat& intervals, Mat& hulls)
{
    hulls.create(intervals.rows / 2, intervals.cols / 2, CV_16UC2);
    if (hulls.empty())
        return;
    parallelForRows(hulls.size(), [&](int y) {
        dispatched::halveIntervals(intervals.ptr<ushort>(2 * y), intervals.ptr<ushort>(2 * y + 1), hulls.cols,
                                   hulls.ptr<ushort>(y));
    });
}

void buildIntervals(const PixelRanges& ranges, int minDisparity, int extension, const std::vector<int>& numDisparities,
                    std::vector<Mat>& units, std::vector<Mat>& intervals)
{
    intervals.resize(ranges.isEmpty() ? 0 : numDisparities.size());
    units.resize(intervals.size());
    if (ranges.isEmpty())
        return;
    // In units of the image first, so that layers know fractions
    const int last = (numDisparities[0] - 1) * subpixelScale, offset = minDisparity * subpixelScale;
    units[0].create(ranges.smallest.rows, ranges.smallest.cols + extension, CV_16UC2);
    parallelForRows(units[0].size(), [&](int y) {
        ushort* const row = units[0].ptr<ushort>(y);
        ushort* const own = row + 2 * extension;
        dispatched::joinLimits(ranges.smallest.ptr<short>(y), ranges.largest.ptr<short>(y), ranges.smallest.cols,
                               offset, last, own);
        for (int x = 0; x < 2 * extension; ++x)
            row[x] = own[x % 2];
    });
    for (size_t layer = 0; layer < numDisparities.size(); ++layer)
    {
        Mat& exact = units[layer];
        if (layer > 0)
            halveIntervals(units[layer - 1], exact);
        Mat& ofLayer = intervals[layer];
        ofLayer.create(exact.size(), CV_16UC2);
        parallelForRows(exact.size(), [&](int y) {
            dispatched::toCandidates(exact.ptr<ushort>(y), exact.cols, (int)layer, numDisparities[layer] - 1,
                                     ofLayer.ptr<ushort>(y));
        });
    }
}

Mat doubleIntervals(const Mat& intervals, int candidates) { return min(2 * intervals + Scalar(0, 1), candidates - 1); }

void intersectIntervals(const Mat& intervals, Mat& others)
{
    parallelForRows(others.size(), [&](int y) {
        dispatched::intersectIntervals(intervals.ptr<ushort>(y), others.cols, others.ptr<ushort>(y));
    });
}

void moveIntoIntervals(const Mat& intervals, Mat& disparity)
{
    parallelForRows(disparity.size(), [&](int y) {
        dispatched::moveIntoIntervals(intervals.ptr<ushort>(y), disparity.cols, disparity.ptr<ushort>(y));
    });
}

}}} // namespace cv::stereo::hdp
