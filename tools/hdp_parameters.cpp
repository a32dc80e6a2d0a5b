// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What each parameter of HDPTreeMatcher does to speed and accuracy: changes one at a time in PRESET_FAST and in
// PRESET_TREE, matches all pairs of a dataset, and prints a table of the errors and of the processor time beside the
// preset's own.

#include <ctime>
#include <functional>
#include <iostream>
#include <sstream>

#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/harmless_changes.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/scores.hpp"

using namespace cv;
using namespace hdp_tools;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?  |           | print this and exit }"
    "{@root     |           | folder of Middlebury pairs with truth, see hdp_evaluate }"
    "{presets   | fast,tree | those to change: fast, tree or both }"
    "{changes   |           | errors and times are means over changes that must not matter: those of hdp_stability, or "
    "a list }"
    "{runs      | 3         | how often a pair is matched in each way, in turns; the shortest times count }"
    "{threads   |           | number of threads; all processors if not given }";

//! A preset, or a preset with one change
struct Variant
{
    String name;
    std::function<void(HDPTreeMatcher&)> change;
    double error1, error2, relativeTime; // sums over the pairs
};

//! One for each value of a parameter
template <typename Value>
static void add(std::vector<Variant>& variants, const String& parameter, void (HDPTreeMatcher::*setter)(Value),
                const std::vector<Value>& values)
{
    for (const Value value : values)
    {
        std::ostringstream name;
        name << std::boolalpha << parameter << " = " << value;
        variants.push_back({ name.str(), [=](HDPTreeMatcher& m) { (m.*setter)(value); }, 0, 0, 0 });
    }
}

static void addTree(std::vector<Variant>& variants, const String& name, const Ptr<stereo::TreeStrategy>& strategy)
{
    variants.push_back({ "treeStrategy = " + name, [=](HDPTreeMatcher& m) { m.setTreeStrategy(strategy); }, 0, 0, 0 });
}

//! What a preset is changed to; the first one is the preset itself.
static std::vector<Variant> variantsOf(int preset)
{
    typedef HDPTreeMatcher M;
    std::vector<Variant> variants(1, { "PRESET_FAST", [](M&) {}, 0, 0, 0 });
    add<int>(variants, "blockSize", &M::setBlockSize, { 3, 5 });
    add<int>(variants, "disparityMedianSize", &M::setDisparityMedianSize, { 0, 3, 7 });
    add<int>(variants, "disparityMedianPasses", &M::setDisparityMedianPasses, { 2 });
    add<double>(variants, "gamma", &M::setGamma, { 10, 40 });
    add<bool>(variants, "fillOcclusions", &M::setFillOcclusions, { false });
    add<bool>(variants, "useSubpixel", &M::setUseSubpixel, { false });
    add<int>(variants, "maxRowOffset", &M::setMaxRowOffset, { 0 });
    add<bool>(variants, "useLightAlignment", &M::setUseLightAlignment, { false });
    add<double>(variants, "noiseThreshold", &M::setNoiseThreshold, { 0, 1 });
    variants.push_back(
        { "numDisparities twice as large", [](M& m) { m.setNumDisparities(2 * m.getNumDisparities()); }, 0, 0, 0 });
    if (preset == M::PRESET_FAST) // each has one of the two
        addTree(variants, "createMinimumSpanningTree()", stereo::createMinimumSpanningTree());
    else
        addTree(variants, "createSegmentTree()", stereo::createSegmentTree());
    addTree(variants, "createRandomTree()", stereo::createRandomTree());
    if (preset == M::PRESET_FAST)
    {
        add<int>(variants, "finestLayer", &M::setFinestLayer, { 1, 2 });
        add<int>(variants, "scanlinePasses", &M::setScanlinePasses, { 2, 3 });
        variants.push_back(
            { "topAggregation = AGGREGATION_TREES", [](M& m) { m.setTopAggregation(M::AGGREGATION_TREES); }, 0, 0, 0 });
        add<int>(variants, "maxTopDisparities", &M::setMaxTopDisparities, { 16, 64 });
        add<int>(variants, "P1", &M::setP1, { 8, 32 });
        add<int>(variants, "P2", &M::setP2, { 35, 100 });
    }
    else
    {
        variants[0].name = "PRESET_TREE";
        variants.push_back(
            { "aggregation = AGGREGATION_TREES", [](M& m) { m.setAggregation(M::AGGREGATION_TREES); }, 0, 0, 0 });
        add<bool>(variants, "useNonLocalRefinement", &M::setUseNonLocalRefinement, { true });
        add<int>(variants, "maxTopDisparities", &M::setMaxTopDisparities, { 32, 128 });
        add<double>(variants, "delta0", &M::setDelta0, { 0.005, 0.08 });
        add<double>(variants, "beta", &M::setBeta, { 0.6, 0.98 });
        add<int>(variants, "intervalMargin", &M::setIntervalMargin, { 0, 4 });
        variants.push_back({ "disparityPrior = PRIOR_SUPPORT_POINTS",
                             [](M& m) { m.setDisparityPrior(M::PRIOR_SUPPORT_POINTS); }, 0, 0, 0 });
        add<bool>(variants, "usePrediction", &M::setUsePrediction, { false });
        variants.push_back({ "matchingCost = COST_COLOR_GRADIENT, blockSize = 1",
                             [](M& m) {
            m.setMatchingCost(M::COST_COLOR_GRADIENT);
            m.setBlockSize(1);
            m.setAggregation(M::AGGREGATION_TREES); // the others need the census
            m.setFillOcclusions(false);
                            },
                             0, 0, 0 });
    }
    return variants;
}

