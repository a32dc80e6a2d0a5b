// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Errors of a map by the measures of the datasets.

#ifndef OPENCV_HDPSTEREO_TOOLS_SCORES_HPP
#define OPENCV_HDPSTEREO_TOOLS_SCORES_HPP

#include <vector>

#include "pair.hpp"

namespace hdp_tools {

const double NO_SCORE = std::numeric_limits<double>::quiet_NaN();

//! In percent of the judged pixels, but for the average; pixels without a disparity are wrong. NO_SCORE without truth.
struct Score
{
    double error1, error2;            // err>=1 and err>=2, as in the paper
    double badHalf, bad1, bad2, bad4; // errors above 0.5, 1, 2 and 4 pixels
    double d1, d1NonOccluded;         // errors above 3 pixels and 5 %; the latter for KITTI only
    double invalid;                   // pixels without a disparity
    double average;                   // mean absolute error in pixels, of each pixel at most 64
    double occluded;                  // wrong occluded pixels, by the main score
    double sparsification;            // of the confidence, see findSparsification()
    double leastSparsification;       // of the best confidence that there could be

    Score();
};

Score scoreMap(const Mat& disparity, const Pair& pair);

//! The score that the pair's dataset is known for, in words, and its value: err>=2, D1, or bad 2
String mainScoreName(Pair::Protocol protocol);
double mainScore(const Score& score, Pair::Protocol protocol);

//! Pixels that are wrong by the pair's main score
Mat wrongPixels(const Mat& disparity, const Pair& pair);

/** The area under the sparsification curve: the error rate of the most confident pixels, in percent, mean over all shares
of them from none to all. Pixels of one confidence are in no order.
@param wrong Mask of the wrong pixels.
@param judged Mask of the pixels that count.
@param confidence CV_8UC1.
@param score Receives the area, and that of a confidence which has all wrong pixels last. */
void findSparsification(const Mat& wrong, const Mat& judged, const Mat& confidence, Score& score);

//! Mean of the numbers that there are; NO_SCORE if there are none.
double meanOf(const std::vector<double>& values);

//! Means of each figure
Score meanScore(const std::vector<Score>& scores);

} // namespace hdp_tools

#endif
