// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_POINT_TRACKER_HPP
#define OPENCV_HDPSTEREO_POINT_TRACKER_HPP

#include "opencv2/core.hpp"

#include <functional>
#include <vector>

namespace cv { namespace stereo { namespace hdp {

//! No point of an image
const Point nowhere(-1, -1);

//! A point of the scene in two frames, in pixels
struct TrackedPoint
{
    Point2d before, now;
    double disparity; // in the frame before
};

/** The best pixel of each cell of a grid, row by row; the first one of several.
@param cell,step Side of a cell, and from a candidate to the next, in pixels.
@param minScore A cell whose pixels have no more has none.
@param score Of a pixel; called by several threads. */
std::vector<Point> bestPixels(Size grid, int cell, int step, double minScore,
                              const std::function<double(const Point&)>& score);

//! Number of levels that trackPoints() needs if the finest one has this size; each has a pixel.
CV_EXPORTS int trackingLevels(Size size);

/** Chooses points to be tracked: on a grid, where the image has texture in both directions.
@param before Pyramid of the frame before, CV_8UC1, the finest level first, which points are in pixels of. */
CV_EXPORTS void choosePoints(const std::vector<Mat>& before, std::vector<TrackedPoint>& points);

//! Where trackPoints() begins
enum TrackingStart
{
    FROM_BEFORE, // TrackedPoint::before, on the coarsest level
    FROM_GUESS   // TrackedPoint::now, or nowhere for a point that stays where it was; on the finest levels alone
};

/** Finds points again: where the sum of absolute differences over a square has its minimum, with the fraction of a
parabola. Those that leave the image stay where they were, as if at rest. */
CV_EXPORTS void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now, TrackingStart start,
                            std::vector<TrackedPoint>& points);

}}} // namespace cv::stereo::hdp

#endif
