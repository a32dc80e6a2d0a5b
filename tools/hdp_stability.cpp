// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches every pair of a dataset as it is and under changes that must not matter: what the errors are in the mean,
// which scenes flip, and which pixels.

#include <iostream>

#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/stability.hpp"
#include "evaluation/tables.hpp"
#include "evaluation/tunables.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS =
    String("{help h ?        |     | print this and exit }"
           "{@root           |     | folder of Middlebury, ETH3D or KITTI pairs, of pairs without truth, or of such "
           "folders }"
           "{resolution      |     | only these of Middlebury's: full, half, third or quarter, separated by commas }"
           "{scenes          |     | only these, separated by commas }"
           "{methods         | fast,quality,ultrafast,tree,sgbm,sgbm-3way,sgbm-hh4 | names as of hdp_evaluate }"
           "{changes         | ") +
    ALL_CHANGES +
    " | changes of the pairs; numbers may be others }"
    "{confidence      |     | what the confidence knows of it: unstable pixels among the 80 % most confident, "
    "correlation }"
    "{num-disparities |     | number of disparities; by default that of the dataset }"
    "{threads         |     | number of threads; all processors if not given }";

static const char* const ABOUT =
    "What changes that must not matter do to the maps of stereo matchers.\n"
    "  noise.5         Gaussian noise of half a level in both images\n"
    "  gamma1.05, gamma.95, jpeg95  both images\n"
    "  left1 .. left8, top1 .. top4  so many columns or rows are cut off both images\n"
    "  move1           both images a column to the right and a row down, borders repeated\n"
    "  scale.98        width and height, cubic interpolation; the map is scaled back\n"
    "  flip            upside down\n"
    "  mirror          left to right, images exchanged: the map of the right image. It is judged by that image's "
    "truth,\n"
    "                  where the set has none by the left truth of the pixels that both images show\n"
    "  range1, range16 so many disparities more (OpenCV's matchers take multiples of 16)\n"
    "  bits12          grey levels of 12 bits, from colours whose lower 4 are random; OpenCV's matchers get the upper "
    "8\n"
    "A scene is bistable if its error changes by more than 1.5 x and 1 point. A pixel is unstable if its disparity "
    "moves\n"
    "by more than 1 pixel, or is there only before or after. Visible pixels: those that count as non-occluded; "
    "without\n"
    "truth, those that the map as it is does not hide.\n"
    "Exit status: 0 if all is well, 2 if a pair was skipped, 130 if interrupted, 1 on other errors.\n";

//! Of the pairs of a set with a kind of truth, by method
struct SetResult
{
    String set;
    Pair::Protocol protocol;
    std::vector<String> scenes;
    std::vector<std::vector<Stability>> byMethod;
};

//! Mean of a figure over the pairs
template <typename Figure> static double meanOver(const std::vector<Stability>& results, const Figure& figure)
{
    std::vector<double> values;
    for (const Stability& result : results)
        values.push_back(figure(result));
    return meanOf(values);
}

static String titleOf(const SetResult& result)
{
    return result.set + format(", means of %d pairs", (int)result.scenes.size());
}

static String scoreName(const SetResult& result)
{
    return result.protocol == Pair::NO_TRUTH ? String("error") : mainScoreName(result.protocol);
}

static Table summary(const SetResult& result, const std::vector<Method>& methods)
{
    Table table;
    const String name = scoreName(result);
    table.title = "Stability of " + titleOf(result);
    table.header = { "system",          name + ": as it is",      "mean over changes", "worst change",
                     "bistable scenes", "unstable, % of visible", "of these bare",     "at edges",
                     "in blobs",        "unstable, % of occluded" };
    for (size_t m = 0; m < methods.size(); ++m)
    {
        const std::vector<Stability>& all = result.byMethod[m];
        const auto isBistable = [](const Stability& s) { return s.bistableChange() >= 0; };
        table.addRow(methods[m].name);
        table.addNumber(meanOver(all, [](const Stability& s) { return s.cleanError; }));
        table.addNumber(meanOver(all, [](const Stability& s) { return meanOf(s.errors); }));
        table.addNumber(meanOver(
            all, [](const Stability& s) { return s.worstChange() < 0 ? NO_SCORE : s.errors[s.worstChange()]; }));
        table.addText(result.protocol == Pair::NO_TRUTH
                          ? String("-")
                          : format("%d", (int)std::count_if(all.begin(), all.end(), isBistable)));
        table.addNumber(meanOver(all, [](const Stability& s) { return meanOf(s.unstable); }));
        table.addNumber(meanOver(all, [](const Stability& s) { return s.bare; }));
        table.addNumber(meanOver(all, [](const Stability& s) { return s.edge; }));
        table.addNumber(meanOver(all, [](const Stability& s) { return s.inBlobs; }));
        table.addNumber(meanOver(all, [](const Stability& s) { return s.occluded; }));
    }
    table.note = "worst change: of each pair. bare, at edges, in blobs: in percent of the visible pixels, too.";
    return table;
}

