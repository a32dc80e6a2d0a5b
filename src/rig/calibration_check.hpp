// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CALIBRATION_CHECK_HPP
#define OPENCV_HDPSTEREO_CALIBRATION_CHECK_HPP

#include "opencv2/hdpstereo/stereo_rig.hpp"

namespace cv { namespace stereo { namespace hdp {

// What exceptions call the fields of a calibration, with the file that they are in

struct CameraNames
{
    std::string focalLengths, principalPoint, distortion;
};

struct CalibrationNames
{
    std::string imageSize;
    CameraNames cameras[2];
    std::string rotation, translation;
};

const double leastBaseline = 1e-6; // metres

//! Whether cv::remap takes and makes images of this size
inline bool isPossible(Size size)
{
    return std::min(size.width, size.height) >= 1 && std::max(size.width, size.height) < SHRT_MAX;
}

//! But for the few digits of files
bool isRotation(const Matx33d& R);

//! Brings a calibration into the form that StereoCalibration documents, with a rotation that is one. Throws if a matrix
//! has another size, or what it has is not finite or impossible.
void checkCalibration(const CalibrationNames& names, StereoCalibration& calibration);

}}} // namespace cv::stereo::hdp

#endif
