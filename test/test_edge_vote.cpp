// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/map_filters.hpp"

namespace opencv_test { namespace {

//! hdp::voteAtEdges() for a pixel
ushort votedDisparity(const Mat& image, const Mat& disparity, int x, int y)
{
    const int width = disparity.cols, height = disparity.rows;
    int nearest = 0, farthest = 65535;
    for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
        {
            const int d = disparity.at<ushort>(oracle::clamped(v, height), oracle::clamped(u, width));
            nearest = std::max(nearest, d);
            farthest = std::min(farthest, d);
        }
    const int own = disparity.at<ushort>(y, x), middle = (nearest + farthest) / 2;
    if (nearest - farthest <= 2 * 16)
        return (ushort)own;
    const int start = std::min(std::max(x - 7, 0), width - 16);
    int near = 0, far = 0;
    for (int dy = -6; dy <= 6; dy += 3)
        for (int u = start; u < start + 16; ++u)
        {
            const int v = oracle::clamped(y + dy, height), d = disparity.at<ushort>(v, u);
            int change = 0;
            for (int c = 0; c < image.channels(); ++c)
                change = std::max(change, std::abs(image.ptr(v, u)[c] - image.ptr(y, x)[c]));
            const int votes = std::max(36 - change, 0);
            near += d > middle && d <= std::min(nearest + 16, 65535) ? votes : 0;
            far += d <= middle && d >= farthest - 16 ? votes : 0;
        }
    const bool isNear = own > middle;
    bool goesOn[4] = { true, true, true, true };
    for (int k = 1; k <= 8; ++k)
    {
        goesOn[0] = goesOn[0] && (x - k < 0 || disparity.at<ushort>(y, x - k) > middle);
        goesOn[1] = goesOn[1] && (x + k >= width || disparity.at<ushort>(y, x + k) > middle);
        for (int down = 0; down < 2; ++down)
        {
            const int v = oracle::clamped(down ? y + k : y - k, height);
            goesOn[2 + down] = goesOn[2 + down] && ((k % 3 != 0 && k != 8) || disparity.at<ushort>(v, x) > middle);
        }
    }
    const bool isBar = ((goesOn[0] || goesOn[1]) && !goesOn[2] && !goesOn[3]) ||
                       ((goesOn[2] || goesOn[3]) && !goesOn[0] && !goesOn[1]);
    return (ushort)(isNear && far > near && !isBar ? farthest : !isNear && near > far ? nearest : own);
}

TEST(HDPStereo_EdgeVote, oracle)
{
    RNG rng(93);
    int changed = 0;
    for (const Size& size : { Size(16, 9), Size(17, 1), Size(61, 40), Size(90, 3), Size(20, 150) })
        for (int range : { 100, 4000, 65536 })
        {
            const int channels = range == 100 ? 1 : 3;
            // Patches of some disparities, with noise and single pixels of others
            Mat image(size, CV_8UC(channels)), disparity(size, CV_16U);
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    const int patch = (x / 11 + y / 9) % 3, wrong = rng.uniform(0, 6) == 0;
                    disparity.at<ushort>(y, x) =
                        (ushort)std::min(((patch + wrong) % 3) * range / 3 + rng.uniform(0, 20), 65535);
                    if (rng.uniform(0, 20) == 0)
                        disparity.at<ushort>(y, x) = USHRT_MAX; // no vote
                    for (int c = 0; c < channels; ++c)
                        image.ptr(y, x)[c] = (uchar)(patch * 25 * (c + 1) + 75 + rng.uniform(0, 22));
                }
            Mat expected(size, CV_16U), voted;
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    expected.at<ushort>(y, x) = votedDisparity(image, disparity, x, y);
                    changed += expected.at<ushort>(y, x) != disparity.at<ushort>(y, x);
                }
            hdp::voteAtEdges(image, disparity, voted);
            SCOPED_TRACE(testing::Message() << size << ", " << range);
            expectIdentical(expected, voted);
        }
    EXPECT_GT(changed, 100);
}

//! The outline of a square that is off by some pixels moves to its edge, but in its corners.
TEST(HDPStereo_EdgeVote, outline)
{
    const Rect square(40, 30, 50, 40), wide(37, 27, 56, 46), narrow(43, 33, 44, 34);
    const ushort far = 10 * 16, near = 30 * 16;
    // Colours of the same brightness
    Mat image(100, 140, CV_8UC3, Scalar(50, 120, 90)), truth(image.size(), CV_16U, Scalar(far));
    image(square).setTo(Scalar(50, 80, 168));
    truth(square).setTo(near);
    for (const Rect& matched : { wide, narrow })
    {
        Mat disparity(image.size(), CV_16U, Scalar(far)), voted;
        disparity(matched).setTo(near);
        const int before = countNonZero(disparity != truth);
        for (int pass = 0; pass < 4; ++pass) // one moves an outline by a pixel
        {
            hdp::voteAtEdges(image, disparity, voted);
            std::swap(disparity, voted);
        }
        EXPECT_LE(countNonZero(disparity != truth), before / 20) << matched;
    }
}

//! Steps of up to two pixels are slopes, and of a narrow map nothing is known.
TEST(HDPStereo_EdgeVote, leaves_slopes_and_narrow_maps)
{
    RNG rng(94);
    for (const Size& size : { Size(40, 30), Size(15, 30) })
    {
        const Mat image = randomImage(rng, size, CV_8UC3, 255);
        Mat disparity(size, CV_16U), voted;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                disparity.at<ushort>(y, x) = (ushort)(size.width == 40 ? 16 * x : rng.uniform(0, 1000));
        hdp::voteAtEdges(image, disparity, voted);
        expectIdentical(disparity, voted);
    }
}

}} // namespace opencv_test
