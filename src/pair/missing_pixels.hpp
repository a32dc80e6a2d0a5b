// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MISSING_PIXELS_HPP
#define OPENCV_HDPSTEREO_MISSING_PIXELS_HPP

#include "opencv2/hdpstereo/pair_model.hpp"

#include "blank_borders.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What the levels of a pair of floats are matched as
struct FloatLevels
{
    double black, white; // become 0 and 65535; others are clamped
};

//! A pair of which each pixel has a level, and which of them are data
struct CompletePair
{
    Mat left, right;
    PairMasks masks;
    FloatLevels floats; // if it was of floats
    double borderLevel; // that ends black borders, which are no data; 0: there are none
    Mat filled[2];      // memory, kept from pair to pair
};

/** Gives the pixels without data levels that depend on the others alone, and images of type CV_32FC1 16 bits. A run of
pixels without data in a row gets the levels at its ends, each half of it the nearer one's. A row without any gets what
the nearest row has that has some, the upper one of two; black if there is none. Floats have one scale for both images:
the darkest pixel becomes black and the brightest white, but for one in 1024 at each end.
@param leftMask,rightMask CV_8UC1, 0 where there is no data; empty: there is everywhere. If both are empty, and levels
are whole numbers, black borders are no data, see maskBorders().
@param model What is known of the pixels; empty: it is found in this pair.
@param complete Receives the pair: the images themselves if nothing is to be done. */
CV_EXPORTS void completePair(const Mat& left, const Mat& right, const Mat& leftMask, const Mat& rightMask,
                             const PairModel& model, CompletePair& complete);

}}} // namespace cv::stereo::hdp

#endif
