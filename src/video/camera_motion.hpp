// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CAMERA_MOTION_HPP
#define OPENCV_HDPSTEREO_CAMERA_MOTION_HPP

#include "../pair/point_tracker.hpp"

namespace cv { namespace stereo { namespace hdp {

/** How the cameras moved from one frame to the next, as a scene at rest shows it in the left image: a point that was at
(x, y) with disparity d is now at (X / W, Y / W) with disparity d / W, where (X, Y, d, W) = forward * (x, y, d, 1).

Every rigid motion is such a matrix, whatever focal length and baseline are: the columns of x, y and 1 are the
homography of points at infinity, the column of d is the epipole. */
struct CameraMotion
{
    static const int minPoints = 30; // that tell one, for eleven terms: fewer may agree by chance
    Matx44d forward = Matx44d::eye();
    bool isStill = true; // forward is the identity
    double error = 0;    // median distance of the points from where it takes them, in pixels
};

//! Moves points to where a motion in their pixels takes them; those that leave the image are nowhere.
CV_EXPORTS void movePoints(const CameraMotion& motion, Size size, std::vector<TrackedPoint>& points);

//! Fits a motion to most of the points, at most tolerance pixels, more than 0.25, from a first guess; others, as on
//! things that move by themselves, lose their weight. None if most are where they were, or of less than minPoints.
CV_EXPORTS CameraMotion fitMotion(const std::vector<TrackedPoint>& points, Size size, double tolerance);

//! The motion in pixels of an image that is scale times as large
CV_EXPORTS CameraMotion scaled(const CameraMotion& motion, double scale);

//! How the motion of the camera changes the disparity of what is now at (x, y):
//! before = d / (ofX x + ofY y + ofDisparity d + constant), d = now - offset. Disparities are in pixels.
struct DisparityChange
{
    float ofX, ofY, ofDisparity, constant, offset;
    float minDisparity, maxDisparity; // of a map, which counts from the first one, as the next two disparities do

    //! The disparity of what is now at (x, y) and had the disparity before: the equation above, solved for it
    CV_ALWAYS_INLINE float now(float before, float x, float y) const
    {
        const float ofPlace = ofX * x + (ofY * y + constant), old = before + minDisparity, w = 1 - ofDisparity * old;
        const float minW = 0.1f; // what gets ten times as near in a frame is at the camera or behind it
        const float positive = w > minW ? w : minW;
        const float disparity = old * ofPlace / positive + offset - minDisparity;
        const float notNegative = disparity > 0 ? disparity : 0;
        return notNegative < maxDisparity ? notNegative : maxDisparity;
    }
};

/** A change as it was measured: cameras shake against each other, and the motion is an estimate. The disparities become
factor d + offset, both fitted robustly to those that the change, whose offset is 0, predicted and those measured. */
CV_EXPORTS DisparityChange correctedChange(const DisparityChange& change, const std::vector<float>& predicted,
                                           const std::vector<float>& measured);

//! From a pixel of this frame to where it was; disparities count from minDisparity, up to maxDisparity, in pixels.
struct CV_EXPORTS BackwardMotion
{
    Vec4f x, y, w; // of (x, y, disparity, 1)
    DisparityChange change;

    BackwardMotion() {}
    BackwardMotion(const CameraMotion& motion, double minDisparity, double maxDisparity);

    //! Where a pixel was in the last frame if this is its disparity now; (-1, -1) if that is behind the camera
    CV_ALWAYS_INLINE Point2f placeBefore(int atX, int atY, float disparity) const
    {
        const float minW = 0.001f; // of what is in front of the camera it is larger; the division stays finite
        const float ownW = w[0] * atX + w[1] * atY + w[2] * disparity + w[3];
        const float factor = 1 / (ownW > minW ? ownW : minW);
        const float placeX = (x[0] * atX + x[1] * atY + x[2] * disparity + x[3]) * factor;
        const float placeY = (y[0] * atX + y[1] * atY + y[2] * disparity + y[3]) * factor;
        return Point2f(ownW > minW ? placeX : -1, ownW > minW ? placeY : -1);
    }
};

}}} // namespace cv::stereo::hdp

#endif
