// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/forest/disparity_forest.hpp"

namespace opencv_test { namespace {

using hdp::DisparityForest;
using hdp::DisparityTree;

Mat constantIntervals(Size size, int first, int last) { return Mat(size, CV_16UC2, Scalar(first, last)); }

//! Intervals of a few kinds, as a layer above leaves them: constant in squares of 2 x 2, some of them empty.
Mat randomIntervals(RNG& rng, Size size)
{
    Mat intervals(size, CV_16UC2);
    const Mat depth = randomImage(rng, Size(size.width / 8 + 1, size.height / 8 + 1), CV_8UC1, 4);
    for (int y = 0; y < size.height; y += 2)
        for (int x = 0; x < size.width; x += 2)
        {
            const int first = 6 * depth.at<uchar>(y / 8, x / 8) + rng.uniform(0, 3);
            const bool isEmpty = rng.uniform(0, 25) == 0;
            const Vec2w interval((ushort)(isEmpty ? 1 : first), (ushort)(isEmpty ? 0 : first + rng.uniform(0, 8)));
            const Rect square(x, y, 2, 2);
            intervals(square & Rect(Point(), size)).setTo(Scalar(interval[0], interval[1]));
        }
    return intervals;
}

std::vector<int> joinedEdges(const DisparityForest& forest)
{
    const Mat& links = forest.links;
    std::vector<int> joined;
    for (int y = 0; y < links.rows; ++y)
        for (int x = 0; x < links.cols; ++x)
        {
            const int p = y * links.cols + x, link = links.at<uchar>(y, x);
            const bool right = (link & hdp::TreeLink::RIGHT) != 0, below = (link & hdp::TreeLink::BELOW) != 0;
            // Both ends say the same, and nothing leads out of the image.
            EXPECT_EQ(right, x + 1 < links.cols && (links.at<uchar>(y, x + 1) & hdp::TreeLink::LEFT) != 0);
            EXPECT_EQ(below, y + 1 < links.rows && (links.at<uchar>(y + 1, x) & hdp::TreeLink::ABOVE) != 0);
            EXPECT_FALSE(x == 0 && (link & hdp::TreeLink::LEFT));
            EXPECT_FALSE(y == 0 && (link & hdp::TreeLink::ABOVE));
            if (right)
                joined.push_back(2 * p);
            if (below)
                joined.push_back(2 * p + 1);
        }
    return joined;
}

void testForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta, bool link,
                hdp::ForestBuffers& buffers, DisparityForest& forest)
{
    SCOPED_TRACE(testing::Message() << strategy.getDefaultName() << ", " << image.size() << ", beta " << beta
                                    << (link ? ", linked" : ""));
    hdp::buildForest(image, pixelIntv, strategy, beta, link, buffers, forest);
    const oracle::Forest expected = oracle::buildForest(image, pixelIntv, strategy, beta, link);

    expectIdentical(oracle::edgeWeights(image), forest.weights);
    ASSERT_EQ(image.size(), forest.links.size());
    ASSERT_EQ(expected.joined, joinedEdges(forest));

    size_t count = 0;
    for (size_t t = 0; t < expected.trees.size(); ++t)
        count += !expected.trees[t].pixels.empty();
    ASSERT_EQ(count, forest.trees.size());
    std::vector<bool> seen(expected.trees.size());
    for (size_t t = 0; t < forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        ASSERT_TRUE(t == 0 || forest.trees[t - 1].root < tree.root) << "trees are ordered by root";
        ASSERT_TRUE(tree.root >= 0 && (size_t)tree.root < image.total());
        const int match = expected.treeOf[tree.root];
        ASSERT_FALSE(seen[match]) << "two trees for one";
        seen[match] = true;
        ASSERT_EQ((int)expected.trees[match].pixels.size(), tree.size);
        ASSERT_EQ(expected.trees[match].empty(), tree.interval.empty());
        if (!tree.interval.empty())
        {
            ASSERT_EQ(expected.trees[match].first, tree.interval.first);
            ASSERT_EQ(expected.trees[match].last, tree.interval.last);
        }
    }
}

//! Heavy edges may come before light ones, and Rule 2 asks for all of a tree's state.
class UnorderedSegments : public TreeStrategy
{
public:
    void orderEdges(const Mat&, std::vector<int>& edges) const CV_OVERRIDE { std::reverse(edges.begin(), edges.end()); }
    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        return std::abs(a.maxWeight - b.maxWeight) < 40 && weight * a.size < 3000 && weight * b.size < 3000;
    }
};

//! The same Rule 2, light edges first
class OrderedSegments : public UnorderedSegments
{
public:
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        TreeStrategy::orderEdges(weights, edges);
    }
    bool ordersByWeight() const CV_OVERRIDE { return true; }
};

