// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_ROW_MATCHES_HPP
#define OPENCV_HDPSTEREO_ROW_MATCHES_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {
namespace hdp {

//! The constants of findRowMatches() and trackRowMatches()
struct RowMatching
{
    enum
    {
        points = 600,     // at most so many, one per cell of a grid
        searchRadius = 2, // rows above and below that are searched on the coarse layer
        searchSide = 9,   // of the window there
        trackWidth = 16,  // of the window on the finer layers
        trackHeight = 13,
        iterations = 3,
        leastSide = 2 * (searchSide + searchRadius) // of an image
    };
};

//! A point of the left image and what it matches in the right one, in pixels of a layer
struct RowMatch
{
    Point left;
    double x, y;     // in the right image
    double variance; // of y
    bool isValid;
};

/** Matches the corners of a coarse layer over all disparities and some rows by normalised cross-correlation.
@param left CV_16UC1, values up to 1023.
@param right Of the same size and type.
@param numDisparities Of the layer.
@param matches Receives one match per corner, to whole pixels. */
CV_EXPORTS void findRowMatches(const Mat& left, const Mat& right, int numDisparities, std::vector<RowMatch>& matches);

/** Improves matches to a fraction of a pixel by the method of Lucas and Kanade, on windows of equal mean and variance.
@param left CV_16UC1, values up to 1023.
@param right Of the same size and type.
@param matches Where the points are by what is known so far. What is lost becomes invalid. */
CV_EXPORTS void trackRowMatches(const Mat& left, const Mat& right, std::vector<RowMatch>& matches);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
