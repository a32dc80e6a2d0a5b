// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches every pair of a dataset with every system, and prints the tables of the paper: the share of the disparities
// that is searched, the errors, and the time. --report writes them with pictures of all maps to a page.

#include <atomic>
#include <csignal>
#include <iostream>
#include <mutex>
#include <thread>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include "opencv2/core/utils/logger.hpp"

#include "hdp_methods.hpp"
#include "hdp_report.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::DisparityPredictionModel;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@root           |     | folder of Middlebury or KITTI pairs, or of pairs without truth; or a folder above such }"
    "{resolution      |     | only these of Middlebury's: full, half, third or quarter, separated by commas }"
    "{methods         |     | only these: names as in the tables, or the groups paper, presets and opencv, separated "
    "by "
    "commas }"
    "{scenes          |     | only these, separated by commas }"
    "{num-disparities |     | number of disparities; by default that of the dataset }"
    "{model           |     | prediction model of the paper's HDP systems: a file of hdp_train }"
    "{report          |     | folder for index.html, with the tables, pictures of all maps, and how they came about }"
    "{csv             |     | FILE.csv for the tables, and one of every pair }"
    "{maps            |     | folder for the maps: METHOD/SET/SCENE.png (16 bit, times 256, 0 = none) }"
    "{runs            | 1   | how often a pair is matched; the shortest time counts }"
    "{jobs            | 1   | how many pairs are matched at a time; they share the threads, and get slower }"
    "{threads         |     | number of threads; all processors if not given }";

static const std::vector<String> FLAGS = { "help", "h", "?" };

struct Result
{
    bool done;
    Score score;
    double seconds;
    std::vector<double> ratios; // R_l of a method of this module, by layer
};

struct SceneResult
{
    Scene scene;
    Pair::Protocol protocol;
    Size size;
    std::vector<Result> results; // by method
    String maps, predictions;    // figures of the report
    std::vector<String> problems;
    bool isRead;
};

// ---- Interruption and progress

static volatile std::sig_atomic_t interrupted = 0;

extern "C" {
static void interrupt(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL); // a second time ends the program at once
}
}

static bool isTerminal()
{
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) != 0;
#endif
}

//! A bar on a terminal, lines elsewhere; for any thread.
class Progress
{
public:
    explicit Progress(size_t total) : total_(total), done_(0), isTerminal_(isTerminal()) {}

    void step(const String& what)
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        done_++;
        if (!isTerminal_)
        {
            std::cerr << done_ << "/" << total_ << " " << what << std::endl;
            return;
        }
        const size_t width = 30, filled = width * done_ / total_;
        std::cerr << "\r\x1b[K[" << String(filled, '#') << String(width - filled, '.') << "] " << done_ << "/" << total_
                  << " " << what << std::flush;
    }

    void skip(size_t steps)
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        done_ += steps;
    }

    void message(const String& text)
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        std::cerr << (isTerminal_ ? "\r\x1b[K" : "") << text << std::endl;
    }

    void finish()
    {
        if (isTerminal_)
            std::cerr << "\r\x1b[K" << std::flush;
    }

private:
    std::mutex mutex_;
    const size_t total_;
    size_t done_;
    const bool isTerminal_;
};

// ---- Selection

static std::vector<String> splitList(const String& text)
{
    std::vector<String> items;
    std::istringstream in(text);
    for (String item; std::getline(in, item, ',');)
        if (!item.empty())
            items.push_back(item);
    return items;
}

//! The methods of these names and groups, in their own order.
static std::vector<Method> selectMethods(const String& list, const std::vector<Method>& all)
{
    if (list.empty() || lowerCase(list) == "all")
        return all;
    std::vector<bool> isSelected(all.size(), false);
    for (const String& item : splitList(list))
    {
        bool found = false;
        for (size_t i = 0; i < all.size(); i++)
            if (lowerCase(item) == lowerCase(all[i].name) || lowerCase(item) == all[i].group)
                isSelected[i] = found = true;
        if (!found)
        {
            String names = "paper, presets, opencv";
            for (const Method& method : all)
                names += ", " + method.name;
            fail("--methods: unknown method '" + item + "', there are: " + names);
        }
    }
    std::vector<Method> selected;
    for (size_t i = 0; i < all.size(); i++)
        if (isSelected[i])
            selected.push_back(all[i]);
    return selected;
}

