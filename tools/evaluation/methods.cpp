// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "methods.hpp"

#include <algorithm>

#include "opencv2/imgproc.hpp"

#include "command_line.hpp"
#include "pair.hpp"

namespace hdp_tools {

const char* const REFERENCE_METHOD = "sgbm-3way";

static const struct
{
    const char* name;
    int value;
} presets[] = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                { "fast", HDPTreeMatcher::PRESET_FAST },
                { "quality", HDPTreeMatcher::PRESET_QUALITY },
                { "tree", HDPTreeMatcher::PRESET_TREE },
                { "paper", HDPTreeMatcher::PRESET_PAPER } };

bool Method::isPreset() const
{
    return std::any_of(std::begin(presets), std::end(presets),
                       [this](decltype(presets[0])& p) { return name == p.name; });
}

int presetOf(const String& name)
{
    String names;
    for (const auto& preset : presets)
    {
        if (name == preset.name)
            return preset.value;
        names += (names.empty() ? "" : ", ") + String(preset.name);
    }
    fail("'" + name + "' is not a preset, there are: " + names);
}

static Method presetMethod(const String& name)
{
    const int preset = presetOf(name);
    return { name, String(), true, false, [preset](cv::Range disparities) -> Ptr<cv::StereoMatcher> {
                return HDPTreeMatcher::create(disparities.start, disparities.size(), preset);
            } };
}

//! A row of the paper's tables; the prefix is "hdp+", "m+" or empty, the tree "mst", "st" or "rt".
static Method systemMethod(const String& prefix, const String& tree, const Ptr<DisparityPredictionModel>& model)
{
    Method method;
    method.name = prefix == "hdp+" && tree == "mst" ? String("paper") : prefix + tree;
    method.fullRange = prefix == "hdp+" ? tree : String();
    method.isHdp = true;
    method.isGray = false;
    method.create = [=](cv::Range disparities) -> Ptr<cv::StereoMatcher> {
        const Ptr<HDPTreeMatcher> matcher =
            HDPTreeMatcher::create(disparities.start, disparities.size(), HDPTreeMatcher::PRESET_PAPER);
        HDPTreeMatcher::Params params(HDPTreeMatcher::PRESET_PAPER);
        params.treeStrategy = tree == "mst"  ? cv::stereo::createMinimumSpanningTree()
                              : tree == "st" ? cv::stereo::createSegmentTree()
                                             : cv::stereo::createRandomTree();
        params.usePrediction = prefix == "hdp+";
        params.useMedianPrefilter = prefix == "m+";
        params.predictionModel = model;
        matcher->setParams(params);
        return matcher;
    };
    return method;
}

//! The minimum spanning tree a second time, outside of the library
class CustomTree : public cv::stereo::TreeStrategy
{
public:
    explicit CustomTree(bool byWeight) : byWeight_(byWeight) {}
    bool ordersByWeight() const override { return byWeight_; }
    bool mayJoin(int, const cv::stereo::TreeState&, const cv::stereo::TreeState&) const override { return true; }

private:
    const bool byWeight_;
};

//! PRESET_TREE with a custom strategy, which gives the same map
static Method customMethod(const String& name, bool byWeight)
{
    Method method = presetMethod("tree");
    const std::function<Ptr<cv::StereoMatcher>(cv::Range)> create = method.create;
    method.name = name;
    method.create = [=](cv::Range disparities) {
        const Ptr<cv::StereoMatcher> matcher = create(disparities);
        matcher.dynamicCast<HDPTreeMatcher>()->setTreeStrategy(cv::makePtr<CustomTree>(byWeight));
        return matcher;
    };
    return method;
}

//! 15 x 15 pixels; checks texture and uniqueness, as it does by default.
static Method blockMatchingMethod()
{
    return { "bm", String(), false, true, [](cv::Range disparities) -> Ptr<cv::StereoMatcher> {
                const Ptr<cv::StereoBM> matcher =
                    cv::StereoBM::create(int(cv::alignSize(size_t(disparities.size()), 16)), 15);
                matcher->setMinDisparity(disparities.start);
                return matcher;
            } };
}

