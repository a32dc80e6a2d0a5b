// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_REFINEMENT_HPP
#define OPENCV_HDPSTEREO_DISPARITY_REFINEMENT_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Median of size x size pixels, 3, 5 or 7, borders replicated: several times faster than cv::medianBlur, which does
//! not share the work on a column of the window. disparity: CV_16UC1; filtered: another Mat.
CV_EXPORTS void medianDisparity(const Mat& disparity, int size, Mat& filtered);

//! The constants of restoreThinStructures()
struct ThinStructures
{
    enum
    {
        window = 7,        // side of the square, in pixels
        minShare = 30,     // percent of its pixels that are of the structure
        minDistance = 5,   // in front of what the median left, in pixels
        maxDifference = 1, // inside the structure, in pixels
        columns = 64       // that are looked at together
    };
};

/** Gives back what the median removed although it is more than noise: a pixel takes its disparity from before the median
if this is nearer by minDistance, and if minShare of the pixels in the window around it, as far as that is inside the
image, had the same disparity but for maxDifference.
@param unfiltered The map before the median, CV_16UC1.
@param disparity The map after the median. */
CV_EXPORTS void restoreThinStructures(const Mat& unfiltered, Mat& disparity);

//! Memory for a row of fillOccluded()
struct OcclusionScratch
{
    explicit OcclusionScratch(int width)
        : columns(width), nearest((size_t)width + 1), keys(width), there((size_t)width + 1), visible(width),
          shown(width)
    {
    }

    std::vector<int> columns;          // of the right image that each pixel maps to, from 1 on; 0: none
    std::vector<int> nearest;          // the largest disparity that maps to each column
    std::vector<unsigned> keys;        // of each pixel, by which the lowest wins its column: residual and disparity
    std::vector<unsigned> there;       // the key that won each column
    std::vector<uchar> visible, shown; // which pixels the right image shows, and in its first columns
};

/** Gives pixels that the right image does not show the disparity of the farther of the pixels beside them. Of the
pixels that map to one column of the right image the one with the lowest residual is there; those whose disparity is
another one, and those that map to no column, are not. Nor are single pixels between two that are not, nor what is left
of a surface that begins at the border of the right image: the last run of four pixels it shows, without steps, of which
the first one is in column 0, 1 or 2; or one that is nearer than what is before it, if nearer pixels hide three quarters
of that from the right image, or it maps to no column, and an eighth at most is visible in columns that are not blank. The
surface is continued to the left border, half as steep as its first columns are.
@param disparity CV_16UC1, a disparity map; changed.
@param residual Matching costs, CV_8UC1.
@param right Grey levels of the right image, CV_16UC1, see greyLevels(): columns on its left are blank that are black, as
rectification leaves them. None if empty. */
CV_EXPORTS void fillOccluded(Mat& disparity, const Mat& residual, const Mat& right = Mat());

/** The disparities of a layer from those of the layer above: bilinear inside a surface, its pixel's own at its border.
@param upper CV_16UC1, a disparity map.
@param size Of the layer.
@param disparity Receives CV_16UC1, a disparity map. */
CV_EXPORTS void upsampleDisparity(const Mat& upper, Size size, Mat& disparity);

//! What the right image has at a pixel's match
enum Visibility
{
    VISIBLE,
    OCCLUDED, // a nearer pixel
    OUTSIDE   // nothing, it ends before
};

//! Marks the pixels as invalid whose disparity differs by more than maxDiff pixels from the largest one that maps to
//! the same column of the right image. disparity: CV_16SC1, times 16; invalid: its value of an invalid pixel.
CV_EXPORTS void rejectOccluded(Mat& disparity, int maxDiff, short invalid);

/** Left-right check of a layer's disparities: which pixels are stable.
@param disparity CV_16UC1, a disparity map.
@param maxDiff A pixel is stable if the largest disparity that maps to its column of the right image is larger by
maxDiff pixels at most. One that maps to no column is not.
@param stable Receives CV_8UC1, 255 where stable, else 0. */
CV_EXPORTS void findStable(const Mat& disparity, int maxDiff, Mat& stable);

}}} // namespace cv::stereo::hdp

#endif
