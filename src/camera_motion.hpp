// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CAMERA_MOTION_HPP
#define OPENCV_HDPSTEREO_CAMERA_MOTION_HPP

#include "opencv2/core.hpp"

#include <vector>

namespace cv {
namespace stereo {
namespace hdp {

/** How the cameras moved from one frame to the next, as a scene at rest shows it in the left image: a point that was at
(x, y) with disparity d is now at (X / W, Y / W) with disparity d / W, where (X, Y, d, W) = forward * (x, y, d, 1).

Every rigid motion is such a matrix, whatever focal length and baseline are: the columns of x, y and 1 are the homography
of points at infinity, the column of d is the epipole. */
struct CameraMotion
{
    Matx44d forward = Matx44d::eye();
    bool isStill = true; // forward is the identity
};

//! A point of the scene in two frames, in pixels
struct TrackedPoint
{
    Point2d before, now;
    double disparity; // in the frame before
};

//! The constants of trackPoints() and fitMotion()
struct MotionTracking
{
    enum
    {
        coarsestWidth = 160,  // of the level that the search begins at, at most
        spacing = 4,          // of the points, in pixels of that level
        side = 8,             // of the squares that are compared, in pixels of any level
        searchRadius = 8,     // on the coarsest level, in its pixels
        refinementRadius = 2, // on the others
        minTexture = 3,       // levels from a pixel to the next, in both directions, on average
        minPoints = 30,       // of a motion
        fittingRounds = 12    // of reweighted least squares
    };
};

//! Number of levels that trackPoints() needs if the finest one has this width
CV_EXPORTS int trackingLevels(int width);

/** Finds points again, from the coarsest level to the finest: where the sum of absolute differences over a square is
least, with the fraction of a parabola.
@param before Pyramid of the frame before, CV_8UC1, the finest level first, each of half the size of the one before.
@param now That of this frame, of the same sizes.
@param points Receives points on a grid, where the image has texture in both directions; positions in pixels of the
finest level. Disparities are not set. */
CV_EXPORTS void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now,
                            std::vector<TrackedPoint>& points);

/** Finds points again near the places that a motion takes them to. See trackPoints().
@param before
@param now
@param motion In pixels of the finest level, disparities as well.
@param points Changed. */
CV_EXPORTS void trackPointsAgain(const std::vector<Mat>& before, const std::vector<Mat>& now,
                                 const CameraMotion& motion, std::vector<TrackedPoint>& points);

/** Fits a motion to most of the points. Those that do not fit, as on things that move by themselves, lose their weight.
@param points The points.
@param size Of the image that their positions are in.
@return The motion; isStill if it does not explain clearly more of the points than none. */
CV_EXPORTS CameraMotion fitMotion(const std::vector<TrackedPoint>& points, Size size);

//! The motion in pixels of an image that is scale times as large
CV_EXPORTS CameraMotion scaled(const CameraMotion& motion, double scale);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
