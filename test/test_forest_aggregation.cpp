// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/forest_aggregation.hpp"

namespace opencv_test {
namespace {

const hdp::MatchingCostParams costParams = { 10, 2, 0.11f, 1 };
const int numDisparities = 24;

//! A forest with what belongs to it, and the cost of each pixel and disparity by the formula. Of one channel, where the
//! library's cost is exact.
struct Layer
{
    Mat left, right;
    hdp::DisparityForest forest;
    oracle::Forest expectedForest;
    hdp::MatchingCost cost;
    Mat_<double> costTable;

    Layer(RNG& rng, Size size, const TreeStrategy& strategy, const Mat& pixelIntv, double beta, bool link)
        : left(patchyImage(rng, size, CV_8UC1)), right(size, CV_8UC1)
    {
        const Mat noise = randomImage(rng, size, CV_8UC1, 6);
        for (int x = 0; x < size.width; ++x) // the left image, 6 pixels to the left
            right.col(x) = left.col(std::min(x + 6, size.width - 1)) + noise.col(x);
        hdp::ForestBuffers buffers;
        hdp::buildForest(left, pixelIntv, strategy, beta, link, buffers, forest);
        expectedForest = oracle::buildForest(left, pixelIntv, strategy, beta, link);
        cost.prepare(left, right, numDisparities, costParams);
        costTable = oracle::costTable(oracle::Cost(left, right, costParams), size, numDisparities);
    }
};

//! Stripes of one interval each, of 1 to 20 candidates, and an empty one
Mat stripedIntervals(Size size)
{
    const int intervals[][2] = { { 0, 19 }, { 3, 3 }, { 5, 8 }, { 1, 0 }, { 2, 9 }, { 10, 18 }, { 20, 23 } };
    Mat pixelIntv(size, CV_16UC2);
    for (int y = 0; y < size.height; ++y)
    {
        const int* interval = intervals[y / 3 % 7];
        pixelIntv.row(y).setTo(Scalar(interval[0], interval[1]));
    }
    return pixelIntv;
}

void expectExplicitSums(const Layer& layer, double gamma)
{
    SCOPED_TRACE(testing::Message() << layer.left.size() << ", trees " << layer.forest.trees.size() << ", gamma "
                                    << gamma);
    const hdp::EdgeSimilarity similarity(gamma);
    hdp::TreeWalk walk;
    std::vector<float> sums;
    for (const hdp::DisparityTree& tree : layer.forest.trees)
    {
        hdp::walkTree(layer.forest, tree, walk);
        for (int count = 1; count <= 8; ++count)
        {
            const int first = (count * 5 + tree.root) % (numDisparities - count + 1);
            const int lanes =
                hdp::aggregateTree(walk, tree.size, layer.left.cols, layer.cost, similarity, first, count, sums);
            ASSERT_EQ(count <= 4 ? 4 : 8, lanes);
            for (int i = 0; i < tree.size; i += 1 + tree.size / 50)
            {
                const std::vector<double> expected = oracle::aggregated(
                    layer.expectedForest.neighbours, walk.pixels[i], gamma, layer.costTable, first, first + count - 1);
                for (int k = 0; k < count; ++k)
                    ASSERT_NEAR(expected[k], sums[i * lanes + k], 1e-5 + 2e-5 * expected[k])
                        << "pixel " << walk.pixels[i] << ", candidate " << first + k;
            }
        }
    }
}

TEST(HDPStereo_ForestAggregation, similarity_of_neighbours)
{
    for (double gamma : { 0.5, 25.5, 1e6 })
    {
        const hdp::EdgeSimilarity similarity(gamma);
        for (int weight = 0; weight < 256; ++weight)
            EXPECT_NEAR(std::exp(-weight / gamma), similarity.table[weight], 1e-7);
    }
}

TEST(HDPStereo_ForestAggregation, explicit_sum_over_paths_in_one_tree)
{
    RNG rng(18);
    for (const Size& size : { Size(1, 1), Size(1, 30), Size(30, 1), Size(2, 2), Size(25, 18) })
    {
        const Mat pixelIntv(size, CV_16UC2, Scalar(0, numDisparities - 1));
        for (const Ptr<TreeStrategy>& strategy : { createMinimumSpanningTree(), createRandomTree(3) })
            for (double gamma : { 1., 25.5, 1000. })
                expectExplicitSums(Layer(rng, size, *strategy, pixelIntv, 0.95, true), gamma);
    }
}

TEST(HDPStereo_ForestAggregation, explicit_sum_over_paths_in_many_trees)
{
    RNG rng(19);
    const Size size(25, 22);
    for (const Ptr<TreeStrategy>& strategy : { createMinimumSpanningTree(), createSegmentTree(20), createRandomTree() })
    {
        const Layer layer(rng, size, *strategy, stripedIntervals(size), 0.6, false);
        ASSERT_GE(layer.forest.trees.size(), 5u);
        expectExplicitSums(layer, 25.5);
    }
}

//! Every pixel's winner has the smallest explicit sum among the candidates of its tree, but for rounding.
void expectWinners(const Layer& layer, double gamma, hdp::AggregationBuffers& buffers)
{
    Mat disparity;
    hdp::aggregateForest(layer.forest, layer.cost, gamma, buffers, disparity);
    ASSERT_EQ(CV_16UC1, disparity.type());
    ASSERT_EQ(layer.left.size(), disparity.size());
    int ties = 0;
    for (int p = 0; p < (int)disparity.total(); ++p)
    {
        const oracle::Tree& tree = layer.expectedForest.trees[layer.expectedForest.treeOf[p]];
        const int actual = disparity.at<ushort>(p / disparity.cols, p % disparity.cols);
        if (tree.empty())
        {
            ASSERT_EQ(0, actual) << "pixel " << p;
            continue;
        }
        ASSERT_TRUE(tree.first <= actual && actual <= tree.last) << "pixel " << p;
        const std::vector<double> sums =
            oracle::aggregated(layer.expectedForest.neighbours, p, gamma, layer.costTable, tree.first, tree.last);
        const int best = oracle::winner(sums);
        ASSERT_LE(sums[actual - tree.first], sums[best] * (1 + 2e-6))
            << "pixel " << p << ", best " << best + tree.first;
        ties += actual - tree.first != best;
    }
    EXPECT_LE(ties, (int)disparity.total() / 5) << "too many winners depend on rounding to say anything";
}

TEST(HDPStereo_ForestAggregation, winner_of_explicit_sums)
{
    RNG rng(20);
    hdp::AggregationBuffers buffers; // reused
    for (const Size& size : { Size(1, 1), Size(1, 40), Size(40, 1), Size(30, 24) })
        for (const Ptr<TreeStrategy>& strategy :
             { createMinimumSpanningTree(), createSegmentTree(20), createRandomTree() })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << strategy->getDefaultName());
            expectWinners(Layer(rng, size, *strategy, stripedIntervals(size), 0.6, false), 25.5, buffers);
            const Mat fullRange(size, CV_16UC2, Scalar(0, numDisparities - 1));
            expectWinners(Layer(rng, size, *strategy, fullRange, 0.95, true), 25.5, buffers);
            expectWinners(Layer(rng, size, *strategy, fullRange, 0.95, true), 2, buffers);
        }
}

