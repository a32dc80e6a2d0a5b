// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "evaluation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "opencv2/core/utils/filesystem.hpp"

#include "command_line.hpp"
#include "pictures.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace hdp_tools {

namespace fs = cv::utils::fs;

static String printScore(const Score& score, Pair::Protocol protocol)
{
    if (protocol == Pair::NO_TRUTH)
        return "no truth";
    const String main = mainScoreName(protocol) + cv::format(" %.2f", mainScore(score, protocol));
    return protocol == Pair::MIDDLEBURY ? cv::format("err>=1 %.2f, ", score.error1) + main : main;
}

void makeFolder(const String& path)
{
    if (!fs::createDirectories(path))
        fail("cannot make the folder '" + path + "'");
}

//! Fills one result; may throw.
static void evaluateMethod(const Method& method, const Pair& pair, const EvaluationSettings& settings,
                           SceneResult& scene, Result& result)
{
    const Ptr<cv::StereoMatcher> matcher = method.create(pair.disparities);
    const Mat disparity = matchDensely(method, *matcher, pair.left, pair.right, &result.seconds, settings.runs);
    result.score = scoreMap(disparity, pair);
    const Ptr<HDPTreeMatcher> hdp = matcher.dynamicCast<HDPTreeMatcher>();
    if (hdp)
    {
        result.ratios = hdp->getFindings().searchRatios;
        Mat confidence;
        hdp->getConfidence(confidence);
        if (pair.protocol != Pair::NO_TRUTH)
            findSparsification(wrongPixels(disparity, pair), pair.judged, confidence, result.score);
    }
    if (!settings.maps.empty())
    {
        const String folder = fs::join(fs::join(settings.maps, method.name), scene.scene.set);
        makeFolder(folder);
        writeDisparity(fs::join(folder, scene.scene.name + ".png"), disparity);
    }
    if (settings.hasReport)
    {
        scene.maps +=
            figure(resultPicture(disparity, pair), method.name + ": " + printScore(result.score, pair.protocol) +
                                                       cv::format(", %.3f s", result.seconds));
        if (hdp && hdp->getParams().usePrediction &&
            hdp->getParams().aggregation != HDPTreeMatcher::AGGREGATION_SCANLINES)
            scene.predictions += "<div class=\"figures\">\n" + predictionFigures(method.name, *hdp, pair) + "</div>\n";
    }
    result.done = true;
}

//! Matches a scene with all methods.
static void evaluateScene(const EvaluationSettings& settings, SceneResult& result, Progress& progress)
{
    const String title = result.scene.title();
    Pair pair;
    try
    {
        pair = readPair(result.scene);
    }
    catch (const std::exception& e)
    {
        result.problems.push_back("skipped " + title + ": " + e.what());
        progress.message(result.problems.back());
        progress.skip(settings.methods.size());
        return;
    }
    if (settings.numDisparities > 0)
        pair.disparities = cv::Range(0, settings.numDisparities);
    result.isRead = true;
    result.protocol = pair.protocol;
    result.size = pair.left.size();
    if (settings.hasReport)
    {
        Mat left = pair.left, right = pair.right;
        toColors(left, right);
        result.maps = figure(left, "left image");
        if (pair.protocol != Pair::NO_TRUTH)
            result.maps += figure(resultPicture(pair.truth, pair), "truth");
    }

    for (size_t m = 0; m < settings.methods.size() && !isInterrupted(); m++)
    {
        const String& name = settings.methods[m].name;
        try
        {
            Result& r = result.results[m];
            evaluateMethod(settings.methods[m], pair, settings, result, r);
            progress.step(title + " " + name + ": " + printScore(r.score, pair.protocol) +
                          cv::format(", %.3f s", r.seconds));
        }
        catch (const std::exception& e)
        {
            result.problems.push_back("failed: " + title + " " + name + ": " + e.what());
            progress.message(result.problems.back());
            progress.skip(1);
        }
    }
}

int evaluateScenes(const EvaluationSettings& settings, std::vector<SceneResult>& results)
{
    Progress progress(results.size() * settings.methods.size());
    std::atomic<size_t> next(0);
    const auto work = [&] {
        for (size_t i = next++; i < results.size() && !isInterrupted(); i = next++)
            evaluateScene(settings, results[i], progress);
    };
    std::vector<std::thread> threads;
    for (int job = 1; job < settings.jobs; job++)
        threads.push_back(std::thread(work));
    work();
    for (std::thread& thread : threads)
        thread.join();
    progress.finish();
    return int(std::count_if(results.begin(), results.end(),
                             [](const SceneResult& result) { return !result.problems.empty(); }));
}

} // namespace hdp_tools