std::vector<Ptr<TreeStrategy>> allStrategies()
{
    return std::vector<Ptr<TreeStrategy>>{ createMinimumSpanningTree(),  createSegmentTree(),
                                           createSegmentTree(40),        createSegmentTree(0),
                                           createRandomTree(),           createRandomTree(7),
                                           makePtr<UnorderedSegments>(), makePtr<OrderedSegments>() };
}

const Size testSizes[] = { Size(1, 1), Size(1, 9), Size(9, 1), Size(2, 2), Size(17, 13), Size(48, 40) };

TEST(HDPStereo_DisparityForest, plain_kruskal_on_sets_with_predicted_intervals)
{
    RNG rng(12);
    hdp::ForestBuffers buffers; // reused, for any size
    DisparityForest forest;
    for (const Ptr<TreeStrategy>& strategy : allStrategies())
        for (double beta : { 0., 0.3, 0.6, 0.95, 1. })
            for (const Size& size : testSizes)
                for (int type : { CV_8UC1, CV_8UC3 })
                {
                    const Mat pixelIntv = randomIntervals(rng, size);
                    testForest(patchyImage(rng, size, type), pixelIntv, *strategy, beta, false, buffers, forest);
                    testForest(randomImage(rng, size, type, 12), pixelIntv, *strategy, beta, false, buffers, forest);
                }
}

TEST(HDPStereo_DisparityForest, plain_kruskal_on_grey_levels_in_quarters)
{
    RNG rng(19);
    hdp::ForestBuffers buffers;
    DisparityForest forest;
    for (const Ptr<TreeStrategy>& strategy : allStrategies())
        for (const Size& size : testSizes)
            for (int levels : { 3, 12, 1024 })
                testForest(randomImage(rng, size, CV_16UC1, levels), randomIntervals(rng, size), *strategy, 0.6, false,
                           buffers, forest);
}

TEST(HDPStereo_DisparityForest, plain_kruskal_over_the_full_range)
{
    RNG rng(13);
    hdp::ForestBuffers buffers;
    DisparityForest forest;
    for (const Ptr<TreeStrategy>& strategy : allStrategies())
        for (bool link : { false, true })
            for (const Size& size : testSizes)
            {
                const Mat pixelIntv = constantIntervals(size, 0, 63);
                testForest(patchyImage(rng, size, CV_8UC3), pixelIntv, *strategy, 0.95, link, buffers, forest);
                testForest(randomImage(rng, size, CV_8UC1), pixelIntv, *strategy, 0.6, link, buffers, forest);
                if (link)
                {
                    EXPECT_EQ(1u, forest.trees.size());
                }
            }
}

//! Trees grow across stripes, whose number depends on that of threads, and edges are rejected inside areas of equal
//! intervals, as the trees on both sides have united theirs with different ones.
TEST(HDPStereo_DisparityForest, plain_kruskal_in_any_number_of_stripes)
{
    RNG rng(18);
    hdp::ForestBuffers buffers;
    DisparityForest forest;
    const Ptr<TreeStrategy> minimum = createMinimumSpanningTree(), segments = createSegmentTree(40);
    const Ptr<TreeStrategy> own = makePtr<OrderedSegments>();
    const Ptr<TreeStrategy> strategies[] = { minimum, minimum, own, minimum, segments };
    for (int threads = 1; threads <= 5; ++threads)
    {
        ScopedThreads scope(threads);
        for (int i = 0; i < 400; ++i)
        {
            const int height = i % 20 == 1 ? 1 : rng.uniform(1, 36), width = i % 20 == 0 ? 1 : rng.uniform(1, 36);
            const Size size(width, height);
            const Mat image = randomImage(rng, size, i % 2 == 0 ? CV_8UC1 : CV_8UC3, i % 3 == 0 ? 4 : 20);
            Mat pixelIntv(size, CV_16UC2);
            const int side = rng.uniform(1, 9), shifts = rng.uniform(1, 5), length = rng.uniform(1, 10);
            for (int y = 0; y < size.height; y += side)
                for (int x = 0; x < size.width; x += side)
                {
                    const bool isEmpty = rng.uniform(0, 30) == 0;
                    const int first = isEmpty ? 1 : rng.uniform(0, shifts);
                    const int last = isEmpty ? 0 : first + length - 1 + rng.uniform(0, 3);
                    pixelIntv(Rect(x, y, side, side) & Rect(Point(), size)).setTo(Scalar(first, last));
                }
            const Ptr<TreeStrategy>& strategy = strategies[i % 5];
            // Segments are linked without prediction only, when all intervals are equal.
            const bool link = strategy != segments && i % 7 == 0;
            testForest(image, pixelIntv, *strategy, rng.uniform(0., 1.), link, buffers, forest);
            if (HasFatalFailure())
                return;
        }
    }
}