//! Each number of candidates goes its own way through the groups of 4 and 8.
TEST(HDPStereo_ForestAggregation, winner_among_any_number_of_candidates)
{
    RNG rng(21);
    hdp::AggregationBuffers buffers;
    const Size size(14, 11);
    for (int first : { 0, 2 })
        for (int count = 1; first + count <= numDisparities; ++count)
        {
            SCOPED_TRACE(testing::Message() << count << " candidates from " << first);
            const Mat pixelIntv(size, CV_16UC2, Scalar(first, first + count - 1));
            expectWinners(Layer(rng, size, *createMinimumSpanningTree(), pixelIntv, 0.95, true), 25.5, buffers);
        }
}

TEST(HDPStereo_ForestAggregation, lowest_disparity_wins_a_tie)
{
    const Size size(20, 15);
    for (int difference : { 0, 5 })
        for (int first : { 0, 7 })
        {
            const Mat left(size, CV_8UC3, Scalar::all(100)), right(size, CV_8UC3, Scalar::all(100 + difference));
            hdp::ForestBuffers forestBuffers;
            hdp::DisparityForest forest;
            const Mat pixelIntv(size, CV_16UC2, Scalar(first, numDisparities - 1));
            hdp::buildForest(left, pixelIntv, *createMinimumSpanningTree(), 0.95, true, forestBuffers, forest);
            hdp::MatchingCost cost;
            cost.prepare(left, right, numDisparities, costParams);
            hdp::AggregationBuffers buffers;
            Mat disparity;
            hdp::aggregateForest(forest, cost, 25.5, buffers, disparity);
            EXPECT_EQ((int)size.area(), cv::countNonZero(disparity == first)) << "from " << first;
        }
}

} // namespace
} // namespace opencv_test
