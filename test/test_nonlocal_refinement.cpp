// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/left_right_check.hpp"
#include "../src/paper/nonlocal_refinement.hpp"

namespace opencv_test { namespace {

const int numDisparities = 24;
const int scale = hdp::subpixelScale;

//! A layer's forest, and the same one built by the rules
struct Layer
{
    hdp::DisparityForest forest;
    oracle::Forest expectedForest;

    Layer(const Mat& image, const TreeStrategy& strategy, const Mat& pixelIntv)
    {
        hdp::ForestBuffers buffers;
        hdp::buildForest(image, pixelIntv, strategy, 0.6, true, buffers, forest);
        expectedForest = oracle::buildForest(image, pixelIntv, strategy, 0.6, true);
    }
};

//! A layer of one minimum spanning tree
Layer oneTree(const Mat& image)
{
    return Layer(image, *createMinimumSpanningTree(), Mat(image.size(), CV_16UC2, Scalar(0, numDisparities - 1)));
}

//! Stripes of one interval each
Mat stripedIntervals(Size size)
{
    const int intervals[][2] = { { 0, 19 }, { 3, 3 }, { 5, 8 }, { 1, 0 }, { 10, 18 }, { 20, 23 } };
    Mat pixelIntv(size, CV_16UC2);
    for (int y = 0; y < size.height; ++y)
        pixelIntv.row(y).setTo(Scalar(intervals[y / 4 % 6][0], intervals[y / 4 % 6][1]));
    return pixelIntv;
}

Mat randomMask(RNG& rng, Size size, double share)
{
    Mat mask(size, CV_8UC1);
    for (uchar& value : Mat_<uchar>(mask))
        value = rng.uniform(0., 1.) < share ? 255 : 0;
    return mask;
}

//! Disparities below count, with a fraction or whole
Mat randomDisparity(RNG& rng, Size size, int count, bool subpixel)
{
    if (subpixel)
        return randomImage(rng, size, CV_16UC1, (count - 1) * scale + 1);
    return randomImage(rng, size, CV_16UC1, count) * scale;
}

Mat refine(const Layer& layer, const Mat& disparity, const Mat& stable, double gamma, bool subpixel = true)
{
    hdp::SumBuffers buffers;
    Mat refined;
    hdp::refineNonLocal(layer.forest, disparity, stable, gamma, subpixel, buffers, refined);
    return refined;
}

struct Votes // of the stable pixels of a tree for one pixel
{
    std::vector<std::pair<int, double>> disparities; // with their similarities, ascending
    double total;

    Votes(const Layer& layer, int pixel, const Mat& disparity, const Mat& stable, double gamma) : total(0)
    {
        for (const auto& other : oracle::similarities(layer.expectedForest.neighbours, pixel, gamma))
            if (stable.ptr()[other.first])
            {
                disparities.push_back(std::make_pair((int)disparity.ptr<ushort>()[other.first], other.second));
                total += other.second;
            }
        std::sort(disparities.begin(), disparities.end());
    }

