// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "found_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "opencv2/hdpstereo.hpp"

#include "command_line.hpp"
#include "evaluation.hpp"
#include "scores.hpp"

namespace hdp_tools {

using cv::stereo::HDPTreeMatcher;

static const double TOLERANCE = 0.05; // share of the true range

RangeError rangeError(const cv::Range& found, const Mat& truth, const Mat& judged, double leftOut)
{
    std::vector<float> disparities;
    for (int y = 0; y < truth.rows; y++)
        for (int x = 0; x < truth.cols; x++)
            if (judged.at<uchar>(y, x) != 0 && std::isfinite(truth.at<float>(y, x)))
                disparities.push_back(truth.at<float>(y, x));
    if (disparities.empty())
        fail("there is no true disparity");
    std::sort(disparities.begin(), disparities.end());
    const size_t end = disparities.size() - 1, skipped = size_t(leftOut * end);
    const double first = disparities[skipped], last = disparities[end - skipped], size = std::max(last - first, 1.);
    return { (found.start - first) / size, (last - (found.end - 1)) / size, (found.size() - 1) / size };
}

namespace {

struct SetErrors
{
    int pairs = 0, notFound = 0, covered = 0;
    double before = 0, behind = 0, size = 0, seconds = 0; // the worst two, and sums
    std::vector<String> bad;
};

//! With which the range was found, in seconds
double secondsOf(const HDPTreeMatcher::Findings& findings)
{
    const auto stage = std::find(findings.stages.begin(), findings.stages.end(), "disparity range");
    return stage == findings.stages.end() ? 0 : 1e-3 * findings.stageTimes[stage - findings.stages.begin()];
}

void addPair(const Method& method, const Scene& scene, const Pair& pair, SetErrors& set)
{
    const Ptr<cv::StereoMatcher> matcher = method.create(cv::Range(0, 0));
    const std::array<Mat, 2> images = imagesFor(method, pair.left, pair.right);
    set.pairs++;
    Mat disparity;
    try
    {
        matcher->compute(images[0], images[1], disparity);
    }
    catch (const cv::Exception&)
    {
        set.notFound++;
        set.bad.push_back(scene.name);
        return;
    }
    const HDPTreeMatcher::Findings findings = dynamic_cast<const HDPTreeMatcher&>(*matcher).getFindings();
    const cv::Range found(findings.minDisparity, findings.minDisparity + findings.numDisparities);
    const RangeError error = rangeError(found, pair.truth, pair.judged);
    const bool isCovered = std::max(error.before, error.behind) < TOLERANCE;
    set.covered += isCovered;
    set.before = std::max(set.before, error.before);
    set.behind = std::max(set.behind, error.behind);
    set.size += error.size;
    set.seconds += secondsOf(findings);
    if (!isCovered)
        set.bad.push_back(scene.name);
}

} // namespace

Table foundRangesTable(const Method& method, const std::vector<Scene>& scenes, std::set<String>& bad)
{
    std::map<String, SetErrors> sets;
    forEachPair(method, scenes, bad,
                [&](const Scene& scene, const Pair& pair) { addPair(method, scene, pair, sets[scene.set]); });
    Table table;
    table.title = "Ranges found, " + method.name;
    table.note =
        cv::format("Beside the true disparities without 0.1 %% at each end. Covered: pairs whose range leaves out "
                   "less than %.0f %% of the true one at either end. The most left out, in %% of the true range. "
                   "Mean size in true ranges, and time.",
                   100 * TOLERANCE);
    table.header = { "set", "pairs", "not found", "covered", "before", "behind", "size", "ms", "not covered" };
    for (const auto& item : sets)
    {
        const SetErrors& set = item.second;
        const int found = set.pairs - set.notFound;
        table.addRow(item.first);
        table.addNumber(set.pairs, "%.0f");
        table.addNumber(set.notFound, "%.0f");
        table.addNumber(set.covered, "%.0f");
        table.addNumber(100 * set.before, "%.1f");
        table.addNumber(100 * set.behind, "%.1f");
        table.addNumber(found == 0 ? NO_SCORE : set.size / found, "%.2f");
        table.addNumber(found == 0 ? NO_SCORE : 1000 * set.seconds / found, "%.0f");
        String names;
        for (const String& name : set.bad)
            names += (names.empty() ? "" : " ") + name;
        table.addText(names);
    }
    return table;
}

} // namespace hdp_tools
