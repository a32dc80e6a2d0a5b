// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "left_right_check.hpp"

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

//! A Visibility per pixel, CV_8UC1. disparity: CV_16SC1 or CV_16UC1 (T); maxDiff: of a visible pixel, in pixels;
//! invalid: that of pixels that map to no column, or a value that none has
template <typename T> Mat checkLeftRight(const Mat& disparity, int maxDiff, int invalid)
{
    static_assert(subpixelScale == 1 << 4, "divided by a shift, so that negative ones are rounded as others");
    const int maxDifference = (int)std::min<int64>((int64)maxDiff * subpixelScale, INT_MAX), width = disparity.cols;
    Mat visibility(disparity.size(), CV_8U);
    parallelForRows(disparity.size(), std::vector<int>(2 * width + 1), [&](int y, std::vector<int>& memory) {
        const T* const row = disparity.ptr<T>(y);
        int *const columns = memory.data(), *const nearest = columns + width, end = width;
        HDP_VECTORIZED for (int x = 0; x < end; ++x)
        {
            // As cvRound(disparity / 16.), for vectors: of two that are equally near the even one
            const int own = row[x], rounded = (own + subpixelScale / 2 - 1 + ((own >> 4) & 1)) >> 4;
            const int column = x + 1 - rounded;
            columns[x] = ((column > 0) & (column <= end) & (own != invalid)) ? column : 0;
        }
        testVisibility(row, columns, width, width, maxDifference, nearest, visibility.ptr(y));
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
