// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP
#define OPENCV_HDPSTEREO_DISPARITY_CONFIDENCE_HPP

#include "../cost/census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of disparityConfidence() that the compiler needs. None of them is critical.
struct DisparityConfidence
{
    enum
    {
        stepHalves = 3,    // half pixels; disparities at a step differ by more: 2 are slopes, 4 leaves steps out
        farFromSteps = 64, // pixels from the nearest step: wrong patches are smaller, and more cost time
        window = 21,       // pixels; side of the square that costs are averaged over: a smaller one has noise, a larger
                           // one sees beyond wrong patches
        alternative = 2,   // pixels from the winner to the candidates it is compared with: nearer ones cost the same by
                           // slopes, farther ones may be other matches
        hiddenDivisor = 2, // of the confidence of a pixel that fails the left-right check: some of them are right
        upperWindow = 31,  // cells of 2 x 2 pixels; side of the square that P is averaged over: a smaller one
                           // misses the middle of wrong patches
        medianWindow = 7,  // the same of M; smaller, as the median changes single pixels
        halved = 4         // 1 / pixel: a mean difference of 1 / halved pixels halves the confidence
    };
};

//! The maps that disparityConfidence() looks at
struct ConfidenceMaps
{
    Mat disparity;  // of the layer, CV_16UC1
    Mat unfiltered; // the same before the median
    Mat upper;      // of the layer above; empty if there is none
};

// Elements behind a row that its vectors may reach
const int vectorMargin = 32;

//! Memory for a row of census costs
struct CensusScratch
{
    explicit CensusScratch(int width)
        : words(width), winner(width), before(width), after(width), ofWinner(width), ofBefore(width), ofAfter(width)
    {
    }

    std::vector<unsigned> words;                    // the census of the right image
    std::vector<unsigned> winner, before, after;    // where each pixel's differs from its candidates'
    std::vector<short> ofWinner, ofBefore, ofAfter; // where these are in words
};

//! The two candidates that a winner is compared with: the only one that exists twice, or the winner if none does.
template <typename T> struct Alternatives
{
    T before, after;

    CV_ALWAYS_INLINE Alternatives(T winner, T last)
    {
        const T distance = DisparityConfidence::alternative;
        const T below = (T)(winner - distance), above = (T)(winner + distance);
        const T only = above <= last ? above : winner;
        before = below >= 0 ? below : only;
        after = above <= last ? above : before;
    }
};

/** How far the disparities of a layer are to be trusted: 255 v sqrt(sqrt(S U) P M), rounded. Wrong disparities come in
patches with a step at their border, where other disparities fit as well, where the layer above had others, and where
the median had to change many.

S is the distance to the nearest pixel at a step, with a limit: min(distance, 64) / 64. The two pixels at a step are
neighbours in a row or column whose disparities differ by more than 1.5 pixels.

U is how much the cost of the disparity, as the nearest candidate has it, stands out from those of the candidates 2
pixels before and after it (or of the only one of them that there is): max(0, A - C) / (A + C), where C and A are the
means of both over a window of 21 x 21 pixels, borders replicated; 0 without alternatives or if A + C = 0. Sums are
of whole numbers: other costs than that of the census are rounded to 1/512.

P is 1 / (1 + 4 p), where p is the mean difference, in pixels, from twice the disparity that the layer above has there,
no more than 8 per pixel; M is 1 / (1 + 4 m), where m is the mean change by the median, no more than 4 per pixel. Means
are those over 31 x 31 and 7 x 7 cells of 2 x 2 pixels, the pixel's own in the middle. Borders are replicated. P is 1
without a layer above.

v is 1 for a pixel that passes the left-right check, see findStable(), or else 1/2.
@param maps The maps.
@param numDisparities Of the layer.
@param cost Of the layer.
@param confidence Receives CV_8UC1. */
CV_EXPORTS void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const CensusCost& cost,
                                    Mat& confidence);

//! For any cost
CV_EXPORTS void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const MatchingCost& cost,
                                    Mat& confidence);

}}} // namespace cv::stereo::hdp

#endif
