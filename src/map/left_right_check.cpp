// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "left_right_check.hpp"

#include "left_right_check.simd.hpp"
#include "map/left_right_check.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(visibilityRow)

//! A Visibility per pixel, CV_8UC1. disparity: CV_16SC1 or CV_16UC1 (T); maxDiff: of a visible pixel, in pixels;
//! invalid: see visibilityRow()
template <typename T> Mat checkLeftRight(const Mat& disparity, int maxDiff, int invalid)
{
    const int maxDifference = (int)std::min<int64>((int64)maxDiff * subpixelScale, INT_MAX);
    Mat visibility(disparity.size(), CV_8U);
    const int width = disparity.cols;
    parallelForRows(disparity.size(), std::vector<int>(2 * width + 1), [&](int y, std::vector<int>& memory) {
        dispatched::visibilityRow(disparity.ptr<T>(y), width, invalid, maxDifference, memory.data(), &memory[width],
                                  visibility.ptr(y));
    });
    return visibility;
}

} // namespace

void rejectOccluded(Mat& disparity, int maxDiff, short invalid)
{
    disparity.setTo(Scalar(invalid), checkLeftRight<short>(disparity, maxDiff, invalid) == +OCCLUDED);
}

void findStable(const Mat& disparity, Mat& stable)
{
    const int maxDiff = 1;
    compare(checkLeftRight<ushort>(disparity, maxDiff, USHRT_MAX), +VISIBLE, stable, CMP_EQ);
}

}}} // namespace cv::stereo::hdp
