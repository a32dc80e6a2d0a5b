// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/map_filters.hpp"

namespace opencv_test { namespace {

//! A slope in eighths of the noise, squared
int squaredSlope(const Mat& levels, double noise, int x, int y)
{
    const int v = oracle::clamped(y, levels.rows);
    const auto level = [&](int u) { return (int)levels.at<ushort>(v, oracle::clamped(u, levels.cols)); };
    const int u = oracle::clamped(x, levels.cols);
    const int change = std::min(std::abs(level(u - 1) - level(u + 1)), cvFloor(36 * noise));
    const int slope = change * cvFloor(256 / noise) / 256;
    return slope * slope;
}

int precisionOf(const Mat& levels, double noise, int x, int y)
{
    int sum = 0;
    for (int dy = -3; dy <= 3; ++dy)
        for (int dx = -3; dx <= 3; ++dx)
            sum += squaredSlope(levels, noise, x + dx, y + dy);
    return std::max((sum - 49 * 32) / 64, 1);
}

//! A pass: pairs at one, two and four times the step
Mat smoothOnce(const Mat& disparity, const Mat& precision, Point step, int like)
{
    Mat smoothed = disparity.clone();
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const int own = disparity.at<ushort>(y, x), ownWeight = std::max(precision.at<int>(y, x), 1);
            int weights = ownWeight, sum = own * ownWeight;
            for (int k : { 1, 2, 4 })
            {
                const Point before = Point(x, y) - k * step, after = Point(x, y) + k * step;
                if (before.x < 0 || before.y < 0 || after.x >= disparity.cols || after.y >= disparity.rows)
                    continue;
                const int distance = k * std::max(step.x, step.y);
                const int limit = std::max(cvRound(64. / (distance * distance)), 1);
                const int weight = std::min({ precision.at<int>(before), precision.at<int>(after), limit });
                const int first = disparity.at<ushort>(before), second = disparity.at<ushort>(after);
                if (std::abs(first - own) > like || std::abs(second - own) > like)
                    continue;
                weights += 2 * weight;
                sum += weight * (first + second);
            }
            smoothed.at<ushort>(y, x) = (ushort)((sum + weights / 2) / weights);
        }
    return smoothed;
}

//! hdp::smoothSurfaces(), pixel by pixel
Mat smoothedMap(const Mat& levels, double noise, int like, const Mat& disparity)
{
    Mat precision(disparity.size(), CV_32S), smoothed = disparity;
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
            precision.at<int>(y, x) = precisionOf(levels, std::max(noise, 0.5), x, y);
    precision.setTo(Scalar(0), disparity == USHRT_MAX);
    for (int step : { 1, 3 })
    {
        smoothed = smoothOnce(smoothed, precision, Point(step, 0), like);
        smoothed = smoothOnce(smoothed, precision, Point(0, step), like);
    }
    return smoothed;
}

TEST(HDPStereo_SurfaceSmoothing, oracle)
{
    RNG rng(97);
    for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(2, 3), Size(7, 3), Size(61, 40), Size(20, 300) })
        for (int disparities : { 5, 30, 65504 })
            for (double noise : { 0., 1.7, 12. })
            {
                SCOPED_TRACE(testing::Message() << size << ", " << disparities << ", noise " << noise);
                const int like = disparities == 30 ? 10 : 20;
                const Mat levels = randomImage(rng, size, CV_16UC1, noise == 0 ? 12 : 1024);
                Mat disparity = randomImage(rng, size, CV_16UC1, disparities), smoothed;
                if (disparities == 30)
                    disparity += 65505 - disparities; // up to the largest one
                Mat missing(size, CV_8U);
                rng.fill(missing, RNG::UNIFORM, 0, 20);
                missing = missing == 0;
                disparity.setTo(Scalar(USHRT_MAX), missing);
                Mat expected = smoothedMap(levels, noise, like, disparity);
                hdp::smoothSurfaces(levels, noise, like, disparity, smoothed);
                expected.setTo(Scalar(0), missing);
                smoothed.setTo(Scalar(0), missing);
                expectIdentical(expected, smoothed);
            }
}

//! Rows with noise of a level and a given contrast
Mat textured(RNG& rng, Size size, double contrast)
{
    Mat levels(size, CV_16U), noise(size, CV_16S);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            levels.at<ushort>(y, x) = (ushort)(400 + cvRound(contrast * 4 * std::sin(x * 0.9 + y * 0.4)));
    rng.fill(noise, RNG::NORMAL, 0, 4);
    cv::add(levels, noise, levels, noArray(), CV_16U);
    return levels;
}

TEST(HDPStereo_SurfaceSmoothing, noise_of_slopes_but_not_steps)
{
    RNG rng(98);
    Mat truth(60, 80, CV_16U), noise(truth.size(), CV_16S), noisy, smoothed;
    for (int y = 0; y < truth.rows; ++y)
        for (int x = 0; x < truth.cols; ++x)
            truth.at<ushort>(y, x) = (ushort)(x < 40 ? 400 + x + 2 * y : 900 - 2 * x);
    rng.fill(noise, RNG::NORMAL, 0, 2.5);
    cv::add(truth, noise, noisy, noArray(), CV_16U);
    hdp::smoothSurfaces(textured(rng, truth.size(), 0), 1, 20, noisy, smoothed);
    EXPECT_LT(cv::norm(smoothed, truth, NORM_L2), 0.4 * cv::norm(noisy, truth, NORM_L2));
    EXPECT_LT(cv::norm(smoothed, truth, NORM_INF), 16) << "of pixels beside the step, too";
}

TEST(HDPStereo_SurfaceSmoothing, texture_keeps_its_details)
{
    RNG rng(99);
    Mat truth(60, 80, CV_16U), smoothed; // waves of half a pixel
    for (int y = 0; y < truth.rows; ++y)
        for (int x = 0; x < truth.cols; ++x)
            truth.at<ushort>(y, x) = (ushort)cvRound(300 + 4 * std::sin(x * 0.6));
    hdp::smoothSurfaces(textured(rng, truth.size(), 40), 1, 20, truth, smoothed);
    EXPECT_LT(cv::norm(smoothed, truth, NORM_INF), 2);
    hdp::smoothSurfaces(textured(rng, truth.size(), 0), 1, 20, truth, smoothed);
    EXPECT_LT(2, cv::norm(smoothed, truth, NORM_INF)) << "nothing tells waves from noise";
}

TEST(HDPStereo_SurfaceSmoothing, bare_gap_in_texture)
{
    RNG rng(100);
    const Size size(80, 60);
    Mat levels = textured(rng, size, 40), disparity(size, CV_16U, Scalar(320)), smoothed;
    const Rect gap(34, 0, 12, size.height), bare(37, 0, 6, size.height); // whose windows are in the gap
    textured(rng, size, 0)(gap).copyTo(levels(gap));
    disparity(bare).setTo(Scalar(326)); // 3/8 pixels off
    hdp::smoothSurfaces(levels, 1, 20, disparity, smoothed);
    EXPECT_LT(cv::mean(smoothed(bare))[0], 324);
    const Rect left(0, 0, 34, size.height);
    EXPECT_LT(cv::norm(smoothed(left), disparity(left), NORM_INF), 2) << "texture knows better";
}

}} // namespace opencv_test
