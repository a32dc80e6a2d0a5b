// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_THIN_STRUCTURES_HPP
#define OPENCV_HDPSTEREO_THIN_STRUCTURES_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Gives back what the median removed although it is more than noise: a pixel takes its disparity from before the
median if this is clearly nearer, and if many of the pixels in the window around it, as far as that is inside the
image, had about the same disparity.
@param unfiltered The map before the median, CV_16UC1.
@param disparity The map after the median. */
CV_EXPORTS void restoreThinStructures(const Mat& unfiltered, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
