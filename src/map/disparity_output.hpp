// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_OUTPUT_HPP
#define OPENCV_HDPSTEREO_DISPARITY_OUTPUT_HPP

#include "../pair/disparity_ranges.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Bytes per pixel of the memory of cv::filterSpeckles, which counts them by int
const int speckleBytes = 9;

//! What outputDisparity() makes of the finest layer
struct OutputPlan
{
    int minDisparity;
    int extension;   // columns of the layers that the image does not have, in pixels of the image
    int finestLayer; // 0: the image
    bool isWhole;    // whether disparities are rounded to whole pixels
    int disp12MaxDiff, speckleWindowSize, speckleRange; // as of cv::StereoMatcher; <= 0: no filter

    bool hasFilters() const { return disp12MaxDiff > 0 || speckleWindowSize > 0; }
    bool hasBothFilters() const { return disp12MaxDiff > 0 && speckleWindowSize > 0; }
};

//! Memory that is kept from pair to pair
struct OutputBuffers
{
    bool hasRejected = false;
    Mat rejected;  // CV_8UC1, 255 where a pixel has no data or a filter rejected it; if hasRejected
    Mat notStable; // CV_8UC1, 255 where the left-right check rejected it or it has no data, if there are two filters
    Mat masked;    // CV_8UC1, 255 where it has no data, or its range no candidate; empty: all have
    std::vector<Mat> enlarged;
    Mat whole, fixedPoint, speckles;
};

/** From the disparities of the finest layer to what cv::StereoMatcher promises: those of every pixel of the image, from
minDisparity on, less those without data and what the left-right check and the speckle filter reject.
@param finest CV_16UC1 of the finest layer's size, a disparity map.
@param plan What to do.
@param buffers Memory to work in; receives what was rejected.
@param disparity CV_16SC1 or CV_32FC1 of the image's size; receives the result.
@param mask Of the image, CV_8UC1, 0 where it has no data; empty: it has everywhere.
@param ranges What each pixel may have: the nearest of that, or nothing if it may have none of the candidates. */
CV_EXPORTS void outputDisparity(const Mat& finest, const OutputPlan& plan, OutputBuffers& buffers, Mat& disparity,
                                const Mat& mask = Mat(), const PixelRanges& ranges = PixelRanges());

}}} // namespace cv::stereo::hdp

#endif
