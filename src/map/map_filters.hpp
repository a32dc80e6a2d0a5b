// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MAP_FILTERS_HPP
#define OPENCV_HDPSTEREO_MAP_FILTERS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// Filters of a disparity map, in the order in which they run. Each is in a file of its own.

//! Median of size x size pixels, 3, 5 or 7, borders replicated: several times faster than cv::medianBlur, which does
//! not share the work on a column of the window. disparity: CV_16UC1; filtered: another Mat.
CV_EXPORTS void medianDisparity(const Mat& disparity, int size, Mat& filtered);

/** Gives back what the median removed although it is more than noise: a pixel takes its disparity from before the
median if this is clearly nearer, and if many of the pixels in the window around it, as far as that is inside the
image, had about the same disparity.
@param unfiltered The map before the median, CV_16UC1.
@param disparity The map after the median. */
CV_EXPORTS void restoreThinStructures(const Mat& unfiltered, Mat& disparity);

const int smoothingRadius = 4; // pixels

/** Smooths each surface by itself: the noise of a disparity's fraction is that of a single pixel. It is a sigma filter
@cite Lee1983Sigma over pairs of pixels: each pixel becomes the mean of the 16 that are up to 4 pixels away in its row
and its column. Two that are opposite to one another count if both differ from it by one pixel at most, so that slopes
and outlines stay as they are; otherwise it counts itself in their place. Borders are replicated.
@param disparity CV_16UC1. USHRT_MAX changes no pixel beside it.
@param smoothed Receives the map; another one. */
CV_EXPORTS void smoothSurfaces(const Mat& disparity, Mat& smoothed);

}}} // namespace cv::stereo::hdp

#endif