//! The bistable scenes by name
static String bistableScenes(const SetResult& result, const std::vector<Method>& methods,
                             const std::vector<HarmlessChange>& changes)
{
    String text;
    for (size_t m = 0; m < methods.size(); ++m)
    {
        String scenes;
        for (size_t s = 0; s < result.scenes.size(); ++s)
        {
            const Stability& stability = result.byMethod[m][s];
            const int change = stability.bistableChange();
            if (change >= 0)
                scenes += (scenes.empty() ? "" : ", ") + result.scenes[s] +
                          format(" %.2f -> %.2f by %s", stability.cleanErrors[change], stability.errors[change],
                                 changes[change].name.c_str());
        }
        if (!scenes.empty())
            text += "- bistable with " + methods[m].name + ": " + scenes + "\n";
    }
    return text;
}

//! A row for each change, with a figure of each method
template <typename Figure>
static Table byChange(const String& title, const SetResult& result, const std::vector<Method>& methods,
                      const std::vector<HarmlessChange>& changes, const Figure& figure)
{
    Table table;
    table.title = title;
    table.header.push_back("change");
    for (const Method& method : methods)
        table.header.push_back(method.name);
    for (size_t i = 0; i < changes.size(); ++i)
    {
        std::vector<double> means;
        for (const std::vector<Stability>& all : result.byMethod)
            means.push_back(meanOver(all, [&](const Stability& s) { return figure(s)[i]; }));
        table.addRow(changes[i].name);
        table.addNumbers(means);
    }
    return table;
}

static Table confidenceTable(const SetResult& result, const std::vector<Method>& methods)
{
    Table table;
    table.title = "Confidence and stability of " + result.set;
    table.header = { "system", "unstable, % of visible", "% of the 80 % most confident", "ratio", "correlation" };
    for (size_t m = 0; m < methods.size(); ++m)
    {
        ConfidenceCounts counts;
        for (const Stability& stability : result.byMethod[m])
            counts.add(stability.confidence);
        const double all = counts.unstableShare(1), confident = counts.unstableShare(0.8);
        table.addRow(methods[m].name);
        table.addNumber(all);
        table.addNumber(confident);
        table.addNumber(all > 0 ? confident / all : NO_SCORE);
        table.addNumber(counts.correlation(), "%.3f");
    }
    table.note = "Of the pixels of all pairs and changes; a method without a confidence has no figures.";
    return table;
}

static void print(const SetResult& result, const std::vector<Method>& methods,
                  const std::vector<HarmlessChange>& changes, bool withConfidence)
{
    std::cout << toMarkdown(summary(result, methods)) << "\n";
    const String bistable = bistableScenes(result, methods, changes);
    std::cout << bistable << (bistable.empty() ? "" : "\n");
    if (result.protocol != Pair::NO_TRUTH)
        std::cout << toMarkdown(byChange(scoreName(result) + " of " + titleOf(result), result, methods, changes,
                                         [](const Stability& s) { return s.errors; }))
                  << "\n";
    std::cout << toMarkdown(byChange("Unstable, % of the visible pixels of " + titleOf(result), result, methods,
                                     changes, [](const Stability& s) { return s.unstable; }))
              << "\n";
    if (withConfidence)
        std::cout << toMarkdown(confidenceTable(result, methods)) << "\n";
    std::cout.flush();
}

//! Adds a pair to the results of its set, or fails. Returns whether it was not interrupted.
static bool measure(const Scene& scene, int numDisparities, const std::vector<Method>& methods,
                    const std::vector<HarmlessChange>& changes, std::vector<SetResult>& results)
{
    Pair pair = readPair(scene);
    if (numDisparities > 0)
        pair.disparities.end = pair.disparities.start + numDisparities;
    std::vector<Stability> ofPair;
    for (const Method& method : methods)
        if (!isInterrupted())
            ofPair.push_back(measureStability(method, pair, changes, scene.name));
    if (isInterrupted())
        return false;
    const auto isOfSet = [&](const SetResult& r) { return r.set == scene.set && r.protocol == pair.protocol; };
    std::vector<SetResult>::iterator found = std::find_if(results.begin(), results.end(), isOfSet);
    if (found == results.end())
        found = results.insert(
            found, SetResult{ scene.set, pair.protocol, {}, std::vector<std::vector<Stability>>(methods.size()) });
    found->scenes.push_back(scene.name);
    for (size_t m = 0; m < methods.size(); ++m)
        found->byMethod[m].push_back(ofPair[m]);
    return true;
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    const std::vector<Method> methods = selectMethods("methods", parser.get<String>("methods"));
    const std::vector<HarmlessChange> changes = selectChanges(parser);
    const int numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, 2048) : 0;
    const std::vector<Scene> scenes = selectScenes(parser);
    catchInterrupts();
    Progress progress(scenes.size());
    size_t skipped = 0;
    std::vector<SetResult> results; // of a set
    for (size_t s = 0; s < scenes.size() && !isInterrupted(); ++s)
    {
        try
        {
            if (measure(scenes[s], numDisparities, methods, changes, results))
                progress.step(scenes[s].title());
        }
        catch (const std::exception& error)
        {
            progress.message("skipped " + scenes[s].title() + ": " + messageOf(error));
            progress.skip(1);
            ++skipped;
        }
        if (s + 1 < scenes.size() && scenes[s + 1].set == scenes[s].set && !isInterrupted())
            continue;
        for (const SetResult& result : results)
            print(result, methods, changes, parser.has("confidence"));
        results.clear();
    }
    progress.finish();
    return endOfRun(skipped, scenes.size());
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, KEYS + TUNABLE_KEYS, ABOUT, { "confidence", "changes=" }, 1, run);
}