static std::vector<Scene> selectScenes(const CommandLineParser& parser)
{
    std::vector<Scene> scenes = findScenes(parser.get<String>("@root"));
    const std::vector<String> resolutions = splitList(parser.get<String>("resolution")),
                              names = splitList(parser.get<String>("scenes"));
    for (const String& resolution : resolutions)
        if (resolution != "full" && resolution != "half" && resolution != "third" && resolution != "quarter")
            fail("--resolution: unknown resolution '" + resolution + "', there are: full, half, third, quarter");
    for (const String& name : names)
        if (std::none_of(scenes.begin(), scenes.end(), [&](const Scene& scene) { return scene.name == name; }))
            fail("--scenes: there is no scene '" + name + "'");
    const auto isLeftOut = [&](const Scene& scene) {
        const bool otherResolution =
            !resolutions.empty() && !scene.resolution.empty() &&
            std::find(resolutions.begin(), resolutions.end(), scene.resolution) == resolutions.end();
        return otherResolution || (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end());
    };
    scenes.erase(std::remove_if(scenes.begin(), scenes.end(), isLeftOut), scenes.end());
    if (scenes.empty())
        fail("no pair is left by --resolution and --scenes");
    return scenes;
}

// ---- Matching

struct Settings
{
    std::vector<Method> methods;
    int numDisparities; // 0: the dataset's
    int runs;
    String maps; // folder, or empty
    bool hasReport;
};

static String printScore(const Score& score)
{
    if (!std::isnan(score.error1))
        return format("err>=1 %.2f, err>=2 %.2f", score.error1, score.error2);
    return std::isnan(score.d1) ? String("no truth") : format("D1 %.2f", score.d1);
}

static String titleOf(const Scene& scene) { return scene.set + "/" + scene.name; }

static void makeFolder(const String& path)
{
    if (!fs::createDirectories(path))
        fail("cannot make the folder '" + path + "'");
}

//! Fills one result; may throw.
static void evaluate(const Method& method, const Pair& pair, const Settings& settings, SceneResult& scene,
                     Result& result)
{
    const Ptr<cv::StereoMatcher> matcher = method.create(pair.numDisparities);
    const Match match = runMethod(method, *matcher, pair.left, pair.right, settings.runs);
    result.score = scoreMap(match.disparity, pair);
    result.seconds = match.seconds;
    const Ptr<HDPTreeMatcher> hdp = matcher.dynamicCast<HDPTreeMatcher>();
    if (hdp)
        hdp->getSearchRatios(result.ratios);
    if (!settings.maps.empty())
    {
        const String folder = fs::join(fs::join(settings.maps, method.name), scene.scene.set);
        makeFolder(folder);
        writeDisparity(fs::join(folder, scene.scene.name + ".png"), match.disparity);
    }
    if (settings.hasReport)
    {
        scene.maps += figure(resultPicture(match.disparity, pair),
                             method.name + ": " + printScore(result.score) + format(", %.2f s", match.seconds));
        if (hdp && hdp->getUsePrediction() && hdp->getAggregation() == HDPTreeMatcher::AGGREGATION_TREES)
            scene.predictions +=
                "<div class=\"figures\">\n" + predictionFigures(method.name, *hdp, method.create, pair) + "</div>\n";
    }
    result.done = true;
}

//! Matches a scene with all methods.
static void evaluateScene(const Settings& settings, SceneResult& result, Progress& progress)
{
    const String title = titleOf(result.scene);
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
        pair.numDisparities = settings.numDisparities;
    result.isRead = true;
    result.protocol = pair.protocol;
    result.size = pair.left.size();
    if (settings.hasReport)
    {
        result.maps = figure(pair.left, "left image");
        if (pair.protocol != Pair::NO_TRUTH)
            result.maps += figure(resultPicture(pair.truth, pair), "truth");
    }

    for (size_t m = 0; m < settings.methods.size() && !interrupted; m++)
    {
        const String& name = settings.methods[m].name;
        try
        {
            Result& r = result.results[m];
            evaluate(settings.methods[m], pair, settings, result, r);
            progress.step(title + " " + name + ": " + printScore(r.score) + format(", %.2f s", r.seconds));
        }
        catch (const std::exception& e)
        {
            result.problems.push_back("failed: " + title + " " + name + ": " + e.what());
            progress.message(result.problems.back());
            progress.skip(1);
        }
    }
}

