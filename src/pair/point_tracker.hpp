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

//! Tells what some pixels of row y are worth.
typedef std::function<void(int y, const std::vector<int>& columns, double* scores)> RowScores;

/** Finds the best pixel of each cell of a grid, the first one of several.
@param grid Number of cells.
@param cell Side of a cell, in pixels.
@param step From a candidate to the next, in pixels.
@param minScore A pixel has to have more.
@param scoreRow The score; called by several threads.
@param best Receives a pixel of each cell, row by row, or nowhere. */
void bestPixelPerCell(Size grid, int cell, int step, double minScore, const RowScores& scoreRow,
                      std::vector<Point>& best);

//! Number of levels that trackPoints() needs if the finest one has this size; each has a pixel.
CV_EXPORTS int trackingLevels(Size size);

/** Chooses points to be tracked: on a grid, where the image has texture in both directions.
@param before Pyramid of the frame before, CV_8UC1, the finest level first, each of half the size of the one before.
@param points Receives TrackedPoint::before of each, in pixels of the finest level. */
CV_EXPORTS void choosePoints(const std::vector<Mat>& before, std::vector<TrackedPoint>& points);

/** Finds points again, from the coarsest level to the finest: where the sum of absolute differences over a square has
its minimum, with the fraction of a parabola.
@param before Pyramid of the frame before.
@param now That of this frame, of the same sizes.
@param points Receives TrackedPoint::now of each; those that leave the image stay where they were. */
CV_EXPORTS void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now,
                            std::vector<TrackedPoint>& points);

/** Finds points again near the places where they are thought to be. See trackPoints().
@param before Pyramid of the frame before.
@param now That of this frame, of the same sizes.
@param points TrackedPoint::now is a guess, or nowhere for a point that stays where it was; receives the place. */
CV_EXPORTS void trackNearby(const std::vector<Mat>& before, const std::vector<Mat>& now,
                            std::vector<TrackedPoint>& points);

}}} // namespace cv::stereo::hdp

#endif
