// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "../src/map/left_right_check.hpp"

namespace opencv_test { namespace {

//! A left pixel is kept if no other one that maps to its column of the right image is nearer by more than maxDiff.
Mat rejectOccludedByPairs(const Mat& disparity, int maxDiff, short invalid)
{
    Mat result = disparity.clone();
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
            for (int other = 0; other < disparity.cols; ++other)
            {
                const int own = disparity.at<short>(y, x), theirs = disparity.at<short>(y, other);
                const int column = x - cvRound(own / 16.);
                if (own != invalid && theirs != invalid && column >= 0 && column < disparity.cols &&
                    column == other - cvRound(theirs / 16.) && theirs - own > 16 * maxDiff)
                    result.at<short>(y, x) = invalid;
            }
    return result;
}

TEST(HDPStereo_LeftRightCheck, occluded_pixels_by_comparing_all_pairs)
{
    RNG rng(24);
    for (int minDisparity : { -20, 0, 5 })
        for (int maxDiff : { 1, 2, 5 })
            for (bool wholePixels : { true, false })
            {
                const short invalid = (short)((minDisparity - 1) * 16);
                Mat disparity(30, 50, CV_16SC1);
                for (short& d : Mat_<short>(disparity))
                {
                    d = (short)(16 * (minDisparity + rng.uniform(0, 25)));
                    d = (short)(d + (wholePixels ? 0 : rng.uniform(-7, 8)));
                }
                disparity.row(3).setTo(Scalar(invalid));
                disparity.col(9).setTo(Scalar(invalid));
                const Mat expected = rejectOccludedByPairs(disparity, maxDiff, invalid);
                ASSERT_GT(countDifferent(disparity, expected), 0);
                hdp::rejectOccluded(disparity, maxDiff, invalid);
                expectIdentical(expected, disparity);
            }
}

TEST(HDPStereo_LeftRightCheck, a_limit_beyond_all_disparities_rejects_nothing)
{
    RNG rng(25);
    for (int maxDiff : { 64, 4096, INT_MAX / 16 + 1, INT_MAX })
    {
        SCOPED_TRACE(maxDiff);
        Mat disparity = randomImage(rng, Size(50, 8), CV_16SC1, 64) * 16;
        const Mat before = disparity.clone();
        hdp::rejectOccluded(disparity, maxDiff, -16);
        expectIdentical(before, disparity);
    }
}

}} // namespace opencv_test