//! Matches all scenes, several at a time. Returns how many of them have something wrong with them.
static int evaluateScenes(const Settings& settings, int jobs, std::vector<SceneResult>& results)
{
    Progress progress(results.size() * settings.methods.size());
    std::atomic<size_t> next(0);
    const auto work = [&] {
        for (size_t i = next++; i < results.size() && !interrupted; i = next++)
            evaluateScene(settings, results[i], progress);
    };
    std::vector<std::thread> threads;
    for (int job = 1; job < jobs; job++)
        threads.push_back(std::thread(work));
    work();
    for (std::thread& thread : threads)
        thread.join();
    progress.finish();
    return int(std::count_if(results.begin(), results.end(),
                             [](const SceneResult& result) { return !result.problems.empty(); }));
}

// ---- Tables

//! The results of a set that are to be in its tables: those of the pairs that were read and matched with anything.
static std::vector<const SceneResult*> resultsOfSet(const std::vector<SceneResult>& results, const String& set,
                                                    Pair::Protocol protocol)
{
    std::vector<const SceneResult*> selected;
    for (const SceneResult& result : results)
    {
        const bool isMatched =
            std::any_of(result.results.begin(), result.results.end(), [](const Result& r) { return r.done; });
        if (result.scene.set == set && result.isRead && result.protocol == protocol && isMatched)
            selected.push_back(&result);
    }
    return selected;
}

//! Those that all methods have matched: only these are in means, so that the means are comparable.
static std::vector<const SceneResult*> completeOnes(const std::vector<const SceneResult*>& results)
{
    std::vector<const SceneResult*> complete;
    std::copy_if(results.begin(), results.end(), std::back_inserter(complete), [](const SceneResult* result) {
        return std::all_of(result->results.begin(), result->results.end(), [](const Result& r) { return r.done; });
    });
    return complete;
}

typedef double Score::*Figure;

static std::vector<double> figuresOf(const std::vector<const SceneResult*>& results, size_t method, Figure figure)
{
    std::vector<double> values;
    for (const SceneResult* result : results)
        values.push_back(result->results[method].done ? result->results[method].score.*figure : NO_SCORE);
    return values;
}

static double meanSeconds(const std::vector<const SceneResult*>& results, size_t method)
{
    std::vector<double> values;
    for (const SceneResult* result : results)
        values.push_back(result->results[method].seconds);
    return meanOf(values);
}

//! Index of the method by which a method with prediction is measured; -1 if it is not among them.
static int fullRangeOf(const std::vector<Method>& methods, size_t method)
{
    for (size_t i = 0; i < methods.size(); i++)
        if (methods[i].name == methods[method].fullRange)
            return int(i);
    return -1;
}

static std::vector<String> headerOf(const String& first, const std::vector<Method>& methods)
{
    std::vector<String> header(1, first);
    for (const Method& method : methods)
        header.push_back(method.name);
    return header;
}

static bool narrowsRange(const Method& method) { return !method.fullRange.empty() || method.group == "presets"; }

//! R_l per layer, set and method; the paper's Table 1
static Table searchTable(const std::vector<String>& sets, const std::vector<Method>& methods,
                         const std::vector<SceneResult>& results)
{
    Table table;
    table.title = "Table 1: disparities searched, R_l in percent";
    table.header = { "set and system" };
    size_t layers = 0;
    for (const SceneResult& result : results)
        for (size_t m = 0; m < methods.size(); m++)
            if (narrowsRange(methods[m]))
                layers = std::max(layers, result.results[m].ratios.size());
    for (size_t l = 0; l < layers; l++)
        table.header.push_back(format("layer %d", int(l)));
    for (const String& set : sets)
        for (size_t m = 0; m < methods.size(); m++)
        {
            if (!narrowsRange(methods[m]))
                continue;
            std::vector<std::vector<double>> ratios(layers);
            for (const SceneResult& result : results)
                for (size_t l = 0; result.scene.set == set && l < result.results[m].ratios.size(); l++)
                    ratios[l].push_back(100 * result.results[m].ratios[l]);
            if (layers == 0 || ratios[0].empty())
                continue;
            table.addRow(set + " " + methods[m].name);
            for (size_t l = 0; l < layers; l++)
                table.addNumber(meanOf(ratios[l]));
        }
    return table;
}

