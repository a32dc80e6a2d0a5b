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

/** Brings a calibration into the form that StereoCalibration documents, with a rotation that is one.
@param source What the calibration is of, for the text of an exception.
@throws cv::Exception if a matrix has another size, or what it has is not finite or impossible. */
void checkCalibration(const std::string& source, StereoCalibration& calibration);

}}} // namespace cv::stereo::hdp

#endif
