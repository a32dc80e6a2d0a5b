// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_output.hpp"

#include "left_right_check.hpp"
#include "upsampling.hpp"
#include "../base/units.hpp"

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

} // namespace

void outputDisparity(const Mat& finest, const OutputPlan& plan, OutputBuffers& buffers, Mat& disparity, const Mat& mask,
                     const PixelRanges& ranges)
{
    buffers.masked.release();
    buffers.hasRejected = plan.hasFilters() || !mask.empty() || !ranges.isEmpty();
    const Size extendedSize = disparity.size() + Size(plan.extension, 0);
    Mat extended = enlarge(finest, plan.finestLayer, extendedSize, buffers.enlarged);
    if (plan.isWhole)
    {
        convert(extended, CV_16U, 1. / unit, 0, buffers.whole);
        convert(buffers.whole, CV_16U, unit, 0, buffers.whole);
        extended = buffers.whole;
    }
    const Mat map = extended.colRange(plan.extension, extended.cols);
    const bool isFloat = disparity.depth() == CV_32F;
    if (isFloat && !buffers.hasRejected)
        return convert(map, CV_32F, 1. / unit, plan.minDisparity, disparity);
    Mat& fixedPoint = isFloat ? buffers.fixedPoint : disparity; // what the filters take
    convert(map, CV_16S, 1, (double)plan.minDisparity * unit, fixedPoint);
    if (!buffers.hasRejected)
        return;

    const short invalid = (short)((plan.minDisparity - 1) * unit);
    if (!ranges.isEmpty())
        moveIntoRanges(ranges, invalid, fixedPoint);
    if (!mask.empty())
        fixedPoint.setTo(Scalar(invalid), mask == 0);
    if (!mask.empty() || !ranges.isEmpty())
        compare(fixedPoint, Scalar(invalid), buffers.masked, CMP_EQ);
    if (plan.disp12MaxDiff > 0)
        rejectOccluded(fixedPoint, plan.disp12MaxDiff, invalid);
    if (plan.hasBothFilters())
        compare(fixedPoint, Scalar(invalid), buffers.notStable, CMP_EQ);
    if (plan.speckleWindowSize > 0)
        removeSpeckles(fixedPoint, plan, invalid, buffers.speckles);
    compare(fixedPoint, Scalar(invalid), buffers.rejected, CMP_EQ);
    if (isFloat)
        convert(fixedPoint, CV_32F, 1. / unit, 0, disparity);
}

}}} // namespace cv::stereo::hdp
