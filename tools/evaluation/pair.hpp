// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A rectified stereo pair and what is known of it.

#ifndef OPENCV_HDPSTEREO_TOOLS_PAIR_HPP
#define OPENCV_HDPSTEREO_TOOLS_PAIR_HPP

#include "disparity_maps.hpp"

#include "opencv2/core/utility.hpp"

namespace hdp_tools {

struct Pair
{
    //! The measure that the tables of its dataset have
    enum Protocol
    {
        NO_TRUTH,
        MIDDLEBURY, //!< err>=1 and err>=2 of the non-occluded pixels
        KITTI,      //!< D1: errors above 3 pixels and 5 %, of all known pixels and of the non-occluded ones
        BAD         //!< Middlebury 2014, MiddEval3, ETH3D: errors above 0.5, 1, 2 and 4 of the non-occluded pixels
    };
    Protocol protocol;
    Mat left, right;           // CV_8UC3 or CV_16UC1, see readPicture()
    cv::Range disparities;     // to be searched
    Mat truth;                 // NO_DISPARITY where unknown; empty without truth
    double truthDeviation = 0; // of its errors by rounding, in pixels, where it is in large steps
    Mat rightTruth;            // of the right image; may be empty
    Mat judged;                // mask of the pixels that count
    Mat judgedNonOccluded;     // those of KITTI that are not occluded; may be empty
};

//! The options that readPair() knows: @left, @right, the disparities, and the truth
extern const char* const PAIR_KEYS;

//! The pair of a command line; of the protocol MIDDLEBURY if there is a truth.
Pair readPair(const cv::CommandLineParser& parser);

//! Images in CV_8UC3, for cv::StereoSGBM and to be shown: of 16 bit, the largest value of both images becomes white.
void toColors(Mat& left, Mat& right);

//! A number of disparities for a pair that nothing is known of: a fifth of the width, a multiple of 16
int defaultNumDisparities(int width);

} // namespace hdp_tools

#endif
