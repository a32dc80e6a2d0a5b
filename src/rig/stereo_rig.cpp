// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "../base/result_array.hpp"
#include "calibration_check.hpp"

#include <cmath>
#include <limits>

namespace cv { namespace stereo {

namespace {

const int zeroDisparity = 0x400; // CALIB_ZERO_DISPARITY, which OpenCV 5 calls STEREO_ZERO_DISPARITY

//! Of a point at this angle from the optical axis; k: coefficients of the distortion, 0 where there are less than 8
double radialDistance(const double* k, bool isFisheye, double angle)
{
    const double r = isFisheye ? angle : std::tan(angle), s = r * r;
    if (isFisheye)
        return r * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
    const double above = 1 + s * (k[0] + s * (k[1] + s * k[4])), below = 1 + s * (k[5] + s * (k[6] + s * k[7]));
    return below > 0 ? r * above / below : -1;
}

//! The largest angle from the optical axis up to which the distortion keeps the order of points: beyond it a polynomial
//! folds back, and shows what is not there. In radians, not above 89.9 degrees.
double maxUnfoldedAngle(const Mat& distortion, bool isFisheye)
{
    double k[14] = { 0 };
    std::copy(distortion.begin<double>(), distortion.end<double>(), k);
    const double step = 0.1 * CV_PI / 180;
    double before = 0;
    for (int i = 1; i <= 899; ++i)
    {
        const double distance = radialDistance(k, isFisheye, i * step);
        if (!(distance > before))
            return (i - 1) * step;
        before = distance;
    }
    return 899 * step;
}

void copyIfNeeded(const Mat& result, OutputArray array)
{
    if (array.needed())
        result.copyTo(array);
}

class StereoRigImpl CV_FINAL : public StereoRig
{
public:
    //! The calibration is a checked one.
    StereoRigImpl(const StereoCalibration& calibration, double fieldOfView, Size size)
        : calibration_(calibration), size_(size), baseline_(norm(calibration.T))
    {
        chooseCameras(fieldOfView);
        for (int camera = 0; camera < 2; ++camera)
        {
            makeMaps(camera);
            if (countNonZero(masks_[camera]) == 0)
                CV_Error(Error::StsBadArg, "calibration: R must be of cameras that look in about the same direction");
        }
    }

    void rectify(InputArray left, InputArray right, OutputArray rectifiedLeft,
                 OutputArray rectifiedRight) const CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        Mat raw[] = { left.getMat(), right.getMat() };
        for (int camera = 0; camera < 2; ++camera)
            checkImage(raw[camera], camera ? "right" : "left");
        if (raw[0].type() != raw[1].type())
            CV_Error(Error::StsUnmatchedFormats, "left and right must be of one type");
        hdp::requireMat(rectifiedLeft, size_, raw[0].type(), "rectifiedLeft");
        hdp::requireMat(rectifiedRight, size_, raw[0].type(), "rectifiedRight");
        Mat rectified[2];
        for (int camera = 0; camera < 2; ++camera)
        {
            remap(raw[camera], rectified[camera], positions_[camera], fractions_[camera], INTER_LINEAR, BORDER_CONSTANT,
                  Scalar());
            raw[camera].release(); // a UMat that is a result, too, must not be mapped
        }
        rectified[0].copyTo(rectifiedLeft);
        rectified[1].copyTo(rectifiedRight);
    }

    void getMasks(OutputArray left, OutputArray right) const CV_OVERRIDE
    {
        copyIfNeeded(masks_[0], left);
        copyIfNeeded(masks_[1], right);
    }