//! 3 x 3 pixels, the penalties that the documentation advises; checks left against right (disp12MaxDiff = 0 means 1).
static Method sgbmMethod(const String& name, int mode)
{
    return { name, String(), false, false, [mode](cv::Range disparities) -> Ptr<cv::StereoMatcher> {
                const int blockSize = 3, channels = 3, P1 = 8 * channels * blockSize * blockSize, P2 = 4 * P1;
                return cv::StereoSGBM::create(disparities.start, int(cv::alignSize(size_t(disparities.size()), 16)),
                                              blockSize, P1, P2, 0, 0, 0, 0, 0, mode);
            } };
}

struct Group
{
    const char* name;
    std::vector<Method> methods;
};

static std::vector<Group> allMethods(const Ptr<DisparityPredictionModel>& model)
{
    std::vector<Group> groups = { { "systems", {} }, { "presets", {} }, { "opencv", {} }, { "custom", {} } };
    for (const char* tree : { "mst", "st", "rt" })
        for (const char* prefix : { "hdp+", "", "m+" })
            groups[0].methods.push_back(systemMethod(prefix, tree, model));
    for (const auto& preset : presets)
        groups[1].methods.push_back(presetMethod(preset.name));
    groups[1].methods.back() = groups[0].methods.front(); // paper is in both, with the model
    groups[2].methods = { blockMatchingMethod(), sgbmMethod("sgbm", cv::StereoSGBM::MODE_SGBM),
                          sgbmMethod(REFERENCE_METHOD, cv::StereoSGBM::MODE_SGBM_3WAY),
                          sgbmMethod("sgbm-hh4", cv::StereoSGBM::MODE_HH4) };
    groups[3].methods = { customMethod("tree-by-weight", true), customMethod("tree-in-order", false) };
    return groups;
}

std::vector<Method> selectMethods(const String& option, const String& list, const Ptr<DisparityPredictionModel>& model)
{
    const std::vector<Group> groups = allMethods(model);
    std::vector<Method> selected;
    for (const String& item : splitList(option, list))
    {
        bool isKnown = false;
        for (const Group& group : groups)
            for (const Method& method : group.methods)
            {
                if (item != method.name && item != group.name)
                    continue;
                isKnown = true;
                if (std::none_of(selected.begin(), selected.end(),
                                 [&](const Method& other) { return other.name == method.name; }))
                    selected.push_back(method);
            }
        if (isKnown)
            continue;
        String names;
        for (const Group& group : groups)
        {
            names += String(names.empty() ? "" : "; ") + group.name + " (";
            for (const Method& method : group.methods)
                names += (&method == &group.methods[0] ? "" : ", ") + method.name;
            names += ")";
        }
        fail("--" + option + "=" + list + ": '" + item + "' is unknown, there are: " + names);
    }
    return selected;
}

std::array<Mat, 2> imagesFor(const Method& method, const Mat& left, const Mat& right)
{
    std::array<Mat, 2> images = { { left, right } };
    if (!method.isHdp)
        toColors(images[0], images[1]);
    for (Mat& image : images)
        if (method.isGray && image.channels() == 3)
            cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    return images;
}

Mat matchDensely(const Method& method, cv::StereoMatcher& matcher, const Mat& left, const Mat& right, double* seconds,
                 int runs)
{
    const int minDisparity = matcher.getMinDisparity();
    const int before = method.isHdp ? 0 : std::max(minDisparity + matcher.getNumDisparities(), 0),
              behind = method.isHdp ? 0 : std::max(-minDisparity, 0);
    std::array<Mat, 2> images = imagesFor(method, left, right);
    if (!method.isHdp)
        for (Mat& image : images)
            cv::copyMakeBorder(image, image, 0, 0, before, behind, cv::BORDER_CONSTANT);
    Mat disparity16;
    double shortest = DBL_MAX;
    for (int run = 0; run < runs; run++)
    {
        cv::TickMeter timer;
        timer.start();
        matcher.compute(images[0], images[1], disparity16);
        timer.stop();
        shortest = std::min(shortest, timer.getTimeSec());
    }
    if (seconds)
        *seconds = shortest;
    const HDPTreeMatcher* const hdp = dynamic_cast<const HDPTreeMatcher*>(&matcher); // may find its range
    return toPixels(disparity16.colRange(before, before + left.cols),
                    hdp ? hdp->getFindings().minDisparity : minDisparity);
}

} // namespace hdp_tools
