// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_RANGES_HPP
#define OPENCV_HDPSTEREO_DISPARITY_RANGES_HPP

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The disparities that each pixel of the image may have, in 1 / subpixelScale pixel, not less minDisparity
struct PixelRanges
{
    Mat smallest, largest; // CV_16SC1; empty: there are no ranges
    bool hasEmpty = false; // whether a pixel may have none

    bool isEmpty() const { return smallest.empty(); }
};

/** Ranges as the caller gives them, for each pixel of the image. Those of a coarser map hold for all pixels that are
nearest to one of it; what is no number limits nothing.
@param smallest,largest CV_32FC1, in pixels, of the images' size or coarser.
@param disparities The first and the last one of the map, in pixels; ranges have no others.
@param isWhole Whether ranges have only whole disparities.
@param ranges Receives them; largest is less than smallest where there is nothing in one. */
CV_EXPORTS void expandRanges(const Mat& smallest, const Mat& largest, Size size, Range disparities, bool isWhole,
                             PixelRanges& ranges);

/** The candidates of each pixel of each layer: those that one of the pixels of the image that it stands for may have,
or the nearest one, if these are none.
@param minDisparity What candidate 0 stands for.
@param extension Columns added on the left.
@param numDisparities,intervals Of each layer; receives a DisparityInterval per pixel. */
CV_EXPORTS void buildIntervals(const PixelRanges& ranges, int minDisparity, int extension,
                               const std::vector<int>& numDisparities, std::vector<Mat>& units,
                               std::vector<Mat>& intervals);

//! The hulls of 2 x 2 intervals each
CV_EXPORTS void halveIntervals(const Mat& intervals, Mat& hulls);

//! The intervals of a layer in candidates of the layer below, of which there are so many
CV_EXPORTS Mat doubleIntervals(const Mat& intervals, int candidates);

//! What candidates both have of each pixel, or those of the first if they have none in common; to the second
CV_EXPORTS void intersectIntervals(const Mat& intervals, Mat& others);

//! Moves the disparities of a layer into the intervals of its pixels. disparity: CV_16UC1, a disparity map.
CV_EXPORTS void moveIntoIntervals(const Mat& intervals, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
