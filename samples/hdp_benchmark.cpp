// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The presets of cv::stereo::HDPTreeMatcher beside cv::StereoBM and cv::StereoSGBM on one pair: time, memory and, if the
// truth is known, errors, as a table in Markdown.
//
// All methods are timed in one process, in turns, so that a machine that is busy for a while slows all of them. Memory
// is measured in a process for each method: this program, run again with --memory-of.

#include <cstdio>
#include <iostream>
#include <sstream>

#ifdef __linux__
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include "opencv2/hdpstereo.hpp"

#include "hdp_samples_common.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@left           |     | left image of a rectified pair }"
    "{@right          |     | right image }"
    "{methods         | all | what to compare: names of presets, bm, sgbm, sgbm-3way, sgbm-hh4, separated by commas }"
    "{min-disparity   | 0   | smallest disparity in pixels }"
    "{num-disparities |     | number of disparities, a multiple of 16; by default width / 5, rounded up to one }"
    "{resize          |     | WIDTHxHEIGHT to resize the pair to; the truth's disparities scale with the width }"
    "{truth           |     | left disparity: PNG of 8 bit (0 = unknown) or 16 bit (times 256, 0 = unknown) or PFM }"
    "{truth-right     |     | right disparity; occluded pixels are then not judged }"
    "{truth-scale     |     | what a disparity of 1 is in the truth files, if not 1 (8 bit, PFM) or 256 (16 bit) }"
    "{threads         |     | number of threads; all processors if not given }"
    "{runs            | 7   | timed runs of each method, after one that is not timed }"
    "{one-at-a-time   |     | keep the buffers of one method only, for pairs so large that all do not fit into memory; "
    "each timed run then has an untimed one before it }"
    "{stages          |     | the time of each stage of the presets, too }"
    "{memory-of       |     | measure the memory of this method, print it in bytes a pixel, and exit }";

static const std::vector<String> FLAGS = { "help", "h", "?", "one-at-a-time", "stages" };

// ---- Methods

enum Kind
{
    HDP_PRESET,
    BM,
    SGBM
};

struct Method
{
    String name;
    Kind kind;
    int mode; // the preset, or the mode of StereoSGBM
};

//! What the times are compared with.
static const char* const REFERENCE = "sgbm-3way";

static std::vector<Method> allMethods()
{
    std::vector<Method> methods;
    for (const Preset& preset : PRESETS)
        methods.push_back({ preset.name, HDP_PRESET, preset.value });
    methods.push_back({ "bm", BM, 0 });
    methods.push_back({ "sgbm", SGBM, StereoSGBM::MODE_SGBM });
    methods.push_back({ REFERENCE, SGBM, StereoSGBM::MODE_SGBM_3WAY });
    methods.push_back({ "sgbm-hh4", SGBM, StereoSGBM::MODE_HH4 });
    return methods;
}

//! The methods of a list of names, such as "all" or "tree,sgbm-3way".
static std::vector<Method> selectMethods(const String& option, const String& list)
{
    const std::vector<Method> all = allMethods();
    if (list == "all")
        return all;
    std::vector<Method> selected;
    std::istringstream names(list + ","); // the comma makes an empty last name one that is seen, and refused
    for (String name; std::getline(names, name, ',');)
    {
        const auto sameName = [&](const Method& method) { return method.name == name; };
        const auto found = std::find_if(all.begin(), all.end(), sameName);
        if (found == all.end())
        {
            String known;
            for (const Method& method : all)
                known += (known.empty() ? "" : ", ") + method.name;
            fail("--" + option + "=" + list + ": '" + name + "' is unknown, there are: " + known);
        }
        selected.push_back(*found);
    }
    return selected;
}

static Ptr<cv::StereoMatcher> createMatcher(const Method& method, Range disparities)
{
    const int minDisparity = disparities.start, numDisparities = disparities.size();
    if (method.kind == HDP_PRESET)
        return HDPTreeMatcher::create(minDisparity, numDisparities, method.mode);
    if (method.kind == BM)
    {
        const Ptr<StereoBM> matcher = StereoBM::create(numDisparities, 15);
        matcher->setMinDisparity(minDisparity);
        return matcher;
    }
    // The penalties that the documentation advises, for 3 channels.
    const int blockSize = 3, P1 = 8 * 3 * blockSize * blockSize, P2 = 4 * P1;
    return StereoSGBM::create(minDisparity, numDisparities, blockSize, P1, P2, 0, 0, 0, 0, 0, method.mode);
}

