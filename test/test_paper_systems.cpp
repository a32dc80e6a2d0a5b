// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

typedef testing::TestWithParam<System> HDPStereo_PaperSystem;
typedef testing::TestWithParam<System> HDPStereo_SlowPaperSystem;

//////////////////////////////////// the whole system, slowly ////////////////////////////////////

//! Winner-takes-all of the explicit sums; 0 where a tree has no candidates.
Mat winners(const oracle::Forest& forest, const Mat_<double>& costs, Size size)
{
    Mat disparity(size, CV_16UC1);
    for (int p = 0; p < size.area(); ++p)
    {
        const oracle::Tree& tree = forest.trees[forest.treeOf[p]];
        const int d = tree.empty() ? 0
                                   : tree.first + oracle::winner(oracle::aggregated(forest.neighbours, p, 25.5, costs,
                                                                                    tree.first, tree.last));
        disparity.at<ushort>(p / size.width, p % size.width) = (ushort)d;
    }
    return disparity;
}

//! The paper from images to disparities, made of nothing but the oracles, with its settings for small images.
Mat matchByOracles(const Mat& left, const Mat& right, int numDisparities, const System& system)
{
    const double delta0 = 0.004, beta = 0.95;
    const hdp::ColorGradientParams costParams = { 10, 2, 0.11f, 1 };
    const Ptr<TreeStrategy> strategy = system.createTree();
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);

    const int layers = system.usePrediction ? 3 : 1;
    Mat lefts[3] = { left }, rights[3] = { right }, disparity;
    for (int l = 1; l < layers; ++l)
    {
        lefts[l] = oracle::halve(lefts[l - 1]);
        rights[l] = oracle::halve(rights[l - 1]);
    }
    for (int l = layers - 1; l >= 0; --l)
    {
        const Size size = lefts[l].size();
        const int largest = (numDisparities - 1) / (1 << l), largestAbove = largest / 2;
        Mat pixelIntv(size, CV_16UC2, Scalar(0, largest));
        if (l < layers - 1)
        {
            const Mat points = oracle::SupportPoints(lefts[l], rights[l], largest + 1).find();
            const Mat_<double> posterior =
                oracle::posterior(*model, l, oracle::histogram(points, largest + 1), largestAbove + 1);
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    const ushort above = disparity.at<ushort>(oracle::clamped(y / 2, disparity.rows),
                                                              oracle::clamped(x / 2, disparity.cols));
                    const hdp::DisparityInterval interval =
                        oracle::pixelInterval(posterior.row(above), delta0 * (1 << l));
                    pixelIntv.at<Vec2w>(y, x) = Vec2w(interval.first, interval.last);
                }
        }
        Mat guide = lefts[l].clone();
        if (system.useMedianPrefilter)
            cv::medianBlur(lefts[l], guide, 3);
        const oracle::Forest forest = oracle::buildForest(guide, pixelIntv, *strategy, beta, !system.usePrediction);
        const Mat_<double> costs =
            oracle::costTable(oracle::ColorGradientCost(lefts[l], rights[l], costParams), size, largest + 1);
        disparity = oracle::median(winners(forest, costs, size), system.usePrediction ? 7 : 5);
    }
    return disparity;
}

//! Share of the pixels in which the library and the oracles differ
double differenceToOracles(const System& system, bool inColor)
{
    const int numDisparities = 23;
    int different = 0, all = 0;
    for (const Size& size : { Size(68, 50), Size(61, 43) })
    {
        const SyntheticPair pair = makeSyntheticPair(size, numDisparities, 11);
        const Mat left = inColor ? pair.left : oracle::grey(pair.left);
        const Mat right = inColor ? pair.right : oracle::grey(pair.right);
        const Mat disparity = match(*createSystem(system, numDisparities), left, right);
        Mat expected;
        matchByOracles(left, right, numDisparities, system).convertTo(expected, CV_16S, 16);
        different += countDifferent(expected, disparity);
        all += (int)disparity.total();
    }
    return (double)different / all;
}

TEST_P(HDPStereo_SlowPaperSystem, whole_system_made_of_oracles)
{
    // What differs by less than a float can hold may go either way; in colour, what 1/32 level of a gradient can.
    const double grey = differenceToOracles(GetParam(), false), color = differenceToOracles(GetParam(), true);
    EXPECT_LE(grey, 0.002);
    EXPECT_LE(color, 0.01);
}

//////////////////////////////////// error on pairs with exact truth ////////////////////////////////////

