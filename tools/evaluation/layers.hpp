// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The layers of HDPTreeMatcher's pyramid one by one: what the matcher finds in layer l, and what is true there.

#ifndef OPENCV_HDPSTEREO_TOOLS_LAYERS_HPP
#define OPENCV_HDPSTEREO_TOOLS_LAYERS_HPP

#include <vector>

#include "opencv2/hdpstereo.hpp"

#include "disparity_maps.hpp"

namespace hdp_tools {

using cv::Ptr;
using cv::stereo::DisparityPredictionModel;
using cv::stereo::HDPTreeMatcher;

//! The image in layer + 1 of an image in layer: means of 2 x 2 pixels
Mat nextLayer(const Mat& image);

//! D_l of the true disparities: those of layer 0, in pixels of the layer, at one of the four pixels that become one
Mat truthOfLayer(const Mat& truth, int layer);

Ptr<DisparityPredictionModel> publishedModel(int width);

//! The layers first .. of a model, as a model of its own
Ptr<DisparityPredictionModel> upperPart(const DisparityPredictionModel& model, int first);

//! How many candidates a layer has
int disparitiesOfLayer(int numDisparities, int layer);

/** Makes a new matcher do for the images of a layer what one with its parameters and so many layers does in that layer
and those above, when it matches images of this width.
@param matcher Of disparitiesOfLayer() candidates.
@param above The model of this layer and those above; empty at the top layer. */
void adaptToLayer(HDPTreeMatcher& matcher, int layer, int layers, int width,
                  const Ptr<DisparityPredictionModel>& above);

//! A matcher (PRESET_PAPER) that has been adapted to a layer of a pair with so many candidates.
Ptr<HDPTreeMatcher> matcherOfLayer(int layer, int layers, int numDisparities, int width,
                                   const Ptr<DisparityPredictionModel>& above);

} // namespace hdp_tools

#endif
