// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_STEREO_ADAPTERS_HPP
#define OPENCV_HDPSTEREO_STEREO_ADAPTERS_HPP

#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"

// HDPTreeMatcher behind the interfaces of cv::StereoSGBM and cv::StereoBM. The preloaded library finds these functions
// by name.
//
// The adapter keeps the matcher that it gets, and leaves all setters, getters, read() and write() to it: a program
// finds what it has set. compute() is by HDPTreeMatcher, with
// - minDisparity, numDisparities, disp12MaxDiff, speckleWindowSize and speckleRange of that matcher;
// - of StereoBM also ROI1 and ROI2: if one is set, pixels outside getValidDisparityROI() are rejected.
// The others have no counterpart, and no effect: a block of StereoSGBM is no window of a census, P1 and P2 are in units
// of another matching cost, mode and the prefilter are details of OpenCV's algorithms, and nothing here compares the
// best cost of a pixel with its second best, as uniquenessRatio does, or measures texture.

//! Replaces the matcher by its adapter. preset: of HDPTreeMatcher.
extern "C" CV_EXPORTS void hdpstereoAdaptSGBM(cv::Ptr<cv::StereoSGBM>& matcher, int preset);
extern "C" CV_EXPORTS void hdpstereoAdaptBM(cv::Ptr<cv::StereoBM>& matcher, int preset);

#endif