// ---- The pair

struct Pair
{
    Mat left, right;
};

//! The pair as the method takes it: StereoBM only matches grey images.
static Pair pairFor(const Method& method, const Pair& pair)
{
    if (method.kind != BM)
        return pair;
    Pair grey;
    cvtColor(pair.left, grey.left, COLOR_BGR2GRAY);
    cvtColor(pair.right, grey.right, COLOR_BGR2GRAY);
    return grey;
}

static void resizePair(const String& sizeText, Pair& pair, Truth& truth)
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
    if (!truth.disparity.empty())
    {
        // What is judged was found at the size of the files, where the truth of both images can be compared.
        resize(truth.disparity, truth.disparity, size, 0, 0, INTER_NEAREST);
        resize(truth.judged, truth.judged, size, 0, 0, INTER_NEAREST);
        truth.disparity *= factor;
    }
}

// ---- Memory

#ifdef __linux__

static long peakKilobytes()
{
    std::ifstream status("/proc/self/status");
    for (String line; std::getline(status, line);)
    {
        long kilobytes;
        if (std::sscanf(line.c_str(), "VmHWM: %ld kB", &kilobytes) == 1)
            return kilobytes;
    }
    fail("/proc/self/status does not say how much memory was used");
    return 0;
}

//! What compute() adds to the memory of this process at its peak, beside the images and the disparities.
static double measureMemory(const Method& method, const Pair& pair, Range disparities)
{
    // Threads, tables and the like are there after a first small pair.
    Pair noise = { Mat(64, 128, CV_8UC3), Mat(64, 128, CV_8UC3) };
    randu(noise.left, 0, 256);
    randu(noise.right, 0, 256);
    noise = pairFor(method, noise);
    Mat ignored;
    createMatcher(method, Range(0, 16))->compute(noise.left, noise.right, ignored);

    const Pair input = pairFor(method, pair);
    Mat disparity(pair.left.size(), CV_16SC1, Scalar(0));
    const Ptr<cv::StereoMatcher> matcher = createMatcher(method, disparities);
#ifdef __GLIBC__
    malloc_trim(0); // or compute() would be given what reading the images left behind
#endif
    std::ofstream("/proc/self/clear_refs") << 5 << std::flush; // the peak starts again at what is in use
    const long before = peakKilobytes();
    matcher->compute(input.left, input.right, disparity);
    return (peakKilobytes() - before) * 1024. / double(disparity.total());
}

//! Runs this program again with --memory-of. Returns why there is no result, or an empty string.
static String runMemoryOf(const Method& method, char** argv, double& bytesPerPixel)
{
    const String option = "--memory-of=" + method.name;
    std::vector<char*> arguments;
    for (char** argument = argv; *argument; argument++)
        arguments.push_back(*argument);
    arguments.push_back(const_cast<char*>(option.c_str()));
    arguments.push_back(nullptr);

    int ends[2];
    if (pipe(ends) != 0)
        fail("cannot start a process to measure memory in: no pipe");
    const pid_t child = fork();
    if (child < 0)
        fail("cannot start a process to measure memory in");
    if (child == 0)
    {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        execv("/proc/self/exe", arguments.data());
        _exit(127);
    }
    close(ends[1]);
    char text[64] = "";
    size_t length = 0;
    for (ssize_t n; length + 1 < sizeof(text) && (n = read(ends[0], text + length, sizeof(text) - 1 - length)) > 0;)
        length += size_t(n);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status))
        return format("killed by signal %d (out of memory?)", WTERMSIG(status));
    if (status != 0 || std::sscanf(text, "%lf", &bytesPerPixel) != 1)
        return "failed, see above";
    return String();
}

#else

