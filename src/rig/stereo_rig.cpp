// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "opencv2/hdpstereo/stereo_rig.hpp"

#include "calibration_check.hpp"
#include "rectification.hpp"

#include <limits>

namespace cv { namespace stereo {

namespace {

//! Of each disparity in pixels, CV_32FC1; 0 if there is none
Mat depthOf(const Mat& disparity, double focalTimesBaseline, double smallest)
{
    Mat depth(disparity.size(), CV_32F);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const double pixels = disparity.at<float>(y, x);
            const bool isKnown = pixels > 0 && pixels >= smallest && pixels <= std::numeric_limits<float>::max();
            depth.at<float>(y, x) = isKnown ? (float)(focalTimesBaseline / pixels) : 0;
        }
    return depth;
}

class StereoRigImpl CV_FINAL : public StereoRig
{
public:
    StereoRigImpl(const StereoCalibration& calibration, double fieldOfView, Size size)
        : calibration_(calibration), rectification_(hdp::planRectification(calibration, fieldOfView, size))
    {
        for (int camera = 0; camera < 2; ++camera)
            hdp::makeMaps(calibration_, rectification_, camera, maps_[camera]);
    }

    void rectify(InputArray left, InputArray right, OutputArray rectifiedLeft,
                 OutputArray rectifiedRight) const CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        const Mat raw[] = { left.getMat(), right.getMat() };
        for (int camera = 0; camera < 2; ++camera)
            checkImage(raw[camera], camera ? "right" : "left");
        if (raw[0].type() != raw[1].type())
            CV_Error(Error::StsUnmatchedFormats, "left and right must be of one type");
        Mat rectified[2];
        for (int camera = 0; camera < 2; ++camera)
            remap(raw[camera], rectified[camera], maps_[camera].positions, maps_[camera].fractions, INTER_LINEAR,
                  BORDER_CONSTANT, Scalar());
        rectified[0].copyTo(rectifiedLeft);
        rectified[1].copyTo(rectifiedRight);
    }

    void getMasks(OutputArray left, OutputArray right) const CV_OVERRIDE
    {
        maps_[0].mask.copyTo(left);
        maps_[1].mask.copyTo(right);
    }

    void computeDepth(InputArray disparityArray, OutputArray depth, int depthType, int minDisparity) const CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        const Mat disparity = disparityArray.getMat();
        if (disparity.type() != CV_16SC1 && disparity.type() != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "disparity must be CV_16SC1 or CV_32FC1");
        if (depthType != CV_32F && depthType != CV_16U)
            CV_Error(Error::StsBadArg, "depthType must be CV_32F or CV_16U");
        const double product = rectification_.focalLength * rectification_.baseline;
        Mat pixels;
        disparity.convertTo(pixels, CV_32F, disparity.depth() == CV_16S ? 1. / StereoMatcher::DISP_SCALE : 1);
        const Mat metres = depthOf(pixels, product, minDisparity);
        Mat result = metres;
        if (depthType == CV_16U)
        {
            metres.convertTo(result, CV_16U, 1000);
            result.setTo(0, metres > 65.535);
        }
        else
            result.setTo(std::numeric_limits<float>::quiet_NaN(), metres == 0);
        result.copyTo(depth);
    }

    void getRectification(OutputArray R1, OutputArray R2, OutputArray P1, OutputArray P2,
                          OutputArray Q) const CV_OVERRIDE
    {
        const double f = rectification_.focalLength, B = rectification_.baseline;
        const Point2d c = rectification_.center;
        Mat(rectification_.R[0]).copyTo(R1);
        Mat(rectification_.R[1]).copyTo(R2);
        Mat(Matx34d(f, 0, c.x, 0, 0, f, c.y, 0, 0, 0, 1, 0)).copyTo(P1);
        Mat(Matx34d(f, 0, c.x, -f * B, 0, f, c.y, 0, 0, 0, 1, 0)).copyTo(P2);
        Mat(Matx44d(1, 0, 0, -c.x, 0, 1, 0, -c.y, 0, 0, 0, f, 0, 0, 1 / B, 0)).copyTo(Q);
    }

    StereoCalibration getCalibration() const CV_OVERRIDE
    {
        StereoCalibration copy = calibration_;
        for (Mat* matrix :
             { &copy.cameraMatrix1, &copy.cameraMatrix2, &copy.distCoeffs1, &copy.distCoeffs2, &copy.R, &copy.T })
            *matrix = matrix->clone();
        return copy;
    }

    Size getSize() const CV_OVERRIDE { return rectification_.size; }
    double getBaseline() const CV_OVERRIDE { return rectification_.baseline; }
    double getFocalLength() const CV_OVERRIDE { return rectification_.focalLength; }

private:
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
    const hdp::Rectification rectification_;
    hdp::RectificationMaps maps_[2];
};

hdp::CalibrationNames memberNames()
{
    const std::string c = "calibration: ";
    return { c + "imageSize",
             { { c + "cameraMatrix1", c + "cameraMatrix1", c + "distCoeffs1" },
               { c + "cameraMatrix2", c + "cameraMatrix2", c + "distCoeffs2" } },
             c + "R",
             c + "T" };
}

} // namespace

Ptr<StereoRig> StereoRig::create(const StereoCalibration& calibration, double fieldOfView, Size size)
{
    CV_TRACE_FUNCTION();
    StereoCalibration checked = calibration;
    hdp::checkCalibration(memberNames(), checked);
    if (!(fieldOfView == 0 || (fieldOfView >= 1 && fieldOfView <= 170)))
        CV_Error(Error::StsOutOfRange, "fieldOfView must be 0, or from 1 to 170 degrees");
    if (size == Size())
        size = checked.imageSize;
    if (!hdp::isPossible(size))
        CV_Error(Error::StsOutOfRange, "size must be from 1 x 1 to 32766 x 32766");
    return makePtr<StereoRigImpl>(checked, fieldOfView, size);
}

}} // namespace cv::stereo
