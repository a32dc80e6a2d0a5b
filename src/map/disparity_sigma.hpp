// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_SIGMA_HPP
#define OPENCV_HDPSTEREO_DISPARITY_SIGMA_HPP

#include "../cost/census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

/** How much matched levels differ, in pixels of a shift that would explain it: D / (G + 1/2). D is the standard
deviation, over 9 x 9 pixels, of the differences of the left levels and those of the right image where the disparities
lead to, interpolated linearly; G the root of the mean square of half the difference between the left levels beside a
pixel. Levels are whole ones, borders are replicated.
@param disparity A disparity map of the layer, CV_16UC1.
@param cost Of the layer; it has the levels.
@param mismatch Receives CV_32FC1. */
CV_EXPORTS void levelMismatch(const Mat& disparity, const CensusCost& cost, Mat& mismatch);

/** Standard deviation of the disparities' errors, in pixels of the layer: 68 % of them are within it. It is what errors
of pixels with this confidence and mismatch are in pairs of known truth, by a table between whose lines and columns it
is linear, times the root of the row error in terms of the usual one and the fourth root of the noise.
@param confidence Of the layer, CV_8UC1.
@param mismatch Of the layer, CV_32FC1; empty if it is unknown.
@param rowError Of the pair, in pixels, see RowFindings; 0 if it is unknown.
@param noise Of the images in grey levels, 0 if it is unknown: as little.
@param rounding Of what disparities are rounded by, 0 if they have fractions.
@param sigma Receives CV_32FC1. */
CV_EXPORTS void disparitySigma(const Mat& confidence, const Mat& mismatch, double rowError, double noise,
                               float rounding, Mat& sigma);

}}} // namespace cv::stereo::hdp

#endif
