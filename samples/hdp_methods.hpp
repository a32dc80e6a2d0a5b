// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The systems that hdp_evaluate compares: the rows of the paper's tables, the presets of HDPTreeMatcher, and OpenCV's
// own matchers.

#ifndef OPENCV_HDPSTEREO_SAMPLES_METHODS_HPP
#define OPENCV_HDPSTEREO_SAMPLES_METHODS_HPP

#include <functional>

#include "hdp_samples_common.hpp"

namespace hdp_samples {

using cv::Ptr;
using cv::stereo::DisparityPredictionModel;
using cv::stereo::HDPTreeMatcher;

struct Method
{
    String name;
    String group;     // "paper", "presets" or "opencv"
    String fullRange; // of a method with prediction: the same one without
    bool isBlind;     // leaves out the columns that the right image may not show
    bool isGray;
    std::function<Ptr<cv::StereoMatcher>(int numDisparities)> create; // for disparities from 0
};

//! A map and what it took
struct Match
{
    Mat disparity; // in pixels; NO_DISPARITY
    double seconds;
};

//! A row of the paper's tables, such as HDP+MST, MST and M+MST.
inline Method paperMethod(const String& prefix, const String& tree, const Ptr<DisparityPredictionModel>& model)
{
    Method method;
    method.name = prefix + tree;
    method.group = "paper";
    method.fullRange = prefix == "HDP+" ? tree : String();
    method.isBlind = method.isGray = false;
    method.create = [=](int numDisparities) -> Ptr<cv::StereoMatcher> {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, HDPTreeMatcher::PRESET_PAPER);
        matcher->setTreeStrategy(createTree(lowerCase(tree)));
        matcher->setUsePrediction(prefix == "HDP+");
        matcher->setUseMedianPrefilter(prefix == "M+");
        matcher->setPredictionModel(model);
        return matcher;
    };
    return method;
}

//! OpenCV's matchers leave out what fails their checks, which counts as wrong. StereoSGBM checks left against right
//! (it takes disp12MaxDiff = 0 for 1); StereoBM texture and uniqueness, as it does by default.
inline Method sgbmMethod(const String& name, int mode)
{
    Method method;
    method.name = name;
    method.group = "opencv";
    method.isBlind = true;
    method.isGray = false;
    method.create = [=](int numDisparities) -> Ptr<cv::StereoMatcher> {
        return cv::StereoSGBM::create(0, int(cv::alignSize(numDisparities, 16)), 3, 8 * 27, 32 * 27, 0, 0, 0, 0, 0,
                                      mode);
    };
    return method;
}

inline Method blockMatchingMethod()
{
    Method method;
    method.name = "StereoBM";
    method.group = "opencv";
    method.isBlind = method.isGray = true;
    method.create = [](int numDisparities) -> Ptr<cv::StereoMatcher> {
        return cv::StereoBM::create(int(cv::alignSize(numDisparities, 16)), 15);
    };
    return method;
}

//! All methods. The model is that of the paper's HDP rows; empty for the published ones.
inline std::vector<Method> allMethods(const Ptr<DisparityPredictionModel>& model)
{
    std::vector<Method> methods;
    for (const char* tree : { "MST", "ST", "RT" })
        for (const char* prefix : { "HDP+", "", "M+" })
            methods.push_back(paperMethod(prefix, tree, model));
    for (const Preset& preset : PRESETS)
    {
        if (preset.value == HDPTreeMatcher::PRESET_PAPER) // the paper's HDP+MST
            continue;
        Method method;
        method.name = "PRESET_" + upperCase(preset.name);
        method.group = "presets";
        method.isBlind = method.isGray = false;
        const int number = preset.value;
        method.create = [number](int numDisparities) -> Ptr<cv::StereoMatcher> {
            return HDPTreeMatcher::create(0, numDisparities, number);
        };
        methods.push_back(method);
    }
    methods.push_back(blockMatchingMethod());
    methods.push_back(sgbmMethod("SGBM", cv::StereoSGBM::MODE_SGBM));
    methods.push_back(sgbmMethod("SGBM_3WAY", cv::StereoSGBM::MODE_SGBM_3WAY));
    methods.push_back(sgbmMethod("SGBM_HH4", cv::StereoSGBM::MODE_HH4));
    return methods;
}

/** Matches a pair; the time is that of compute() alone, the shortest of several runs.

What OpenCV's matchers leave out at the left border would count as wrong. They get images that go on to the left of it
by the disparities that are searched, and so do the same work as a matcher that leaves out nothing. */
inline Match runMethod(const Method& method, cv::StereoMatcher& matcher, const Mat& left, const Mat& right, int runs)
{
    const int border = method.isBlind ? matcher.getNumDisparities() : 0;
    Mat pair[2];
    for (int i = 0; i < 2; i++)
    {
        const Mat& image = i == 0 ? left : right;
        if (method.isGray)
            cv::cvtColor(image, pair[i], cv::COLOR_BGR2GRAY);
        else
            pair[i] = image;
        if (border > 0)
            cv::copyMakeBorder(pair[i], pair[i], 0, 0, border, 0, cv::BORDER_CONSTANT);
    }
    Match match;
    match.seconds = std::numeric_limits<double>::max();
    Mat disparity16;
    for (int run = 0; run < runs; run++)
    {
        cv::TickMeter timer;
        timer.start();
        matcher.compute(pair[0], pair[1], disparity16);
        timer.stop();
        match.seconds = std::min(match.seconds, timer.getTimeSec());
    }
    match.disparity = toPixels(disparity16.colRange(border, disparity16.cols), matcher.getMinDisparity());
    return match;
}

} // namespace hdp_samples

#endif