//! The order in which trees are walked depends on the roots.
TEST(HDPStereo_DisparityForest, roots_do_not_depend_on_the_number_of_threads)
{
    RNG rng(19);
    const Mat image = patchyImage(rng, Size(61, 83), CV_8UC3), pixelIntv = randomIntervals(rng, image.size());
    for (const Ptr<TreeStrategy>& strategy : allStrategies())
    {
        hdp::ForestBuffers buffers;
        DisparityForest expected, forest;
        {
            ScopedThreads one(1);
            hdp::buildForest(image, pixelIntv, *strategy, 0.6, false, buffers, expected);
        }
        for (int threads = 2; threads <= 5; ++threads)
        {
            ScopedThreads scope(threads);
            hdp::buildForest(image, pixelIntv, *strategy, 0.6, false, buffers, forest);
            ASSERT_EQ(expected.trees.size(), forest.trees.size());
            for (size_t t = 0; t < expected.trees.size(); ++t)
                ASSERT_EQ(expected.trees[t].root, forest.trees[t].root) << threads << " threads";
            expectIdentical(expected.links, forest.links);
        }
    }
}

TEST(HDPStereo_DisparityForest, regions_of_interest)
{
    RNG rng(14);
    hdp::ForestBuffers buffers;
    DisparityForest forest;
    const Mat image = patchyImage(rng, Size(40, 30), CV_8UC3);
    testForest(image(Rect(4, 3, 21, 19)), randomIntervals(rng, Size(21, 19)), *createMinimumSpanningTree(), 0.6, false,
               buffers, forest);
}

//! DT-Rule 1: the weight up to which pixels whose intervals do not meet keep their edge, seen with beta = 0.
TEST(HDPStereo_DisparityForest, disjoint_intervals_keep_edges_of_weight_7)
{
    for (int weight = 0; weight < 20; ++weight)
    {
        const Mat image = Mat_<uchar>({ 1, 2 }, { 100, (uchar)(100 + weight) });
        Mat pixelIntv(1, 2, CV_16UC2);
        pixelIntv.at<Vec2w>(0, 0) = Vec2w(0, 4);
        pixelIntv.at<Vec2w>(0, 1) = Vec2w(5, 9);
        hdp::ForestBuffers buffers;
        DisparityForest forest;
        hdp::buildForest(image, pixelIntv, *createMinimumSpanningTree(), 0, false, buffers, forest);
        EXPECT_EQ(weight <= 7 ? 1u : 2u, forest.trees.size()) << weight;
    }
}

//! Prim's algorithm, O(n^2): the total weight of a minimum spanning tree.
int64 primTotalWeight(const Mat& image)
{
    const int pixels = (int)image.total(), width = image.cols;
    std::vector<int> distance(pixels, INT_MAX);
    std::vector<bool> reached(pixels);
    distance[0] = 0;
    int64 total = 0;
    for (int step = 0; step < pixels; ++step)
    {
        int nearest = -1;
        for (int p = 0; p < pixels; ++p)
            if (!reached[p] && (nearest < 0 || distance[p] < distance[nearest]))
                nearest = p;
        reached[nearest] = true;
        total += distance[nearest];
        const int x = nearest % width, y = nearest / width;
        const int neighbours[] = { x > 0 ? nearest - 1 : -1, x + 1 < width ? nearest + 1 : -1,
                                   y > 0 ? nearest - width : -1, y + 1 < image.rows ? nearest + width : -1 };
        for (int q : neighbours)
            if (q >= 0 && !reached[q])
                distance[q] = std::min(distance[q], oracle::edgeWeight(image, nearest, q));
    }
    return total;
}

TEST(HDPStereo_DisparityForest, minimum_spanning_tree_is_minimal)
{
    RNG rng(15);
    for (int type : { CV_8UC1, CV_8UC3 })
        for (const Size& size : testSizes)
            for (int levels : { 4, 256 })
            {
                const Mat image = randomImage(rng, size, type, levels);
                hdp::ForestBuffers buffers;
                DisparityForest forest;
                hdp::buildForest(image, constantIntervals(size, 0, 9), *createMinimumSpanningTree(), 0.95, true,
                                 buffers, forest);
                const std::vector<int> joined = joinedEdges(forest);
                ASSERT_EQ(image.total() - 1, joined.size());
                int64 total = 0;
                for (int e : joined)
                    total += forest.weights.ptr()[e];
                EXPECT_EQ(primTotalWeight(image), total);
            }
}

