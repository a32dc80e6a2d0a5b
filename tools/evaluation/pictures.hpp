// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Pictures of maps and of what a matcher knows of them

#ifndef OPENCV_HDPSTEREO_TOOLS_PICTURES_HPP
#define OPENCV_HDPSTEREO_TOOLS_PICTURES_HPP

#include "scores.hpp"

namespace hdp_tools {

//! The disparities that a map's colors are to tell apart: all of them but a few outliers
cv::Vec2f colorRange(const Mat& disparity);

//! The map in colors, from blue (far) by green to orange (near); black where there is no disparity.
Mat colorPicture(const Mat& disparity, const cv::Vec2f& range);

Mat colorPicture(const Mat& disparity);

//! A map in colors; wrong pixels by the main score red, pixels that are not judged black.
Mat resultPicture(const Mat& disparity, const Pair& pair);

//! Every tree in a color of its own, by its number
Mat forestPicture(const Mat& trees);

//! Number of candidates of each pixel: violet for 1 to yellow for all, in equal steps of the logarithm
Mat widthPicture(const Mat& intervals, int numDisparities);

//! P(D_l | D_{l+1}): a row for every D_{l+1}, its largest element white. Rows without any are black.
Mat matrixPicture(const cv::Mat_<double>& matrix);

} // namespace hdp_tools

#endif
