// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/disparity_output.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_Upsampling, bilinear_inside_surfaces)
{
    RNG rng(45);
    for (const Size& size : { Size(2, 2), Size(3, 2), Size(2, 9), Size(3, 3), Size(64, 40), Size(65, 41) })
        for (int levels : { 1, 3, 40, 1024 * 16 }) // within a pixel, and anything
        {
            SCOPED_TRACE(testing::Message() << size << ", levels " << levels);
            const Mat upper = randomImage(rng, size / 2, CV_16UC1, levels);
            Mat disparity(5, 5, CV_16UC1);
            hdp::upsampleDisparity(upper, size, disparity);
            expectIdentical(oracle::upsampled(upper, size), disparity);
        }
}

//! A slanted plane stays one, at twice the size; a step stays sharp.
TEST(HDPStereo_Upsampling, planes_and_steps)
{
    Mat upper(20, 30, CV_16UC1), disparity;
    for (int y = 0; y < upper.rows; ++y)
        for (int x = 0; x < upper.cols; ++x)
            upper.at<ushort>(y, x) = (ushort)((x < 15 ? 100 : 400) + 8 * x + 4 * y);
    hdp::upsampleDisparity(upper, Size(60, 40), disparity);
    for (int y = 1; y < 39; ++y)
        for (int x = 1; x < 59; ++x)
            if (std::abs(x - 29.5) > 1) // beside the step the slope has but one side
            {
                // The pixel's centre in the upper layer is at (x - 0.5) / 2.
                const double exact = 2 * ((x < 30 ? 100 : 400) + 8 * (x - 0.5) / 2 + 4 * (y - 0.5) / 2);
                EXPECT_NEAR(exact, disparity.at<ushort>(y, x), 0.5) << "y " << y << " x " << x;
            }
            else
                EXPECT_NEAR(2 * (x < 30 ? 100 : 400) + 8 * x + 4 * y, disparity.at<ushort>(y, x), 16);
}

}} // namespace opencv_test
