// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The presets of cv::stereo::HDPTreeMatcher beside cv::StereoBM and cv::StereoSGBM on one pair: time, memory and, if the
// truth is known, errors, as tables in Markdown.
//
// All methods are timed in one process, in turns, so that a machine that is busy for a while slows all of them. Each
// timed run follows an untimed one of its own, as the frames of a camera do: what a method before it left in caches and
// page tables does not count. Memory is measured in a process for each method: this program, run again with --memory-of.

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "opencv2/imgproc.hpp"

#include "evaluation/command_line.hpp"
#include "evaluation/memory.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS =
    "{help h ?        |     | print this and exit }" + String(PAIR_KEYS) +
    "{methods         | presets,opencv | what to compare: ultrafast, fast, quality, tree, paper, bm, sgbm, sgbm-3way, "
    "sgbm-hh4, ..., or groups: presets, systems, opencv, custom (tree with a custom strategy, in parallel and in "
    "order), separated by commas }"
    "{resize          |     | WIDTHxHEIGHT to resize the pair to; the truth's disparities scale with the width }"
    "{sizes           |     | times at these sizes and as the pair is, a line for each: WIDTHxHEIGHT/DISPARITIES, "
    "separated by commas; those of robots, 640x480/64,1280x720/128, if there is no value }"
    "{threads         |     | number of threads; all processors if not given }"
    "{runs            | 7   | timed runs of each method, each after one that is not timed }"
    "{one-at-a-time   |     | keep the buffers of one method only, for pairs so large that all do not fit into memory }"
    "{stages          |     | the time of each stage of the presets, too }"
    "{memory-of       |     | measure the memory of this method, print it in bytes per pixel, and exit }";

