// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/map_filters.hpp"

namespace opencv_test { namespace {

//! hdp::smoothSurfaces() for a pixel
ushort smoothedDisparity(const Mat& disparity, int x, int y)
{
    const auto at = [&](int u, int v) {
        return (int)disparity.at<ushort>(oracle::clamped(v, disparity.rows), oracle::clamped(u, disparity.cols));
    };
    const int own = at(x, y), likeness = 16; // a pixel
    int sum = 0;
    for (int k = 1; k <= 4; ++k)
        for (const Point& step : { Point(k, 0), Point(0, k) })
        {
            const int before = at(x - step.x, y - step.y), after = at(x + step.x, y + step.y);
            const bool isLike = std::abs(before - own) <= likeness && std::abs(after - own) <= likeness;
            sum += isLike ? before + after : 2 * own;
        }
    return (ushort)((sum + 8) / 16);
}

TEST(HDPStereo_SurfaceSmoothing, oracle)
{
    RNG rng(97);
    for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(7, 3), Size(61, 40), Size(20, 150) })
        for (int levels : { 5, 30, 65536 })
        {
            SCOPED_TRACE(testing::Message() << size << ", levels " << levels);
            Mat disparity = randomImage(rng, size, CV_16UC1, levels);
            if (levels == 30)
                disparity += 65536 - levels; // up to the largest one
            Mat expected(size, CV_16U), smoothed;
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                    expected.at<ushort>(y, x) = smoothedDisparity(disparity, x, y);
            hdp::smoothSurfaces(disparity, smoothed);
            expectIdentical(expected, smoothed);
        }
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
    hdp::smoothSurfaces(noisy, smoothed);
    const Rect inside(5, 5, 70, 50); // slopes are not those of what is beyond the image
    EXPECT_LT(cv::norm(smoothed(inside), truth(inside), NORM_L2),
              0.4 * cv::norm(noisy(inside), truth(inside), NORM_L2));
    EXPECT_LT(cv::norm(smoothed(inside), truth(inside), NORM_INF), 16) << "of pixels beside the step, too";
}

}} // namespace opencv_test
