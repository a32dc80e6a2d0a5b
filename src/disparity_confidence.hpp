// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP
#define OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP

#include "matching_cost.hpp"

namespace cv {
namespace stereo {
namespace hdp {

//! The constants of disparityConfidence(). None of them is critical.
struct DisparityConfidence
{
    enum
    {
        farFromSteps = 64,  // pixels from the nearest step of the disparities; more do not count
        window = 21,        // side of the square that costs are averaged over, in pixels
        alternative = 2,    // distance, in pixels, of the candidates that the winner is compared with
        visibleMaxDiff = 1, // of the left-right check, in pixels
        hiddenDivisor = 2   // what the confidence of a pixel that fails it is divided by
    };
};

/** How far the disparities of a layer are to be trusted: 255 v sqrt(S U), rounded. Wrong disparities come in patches
with a step at their border, and where other disparities fit as well.

S is the distance to the nearest pixel at a step, with a limit: min(distance, 64) / 64. The two pixels at a step are
neighbours in a row or column whose disparities differ by more than 1.5 pixels.

U is how much the cost of the disparity, as the nearest candidate has it, stands out from those of the candidates 2
pixels before and after it (or of the only one of them that there is): max(0, A - C) / (A + C), where C and A are the
means of both over a window of 21 x 21 pixels, borders replicated; 0 without alternatives or if A + C = 0.

v is 1 for a pixel that passes the left-right check, see findStable(), or else 1/2.
@param disparity CV_16UC1, a disparity map.
@param numDisparities Of the layer.
@param cost Of the layer.
@param confidence Receives CV_8UC1. */
CV_EXPORTS void disparityConfidence(const Mat& disparity, int numDisparities, const MatchingCost& cost,
                                    Mat& confidence);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
