// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MEDIAN_FILTER_HPP
#define OPENCV_HDPSTEREO_MEDIAN_FILTER_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Median of size x size pixels, 3, 5 or 7, borders replicated: several times faster than cv::medianBlur, which does
//! not share the work on a column of the window. disparity: CV_16UC1; filtered: another Mat.
CV_EXPORTS void medianDisparity(const Mat& disparity, int size, Mat& filtered);

}}} // namespace cv::stereo::hdp

#endif