TEST_P(HDPStereo_PaperSystem, error_on_synthetic_pairs)
{
    const int numDisparities = 48;
    double error = 0;
    for (int seed : { 1, 2, 3 })
    {
        const SyntheticPair pair = makeSyntheticPair(Size(320, 240), numDisparities, seed);
        const Mat disparity = match(*createSystem(GetParam(), numDisparities), pair.left, pair.right);
        error += badPixels(disparity, pair.truth, pair.visible, 2) / 3;
    }
    // Measured: 6.10, 6.51, 6.74 (prediction misses parts of the thin pole), 2.45, 2.73, 3.84, 1.26, 1.87, 2.57.
    // Without aggregation (gamma = 0.001) 9.5 with prediction and 15 without, with equal similarities 25 to 68.
    const double limits[9] = { 6.8, 7.2, 7.8, 2.8, 3.1, 4.5, 1.5, 2.2, 3.0 };
    EXPECT_LE(error, limitOf(GetParam(), limits));
}

//! What getForest() gives agrees with the other results of the same compute().
TEST(HDPStereo_PaperForest, agrees_with_the_other_results)
{
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 12);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(-2, 32, HDPTreeMatcher::PRESET_PAPER);
    Mat trees, intervals;
    std::vector<double> prior, ratios;
    matcher->getForest(trees, intervals);
    matcher->getLayerPrior(0, prior);
    EXPECT_TRUE(trees.empty() && intervals.empty() && prior.empty());

    change(*matcher, [&](Params& p) { p.disparityMedianSize = 0; });
    for (bool usePrediction : { true, false })
    {
        change(*matcher, [&](Params& p) { p.usePrediction = usePrediction; });
        const Mat disparity = match(*matcher, pair.left, pair.right);
        matcher->getForest(trees, intervals);
        matcher->getLayerPrior(0, prior);
        ratios = matcher->getFindings().searchRatios;
        ASSERT_EQ(CV_32SC1, trees.type());
        ASSERT_EQ(CV_16UC2, intervals.type());
        ASSERT_EQ(pair.left.size(), trees.size());
        ASSERT_EQ(pair.left.size(), intervals.size());
        EXPECT_EQ(usePrediction ? 32u : 0u, prior.size());

        std::map<int, Vec2w> ofTree;
        double searched = 0;
        for (int y = 0; y < trees.rows; ++y)
            for (int x = 0; x < trees.cols; ++x)
            {
                const Vec2w interval = intervals.at<Vec2w>(y, x);
                const int candidate = disparity.at<short>(y, x) / 16 + 2;
                ASSERT_TRUE(candidate >= interval[0] && candidate <= interval[1]) << x << ", " << y;
                searched += interval[1] - interval[0] + 1;
                const auto known = ofTree.insert(std::make_pair(trees.at<int>(y, x), interval));
                ASSERT_EQ(known.first->second, interval); // one for the whole tree
            }
        EXPECT_NEAR(ratios[0], searched / (32. * trees.total()), 0.005); // columns beside the image count, too
        EXPECT_EQ(0, ofTree.begin()->first);
        EXPECT_EQ((int)ofTree.size() - 1, ofTree.rbegin()->first);
        EXPECT_EQ(!usePrediction, ofTree.size() == 1);
    }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_PaperSystem, testing::ValuesIn(paperSystems));
INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_SlowPaperSystem, testing::ValuesIn(paperSystems));

//////////////////////////////////// the Aloe pair ////////////////////////////////////

typedef testing::TestWithParam<System> HDPStereo_SlowAloe;

//! The authors' program on the same images has these errors; a percentage point is left for what is random (RT) or
//! open (the order of equal edges).
TEST_P(HDPStereo_SlowAloe, error_like_the_authors_program)
{
    const Mat left = readSample("aloeL.jpg", IMREAD_COLOR), right = readSample("aloeR.jpg", IMREAD_COLOR);
    const Mat truth8 = readSample("aloeGT.png", IMREAD_GRAYSCALE);
    ASSERT_EQ(left.size(), truth8.size());
    Mat truth;
    truth8.convertTo(truth, CV_32F);
    const Mat known = truth8 > 0;

    const Mat disparity = match(*createSystem(GetParam(), 256), left, right);
    const double authors[9] = { 18.76, 17.77, 21.35, 18.74, 18.35, 23.03, 18.59, 18.11, 21.44 };
    const double error = badPixels(disparity, truth, known, 2);
    EXPECT_LE(error, limitOf(GetParam(), authors) + 1);
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_SlowAloe, testing::ValuesIn(paperSystems));

}} // namespace opencv_test
