// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_LEFT_RIGHT_CHECK_HPP
#define OPENCV_HDPSTEREO_LEFT_RIGHT_CHECK_HPP

#include "opencv2/core.hpp"

#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What the right image has at a pixel's match
enum Visibility
{
    VISIBLE,
    OCCLUDED, // a nearer pixel
    OUTSIDE   // nothing, it ends before
};

//! Makes pixels invalid whose disparity differs by more than maxDiff pixels from the maximum of those that map to the
//! same column of the right image. disparity: CV_16SC1, times 16
CV_EXPORTS void rejectOccluded(Mat& disparity, int maxDiff, short invalid);

/** A pixel is stable if the maximum of the disparities that map to its column of the right image is larger by a pixel
at most: exact equality fails by rounding. One that maps to no column is not.
@param disparity CV_16UC1, a disparity map; USHRT_MAX maps to none.
@param stable Receives CV_8UC1, 255 where stable, else 0. */
CV_EXPORTS void findStable(const Mat& disparity, Mat& stable);

/** The visibility test: compares each disparity of a row with the maximum of those that map to the same column.
@param columns Of the right image that each of count pixels maps to, from 1 on; 0: none.
@param width Of the right image.
@param maxDifference Of a visible pixel; this and disparities are in 1 / subpixelScale pixel.
@param nearest Memory for width + 1 columns.
@param visibility Receives a Visibility per pixel. */
template <typename T>
CV_ALWAYS_INLINE void testVisibility(const T* disparity, const int* columns, int count, int width, int maxDifference,
                                     int* nearest, uchar* visibility)
{
    HDP_VECTORIZED for (int column = 0; column <= width; ++column) nearest[column] = SHRT_MIN;
    for (int x = 0; x < count; ++x)
        nearest[columns[x]] = std::max(nearest[columns[x]], (int)disparity[x]);
    HDP_VECTORIZED for (int x = 0; x < count; ++x)
    {
        const int column = columns[x], inside = nearest[column] - disparity[x] > maxDifference ? OCCLUDED : VISIBLE;
        visibility[x] = (uchar)(column == 0 ? OUTSIDE : inside);
    }
}

}}} // namespace cv::stereo::hdp

#endif
