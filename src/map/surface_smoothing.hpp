// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SURFACE_SMOOTHING_HPP
#define OPENCV_HDPSTEREO_SURFACE_SMOOTHING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is around a row of smoothSurfaces()
struct SmoothedRow
{
    enum
    {
        radius = 4 // pixels
    };
    int width;
    const ushort* own;                           // with radius elements more on both sides
    const ushort *above[radius], *below[radius]; // by the distance less one
};

/** Smooths each surface by itself: the noise of a disparity's fraction is that of a single pixel. It is a sigma filter
@cite Lee1983Sigma over pairs of pixels: each pixel becomes the mean of the 16 that are up to 4 pixels away in its row
and its column. Two that are opposite to one another count if both differ from it by one pixel at most, so that slopes
and outlines stay as they are; otherwise it counts itself in their place. Borders are replicated.
@param disparity CV_16UC1. USHRT_MAX changes no pixel beside it.
@param smoothed Receives the map; another one. */
CV_EXPORTS void smoothSurfaces(const Mat& disparity, Mat& smoothed);

}}} // namespace cv::stereo::hdp

#endif
