// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

//! A matcher without a single value of any preset or a default one
Ptr<HDPTreeMatcher> createUnusualMatcher()
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(-3, 21, HDPTreeMatcher::PRESET_PAPER);
    matcher->setBlockSize(3);
    matcher->setSpeckleWindowSize(9);
    matcher->setSpeckleRange(2);
    matcher->setDisp12MaxDiff(4);
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    model->addLayer(std::vector<double>(1, 0.375), std::vector<double>(1, 1.25), std::vector<double>(1, 1.));
    change(*matcher, [&](Params& p) {
        p.treeStrategy = createSegmentTree(333.5);
        p.maxRowOffset = 7;
        p.useLightAlignment = true;
        p.noiseThreshold = 4.5;
        p.useTemporalPrediction = true;
        p.usePrediction = false;
        p.useMedianPrefilter = true;
        p.numLayers = 2;
        p.maxTopDisparities = 48;
        p.predictionModel = model;
        p.delta0 = 0.03125;
        p.beta = 0.75;
        p.gamma = 19.5;
        p.colorTruncation = 7.5;
        p.gradientTruncation = 3.25;
        p.colorWeight = 0.25;
        p.disparityMedianSize = 3;
        p.matchingCost = HDPTreeMatcher::COST_CENSUS;
        p.disparityPrior = HDPTreeMatcher::PRIOR_UPPER_LAYER;
        p.intervalMargin = 2;
        p.useSubpixel = true;
        p.aggregation = HDPTreeMatcher::AGGREGATION_SCANLINES;
        p.topAggregation = HDPTreeMatcher::AGGREGATION_TREE_SCANLINES;
        p.P1 = 9;
        p.P2 = 44;
        p.scanlinePasses = 3;
        p.finestLayer = 2;
        p.useNonLocalRefinement = true;
        p.fillOcclusions = true;
    });
    return matcher;
}

Mat matchTestPair(HDPTreeMatcher& matcher)
{
    static const SyntheticPair pair = makeSyntheticPair(Size(80, 60), 16, 6);
    return match(matcher, pair.left, pair.right);
}

TEST(HDPStereo_MatcherStorage, write_and_read)
{
    for (const char* extension : { "yml", "xml", "json" })
        for (bool usePrediction : { false, true })
        {
            SCOPED_TRACE(testing::Message() << extension << ", prediction " << usePrediction);
            const Ptr<HDPTreeMatcher> written = createUnusualMatcher(), read = HDPTreeMatcher::create();
            change(*written, [&](Params& p) { p.usePrediction = usePrediction; });
            deserialize(serialized(*written, extension), *read);
            EXPECT_EQ(serialized(*written), serialized(*read));

            const Params params = read->getParams();
            EXPECT_EQ(-3, read->getMinDisparity());
            EXPECT_EQ(21, read->getNumDisparities());
            EXPECT_EQ(3, read->getBlockSize());
            EXPECT_EQ(9, read->getSpeckleWindowSize());
            EXPECT_EQ(2, read->getSpeckleRange());
            EXPECT_EQ(4, read->getDisp12MaxDiff());
            EXPECT_EQ(createSegmentTree()->getDefaultName(), read->getTreeStrategy()->getDefaultName());
            EXPECT_EQ(usePrediction, params.usePrediction);
            EXPECT_TRUE(params.useMedianPrefilter);
            EXPECT_EQ(2, params.numLayers);
            EXPECT_EQ(48, params.maxTopDisparities);
            EXPECT_EQ(7, read->getMaxRowOffset());
            EXPECT_TRUE(read->getUseLightAlignment());
            EXPECT_EQ(4.5, read->getNoiseThreshold());
            ASSERT_FALSE(params.predictionModel.empty());
            EXPECT_EQ(1, params.predictionModel->getNumLayers());
            EXPECT_EQ(0.03125, params.delta0);
            EXPECT_EQ(0.75, params.beta);
            EXPECT_EQ(19.5, params.gamma);
            EXPECT_EQ(7.5, params.colorTruncation);
            EXPECT_EQ(3.25, params.gradientTruncation);
            EXPECT_EQ(0.25, params.colorWeight);
            EXPECT_EQ(3, params.disparityMedianSize);
            EXPECT_EQ((int)HDPTreeMatcher::COST_CENSUS, params.matchingCost);
            EXPECT_EQ((int)HDPTreeMatcher::PRIOR_UPPER_LAYER, params.disparityPrior);
            EXPECT_EQ(2, params.intervalMargin);
            EXPECT_TRUE(params.useSubpixel);
            EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_SCANLINES, params.aggregation);
            EXPECT_EQ((int)HDPTreeMatcher::AGGREGATION_TREE_SCANLINES, params.topAggregation);
            EXPECT_EQ(9, params.P1);
            EXPECT_EQ(44, params.P2);
            EXPECT_EQ(3, params.scanlinePasses);
            EXPECT_EQ(2, params.finestLayer);
            EXPECT_TRUE(params.useNonLocalRefinement);
            EXPECT_TRUE(read->getUseTemporalPrediction());
            EXPECT_TRUE(params.fillOcclusions);
            expectIdentical(matchTestPair(*written), matchTestPair(*read));
        }
}

