// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches every pair of a dataset with every method, and prints the tables of the paper: the share of the disparities
// that is searched, the errors, and the time. --report writes them with pictures of all maps to a page.

#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"

#include "evaluation/calibration.hpp"
#include "evaluation/command_line.hpp"
#include "evaluation/found_ranges.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/result_tables.hpp"
#include "evaluation/tunables.hpp"

using namespace cv;
using namespace hdp_tools;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@root           |     | folder of Middlebury, ETH3D or KITTI pairs, of pairs without truth, or of such folders }"
    "{resolution      |     | only these of Middlebury's: full, half, third or quarter, separated by commas }"
    "{methods         |     | names as in the tables, or groups, separated by commas: by default "
    "systems,presets,opencv, and presets where others cannot be asked }"
    "{scenes          |     | only these, separated by commas }"
    "{changes         |     | all figures are means over changes that must not matter, the list of hdp_stability or "
    "one's "
    "own; maps and pictures are of the pairs as they are }"
    "{num-disparities |     | number of disparities; by default that of the dataset. 0: only prints how the ranges "
    "that "
    "are found in the pairs differ from the true ones, by sets }"
    "{model           |     | prediction model of the paper's HDP systems: a file of hdp_train }"
    "{report          |     | folder for index.html, with the tables, pictures of all maps, and how they came about }"
    "{csv             |     | FILE.csv for the tables, and one of every pair }"
    "{maps            |     | folder for the maps: METHOD/SET/SCENE.png (16 bit, times 256, 0 = none) }"
    "{calibration     |     | only prints how many errors are within what getDisparitySigma() says, by sets }"
    "{plot            |     | with calibration, FILE.svg for its curves; of one method }"
    "{confidence      |     | only prints how many pixels have what getConfidence(), and how many of these are wrong, "
    "by sets }"
    "{runs            | 1   | how often a pair is matched; the shortest time counts }"
    "{jobs            | 1   | how many pairs are matched at a time; they share the threads, and get slower }"
    "{threads         |     | number of threads; all processors if not given }";

static void writeText(const String& path, const String& text)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file << text;
    file.close();
    if (!file)
        fail("cannot write '" + path + "'");
}

static bool asksForRanges(const CommandLineParser& parser)
{
    return parser.has("num-disparities") && getInteger(parser, "num-disparities", 0, 2048) == 0;
}

//! The option that asks for tables of its own, of what matchers say; empty if there is none
static String ownTables(const CommandLineParser& parser)
{
    return asksForRanges(parser)       ? "--num-disparities=0"
           : parser.has("calibration") ? "--calibration"
           : parser.has("confidence")  ? "--confidence"
                                       : "";
}

static EvaluationSettings readSettings(const CommandLineParser& parser)
{
    const Ptr<DisparityPredictionModel> model = parser.has("model")
                                                    ? DisparityPredictionModel::load(parser.get<String>("model"))
                                                    : Ptr<DisparityPredictionModel>();
    EvaluationSettings settings;
    settings.numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 0, 2048) : 0;
    const String usual = ownTables(parser).empty() ? "systems,presets,opencv" : "presets";
    settings.methods = selectMethods("methods", parser.has("methods") ? parser.get<String>("methods") : usual, model);
    settings.runs = getInteger(parser, "runs", 1, 1000);
    settings.jobs = getInteger(parser, "jobs", 1, 256);
    settings.maps = parser.get<String>("maps");
    settings.hasReport = parser.has("report");
    settings.changes = selectChanges(parser);
    return settings;
}

//! What the figures are of, if not of the pairs as they are
static String changesText(const std::vector<HarmlessChange>& changes)
{
    String text;
    for (const HarmlessChange& change : changes)
        text += (text.empty() ? "Means over the changes " : ", ") + change.name;
    return text;
}

static void checkOwnTables(const CommandLineParser& parser, const EvaluationSettings& settings)
{
    const String option = ownTables(parser);
    const bool areRanges = asksForRanges(parser);
    std::vector<String> others = { "changes", "csv", "report", "maps" };
    if (areRanges)
        others.insert(others.end(), { "calibration", "confidence" });
    for (const String& other : others)
        if (parser.has(other))
            fail("--" + other + " does not go with " + option);
    if (settings.runs > 1 || settings.jobs > 1)
        fail("--runs and --jobs do not go with " + option);
    for (const Method& method : settings.methods)
        if (!method.isHdp)
            fail(option + ": " + method.name + (areRanges ? " finds no range" : " knows no errors"));
}

