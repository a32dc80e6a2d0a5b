// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"

#include <atomic>

namespace opencv_test { namespace {

/////////////////////////////////////////// the library's own ///////////////////////////////////////////

std::vector<int> allEdges(Size size)
{
    std::vector<int> edges;
    for (int e = 0; e < 2 * size.area(); ++e)
        if (e % 2 == 0 ? e / 2 % size.width + 1 < size.width : e / 2 / size.width + 1 < size.height)
            edges.push_back(e);
    return edges;
}

TEST(HDPStereo_TreeStrategy, light_edges_first_then_in_the_order_given)
{
    RNG rng(26);
    const Mat weights = randomImage(rng, Size(40, 30), CV_8UC2, 50);
    std::vector<int> given = allEdges(weights.size());
    std::reverse(given.begin(), given.end());
    given.erase(given.begin() + 10, given.begin() + 200); // what DT-Rule 1 leaves
    std::vector<int> expected = given;
    const uchar* weight = weights.ptr();
    std::stable_sort(expected.begin(), expected.end(), [weight](int a, int b) { return weight[a] < weight[b]; });
    for (const Ptr<TreeStrategy>& strategy : { createMinimumSpanningTree(), createSegmentTree() })
    {
        EXPECT_TRUE(strategy->ordersByWeight());
        std::vector<int> edges = given, none;
        strategy->orderEdges(weights, edges);
        EXPECT_EQ(expected, edges) << strategy->getDefaultName();
        strategy->orderEdges(weights, none);
        EXPECT_TRUE(none.empty());
    }
    EXPECT_FALSE(createRandomTree()->ordersByWeight());
}

TEST(HDPStereo_TreeStrategy, random_order_depends_on_the_seed_alone)
{
    RNG rng(27);
    const Mat weights = randomImage(rng, Size(40, 30), CV_8UC2), others = randomImage(rng, Size(40, 30), CV_8UC2);
    const std::vector<int> given = allEdges(weights.size());
    std::vector<int> edges = given, again = given, other = given;
    createRandomTree(5)->orderEdges(weights, edges);
    createRandomTree(5)->orderEdges(others, again);
    createRandomTree(6)->orderEdges(weights, other);
    EXPECT_EQ(edges, again);
    EXPECT_NE(edges, other);
    std::vector<int> sorted = edges;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(given, sorted) << "not a permutation";

    // A shuffle: each tenth of the order holds edges of each tenth of the image.
    const size_t tenth = given.size() / 10;
    for (size_t i = 0; i < 10; ++i)
    {
        std::vector<int> counts(10, 0);
        for (size_t k = i * tenth; k < (i + 1) * tenth; ++k)
            ++counts[std::min<size_t>(9, (size_t)edges[k] * 10 / (2 * weights.total()))];
        for (int count : counts)
            EXPECT_NEAR(tenth / 10., count, 15);
    }
}

TEST(HDPStereo_TreeStrategy, rule_2)
{
    const TreeState states[] = { { 1, 0 }, { 7, 3 }, { 100, 20 }, { 1200, 11 }, { 1000000, 255 } };
    for (const TreeState& a : states)
        for (const TreeState& b : states)
            for (int weight = 0; weight < 256; ++weight)
            {
                EXPECT_TRUE(createMinimumSpanningTree()->mayJoin(weight, a, b));
                EXPECT_TRUE(createRandomTree()->mayJoin(weight, a, b));
                for (double k : { 0., 50., 1200. })
                {
                    const double limit = std::min(a.maxWeight + k / a.size, b.maxWeight + k / b.size);
                    EXPECT_EQ(weight <= limit, createSegmentTree(k)->mayJoin(weight, a, b))
                        << "k " << k << ", weight " << weight << ", sizes " << a.size << ", " << b.size;
                }
            }
    EXPECT_EQ(createSegmentTree(1200)->mayJoin(40, states[1], states[2]),
              createSegmentTree()->mayJoin(40, states[1], states[2]));
}

TEST(HDPStereo_TreeStrategy, segment_tree_does_not_unite_intervals)
{
    EXPECT_TRUE(createMinimumSpanningTree()->unitesIntervals());
    EXPECT_TRUE(createRandomTree()->unitesIntervals());
    EXPECT_FALSE(createSegmentTree()->unitesIntervals());
    for (const Ptr<TreeStrategy>& strategy : { createMinimumSpanningTree(), createSegmentTree(), createRandomTree() })
        EXPECT_TRUE(strategy->linksTrees());
}

TEST(HDPStereo_TreeStrategy, bad_parameters_are_rejected)
{
    for (double k : { -1., -1e-300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN() })
        expectRejected([&] { createSegmentTree(k); }, "k must");
    for (int seed : { -1, INT_MIN })
        expectRejected([&] { createRandomTree(seed); }, "seed");
    EXPECT_NO_THROW(createSegmentTree(0));
    EXPECT_NO_THROW(createSegmentTree(1e300));
    EXPECT_NO_THROW(createRandomTree(INT_MAX));
}

/////////////////////////////////////////// defined by a user ///////////////////////////////////////////

//! The library's minimum spanning tree a second time
class OwnMinimumSpanningTree : public TreeStrategy
{
public:
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        const uchar* weight = weights.ptr();
        std::stable_sort(edges.begin(), edges.end(), [weight](int a, int b) { return weight[a] < weight[b]; });
    }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
};

//! The library's segment tree a second time
class OwnSegmentTree : public OwnMinimumSpanningTree
{
public:
    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        return weight <= std::min(a.maxWeight + 1200. / a.size, b.maxWeight + 1200. / b.size);
    }
    bool unitesIntervals() const CV_OVERRIDE { return false; }
};

