// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"
#include "synthetic_video.hpp"

#include <atomic>
#include <thread>

namespace opencv_test { namespace {

const int disparities = 24;

//! Sets the number of threads, and restores it.
class ThreadCount
{
public:
    explicit ThreadCount(int count) : before_(cv::getNumThreads()) { cv::setNumThreads(count); }
    ~ThreadCount() { cv::setNumThreads(before_); }

private:
    int before_;
};

//! Runs body(0) .. body(count - 1) at once, each in a thread of its own.
template <typename Body> void runAtOnce(int count, const Body& body)
{
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i)
        threads.push_back(std::thread([&body, i] { body(i); }));
    for (std::thread& thread : threads)
        thread.join();
}

//! Large enough for several stripes of each stage
const std::vector<SyntheticPair>& testPairs()
{
    static const std::vector<SyntheticPair> pairs{ makeSyntheticPair(Size(131, 270), disparities, 71),
                                                   makeSyntheticPair(Size(60, 41), disparities, 72),
                                                   makeSyntheticPair(Size(233, 140), disparities, 73) };
    return pairs;
}

const int matchers = 8;

//! One of eight systems that use all of the stages, with a strategy and a model that all of them share
Ptr<HDPTreeMatcher> createMatcher(int i)
{
    static const Ptr<TreeStrategy> strategies[] = { createMinimumSpanningTree(), createSegmentTree(),
                                                    createRandomTree(3) };
    static const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
    const Ptr<HDPTreeMatcher> matcher = createSystem(presets[i % 5], disparities);
    matcher->setTreeStrategy(strategies[i % 3]);
    change(*matcher, [&](Params& p) {
        p.predictionModel = model;
        p.usePrediction = i != 5;
        p.useNonLocalRefinement = i >= 4;
        p.useMedianPrefilter = i % 2 == 1;
    });
    matcher->setDisp12MaxDiff(i % 2);
    matcher->setSpeckleWindowSize(i % 4 == 3 ? 20 : 0);
    matcher->setSpeckleRange(1);
    return matcher;
}

struct Result
{
    Mat disparity, confidence, trees, intervals;
    std::vector<double> priors[3], ratios;
    Mat layers[3];
};

Result computeAll(HDPTreeMatcher& matcher, const SyntheticPair& pair)
{
    Result result;
    matcher.compute(pair.left, pair.right, result.disparity);
    matcher.getConfidence(result.confidence);
    matcher.getForest(result.trees, result.intervals);
    for (int layer = 0; layer < 3; ++layer)
    {
        matcher.getLayerPrior(layer, result.priors[layer]);
        matcher.getLayerDisparity(layer, result.layers[layer]);
    }
    result.ratios = matcher.getFindings().searchRatios;
    return result;
}

void expectEqual(const Result& expected, const Result& actual)
{
    expectIdentical(expected.disparity, actual.disparity);
    expectIdentical(expected.confidence, actual.confidence);
    expectIdentical(expected.trees, actual.trees);
    expectIdentical(expected.intervals, actual.intervals);
    for (int layer = 0; layer < 3; ++layer)
    {
        EXPECT_EQ(expected.priors[layer], actual.priors[layer]);
        ASSERT_EQ(expected.layers[layer].empty(), actual.layers[layer].empty());
        if (!expected.layers[layer].empty())
            expectIdentical(expected.layers[layer], actual.layers[layer]);
    }
    EXPECT_EQ(expected.ratios, actual.ratios);
}

std::vector<Result> computePairs(int i)
{
    const Ptr<HDPTreeMatcher> matcher = createMatcher(i);
    std::vector<Result> results;
    for (const SyntheticPair& pair : testPairs())
        results.push_back(computeAll(*matcher, pair));
    return results;
}

//! The maps of a video whose camera moves after some frames
std::vector<Mat> computeVideo(int i)
{
    const Board board = { Rect2d(80, 30, 50, 60), 16, 3 };
    SyntheticVideo video(Size(200, 140), 8.3, 3);
    const Ptr<HDPTreeMatcher> matcher = createMatcher(i);
    change(*matcher, [&](Params& p) { p.matchingCost = HDPTreeMatcher::COST_CENSUS; });
    matcher->setBlockSize(5);
    matcher->setUseTemporalPrediction(true);
    std::vector<Mat> maps;
    for (int k = 0; k < 5; ++k)
    {
        const SyntheticFrame frame =
            video.render(k, std::vector<Board>(1, board), Point3d(0.1, 0.05, 0.0005) * std::max(k - 2, 0));
        maps.push_back(match(*matcher, frame.left, frame.right));
    }
    return maps;
}

TEST(HDPStereo_Threads, videos_in_four_threads)
{
    const int videos = 4;
    std::vector<std::vector<Mat>> expected, actual(videos);
    for (int i = 0; i < videos; ++i)
        expected.push_back(computeVideo(i));
    runAtOnce(videos, [&](int i) { actual[i] = computeVideo(i); });
    for (int i = 0; i < videos; ++i)
        for (size_t k = 0; k < expected[i].size(); ++k)
            expectIdentical(expected[i][k], actual[i][k]);
}

TEST(HDPStereo_Threads, eight_matchers_in_eight_threads)
{
    testPairs(); // made before threads ask for it
    std::vector<std::vector<Result>> expected, actual(matchers);
    for (int i = 0; i < matchers; ++i)
        expected.push_back(computePairs(i));
    runAtOnce(matchers, [&](int i) { actual[i] = computePairs(i); });
    for (int i = 0; i < matchers; ++i)
        for (size_t pair = 0; pair < testPairs().size(); ++pair)
        {
            SCOPED_TRACE(testing::Message() << "matcher " << i << ", pair " << pair);
            expectEqual(expected[i][pair], actual[i][pair]);
        }
}

//! The same map whatever cv::setNumThreads() was given, which stays as it is.
TEST(HDPStereo_Threads, any_number)
{
    const ThreadCount restore(cv::getNumThreads());
    for (int i = 0; i < matchers; ++i)
    {
        std::vector<Result> expected;
        for (int count : { 1, 0, 2, 5, 64, -1 }) // 0: without any; negative: as many as OpenCV likes
        {
            SCOPED_TRACE(testing::Message() << "matcher " << i << ", threads " << count);
            cv::setNumThreads(count);
            const int before = cv::getNumThreads();
            const std::vector<Result> results = computePairs(i);
            EXPECT_EQ(before, cv::getNumThreads());
            if (expected.empty())
                expected = results;
            for (size_t pair = 0; pair < results.size(); ++pair)
                expectEqual(expected[pair], results[pair]);
        }
    }
}

//! What a strategy throws that is no exception of any library
struct OutOfTrees
{
    int calls;
};

//! A tree strategy that throws from one of its methods
class ThrowingTree : public TreeStrategy
{
public:
    enum Method
    {
        ORDER_EDGES,
        MAY_JOIN,
        UNITES_INTERVALS,
        LINKS_TREES,
        NAME,
        NONE
    };
    //! calls: of this method that do not throw; kind: of what is thrown, 0..2
    ThrowingTree(bool byWeight, Method method, int calls, int kind)
        : byWeight_(byWeight), method_(method), left_(calls), kind_(kind)
    {
    }