    //! The sum of S |x - d_stable|, x a whole disparity
    double cost(int x) const
    {
        double sum = 0;
        for (const auto& d : disparities)
            sum += d.second * std::abs(x - d.first / (double)scale);
        return sum;
    }
};

// Of the library's sums, in float
const double sumError = 4e-6;

//! Whether a refined disparity is that of a whole winner, or of one that is as good but for rounding.
bool isWinner(const Votes& votes, bool subpixel, int own, bool isStable, int refined)
{
    std::vector<double> costs; // of -1, 0, ..., numDisparities
    for (int x = -1; x <= numDisparities; ++x)
        costs.push_back(votes.cost(x));
    const double lowest = *std::min_element(costs.begin(), costs.end());
    for (int x = 0; x < numDisparities; ++x)
    {
        const double middle = costs[x + 1], before = costs[x] - middle, after = costs[x + 2] - middle;
        if (middle > lowest + sumError * (lowest + votes.total))
            continue;
        if (isStable && hdp::wholeDisparity(own) == x)
        {
            if (refined == own)
                return true;
            continue;
        }
        if (!subpixel)
        {
            if (refined == x * scale)
                return true;
            continue;
        }
        const double steeper = std::max(before, after), error = sumError * (middle + votes.total);
        // Where costs are equal any slope may come out.
        const double offset = steeper > 2 * error ? (before - after) / steeper * (scale / 2) : 0;
        const double offsetError = steeper > 2 * error ? 2 * error / steeper * scale : scale / 2;
        if (refined >= x * scale + cvRound(offset - offsetError) &&
            refined <= x * scale + cvRound(offset + offsetError))
            return true;
    }
    return false;
}

//! Every n-th pixel against the explicit sums
void expectWinners(const Layer& layer, const Mat& disparity, bool subpixel, const Mat& stable, double gamma,
                   int step = 1)
{
    SCOPED_TRACE(testing::Message() << disparity.size() << ", trees " << layer.forest.trees.size() << ", sub-pixel "
                                    << subpixel << ", gamma " << gamma << ", stable " << cv::countNonZero(stable));
    const Mat refined = refine(layer, disparity, stable, gamma, subpixel);
    ASSERT_EQ(CV_16UC1, refined.type());
    ASSERT_EQ(disparity.size(), refined.size());
    for (int p = 0; p < (int)disparity.total(); p += step)
    {
        const int own = disparity.ptr<ushort>()[p], actual = refined.ptr<ushort>()[p];
        const Votes votes(layer, p, disparity, stable, gamma);
        if (votes.total < 1e-48) // 0 in float
        {
            ASSERT_EQ(own, actual) << "pixel " << p;
        }
        else if (votes.total > 1e-36) // else it has lost its digits
        {
            ASSERT_TRUE(isWinner(votes, subpixel, own, stable.ptr()[p] != 0, actual))
                << "pixel " << p << " of disparity " << own << ", refined " << actual;
        }
    }
}

TEST(HDPStereo_NonLocalRefinement, winner_of_explicit_sums)
{
    RNG rng(31);
    for (const Size& size : { Size(1, 1), Size(1, 30), Size(30, 1), Size(22, 25) })
        for (const Ptr<TreeStrategy>& strategy :
             { createMinimumSpanningTree(), createSegmentTree(20), createRandomTree(3) })
            for (const Mat& pixelIntv : { Mat(size, CV_16UC2, Scalar(0, numDisparities - 1)), stripedIntervals(size) })
            {
                const Layer layer(patchyImage(rng, size, CV_8UC3), *strategy, pixelIntv);
                for (bool subpixel : { false, true })
                {
                    const Mat disparity = randomDisparity(rng, size, numDisparities, subpixel);
                    for (double share : { 0., 0.05, 0.7, 1. })
                        for (double gamma : { 5., 25.5 })
                            expectWinners(layer, disparity, subpixel, randomMask(rng, size, share), gamma);
                }
            }
}

//! Each number of candidates goes its own way through the groups of 4 and 8.
TEST(HDPStereo_NonLocalRefinement, winner_among_any_number_of_candidates)
{
    RNG rng(32);
    const Size size(14, 11);
    const Layer layer = oneTree(patchyImage(rng, size, CV_8UC1));
    for (bool subpixel : { false, true })
        for (int first : { 0, 2 })
            for (int count = 1; first + count <= numDisparities; ++count)
            {
                const Mat disparity = randomDisparity(rng, size, count, subpixel) + first * scale;
                for (double gamma : { 2., 25.5 })
                    expectWinners(layer, disparity, subpixel, randomMask(rng, size, 0.8), gamma);
            }
}

//! A large tree's groups of candidates go side by side.
TEST(HDPStereo_NonLocalRefinement, winner_in_a_large_tree)
{
    RNG rng(33);
    const Size size(210, 160);
    const Layer layer = oneTree(patchyImage(rng, size, CV_8UC3));
    ASSERT_EQ(1u, layer.forest.trees.size());
    for (bool subpixel : { false, true })
    {
        const Mat disparity = randomDisparity(rng, size, numDisparities, subpixel);
        expectWinners(layer, disparity, subpixel, randomMask(rng, size, 0.5), 5, 997);
        expectWinners(layer, disparity, subpixel, Mat(size, CV_8UC1, Scalar(0)), 5, 997);
    }
}

//! The sum of S |x - d_stable| is smallest at the median of the d_stable, weighted by S.
TEST(HDPStereo_NonLocalRefinement, weighted_median)
{
    RNG rng(34);
    const Size size(25, 20);
    const Layer layer = oneTree(patchyImage(rng, size, CV_8UC3));
    const Mat disparity = randomDisparity(rng, size, numDisparities, false), stable = randomMask(rng, size, 0.6);
    const Mat refined = refine(layer, disparity, stable, 10, false);
    int ambiguous = 0;
    for (int p = 0; p < size.area(); ++p)
    {
        const Votes votes(layer, p, disparity, stable, 10);
        double below = 0;
        size_t i = 0;
        while (2 * (below + votes.disparities[i].second) < votes.total)
            below += votes.disparities[i++].second;
        const bool isTie = std::abs(2 * (below + votes.disparities[i].second) - votes.total) < 1e-4 * votes.total;
        if (isTie)
            ++ambiguous;
        else
            EXPECT_EQ(votes.disparities[i].first, refined.ptr<ushort>()[p]) << "pixel " << p;
    }
    EXPECT_LE(ambiguous, size.area() / 20);
}

//! Whatever the unstable pixels say; with a fraction, which is not lost, below 1 neither.
TEST(HDPStereo_NonLocalRefinement, one_stable_disparity)
{
    RNG rng(35);
    const Size size(30, 20);
    const Layer layer = oneTree(patchyImage(rng, size, CV_8UC3));
    for (int value : { 0, 3, 5, 8, 13, 16, 160, 167, 168, 169, 367 })
    {
        SCOPED_TRACE(testing::Message() << value);
        const Mat constant(size, CV_16UC1, Scalar(value));
        for (double share : { 1., 0.5, 0. })
            expectIdentical(constant, refine(layer, constant, randomMask(rng, size, share), 25.5));

        const Mat stable = randomMask(rng, size, 0.1);
        Mat disparity = randomImage(rng, size, CV_16UC1, 400);
        disparity.setTo(Scalar(value), stable);
        ASSERT_GT(countDifferent(constant, disparity), 0);
        expectIdentical(constant, refine(layer, disparity, stable, 25.5));
    }
}

TEST(HDPStereo_NonLocalRefinement, outliers_in_a_flat_region)
{
    const Size size(30, 20);
    const Layer layer = oneTree(Mat(size, CV_8UC3, Scalar(90, 100, 110)));
    const Mat constant(size, CV_16UC1, Scalar(167)), stable(size, CV_8UC1, Scalar(255));
    Mat disparity = constant.clone();
    for (int i = 0; i < 20; ++i)
        disparity.at<ushort>(i, (7 * i) % size.width) = (ushort)(37 * i);
    expectIdentical(constant, refine(layer, disparity, stable, 25.5));
}

//! Two surfaces of one color and disparity each: unstable pixels take the disparity of their color, which wins over
//! that of nearer pixels.
TEST(HDPStereo_NonLocalRefinement, unstable_pixels_take_the_disparity_of_similar_ones)
{
    RNG rng(36);
    const Size size(40, 24);
    Mat image(size, CV_8UC3), truth(size, CV_16UC1);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const bool isFront = x > 15 + y / 4;
            image.at<Vec3b>(y, x) = isFront ? Vec3b(200, 60, 30) : Vec3b(40, 50, 60);
            truth.at<ushort>(y, x) = isFront ? 301 : 85;
        }
    const Layer layer = oneTree(image);
    Mat stable = randomMask(rng, size, 0.3);
    stable.colRange(10, 30).setTo(Scalar(0)); // on both sides of the edge
    Mat disparity = randomImage(rng, size, CV_16UC1, 16 * numDisparities);
    truth.copyTo(disparity, stable);
    expectIdentical(truth, refine(layer, disparity, stable, 10));
}

//! S underflows: no stable pixel says anything, as if there were none.
TEST(HDPStereo_NonLocalRefinement, pixels_similar_to_no_stable_one)
{
    RNG rng(37);
    const Size size(20, 10);
    for (int levels : { 1, numDisparities }) // one or several runs of candidates
    {
        Mat image(size, CV_8UC1, Scalar(0)), stable(size, CV_8UC1, Scalar(255));
        image.colRange(12, 20).setTo(Scalar(255));
        stable.colRange(12, 20).setTo(Scalar(0));
        const Layer layer = oneTree(image);
        ASSERT_EQ(1u, layer.forest.trees.size());
        Mat disparity = randomImage(rng, size, CV_16UC1, levels * scale);
        disparity.colRange(12, 20) = 23 * scale;
        const Mat refined = refine(layer, disparity, stable, 1);
        expectIdentical(disparity.colRange(12, 20), refined.colRange(12, 20));
    }
}

TEST(HDPStereo_NonLocalRefinement, any_number_of_threads)
{
    RNG rng(38);
    const int threads = cv::getNumThreads();
    const Size size(230, 170);
    for (const Mat& pixelIntv : { Mat(size, CV_16UC2, Scalar(0, numDisparities - 1)), stripedIntervals(size) })
    {
        const Layer layer(patchyImage(rng, size, CV_8UC3), *createMinimumSpanningTree(), pixelIntv);
        const Mat disparity = randomImage(rng, size, CV_16UC1, 16 * numDisparities);
        std::vector<Mat> refined;
        for (int n : { 1, 2, 8 })
        {
            cv::setNumThreads(n);
            Mat stable;
            hdp::findStable(disparity, stable);
            refined.push_back(refine(layer, disparity, stable, 10));
        }
        cv::setNumThreads(threads);
        expectIdentical(refined[0], refined[1]);
        expectIdentical(refined[0], refined[2]);
    }
}

//! Stable: maps to a column of the right image, to which no disparity maps that is larger by more than a pixel.
TEST(HDPStereo_NonLocalRefinement, stable_pixels_by_comparing_all_pairs)
{
    RNG rng(39);
    const Size size(50, 20);
    for (int run = 0; run < 4; ++run)
    {
        const Mat disparity = randomImage(rng, size, CV_16UC1, 20 * scale);
        Mat expected(size, CV_8UC1), stable;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int own = disparity.at<ushort>(y, x), column = x - cvRound(own / (double)scale);
                bool isStable = column >= 0;
                for (int other = 0; other < size.width; ++other)
                {
                    const int theirs = disparity.at<ushort>(y, other);
                    if (other - cvRound(theirs / (double)scale) == column && (theirs - own) > scale)
                        isStable = false;
                }
                expected.at<uchar>(y, x) = isStable ? 255 : 0;
            }
        hdp::findStable(disparity, stable);
        expectIdentical(expected, stable);
        EXPECT_GT(cv::countNonZero(stable == 0), 0);
    }
}

