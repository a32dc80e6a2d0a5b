// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/map_filters.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_MedianFilter, by_sorting)
{
    RNG rng(22);
    for (const Size& size : { Size(1, 1), Size(1, 7), Size(7, 1), Size(2, 2), Size(5, 3), Size(33, 29) })
        for (int levels : { 2, 64, 256, 257, 1000, 65536 })
            for (int window : { 3, 5, 7 })
            {
                SCOPED_TRACE(testing::Message() << size << ", window " << window << ", levels " << levels);
                const Mat disparity = randomImage(rng, size, CV_16UC1, levels);
                Mat filtered;
                hdp::medianDisparity(disparity, window, filtered);
                expectIdentical(oracle::median(disparity, window), filtered);
            }
}

TEST(HDPStereo_MedianFilter, many_rows)
{
    RNG rng(23);
    for (int window : { 3, 5, 7 })
        for (int levels : { 300, 65536 })
        {
            const Mat disparity = randomImage(rng, Size(20, 700), CV_16UC1, levels);
            Mat filtered(20, 20, CV_16UC1); // a buffer of another size
            hdp::medianDisparity(disparity, window, filtered);
            expectIdentical(oracle::median(disparity, window), filtered);
        }
}

}} // namespace opencv_test
