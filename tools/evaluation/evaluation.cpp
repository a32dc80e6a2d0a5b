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

//! What a method made of a pair
struct Matched
{
    Mat disparity;
    double seconds;
    Ptr<HDPTreeMatcher> hdp; // empty if it is another matcher
    Mat confidence;          // of hdp
};

static Matched match(const Method& method, const Pair& pair, int runs)
{
    Matched matched;
    const Ptr<cv::StereoMatcher> matcher = method.create(pair.disparities);
    matched.disparity = matchDensely(method, *matcher, pair.left, pair.right, &matched.seconds, runs);
    matched.hdp = matcher.dynamicCast<HDPTreeMatcher>();
    if (matched.hdp)
        matched.hdp->getConfidence(matched.confidence);
    return matched;
}

static Score scoreMatched(const Mat& disparity, const Mat& confidence, const Pair& pair)
{
    Score score = scoreMap(disparity, pair);
    if (!confidence.empty() && pair.protocol != Pair::NO_TRUTH)
        findSparsification(wrongPixels(disparity, pair), pair.judged, confidence, score);
    return score;
}

//! Means over the changes
static void evaluateChanges(const Method& method, const Pair& pair, const EvaluationSettings& settings,
                            const String& scene, Result& result)
{
    const cv::Size size = pair.left.size();
    std::vector<Score> scores;
    std::vector<double> seconds;
    std::vector<std::vector<double>> ratios; // by layer
    for (const HarmlessChange& change : settings.changes)
    {
        const Matched matched = match(method, changePair(change, pair, scene), settings.runs);
        scores.push_back(
            scoreMatched(restoreMap(change, matched.disparity, size),
                         matched.confidence.empty() ? Mat() : restorePicture(change, matched.confidence, size),
                         truthOfChanged(change, pair)));
        seconds.push_back(matched.seconds);
        std::vector<double> ofChange;
        if (matched.hdp)
            ofChange = matched.hdp->getFindings().searchRatios;
        ratios.resize(std::max(ratios.size(), ofChange.size()));
        for (size_t l = 0; l < ofChange.size(); l++)
            ratios[l].push_back(ofChange[l]);
    }
    result.score = meanScore(scores);
    result.seconds = meanOf(seconds);
    for (const std::vector<double>& ofLayer : ratios)
        result.ratios.push_back(meanOf(ofLayer));
}

//! Fills one result; may throw.
static void evaluateMethod(const Method& method, const Pair& pair, const EvaluationSettings& settings,
                           SceneResult& scene, Result& result)
{
    const bool hasChanges = !settings.changes.empty(), isShown = settings.hasReport || !settings.maps.empty();
    Matched matched; // the pair as it is, which pictures are of
    if (!hasChanges || isShown)
        matched = match(method, pair, hasChanges ? 1 : settings.runs);
    if (hasChanges)
        evaluateChanges(method, pair, settings, scene.scene.name, result);
    else
    {
        result.seconds = matched.seconds;
        result.score = scoreMatched(matched.disparity, matched.confidence, pair);
        if (matched.hdp)
            result.ratios = matched.hdp->getFindings().searchRatios;
    }
    if (!settings.maps.empty())
    {
        const String folder = fs::join(fs::join(settings.maps, method.name), scene.scene.set);
        makeFolder(folder);
        writeDisparity(fs::join(folder, scene.scene.name + ".png"), matched.disparity);
    }
    if (settings.hasReport)
    {
        const Ptr<HDPTreeMatcher>& hdp = matched.hdp;
        scene.maps += figure(resultPicture(matched.disparity, pair), method.name + ": " +
                                                                         printScore(result.score, pair.protocol) +
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
        result.problems.push_back("skipped " + title + ": " + messageOf(e));
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
            result.problems.push_back("failed: " + title + " " + name + ": " + messageOf(e));
            progress.message(result.problems.back());
            progress.skip(1);
        }
    }
}

void forEachPair(const Method& method, const std::vector<Scene>& scenes, std::set<String>& bad,
                 const std::function<void(const Scene&, const Pair&)>& use)
{
    Progress progress(scenes.size());
    for (size_t i = 0; i < scenes.size() && !isInterrupted(); i++)
    {
        const String title = scenes[i].title();
        try
        {
            use(scenes[i], readPair(scenes[i]));
            progress.step(title + " " + method.name);
        }
        catch (const std::exception& e)
        {
            bad.insert(title);
            progress.message("skipped " + title + " " + method.name + ": " + messageOf(e));
            progress.skip(1);
        }
    }
    progress.finish();
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
