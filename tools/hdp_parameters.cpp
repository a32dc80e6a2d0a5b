// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What each parameter of HDPTreeMatcher does to speed and accuracy: changes one at a time in PRESET_FAST and in
// PRESET_TREE, matches all pairs of a dataset, and prints a table of the errors and of the processor time beside the
// preset's own. --sweep does the same for the tuned constants of the library.

#include <ctime>
#include <functional>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>

#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/harmless_changes.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tunables.hpp"

using namespace cv;
using namespace hdp_tools;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?  |           | print this and exit }"
    "{@root     |           | folder of pairs with truth, or of such folders, see hdp_evaluate }"
    "{presets   | fast,tree | those to change: fast, tree or both; with --sweep any }"
    "{changes   |           | errors and times are means over changes that must not matter, the list of hdp_stability "
    "or one's own }"
    "{sweep     |           | instead of the parameters, tuned constants of the library, see --list-tunables: "
    "NAME=VALUE:VALUE, or NAME for half of it and double, separated by commas }"
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
    add<double>(variants, "gamma", &P::gamma, { 10, 40 });
    add<bool>(variants, "fillOcclusions", &P::fillOcclusions, { false });
    add<bool>(variants, "useSubpixel", &P::useSubpixel, { false });
    add<int>(variants, "maxRowOffset", &P::maxRowOffset, { 0 });
    add<bool>(variants, "useLightAlignment", &P::useLightAlignment, { false });
    add<double>(variants, "noiseThreshold", &P::noiseThreshold, { 0, 1 });
    variants.push_back(
        { "numDisparities twice as large", [](M& m) { m.setNumDisparities(2 * m.getNumDisparities()); }, 0, 0, 0 });
    addTree(variants, "createMinimumSpanningTree()", stereo::createMinimumSpanningTree());
    addTree(variants, "createRandomTree()", stereo::createRandomTree());
    if (preset == M::PRESET_FAST)
    {
        add<int>(variants, "finestLayer", &P::finestLayer, { 1, 2 });
        add<int>(variants, "scanlinePasses", &P::scanlinePasses, { 2, 3 });
        addChange(variants, "topAggregation = AGGREGATION_TREES",
                  [](P& p) { p.topAggregation = M::AGGREGATION_TREES; });
        addChange(variants, "topAggregation = AGGREGATION_SCANLINES",
                  [](P& p) { p.topAggregation = M::AGGREGATION_SCANLINES; });
        add<int>(variants, "maxTopDisparities", &P::maxTopDisparities, { 16, 64 });
        add<int>(variants, "P1", &P::P1, { 8, 32 });
        add<int>(variants, "P2", &P::P2, { 35, 100 });
    }
    else
    {
        variants[0].name = "PRESET_TREE";
        addChange(variants, "aggregation = AGGREGATION_TREES", [](P& p) { p.aggregation = M::AGGREGATION_TREES; });
        add<int>(variants, "maxTopDisparities", &P::maxTopDisparities, { 32, 128 });
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

//! A preset, and the same with each value of --sweep
static std::vector<Variant> variantsOf(const String& preset, const std::vector<TunableSetting>& sweep)
{
    std::vector<Variant> variants(1, { preset, [](HDPTreeMatcher&) {}, 0, 0, 0 });
    for (const TunableSetting& setting : sweep)
        variants.push_back({ setting.name + " = " + setting.value, variants[0].change, 0, 0, 0 });
    return variants;
}

//! A setting for as long as this lives
class AppliedSetting
{
public:
    explicit AppliedSetting(const TunableSetting& setting) : before_(applySetting(setting)) {}
    AppliedSetting(const AppliedSetting&) = delete;
    AppliedSetting& operator=(const AppliedSetting&) = delete;
    ~AppliedSetting() { applySetting(before_); }

private:
    TunableSetting before_;
};

//! What is done with the pairs of every set
struct Settings
{
    std::vector<HarmlessChange> changes; // over which errors and times are means
    std::vector<TunableSetting> sweep;   // of all variants but the first one, or none
    int preset, runs;
};

//! Errors by the two figures that the tables of a dataset have
struct Figures
{
    const char* names[2];
    double Score::*figures[2];
};

static Figures figuresOf(Pair::Protocol protocol)
{
    if (protocol == Pair::KITTI)
        return { { "average error, pixels", "D1 %" }, { &Score::average, &Score::d1 } };
    if (protocol == Pair::BAD)
        return { { "bad 1.0 %", "bad 2.0 %" }, { &Score::bad1, &Score::bad2 } };
    return { { "err>=1 %", "err>=2 %" }, { &Score::error1, &Score::error2 } };
}

//! Returns the processor time of all threads: so it matters little what else the computer does.
static double compute(HDPTreeMatcher& matcher, const Pair& pair, Mat& map)
{
    const std::clock_t start = std::clock();
    matcher.compute(pair.left, pair.right, map);
    return double(std::clock() - start) / CLOCKS_PER_SEC;
}

//! Matches a changed pair in all ways, in turns.
static void measure(const Pair& pair, const HarmlessChange& change, const Pair& changed, const Settings& settings,
                    std::vector<Variant>& variants)
{
    std::vector<Ptr<HDPTreeMatcher>> matchers;
    for (const Variant& variant : variants)
    {
        matchers.push_back(HDPTreeMatcher::create(0, changed.disparities.size(), settings.preset));
        variant.change(*matchers.back());
    }
    std::vector<double> seconds(variants.size(), DBL_MAX);
    std::vector<Mat> maps(variants.size());
    for (int run = 0; run < settings.runs; run++)
        for (size_t i = 0; i < variants.size(); i++)
        {
            const bool isSwept = i > 0 && !settings.sweep.empty();
            const std::unique_ptr<AppliedSetting> swept(isSwept ? new AppliedSetting(settings.sweep[i - 1]) : nullptr);
            seconds[i] = std::min(seconds[i], compute(*matchers[i], changed, maps[i]));
        }
    const Pair truth = truthOfChanged(change, pair);
    const Figures figures = figuresOf(pair.protocol);
    for (size_t i = 0; i < variants.size(); i++)
    {
        const Score score = scoreMap(restoreMap(change, toPixels(maps[i], 0), pair.left.size()), truth);
        variants[i].error1 += score.*figures.figures[0];
        variants[i].error2 += score.*figures.figures[1];
        variants[i].relativeTime += seconds[i] / seconds[0];
    }
}

//! A pair as it is, or with each change
static void measure(const Pair& pair, const String& scene, const Settings& settings, std::vector<Variant>& variants)
{
    for (const HarmlessChange& change : settings.changes)
        measure(pair, change, changePair(change, pair, scene), settings, variants);
    if (settings.changes.empty())
        measure(pair, HarmlessChange(), pair, settings, variants);
}

//! A table for the scenes of a set, which have truth of one kind. bad: receives those that are skipped.
static void measureSet(const std::vector<Scene>& scenes, const Settings& settings, std::vector<Variant> variants,
                       std::set<String>& bad)
{
    Pair::Protocol protocol = Pair::NO_TRUTH;
    size_t pairs = 0;
    for (const Scene& scene : scenes)
        try
        {
            std::cerr << variants[0].name << ": " << scene.title() << std::endl;
            const Pair pair = readPair(scene);
            if (pairs > 0)
                expectProtocol(pair, protocol);
            std::vector<Variant> withPair = variants;
            measure(pair, scene.name, settings, withPair);
            variants = withPair;
            protocol = pair.protocol;
            pairs++;
        }
        catch (const std::exception& error)
        {
            std::cerr << "skipped " << scene.title() << ": " << messageOf(error) << std::endl;
            bad.insert(scene.title());
        }
    if (pairs == 0)
        return;
    const Figures figures = figuresOf(protocol);
    const double count = double(pairs * std::max<size_t>(settings.changes.size(), 1));
    std::cout << "| " << scenes[0].set << ": " << variants[0].name << " with | " << figures.names[0] << " | "
              << figures.names[1] << " | time |\n|---|---|---|---|\n";
    for (const Variant& v : variants)
        std::cout << format("| %s | %.2f | %.2f | %.2f |\n", v.name.c_str(), v.error1 / count, v.error2 / count,
                            v.relativeTime / count);
    std::cout << std::endl;
}

//! Those with truth, by set
static std::vector<std::vector<Scene>> findSets(const String& root)
{
    std::vector<std::vector<Scene>> sets;
    for (const Scene& scene : findScenes(root))
    {
        if (scene.truth.empty())
            continue;
        if (sets.empty() || sets.back()[0].set != scene.set)
            sets.push_back(std::vector<Scene>());
        sets.back().push_back(scene);
    }
    if (sets.empty())
        fail(root + ": no pairs with truth");
    return sets;
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    Settings settings;
    settings.runs = getInteger(parser, "runs", 1, 1000);
    settings.changes = selectChanges(parser);
    if (parser.has("sweep"))
        settings.sweep = parseSweep("sweep", parser.get<String>("sweep"));
    const std::vector<String> presets = splitList("presets", parser.get<String>("presets"));
    for (const String& name : presets)
        if (settings.sweep.empty() && name != "fast" && name != "tree")
            fail("--presets=" + parser.get<String>("presets") + ": neither fast nor tree");

    const std::vector<std::vector<Scene>> sets = findSets(parser.get<String>("@root"));
    std::set<String> bad;
    size_t pairs = 0;
    for (const std::vector<Scene>& set : sets)
        pairs += set.size();
    for (const String& name : presets)
    {
        settings.preset = presetOf(name);
        const std::vector<Variant> variants =
            settings.sweep.empty() ? variantsOf(settings.preset) : variantsOf(name, settings.sweep);
        for (const std::vector<Scene>& set : sets)
            measureSet(set, settings, variants, bad);
    }
    return endOfRun(bad.size(), pairs);
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, String(KEYS) + TUNABLE_KEYS,
                      "What each parameter does to speed and accuracy: mean errors over the pairs of each set, and the "
                      "processor time as a multiple of the preset's.\n"
                      "Exit status: 0 if all is well, 2 if a pair was skipped, 1 on other errors.\n",
                      { "changes=" }, 1, run);
}
