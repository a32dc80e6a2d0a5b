// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_STEREO_RIG_HPP
#define OPENCV_HDPSTEREO_STEREO_RIG_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief What a calibration says of two cameras side by side, as cv::stereoCalibrate has it.

A point X of the left camera is R X + T in the right one: x to the right, y down, z forward.
 */
struct CV_EXPORTS_W_SIMPLE StereoCalibration
{
    CV_WRAP StereoCalibration() : isFisheye(false) {}

    //! Size of the raw images, in pixels
    CV_PROP_RW Size imageSize;

    //! Left camera: CV_64F, 3 x 3; focal lengths and principal point in pixels
    CV_PROP_RW Mat cameraMatrix1;
    //! Its distortion: CV_64F, 1 x 4, 5, 8, 12 or 14; with isFisheye 1 x 4
    CV_PROP_RW Mat distCoeffs1;
    //! Right camera
    CV_PROP_RW Mat cameraMatrix2;
    //! Its distortion
    CV_PROP_RW Mat distCoeffs2;

    //! Rotation from the left to the right camera: CV_64F, 3 x 3
    CV_PROP_RW Mat R;
    //! Translation from the left to the right camera: CV_64F, 3 x 1, in metres
    CV_PROP_RW Mat T;

    //! Whether distortion is that of cv::fisheye
    CV_PROP_RW bool isFisheye;
};

/** @brief Reads a calibration from the files of the program or the vendor that made it.

| files | of |
|---|---|
| intrinsics.yml, extrinsics.yml (or one with both) | OpenCV's stereo_calib: M1, D1, M2, D2, R, T; `fisheye_model: 1` |
| left.yaml, right.yaml | ROS, camera_info: plumb_bob, rational_polynomial, equidistant |
| camchain.yaml | Kalibr: cam0 is the left, cam1 the right camera; pinhole with radtan, equidistant or none |
| sensor.yaml, sensor.yaml | EuRoC: T_BS, radial-tangential or equidistant |
| SN12345.conf | the ZED's factory calibration |

@param first File of the left camera, or the only one.
@param second File of the right camera, or with R and T.
@param imageSize Size of the raw images. If it has the same aspect as the size of the calibration, that is scaled. The
size of the calibration by default; but OpenCV's and the ZED's files do not have it, and it must be given.
@param unit Metres in a unit of T, in OpenCV's files: it is that of the chessboard's squares. Others are in known units.
@throws cv::Exception with the file and the field in one sentence if something is missing, not finite or impossible; if
the second camera is not to the right of the first; if the images have another aspect; if a principal point is outside
of the image or, in OpenCV's files, more than a quarter of its width or height from the middle: imageSize may be wrong.
If it is right, as of cropped images, fill in StereoCalibration.
 */
CV_EXPORTS_W StereoCalibration readStereoCalibration(const String& first, const String& second = String(),
                                                     Size imageSize = Size(), double unit = 1);

/** @brief A calibrated pair of cameras: from raw images to rectified ones, and from disparities to depth.

@code{.cpp}
    Ptr<StereoRig> rig = StereoRig::create(readStereoCalibration("left.yaml", "right.yaml"));
    rig->rectify(rawLeft, rawRight, left, right);
    matcher->compute(left, right, disparity);
    rig->computeDepth(disparity, depth); // metres
@endcode

With a field of view, getMasks() is for HDPTreeMatcher::setMasks().

Rectification is by OpenCV's own functions; its maps are computed once. An object is constant: threads may share it.
 */
class CV_EXPORTS_W StereoRig
{
public:
    virtual ~StereoRig() {}

    /** @brief Rectifies a pair.
    @param left Raw image of the calibration's size: CV_8U, CV_16U or CV_32F, 1, 3 or 4 channels.
    @param right Raw image of the same size and type.
    @param rectifiedLeft Receives the rectified image, see getSize(). What no raw pixel reaches is 0.
    @param rectifiedRight Receives the other one.
    @throws cv::Exception if an image is empty or of another size or type.
     */
    CV_WRAP virtual void rectify(InputArray left, InputArray right, OutputArray rectifiedLeft,
                                 OutputArray rectifiedRight) const = 0;

    /** @brief Returns which pixels of the rectified images show something. Either may be cv::noArray().
    @param left Receives CV_8UC1 of the rectified size: 255, or 0 for what no raw pixel reaches.
    @param right Receives that of the right image.
     */
    CV_WRAP virtual void getMasks(OutputArray left, OutputArray right) const = 0;

    /** @brief Computes the depth of each pixel: its distance from the cameras' plane.
    @param disparity CV_16SC1, times 16, or CV_32FC1 in pixels, of rectified images of getSize(), or of a part of these.
    @param depth Receives CV_32FC1 in metres, NaN where there is none, or CV_16UC1 in millimetres, 0 where there is
    none, or more than 65.535 m.
    @param depthType CV_32F or CV_16U.
    @param minDisparity In pixels. Disparities below it, at or below 0, or not finite are invalid. Rejected pixels of a
    matcher with minDisparity > 1 are above 0, so it is to be given then.
    @throws cv::Exception if an argument is of another type, disparity is empty or larger than getSize(), or depth is
    cv::noArray(), or of a fixed type or size that is not that of the result.
     */
    CV_WRAP virtual void computeDepth(InputArray disparity, OutputArray depth, int depthType = CV_32F,
                                      int minDisparity = 0) const = 0;

