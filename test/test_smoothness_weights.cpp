// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/smoothness_weights.hpp"

namespace opencv_test { namespace {

const int bits = 24, side = 25; // of a window

//! The formula of weighSmoothness(), in doubles; borders replicated, as in its windows
double expectedWeight(const Mat& upper, const Mat& residual, Point p)
{
    using oracle::clamped;
    double sum = 0, breaks = 0;
    for (int dy = -side / 2; dy <= side / 2; ++dy)
        for (int dx = -side / 2; dx <= side / 2; ++dx)
        {
            const int x = clamped(p.x + dx, upper.cols), y = clamped(p.y + dy, upper.rows);
            const int cost = residual.at<uchar>(y, x), own = upper.at<ushort>(y, x);
            sum += cost == 255 ? bits / 8 : std::min(cost, bits / 2);
            breaks += std::abs(upper.at<ushort>(y, clamped(x + 1, upper.cols)) - own) > 16;
            breaks += std::abs(upper.at<ushort>(clamped(y + 1, upper.rows), x) - own) > 16;
        }
    const double r = std::min(sum / (side * side * bits), 0.45), q = breaks / (2 * side * side);
    const double evidence = (0.5 - r) * std::log((1 - r) / r);
    return std::min(std::max(-std::log(std::min(q + 0.001, 1.)) / (7.3 * evidence), 0.4), 1.8);
}

Mat weightsOf(const Mat& upper, const Mat& residual, int least = hdp::SmoothnessWeight::min)
{
    Mat weights;
    hdp::weighSmoothness(upper, residual, bits, { side / 2, least, hdp::SmoothnessWeight::max }, weights);
    EXPECT_EQ(upper.size(), weights.size());
    EXPECT_EQ(CV_8UC1, weights.type());
    return weights;
}

//! Of a map of one value, with costs of one value
double weightOf(int cost)
{
    return weightsOf(Mat(40, 50, CV_16UC1, Scalar(160)), Mat(40, 50, CV_8UC1, Scalar(cost))).at<uchar>(20, 25) / 64.;
}

TEST(HDPStereo_SmoothnessWeights, formula)
{
    RNG rng(71);
    int between = 0;
    for (const Size& size : { Size(1, 1), Size(7, 1), Size(1, 30), Size(50, 41), Size(90, 150) })
        for (int steps : { 1, 4, 30 })
            for (int mostCost : { 2, 10, 20 })
            {
                SCOPED_TRACE(testing::Message() << size << ", 1 of " << steps << ", costs to " << mostCost);
                Mat upper(size, CV_16UC1), residual = randomImage(rng, size, CV_8UC1, mostCost + 1);
                int disparity = 100;
                for (int y = 0; y < size.height; ++y)
                    for (int x = 0; x < size.width; ++x)
                    {
                        disparity = rng.uniform(0, steps) ? disparity : rng.uniform(0, 200);
                        upper.at<ushort>(y, x) = (ushort)disparity;
                        if (rng.uniform(0, 20) == 0)
                            residual.at<uchar>(y, x) = 255; // no data
                    }
                const Mat weights = weightsOf(upper, residual);
                for (int y = 0; y < size.height; y += 3)
                    for (int x = 0; x < size.width; x += 3)
                    {
                        const double expected = expectedWeight(upper, residual, Point(x, y));
                        const int weight = weights.at<uchar>(y, x);
                        ASSERT_NEAR(64 * expected, weight, 1 + 0.06 * 64 * expected) << "x " << x << " y " << y;
                        between += weight > hdp::SmoothnessWeight::min && weight < hdp::SmoothnessWeight::max;
                    }
            }
    EXPECT_GT(between, 1000) << "nothing but limits is tested";
}

TEST(HDPStereo_SmoothnessWeights, rise_with_residuals_and_fall_with_steps)
{
    EXPECT_LT(weightOf(1), weightOf(3));
    EXPECT_LT(weightOf(3), weightOf(4));
    EXPECT_DOUBLE_EQ(+hdp::SmoothnessWeight::max / 64., weightOf(12)); // chance
    const Mat residual(60, 60, CV_8UC1, Scalar(3));
    EXPECT_EQ(100, weightsOf(Mat(9, 9, CV_16UC1, Scalar(0)), Mat(9, 9, CV_8UC1, Scalar(0)), 100).at<uchar>(4, 4));
    Mat upper(60, 60, CV_16UC1, Scalar(160));
    int last = weightsOf(upper, residual).at<uchar>(30, 30);
    for (int columns : { 20, 12, 7, 4 }) // between steps
    {
        for (int x = 0; x < upper.cols; ++x)
            upper.col(x).setTo(Scalar(160 + 32 * ((x + columns / 2) / columns % 2)));
        const int weight = weightsOf(upper, residual).at<uchar>(30, 30);
        EXPECT_LT(weight, last) << columns;
        last = weight;
    }
}

//! What is no step, and is far away, changes nothing.
TEST(HDPStereo_SmoothnessWeights, slopes_and_distant_pixels_do_not_count)
{
    const Mat residual(80, 80, CV_8UC1, Scalar(3));
    Mat slanted(80, 80, CV_16UC1);
    for (int x = 0; x < 80; ++x)
        slanted.col(x).setTo(Scalar(16 * x)); // a pixel from one to the next
    const Mat flat = weightsOf(Mat(80, 80, CV_16UC1, Scalar(0)), residual);
    expectIdentical(flat, weightsOf(slanted, residual));
    Mat distant = residual.clone();
    distant.colRange(60, 80).setTo(Scalar(20));
    expectIdentical(flat.colRange(0, 60 - side / 2), weightsOf(slanted, distant).colRange(0, 60 - side / 2));
}

}} // namespace opencv_test
