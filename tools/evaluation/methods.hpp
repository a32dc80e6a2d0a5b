// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What can be compared: the presets of HDPTreeMatcher, the systems of the paper, and OpenCV's own matchers.

#ifndef OPENCV_HDPSTEREO_TOOLS_METHODS_HPP
#define OPENCV_HDPSTEREO_TOOLS_METHODS_HPP

#include <array>
#include <functional>
#include <vector>

#include "opencv2/hdpstereo.hpp"

#include "disparity_maps.hpp"

namespace hdp_tools {

using cv::Ptr;
using cv::stereo::DisparityPredictionModel;
using cv::stereo::HDPTreeMatcher;

struct Method
{
    String name;      // in the tables, and for --methods
    String fullRange; // of a method with prediction: the name of the same one without
    bool isHdp;       // an HDPTreeMatcher
    bool isGray;      // matches grey images only
    std::function<Ptr<cv::StereoMatcher>(cv::Range disparities)> create;

    bool isPreset() const;
};

//! What the times are compared with
extern const char* const REFERENCE_METHOD;

//! The value of a preset, by its name in lower case; fails if there is none.
int presetOf(const String& name);

/** The methods of a list of names and groups that is separated by commas, in this order; each once.

- the group presets: ultrafast, fast, quality, tree, paper
- the group systems, the rows of the paper's tables: paper (HDP+MST), mst, m+mst, hdp+st, st, m+st, hdp+rt, rt, m+rt
- the group opencv: bm, sgbm, sgbm-3way, sgbm-hh4
- the group custom, the preset tree with a custom strategy that gives the same map: tree-by-weight, which says so, see
  cv::stereo::TreeStrategy::ordersByWeight(), and tree-in-order, which does not and is slower

@param option The name of the option, for messages.
@param model Of the paper's systems; empty for the published ones.
*/
std::vector<Method> selectMethods(const String& option, const String& list,
                                  const Ptr<DisparityPredictionModel>& model = Ptr<DisparityPredictionModel>());

//! The images as the method takes them; those of OpenCV in 8 bit
std::array<Mat, 2> imagesFor(const Method& method, const Mat& left, const Mat& right);

/** Matches a pair; disparities in pixels.

OpenCV's matchers leave out columns that the other image may not show, which would count as wrong. They get images that
go on beside it by the disparities that are searched, and so do the same work as a matcher that leaves out nothing.
@param seconds If not null, the time of compute() alone, the shortest of several runs.
*/
Mat matchDensely(const Method& method, cv::StereoMatcher& matcher, const Mat& left, const Mat& right,
                 double* seconds = nullptr, int runs = 1);

} // namespace hdp_tools

#endif