    bool ordersByWeight() const CV_OVERRIDE { return byWeight_; } // if so, mayJoin() is called in several threads

    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        countCall(ORDER_EDGES);
        const uchar* weight = weights.ptr();
        std::stable_sort(edges.begin(), edges.end(), [weight](int a, int b) { return weight[a] < weight[b]; });
    }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE
    {
        countCall(MAY_JOIN);
        return true;
    }
    bool unitesIntervals() const CV_OVERRIDE
    {
        countCall(UNITES_INTERVALS);
        return true;
    }
    bool linksTrees() const CV_OVERRIDE
    {
        countCall(LINKS_TREES);
        return true;
    }
    String getDefaultName() const CV_OVERRIDE
    {
        countCall(NAME);
        return "test_ThrowingTree";
    }

private:
    void countCall(Method method) const
    {
        if (method != method_ || left_-- > 0)
            return;
        if (kind_ == 0)
            // Not CV_Error(): opencv_ts's handler of errors is not for several threads.
            throw cv::Exception(Error::StsError, "out of trees", CV_Func, __FILE__, __LINE__);
        if (kind_ == 1)
            throw std::runtime_error("out of trees");
        throw OutOfTrees();
    }

    const bool byWeight_;
    const Method method_;
    mutable std::atomic<int> left_;
    const int kind_;
};

