// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MISSING_PIXELS_HPP
#define OPENCV_HDPSTEREO_MISSING_PIXELS_HPP

#include "../base/mask.hpp"

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
    Mat filled[2];      // memory, kept from pair to pair
};

/** Gives the pixels without data levels that depend on the others alone, and images of type CV_32FC1 16 bits.
@param leftMask,rightMask CV_8UC1, 0 where there is no data; empty: there is everywhere.
@param given What floats are matched as; none: that of this pair.
@param complete Receives the pair: the images themselves if nothing is to be done. */
CV_EXPORTS void completePair(const Mat& left, const Mat& right, const Mat& leftMask, const Mat& rightMask,
                             const FloatLevels* given, CompletePair& complete);

//! One scale for both images of a pair of CV_32FC1: the darkest pixel becomes black and the brightest white, but for
//! one in 1024 at each end. masks: which pixels count, all of them finite
CV_EXPORTS FloatLevels findLevels(const Mat& left, const Mat& right, const PairMasks& masks);

//! Levels of CV_32FC1 in CV_16UC1, 0 where there is no data; all are black if floats' black and white are the same.
CV_EXPORTS void wholeLevels(const Mat& image, const Mat& mask, const FloatLevels& floats, Mat& levels);

/** Fills the pixels without data. A run of them in a row gets the levels at its ends, each half of it the nearer one's.
A row without any gets what the nearest row has that has some, the upper one of two; black if there is none.
@param image Of 8 or 16 bits, any number of channels.
@param mask CV_8UC1, 255 where there is data, else 0. */
CV_EXPORTS void fillMissing(const Mat& image, const Mat& mask, Mat& filled);

}}} // namespace cv::stereo::hdp

#endif