TEST(HDPStereo_MatcherStorage, presets_without_model)
{
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> written = createSystem(preset, 16), read = createUnusualMatcher();
        deserialize(serialized(*written), *read);
        EXPECT_EQ(serialized(*written), serialized(*read));
        EXPECT_TRUE(read->getParams().predictionModel.empty());
        expectIdentical(matchTestPair(*written), matchTestPair(*read));
    }
}

TEST(HDPStereo_MatcherStorage, save_and_load)
{
    const Ptr<HDPTreeMatcher> written = createUnusualMatcher(), read = HDPTreeMatcher::create();
    const TemporaryFile file(".xml");
    written->save(file.name);
    FileStorage fs(file.name, FileStorage::READ);
    read->read(fs[written->getDefaultName()]);
    fs.release();
    EXPECT_EQ(serialized(*written), serialized(*read));
}

TEST(HDPStereo_MatcherStorage, strategies_with_their_parameters)
{
    const std::vector<Ptr<TreeStrategy>> strategies{ createMinimumSpanningTree(), createSegmentTree(5.5),
                                                     createRandomTree(99) };
    for (const Ptr<TreeStrategy>& strategy : strategies)
    {
        const Ptr<HDPTreeMatcher> written = HDPTreeMatcher::create(0, 16), read = HDPTreeMatcher::create();
        written->setTreeStrategy(strategy);
        read->setTreeStrategy(createRandomTree(5));
        deserialize(serialized(*written), *read);
        EXPECT_EQ(strategy->getDefaultName(), read->getTreeStrategy()->getDefaultName());
        EXPECT_EQ(serialized(*strategy), serialized(*read->getTreeStrategy()));
        expectIdentical(matchTestPair(*written), matchTestPair(*read));
    }
}

//! A file cannot hold a user's class, so that the reader must have one of its name.
class OwnTree : public TreeStrategy
{
public:
    void orderEdges(const Mat&, std::vector<int>&) const CV_OVERRIDE {}
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
    String getDefaultName() const CV_OVERRIDE { return "test_OwnTree"; }
};

TEST(HDPStereo_MatcherStorage, strategy_of_a_user)
{
    const Ptr<HDPTreeMatcher> written = createUnusualMatcher(), read = HDPTreeMatcher::create();
    written->setTreeStrategy(makePtr<OwnTree>());
    const std::string before = serialized(*read);
    EXPECT_THROW(deserialize(serialized(*written), *read), cv::Exception);
    EXPECT_EQ(before, serialized(*read));

    const Ptr<TreeStrategy> own = makePtr<OwnTree>();
    read->setTreeStrategy(own);
    deserialize(serialized(*written), *read);
    EXPECT_EQ(own.get(), read->getTreeStrategy().get());
    EXPECT_EQ(serialized(*written), serialized(*read));
}

//! Reading must throw and leave the matcher as it was.
void expectUnreadable(const std::string& text)
{
    SCOPED_TRACE(text);
    const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
    const Ptr<TreeStrategy> strategy = matcher->getTreeStrategy();
    const Ptr<DisparityPredictionModel> model = matcher->getParams().predictionModel;
    const std::string before = serialized(*matcher);
    EXPECT_THROW(deserialize(text, *matcher), cv::Exception);
    EXPECT_EQ(before, serialized(*matcher));
    EXPECT_EQ(strategy.get(), matcher->getTreeStrategy().get());
    EXPECT_EQ(model.get(), matcher->getParams().predictionModel.get());
}

//! A YAML text with the value of a key replaced; an empty value leaves the whole line out.
std::string withValue(const std::string& text, const std::string& key, const std::string& value)
{
    std::istringstream in(text);
    std::ostringstream out;
    bool found = false;
    for (std::string line; std::getline(in, line);)
    {
        const size_t start = line.find_first_not_of(' ');
        if (!found && start != std::string::npos && line.compare(start, key.size() + 1, key + ":") == 0)
        {
            found = true;
            if (!value.empty())
                out << line.substr(0, start) << key << ": " << value << "\n";
        }
        else
            out << line << "\n";
    }
    CV_Assert(found);
    return out.str();
}