    void computeDepth(InputArray disparityArray, OutputArray depth, int depthType, int minDisparity) const CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        Mat disparity = disparityArray.getMat();
        if (disparity.type() != CV_16SC1 && disparity.type() != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "disparity must be CV_16SC1 or CV_32FC1");
        if (disparity.empty() || disparity.cols > size_.width || disparity.rows > size_.height)
            CV_Error(Error::StsUnmatchedSizes,
                     format("disparity must be of %d x %d pixels, or of a part of these, not of %d x %d", size_.width,
                            size_.height, disparity.cols, disparity.rows));
        if (depthType != CV_32F && depthType != CV_16U)
            CV_Error(Error::StsBadArg, "depthType must be CV_32F or CV_16U");
        hdp::requireMat(depth, disparity.size(), depthType, "depth");
        Mat metres; // from disparities in pixels; 0 where there is none
        disparity.convertTo(metres, CV_32F, disparity.depth() == CV_16S ? 1. / StereoMatcher::DISP_SCALE : 1);
        disparity.release(); // a UMat that is the result, too, must not be mapped
        const float largest = std::numeric_limits<float>::max();
        for (float& value : Mat_<float>(metres))
        {
            const double pixels = value, distance = focalLength_ * baseline_ / pixels;
            const bool isKnown = pixels > 0 && pixels >= minDisparity && pixels <= largest && distance <= largest;
            value = isKnown ? (float)distance : 0;
        }
        metres.convertTo(depth, depthType, depthType == CV_16U ? 1000 : 1);
        if (depthType == CV_16U)
            depth.setTo(Scalar(0), metres > 65.535);
        else
            depth.setTo(Scalar(std::numeric_limits<float>::quiet_NaN()), metres == 0);
    }

    void getRectification(OutputArray R1, OutputArray R2, OutputArray P1, OutputArray P2,
                          OutputArray Q) const CV_OVERRIDE
    {
        const double f = focalLength_, B = baseline_;
        const Point2d c = principalPoint_;
        copyIfNeeded(Mat(R_[0]), R1);
        copyIfNeeded(Mat(R_[1]), R2);
        copyIfNeeded(Mat(Matx34d(f, 0, c.x, 0, 0, f, c.y, 0, 0, 0, 1, 0)), P1);
        copyIfNeeded(Mat(Matx34d(f, 0, c.x, -f * B, 0, f, c.y, 0, 0, 0, 1, 0)), P2);
        copyIfNeeded(Mat(Matx44d(1, 0, 0, -c.x, 0, 1, 0, -c.y, 0, 0, 0, f, 0, 0, 1 / B, 0)), Q);
    }

    StereoCalibration getCalibration() const CV_OVERRIDE
    {
        StereoCalibration copy = calibration_;
        for (Mat* matrix :
             { &copy.cameraMatrix1, &copy.cameraMatrix2, &copy.distCoeffs1, &copy.distCoeffs2, &copy.R, &copy.T })
            *matrix = matrix->clone();
        return copy;
    }

    Size getSize() const CV_OVERRIDE { return size_; }
    double getBaseline() const CV_OVERRIDE { return baseline_; }
    double getFocalLength() const CV_OVERRIDE { return focalLength_; }

private:
    //! The rectified cameras: both have one focal length and one principal point.
    void chooseCameras(double fieldOfView)
    {
        const StereoCalibration& c = calibration_;
        Mat R1, R2, P1, P2, Q;
        // The rotations do not depend on the distortion. The focal length does, if all rectified pixels are to be
        // filled.
        const Mat noDistortion = Mat::zeros(1, 4, CV_64F);
        const bool fillsImages = fieldOfView == 0 && !c.isFisheye;
        stereoRectify(c.cameraMatrix1, fillsImages ? c.distCoeffs1 : noDistortion, c.cameraMatrix2,
                      fillsImages ? c.distCoeffs2 : noDistortion, c.imageSize, c.R, c.T, R1, R2, P1, P2, Q,
                      zeroDisparity, fillsImages ? 0 : -1, size_);
        if (P2.at<double>(0, 3) == 0)
            CV_Error(Error::StsBadArg, "calibration: R and T must be of cameras side by side, not one above the other");
        R_[0] = R1;
        R_[1] = R2;
        principalPoint_ = Point2d(0.5 * (size_.width - 1), 0.5 * (size_.height - 1));
        if (fillsImages)
        {
            focalLength_ = P1.at<double>(0, 0);
            principalPoint_ = Point2d(P1.at<double>(0, 2), P1.at<double>(1, 2));
        }
        else if (fieldOfView > 0)
            focalLength_ = 0.5 * size_.width / std::tan(0.5 * fieldOfView * CV_PI / 180);
        else
            focalLength_ = 0.5 * (c.cameraMatrix1.at<double>(0, 0) + c.cameraMatrix2.at<double>(0, 0)) * size_.width /
                           c.imageSize.width;
        const double most = 1e6;
        if (!(focalLength_ > 1 && focalLength_ < most && std::abs(principalPoint_.x) < most &&
              std::abs(principalPoint_.y) < most))
            CV_Error(Error::StsBadArg,
                     fillsImages
                         ? "fieldOfView must be given: with this distortion and these principal points nothing else "
                           "tells the size of what both cameras see. Is the calibration right?"
                         : format("size must be larger, or fieldOfView smaller: the focal length would be %g pixels, "
                                  "which must be between 1 and 10^6",
                                  focalLength_));
    }

