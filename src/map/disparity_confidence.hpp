// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP
#define OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP

#include "../cost/matching_cost.hpp"

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

}}} // namespace cv::stereo::hdp

#endif