TEST(HDPStereo_MatcherStorage, garbage_and_foreign_nodes)
{
    expectUnreadable("");
    expectUnreadable("%YAML:1.0\n---\n");
    expectUnreadable("%YAML:1.0\n---\nname: 5\n");
    expectUnreadable("%YAML:1.0\n---\n- 1\n- 2\n");
    expectUnreadable(serialized(*StereoSGBM::create()));
    expectUnreadable(serialized(*DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL)));
    expectUnreadable(withValue(serialized(*createUnusualMatcher()), "name", "\"StereoMatcher.HDP\""));

    const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
    const std::string before = serialized(*matcher);
    EXPECT_THROW(matcher->read(FileNode()), cv::Exception);
    EXPECT_EQ(before, serialized(*matcher));
}

TEST(HDPStereo_MatcherStorage, hostile_values)
{
    const std::string text = serialized(*createUnusualMatcher());
    const struct
    {
        const char *key, *values[8];
    } hostile[] = {
        { "numDisparities", { "-1", "-2147483648", "1.5", 0 } },
        { "blockSize", { "3.5", 0 } },
        { "speckleWindowSize", { "1.5", 0 } },
        { "speckleRange", { "-1", "0.5", 0 } },
        { "minDisparity", { "0.5", 0 } },
        { "disp12MaxDiff", { "0.5", 0 } },
        { "usePrediction", { "0.5", 0 } },
        { "useMedianPrefilter", { "0.5", 0 } },
        { "numLayers", { "0", "-1", "17", "2147483647", "1.5", 0 } },
        { "maxTopDisparities", { "-1", "-2147483648", "1.5", 0 } },
        { "maxRowOffset", { "-1", "-2147483648", "1.5", 0 } },
        { "noiseThreshold", { "-1.", "-1e-3", ".Nan", ".Inf", 0 } },
        { "disparityMedianSize", { "1", "2", "-2", "4", "9", "2147483647", 0 } },
        { "matchingCost", { "-1", "2", "2147483647", "0.5", 0 } },
        { "disparityPrior", { "-1", "2", "2147483647", "0.5", 0 } },
        { "intervalMargin", { "-1", "65", "2147483647", "0.5", 0 } },
        { "useSubpixel", { "0.5", 0 } },
        { "aggregation", { "-1", "3", "2147483647", "0.5", 0 } },
        { "topAggregation", { "-1", "3", "2147483647", "0.5", 0 } },
        { "P1", { "-1", "101", "2147483647", "0.5", 0 } },
        { "P2", { "-1", "101", "2147483647", "0.5", 0 } },
        { "scanlinePasses", { "0", "-1", "5", "2147483647", "0.5", 0 } },
        { "finestLayer", { "-1", "16", "2147483647", "0.5", 0 } },
        { "useNonLocalRefinement", { "0.5", 0 } },
        { "useTemporalPrediction", { "0.5", 0 } },
        { "fillOcclusions", { "0.5", 0 } },
        { "delta0", { "-0.5", "1.", "1e300", 0 } },
        { "beta", { "-0.5", "1.5", "-1e300", 0 } },
        { "gamma", { "0", "0.", "-19.5", 0 } },
        { "colorTruncation", { "-1", "-1e300", 0 } },
        { "gradientTruncation", { "-1", "-1e300", 0 } },
        { "colorWeight", { "-0.1", "1.1", "1e300", 0 } },
        { "k", { "-1.", "-1", 0 } },
        { "sigmas", { "[ -1.25 ]", "[ 0. ]", "[ .Nan ]", "[ .Inf ]", "[ ]", "[ 1., 1. ]", 0 } },
        { "means", { "[ .Nan ]", "[ -.Inf ]", "[ ]", "[ 0., 1. ]", 0 } },
        { "weights", { "[ 2. ]", "[ 0. ]", "[ -1. ]", "[ .Nan ]", "[ 1e300 ]", "[ ]", 0 } },
    };
    for (const auto& h : hostile)
    {
        for (const char* const* value = h.values; *value; ++value)
            expectUnreadable(withValue(text, h.key, *value));
        for (const char* value : { ".Nan", ".Inf", "-.Inf", "\"7\"", "{ a: 1 }", "[ [ 1. ] ]" })
            expectUnreadable(withValue(text, h.key, value));
    }
    const std::string random = [] {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create();
        matcher->setTreeStrategy(createRandomTree(3));
        return serialized(*matcher);
    }();
    for (const char* value : { "-1", "1.5", ".Nan", "\"3\"", "[ 3 ]" })
        expectUnreadable(withValue(random, "seed", value));
}

