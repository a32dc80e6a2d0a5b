// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "../src/pair/pair_alignment.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_NoiseSmoothing, is_a_filter_of_3_x_3_pixels)
{
    RNG rng(81);
    for (int neighbour : { 0, 1, 27, hdp::mostSmoothing })
    {
        const Mat weights = (Mat_<double>(3, 1) << neighbour, 256 - 2 * neighbour, neighbour) / 256;
        for (const Size& size : { Size(1, 1), Size(7, 1), Size(1, 9), Size(2, 2), Size(45, 31) })
        {
            const Mat image = randomImage(rng, size, CV_16UC1, 1024);
            Mat smoothed, exact, expected;
            hdp::smoothNoise(image, neighbour, smoothed);
            ASSERT_EQ(CV_16UC1, smoothed.type());
            image.convertTo(exact, CV_64F);
            sepFilter2D(exact, expected, CV_64F, weights, weights, Point(-1, -1), 0, BORDER_REPLICATE);
            smoothed.convertTo(smoothed, CV_64F);
            EXPECT_LE(cv::norm(smoothed, expected, NORM_INF), 0.5 + 1e-9) << size << ", rounded once";
        }
        const Mat plain(5, 6, CV_16UC1, Scalar(1023));
        Mat smoothed;
        hdp::smoothNoise(plain, neighbour, smoothed);
        expectIdentical(plain, smoothed);
    }
}

}} // namespace opencv_test
