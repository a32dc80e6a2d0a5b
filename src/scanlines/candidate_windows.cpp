// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "candidate_windows.hpp"
#include "candidate_windows.simd.hpp"
#include "scanlines/candidate_windows.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, neighborhood, 3, "pixels of the upper layer",
            "in which the surface beyond a discontinuity is: in more there is often a third one");
const int maxStripes = 16, minStripeHeight = 16; // rows; for as many threads: more filter the rows between them twice

HDP_DISPATCH(findOthersOfRow)
HDP_DISPATCH(predictRow)
HDP_DISPATCH(restrictRow)

} // namespace

void findOtherSurfaces(const Mat& upper, const Mat& unfiltered, Mat& others)
{
    const Mat maps[] = { upper, unfiltered };
    const Size size = upper.size();
    // Not Mat::ones(): the first thread with an expression sets them up, in OpenCV, which ThreadSanitizer does not see.
    const Mat kernel(2 * neighborhood + 1, 2 * neighborhood + 1, CV_8U, Scalar(1));
    others.create(size, CV_16U);
    const int stripes = std::max(1, std::min(maxStripes, size.height / minStripeHeight));
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        const Range rows(size.height * range.start / stripes, size.height * range.end / stripes);
        Mat min[2], max[2]; // of the disparities around each pixel
        for (int map = 0; map < 2; ++map)
        {
            erode(maps[map].rowRange(rows), min[map], kernel); // a stripe sees its neighbours' rows
            dilate(maps[map].rowRange(rows), max[map], kernel);
        }
        const auto rowOf = [&](int map, int y) -> DisparityRow {
            const int own = y - rows.start;
            return { maps[map].ptr<ushort>(y), min[map].ptr<ushort>(own), max[map].ptr<ushort>(own) };
        };
        for (int y = rows.start; y < rows.end; ++y)
            dispatched::findOthersOfRow(rowOf(0, y), rowOf(1, y), size.width, others.ptr<ushort>(y));
    });
}

void predictWindows(const Mat& upper, const Mat& others, int numDisparities, Mat& windows)
{
    windows.create(upper.size(), CV_16UC4);
    parallelForRows(upper.size(), [&](int y) {
        dispatched::predictRow(upper.ptr<ushort>(y), others.ptr<ushort>(y), upper.cols, numDisparities,
                               windows.ptr<ushort>(y));
    });
}

void restrictWindows(const Mat& intervals, int numDisparities, Mat& windows)
{
    CV_DbgAssert(intervals.size() == windows.size());
    parallelForRows(windows.size(), [&](int y) {
        dispatched::restrictRow(intervals.ptr<ushort>(y), windows.cols, numDisparities, windows.ptr<ushort>(y));
    });
}

void halveDisparity(const Mat& disparity, Mat& upper)
{
    upper.create(disparity.rows / 2, disparity.cols / 2, CV_16U);
    const int maxDistance = otherSurfaceDistance * subpixelScale;
    parallelForRows(upper.size(), [&](int y) {
        const ushort* above = disparity.ptr<ushort>(2 * y);
        const ushort* below = disparity.ptr<ushort>(2 * y + 1);
        ushort* middle = upper.ptr<ushort>(y);
        for (int x = 0; x < upper.cols; ++x)
        {
            const int a = above[2 * x], b = above[2 * x + 1], c = below[2 * x], d = below[2 * x + 1];
            const int p = std::max(std::min(a, b), std::min(c, d)), q = std::min(std::max(a, b), std::max(c, d));
            middle[x] = (ushort)(std::abs(p - q) < maxDistance ? (p + q) / 4 : std::min(p, q) / 2);
        }
    });
}

}}} // namespace cv::stereo::hdp
