// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "../src/map/occlusion_filling.hpp"

namespace opencv_test { namespace {

// In one row; whole disparities.
Mat filled(const std::vector<int>& disparities, const std::vector<int>& residuals,
           const hdp::PairMasks& masks = hdp::PairMasks())
{
    Mat disparity(1, (int)disparities.size(), CV_16UC1), residual(disparity.size(), CV_8UC1);
    for (int x = 0; x < disparity.cols; ++x)
    {
        disparity.at<ushort>(x) = (ushort)(16 * disparities[x]);
        residual.at<uchar>(x) = (uchar)residuals[x];
    }
    hdp::fillOccluded(disparity, residual, masks);
    return disparity / 16;
}

TEST(HDPStereo_OcclusionFilling, occluded_pixels_get_the_farther_disparity)
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

TEST(HDPStereo_OcclusionFilling, what_is_left_of_a_surface_at_the_border_is_not_visible)
{
    // A surface of disparity 4 begins in column 0 of the right image. Two of the pixels on its left match better there,
    // but it is seen from column 2 on.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4 })),
                    filled({ 0, 0, 0, 0, 4, 4, 4, 4, 4, 4, 4, 4 }, { 0, 0, 9, 9, 5, 5, 5, 5, 5, 5, 5, 5 }));
    // Three columns of disparity 6 stand in front of a background that is seen on both sides of them.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 1, 1, 1, 1, 1, 1, 1, 6, 6, 6, 1, 1 })),
                    filled({ 1, 1, 1, 1, 1, 1, 1, 6, 6, 6, 1, 1 }, { 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1 }));
}

TEST(HDPStereo_OcclusionFilling, what_is_left_of_the_first_surface_is_not_visible)
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

TEST(HDPStereo_OcclusionFilling, a_match_by_chance_in_an_occlusion_is_not_visible)
{
    // Columns 5 to 7 lie behind disparity 4. Column 6 matches one that column 4 has.
    expectIdentical(Mat_<ushort>(Mat_<ushort>({ 1, 12 }, { 1, 1, 1, 1, 1, 1, 1, 1, 4, 4, 4, 4 })),
                    filled({ 1, 1, 1, 1, 1, 1, 3, 1, 4, 4, 4, 4 }, { 1, 1, 1, 1, 1, 9, 0, 9, 1, 1, 1, 1 }));
}

TEST(HDPStereo_OcclusionFilling, up_to_three_pixels_between_gaps_that_are_no_shorter_are_not_visible)
{
    const int width = 40, begin = 20, nowhere = width; // a disparity beside the right image
    for (int gap : { 1, 2, 3, 4 })
        for (int count : { 1, 2, 3, 4 })
        {
            SCOPED_TRACE(cv::format("%d pixels, gaps of %d", count, gap));
            std::vector<int> disparities(width, 5);
            const auto at = disparities.begin() + begin;
            std::fill(at - gap, at + count + gap, nowhere);
            std::fill(at, at + count, 6);
            Mat expected(1, width, CV_16UC1, Scalar(5));
            if (count > std::min(gap, 3))
                expected.colRange(begin, begin + count).setTo(Scalar(6));
            expectIdentical(expected, filled(disparities, std::vector<int>(width, 0)));
            disparities[begin - gap - 1] = nowhere; // the gap before it is longer, that behind it counts
            expectIdentical(expected, filled(disparities, std::vector<int>(width, 0)));
        }
}

//! A block of the smallest disparities beside a surface that maps to the same columns, whatever matches better
TEST(HDPStereo_OcclusionFilling, what_a_nearer_surface_hides_is_not_visible)
{
    const int width = 40, blockEnd = 16;
    std::vector<int> disparities(width, 14), residuals(width, 9);
    std::fill(disparities.begin(), disparities.begin() + blockEnd, 0); // the surface has column 2 and those after it
    std::fill(residuals.begin(), residuals.begin() + blockEnd, 1);
    expectIdentical(Mat(1, width, CV_16UC1, Scalar(14)), filled(disparities, residuals));

    // Four columns are left to the block: it is visible, unless the right image has no data there.
    std::fill(disparities.begin() + blockEnd, disparities.end(), 12);
    const Mat all(1, width, CV_8UC1, Scalar(255));
    hdp::PairMasks masks = { all, all.clone() };
    EXPECT_EQ(0, filled(disparities, residuals, masks).at<ushort>(0));
    masks.right.colRange(0, 4).setTo(Scalar(0));
    expectIdentical(Mat(1, width, CV_16UC1, Scalar(12)), filled(disparities, residuals, masks));
}

