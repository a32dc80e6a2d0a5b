// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/edge_vote.hpp"

namespace opencv_test { namespace {

//! hdp::voteAtEdges() for a pixel
ushort votedDisparity(const Mat& grey, const Mat& disparity, int x, int y)
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
            const int change = std::abs(grey.at<ushort>(v, u) - grey.at<ushort>(y, x));
            const int distance = std::max(std::abs(dy), std::abs(u - x));
            const int votes = std::max(4 * 36 - change, 0) * std::max(9 - distance, 1);
            near += d > middle && d <= nearest + 16 ? votes : 0;
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
    for (const Size& size : { Size(16, 9), Size(17, 1), Size(61, 40), Size(90, 3) })
        for (int range : { 100, 4000, 65536 })
        {
            // Patches of some disparities, with noise and single pixels of others
            Mat grey(size, CV_16U), disparity(size, CV_16U);
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    const int patch = (x / 11 + y / 9) % 3, wrong = rng.uniform(0, 6) == 0;
                    disparity.at<ushort>(y, x) =
                        (ushort)std::min(((patch + wrong) % 3) * range / 3 + rng.uniform(0, 20), 65535);
                    const bool hasVote = rng.uniform(0, 20) > 0;
                    grey.at<ushort>(y, x) = hasVote ? (ushort)(patch * 100 + 300 + rng.uniform(0, 90)) : USHRT_MAX;
                }
            Mat expected(size, CV_16U), voted;
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    expected.at<ushort>(y, x) = votedDisparity(grey, disparity, x, y);
                    changed += expected.at<ushort>(y, x) != disparity.at<ushort>(y, x);
                }
            hdp::voteAtEdges(grey, disparity, voted);
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
    Mat grey(100, 140, CV_16U, Scalar(300)), truth(grey.size(), CV_16U, Scalar(far));
    grey(square).setTo(600);
    truth(square).setTo(near);
    for (const Rect& matched : { wide, narrow })
    {
        Mat disparity(grey.size(), CV_16U, Scalar(far)), voted;
        disparity(matched).setTo(near);
        const int before = countNonZero(disparity != truth);
        for (int pass = 0; pass < 4; ++pass) // one moves an outline by a pixel
        {
            hdp::voteAtEdges(grey, disparity, voted);
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
        const Mat grey = randomImage(rng, size, CV_16UC1, 1023);
        Mat disparity(size, CV_16U), voted;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                disparity.at<ushort>(y, x) = (ushort)(size.width == 40 ? 16 * x : rng.uniform(0, 1000));
        hdp::voteAtEdges(grey, disparity, voted);
        expectIdentical(disparity, voted);
    }
}

}} // namespace opencv_test
