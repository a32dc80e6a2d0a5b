// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MAP_FILTERS_HPP
#define OPENCV_HDPSTEREO_MAP_FILTERS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// Filters of a disparity map, in the order in which they run, but for voteAtEdges(), which is the last but one. Each is
// in a file of its own.

//! Median of size x size pixels, 3, 5 or 7, borders replicated: several times faster than cv::medianBlur, which does
//! not share the work on a column of the window. disparity: CV_16UC1; filtered: another Mat.
CV_EXPORTS void medianDisparity(const Mat& disparity, int size, Mat& filtered);

/** Gives back what the median removed although it is more than noise: a pixel takes its disparity from before the
median if this is clearly nearer, and if many of the pixels in the window around it, as far as that is inside the
image, had about the same disparity.
@param unfiltered The map before the median, CV_16UC1.
@param disparity The map after the median. */
CV_EXPORTS void restoreThinStructures(const Mat& unfiltered, Mat& disparity);

/** Smooths each surface by itself. The variance of a disparity's fraction is that of the noise over the sum of the
squared slopes around it @cite Kanade1994Adaptive: a pixel with texture stays as it is, one without takes over what
is on both sides of it. The precision of a pixel is the sum over 7 x 7 pixels of (slope / noise)^2 - 1/2, the slope
being half the difference of the grey levels to the left and to the right, and the half what noise alone has; 1 at
least.

Each pixel becomes a mean of itself and pairs of opposite pixels, as in a sigma filter @cite Lee1983Sigma: those 1, 2
and 4 pixels away in the row, if neither differs from it by more than a surface's do, so that slopes and outlines stay
as they are. It has its precision for a weight, both of a pair the lower one of theirs, at most 64 over the square of
the distance. The same follows in the columns, and both again for pixels 3, 6 and 12 away. There are none beyond the
map.
@param levels Grey levels, CV_16UC1 in 1 / greyScale.
@param noise Standard deviation of the grey levels; half a level at least counts.
@param mostDifference Of the disparities of a surface.
@param disparity CV_16UC1; at most 4094 pixels. USHRT_MAX changes no other pixel.
@param smoothed Receives the map; another one. */
CV_EXPORTS void smoothSurfaces(const Mat& levels, double noise, int mostDifference, const Mat& disparity,
                               Mat& smoothed);

}}} // namespace cv::stereo::hdp

#endif
