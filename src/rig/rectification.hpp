// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_RECTIFICATION_HPP
#define OPENCV_HDPSTEREO_RECTIFICATION_HPP

#include "opencv2/hdpstereo/stereo_rig.hpp"

namespace cv { namespace stereo { namespace hdp {

//! As cv::stereoRectify has it: both cameras have one focal length and one principal point.
struct Rectification
{
    Size size;
    Matx33d R[2];
    double focalLength;
    Point2d center;  // principal point
    double baseline; // metres

    Matx33d cameraMatrix() const { return Matx33d(focalLength, 0, center.x, 0, focalLength, center.y, 0, 0, 1); }
};

/** Chooses the rectified cameras, see StereoRig::create(). The calibration is a checked one.
@throws cv::Exception if the distortion leaves no picture. */
Rectification planRectification(const StereoCalibration& calibration, double fieldOfView, Size size);

//! Where the pixels of a rectified image are in the raw one
struct RectificationMaps
{
    Mat positions, fractions; // for cv::remap: CV_16SC2, CV_16UC1
    Mat mask;                 // CV_8UC1: 255 where there is a raw pixel
};

//! camera: 0 is the left one.
void makeMaps(const StereoCalibration& calibration, const Rectification& rectification, int camera,
              RectificationMaps& maps);

/** The largest angle from the optical axis up to which the distortion keeps the order of points: beyond it a polynomial
folds back, and shows what is not there. In radians, not above 89.9 degrees.
@param distortion 1 x 4 to 14, CV_64F. */
CV_EXPORTS double maxUnfoldedAngle(const Mat& distortion, bool isFisheye);

}}} // namespace cv::stereo::hdp

#endif