template <typename Action> bool throwsAnything(const Action& action)
{
    try
    {
        action();
    }
    catch (...)
    {
        return true;
    }
    return false;
}

//! A matcher whose strategy threw says that it has no pair, and is as good as new.
void expectUsableAfterThrowing(int i, bool byWeight, ThrowingTree::Method method, int calls, int kind)
{
    const SyntheticPair &pair = testPairs()[1], &before = testPairs()[0];
    const Ptr<HDPTreeMatcher> matcher = createMatcher(i);
    const Ptr<TreeStrategy> harmless = makePtr<ThrowingTree>(byWeight, ThrowingTree::NONE, 0, 0);
    matcher->setTreeStrategy(harmless);
    computeAll(*matcher, before); // something to be left over

    matcher->setTreeStrategy(makePtr<ThrowingTree>(byWeight, method, calls, kind));
    Mat disparity;
    const bool isThrown = throwsAnything([&] { matcher->compute(pair.left, pair.right, disparity); });
    if (isThrown)
    {
        EXPECT_TRUE(disparity.empty());
        Mat confidence, trees, intervals;
        matcher->getConfidence(confidence);
        EXPECT_TRUE(confidence.empty());
        matcher->getForest(trees, intervals);
        EXPECT_TRUE(trees.empty() && intervals.empty());
    }
    matcher->setTreeStrategy(harmless);
    const Ptr<HDPTreeMatcher> fresh = createMatcher(i);
    fresh->setTreeStrategy(harmless);
    expectEqual(computeAll(*fresh, pair), computeAll(*matcher, pair));
    // Not every layer asks every method, but the first call of the rules is always made.
    EXPECT_TRUE(isThrown || calls > 0 || method == ThrowingTree::UNITES_INTERVALS ||
                method == ThrowingTree::LINKS_TREES || (byWeight && method == ThrowingTree::ORDER_EDGES));
}

TEST(HDPStereo_Threads, strategy_that_throws)
{
    for (int i = 0; i < matchers; ++i)
        for (ThrowingTree::Method method : { ThrowingTree::ORDER_EDGES, ThrowingTree::MAY_JOIN,
                                             ThrowingTree::UNITES_INTERVALS, ThrowingTree::LINKS_TREES })
            for (int calls : { 0, 500 })
                for (bool byWeight : { false, true })
                {
                    SCOPED_TRACE(testing::Message() << "matcher " << i << ", method " << (int)method << " after "
                                                    << calls << " calls, by weight " << byWeight);
                    expectUsableAfterThrowing(i, byWeight, method, calls, (i + calls) % 3);
                }
}

TEST(HDPStereo_Threads, strategies_that_throw_in_eight_threads)
{
    testPairs();
    runAtOnce(matchers, [](int i) {
        for (int repetition = 0; repetition < 10; ++repetition)
        {
            const ThrowingTree::Method method = repetition % 2 ? ThrowingTree::ORDER_EDGES : ThrowingTree::MAY_JOIN;
            const bool byWeight = repetition % 4 == 0;
            expectUsableAfterThrowing(i, byWeight, method, repetition % 2 ? 0 : 100 * repetition, i % 3);
        }
    });
}

//! A strategy that throws while a file is written leaves the matcher as it was.
TEST(HDPStereo_Threads, strategy_that_throws_in_a_file)
{
    const SyntheticPair& pair = testPairs()[1];
    for (int i = 0; i < matchers; ++i)
    {
        const Ptr<HDPTreeMatcher> matcher = createMatcher(i);
        const std::string library = serialized(*matcher);
        const Result expected = computeAll(*matcher, pair);
        matcher->setTreeStrategy(makePtr<ThrowingTree>(false, ThrowingTree::NAME, 0, i % 3));
        EXPECT_TRUE(throwsAnything([&] { serialized(*matcher); }));
        deserialize(library, *matcher); // does not need to know what the strategy before is called
        EXPECT_EQ(library, serialized(*matcher));
        expectEqual(expected, computeAll(*matcher, pair));
    }
}

}} // namespace opencv_test
