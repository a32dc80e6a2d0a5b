// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_REASONS_HPP
#define OPENCV_HDPSTEREO_DISPARITY_REASONS_HPP

#include "disparity_output.hpp"
#include "../cost/matching_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Why the pixels of a layer have their disparities, see HDPTreeMatcher::Reason: MATCHED, OCCLUDED or OUTSIDE.
@param disparity Of the layer, CV_16UC1, a disparity map.
@param plan Of the output: where the layer lies in the image.
@param width Of the image.
@param limits Of the layer: pixels without data hide none.
@param reasons Receives CV_8UC1. */
CV_EXPORTS void findReasons(const Mat& disparity, const OutputPlan& plan, int width, const CostLimits& limits,
                            Mat& reasons);

}}} // namespace cv::stereo::hdp

#endif
