// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_GREY_LEVELS_HPP
#define OPENCV_HDPSTEREO_GREY_LEVELS_HPP

namespace cv { namespace stereo { namespace hdp {

//! The unit of grey levels in CV_16UC1 images is 1 / greyScale of a level of 8 bits, and whiteLevel is the highest one.
const int greyScale = 4, whiteLevel = 256 * greyScale - 1;

}}} // namespace cv::stereo::hdp

#endif