//! Says that light edges come first, and is not asked for their order then.
template <class Tree> class ByWeight : public Tree
{
public:
    using Tree::Tree;
    bool ordersByWeight() const CV_OVERRIDE { return true; }
    void orderEdges(const Mat&, std::vector<int>&) const CV_OVERRIDE
    {
        CV_Error(Error::StsError, "orderEdges was called");
    }
};

//! Horizontal edges first, then the vertical ones
class RowTree : public TreeStrategy
{
public:
    void orderEdges(const Mat&, std::vector<int>& edges) const CV_OVERRIDE
    {
        std::stable_partition(edges.begin(), edges.end(), [](int e) { return e % 2 == 0; });
    }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
};

//! Nothing is joined, so that every pixel decides alone.
class NoTree : public RowTree
{
public:
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return false; }
    bool linksTrees() const CV_OVERRIDE { return false; }
};

const int disparities = 24;

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(121, 90), disparities, 5);
    return pair;
}

Mat matchWith(const Ptr<TreeStrategy>& strategy, bool usePrediction)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, disparities, HDPTreeMatcher::PRESET_PAPER);
    matcher->setTreeStrategy(strategy);
    change(*matcher, [&](Params& p) { p.usePrediction = usePrediction; });
    return match(*matcher, testPair().left, testPair().right);
}

TEST(HDPStereo_UserTreeStrategy, equal_rules_give_the_library_s_maps)
{
    for (bool usePrediction : { false, true })
    {
        const Mat mst = matchWith(createMinimumSpanningTree(), usePrediction);
        const Mat st = matchWith(createSegmentTree(), usePrediction);
        ASSERT_GT(countDifferent(mst, st), 0);
        expectIdentical(mst, matchWith(makePtr<OwnMinimumSpanningTree>(), usePrediction));
        expectIdentical(st, matchWith(makePtr<OwnSegmentTree>(), usePrediction));
        for (int threads : { 1, 2, 4 })
        {
            const ScopedThreads scope(threads);
            expectIdentical(mst, matchWith(makePtr<ByWeight<OwnMinimumSpanningTree>>(), usePrediction));
            expectIdentical(st, matchWith(makePtr<ByWeight<OwnSegmentTree>>(), usePrediction));
        }
    }
}

TEST(HDPStereo_UserTreeStrategy, another_tree)
{
    for (bool usePrediction : { false, true })
    {
        const Mat rows = matchWith(makePtr<RowTree>(), usePrediction);
        EXPECT_GT(countDifferent(matchWith(createMinimumSpanningTree(), usePrediction), rows), 100);
        EXPECT_LT(badPixels(rows, testPair().truth, testPair().visible, 2), 30);
    }
}