//! A figure per scene and method, and the means
static Table sceneTable(const String& title, const std::vector<const SceneResult*>& results,
                        const std::vector<Method>& methods, Figure figure)
{
    Table table;
    table.title = title;
    table.header = headerOf("scene", methods);
    for (const SceneResult* result : results)
    {
        table.addRow(result->scene.name);
        std::vector<double> values;
        for (const Result& r : result->results)
            values.push_back(r.done ? r.score.*figure : NO_SCORE);
        table.addNumbers(values);
    }
    const std::vector<const SceneResult*> complete = completeOnes(results);
    table.addRow(format("mean of %d", int(complete.size())));
    std::vector<double> means;
    for (size_t m = 0; m < methods.size(); m++)
        means.push_back(meanOf(figuresOf(complete, m, figure)));
    table.addNumbers(means);
    return table;
}

//! Means of err>=1 and err>=2 per set; the paper's Table 3
static Table averageTable(const std::vector<String>& sets, const std::vector<Method>& methods,
                          const std::vector<SceneResult>& results)
{
    Table table;
    table.title = "Table 3: average errors, percent of the non-occluded pixels";
    table.header = { "system" };
    std::vector<std::vector<const SceneResult*>> ofSets;
    for (const String& set : sets)
    {
        ofSets.push_back(completeOnes(resultsOfSet(results, set, Pair::MIDDLEBURY)));
        const String count = format(" (%d scenes)", int(ofSets.back().size()));
        table.header.push_back(set + count + ": err>=1");
        table.header.push_back(set + count + ": err>=2");
    }
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        for (const std::vector<const SceneResult*>& ofSet : ofSets)
        {
            table.addNumber(meanOf(figuresOf(ofSet, m, &Score::error1)));
            table.addNumber(meanOf(figuresOf(ofSet, m, &Score::error2)));
        }
    }
    return table;
}

//! D1 and the average error per set of KITTI frames
static Table kittiTable(const String& set, const std::vector<Method>& methods,
                        const std::vector<const SceneResult*>& results)
{
    const std::vector<const SceneResult*> complete = completeOnes(results);
    Table table;
    table.title = format("KITTI: means over %d frames of %s", int(complete.size()), set.c_str());
    table.header = { "system", "D1, percent of all known pixels", "D1, percent of the non-occluded",
                     "average error, pixels" };
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        table.addNumber(meanOf(figuresOf(complete, m, &Score::d1)));
        table.addNumber(meanOf(figuresOf(complete, m, &Score::d1NonOccluded)));
        table.addNumber(meanOf(figuresOf(complete, m, &Score::average)));
    }
    return table;
}

static std::vector<RuntimePair> runtimePairs(const std::vector<const SceneResult*>& results, size_t method,
                                             size_t fullRange)
{
    std::vector<RuntimePair> pairs;
    for (const SceneResult* result : results)
    {
        const RuntimePair p = { result->scene.name, result->results[fullRange].seconds,
                                result->results[method].seconds };
        pairs.push_back(p);
    }
    return pairs;
}

//! Mean times, and of each HDP method how many times faster than over the full range; the paper's runtime figure
static Table runtimeTable(const String& set, const std::vector<Method>& methods,
                          const std::vector<const SceneResult*>& results)
{
    Table table;
    table.title = format("Runtime: means over %d pairs of %s", int(results.size()), set.c_str());
    table.header = { "system", "seconds", "times faster than over the full range: mean", "least", "most" };
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        table.addNumber(meanSeconds(results, m), "%.3f");
        const int fullRange = fullRangeOf(methods, m);
        std::vector<double> speedUps;
        if (fullRange >= 0)
            for (const RuntimePair& p : runtimePairs(results, m, size_t(fullRange)))
                speedUps.push_back(p.fullRange / p.predicted);
        table.addNumber(meanOf(speedUps));
        for (int end = 0; end < 2; end++)
            table.addNumber(speedUps.empty() ? NO_SCORE
                            : end == 0       ? *std::min_element(speedUps.begin(), speedUps.end())
                                             : *std::max_element(speedUps.begin(), speedUps.end()));
    }
    return table;
}

