// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What is true in the layers of HDPTreeMatcher's pyramid, and what it predicts them with

#ifndef OPENCV_HDPSTEREO_TOOLS_LAYERS_HPP
#define OPENCV_HDPSTEREO_TOOLS_LAYERS_HPP

#include <vector>

#include "opencv2/hdpstereo.hpp"

#include "disparity_maps.hpp"

namespace hdp_tools {

using cv::Ptr;
using cv::stereo::DisparityPredictionModel;

//! D_l of the true disparities: those of layer 0, in pixels of the layer, at one of the four pixels that become one
Mat truthOfLayer(const Mat& truth, int layer);

//! The model that HDPTreeMatcher takes by default for images of this width
Ptr<DisparityPredictionModel> publishedModel(int width);

} // namespace hdp_tools

#endif
