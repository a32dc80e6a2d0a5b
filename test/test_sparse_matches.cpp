// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/sparse_matches.hpp"

namespace opencv_test {
namespace {

const int noMatch = hdp::SparseMatches::noMatch;

//! Grey levels of a pair: bands of texture at several disparities, some of them flat, with noise.
void makeLevels(RNG& rng, Size size, int numDisparities, Mat& left, Mat& right)
{
    left = randomImage(rng, size, CV_16UC1, 1021);
    right = randomImage(rng, size, CV_16UC1, 1021);
    for (int y0 = 0; y0 < size.height; y0 += 24)
    {
        const int d = rng.uniform(0, numDisparities);
        const bool isFlat = rng.uniform(0, 4) == 0;
        for (int y = y0; y < std::min(y0 + 24, size.height); ++y)
            for (int x = 0; x < size.width; ++x)
            {
                if (isFlat && x % 40 < 24)
                    left.at<ushort>(y, x) = 500;
                if (x >= d && rng.uniform(0, 12))
                    right.at<ushort>(y, x - d) = left.at<ushort>(y, x);
            }
    }
}

Mat find(const Mat& left, const Mat& right, int blockSize, int numDisparities)
{
    hdp::CensusCost cost;
    cost.prepare(left, right, numDisparities, blockSize);
    Mat matches(3, 1, CV_8UC1); // of another size and type
    hdp::findSparseMatches(cost, left.size(), numDisparities, matches);
    return matches;
}

TEST(HDPStereo_SparseMatches, direct_search)
{
    RNG rng(61);
    for (const Size& size : { Size(1, 1), Size(9, 40), Size(19, 19), Size(20, 5), Size(200, 130), Size(331, 97) })
        for (int blockSize : { 3, 5, 7 })
            for (int numDisparities : { 1, 3, 6, 16, 33, 100 })
            {
                SCOPED_TRACE(testing::Message()
                             << size << ", window of " << blockSize << ", " << numDisparities << " disparities");
                Mat left, right;
                makeLevels(rng, size, numDisparities, left, right);
                expectIdentical(oracle::findSparseMatches(left, right, blockSize, numDisparities),
                                find(left, right, blockSize, numDisparities));
            }
}

TEST(HDPStereo_SparseMatches, are_found_where_they_are_unique)
{
    RNG rng(62);
    const int d = 37;
    const Mat texture = randomImage(rng, Size(400, 100), CV_16UC1, 1021);
    const Mat left = texture.colRange(0, 360), right = texture.colRange(d, 360 + d);
    const Mat matches = find(left, right, 7, 64);
    for (int x = 0; x < matches.cols; ++x)
        for (int y = 0; y < matches.rows; ++y)
            if (24 * x + 12 - 7 >= d && 24 * x + 12 + 7 < left.cols)
            {
                EXPECT_EQ(16 * d, matches.at<ushort>(y, x)) << x << ", " << y;
            }

    Mat periodic(100, 360, CV_16UC1);
    for (int x = 0; x < periodic.cols; ++x)
        periodic.col(x).setTo(texture.at<ushort>(0, x % 10));
    const Mat ofPeriodic = find(periodic, periodic, 7, 64).colRange(1, matches.cols); // with more than one period
    EXPECT_EQ((int)ofPeriodic.total(), countNonZero(ofPeriodic == noMatch)) << "repeated texture";
    const Mat flat(100, 360, CV_16UC1, Scalar(800));
    EXPECT_EQ((int)matches.total(), countNonZero(find(flat, right, 7, 64) == noMatch)) << "no texture";
}

} // namespace
} // namespace opencv_test