//! All there is, for other programs
static Table everyPairTable(const std::vector<SceneResult>& results, const std::vector<Method>& methods)
{
    Table table;
    table.title = "Every pair";
    table.header = { "set",  "scene",    "method",     "err>=1 %",        "err>=2 %",
                     "D1 %", "D1 noc %", "average px", "runtime seconds", "R_l in percent, by layer" };
    for (const SceneResult& result : results)
        for (size_t m = 0; m < methods.size(); m++)
        {
            const Result& r = result.results[m];
            if (!r.done)
                continue;
            table.addRow(result.scene.set);
            table.addText(result.scene.name);
            table.addText(methods[m].name);
            for (Figure figure : { &Score::error1, &Score::error2, &Score::d1, &Score::d1NonOccluded, &Score::average })
                table.addNumber(r.score.*figure, "%.4f");
            table.addNumber(r.seconds, "%.4f");
            String ratios;
            for (double ratio : r.ratios)
                ratios += (ratios.empty() ? "" : " ") + format("%.3f", 100 * ratio);
            table.addText(ratios);
        }
    return table;
}

//! The tables that are printed. Those without a row are left out.
static std::vector<Table> makeTables(const std::vector<String>& sets, const std::vector<Method>& methods,
                                     const std::vector<SceneResult>& results, int jobs)
{
    std::vector<Table> tables(1, searchTable(sets, methods, results));
    std::vector<String> middleburySets;
    for (const String& set : sets)
    {
        const std::vector<const SceneResult*> ofSet = resultsOfSet(results, set, Pair::MIDDLEBURY);
        if (ofSet.empty())
            continue;
        middleburySets.push_back(set);
        tables.push_back(sceneTable("Table 2: err>=2 of " + set + ", percent of the non-occluded pixels", ofSet,
                                    methods, &Score::error2));
    }
    if (!middleburySets.empty())
        tables.push_back(averageTable(middleburySets, methods, results));
    for (const String& set : sets)
    {
        const std::vector<const SceneResult*> ofSet = resultsOfSet(results, set, Pair::KITTI);
        if (ofSet.empty())
            continue;
        tables.push_back(
            sceneTable("KITTI: D1 of " + set + ", percent of all known pixels", ofSet, methods, &Score::d1));
        tables.push_back(kittiTable(set, methods, ofSet));
    }
    for (const String& set : sets)
        for (Pair::Protocol protocol : { Pair::MIDDLEBURY, Pair::KITTI, Pair::NO_TRUTH })
        {
            const std::vector<const SceneResult*> complete = completeOnes(resultsOfSet(results, set, protocol));
            if (complete.empty())
                continue;
            tables.push_back(runtimeTable(set, methods, complete));
            if (jobs > 1)
                tables.back().note = format("%d pairs were matched at a time.", jobs);
        }
    tables.erase(std::remove_if(tables.begin(), tables.end(), [](const Table& table) { return table.rows.empty(); }),
                 tables.end());
    return tables;
}

// ---- Output

static void writeText(const String& path, const String& text)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file << text;
    file.close();
    if (!file)
        fail("cannot write '" + path + "'");
}

static String reportPage(const std::vector<Table>& tables, const std::vector<String>& sets,
                         const std::vector<Method>& methods, const std::vector<SceneResult>& results,
                         const String& summary)
{
    std::ostringstream body;
    body << "<p>" << htmlText(summary) << "</p>\n";
    for (const SceneResult& result : results)
        for (const String& problem : result.problems)
            body << "<p class=\"problem\">" << htmlText(problem) << "</p>\n";
    body << "<p>Pairs:";
    for (size_t i = 0; i < results.size(); i++)
        if (results[i].isRead)
            body << " <a href=\"#pair" << i << "\">" << htmlText(titleOf(results[i].scene)) << "</a>";
    body << "</p>\n";
    for (const Table& table : tables)
        body << toHtml(table);
    body << "<div class=\"scroll\">\n";
    for (const String& set : sets)
        for (size_t m = 0; m < methods.size(); m++)
        {
            const int fullRange = fullRangeOf(methods, m);
            if (fullRange < 0)
                continue;
            for (Pair::Protocol protocol : { Pair::MIDDLEBURY, Pair::KITTI })
                body << runtimeChart(
                    "Runtime, " + set + ": " + methods[size_t(fullRange)].name + " (pale), " + methods[m].name +
                        " (dark), speed-up (red)",
                    runtimePairs(completeOnes(resultsOfSet(results, set, protocol)), m, size_t(fullRange)));
        }
    body << "</div>\n<p>Maps: blue is far, orange near. Wrong pixels (Middlebury: errors of 2 pixels and more; KITTI: "
            "above 3 "
            "pixels and 5 %) are red. Of Middlebury's pairs, pixels that are occluded or of unknown truth are black, "
            "and so is everywhere what has no disparity. P(D_l | D_{l+1}): a row for every disparity of the layer "
            "above, from the top, a column for every disparity of the layer; the largest element of a row is the "
            "brightest.</p>\n";
    for (size_t i = 0; i < results.size(); i++)
    {
        const SceneResult& result = results[i];
        if (!result.isRead)
            continue;
        body << "<h2 id=\"pair" << i << "\">" << htmlText(titleOf(result.scene))
             << format(" (%d x %d)", result.size.width, result.size.height) << "</h2>\n<div class=\"figures\">\n"
             << result.maps << "</div>\n";
        if (!result.predictions.empty())
            body << "<h3>Prediction</h3>\n" << result.predictions;
    }
    return htmlPage("Hierarchical disparity prediction: evaluation", body.str());
}

