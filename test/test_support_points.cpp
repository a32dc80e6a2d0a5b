// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"
#include "../src/paper/support_points.hpp"

namespace opencv_test { namespace {

void testSupportPoints(const Mat& left, const Mat& right, int numDisparities, int atLeast)
{
    SCOPED_TRACE(testing::Message() << left.size() << ", " << numDisparities << " disparities");
    hdp::SupportPointBuffers buffers;
    Mat points;
    hdp::findSupportPoints(left, right, numDisparities, buffers, points);
    const Mat expected = oracle::SupportPoints(left, right, numDisparities).find();
    expectIdentical(expected, points);
    EXPECT_GE(cv::countNonZero(expected >= 0), atLeast) << "the test is empty";
}

TEST(HDPStereo_SupportPoints, direct_search)
{
    const SyntheticPair pair = makeSyntheticPair(Size(131, 90), 24, 1);
    testSupportPoints(pair.left, pair.right, 24, 100);
    testSupportPoints(oracle::grey(pair.left), oracle::grey(pair.right), 24, 100);
}

TEST(HDPStereo_SupportPoints, direct_search_in_noise)
{
    RNG rng(8);
    testSupportPoints(randomImage(rng, Size(70, 61), CV_8UC1), randomImage(rng, Size(70, 61), CV_8UC1), 40, 0);
    // Few levels: many equal dissimilarities, little texture
    testSupportPoints(randomImage(rng, Size(72, 60), CV_8UC1, 3), randomImage(rng, Size(72, 60), CV_8UC1, 3), 16, 0);
}

TEST(HDPStereo_SupportPoints, more_disparities_than_columns)
{
    const SyntheticPair pair = makeSyntheticPair(Size(60, 45), 20, 2);
    testSupportPoints(pair.left, pair.right, 100, 5);
}

TEST(HDPStereo_SupportPoints, numbers_of_disparities_around_the_shortest_range)
{
    const SyntheticPair pair = makeSyntheticPair(Size(60, 45), 10, 3);
    for (int numDisparities : { 1, 9, 10, 11, 12 })
        testSupportPoints(pair.left, pair.right, numDisparities, numDisparities > 10 ? 5 : 0);
}

TEST(HDPStereo_SupportPoints, sizes_around_the_border)
{
    RNG rng(9);
    for (int width : { 1, 4, 10, 11, 12, 21, 22, 27 })
        for (int height : { 1, 10, 11, 12, 13, 16, 17 })
        {
            Mat left = randomImage(rng, Size(width, height), CV_8UC1, 100);
            testSupportPoints(left, left.clone(), 14, 0);
        }
}

TEST(HDPStereo_SupportPoints, buffers_serve_pairs_of_any_size)
{
    hdp::SupportPointBuffers buffers;
    for (const Size& size : { Size(90, 60), Size(40, 70), Size(90, 60) })
    {
        const SyntheticPair pair = makeSyntheticPair(size, 16, 4);
        Mat points;
        hdp::findSupportPoints(pair.left, pair.right, 16, buffers, points);
        expectIdentical(oracle::SupportPoints(pair.left, pair.right, 16).find(), points);
    }
}

TEST(HDPStereo_SupportPoints, histogram_counts_every_disparity)
{
    const Mat points = Mat_<short>({ 2, 4 }, { -1, 0, 3, 3, 1, -1, 0, 3 });
    std::vector<double> histogram;
    hdp::disparityHistogram(points, 5, histogram);
    ASSERT_EQ(5u, histogram.size());
    ASSERT_GT(histogram[1], 0);
    for (int d = 0; d < 5; ++d)
        EXPECT_DOUBLE_EQ(d == 0 ? 2 : d == 1 ? 1 : d == 3 ? 3 : 0, histogram[d] / histogram[1]) << d;
}

TEST(HDPStereo_SupportPoints, histogram_without_points_is_uniform)
{
    for (int value : { -1, 4 })
    {
        std::vector<double> histogram;
        hdp::disparityHistogram(Mat(3, 5, CV_16SC1, Scalar(value)), 4, histogram);
        ASSERT_EQ(4u, histogram.size());
        for (int d = 0; d < 4; ++d)
            EXPECT_TRUE(histogram[d] > 0 && histogram[d] == histogram[0]);
    }
}

}} // namespace opencv_test