TEST(HDPStereo_MatcherStorage, missing_keys)
{
    const std::string text = serialized(*createUnusualMatcher());
    for (const char* key : { "name", "strategy", "k", "means", "sigmas", "weights" })
        expectUnreadable(withValue(text, key, ""));

    // A number that a file does not have gets the paper's value.
    const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
    const Ptr<HDPTreeMatcher> defaults = HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_PAPER);
    deserialize(withValue(text, "gamma", ""), *matcher);
    EXPECT_EQ(defaults->getParams().gamma, matcher->getParams().gamma);
    deserialize(withValue(text, "numDisparities", ""), *matcher);
    EXPECT_EQ(defaults->getNumDisparities(), matcher->getNumDisparities());
    EXPECT_EQ(19.5, matcher->getParams().gamma);
}

TEST(HDPStereo_MatcherStorage, one_parameter_alone)
{
    Params expected(HDPTreeMatcher::PRESET_PAPER), params;
    expected.P1 = 7;
    const Ptr<HDPTreeMatcher> paper = HDPTreeMatcher::create(0, 64, HDPTreeMatcher::PRESET_PAPER),
                              read = createUnusualMatcher(), matcher = createUnusualMatcher();
    paper->setParams(expected);
    params.read(FileStorage("{ \"P1\": 7 }", FileStorage::READ | FileStorage::MEMORY).root());
    read->setParams(params);
    deserialize("{ \"name\": \"StereoMatcher.HDPTree\", \"P1\": 7 }", *matcher);
    EXPECT_EQ(serialized(*paper), serialized(*matcher));
    EXPECT_EQ(7, read->getParams().P1);
    EXPECT_EQ(paper->getTreeStrategy()->getDefaultName(), read->getTreeStrategy()->getDefaultName());
    expectRejected([&] { params.read(FileNode()); }, "parameters must be a map");
}

//! A file that knows nothing of the parameters that later versions have means the paper's system.
TEST(HDPStereo_MatcherStorage, file_of_the_first_version)
{
    const char* const added[] = { "matchingCost",
                                  "disparityPrior",
                                  "intervalMargin",
                                  "useSubpixel",
                                  "aggregation",
                                  "topAggregation",
                                  "P1",
                                  "P2",
                                  "maxTopDisparities",
                                  "maxRowOffset",
                                  "useLightAlignment",
                                  "noiseThreshold",
                                  "scanlinePasses",
                                  "finestLayer",
                                  "useNonLocalRefinement",
                                  "useTemporalPrediction",
                                  "fillOcclusions" };
    const Ptr<HDPTreeMatcher> paper = HDPTreeMatcher::create(3, 19, HDPTreeMatcher::PRESET_PAPER);
    std::string text = serialized(*paper);
    for (const char* key : added)
        text = withValue(text, key, "");
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 64);
        deserialize(text, *matcher);
        EXPECT_EQ(serialized(*paper), serialized(*matcher)) << "read by " << preset.name;
    }
}

//! The name in files was another one in version 1.0.
TEST(HDPStereo_MatcherStorage, name_in_files)
{
    const std::string text = serialized(*createUnusualMatcher());
    EXPECT_NE(std::string::npos, text.find("StereoMatcher.HDPTree"));
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create();
    deserialize(withValue(text, "name", "\"hdpstereo_HDPTreeMatcher\""), *matcher);
    EXPECT_EQ(text, serialized(*matcher));
}

TEST(HDPStereo_MatcherStorage, params_alone)
{
    const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
    const auto written = [](const Params& params) {
        FileStorage fs(".yml", FileStorage::WRITE | FileStorage::MEMORY);
        params.write(fs);
        return fs.releaseAndGetString();
    };
    const std::string text = written(matcher->getParams());
    for (const std::string& source : { text, serialized(*matcher) }) // a file of the matcher has them, too
    {
        Params params;
        params.read(FileStorage(source, FileStorage::READ | FileStorage::MEMORY).root());
        EXPECT_EQ(text, written(params));
    }

    Params params;
    const std::string before = written(params);
    FileStorage bad(withValue(text, "gamma", "-1."), FileStorage::READ | FileStorage::MEMORY);
    expectRejected([&] { params.read(bad.root()); }, "gamma must be finite and > 0, not -1");
    EXPECT_EQ(before, written(params));
    params.treeStrategy = Ptr<TreeStrategy>();
    expectRejected([&] { written(params); }, "treeStrategy");
}