void testWalk(const DisparityForest& forest)
{
    const int width = forest.links.cols;
    std::vector<int> visits(forest.links.total(), 0);
    hdp::TreeWalk walk; // reused for all trees
    for (const DisparityTree& tree : forest.trees)
    {
        hdp::walkTree(forest, tree, walk);
        ASSERT_GE(walk.pixels.size(), (size_t)tree.size);
        ASSERT_GE(walk.parents.size(), (size_t)tree.size);
        ASSERT_GE(walk.weights.size(), (size_t)tree.size);
        ASSERT_EQ(tree.root, walk.pixels[0]);
        ASSERT_EQ(0, walk.parents[0]);
        ASSERT_EQ(0, walk.weights[0]);
        ++visits[tree.root];
        for (int i = 1; i < tree.size; ++i)
        {
            const int p = walk.pixels[i];
            ASSERT_TRUE(p >= 0 && (size_t)p < visits.size());
            ++visits[p];
            ASSERT_LT(walk.parents[i], i) << "parents come first";
            const int parent = walk.pixels[walk.parents[i]], link = forest.links.ptr()[p];
            const uchar* weights = forest.weights.ptr();
            const bool linked = (parent == p + 1 && (link & hdp::TreeLink::RIGHT)) ||
                                (parent == p - 1 && (link & hdp::TreeLink::LEFT)) ||
                                (parent == p + width && (link & hdp::TreeLink::BELOW)) ||
                                (parent == p - width && (link & hdp::TreeLink::ABOVE));
            ASSERT_TRUE(linked) << parent << " is not a neighbour in the tree of " << p;
            const int lower = std::min(p, parent);
            const bool vertical = (link & (parent < p ? hdp::TreeLink::ABOVE : hdp::TreeLink::BELOW)) != 0 &&
                                  std::abs(parent - p) == width;
            ASSERT_EQ(weights[2 * lower + (vertical ? 1 : 0)], walk.weights[i]);
        }
    }
    for (size_t p = 0; p < visits.size(); ++p)
        ASSERT_EQ(1, visits[p]) << "pixel " << p;
}

TEST(HDPStereo_DisparityForest, walk_visits_each_pixel_once_parents_first)
{
    RNG rng(16);
    for (const Ptr<TreeStrategy>& strategy : allStrategies())
        for (const Size& size : testSizes)
            for (bool predicted : { false, true })
            {
                SCOPED_TRACE(testing::Message() << strategy->getDefaultName() << ", " << size);
                const Mat pixelIntv = predicted ? randomIntervals(rng, size) : constantIntervals(size, 0, 15);
                hdp::ForestBuffers buffers;
                DisparityForest forest;
                hdp::buildForest(patchyImage(rng, size, CV_8UC3), pixelIntv, *strategy, 0.6, !predicted, buffers,
                                 forest);
                testWalk(forest);
            }
}

TEST(HDPStereo_DisparityForest, walk_of_a_long_path)
{
    for (const Size& size : { Size(300000, 1), Size(1, 300000) })
    {
        hdp::ForestBuffers buffers;
        DisparityForest forest;
        hdp::buildForest(Mat(size, CV_8UC1, Scalar(5)), constantIntervals(size, 0, 3), *createMinimumSpanningTree(),
                         0.6, true, buffers, forest);
        ASSERT_EQ(1u, forest.trees.size());
        testWalk(forest);
    }
}

TEST(HDPStereo_DisparityForest, search_ratio)
{
    RNG rng(17);
    const Mat image = patchyImage(rng, Size(48, 40), CV_8UC3);
    hdp::ForestBuffers buffers;
    DisparityForest forest;
    hdp::buildForest(image, constantIntervals(image.size(), 3, 12), *createMinimumSpanningTree(), 0.6, true, buffers,
                     forest);
    EXPECT_DOUBLE_EQ(10 / 40., hdp::searchRatio(forest, 40));

    const Mat pixelIntv = randomIntervals(rng, image.size());
    hdp::buildForest(image, pixelIntv, *createSegmentTree(), 0.6, false, buffers, forest);
    const oracle::Forest expected = oracle::buildForest(image, pixelIntv, *createSegmentTree(), 0.6, false);
    double sum = 0;
    for (size_t p = 0; p < image.total(); ++p)
    {
        const oracle::Tree& tree = expected.trees[expected.treeOf[p]];
        sum += tree.empty() ? 0 : tree.last - tree.first + 1;
    }
    EXPECT_NEAR(sum / image.total() / 40, hdp::searchRatio(forest, 40), 1e-12);
}

}} // namespace opencv_test
