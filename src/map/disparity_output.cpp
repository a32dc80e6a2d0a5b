// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_output.hpp"

#include "../base/result_array.hpp"

#include "left_right_check.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const int unit = subpixelScale;
static_assert(unit == (int)StereoMatcher::DISP_SCALE, "A disparity map and the result have the same units.");

//! From the finest layer that was matched to layer 0 of this size
Mat enlarge(const Mat& finest, int finestLayer, Size size, std::vector<Mat>& enlarged)
{
    enlarged.resize(finestLayer);
    Mat upper = finest;
    for (int layer = finestLayer - 1; layer >= 0; --layer)
    {
        const Size ofLayer(size.width >> layer, size.height >> layer);
        upsampleDisparity(upper, ofLayer, enlarged[layer]);
        upper = enlarged[layer];
    }
    return upper;
}

//! As Mat::convertTo(), by all threads
void convert(const Mat& map, int depth, double scale, double shift, Mat& converted)
{
    converted.create(map.size(), depth);
    parallel_for_(Range(0, map.rows), [&](const Range& rows) {
        Mat part = converted.rowRange(rows);
        map.rowRange(rows).convertTo(part, depth, scale, shift);
    });
}

void removeSpeckles(Mat& disparity, const OutputPlan& plan, short invalid, Mat& speckles)
{
    // One byte more than cv::filterSpeckles allocates: it writes there if no two pixels belong together.
    const int bytes = (int)disparity.total() * speckleBytes + 1;
    if (speckles.cols < bytes)
        speckles.create(1, bytes, CV_8U);
    const int range = std::min(plan.speckleRange, SHRT_MAX / unit); // cv::filterSpeckles may have it in 16 bits
    filterSpeckles(disparity, invalid, plan.speckleWindowSize, unit * range, speckles);
}

//! That of the image, in units of a disparity map, without the added columns
Mat mapOfImage(const Mat& finest, const OutputPlan& plan, const Size& size, OutputBuffers& buffers)
{
    Mat extended = enlarge(finest, plan.finestLayer, size + Size(plan.extension, 0), buffers.enlarged);
    if (plan.isWhole)
    {
        convert(extended, CV_16U, 1. / unit, 0, buffers.whole);
        convert(buffers.whole, CV_16U, unit, 0, buffers.whole);
        extended = buffers.whole;
    }
    return extended.colRange(plan.extension, extended.cols);
}

short invalidDisparity(const OutputPlan& plan) { return (short)((plan.minDisparity - 1) * unit); }

//! Moves disparities into the ranges of their pixels, or to invalid if these are empty.
void moveIntoRanges(const PixelRanges& ranges, short invalid, Mat& fixedPoint)
{
    if (ranges.isEmpty())
        return;
    max(fixedPoint, ranges.smallest, fixedPoint);
    min(fixedPoint, ranges.largest, fixedPoint);
    if (ranges.hasEmpty)
        fixedPoint.setTo(Scalar(invalid), ranges.smallest > ranges.largest);
}

} // namespace

int depthOfOutput(OutputArray disparity, Size size, int usual)
{
    requireMat(disparity, size, "disparity");
    const int type = disparity.fixedType() ? disparity.type() : usual;
    if (type != CV_16SC1 && type != CV_32FC1)
        CV_Error(Error::StsUnsupportedFormat, "disparity must be CV_16SC1 or CV_32FC1 if its type is fixed");
    return type;
}

void upsampleDisparity(const Mat& upper, Size size, Mat& disparity)
{
    disparity.create(size, CV_16U);
    parallelForRows(size, [&](int y) {
        const auto clampRow = [&](int row) { return clamped(row, 0, upper.rows - 1); };
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
    });
}

void outputDisparity(const Mat& finest, const OutputPlan& plan, OutputBuffers& buffers, Mat& disparity, const Mat& mask,
                     const PixelRanges& ranges)
{
    const bool missesAny = !mask.empty() || ranges.hasEmpty, isChecked = plan.disp12MaxDiff > 0,
               isFiltered = plan.speckleWindowSize > 0, isFloat = disparity.depth() == CV_32F;
    std::vector<Rejected>& rejected = buffers.rejected;
    rejected.clear();
    const Mat map = mapOfImage(finest, plan, disparity.size(), buffers);
    if (isFloat && !missesAny && !isChecked && !isFiltered && ranges.isEmpty())
        return convert(map, CV_32F, 1. / unit, plan.minDisparity, disparity);

    Mat& fixedPoint = isFloat ? buffers.fixedPoint : disparity; // what the filters take
    const short invalid = invalidDisparity(plan);
    convert(map, CV_16S, 1, (double)plan.minDisparity * unit, fixedPoint);
    moveIntoRanges(ranges, invalid, fixedPoint);
    if (!mask.empty())
        fixedPoint.setTo(Scalar(invalid), mask == 0);
    const auto addRejected = [&](HDPTreeMatcher::Reason reason) {
        rejected.push_back({ reason, Mat() });
        compare(fixedPoint, Scalar(invalid), rejected.back().pixels, CMP_EQ);
    };
    if (missesAny)
        addRejected(HDPTreeMatcher::REASON_MASKED);
    if (isChecked)
    {
        rejectOccluded(fixedPoint, plan.disp12MaxDiff, invalid);
        addRejected(HDPTreeMatcher::REASON_UNSTABLE);
    }
    if (isFiltered)
    {
        removeSpeckles(fixedPoint, plan, invalid, buffers.speckles);
        addRejected(HDPTreeMatcher::REASON_SPECKLE);
    }
    if (isFloat)
        convert(fixedPoint, CV_32F, 1. / unit, 0, disparity);
}

Mat movedIntoRanges(const Mat& finest, const OutputPlan& plan, Size size, const PixelRanges& ranges)
{
    OutputBuffers buffers;
    Mat found, moved, distance;
    convert(mapOfImage(finest, plan, size, buffers), CV_16S, 1, (double)plan.minDisparity * unit, found);
    moved = found.clone();
    moveIntoRanges(ranges, invalidDisparity(plan), moved);
    subtract(moved, found, distance, noArray(), CV_32F);
    return abs(distance / unit);
}

void findReasons(const Mat& disparity, const OutputPlan& plan, int width, const CostLimits& limits, Mat& reasons)
{
    Mat stable;
    findStable(limits.dropMissing(disparity), stable);
    const int scale = 1 << plan.finestLayer, half = subpixelScale / 2;
    reasons.create(disparity.size(), CV_8U);
    parallelForRows(reasons.size(), [&](int y) {
        limits.hideUnmatched(y, disparity.ptr<ushort>(y), stable.ptr(y));
        for (int x = 0; x < reasons.cols; ++x)
        {
            // The column of the right image, in 1 / subpixelScale pixel
            const int64 column = ((int64)x * scale - plan.extension - plan.minDisparity) * subpixelScale -
                                 (int64)disparity.at<ushort>(y, x) * scale;
            const bool isInside = column > -half && column <= (width - 1) * (int64)subpixelScale + half &&
                                  x - wholeDisparity(disparity.at<ushort>(y, x)) >= limits.firstColumn(y);
            const bool isStable = stable.at<uchar>(y, x) != 0;
            reasons.at<uchar>(y, x) = (uchar)(!isInside  ? HDPTreeMatcher::REASON_OUTSIDE
                                              : isStable ? HDPTreeMatcher::REASON_MATCHED
                                                         : HDPTreeMatcher::REASON_OCCLUDED);
        }
    });
}

}}} // namespace cv::stereo::hdp
