// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/forest/tree_means.hpp"
#include "../src/paper/tree_sums.hpp"

namespace opencv_test { namespace {

const hdp::ColorGradientParams costParams = { 10, 2, 0.11f, 1 };
const int numDisparities = 24;

//! A forest with what belongs to it, and the cost of each pixel and disparity by the formula. Of one channel, where the
//! library's cost is exact.
struct Layer
{
    Mat left, right;
    hdp::DisparityForest forest;
    oracle::Forest expectedForest;
    hdp::ColorGradientCost cost;
    Mat_<double> costTable;

    Layer(RNG& rng, Size size, const TreeStrategy& strategy, const Mat& pixelIntv, double beta, bool link,
          int disparities = numDisparities)
        : left(patchyImage(rng, size, CV_8UC1)), right(size, CV_8UC1)
    {
        const Mat noise = randomImage(rng, size, CV_8UC1, 6);
        for (int x = 0; x < size.width; ++x) // the left image, 6 pixels to the left
            right.col(x) = left.col(std::min(x + 6, size.width - 1)) + noise.col(x);
        hdp::ForestBuffers buffers;
        hdp::buildForest(left, pixelIntv, strategy, beta, link, buffers, forest);
        expectedForest = oracle::buildForest(left, pixelIntv, strategy, beta, link);
        cost.prepare(left, right, disparities, costParams);
        costTable = oracle::costTable(oracle::ColorGradientCost(left, right, costParams), size, disparities);
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

//! Some successive candidates of each tree, and their sums as far as winners have them; one candidate wins if it is
//! chosen, by a cost that all others have beside their own.
class RecordedSums : public hdp::AggregationProblem
{
public:
    RecordedSums(const Layer& layer, int count, int chosen)
        : winners(layer.left.total()), firsts(layer.left.total()), cost_(layer.cost), count_(count), chosen_(chosen)
    {
    }

    Range candidates(const hdp::TreeWalk& walk, const hdp::DisparityTree& tree) const CV_OVERRIDE
    {
        const int first = (count_ * 5 + tree.root) % (numDisparities - count_ + 1);
        for (int i = 0; i < tree.size; ++i)
            firsts[walk.pixels[i]] = first;
        return Range(first, first + count_);
    }

    void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const CV_OVERRIDE
    {
        EXPECT_EQ(count_ <= 4 ? 4 : count_ <= 8 ? 8 : count_ <= 16 ? 16 : 32, lanes);
        cost_.evaluate(pixels, count, first, lanes, costs);
        const int own = firsts[pixels[0]] + chosen_ - first;
        for (int i = 0; i < count * lanes && chosen_ >= 0; ++i)
            costs[i] += i % lanes == own ? 0.f : 1000.f;
    }

    void setDisparities(const int* pixels, const hdp::RunWinner* ofPixels, int count, ushort*) const CV_OVERRIDE
    {
        for (int i = 0; i < count; ++i)
            winners[pixels[i]] = ofPixels[i];
    }

    mutable std::vector<hdp::RunWinner> winners; // by pixel
    mutable std::vector<int> firsts;             // candidates, the same

private:
    const hdp::ColorGradientCost& cost_;
    const int count_, chosen_;
};

void expectExplicitSums(const Layer& layer, double gamma)
{
    SCOPED_TRACE(testing::Message() << layer.left.size() << ", trees " << layer.forest.trees.size() << ", gamma "
                                    << gamma);
    hdp::SumBuffers buffers;
    Mat disparity(layer.left.size(), CV_16U);
    const int pixels = (int)disparity.total();
    for (int count : { 1, 2, 3, 4, 5, 7, 8, 9, 16, 17, 24 })
    {
        const RecordedSums recorded(layer, count, -1);
        hdp::takeWinners(layer.forest, recorded, gamma, buffers, disparity);
        for (int p = 0; p < pixels; p += 1 + pixels / 200)
        {
            const int first = recorded.firsts[p];
            const hdp::RunWinner& winner = recorded.winners[p];
            const std::vector<double> expected = oracle::aggregated(layer.expectedForest.neighbours, p, gamma,
                                                                    layer.costTable, first, first + count - 1);
            const auto expectSum = [&](int k, float sum) {
                if (k < 0 || k >= count)
                    EXPECT_LT(sum, 0) << "pixel " << p << ", beside " << count << " candidates";
                else
                    EXPECT_NEAR(expected[k], sum, 1e-5 + 2e-5 * expected[k])
                        << "pixel " << p << ", candidate " << first + k << " of " << count;
            };
            const int best = winner.candidate - first;
            ASSERT_TRUE(best >= 0 && best < count) << "pixel " << p;
            const double lowest = *std::min_element(expected.begin(), expected.end());
            EXPECT_NEAR(lowest, winner.lowest, 1e-5 + 2e-5 * lowest);
            expectSum(best, winner.lowest);
            expectSum(best - 1, winner.before);
            expectSum(best + 1, winner.after);
            expectSum(0, winner.first);
            expectSum(count - 1, winner.last);
        }
        for (int chosen = 0; chosen < count; ++chosen)
        {
            const RecordedSums one(layer, count, chosen);
            hdp::takeWinners(layer.forest, one, gamma, buffers, disparity);
            for (int p = 0; p < pixels; p += 1 + pixels / 200)
            {
                const int candidate = one.firsts[p] + chosen;
                const std::vector<double> expected = oracle::aggregated(layer.expectedForest.neighbours, p, gamma,
                                                                        layer.costTable, candidate, candidate);
                ASSERT_EQ(candidate, one.winners[p].candidate) << "pixel " << p;
                ASSERT_NEAR(expected[0], one.winners[p].lowest, 1e-5 + 2e-5 * expected[0])
                    << "pixel " << p << ", candidate " << candidate << " of " << count;
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

// Of the library's sums, in float
const double sumError = 2e-6;

//! A winner has the smallest explicit sum among the candidates, but for rounding, and its parabola's offset.
bool isWinner(const std::vector<double>& sums, int best, int disparity, bool subpixel)
{
    for (int k = 0; k < (int)sums.size(); ++k)
    {
        const Range offset = subpixel ? oracle::parabolaOffset(sums, k, sumError) : Range(0, 0);
        const int whole = hdp::subpixelScale * k;
        if (sums[k] <= sums[best] * (1 + sumError) && disparity >= whole + offset.start &&
            disparity <= whole + offset.end)
            return true;
    }
    return false;
}

//! Every pixel's disparity, or that of every n-th pixel, is the winner of the explicit sums.
void expectWinners(const Layer& layer, double gamma, bool subpixel, hdp::SumBuffers& buffers, int step = 1)
{
    SCOPED_TRACE(testing::Message() << "gamma " << gamma << (subpixel ? ", sub-pixel" : ""));
    const int scale = hdp::subpixelScale;
    Mat disparity;
    hdp::aggregateForest(layer.forest, layer.cost, gamma, subpixel, buffers, disparity);
    ASSERT_EQ(CV_16UC1, disparity.type());
    ASSERT_EQ(layer.left.size(), disparity.size());
    int compared = 0, rounded = 0;
    for (int p = 0; p < (int)disparity.total(); p += step)
    {
        const oracle::Tree& tree = layer.expectedForest.trees[layer.expectedForest.treeOf[p]];
        const int actual = disparity.at<ushort>(p / disparity.cols, p % disparity.cols);
        if (tree.empty())
        {
            ASSERT_EQ(0, actual) << "pixel " << p;
            continue;
        }
        ASSERT_TRUE(scale * tree.first <= actual && actual <= scale * tree.last) << "pixel " << p;
        const std::vector<double> sums =
            oracle::aggregated(layer.expectedForest.neighbours, p, gamma, layer.costTable, tree.first, tree.last);
        const int best = oracle::winner(sums);
        ASSERT_TRUE(isWinner(sums, best, actual - scale * tree.first, subpixel))
            << "pixel " << p << ", disparity " << actual << ", best " << best + tree.first;
        ++compared;
        const int exact = scale * best + (subpixel ? oracle::parabolaOffset(sums, best, 0).start : 0);
        rounded += actual - scale * tree.first != exact;
    }
    EXPECT_LE(rounded, compared / 5) << "too many winners depend on rounding to say anything";
}

//! A layer with the census of its images
struct CensusLayer : Layer
{
    hdp::CensusCost census;

    CensusLayer(RNG& rng, Size size, const TreeStrategy& strategy, const Mat& pixelIntv, double beta, bool link,
                int disparities = numDisparities)
        : Layer(rng, size, strategy, pixelIntv, beta, link, disparities)
    {
        Mat levels[2];
        left.convertTo(levels[0], CV_16U);
        right.convertTo(levels[1], CV_16U);
        census.prepare(levels[0], levels[1], disparities, 7);
        costTable = oracle::costTable(oracle::CensusCost(levels[0], levels[1], 7), size, disparities);
    }
};

//! Each mean of the volume is that of the formula, and near that of the explicit sums; the volume has the pixels of each tree.
void expectMeans(const CensusLayer& layer, int disparities, double gamma, hdp::MeanBuffers& buffers, int step = 1)
{
    hdp::CostVolume volume;
    const hdp::TwoLayerCost cost(layer.census, nullptr);
    hdp::aggregateMeans(layer.forest, cost, disparities, gamma, buffers, volume);
    ASSERT_EQ(layer.left.size(), volume.size);
    ASSERT_EQ(disparities, volume.numDisparities);
    ASSERT_LE(volume.total(), volume.costs.size());
    hdp::TreeWalk walk;
    for (size_t t = 0; t < layer.forest.trees.size(); ++t)
    {
        const hdp::DisparityTree& tree = layer.forest.trees[t];
        hdp::walkTree(layer.forest, tree, walk);
        const Mat_<int> expected = oracle::treeMeans(walk, tree.size, layer.costTable, gamma, disparities);
        for (int i = 0; i < tree.size; ++i)
        {
            const int p = walk.pixels[i];
            ASSERT_EQ(p, volume.treePixels[volume.treeStarts[t] + i]);
            const uchar* means = &volume.costs[volume.start(p)];
            for (int k = 0; k < disparities; ++k)
                ASSERT_EQ(expected(i, k), means[k]) << "pixel " << p << ", candidate " << k;
            if (p % step != 0)
                continue;
            const std::vector<double> sums =
                oracle::aggregated(layer.expectedForest.neighbours, p, gamma, layer.costTable, 0, disparities - 1);
            double similarity = 0;
            for (const std::pair<int, double>& other : oracle::similarities(layer.expectedForest.neighbours, p, gamma))
                similarity += other.second;
            for (int k = 0; k < disparities; ++k)
                ASSERT_NEAR(hdp::CostVolume::scale * sums[k] / similarity, means[k], 0.7)
                    << "pixel " << p << ", candidate " << k;
        }
    }
}

TEST(HDPStereo_ForestAggregation, means_over_trees)
{
    RNG rng(27);
    hdp::MeanBuffers buffers;
    for (const Size& size : { Size(1, 1), Size(1, 40), Size(40, 1), Size(30, 24) })
        for (double gamma : { 1e-300, 4., 25.5, 1e6 })
            for (const Ptr<TreeStrategy>& strategy : { createSegmentTree(20), createMinimumSpanningTree() })
            {
                SCOPED_TRACE(testing::Message() << size << ", gamma " << gamma << ", " << strategy->getDefaultName());
                const Mat fullRange(size, CV_16UC2, Scalar(0, numDisparities - 1));
                expectMeans(CensusLayer(rng, size, *strategy, fullRange, 0.95, false), numDisparities, gamma, buffers);
            }
}

TEST(HDPStereo_ForestAggregation, means_of_any_number_of_disparities)
{
    RNG rng(28);
    hdp::MeanBuffers buffers;
    const Size size(14, 11);
    for (int disparities : { 1, 2, 4, 5, 15, 16, 17, 32, 33, 41, 70 })
    {
        const Mat fullRange(size, CV_16UC2, Scalar(0, disparities - 1));
        const CensusLayer layer(rng, size, *createMinimumSpanningTree(), fullRange, 0.95, true, disparities);
        expectMeans(layer, disparities, 5, buffers);
    }
    const Size large(210, 160); // a tree whose candidates are in groups side by side
    const Mat fullRange(large, CV_16UC2, Scalar(0, 149));
    expectMeans(CensusLayer(rng, large, *createMinimumSpanningTree(), fullRange, 0.95, true, 150), 150, 4, buffers,
                large.area() / 12 | 1);
}

TEST(HDPStereo_ForestAggregation, winner_of_explicit_sums)
{
    RNG rng(20);
    hdp::SumBuffers buffers; // reused
    for (const Size& size : { Size(1, 1), Size(1, 40), Size(40, 1), Size(30, 24) })
        for (const Ptr<TreeStrategy>& strategy :
             { createMinimumSpanningTree(), createSegmentTree(20), createRandomTree() })
            for (bool subpixel : { false, true })
            {
                SCOPED_TRACE(testing::Message() << size << ", " << strategy->getDefaultName());
                expectWinners(Layer(rng, size, *strategy, stripedIntervals(size), 0.6, false), 25.5, subpixel, buffers);
                const Mat fullRange(size, CV_16UC2, Scalar(0, numDisparities - 1));
                expectWinners(Layer(rng, size, *strategy, fullRange, 0.95, true), 25.5, subpixel, buffers);
                expectWinners(Layer(rng, size, *strategy, fullRange, 0.95, true), 2, subpixel, buffers);
            }
}

//! Each number of candidates has its own number of lanes, some of them for nothing.
TEST(HDPStereo_ForestAggregation, winner_among_any_number_of_candidates)
{
    RNG rng(21);
    hdp::SumBuffers buffers;
    const Size size(14, 11);
    for (bool subpixel : { false, true })
        for (int first : { 0, 2 })
            for (int count = 1; first + count <= numDisparities; ++count)
            {
                SCOPED_TRACE(testing::Message() << count << " candidates from " << first);
                const Mat pixelIntv(size, CV_16UC2, Scalar(first, first + count - 1));
                const Layer layer(rng, size, *createMinimumSpanningTree(), pixelIntv, 0.95, true);
                for (double gamma : { 1., 25.5 }) // with the smaller one winners are everywhere in the range
                    expectWinners(layer, gamma, subpixel, buffers);
            }
}

//! Several runs, with winners at their borders: in a small tree one after the other, in a large one in groups side by side
TEST(HDPStereo_ForestAggregation, winner_of_several_runs)
{
    RNG rng(26);
    hdp::SumBuffers buffers;
    const int candidates = 150;
    for (const Size& size : { Size(30, 12), Size(210, 160) })
    {
        const Mat fullRange(size, CV_16UC2, Scalar(0, candidates - 1));
        const Layer layer(rng, size, *createMinimumSpanningTree(), fullRange, 0.95, true, candidates);
        ASSERT_EQ(1u, layer.forest.trees.size());
        for (bool subpixel : { false, true })
            for (double gamma : { 1., 25.5 }) // with the smaller one winners are everywhere in the range
                expectWinners(layer, gamma, subpixel, buffers, size.area() / 35 | 1);
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
            hdp::ColorGradientCost cost;
            cost.prepare(left, right, numDisparities, costParams);
            hdp::SumBuffers buffers;
            Mat disparity;
            for (bool subpixel : { false, true })
            {
                // Equal costs have no parabola.
                hdp::aggregateForest(forest, cost, 25.5, subpixel, buffers, disparity);
                EXPECT_EQ(size.area(), cv::countNonZero(disparity == hdp::subpixelScale * first)) << "from " << first;
            }
        }
}

}} // namespace opencv_test
