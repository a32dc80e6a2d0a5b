// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_HPP
#define OPENCV_HDPSTEREO_HPP

#include "opencv2/hdpstereo/tree_strategy.hpp"
#include "opencv2/hdpstereo/disparity_prediction.hpp"
#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"
#include "opencv2/hdpstereo/pair_model.hpp"
#include "opencv2/hdpstereo/stereo_rig.hpp"

/** @defgroup hdpstereo Non-local stereo matching with hierarchical disparity prediction

Dense stereo matching of rectified pairs after "Fast Non-local Stereo Matching based on Hierarchical
Disparity Prediction" @cite Luo2015HDP .

Tree-based (non-local) matching @cite Yang2012MST aggregates the matching cost over a spanning tree of
the image instead of over a window. It is slow because it searches the whole disparity range, and greedy
over large areas of one colour. The paper matches a pyramid of the pair instead: the coarsest layer over
the full range, and every finer one only within the small disparity interval that Bayes' theorem predicts
for each pixel from the layer above. Pixels with similar intervals are joined into a forest of disparity
trees, and costs are aggregated inside each tree, over its few candidates only. This is PRESET_PAPER. The
other presets have trees on the coarsest layer, and semi-global matching below it, over the candidates
that the layer above predicts.

cv::stereo::HDPTreeMatcher is a cv::StereoMatcher, so a program that uses cv::StereoSGBM changes one line:

@code{.cpp}
    Ptr<cv::StereoMatcher> matcher = cv::stereo::HDPTreeMatcher::create(0, 128);
    Mat disparity; // CV_16SC1, disparity * 16
    matcher->compute(left, right, disparity);
@endcode

The spanning tree is pluggable, see cv::stereo::TreeStrategy; the distribution that drives the prediction
is a cv::stereo::DisparityPredictionModel.

cv::stereo::StereoRig leads from raw images of two cameras, and calibrations of several programs, to depth.

Tutorials: @ref tutorial_hdpstereo_matching, @ref tutorial_hdpstereo_own_tree, @ref tutorial_hdpstereo_cameras,
@ref tutorial_hdpstereo_beforehand, @ref tutorial_hdpstereo_photogrammetry
*/

#endif
