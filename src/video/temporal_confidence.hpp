// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_CONFIDENCE_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_CONFIDENCE_HPP

#include "frame_memory.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Trusts what a video has seen for long: confidence v sqrt((n + 1) / (m + 1)), rounded, where n is the number of
frames that a disparity stands for and m the largest one of all pixels. A first frame keeps its confidence.
@param frame What the frame leaves to the next one, whose disparities these are.
@param confidence CV_8UC1, changed. */
CV_EXPORTS void trustStable(const FrameMemory& frame, Mat& confidence);

}}} // namespace cv::stereo::hdp

#endif
