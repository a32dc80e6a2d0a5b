// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_UNITS_HPP
#define OPENCV_HDPSTEREO_UNITS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// Candidates are whole disparities, in pixels of their layer, or in those of the layer below, where a layer of all
// candidates compares both. Disparity maps are CV_16UC1, in 1 / subpixelScale pixel of their layer. Both count from
// minDisparity.

const int subpixelScale = 16;

//! The unit of grey levels in CV_16UC1 images is 1 / greyScale of a level of 8 bits, and whiteLevel is the highest one.
const int greyScale = 4, whiteLevel = 256 * greyScale - 1;

//! Grey level 0.299 R + 0.587 G + 0.114 B of a pixel of 8 bits, in 1 / 65536
CV_ALWAYS_INLINE int greyOf(const uchar* bgr) { return 7471 * bgr[0] + 38470 * bgr[1] + 19595 * bgr[2]; }

//! The candidate next to a disparity of a map, the larger one of two
inline int wholeDisparity(int disparity) { return (int)((unsigned)(disparity + subpixelScale / 2) / subpixelScale); }

//! The largest disparity that a map of a layer may have
inline int largestDisparity(int numDisparities, int layer)
{
    return (int)((int64)(numDisparities - 1) * subpixelScale >> layer);
}

//! Candidates first .. last; empty if last < first. Stored in Mats as CV_16UC2.
struct DisparityInterval
{
    ushort first, last;

    bool empty() const { return last < first; }
    int size() const { return last - first + 1; }
};

}}} // namespace cv::stereo::hdp

#endif
