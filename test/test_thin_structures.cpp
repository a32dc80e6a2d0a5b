// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/map_filters.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_ThinStructures, by_counting)
{
    RNG rng(26);
    for (const Size& size : { Size(1, 1), Size(3, 9), Size(60, 41) })
        for (int share : { 3, 8 })
        {
            Mat unfiltered(size, CV_16UC1, Scalar(200)), filtered, result;
            for (ushort& d : Mat_<ushort>(unfiltered))
                if (rng.uniform(0, share) == 0)
                    d = (ushort)(250 + rng.uniform(0, 60));
            for (int x = 0; x < size.width; x += 9)
                unfiltered.colRange(x, std::min(x + 2, size.width)).setTo(330);
            hdp::medianDisparity(unfiltered, 7, filtered);
            filtered.copyTo(result);
            hdp::restoreThinStructures(unfiltered, result);
            expectIdentical(oracle::restoreThinStructures(unfiltered, filtered), result);
        }
    // A line of three pixels comes back, one of two does not, nor does a background seen through a gap.
    Mat unfiltered(30, 60, CV_16UC1, Scalar(160)), result;
    unfiltered.colRange(10, 13).setTo(400);
    unfiltered.colRange(20, 22).setTo(400);
    unfiltered.colRange(40, 43).setTo(16);
    hdp::medianDisparity(unfiltered, 7, result);
    EXPECT_EQ((int)result.total(), countNonZero(result == 160));
    hdp::restoreThinStructures(unfiltered, result);
    Mat expected(unfiltered.size(), CV_16UC1, Scalar(160));
    expected.colRange(10, 13).setTo(400);
    expectIdentical(expected, result);
}

}} // namespace opencv_test
