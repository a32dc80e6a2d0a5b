// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Disparity maps: their files, their masks, and their errors.
//
// A map is CV_32FC1, in pixels; NO_DISPARITY marks pixels that have none.

#ifndef OPENCV_HDPSTEREO_TOOLS_DISPARITY_MAPS_HPP
#define OPENCV_HDPSTEREO_TOOLS_DISPARITY_MAPS_HPP

#include <limits>

#include "opencv2/core.hpp"

namespace hdp_tools {

using cv::Mat;
using cv::String;

const float NO_DISPARITY = std::numeric_limits<float>::infinity();

inline Mat knownPixels(const Mat& disparity) { return disparity < NO_DISPARITY; }

//! The map that a cv::StereoMatcher computed (CV_16SC1, 1/16 pixel), in pixels
Mat toPixels(const Mat& disparity16, int minDisparity);

// ---- Files

//! The extension is in lower case, with its dot.
bool hasExtension(const String& path, const String& extension);

//! Reads an image; throws an exception that names the file.
Mat readImage(const String& path, int flags);

//! Reads a picture of a camera as HDPTreeMatcher takes it: BGR in 8 bit, or grey levels in 16 bit if the file has 16.
Mat readPicture(const String& path);

//! Writes an image in the format of the path's extension; fails on a full disk, too.
void writeImage(const String& path, const Mat& image);

/** Converts an image that was read from the path to a map.

8 bit: disparity * 1; 16 bit: disparity * 256; both with 0 for unknown. PFM: not finite for unknown.
@param scale If not 0, the factor instead of 1 or 256.
*/
Mat toDisparity(const Mat& image, const String& path, double scale = 0);

Mat readDisparity(const String& path, double scale = 0);

//! Writes a 16-bit PNG: disparity * 256, 0 for none (a disparity of 0 is written as 1). What it cannot hold, below 0 or
//! from 256 on, is written as none.
void writeDisparity(const String& path, const Mat& disparity);

// ---- Errors

//! Pixels of known truth that the right image shows, too: the right truth at x - floor(d) differs by at most the tolerance.
Mat nonOccludedPixels(const Mat& truth, const Mat& rightTruth, double tolerance = 0);

//! Pixels of the mask with an error of at least the threshold, or without a disparity
Mat wrongPixels(const Mat& disparity, const Mat& truth, const Mat& mask, double threshold);

//! As wrongPixels(), by the measure of KITTI: an error above 3 pixels and above 5 % of the truth
Mat wrongPixelsD1(const Mat& disparity, const Mat& truth, const Mat& mask);

//! Share of the mask, in percent; not a number if the mask is empty
double percent(const Mat& pixels, const Mat& mask);

} // namespace hdp_tools

#endif