//! Matches a pair in all ways, in turns, and takes the processor time of all threads: so it matters little what else the
//! computer does.
static void measure(const Pair& pair, const HarmlessChange& change, const Pair& original, int preset, int runs,
                    std::vector<Variant>& variants)
{
    std::vector<Ptr<HDPTreeMatcher>> matchers;
    for (const Variant& variant : variants)
    {
        matchers.push_back(HDPTreeMatcher::create(0, pair.disparities.size(), preset));
        variant.change(*matchers.back());
    }
    const Pair truth = truthOfChanged(change, original);
    std::vector<double> seconds(variants.size(), DBL_MAX);
    std::vector<Mat> maps(variants.size());
    for (int run = 0; run < runs; run++)
        for (size_t i = 0; i < variants.size(); i++)
        {
            const std::clock_t start = std::clock();
            matchers[i]->compute(pair.left, pair.right, maps[i]);
            seconds[i] = std::min(seconds[i], double(std::clock() - start) / CLOCKS_PER_SEC);
        }
    for (size_t i = 0; i < variants.size(); i++)
    {
        const Mat map = restoreMap(change, toPixels(maps[i], 0), original.left.size());
        const Score score = scoreMap(map, truth);
        variants[i].error1 += score.error1;
        variants[i].error2 += score.error2;
        variants[i].relativeTime += seconds[i] / seconds[0];
    }
}

static int run(const CommandLineParser& parser)
{
    setThreads(parser);
    const int runs = getInteger(parser, "runs", 1, 1000);
    const std::vector<HarmlessChange> changes = selectChanges(parser);
    std::vector<int> presets;
    for (const String& name : splitList(parser.get<String>("presets")))
    {
        if (name != "fast" && name != "tree")
            fail("--presets=" + parser.get<String>("presets") + ": neither fast nor tree");
        presets.push_back(presetOf(name));
    }

    std::vector<Scene> scenes;
    for (const Scene& scene : findScenes(parser.get<String>("@root")))
        if (!scene.truth.empty() && !scene.isFrame)
            scenes.push_back(scene);
    if (scenes.empty())
        fail(parser.get<String>("@root") + ": no Middlebury pairs with truth");

    for (const int preset : presets)
    {
        std::vector<Variant> variants = variantsOf(preset);
        for (const Scene& scene : scenes)
        {
            std::cerr << variants[0].name << ": " << scene.set << "/" << scene.name << std::endl;
            const Pair pair = readPair(scene);
            for (const HarmlessChange& change : changes)
                measure(changePair(change, pair, scene.name), change, pair, preset, runs, variants);
            if (changes.empty())
                measure(pair, HarmlessChange(), pair, preset, runs, variants);
        }
        const double pairs = double(scenes.size()) * (double)std::max<size_t>(changes.size(), 1);
        std::cout << "| " << variants[0].name << " with | err>=1 % | err>=2 % | time |\n|---|---|---|---|\n";
        for (const Variant& v : variants)
            std::cout << format("| %s | %.2f | %.2f | %.2f |\n", v.name.c_str(), v.error1 / pairs, v.error2 / pairs,
                                v.relativeTime / pairs);
        std::cout << std::endl;
    }
    return 0;
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, KEYS,
                      "What each parameter does to speed and accuracy: mean errors over all pairs, and the "
                      "processor time as a multiple of the preset's.\n",
                      { "changes=" }, 1, run);
}