//! Prints what ownTables() asks for; returns the exit status.
static int printOwnTables(const CommandLineParser& parser, const EvaluationSettings& settings)
{
    checkOwnTables(parser, settings);
    std::vector<Scene> scenes = selectScenes(parser);
    scenes.erase(std::remove_if(scenes.begin(), scenes.end(), [](const Scene& scene) { return scene.truth.empty(); }),
                 scenes.end());
    if (scenes.empty())
        fail("no pair has truth, which " + ownTables(parser) + " needs");
    const String plot = parser.get<String>("plot");
    if (!plot.empty())
        writeText(plot, "");
    catchInterrupts();
    std::set<String> bad;
    const auto print = [&](const Table& table) {
        if (!table.rows.empty())
            std::cout << toMarkdown(table) << std::endl;
    };
    for (const Method& method : settings.methods)
        if (asksForRanges(parser))
            print(foundRangesTable(method, scenes, bad));
    for (const Method& method : settings.methods)
        if (parser.has("calibration"))
        {
            const Table table = calibrationTable(method, scenes, settings.numDisparities, bad);
            print(table);
            if (!plot.empty() && !table.rows.empty())
                writeText(plot, calibrationPlot(table));
        }
    for (const Method& method : settings.methods)
        if (parser.has("confidence"))
            print(confidenceErrorsTable(method, scenes, settings.numDisparities, bad));
    return endOfRun(bad.size(), scenes.size());
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    const int threads = getNumThreads();
    const EvaluationSettings settings = readSettings(parser);
    if (parser.has("plot") && (!parser.has("calibration") || settings.methods.size() != 1 || asksForRanges(parser)))
        fail("--plot needs --calibration, one method and no --num-disparities=0");
    if (!ownTables(parser).empty())
        return printOwnTables(parser, settings);

    std::vector<SceneResult> results;
    for (const Scene& scene : selectScenes(parser))
        results.push_back(SceneResult(scene, settings.methods.size()));

    // Before hours of work, not after it
    const String report = parser.get<String>("report"), csv = parser.get<String>("csv");
    const String page = utils::fs::join(report, "index.html");
    if (settings.hasReport)
    {
        makeFolder(report);
        writeText(page, htmlPage("Not finished", ""));
    }
    if (!settings.maps.empty())
        makeFolder(settings.maps);
    if (!csv.empty())
        writeText(csv, "");

    setNumThreads(std::max(threads / settings.jobs, 1));
    catchInterrupts();
    const int bad = evaluateScenes(settings, results);

    const std::vector<Table> tables = makeTables(settings.methods, results, settings.jobs);
    String text;
    const String changes = changesText(settings.changes);
    std::cout << changes << (changes.empty() ? "" : "\n\n");
    for (const Table& table : tables)
    {
        std::cout << toMarkdown(table) << "\n";
        text += toCsv(table) + "\n";
    }
    if (!csv.empty())
        writeText(csv, text + toCsv(everyPairTable(settings.methods, results)));
    if (settings.hasReport)
    {
        const String summary =
            format("%d pairs, %d of them with something wrong; %d systems, %d threads, OpenCV " CV_VERSION "%s%s%s",
                   int(results.size()), bad, int(settings.methods.size()), threads,
                   isInterrupted() ? "; interrupted" : "", changes.empty() ? "" : ". ", changes.c_str());
        writeText(page, reportPage(tables, settings.methods, results, summary));
    }
    return endOfRun((size_t)bad, results.size());
}

int main(int argc, char** argv)
{
    return runProgram(
        argc, argv, String(KEYS) + TUNABLE_KEYS,
        "Tables of the paper, and a report with pictures, of a dataset of rectified stereo pairs.\n"
        "Exit status: 0 if all is well, 2 if a pair was skipped, 130 if interrupted, 1 on other errors.\n",
        { "changes=", "calibration", "confidence" }, 1, run);
}
