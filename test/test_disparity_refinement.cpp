// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/disparity_refinement.hpp"

namespace opencv_test {
namespace {

TEST(HDPStereo_DisparityRefinement, median_by_sorting)
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

TEST(HDPStereo_DisparityRefinement, median_of_many_rows)
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

TEST(HDPStereo_DisparityRefinement, thin_structures_by_counting)
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

TEST(HDPStereo_DisparityRefinement, upsampled_bilinearly_inside_surfaces)
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
TEST(HDPStereo_DisparityRefinement, upsampled_planes_and_steps)
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

TEST(HDPStereo_DisparityRefinement, occluded_pixels_by_comparing_all_pairs)
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

TEST(HDPStereo_DisparityRefinement, a_limit_beyond_all_disparities_rejects_nothing)
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

// In one row; whole disparities.
Mat filled(const std::vector<int>& disparities, const std::vector<int>& residuals, const Mat& right = Mat())
{
    Mat disparity(1, (int)disparities.size(), CV_16UC1), residual(disparity.size(), CV_8UC1);
    for (int x = 0; x < disparity.cols; ++x)
    {
        disparity.at<ushort>(x) = (ushort)(16 * disparities[x]);
        residual.at<uchar>(x) = (uchar)residuals[x];
    }
    hdp::fillOccluded(disparity, residual, right);
    return disparity / 16;
}

TEST(HDPStereo_DisparityRefinement, occluded_pixels_get_the_farther_disparity)
{
    // Columns 4 and 5 of disparity 1 lie behind columns 6 and 7 of disparity 3: both map to 3 and 4. Column 0 is within a
    // pixel of what is there.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 9 }, { 0, 1, 1, 1, 1, 1, 3, 3, 3 })),
                    filled({ 0, 1, 1, 1, 1, 1, 3, 3, 3 }, { 5, 0, 0, 0, 9, 9, 1, 1, 1 }));
    // An outlier, in front of what it would hide, that matches badly
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 8 }, { 1, 1, 1, 1, 1, 1, 1, 1 })),
                    filled({ 1, 1, 1, 1, 1, 4, 1, 1 }, { 9, 0, 0, 0, 0, 8, 0, 0 }));
    // Nothing is visible: all map beside the right image.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 3 }, { 4, 5, 6 })), filled({ 4, 5, 6 }, { 0, 0, 0 }));
}

TEST(HDPStereo_DisparityRefinement, what_is_left_of_a_surface_at_the_border_is_not_visible)
{
    // A surface of disparity 4 begins in column 0 of the right image. Two of the pixels on its left match better there,
    // but it is seen from column 2 on.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4 })),
                    filled({ 0, 0, 0, 0, 4, 4, 4, 4, 4, 4, 4, 4 }, { 0, 0, 9, 9, 5, 5, 5, 5, 5, 5, 5, 5 }));
    // Three columns of disparity 6 stand in front of a background that is seen on both sides of them.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 1, 1, 1, 1, 1, 1, 1, 6, 6, 6, 1, 1 })),
                    filled({ 1, 1, 1, 1, 1, 1, 1, 6, 6, 6, 1, 1 }, { 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1 }));
}

TEST(HDPStereo_DisparityRefinement, what_is_left_of_the_first_surface_is_not_visible)
{
    // The surface is seen from column 4 of the right image on. On its left all but one pixel map to what it has itself, or
    // beside the right image.
    const std::vector<int> residuals = { 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 0, 0, 0, 0, 0, 0, 0, 0 };
    std::vector<int> disparities = { 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 8, 8, 8, 8, 8, 8, 8, 8 };
    const Mat surface(1, (int)disparities.size(), CV_16UC1, Scalar(8));
    for (int x = 0; x < 12; ++x)
        disparities[x] = x < 5 ? x + 1 : x - 5; // no column, and column 5
    disparities[3] = 1;                         // column 2, which nothing else maps to
    expectIdentical(surface, filled(disparities, residuals));
}

TEST(HDPStereo_DisparityRefinement, a_match_by_chance_in_an_occlusion_is_not_visible)
{
    // Columns 5 to 7 lie behind disparity 4. Column 6 matches one that column 4 has.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 1, 1, 1, 1, 1, 1, 1, 1, 4, 4, 4, 4 })),
                    filled({ 1, 1, 1, 1, 1, 1, 3, 1, 4, 4, 4, 4 }, { 1, 1, 1, 1, 1, 9, 0, 9, 1, 1, 1, 1 }));
}

//! A block of the smallest disparities beside a surface that maps to the same columns, whatever matches better
TEST(HDPStereo_DisparityRefinement, what_a_nearer_surface_hides_is_not_visible)
{
    const int width = 40, blockEnd = 16;
    std::vector<int> disparities(width, 14), residuals(width, 9);
    std::fill(disparities.begin(), disparities.begin() + blockEnd, 0); // the surface has column 2 and those after it
    std::fill(residuals.begin(), residuals.begin() + blockEnd, 1);
    expectIdentical(Mat(1, width, CV_16UC1, Scalar(14)), filled(disparities, residuals));

    // Four columns are left to the block: it is visible, unless they are black in the right image.
    std::fill(disparities.begin() + blockEnd, disparities.end(), 12);
    Mat right(1, width, CV_16UC1, Scalar(400));
    EXPECT_EQ(0, filled(disparities, residuals, right).at<ushort>(0));
    right.colRange(0, 4).setTo(Scalar(0));
    expectIdentical(Mat(1, width, CV_16UC1, Scalar(12)), filled(disparities, residuals, right));
}

//! On the left of the right image's border a surface goes on, half as steep.
TEST(HDPStereo_DisparityRefinement, slanted_surface_at_the_border)
{
    for (int rise : { -4, 0, 4 }) // per column, in 1/16 pixel
    {
        SCOPED_TRACE(rise);
        const int width = 80, border = 24; // the surface has column 0 there
        Mat disparity(1, width, CV_16UC1), residual(1, width, CV_8UC1, Scalar(0)), result;
        for (int x = 0; x < width; ++x)
            disparity.at<ushort>(x) = (ushort)(x < border ? 16 * 60 : 16 * border + rise * (x - border));
        disparity.copyTo(result);
        hdp::fillOccluded(result, residual);
        const int visible = border + 4;
        expectIdentical(Mat(disparity.colRange(visible, width)), Mat(result.colRange(visible, width)));
        for (int x = 0; x < border; ++x)
            ASSERT_EQ(rise / 2, result.at<ushort>(x + 1) - result.at<ushort>(x)) << "at " << x;
    }
}

TEST(HDPStereo_DisparityRefinement, visible_pixels_are_not_filled)
{
    RNG rng(47);
    Mat disparity(40, 60, CV_16UC1, Scalar(16 * 5 + 3)), residual = randomImage(rng, Size(60, 40), CV_8UC1, 30), result;
    disparity.copyTo(result);
    hdp::fillOccluded(result, residual);
    expectIdentical(disparity, result); // a plane, and its left border
}

} // namespace
} // namespace opencv_test