//! So far from all stable pixels that few bits are left of the costs, candidates tie: the result stays between them.
TEST(HDPStereo_NonLocalRefinement, vanishing_similarities)
{
    const int width = 400, step = 5;
    Mat image(1, width, CV_8UC1);
    for (int x = 0; x < width; ++x)
        image.at<uchar>(0, x) = (uchar)(x % 2 * step);
    const Layer layer = oneTree(image);
    for (double gamma : { 2., 5., 7.5, 9. }) // the similarity becomes 0 in float within the row
        for (int highest : { 0, 1, 7, numDisparities - 1 })
        {
            SCOPED_TRACE(testing::Message() << "gamma " << gamma << ", to " << highest);
            Mat disparity(1, width, CV_16UC1, Scalar(highest / 2 * scale)), stable(1, width, CV_8UC1, Scalar(0));
            disparity.at<ushort>(0, 1) = (ushort)(highest * scale);
            disparity.at<ushort>(0, 0) = 0;
            stable.colRange(0, 2).setTo(255);
            double lowest, largest;
            cv::minMaxLoc(refine(layer, disparity, stable, gamma), &lowest, &largest);
            EXPECT_GE(lowest, 0);
            EXPECT_LE(largest, highest * scale);
        }
}

}} // namespace opencv_test