    //! Where the pixels of a rectified image are in the raw one
    void makeMaps(int camera)
    {
        const StereoCalibration& c = calibration_;
        const Mat &K = camera ? c.cameraMatrix2 : c.cameraMatrix1, &D = camera ? c.distCoeffs2 : c.distCoeffs1;
        const Matx33d rectified(focalLength_, 0, principalPoint_.x, 0, focalLength_, principalPoint_.y, 0, 0, 1);
        Mat x, y;
        if (c.isFisheye)
            fisheye::initUndistortRectifyMap(K, D, R_[camera], rectified, size_, CV_32FC1, x, y);
        else
            initUndistortRectifyMap(K, D, R_[camera], rectified, size_, CV_32FC1, x, y);

        const double minCosine = std::cos(maxUnfoldedAngle(D, c.isFisheye));
        const Matx33d toCamera = R_[camera].t() * rectified.inv();
        Mat& mask = masks_[camera];
        mask.create(size_, CV_8U);
        for (int i = 0; i < size_.height; ++i)
            for (int j = 0; j < size_.width; ++j)
            {
                const Vec3d ray = toCamera * Vec3d(j, i, 1);
                float &u = x.at<float>(i, j), &v = y.at<float>(i, j);
                const bool isReached = ray[2] > minCosine * norm(ray) && u >= 0 && u <= c.imageSize.width - 1 &&
                                       v >= 0 && v <= c.imageSize.height - 1;
                mask.at<uchar>(i, j) = isReached ? 255 : 0;
                if (!isReached)
                    u = v = -2; // outside: cv::remap leaves 0 there
            }
        convertMaps(x, y, positions_[camera], fractions_[camera], CV_16SC2);
    }

    void checkImage(const Mat& image, const char* name) const
    {
        const Size size = calibration_.imageSize;
        if (image.size() != size)
            CV_Error(Error::StsUnmatchedSizes,
                     format("%s must be an image of %d x %d pixels, as the calibration is for, not %d x %d", name,
                            size.width, size.height, image.cols, image.rows));
        const int depth = image.depth(), channels = image.channels();
        if ((depth != CV_8U && depth != CV_16U && depth != CV_32F) || channels > 4 || channels == 2)
            CV_Error(Error::StsUnsupportedFormat,
                     String(name) + " must be an image of CV_8U, CV_16U or CV_32F and 1, 3 or 4 channels");
    }

    const StereoCalibration calibration_;
    // Of the rectified cameras; the left one is the first of two
    const Size size_;
    const double baseline_; // metres
    Matx33d R_[2];
    double focalLength_;
    Point2d principalPoint_;
    Mat positions_[2], fractions_[2]; // for cv::remap: CV_16SC2, CV_16UC1
    Mat masks_[2];                    // CV_8UC1: 255 where there is a raw pixel
};

} // namespace

Ptr<StereoRig> StereoRig::create(const StereoCalibration& calibration, double fieldOfView, Size size)
{
    CV_TRACE_FUNCTION();
    StereoCalibration checked = calibration;
    const std::string c = "calibration: ";
    hdp::checkCalibration({ c + "imageSize",
                            { { c + "cameraMatrix1", c + "cameraMatrix1", c + "distCoeffs1" },
                              { c + "cameraMatrix2", c + "cameraMatrix2", c + "distCoeffs2" } },
                            c + "R",
                            c + "T" },
                          checked);
    if (!(fieldOfView == 0 || (fieldOfView >= 1 && fieldOfView <= 170)))
        CV_Error(Error::StsOutOfRange, "fieldOfView must be 0, or from 1 to 170 degrees");
    if (size == Size())
        size = checked.imageSize;
    if (!hdp::isPossible(size))
        CV_Error(Error::StsOutOfRange, "size must be from 1 x 1 to 32766 x 32766");
    return makePtr<StereoRigImpl>(checked, fieldOfView, size);
}

}} // namespace cv::stereo
