// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_UPSAMPLING_HPP
#define OPENCV_HDPSTEREO_UPSAMPLING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

/** The disparities of a layer from those of the layer above: bilinear inside a surface, its pixel's own at its border.
@param upper CV_16UC1, a disparity map.
@param size Of the layer.
@param disparity Receives CV_16UC1, a disparity map. */
CV_EXPORTS void upsampleDisparity(const Mat& upper, Size size, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