static int run(const CommandLineParser& parser)
{
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    if (parser.has("threads"))
        setNumThreads(getInteger(parser, "threads", 1, 1024));
    const int jobs = getInteger(parser, "jobs", 1, 256), threads = getNumThreads();
    const Ptr<DisparityPredictionModel> model = parser.has("model")
                                                    ? DisparityPredictionModel::load(parser.get<String>("model"))
                                                    : Ptr<DisparityPredictionModel>();
    Settings settings;
    settings.methods = selectMethods(parser.get<String>("methods"), allMethods(model));
    settings.numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, 2048) : 0;
    settings.runs = getInteger(parser, "runs", 1, 1000);
    settings.maps = parser.get<String>("maps");
    settings.hasReport = parser.has("report");

    std::vector<SceneResult> results;
    std::vector<String> sets;
    for (const Scene& scene : selectScenes(parser))
    {
        SceneResult result;
        result.scene = scene;
        result.protocol = Pair::NO_TRUTH;
        result.isRead = false;
        const Result none = { false, { NO_SCORE, NO_SCORE, NO_SCORE, NO_SCORE, NO_SCORE }, NO_SCORE, {} };
        result.results.assign(settings.methods.size(), none);
        results.push_back(result);
        if (std::find(sets.begin(), sets.end(), scene.set) == sets.end())
            sets.push_back(scene.set);
    }
    // Before hours of work, not after it.
    const String report = parser.get<String>("report"), csv = parser.get<String>("csv");
    if (settings.hasReport)
    {
        makeFolder(report);
        writeText(fs::join(report, "index.html"), htmlPage("Not finished", ""));
    }
    if (!settings.maps.empty())
        makeFolder(settings.maps);
    if (!csv.empty())
        writeText(csv, "");

    setNumThreads(std::max(threads / jobs, 1));
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    const int bad = evaluateScenes(settings, jobs, results);

    const std::vector<Table> tables = makeTables(sets, settings.methods, results, jobs);
    String markdown, text;
    for (const Table& table : tables)
    {
        markdown += toMarkdown(table) + "\n";
        text += toCsv(table) + "\n";
    }
    std::cout << markdown << std::flush;
    if (!csv.empty())
        writeText(csv, text + toCsv(everyPairTable(results, settings.methods)));
    if (settings.hasReport)
    {
        const String summary =
            format("%d pairs, %d of them with something wrong; %d systems, %d threads, OpenCV " CV_VERSION "%s",
                   int(results.size()), bad, int(settings.methods.size()), threads, interrupted ? "; interrupted" : "");
        writeText(fs::join(report, "index.html"), reportPage(tables, sets, settings.methods, results, summary));
    }
    if (interrupted)
        std::cerr << "interrupted: this is what was finished" << std::endl;
    if (bad > 0)
        std::cerr << bad << " of " << results.size() << " pairs were skipped or failed, see above" << std::endl;
    return interrupted ? 130 : bad > 0 ? 2 : 0;
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below, in one line
    try
    {
        CommandLineParser parser(argc, argv, KEYS);
        parser.about(
            "Tables of the paper, and a report with pictures, of a dataset of rectified stereo pairs.\n"
            "Exit status: 0 if all is well, 2 if a pair was skipped, 130 if interrupted, 1 on other errors.\n");
        checkArguments(argc, argv, parser, FLAGS, 1);
        if (!parser.has("help"))
            return run(parser);
        parser.printMessage();
        return 0;
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
    }
    catch (const std::exception& e)
    {
        std::cerr << "error: " << e.what() << std::endl;
    }
    return 1;
}