static double measureMemory(const Method&, const Pair&, Range)
{
    fail("--memory-of: memory is only measured on Linux");
    return 0;
}

static String runMemoryOf(const Method&, char**, double&) { return String(); }

#endif

// ---- Measuring

struct Errors
{
    double atLeast1, atLeast2, D1, invalid; // percent of the judged pixels
};

struct Result
{
    Method method;
    String failure; // why the method has no times, if it is not empty
    double bytesPerPixel;
    std::vector<double> milliseconds;
    Errors errors;
    std::vector<String> stages; // of presets
    std::vector<std::vector<double>> stageMilliseconds;
};

//! Pixels without a disparity are wrong. D1 is the measure of KITTI: wrong by more than 3 pixels and 5 %.
static Errors computeErrors(const Mat& disparity, const Truth& truth)
{
    const auto wrongFrom = [&](double threshold) {
        return percent(wrongPixels(disparity, truth.disparity, truth.judged, threshold), truth.judged);
    };
    Mat error;
    absdiff(disparity, truth.disparity, error);
    const Mat wrongD1 = (error > 3) & (error > 0.05 * truth.disparity) & truth.judged;
    return { wrongFrom(1), wrongFrom(2), percent(wrongD1, truth.judged),
             percent(~knownPixels(disparity) & truth.judged, truth.judged) };
}

//! The method's disparities for the errors. OpenCV's matchers leave a border without disparities where candidates are
//! outside of the right image. They are given a wider pair here (but not when they are timed), so that they are judged
//! by what they do inside of it.
static Mat computeDense(cv::StereoMatcher& matcher, const Method& method, const Pair& pair, Range disparities)
{
    const int left = method.kind == HDP_PRESET ? 0 : std::max(disparities.end, 0),
              right = method.kind == HDP_PRESET ? 0 : std::max(-disparities.start, 0);
    Pair wide;
    copyMakeBorder(pair.left, wide.left, 0, 0, left, right, BORDER_REPLICATE);
    copyMakeBorder(pair.right, wide.right, 0, 0, left, right, BORDER_REPLICATE);
    Mat disparity;
    matcher.compute(wide.left, wide.right, disparity);
    return toPixels(disparity.colRange(left, left + pair.left.cols), disparities.start);
}