TEST(HDPStereo_UserTreeStrategy, without_any_tree_each_pixel_takes_its_own_best)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, disparities, HDPTreeMatcher::PRESET_PAPER);
    matcher->setTreeStrategy(makePtr<NoTree>());
    change(*matcher, [&](Params& p) {
        p.usePrediction = false;
        p.disparityMedianSize = 0;
    });
    const Mat left = oracle::grey(testPair().left), right = oracle::grey(testPair().right);
    const Mat disparity = match(*matcher, left, right);

    const hdp::ColorGradientParams params = { 10, 2, 0.11f, 1 };
    const Mat_<double> costs =
        oracle::costTable(oracle::ColorGradientCost(left, right, params), left.size(), disparities);
    for (int p = 0; p < costs.rows; ++p)
    {
        const int d = disparity.at<short>(p / disparity.cols, p % disparity.cols) / 16;
        ASSERT_TRUE(d >= 0 && d < disparities);
        ASSERT_LE(costs(p, d), *std::min_element(costs[p], costs[p] + disparities) + 1e-6) << "pixel " << p;
    }
}

//! Throws when the rules have been asked a number of times.
class ThrowingTree : public OwnMinimumSpanningTree
{
public:
    explicit ThrowingTree(int calls) : calls_(calls) {}
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        count();
        OwnMinimumSpanningTree::orderEdges(weights, edges);
    }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE
    {
        count();
        return true;
    }

private:
    void count() const
    {
        if (calls_-- == 0)
            CV_Error(Error::StsError, "out of trees");
    }
    mutable std::atomic<int> calls_;
};

//! Leaves something else than a permutation.
class BrokenTree : public OwnMinimumSpanningTree
{
public:
    typedef void (*Breaker)(std::vector<int>& edges);
    explicit BrokenTree(Breaker breakOrder) : breakOrder_(breakOrder) {}
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        OwnMinimumSpanningTree::orderEdges(weights, edges);
        breakOrder_(edges);
    }

private:
    Breaker breakOrder_;
};

//! A matcher rejects what the strategy does, and then works with another one. create makes a fresh strategy.
template <typename Create> void expectUsableAfter(const Create& create, const std::string& message)
{
    const SyntheticPair& pair = testPair();
    for (bool usePrediction : { false, true })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, disparities, HDPTreeMatcher::PRESET_PAPER);
        change(*matcher, [&](Params& p) { p.usePrediction = usePrediction; });
        matcher->setTreeStrategy(create());
        expectRejected([&] { match(*matcher, pair.left, pair.right); }, message);
        matcher->setTreeStrategy(createMinimumSpanningTree());
        expectIdentical(matchWith(createMinimumSpanningTree(), usePrediction), match(*matcher, pair.left, pair.right));
    }
}

TEST(HDPStereo_UserTreeStrategy, what_it_throws_leaves_the_matcher_usable)
{
    for (int calls : { 0, 1, 2, 1000 })
    {
        SCOPED_TRACE(calls);
        expectUsableAfter([calls] { return makePtr<ThrowingTree>(calls); }, "out of trees");
        const ScopedThreads scope(4);
        expectUsableAfter([calls] { return makePtr<ByWeight<ThrowingTree>>(calls); }, "out of trees");
    }
}

TEST(HDPStereo_UserTreeStrategy, broken_permutations_are_rejected)
{
    const BrokenTree::Breaker breakers[] = {
        [](std::vector<int>& edges) { edges.clear(); },
        [](std::vector<int>& edges) { edges.pop_back(); },
        [](std::vector<int>& edges) { edges.push_back(edges[0]); },
        [](std::vector<int>& edges) { edges[0] = edges.back(); },
        [](std::vector<int>& edges) { edges[3] = -1; },
        [](std::vector<int>& edges) { edges[3] = INT_MIN; },
        [](std::vector<int>& edges) { edges.back() = INT_MAX; },
        [](std::vector<int>& edges) { *std::max_element(edges.begin(), edges.end()) += 1; }, // leads out of the image
    };
    for (size_t i = 0; i < sizeof(breakers) / sizeof(breakers[0]); ++i)
    {
        SCOPED_TRACE(i);
        const BrokenTree::Breaker breaker = breakers[i];
        expectUsableAfter([breaker] { return makePtr<BrokenTree>(breaker); }, "orderEdges");
    }
}

}} // namespace opencv_test
