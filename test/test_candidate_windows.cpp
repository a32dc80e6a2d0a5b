// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "window_prediction.hpp"

namespace opencv_test { namespace {

using hdp::CandidateWindow;

const int scale = 16;

//! The other surfaces of a layer without a census
Mat otherSurfaces(const Prediction& prediction)
{
    Mat others(prediction.upper.size(), CV_16UC1);
    for (int y = 0; y < others.rows; ++y)
        for (int x = 0; x < others.cols; ++x)
            others.at<ushort>(y, x) = (ushort)oracle::otherSurface(prediction, y, x);
    return others;
}

Mat predict(const Prediction& prediction, int numDisparities)
{
    Mat windows(7, 2, CV_16UC4);
    hdp::predictWindows(prediction.upper, otherSurfaces(prediction), numDisparities, windows);
    return windows;
}

bool isContiguous(const CandidateWindow& window) { return window.first[1] == window.first[0] + 8; }

bool contains(const CandidateWindow& window, int disparity)
{
    for (int run = 0; run < CandidateWindow::runs; ++run)
        if (disparity >= window.first[run] && disparity < window.first[run] + CandidateWindow::runLength)
            return true;
    return false;
}

int nearestDisparity(int predicted) { return cvFloor(predicted / (double)scale + 0.5); }

void expectWindows(const Prediction& prediction, int numDisparities)
{
    const Mat& upper = prediction.upper;
    const Mat windows = predict(prediction, numDisparities);
    ASSERT_EQ(upper.size(), windows.size());
    ASSERT_EQ(CV_16UC4, windows.type());
    for (int y = 0; y < upper.rows; ++y)
        for (int x = 0; x < upper.cols; ++x)
        {
            const CandidateWindow& w = windows.ptr<CandidateWindow>(y)[x];
            const int own = 2 * upper.at<ushort>(y, x), other = oracle::otherSurface(prediction, y, x);
            SCOPED_TRACE(testing::Message() << "y " << y << " x " << x << ": runs from " << w.first[0] << " and "
                                            << w.first[1] << ", own " << own / 16. << ", beyond " << other / 16.);
            for (int run = 0; run < CandidateWindow::runs; ++run)
            {
                ASSERT_GE(w.first[run], -1);
                ASSERT_LE(w.first[run] + 8, std::max(numDisparities + 1, 15));
            }
            ASSERT_GE(std::abs(w.first[0] - w.first[1]), 8) << "runs overlap";
            ASSERT_TRUE(contains(w, nearestDisparity(own)));
            if (std::abs(other - own) < 5 * scale)
            {
                // One run after the other, around the pixel's own disparity but for the ends of the range
                ASSERT_TRUE(isContiguous(w));
                const int first = nearestDisparity(own) - 7;
                ASSERT_EQ(std::max(-1, std::min(first, numDisparities + 1 - 16)), w.first[0]);
                ASSERT_TRUE(w.predicted[0] == own && w.predicted[1] == own);
                continue;
            }
            ASSERT_TRUE(contains(w, nearestDisparity(other)));
            // Candidates on both sides of both surfaces
            for (int surface : { nearestDisparity(own), nearestDisparity(other) })
                for (int d = surface - 3; d <= surface + 4; ++d)
                    ASSERT_TRUE(d < -1 || d > numDisparities || contains(w, d)) << d;
            if (isContiguous(w) && w.predicted[0] != own)
                ASSERT_TRUE(w.predicted[0] == other && w.predicted[1] == own && other < own);
            else
                ASSERT_TRUE(w.predicted[0] == own && w.predicted[1] == other);
        }
}

TEST(HDPStereo_OtherSurfaces, rule)
{
    RNG rng(60);
    Mat others;
    int found = 0;
    for (const Size& size : { Size(1, 1), Size(4, 1), Size(35, 20), Size(80, 18), Size(20, 161) })
        for (int numDisparities : { 1, 12, 70 })
        {
            SCOPED_TRACE(testing::Message() << size << ", disparities " << numDisparities);
            Prediction prediction(patchesAbove(rng, size, numDisparities, 7));
            prediction.addThinStructures(rng, numDisparities);
            hdp::findOtherSurfaces(prediction.upper, prediction.unfiltered, others);
            ASSERT_EQ(size, others.size());
            ASSERT_EQ(CV_16UC1, others.type());
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    ASSERT_EQ(oracle::otherSurface(prediction, y, x), others.at<ushort>(y, x))
                        << "y " << y << " x " << x;
                    found += others.at<ushort>(y, x) != 2 * prediction.upper.at<ushort>(y, x);
                }
        }
    EXPECT_GT(found, 1000) << "nothing is tested where there are none";
}

TEST(HDPStereo_CandidateWindows, properties)
{
    RNG rng(40);
    for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(40, 15), Size(37, 70), Size(13, 300) })
        for (int numDisparities : { 1, 2, 3, 8, 15, 16, 17, 20, 64, 255, 2048 })
            for (int patch : { 1, 5, 12 })
            {
                SCOPED_TRACE(testing::Message()
                             << size << ", " << numDisparities << " disparities, patches of " << patch);
                Prediction prediction(patchesAbove(rng, size, numDisparities, patch));
                expectWindows(prediction, numDisparities);
                prediction.addThinStructures(rng, numDisparities);
                expectWindows(prediction, numDisparities);
            }
}

//! Two surfaces side by side: near the step both have candidates, elsewhere only one.
TEST(HDPStereo_CandidateWindows, a_step)
{
    const int back = 10, front = 30;
    Mat upper(12, 40, CV_16UC1, Scalar(back * scale));
    upper.colRange(20, 40).setTo(front * scale);
    const Mat windows = predict(Prediction(upper), 100);
    for (int x = 0; x < upper.cols; ++x)
    {
        const CandidateWindow& w = windows.ptr<CandidateWindow>(5)[x];
        const bool isNear = x >= 17 && x < 23;
        const int own = 2 * (x < 20 ? back : front), other = 2 * (x < 20 ? front : back);
        EXPECT_EQ(!isNear, isContiguous(w)) << x;
        EXPECT_EQ(own - (isNear ? 3 : 7), w.first[0]) << x;
        if (isNear)
        {
            EXPECT_EQ(other - 3, w.first[1]) << x;
        }
    }
}

//! For a second pass: half the mean of the middle two of four, or half the smaller one if they are 5 pixels apart,
//! rounded down
TEST(HDPStereo_CandidateWindows, halved_disparities)
{
    RNG rng(46);
    for (const Size& size : { Size(2, 2), Size(3, 2), Size(2, 9), Size(47, 33) })
        for (int levels : { 2, 200, 1000, 65536 })
        {
            SCOPED_TRACE(testing::Message() << size << ", levels " << levels);
            const Mat disparity = randomImage(rng, size, CV_16UC1, levels);
            Mat expected(size / 2, CV_16UC1), upper;
            for (int y = 0; y < expected.rows; ++y)
                for (int x = 0; x < expected.cols; ++x)
                {
                    std::vector<int> four;
                    for (int i = 0; i < 4; ++i)
                        four.push_back(disparity.at<ushort>(2 * y + i / 2, 2 * x + i % 2));
                    std::sort(four.begin(), four.end());
                    const bool isOneSurface = four[2] - four[1] < 5 * 16;
                    expected.at<ushort>(y, x) = (ushort)((isOneSurface ? (four[1] + four[2]) / 2 : four[1]) / 2);
                }
            hdp::halveDisparity(disparity, upper);
            expectIdentical(expected, upper);
        }
}

}} // namespace opencv_test