static void resizePair(const String& sizeText, Pair& pair)
{
    Size size;
    char rest;
    const int limit = 1 << 15;
    if (std::sscanf(sizeText.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2 || size.width < 1 ||
        size.height < 1 || size.width > limit || size.height > limit)
        fail(format("--resize=%s: not WIDTHxHEIGHT, each from 1 to %d", sizeText.c_str(), limit));

    const double factor = double(size.width) / pair.left.cols;
    const int method = factor < 1 ? INTER_AREA : INTER_CUBIC;
    resize(pair.left, pair.left, size, 0, 0, method);
    resize(pair.right, pair.right, size, 0, 0, method);
    if (!pair.truth.empty())
    {
        // What is judged was found at the size of the files, where the truth of both images can be compared.
        resize(pair.truth, pair.truth, size, 0, 0, INTER_NEAREST);
        resize(pair.judged, pair.judged, size, 0, 0, INTER_NEAREST);
        pair.truth *= factor;
    }
}

struct Measurement
{
    Method method;
    String failure; // why the method has no times, if it is not empty
    double bytesPerPixel;
    std::vector<double> milliseconds;
    Score score;
    std::vector<String> stages; // of an HDPTreeMatcher
    std::vector<std::vector<double>> stageMilliseconds;
};

//! One more run of a method; the first one is for its errors, too.
static void measureRun(Measurement& result, Ptr<cv::StereoMatcher>& matcher, const Pair& pair)
{
    const Method& method = result.method;
    if (result.milliseconds.empty() && pair.protocol != Pair::NO_TRUTH)
    {
        matcher = method.create(pair.disparities);
        result.score = scoreMap(matchDensely(method, *matcher, pair.left, pair.right), pair);
        if (!method.isHdp) // its buffers are those of a wider pair
            matcher.release();
    }
    const std::array<Mat, 2> images = imagesFor(method, pair.left, pair.right);
    Mat disparity;
    if (!matcher)
        matcher = method.create(pair.disparities);
    matcher->compute(images[0], images[1], disparity);
    TickMeter timer;
    timer.start();
    matcher->compute(images[0], images[1], disparity);
    timer.stop();
    result.milliseconds.push_back(timer.getTimeMilli());
    if (method.isHdp)
    {
        const HDPTreeMatcher::Findings findings = matcher.dynamicCast<HDPTreeMatcher>()->getFindings();
        result.stages = findings.stages;
        result.stageMilliseconds.push_back(findings.stageTimes);
    }
}

//! Each method in turn, again and again
static void measureTimes(std::vector<Measurement>& results, const Pair& pair, int runs, bool oneAtATime)
{
    std::vector<Ptr<cv::StereoMatcher>> matchers(results.size());
    for (int run = 0; run < runs; run++)
    {
        std::cerr << "run " << run + 1 << " of " << runs << std::endl;
        for (size_t i = 0; i < results.size(); i++)
        {
            if (!results[i].failure.empty())
                continue;
            try
            {
                measureRun(results[i], matchers[i], pair);
            }
            catch (const cv::Exception& e)
            {
                results[i].failure = e.err;
            }
            if (oneAtATime)
                matchers[i].release();
        }
    }
}

// ---- Tables

static double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const size_t n = values.size();
    return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

static Table resultTable(const std::vector<Measurement>& results, bool withErrors)
{
    double reference = NO_SCORE;
    for (const Measurement& result : results)
        if (result.method.name == REFERENCE_METHOD && result.failure.empty())
            reference = median(result.milliseconds);

    Table table;
    table.title = "Times, memory" + String(withErrors ? " and errors" : "");
    table.header = { "method", "median ms", "minimum ms", "times faster than " + String(REFERENCE_METHOD),
                     "bytes per pixel" };
    const std::vector<String> errors = { "err>=1 %", "err>=2 %", "D1 %", "invalid %" };
    if (withErrors)
        table.header.insert(table.header.end(), errors.begin(), errors.end());
    for (const Measurement& result : results)
    {
        table.addRow(result.method.name);
        if (!result.failure.empty())
        {
            table.addText(result.failure);
            continue;
        }
        const double time = median(result.milliseconds);
        table.addNumber(time, "%.1f");
        table.addNumber(*std::min_element(result.milliseconds.begin(), result.milliseconds.end()), "%.1f");
        table.addNumber(reference / time);
        table.addNumber(result.bytesPerPixel >= 0 ? result.bytesPerPixel : NO_SCORE, "%.1f");
        if (withErrors)
            for (const double error :
                 { result.score.error1, result.score.error2, result.score.d1, result.score.invalid })
                table.addNumber(error);
    }
    return table;
}

//! --sizes: median times and how many times faster than the reference, a line for each size
static Table sizeTable(const String& sizes, const std::vector<Method>& methods, const Pair& pair, int runs,
                       bool oneAtATime)
{
    std::vector<Pair> pairs(1, pair);
    for (const String& size : splitList("sizes", sizes == "true" ? "640x480/64,1280x720/128" : sizes))
    {
        const size_t slash = std::min(size.find('/'), size.size());
        int disparities;
        char rest;
        if (std::sscanf(size.c_str() + slash, "/%d%c", &disparities, &rest) != 1 || disparities < 1 ||
            disparities > SHRT_MAX / 16 || disparities % 16 != 0)
            fail("--sizes=" + size + ": not WIDTHxHEIGHT/DISPARITIES, the last a multiple of 16");
        pairs.push_back(pair);
        resizePair(size.substr(0, slash), pairs.back());
        pairs.back().disparities = Range(0, disparities);
        pairs.back().protocol = Pair::NO_TRUTH;
    }
    Table table;
    table.title = "Median ms, times faster than " + String(REFERENCE_METHOD);
    table.header = { "size, disparities" };
    for (const Method& method : methods)
        table.header.push_back(method.name);
    for (const Pair& each : pairs)
    {
        std::vector<Measurement> results;
        for (const Method& method : methods)
            results.push_back({ method, String(), -1, {}, Score(), {}, {} });
        measureTimes(results, each, runs, oneAtATime);
        double reference = NO_SCORE;
        for (const Measurement& result : results)
            if (result.method.name == REFERENCE_METHOD && result.failure.empty())
                reference = median(result.milliseconds);
        table.addRow(format("%d x %d, %d", each.left.cols, each.left.rows, each.disparities.size()));
        for (const Measurement& result : results)
            if (!result.failure.empty())
                table.addText(result.failure);
            else
                table.addText(format("%.1f, ", median(result.milliseconds)) +
                              (reference > 0 ? format("%.2f x", reference / median(result.milliseconds)) : "-"));
    }
    return table;
}

static Table stageTable(const std::vector<Measurement>& results)
{
    Table table;
    table.title = "Stages";
    table.header = { "method", "stage", "median ms" };
    for (const Measurement& result : results)
    {
        for (size_t stage = 0; stage < result.stages.size(); stage++)
        {
            std::vector<double> milliseconds;
            for (const std::vector<double>& run : result.stageMilliseconds)
                milliseconds.push_back(run[stage]);
            table.addRow(result.method.name);
            table.addText(result.stages[stage]);
            table.addNumber(median(milliseconds));
        }
    }
    return table;
}

static int run(const CommandLineParser& parser, const char* const argv[])
{
    setThreads(parser);
    const int runs = getInteger(parser, "runs", 1, 10000);
    const bool memoryOnly = parser.has("memory-of");
    const String option = memoryOnly ? "memory-of" : "methods";
    const std::vector<Method> methods = selectMethods(option, parser.get<String>(option));

    Pair pair = readPair(parser);
    if (parser.has("resize"))
    {
        resizePair(parser.get<String>("resize"), pair);
        if (!parser.has("num-disparities"))
            pair.disparities.end = pair.disparities.start + defaultNumDisparities(pair.left.cols);
    }
    const Range disparities = pair.disparities;
    if (disparities.size() % 16 != 0)
        fail(format("--num-disparities=%d: not a multiple of 16, which OpenCV's matchers need", disparities.size()));

    if (memoryOnly)
    {
        if (methods.size() != 1)
            fail("--memory-of measures one method");
        std::cout << measureMemory(methods[0], pair) << std::endl;
        return 0;
    }

    std::cout << format("%d x %d pixels, disparities %d to %d, threads %d, runs %d, OpenCV %s\n", pair.left.cols,
                        pair.left.rows, disparities.start, disparities.end - 1, getNumThreads(), runs,
                        getVersionString().c_str())
              << "processor features: " << getCPUFeaturesLine() << "\n"
              << std::endl;
    if (parser.has("sizes"))
    {
        std::cout << toMarkdown(
            sizeTable(parser.get<String>("sizes"), methods, pair, runs, parser.has("one-at-a-time")));
        return 0;
    }
    std::vector<Measurement> results;
    for (const Method& method : methods)
    {
        Measurement result = { method, String(), -1, {}, Score(), {}, {} };
        std::cerr << "memory of " << method.name << std::endl;
        result.failure = runMemoryOf(method, argv, result.bytesPerPixel);
        results.push_back(result);
    }
    measureTimes(results, pair, runs, parser.has("one-at-a-time"));
    std::cout << toMarkdown(resultTable(results, pair.protocol != Pair::NO_TRUTH));
    if (parser.has("stages"))
        std::cout << "\n" << toMarkdown(stageTable(results));
    for (const Measurement& result : results)
        if (!result.failure.empty())
            fail(result.method.name + " " + result.failure);
    return 0;
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, KEYS, "Times, memory and errors of stereo matchers side by side.\n",
                      { "one-at-a-time", "stages", "sizes=" }, 2,
                      [&](const CommandLineParser& parser) { return run(parser, argv); });
}