    /** @brief Returns the rectification, as cv::stereoRectify does. Any of the matrices may be cv::noArray().
    @param R1 Receives the rotation of the left camera: CV_64F, 3 x 3.
    @param R2 Receives that of the right camera.
    @param P1 Receives the projection of the left camera: CV_64F, 3 x 4, in pixels.
    @param P2 Receives that of the right camera.
    @param Q Receives the matrix for cv::reprojectImageTo3D: CV_64F, 4 x 4, to metres.
     */
    CV_WRAP virtual void getRectification(OutputArray R1, OutputArray R2, OutputArray P1, OutputArray P2,
                                          OutputArray Q) const = 0;

    //! Returns the calibration.
    CV_WRAP virtual StereoCalibration getCalibration() const = 0;

    //! Returns the size of the rectified images.
    CV_WRAP virtual Size getSize() const = 0;

    //! Returns the distance of the cameras in metres.
    CV_WRAP virtual double getBaseline() const = 0;

    //! Returns the focal length of the rectified images in pixels.
    CV_WRAP virtual double getFocalLength() const = 0;

    /** @brief Creates a rig.
    @param calibration See readStereoCalibration().
    @param fieldOfView Horizontal field of view of the rectified images in degrees, 1 to 170. 0: without fisheye as much
    as has no empty pixels, but for a column or row at a border, or 15 % and more with strong distortion and lenses
    beyond some 110 degrees, whose border cv::stereoRectify() undistorts in too few iterations: see getMasks(). With
    fisheye what keeps the focal length.
    @param size Size of the rectified images; by default that of the raw ones.
    @throws cv::Exception if a matrix of the calibration is of another size, not finite or impossible, if
    cv::stereoRectify() would put one camera above the other, if one sees nothing of the other's image, or if an
    argument is out of range.
     */
    CV_WRAP static Ptr<StereoRig> create(const StereoCalibration& calibration, double fieldOfView = 0,
                                         Size size = Size());
};

/** @brief How the right camera of a rig has turned since its calibration, by what rows reveal.

The rows of a rectified pair fit if the calibration does. HDPTreeMatcher::Findings::rows tells how they lie; over some
frames of different scenes this becomes angles, and a calibration that fits again.

@code{.cpp}
    Ptr<RigDrift> drift = RigDrift::create(P2, left.size()); // of StereoRig::getRectification()
    drift->add(matcher->getFindings().rows);                 // after each compute()
    rig = StereoRig::create(drift->correct(rig->getCalibration(), R2));
@endcode

After a turn of more than a quarter of a degree do that twice: the matcher expects small ones.

Pitch (up, down) and roll (about the view) move rows by much, and are found to a hundredth of a degree. Yaw (to the
side) moves rows at the corners only, as another focal length does at the upper and lower border: their deviations
tell how little is known of them, and they are corrected only beyond two of these. A yaw that is not seen is a
disparity that is off by focal length times yaw: look at a known distance. A camera that has not turned but moved
looks like one that has turned.
 */
class CV_EXPORTS_W RigDrift
{
public:
    virtual ~RigDrift() {}

    /** @brief Takes a frame into account.
    @param rows HDPTreeMatcher::Findings::rows of a pair that is rectified by the calibration.
    @return Whether it was: false if all are 0, as too few corners were matched or a row was off by more than
    HDPTreeMatcher::Params::maxRowOffset, or it contradicts those before, which are five at least. At the fifth
    contradiction in a row those are forgotten, and the estimate begins with it: something has hit the rig.
    @throws cv::Exception if there are not five finite numbers, or they move a row by a quarter of the image's height.
     */
    CV_WRAP virtual bool add(const std::vector<double>& rows) = 0;

    //! Returns how many frames were taken into account.
    CV_WRAP virtual int getFrames() const = 0;

    /** @brief Returns how the right camera has turned.
    @param values Receives pitch, yaw and roll in degrees, and by how much its focal length has grown, in percent of the
    left one's: positive pitch looks up, positive yaw to the right, positive roll is clockwise as seen from behind.
    @param deviations Receives their standard deviations. Infinite before the first frame.
     */
    CV_WRAP virtual void getEstimate(CV_OUT std::vector<double>& values,
                                     CV_OUT std::vector<double>& deviations) const = 0;

    /** @brief Returns the rotation of the right camera in rectified coordinates: CV_64F, 3 x 3.

    With its transpose from the left, R2 of cv::stereoRectify becomes that of the camera as it is now: maps by
    cv::initUndistortRectifyMap(K2, D2, rotation.t() * R2, P2, ...) bring rows together, and the left image stays. */
    CV_WRAP virtual Mat getRotation() const = 0;

    /** @brief Returns the calibration as it is now: R and T, and cameraMatrix2 if the focal length has changed.
    @param calibration That of the rectification.
    @param R2 Its rotation of the right camera: of StereoRig::getRectification() or cv::stereoRectify.
     */
    CV_WRAP virtual StereoCalibration correct(const StereoCalibration& calibration, InputArray R2) const = 0;

    /** @brief Creates an estimate that knows nothing yet.
    @param P2 Projection of the rectified right camera: 3 x 3 or 3 x 4, in pixels.
    @param imageSize Size of the rectified images.
    @param memory After so many frames, the oldest begin to be forgotten, >= 1.
    @throws cv::Exception if an argument is out of range.
     */
    CV_WRAP static Ptr<RigDrift> create(InputArray P2, Size imageSize, int memory = 100);
};

//! @}

}} // namespace cv::stereo

#endif
