// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "candidate_windows.hpp"
#include "candidate_windows.simd.hpp"
#include "scanlines/candidate_windows.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "other_surfaces.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(predictRow)
HDP_DISPATCH(restrictRow)

} // namespace

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