//! A key that is no parameter's name is no one's value.
TEST(HDPStereo_MatcherStorage, unknown_keys)
{
    std::string text = serialized(*createUnusualMatcher());
    const size_t key = text.find("\nP1:");
    ASSERT_NE(std::string::npos, key);
    text.replace(key, 4, "\nsmallPenalty:");
    const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
    deserialize(text, *matcher);
    EXPECT_EQ(16, matcher->getParams().P1);
    EXPECT_EQ(44, matcher->getParams().P2);
}

TEST(HDPStereo_MatcherStorage, unknown_strategy)
{
    const std::string text = serialized(*createUnusualMatcher());
    expectUnreadable(withValue(text, "strategy", "\"no_such_tree\""));
    expectUnreadable(withValue(text, "strategy", "\"\""));
    expectUnreadable(withValue(text, "strategy", "5"));
}

TEST(HDPStereo_MatcherStorage, truncated_text)
{
    const std::string text = serialized(*createUnusualMatcher());
    for (size_t length = 0; length < text.size(); length += 7)
    {
        const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
        const std::string before = serialized(*matcher);
        try
        {
            deserialize(text.substr(0, length), *matcher); // may be complete but for values that have defaults
        }
        catch (const cv::Exception&)
        {
            EXPECT_EQ(before, serialized(*matcher)) << "cut at " << length;
        }
        matcher->setUseTemporalPrediction(false); // needs the cost, whose default is another
        EXPECT_NO_THROW(matchTestPair(*matcher)) << "cut at " << length;
    }
}

//! One of many ways to spoil a file.
std::string spoilt(std::string text, RNG& rng)
{
    const char* const pieces[] = { "-1",
                                   "99999999999999999999",
                                   "1e999",
                                   ".Nan",
                                   "\"",
                                   "[",
                                   "]",
                                   "{",
                                   "}",
                                   ":",
                                   ",",
                                   "\n",
                                   "\0",
                                   "<",
                                   "</",
                                   ">",
                                   "<!--",
                                   "&",
                                   "*",
                                   "- ",
                                   "null",
                                   "!!",
                                   "type_id=\"binary\"",
                                   "%YAML" };
    const int count = (int)(sizeof(pieces) / sizeof(pieces[0]));
    for (int i = rng.uniform(1, 4); i > 0 && !text.empty(); --i)
    {
        const size_t at = (size_t)rng.uniform(0, (int)text.size());
        switch (rng.uniform(0, 4))
        {
        case 0:
            text[at] = (char)rng.uniform(1, 256);
            break;
        case 1:
            text.erase(at, (size_t)rng.uniform(1, 40));
            break;
        case 2:
            text.insert(at, pieces[rng.uniform(0, count)]);
            break;
        default: {
            const char* const piece = pieces[rng.uniform(0, count)];
            text.replace(at, (size_t)rng.uniform(1, 5), piece);
        }
        }
    }
    return text;
}

//! Reading takes all of a file or nothing, of a matcher and of a model, and both work afterwards.
TEST(HDPStereo_MatcherStorage, spoilt_files_of_every_format)
{
    RNG rng(91);
    int refused = 0;
    for (const char* extension : { "yml", "xml", "json" })
    {
        const Ptr<HDPTreeMatcher> matcher = createUnusualMatcher();
        const Ptr<DisparityPredictionModel> model =
            DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
        const std::vector<Algorithm*> algorithms{ matcher.get(), model.get() };
        for (Algorithm* algorithm : algorithms)
        {
            const std::string good = serialized(*algorithm, extension);
            for (int i = 0; i < 300; ++i)
            {
                const std::string text = spoilt(good, rng), before = serialized(*algorithm);
                SCOPED_TRACE(text);
                FileStorage fs;
                try
                {
                    fs.open(text, FileStorage::READ | FileStorage::MEMORY);
                }
                catch (const std::exception&) // OpenCV's parser has exceptions of other types, too
                {
                    ++refused;
                    continue;
                }
                try
                {
                    algorithm->read(fs.root());
                    deserialize(good, *algorithm);
                }
                catch (const cv::Exception&)
                {
                    EXPECT_EQ(before, serialized(*algorithm));
                    ++refused;
                }
                EXPECT_EQ(good, serialized(*algorithm, extension));
            }
        }
        EXPECT_NO_THROW(matchTestPair(*matcher));
    }
    EXPECT_GT(refused, 500); // of 1800
}

}} // namespace opencv_test
