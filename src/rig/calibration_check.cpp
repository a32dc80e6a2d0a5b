// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "calibration_check.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

// Numbers of a calibration are below this: its squares and products stay finite.
const double largest = 1e6;

// Each of these changes the field to its documented form.

[[noreturn]] void failOf(const std::string& name, const std::string& expected)
{
    CV_Error(Error::StsBadArg, name + " must be " + expected);
}

void checkNumbers(const std::string& name, Mat& matrix)
{
    if (matrix.channels() != 1 || matrix.dims > 2 || matrix.empty())
        failOf(name, "a matrix of one channel");
    Mat numbers;
    matrix.convertTo(numbers, CV_64F);
    if (!checkRange(numbers, true, 0, -largest, largest))
        failOf(name, "of finite numbers of a magnitude below 1000000");
    matrix = numbers;
}

void checkCamera(const CameraNames& names, Size size, bool isFisheye, Mat& matrix, Mat& D)
{
    checkNumbers(names.focalLengths, matrix);
    if (matrix.size() != Size(3, 3))
        failOf(names.focalLengths, "3 x 3");
    const Matx33d K(matrix);
    if (!(K(0, 0) >= 1 && K(1, 1) >= 1))
        failOf(names.focalLengths, "of focal lengths above 1 pixel");
    if (K(0, 1) != 0 || K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 || K(2, 2) != 1)
        failOf(names.focalLengths, "of the form fx, 0, cx, 0, fy, cy, 0, 0, 1");
    if (!(K(0, 2) >= 0 && K(0, 2) <= size.width && K(1, 2) >= 0 && K(1, 2) <= size.height))
        failOf(names.principalPoint, format("of a principal point in the image of %d x %d", size.width, size.height));
    checkNumbers(names.distortion, D);
    D = D.reshape(1, 1);
    const int count = D.cols;
    if (isFisheye && count != 4)
        failOf(names.distortion, "4 numbers with fisheye");
    if (count != 4 && count != 5 && count != 8 && count != 12 && count != 14)
        failOf(names.distortion, "4, 5, 8, 12 or 14 numbers");
}

void checkRotation(const std::string& name, Mat& rotation)
{
    checkNumbers(name, rotation);
    if (rotation.size() != Size(3, 3))
        failOf(name, "3 x 3");
    const Matx33d R(rotation);
    if (!isRotation(R))
        failOf(name, "a rotation");
    Matx31d w;
    Matx33d u, vt;
    SVD::compute(R, w, u, vt);
    rotation = Mat(u * vt, true); // files have few digits
}

void checkTranslation(const std::string& name, const Matx33d& R, Mat& translation)
{
    checkNumbers(name, translation);
    if (translation.total() != 3)
        failOf(name, "3 numbers");
    translation = translation.reshape(1, 3);
    const Vec3d right = -(R.t() * Vec3d(translation.ptr<double>()));
    if (norm(right) < leastBaseline)
        failOf(name, "of a baseline above 0");
    if (std::abs(right[0]) < std::max(std::abs(right[1]), std::abs(right[2])))
        failOf(name, "that of cameras side by side");
    if (right[0] < 0)
        failOf(name, "that of a second camera to the right of the first one: exchange them, and their images");
}

} // namespace

bool isRotation(const Matx33d& R) { return norm(R * R.t(), Matx33d::eye(), NORM_INF) <= 1e-2 && determinant(R) > 0; }

void checkCalibration(const CalibrationNames& names, StereoCalibration& calibration)
{
    StereoCalibration c = calibration;
    if (!isPossible(c.imageSize))
        failOf(names.imageSize, "from 1 x 1 to 32766 x 32766");
    checkCamera(names.cameras[0], c.imageSize, c.isFisheye, c.cameraMatrix1, c.distCoeffs1);
    checkCamera(names.cameras[1], c.imageSize, c.isFisheye, c.cameraMatrix2, c.distCoeffs2);
    checkRotation(names.rotation, c.R);
    checkTranslation(names.translation, Matx33d(c.R), c.T);
    calibration = c;
}

}}} // namespace cv::stereo::hdp
