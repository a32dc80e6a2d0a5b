// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_NONLOCAL_REFINEMENT_HPP
#define OPENCV_HDPSTEREO_NONLOCAL_REFINEMENT_HPP

#include "tree_sums.hpp"

namespace cv { namespace stereo { namespace hdp {

/** The tree-based refinement of MST and ST @cite Yang2012MST: each disparity is replaced by the weighted median of the
stable ones in its tree. A pixel whose own disparity is stable and, rounded, the winner keeps it.
@param disparity,stable A disparity map, CV_16UC1, and where it is stable, CV_8UC1, not 0.
@param gamma Of the similarity.
@param subpixel Whether other winners get a fraction: that of the tip of a V through the costs of the winner and of the
candidates beside it, which is exact where all stable disparities that matter are equal.
@param refined Receives CV_16UC1 of its size, a disparity map; another Mat than disparity. The pixels of a tree without
stable ones keep their disparity, as does a pixel to which none of them has a similarity > 0 in float. */
CV_EXPORTS void refineNonLocal(const DisparityForest& forest, const Mat& disparity, const Mat& stable, double gamma,
                               bool subpixel, SumBuffers& buffers, Mat& refined);

}}} // namespace cv::stereo::hdp

#endif
