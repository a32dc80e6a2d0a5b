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
#include "evaluation/methods.hpp"
#include "evaluation/scores.hpp"

using namespace cv;
using namespace hdp_tools;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?  |           | print this and exit }"
    "{@root     |           | folder of Middlebury pairs with truth, see hdp_evaluate }"
    "{presets   | fast,tree | those to change: fast, tree or both }"
    "{runs      | 3         | how often a pair is matched in each way, in turns; the shortest times count }"
    "{threads   |           | number of threads; all processors if not given }";

//! A preset, or a preset with one change
struct Variant
{
    String name;
    std::function<void(HDPTreeMatcher&)> change;
    double error1, error2, relativeTime; // sums over the pairs
};

static void addChange(std::vector<Variant>& variants, const String& name,
                      const std::function<void(HDPTreeMatcher::Params&)>& changeParams)
{
    const auto change = [=](HDPTreeMatcher& matcher) {
        HDPTreeMatcher::Params params = matcher.getParams();
        changeParams(params);
        matcher.setParams(params);
    };
    variants.push_back({ name, change, 0, 0, 0 });
}

//! One for each value of a parameter
template <typename Value>
static void add(std::vector<Variant>& variants, const String& parameter, Value HDPTreeMatcher::Params::*field,
                const std::vector<Value>& values)
{
    for (const Value value : values)
    {
        std::ostringstream name;
        name << std::boolalpha << parameter << " = " << value;
        addChange(variants, name.str(), [=](HDPTreeMatcher::Params& p) { p.*field = value; });
    }
}

static void addTree(std::vector<Variant>& variants, const String& name, const Ptr<stereo::TreeStrategy>& strategy)
{
    addChange(variants, "treeStrategy = " + name, [=](HDPTreeMatcher::Params& p) { p.treeStrategy = strategy; });
}

//! What a preset is changed to; the first one is the preset itself.
static std::vector<Variant> variantsOf(int preset)
{
    typedef HDPTreeMatcher M;
    typedef M::Params P;
    std::vector<Variant> variants(1, { "PRESET_FAST", [](M&) {}, 0, 0, 0 });
    add<int>(variants, "blockSize", &P::blockSize, { 3, 5 });
    add<int>(variants, "disparityMedianSize", &P::disparityMedianSize, { 0, 3, 7 });
    add<int>(variants, "disparityMedianPasses", &P::disparityMedianPasses, { 2 });
    add<double>(variants, "gamma", &P::gamma, { 10, 40 });
    add<bool>(variants, "fillOcclusions", &P::fillOcclusions, { false });
    add<bool>(variants, "useSubpixel", &P::useSubpixel, { false });
    add<int>(variants, "maxRowOffset", &P::maxRowOffset, { 0 });
    add<bool>(variants, "useLightAlignment", &P::useLightAlignment, { false });
    add<double>(variants, "noiseThreshold", &P::noiseThreshold, { 0, 1 });
    variants.push_back(
        { "numDisparities twice as large", [](M& m) { m.setNumDisparities(2 * m.getNumDisparities()); }, 0, 0, 0 });
    if (preset == M::PRESET_FAST) // each has one of the two
        addTree(variants, "createMinimumSpanningTree()", stereo::createMinimumSpanningTree());
    else
        addTree(variants, "createSegmentTree()", stereo::createSegmentTree());
    addTree(variants, "createRandomTree()", stereo::createRandomTree());
    if (preset == M::PRESET_FAST)
    {
        add<int>(variants, "finestLayer", &P::finestLayer, { 1, 2 });
        add<int>(variants, "scanlinePasses", &P::scanlinePasses, { 2, 3 });
        addChange(variants, "topAggregation = AGGREGATION_TREES",
                  [](P& p) { p.topAggregation = M::AGGREGATION_TREES; });
        add<int>(variants, "maxTopDisparities", &P::maxTopDisparities, { 16, 64 });
        add<int>(variants, "P1", &P::P1, { 8, 32 });
        add<int>(variants, "P2", &P::P2, { 35, 100 });
    }
    else
    {
        variants[0].name = "PRESET_TREE";
        addChange(variants, "aggregation = AGGREGATION_TREES", [](P& p) { p.aggregation = M::AGGREGATION_TREES; });
        add<bool>(variants, "useNonLocalRefinement", &P::useNonLocalRefinement, { true });
        add<int>(variants, "maxTopDisparities", &P::maxTopDisparities, { 32, 128 });
        add<double>(variants, "delta0", &P::delta0, { 0.005, 0.08 });
        add<double>(variants, "beta", &P::beta, { 0.6, 0.98 });
        add<int>(variants, "intervalMargin", &P::intervalMargin, { 0, 4 });
        addChange(variants, "disparityPrior = PRIOR_SUPPORT_POINTS",
                  [](P& p) { p.disparityPrior = M::PRIOR_SUPPORT_POINTS; });
        add<bool>(variants, "usePrediction", &P::usePrediction, { false });
        addChange(variants, "matchingCost = COST_COLOR_GRADIENT, blockSize = 1", [](P& p) {
            p.matchingCost = M::COST_COLOR_GRADIENT;
            p.blockSize = 1;
            p.aggregation = M::AGGREGATION_TREES; // the others need the census
            p.fillOcclusions = false;
        });
    }
    return variants;
}

//! Matches a pair in all ways, in turns, and takes the processor time of all threads: so it matters little what else the
//! computer does.
static void measure(const Pair& pair, int preset, int runs, std::vector<Variant>& variants)
{
    std::vector<Ptr<HDPTreeMatcher>> matchers;
    for (const Variant& variant : variants)
    {
        matchers.push_back(HDPTreeMatcher::create(0, pair.disparities.size(), preset));
        variant.change(*matchers.back());
    }
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
        const Score score = scoreMap(toPixels(maps[i], 0), pair);
        variants[i].error1 += score.error1;
        variants[i].error2 += score.error2;
        variants[i].relativeTime += seconds[i] / seconds[0];
    }
}

static int run(const CommandLineParser& parser)
{
    setThreads(parser);
    const int runs = getInteger(parser, "runs", 1, 1000);
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
            measure(readPair(scene), preset, runs, variants);
        }
        const double pairs = double(scenes.size());
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
                      {}, 1, run);
}