//! Each method in turn, again and again.
static void measureTimes(std::vector<Result>& results, const Pair& pair, const Truth& truth, Range disparities,
                         int runs, bool oneAtATime)
{
    std::vector<Ptr<cv::StereoMatcher>> matchers(results.size());
    Mat disparity;
    for (int run = 0; run < runs; run++)
    {
        std::cerr << "run " << run + 1 << " of " << runs << std::endl;
        for (size_t i = 0; i < results.size(); i++)
        {
            Result& result = results[i];
            Ptr<cv::StereoMatcher>& matcher = matchers[i];
            if (!result.failure.empty())
                continue;
            try
            {
                const Pair input = pairFor(result.method, pair);
                if (run == 0 && !truth.disparity.empty())
                {
                    matcher = createMatcher(result.method, disparities);
                    result.errors = computeErrors(computeDense(*matcher, result.method, input, disparities), truth);
                    if (result.method.kind != HDP_PRESET) // its buffers are those of a wider pair
                        matcher.release();
                }
                if (!matcher)
                {
                    matcher = createMatcher(result.method, disparities);
                    matcher->compute(input.left, input.right, disparity);
                }
                TickMeter timer;
                timer.start();
                matcher->compute(input.left, input.right, disparity);
                timer.stop();
                result.milliseconds.push_back(timer.getTimeMilli());
            }
            catch (const cv::Exception& e)
            {
                result.failure = e.err;
                continue;
            }
            if (result.method.kind == HDP_PRESET)
            {
                result.stageMilliseconds.push_back(std::vector<double>());
                matcher.dynamicCast<HDPTreeMatcher>()->getStageTimes(result.stages, result.stageMilliseconds.back());
            }
            if (oneAtATime)
                matcher.release();
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

static void printResults(const std::vector<Result>& results, bool withErrors)
{
    double reference = 0;
    for (const Result& result : results)
        if (result.method.name == REFERENCE && result.failure.empty())
            reference = median(result.milliseconds);

    std::cout << "\n| method | median ms | minimum ms | times faster than " << REFERENCE << " | bytes a pixel |"
              << (withErrors ? " err>=1 % | err>=2 % | D1 % | invalid % |" : "") << "\n|---|---|---|---|---|"
              << (withErrors ? "---|---|---|---|" : "") << "\n";
    for (const Result& result : results)
    {
        std::cout << "| " << result.method.name << " |";
        if (!result.failure.empty())
        {
            std::cout << " " << result.failure << " |\n";
            continue;
        }
        const double time = median(result.milliseconds);
        std::cout << format(" %.1f | %.1f |", time,
                            *std::min_element(result.milliseconds.begin(), result.milliseconds.end()))
                  << (reference > 0 ? format(" %.2f |", reference / time) : String(" - |"))
                  << (result.bytesPerPixel >= 0 ? format(" %.1f |", result.bytesPerPixel) : String(" - |"));
        if (withErrors)
            std::cout << format(" %.2f | %.2f | %.2f | %.2f |", result.errors.atLeast1, result.errors.atLeast2,
                                result.errors.D1, result.errors.invalid);
        std::cout << "\n";
    }
}

static void printStages(const std::vector<Result>& results)
{
    std::cout << "\n| method | stage | median ms |\n|---|---|---|\n";
    for (const Result& result : results)
    {
        for (size_t stage = 0; stage < result.stages.size(); stage++)
        {
            std::vector<double> milliseconds;
            for (const std::vector<double>& run : result.stageMilliseconds)
                milliseconds.push_back(run[stage]);
            std::cout << "| " << result.method.name << " | " << result.stages[stage] << " |"
                      << format(" %.2f |\n", median(milliseconds));
        }
    }
}

static void run(const CommandLineParser& parser, char** argv)
{
    if (parser.has("threads"))
        setNumThreads(getInteger(parser, "threads", 1, 1024));
    const int runs = getInteger(parser, "runs", 1, 10000);
    const bool memoryOnly = parser.has("memory-of");
    const String option = memoryOnly ? "memory-of" : "methods";
    const std::vector<Method> methods = selectMethods(option, parser.get<String>(option));

    Pair pair;
    readPair(parser, pair.left, pair.right);
    Truth truth = readTruth(parser, pair.left.size());
    if (parser.has("resize"))
        resizePair(parser.get<String>("resize"), pair, truth);
    const Range disparities = getDisparities(parser, pair.left.size());
    if (disparities.size() % 16 != 0)
        fail(format("--num-disparities=%d: not a multiple of 16, which OpenCV's matchers need", disparities.size()));

    if (memoryOnly)
    {
        if (methods.size() != 1)
            fail("--memory-of measures one method");
        std::cout << measureMemory(methods[0], pair, disparities) << std::endl;
        return;
    }

    std::cout << format("%d x %d pixels, disparities %d to %d, threads %d, runs %d, OpenCV %s\n", pair.left.cols,
                        pair.left.rows, disparities.start, disparities.end - 1, getNumThreads(), runs,
                        getVersionString().c_str())
              << "processor features: " << getCPUFeaturesLine() << std::endl;
    std::vector<Result> results;
    for (const Method& method : methods)
    {
        Result result = { method, String(), -1, {}, Errors(), {}, {} };
        std::cerr << "memory of " << method.name << std::endl;
        result.failure = runMemoryOf(method, argv, result.bytesPerPixel);
        results.push_back(result);
    }
    measureTimes(results, pair, truth, disparities, runs, parser.has("one-at-a-time"));
    printResults(results, !truth.disparity.empty());
    if (parser.has("stages"))
        printStages(results);
    for (const Result& result : results)
        if (!result.failure.empty())
            fail(result.method.name + " " + result.failure);
}

int main(int argc, char** argv)
{
    return runSample(argc, argv, KEYS, "Times, memory and errors of stereo matchers side by side.\n", FLAGS, 2,
                     [&](const CommandLineParser& parser) { run(parser, argv); });
}