//! Columns that neither image shows on its left are as if they were cut off.
TEST(HDPStereo_OcclusionFilling, rows_begin_with_data)
{
    RNG rng(31);
    const int height = 3;
    for (int round = 0; round < 100; ++round)
    {
        const int width = rng.uniform(20, 80), blank = rng.uniform(1, width);
        Mat disparity = randomImage(rng, Size(width, height), CV_16UC1, 12 * 16),
            part = disparity.colRange(blank, width);
        const Mat residual = randomImage(rng, disparity.size(), CV_8UC1, 9),
                  before = disparity.colRange(0, blank).clone();
        Mat expected = part.clone();
        hdp::fillOccluded(expected, residual.colRange(blank, width).clone());
        hdp::PairMasks masks = { Mat(disparity.size(), CV_8UC1, Scalar(255)), Mat() };
        masks.left.colRange(0, blank).setTo(Scalar(0));
        masks.right = masks.left.clone();
        hdp::fillOccluded(disparity, residual, masks);
        expectIdentical(expected, part);
        expectIdentical(before, disparity.colRange(0, blank));
    }
}

//! What only the left image has no data for hides nothing, and rows do not depend on those before them.
TEST(HDPStereo_OcclusionFilling, rows_that_begin_farther_on_in_the_left_image)
{
    RNG rng(32);
    const Size size(230, 4);
    hdp::PairMasks masks = { Mat(size, CV_8UC1, Scalar(255)), Mat(size, CV_8UC1, Scalar(255)) };
    for (int y = 0; y < size.height; ++y)
        masks.left(Rect(0, y, 40 * y, 1)).setTo(Scalar(0));
    const Mat flat(size, CV_16UC1, Scalar(16 * 3)), matched(size, CV_8UC1, Scalar(0));
    Mat filled = flat.clone();
    hdp::fillOccluded(filled, matched, masks);
    expectIdentical(Mat(flat.rowRange(1, size.height)), Mat(filled.rowRange(1, size.height)));
    for (int round = 0; round < 20; ++round)
    {
        const Mat disparity = randomImage(rng, size, CV_16UC1, 40 * 16), residual = randomImage(rng, size, CV_8UC1, 9);
        Mat together = disparity.clone();
        hdp::fillOccluded(together, residual, masks);
        for (int y = 0; y < size.height; ++y)
        {
            Mat alone = disparity.row(y).clone();
            hdp::fillOccluded(alone, residual.row(y).clone(), { masks.left.row(y), masks.right.row(y) });
            expectIdentical(alone, together.row(y));
        }
    }
}

//! On the left of the right image's border a surface goes on, half as steep.
TEST(HDPStereo_OcclusionFilling, slanted_surface_at_the_border)
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

//! The truth of layers of fronto-parallel boxes: what a z-buffer of the right image says is occluded gets the farther one
//! of the disparities beside it, whatever was matched there, and nothing else changes.
TEST(HDPStereo_OcclusionFilling, boxes_as_a_z_buffer_of_the_right_image_says)
{
    const int width = 160, background = 2;
    RNG rng(81);
    for (int run = 0; run < 200; ++run)
    {
        std::vector<int> truth(width, background);
        for (int begin = 40 + rng.uniform(0, 12); begin < width - 30; begin += rng.uniform(34, 50))
            std::fill_n(truth.begin() + begin, rng.uniform(12, 20), rng.uniform(4, 16));

        std::vector<int> nearest(width, -1); // by column of the right image
        for (int x = 0; x < width; ++x)
            if (x >= truth[x])
                nearest[x - truth[x]] = std::max(nearest[x - truth[x]], truth[x]);
        std::vector<int> matched = truth, expected = truth, residuals(width, 1);
        for (int x = background; x < width; ++x)
        {
            if (nearest[x - truth[x]] == truth[x])
                continue;
            expected[x] = background;
            residuals[x] = 20;
            // By chance, but not within a pixel of what is there, or where nothing else is: none could tell that.
            const int chance = rng.uniform(0, 16), shown = x >= chance ? nearest[x - chance] : -1;
            if (shown >= 0 && std::abs(shown - chance) > 1)
                matched[x] = chance;
        }
        SCOPED_TRACE(run);
        expectIdentical(Mat_<ushort>(Mat(expected).reshape(1, 1)), filled(matched, residuals));
    }
}

TEST(HDPStereo_OcclusionFilling, visible_pixels_are_not_filled)
{
    RNG rng(47);
    Mat disparity(40, 60, CV_16UC1, Scalar(16 * 5 + 3)), residual = randomImage(rng, Size(60, 40), CV_8UC1, 30), result;
    disparity.copyTo(result);
    hdp::fillOccluded(result, residual);
    expectIdentical(disparity, result); // a plane, and its left border
}

}} // namespace opencv_test
