// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/pair/image_pyramid.hpp"
#include "../src/pair/pair_pyramids.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_ImagePyramid, means_of_2x2_pixels_truncated)
{
    const Size sizes[] = { Size(2, 2), Size(3, 2), Size(2, 3), Size(64, 48), Size(65, 47), Size(101, 2) };
    RNG rng(1);
    for (const Size& size : sizes)
        for (int type : { CV_8UC1, CV_8UC3 })
        {
            SCOPED_TRACE(testing::Message() << size << " type " << type);
            const Mat image = randomImage(rng, size, type);
            Mat half;
            hdp::halveImage(image, half);
            expectIdentical(oracle::halve(image), half);
        }
}

TEST(HDPStereo_ImagePyramid, means_of_2x2_grey_levels_rounded)
{
    RNG rng(37);
    for (const Size& size : { Size(2, 2), Size(3, 2), Size(2, 3), Size(64, 48), Size(65, 47), Size(101, 2) })
        for (int levels : { 4, 1021, 65536 })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << levels << " levels");
            const Mat image = randomImage(rng, size, CV_16UC1, levels);
            Mat half;
            hdp::halveImage(image, half);
            expectIdentical(oracle::halve(image), half);
        }
}

TEST(HDPStereo_ImagePyramid, halves_a_region_of_interest)
{
    RNG rng(2);
    const Mat image = randomImage(rng, Size(40, 30), CV_8UC3);
    const Mat region = image(Rect(5, 3, 21, 17));
    Mat half;
    hdp::halveImage(region, half);
    expectIdentical(oracle::halve(region.clone()), half);
}

TEST(HDPStereo_ImagePyramid, largest_disparity_is_halved_and_included)
{
    for (int largest = 0; largest < 300; ++largest)
        for (int layer = 0, expected = largest; layer < 10; ++layer, expected /= 2)
            ASSERT_EQ(expected + 1, hdp::layerDisparities(largest + 1, layer, false));
}

//! The largest disparity of a layer, which need not be whole, lies between two of its candidates.
TEST(HDPStereo_ImagePyramid, subpixel_range_includes_the_largest_disparity)
{
    for (int largest = 0; largest < 300; ++largest)
        for (int layer = 0; layer < 10; ++layer)
            ASSERT_EQ(cvCeil(largest / std::pow(2., layer)) + 1, hdp::layerDisparities(largest + 1, layer, true));
    EXPECT_EQ(2, hdp::layerDisparities(INT_MAX, 31, true));
}

TEST(HDPStereo_ImagePyramid, shifts_columns_and_repeats_the_nearest)
{
    RNG rng(3);
    const Mat right = randomImage(rng, Size(9, 4), CV_8UC3);
    for (int extension : { 0, 1, 7, 20 })
        for (int shift : { 0, 1, 5, 8, 9, 10, 1000, INT_MAX, -1, -8, -9, -10, -1000, INT_MIN })
        {
            SCOPED_TRACE(testing::Message() << shift << ", extension " << extension);
            Mat expected(right.rows, right.cols + extension, right.type()), memory;
            for (int x = 0; x < expected.cols; ++x)
            {
                const int64 from = std::max<int64>(0, std::min<int64>((int64)x - extension - shift, right.cols - 1));
                right.col((int)from).copyTo(expected.col(x));
            }
            expectIdentical(expected, hdp::shiftColumns(right, shift, extension, memory));
        }
}

}} // namespace opencv_test
