// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP
#define OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP

#include "../cost/census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The maps that disparityConfidence() looks at
struct ConfidenceMaps
{
    Mat disparity;  // of the layer, CV_16UC1
    Mat unfiltered; // the same before the median
    Mat upper;      // of the layer above; empty if there is none
};

/** How far the disparities of a layer are to be trusted: 255 v sqrt(sqrt(S U) P M), rounded. Wrong disparities come in
patches with a step at their border, where other disparities fit as well, where the layer above had others, and where
the median had to change many.

S is the distance to the nearest pixel at a step, with a limit: min(distance, 64) / 64. The two pixels at a step are
neighbours in a row or column whose disparities differ by more than 1.5 pixels.

U is how much the cost of the disparity, as the nearest candidate has it, stands out from those of the candidates 2
pixels before and after it (or of the only one of them that there is): max(0, A - C) / (A + C), where C and A are the
means of both over a window of 21 x 21 pixels, borders replicated; 0 without alternatives or if A + C = 0. Costs are
rounded to 1/512, so that sums are of whole numbers.

P is 1 / (1 + 4 p), where p is the mean difference, in pixels, from twice the disparity that the layer above has there;
M is 1 / (1 + 4 m), where m is the mean change by the median; each difference counts as 8 at most. Means are those over
21 x 21 and 7 x 7 cells of 2 x 2 pixels, the pixel's own in the middle. Borders are replicated. P is 1 without a layer
above.

v is 1 for a pixel that passes the left-right check, see findStable(), and whose match has data, or else 1/2. Pixels
without data hide none.
@param numDisparities,cost Of the layer.
@param confidence Receives CV_8UC1. */
CV_EXPORTS void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const MatchingCost& cost,
                                    Mat& confidence);

/** How much matched levels differ, in pixels of a shift that would explain it: D / (G + 1/2). D is the standard
deviation, over 9 x 9 pixels, of the differences of the left levels and those of the right image where the disparities
lead to, interpolated linearly; G the root of the mean square of half the difference between the left levels beside a
pixel. Levels are whole ones, borders are replicated.
@param disparity,cost Of the layer, CV_16UC1; the cost has the levels.
@param mismatch Receives CV_32FC1. */
CV_EXPORTS void levelMismatch(const Mat& disparity, const CensusCost& cost, Mat& mismatch);

/** Standard deviation of the disparities' errors, in pixels of the layer: 68 % of them are within it. It is what errors
of pixels with this confidence and mismatch are in pairs of known truth, by a table between whose lines and columns it
is linear, times the root of the row error in terms of the usual one and the fourth root of the noise.
@param confidence,mismatch Of the layer, CV_8UC1 and CV_32FC1; the second is empty if it is unknown.
@param rowError Of the pair, in pixels, see RowFindings; 0 if it is unknown.
@param noise Of the images in grey levels, 0 if it is unknown: as little.
@param rounding Of what disparities are rounded by, 0 if they have fractions.
@param sigma Receives CV_32FC1. */
CV_EXPORTS void disparitySigma(const Mat& confidence, const Mat& mismatch, double rowError, double noise,
                               float rounding, Mat& sigma);

}}} // namespace cv::stereo::hdp

#endif
