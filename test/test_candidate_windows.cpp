// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/candidate_windows.hpp"
#include "../src/scanlines/sparse_matches.hpp"

namespace opencv_test {
namespace {

using hdp::CandidateWindow;

const int scale = 16;

//! Disparities of a layer above another one with this number of disparities: patches of slanted surfaces.
Mat patchesAbove(RNG& rng, Size size, int numDisparities, int patch)
{
    const int largest = (numDisparities - 1) / 2 * scale;
    Mat upper(size, CV_16UC1);
    for (int y0 = 0; y0 < size.height; y0 += patch)
        for (int x0 = 0; x0 < size.width; x0 += patch)
        {
            const int offset = rng.uniform(0, largest + 1), slope = rng.uniform(-8, 9);
            for (int y = y0; y < std::min(y0 + patch, size.height); ++y)
                for (int x = x0; x < std::min(x0 + patch, size.width); ++x)
                    upper.at<ushort>(y, x) = (ushort)std::min(std::max(offset + slope * (x - x0), 0), largest);
        }
    return upper;
}

const int noMatch = hdp::SparseMatches::noMatch;

//! What is known of a layer; without matches of its own
struct Prediction
{
    Mat upper, unfiltered, matches;

    explicit Prediction(const Mat& upper_)
        : upper(upper_), unfiltered(upper_.clone()),
          matches((2 * upper.rows + 23) / 24, (2 * upper.cols + 23) / 24, CV_16UC1, Scalar(noMatch))
    {
    }
};

Mat predict(const Prediction& prediction, int numDisparities)
{
    hdp::WindowBuffers buffers;
    buffers.min[0].create(3, 3, CV_16UC1); // of another size
    Mat windows(7, 2, CV_16UC4);
    const hdp::WindowPrediction all = { prediction.upper, prediction.unfiltered, prediction.matches };
    hdp::predictWindows(all, numDisparities, buffers, windows);
    return windows;
}

//! Single pixels that the median removed, and matches of the layer itself here and there
Prediction withThinStructuresAndMatches(RNG& rng, const Prediction& alone, int numDisparities)
{
    Prediction result = alone;
    result.unfiltered = alone.upper.clone();
    result.matches = alone.matches.clone();
    const int largest = (numDisparities - 1) * scale;
    for (int y = 0; y < result.unfiltered.rows; ++y)
        for (int x = 0; x < result.unfiltered.cols; ++x)
            if (rng.uniform(0, 30) == 0)
                result.unfiltered.at<ushort>(y, x) = (ushort)rng.uniform(0, largest / 2 + 1);
    for (int y = 0; y < result.matches.rows; ++y)
        for (int x = 0; x < result.matches.cols; ++x)
            if (rng.uniform(0, 2) == 0)
                result.matches.at<ushort>(y, x) = (ushort)(scale * rng.uniform(0, numDisparities));
    return result;
}

bool contains(const CandidateWindow& window, int disparity)
{
    for (int run = 0; run < CandidateWindow::runs; ++run)
        if (disparity >= window.first[run] && disparity < window.first[run] + CandidateWindow::runLength)
            return true;
    return false;
}

int nearestDisparity(int predicted) { return cvFloor(predicted / (double)scale + 0.5); }

//! The disparity in 7 x 7 pixels that is farthest from another one; of two as far, the larger one
int farthest(const Mat& upper, int y, int x, int own)
{
    int result = own;
    for (int v = std::max(y - 3, 0); v <= std::min(y + 3, upper.rows - 1); ++v)
        for (int u = std::max(x - 3, 0); u <= std::min(x + 3, upper.cols - 1); ++u)
        {
            const int other = upper.at<ushort>(v, u), farther = std::abs(other - own) - std::abs(result - own);
            if (farther > 0 || (farther == 0 && other > result))
                result = other;
        }
    return result;
}

//! The disparity of the layer, times scale, that the second run is there for, or one near the pixel's own
int otherSurface(const Prediction& prediction, int y, int x)
{
    const int own = 2 * prediction.upper.at<ushort>(y, x);
    const ushort match = prediction.matches.at<ushort>(y / 12, x / 12);
    const int sources[] = { 2 * prediction.unfiltered.at<ushort>(y, x), match != noMatch ? match : own,
                            2 * farthest(prediction.upper, y, x, own / 2),
                            2 * farthest(prediction.unfiltered, y, x, own / 2) };
    for (int other : sources)
        if (std::abs(other - own) >= 5 * scale)
            return other;
    return own;
}

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
            const int own = 2 * upper.at<ushort>(y, x), other = otherSurface(prediction, y, x);
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
                ASSERT_TRUE(w.isContiguous());
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
            if (w.isContiguous() && w.predicted[0] != own)
                ASSERT_TRUE(w.predicted[0] == other && w.predicted[1] == own && other < own);
            else
                ASSERT_TRUE(w.predicted[0] == own && w.predicted[1] == other);
        }
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
                const Prediction alone(patchesAbove(rng, size, numDisparities, patch));
                expectWindows(alone, numDisparities);
                expectWindows(withThinStructuresAndMatches(rng, alone, numDisparities), numDisparities);
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
        EXPECT_EQ(!isNear, w.isContiguous()) << x;
        EXPECT_EQ(own - (isNear ? 3 : 7), w.first[0]) << x;
        if (isNear)
        {
            EXPECT_EQ(other - 3, w.first[1]) << x;
        }
    }
}

//! For a second pass: half the mean of the middle two of four, rounded down
TEST(HDPStereo_CandidateWindows, halved_disparities)
{
    RNG rng(46);
    for (const Size& size : { Size(2, 2), Size(3, 2), Size(2, 9), Size(47, 33) })
        for (int levels : { 2, 1000, 65536 })
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
                    expected.at<ushort>(y, x) = (ushort)((four[1] + four[2]) / 2 / 2);
                }
            hdp::halveDisparity(disparity, upper);
            expectIdentical(expected, upper);
        }
}

} // namespace
} // namespace opencv_test
