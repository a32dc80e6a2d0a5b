// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"

// Pictures that are no pictures of anything: each with what a matcher has to make of it.

namespace opencv_test { namespace {

typedef testing::TestWithParam<System> HDPStereo_Adversarial;

//! The right image of a wall at this disparity: right(x) = left(x + shift), the nearest column where there is none.
Mat shiftedBy(const Mat& left, int shift)
{
    Mat right(left.size(), left.type());
    for (int x = 0; x < left.cols; ++x)
        left.col(std::min(std::max(x + shift, 0), left.cols - 1)).copyTo(right.col(x));
    return right;
}

//! Texture that all layers see: noise of one pixel and of eight
Mat textured(Size size, int type, int seed)
{
    RNG rng((uint64)seed + 1);
    Mat fine = randomImage(rng, size, type, 128), coarse;
    cv::resize(randomImage(rng, Size(size.width / 8 + 1, size.height / 8 + 1), type, 128), coarse, size, 0, 0,
               INTER_NEAREST);
    return fine + coarse;
}

//! Matches a pair. The map is dense, in range, and the same from a fresh matcher in one thread.
Mat matchChecked(const System& system, int numDisparities, int minDisparity, const Mat& left, const Mat& right)
{
    const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities, minDisparity);
    const Mat disparity = match(*matcher, left, right);
    EXPECT_EQ(CV_16SC1, disparity.type());
    EXPECT_EQ(left.size(), disparity.size());
    double lowest, highest;
    cv::minMaxLoc(disparity, &lowest, &highest);
    EXPECT_GE(lowest, 16 * minDisparity);
    EXPECT_LE(highest, 16 * (minDisparity + numDisparities - 1));
    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    expectIdentical(disparity, match(*createSystem(system, numDisparities, minDisparity), left, right));
    cv::setNumThreads(threads);
    return disparity;
}

double meanConfidence(const System& system, int numDisparities, const Mat& left, const Mat& right)
{
    const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
    match(*matcher, left, right);
    Mat confidence;
    matcher->getConfidence(confidence);
    return cv::mean(confidence)[0];
}

//! Percentage of pixels whose disparity, in pixels, is more than 1 from what is expected, modulo a period if there is one
double percentOff(const Mat& disparity, double expected, int period = 0)
{
    int off = 0;
    for (const short d : Mat_<short>(disparity))
    {
        double difference = d / 16. - expected;
        if (period > 0)
            difference -= period * std::floor(difference / period + 0.5);
        off += std::abs(difference) > 1;
    }
    return 100. * off / disparity.total();
}

//! Nothing to tell the candidates apart: the first one, everywhere.
TEST_P(HDPStereo_Adversarial, constant)
{
    for (int type : { CV_8UC1, CV_8UC3 })
        for (int level : { 0, 1, 128, 255 })
            for (int minDisparity : { 0, -7, 5 })
            {
                const Mat image(61, 83, type, Scalar::all(level));
                const Mat disparity = matchChecked(GetParam(), 40, minDisparity, image, image);
                EXPECT_EQ(0, cv::countNonZero(disparity != 16 * minDisparity)) << level << " from " << minDisparity;
            }
}

TEST_P(HDPStereo_Adversarial, zeros_against_255)
{
    for (int type : { CV_8UC1, CV_8UC3 })
        for (int minDisparity : { 0, -7 })
        {
            const Mat black(61, 83, type, Scalar::all(0)), white(61, 83, type, Scalar::all(255));
            EXPECT_EQ(0,
                      cv::countNonZero(matchChecked(GetParam(), 40, minDisparity, black, white) != 16 * minDisparity));
            EXPECT_EQ(0,
                      cv::countNonZero(matchChecked(GetParam(), 40, minDisparity, white, black) != 16 * minDisparity));
        }
}

//! Noise that has nothing to do with the other image's, and noise that has
TEST_P(HDPStereo_Adversarial, noise)
{
    const int width = 160, shift = 12;
    RNG rng(61);
    for (int type : { CV_8UC1, CV_8UC3 })
    {
        const Mat left = randomImage(rng, Size(width, 120), type), other = randomImage(rng, left.size(), type);
        matchChecked(GetParam(), 32, 0, left, other);
        EXPECT_LE(meanConfidence(GetParam(), 32, left, other), 25); // 21.0

        const Mat disparity = matchChecked(GetParam(), 32, 0, left, shiftedBy(left, shift));
        EXPECT_LE(percentOff(disparity.colRange(shift, width), shift), 0.5);          // 0.1
        EXPECT_GE(meanConfidence(GetParam(), 32, left, shiftedBy(left, shift)), 150); // 167
    }
}

//! What is too bright, or too dark, to show anything takes its disparities from what is around it.
TEST_P(HDPStereo_Adversarial, saturated)
{
    const int shift = 14;
    for (int type : { CV_8UC1, CV_8UC3 })
        for (int level : { 0, 255 })
        {
            Mat left = textured(Size(200, 120), type, 62);
            left(Rect(90, 30, 60, 60)).setTo(Scalar::all(level));
            const Mat disparity = matchChecked(GetParam(), 32, 0, left, shiftedBy(left, shift));
            EXPECT_LE(percentOff(disparity.colRange(shift, left.cols), shift), 0.5); // 0.14
        }
}

//! A period is in the range only once: that disparity. Several times: one of those that are equivalent.
TEST_P(HDPStereo_Adversarial, checkerboard)
{
    const int width = 240;
    for (int square : { 4, 8, 16 })
    {
        Mat board(160, 2 * width, CV_8UC1);
        for (int y = 0; y < board.rows; ++y)
            for (int x = 0; x < board.cols; ++x)
                board.at<uchar>(y, x) = (x / square + y / square) % 2 ? 255 : 0;
        const int period = 2 * square;
        for (int shift : { square, square / 2 })
            for (int disparities : { period, 5 * period / 2 })
            {
                SCOPED_TRACE(testing::Message() << square << " by " << shift << " of " << disparities);
                const Mat disparity = matchChecked(GetParam(), disparities, 0, board.colRange(0, width),
                                                   board.colRange(shift, shift + width));
                const Mat inside = disparity.colRange(disparities, width);
                EXPECT_LE(percentOff(inside, shift, disparities > period ? period : 0),
                          4); // 3.1, where two of the equivalent ones meet
            }
    }
}

TEST_P(HDPStereo_Adversarial, periodic_texture)
{
    const int width = 240;
    for (int period : { 8, 24, 32 })
    {
        Mat tiles;
        cv::repeat(textured(Size(period, 160), CV_8UC3, 63), 1, 2 * width / period + 1, tiles);
        const int shift = period / 3;
        for (int disparities : { period, 3 * period })
        {
            SCOPED_TRACE(testing::Message() << period << " of " << disparities);
            const Mat disparity = matchChecked(GetParam(), disparities, 0, tiles.colRange(0, width),
                                               tiles.colRange(shift, shift + width));
            const Mat inside = disparity.colRange(disparities, width);
            EXPECT_LE(percentOff(inside, shift, disparities > period ? period : 0), 0.5); // 0
        }
    }
}

//! Swapped, a pair has negative disparities: nothing to trust in a range from 0 on, and all of it in the right one.
TEST_P(HDPStereo_Adversarial, left_and_right_swapped)
{
    const int shift = 14, disparities = 32, width = 200;
    const Mat left = textured(Size(width, 120), CV_8UC3, 64), right = shiftedBy(left, shift);
    matchChecked(GetParam(), disparities, 0, right, left);
    EXPECT_GE(meanConfidence(GetParam(), disparities, left, right), 150); // 178
    EXPECT_LE(meanConfidence(GetParam(), disparities, right, left), 20);  // 12

    const Mat negative = matchChecked(GetParam(), disparities, -disparities + 1, right, left);
    EXPECT_LE(percentOff(negative.colRange(disparities, width - disparities), -shift), 1); // 0.3
}

TEST_P(HDPStereo_Adversarial, shifted_by_more_than_the_range)
{
    const int disparities = 32;
    const Mat left = textured(Size(240, 120), CV_8UC3, 65);
    EXPECT_GE(meanConfidence(GetParam(), disparities, left, shiftedBy(left, disparities - 12)), 150); // 196
    for (int shift : { -20, 48, 100, 239, 1000 })
    {
        SCOPED_TRACE(shift);
        matchChecked(GetParam(), disparities, 0, left, shiftedBy(left, shift));
        EXPECT_LE(meanConfidence(GetParam(), disparities, left, shiftedBy(left, shift)), 20); // 11
    }
}

TEST_P(HDPStereo_Adversarial, rows)
{
    const int shift = 6;
    for (int type : { CV_8UC1, CV_8UC3 })
        for (const Size& size : { Size(300, 1), Size(300, 3), Size(30000, 2), Size(32767, 1) })
        {
            SCOPED_TRACE(size);
            const Mat left = textured(size, type, 66);
            const Mat disparity = matchChecked(GetParam(), 16, 0, left, shiftedBy(left, shift));
            EXPECT_LE(percentOff(disparity.colRange(shift, size.width), shift), 1); // 0.34
        }
}

//! In a single column all candidates are the same pixel, so that the first one wins.
TEST_P(HDPStereo_Adversarial, columns)
{
    for (int type : { CV_8UC1, CV_8UC3 })
    {
        for (const Size& size : { Size(1, 1), Size(1, 300), Size(1, 32767) })
        {
            const Mat left = textured(size, type, 67), right = textured(size, type, 68);
            EXPECT_EQ(0, cv::countNonZero(matchChecked(GetParam(), 16, 3, left, right) != 16 * 3)) << size;
        }
        const Size two(2, 30000);
        matchChecked(GetParam(), 16, 0, textured(two, type, 67), textured(two, type, 68));
    }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_Adversarial, testing::ValuesIn(presets));

}} // namespace opencv_test
