// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "rectification.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

const int zeroDisparity = 0x400; // CALIB_ZERO_DISPARITY, which OpenCV 5 calls STEREO_ZERO_DISPARITY

double radialDistance(const double* k, int count, bool isFisheye, double angle)
{
    if (isFisheye)
    {
        const double s = angle * angle;
        return angle * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
    }
    const auto of = [&](int i) { return i < count ? k[i] : 0; };
    const double r = std::tan(angle), s = r * r;
    const double above = 1 + s * (k[0] + s * (k[1] + s * of(4))), below = 1 + s * (of(5) + s * (of(6) + s * of(7)));
    return below > 0 ? r * above / below : -1;
}

} // namespace

double maxUnfoldedAngle(const Mat& distortion, bool isFisheye)
{
    const double step = 0.1 * CV_PI / 180;
    const int steps = 899;
    double before = 0;
    for (int i = 1; i <= steps; ++i)
    {
        const double distance = radialDistance(distortion.ptr<double>(), distortion.cols, isFisheye, i * step);
        if (!(distance > before))
            return (i - 1) * step;
        before = distance;
    }
    return steps * step;
}

Rectification planRectification(const StereoCalibration& c, double fieldOfView, Size size)
{
    Rectification plan;
    plan.size = size;
    plan.baseline = norm(c.T);
    Mat R1, R2, P1, P2, Q;
    // Rotations depend on no distortion; the focal length by which all pixels are filled does.
    const Mat straight = Mat::zeros(1, 4, CV_64F);
    const bool fills = fieldOfView == 0 && !c.isFisheye;
    stereoRectify(c.cameraMatrix1, fills ? c.distCoeffs1 : straight, c.cameraMatrix2, fills ? c.distCoeffs2 : straight,
                  c.imageSize, c.R, c.T, R1, R2, P1, P2, Q, zeroDisparity, fills ? 0 : -1, size);
    plan.R[0] = R1;
    plan.R[1] = R2;
    plan.center = Point2d(0.5 * (size.width - 1), 0.5 * (size.height - 1));
    if (fills)
    {
        plan.focalLength = P1.at<double>(0, 0);
        plan.center = Point2d(P1.at<double>(0, 2), P1.at<double>(1, 2));
    }
    else if (fieldOfView > 0)
        plan.focalLength = 0.5 * size.width / std::tan(0.5 * fieldOfView * CV_PI / 180);
    else
        plan.focalLength = 0.5 * (c.cameraMatrix1.at<double>(0, 0) + c.cameraMatrix2.at<double>(0, 0)) * size.width /
                           c.imageSize.width;
    const double most = 1e6;
    if (!(plan.focalLength > 1 && plan.focalLength < most && std::abs(plan.center.x) < most &&
          std::abs(plan.center.y) < most))
        CV_Error(Error::StsBadArg,
                 "fieldOfView must be given: with this distortion nothing else tells the size of what "
                 "both cameras see. Is the calibration right?");
    return plan;
}

void makeMaps(const StereoCalibration& c, const Rectification& plan, int camera, RectificationMaps& maps)
{
    const Mat &K = camera ? c.cameraMatrix2 : c.cameraMatrix1, &D = camera ? c.distCoeffs2 : c.distCoeffs1;
    Mat x, y;
    if (c.isFisheye)
        fisheye::initUndistortRectifyMap(K, D, plan.R[camera], plan.cameraMatrix(), plan.size, CV_32FC1, x, y);
    else
        initUndistortRectifyMap(K, D, plan.R[camera], plan.cameraMatrix(), plan.size, CV_32FC1, x, y);

    const double minCosine = std::cos(maxUnfoldedAngle(D, c.isFisheye));
    const Matx33d toCamera = plan.R[camera].t() * plan.cameraMatrix().inv();
    maps.mask.create(plan.size, CV_8U);
    for (int i = 0; i < plan.size.height; ++i)
        for (int j = 0; j < plan.size.width; ++j)
        {
            const Vec3d ray = toCamera * Vec3d(j, i, 1);
            float &u = x.at<float>(i, j), &v = y.at<float>(i, j);
            const bool isReached = ray[2] > minCosine * norm(ray) && u >= 0 && u <= c.imageSize.width - 1 && v >= 0 &&
                                   v <= c.imageSize.height - 1;
            maps.mask.at<uchar>(i, j) = isReached ? 255 : 0;
            if (!isReached)
                u = v = -2; // outside: cv::remap leaves 0 there
        }
    convertMaps(x, y, maps.positions, maps.fractions, CV_16SC2);
}

}}} // namespace cv::stereo::hdp
