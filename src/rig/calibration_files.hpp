// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CALIBRATION_FILES_HPP
#define OPENCV_HDPSTEREO_CALIBRATION_FILES_HPP

#include "opencv2/hdpstereo/stereo_rig.hpp"
#include "calibration_text.hpp"

namespace cv { namespace stereo { namespace hdp {

/** readStereoCalibration() of texts.
@param texts One or two. */
CV_EXPORTS StereoCalibration toCalibration(const std::vector<CalibrationText>& texts, Size imageSize, double unit);

}}} // namespace cv::stereo::hdp

#endif
