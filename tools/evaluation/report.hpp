// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The parts of the report of hdp_evaluate: figures, charts and the page. All of it is in the page: pictures as data URIs,
// charts as inline SVG.

#ifndef OPENCV_HDPSTEREO_TOOLS_REPORT_HPP
#define OPENCV_HDPSTEREO_TOOLS_REPORT_HPP

#include <vector>

#include "opencv2/imgproc.hpp"

#include "layers.hpp"
#include "pair.hpp"

namespace hdp_tools {

using cv::stereo::HDPTreeMatcher;

String base64(const std::vector<uchar>& bytes);

//! A figure of the page, at most 360 pixels wide
String figure(const Mat& picture, const String& caption, const String& extension = ".jpg",
              int interpolation = cv::INTER_AREA);

//! The model's P(D_l | D_{l+1}) up to a factor for each row: rows D_{l+1}, columns D_l.
cv::Mat_<double> predictedMatrix(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior);

//! How often true D_l and estimated D_{l+1} come together; maps in pixels of their layers.
cv::Mat_<double> sampledMatrix(const Mat& truth, const Mat& upper, int numDisparities);

/** Figures of the forest, of the intervals, and of P(D_l | D_{l+1}) by the model and by the truth.
@param matcher One with predicted intervals that has just matched the pair.
*/
String predictionFigures(const String& name, const HDPTreeMatcher& matcher, const Pair& pair);

//! A bar of the paper's runtime figure
struct RuntimePair
{
    String scene;
    double other, method; // seconds: over the full range, and with prediction
};

//! The paper's runtime figure for one tree: two bars a scene, seconds on a logarithmic axis, and the speed-up as circles
//! on a linear one, whose top is the largest.
String runtimeChart(const String& title, const std::vector<RuntimePair>& pairs);

String htmlPage(const String& title, const String& body);

} // namespace hdp_tools

#endif
