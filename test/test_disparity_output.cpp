// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/map/disparity_output.hpp"

namespace opencv_test { namespace {

//! The documentation of outputDisparity(), pixel by pixel, in 1/16 pixel. rejected: what a filter takes away.
Mat_<int> expectedOutput(const Mat& finest, const hdp::OutputPlan& plan, Size size, const Mat& mask,
                         Mat_<uchar>& rejected)
{
    Mat map = finest;
    for (int layer = plan.finestLayer - 1; layer >= 0; --layer)
        map = oracle::upsampled(map, Size((size.width + plan.extension) >> layer, size.height >> layer));
    Mat_<int> output(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const double disparity = map.at<ushort>(y, x + plan.extension) / 16.;
            output(y, x) = (plan.isWhole ? cvRound(disparity) * 16 : cvRound(disparity * 16)) + plan.minDisparity * 16;
        }
    const int invalid = (plan.minDisparity - 1) * 16;
    rejected = mask.empty() ? Mat_<uchar>::zeros(size) : Mat_<uchar>(mask == 0);
    output.setTo(invalid, rejected);
    if (plan.disp12MaxDiff > 0)
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                for (int other = 0; other < size.width; ++other)
                {
                    const int column = x - cvRound(output(y, x) / 16.);
                    const bool haveData = output(y, x) != invalid && output(y, other) != invalid;
                    if (haveData && column >= 0 && column < size.width &&
                        other - cvRound(output(y, other) / 16.) == column &&
                        output(y, other) - output(y, x) > plan.disp12MaxDiff * 16)
                        rejected(y, x) = 255;
                }
    output.setTo(invalid, rejected);
    if (plan.speckleWindowSize > 0)
    {
        Mat filtered;
        output.convertTo(filtered, CV_16S);
        filterSpeckles(filtered, invalid, plan.speckleWindowSize, 16 * plan.speckleRange);
        filtered.convertTo(output, CV_32S);
        rejected = output == invalid;
    }
    return output;
}

TEST(HDPStereo_DisparityOutput, is_what_StereoMatcher_promises)
{
    RNG rng(51);
    for (int round = 0; round < 60; ++round)
    {
        const int finestLayer = round % 3, unit = 1 << finestLayer;
        const Size size(rng.uniform(1, 12) * 4, rng.uniform(1, 8) * 4);
        const hdp::OutputPlan plan = { rng.uniform(-20, 20), rng.uniform(0, 4) * 4,   finestLayer,      round % 5 == 0,
                                       rng.uniform(-1, 3),   rng.uniform(-1, 2) * 10, rng.uniform(0, 3) };
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << size << ", layer " << finestLayer);
        Mat finest = randomImage(rng, Size((size.width + plan.extension) / unit, size.height / unit), CV_16UC1,
                                 round % 2 ? 200 : 20);
        Mat_<uchar> rejected;
        Mat mask;
        if (round % 4 < 2)
            mask = randomImage(rng, size, CV_8UC1, 4);
        const Mat_<int> expected = expectedOutput(finest, plan, size, mask, rejected);

        hdp::OutputBuffers buffers;
        Mat fixedPoint(size, CV_16S), inPixels(size, CV_32F), asFixedPoint;
        hdp::outputDisparity(finest, plan, buffers, fixedPoint, mask);
        expected.convertTo(asFixedPoint, CV_16S);
        expectIdentical(asFixedPoint, fixedPoint);
        const bool hasFilters = plan.disp12MaxDiff > 0 || plan.speckleWindowSize > 0;
        ASSERT_EQ(hasFilters || !mask.empty(), !buffers.rejected.empty());
        if (!buffers.rejected.empty())
            expectIdentical(rejected, buffers.rejected.back().pixels);

        hdp::outputDisparity(finest, plan, buffers, inPixels, mask);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                ASSERT_EQ(expected(y, x) / 16.f, inPixels.at<float>(y, x)) << x << ", " << y;
    }
}

}} // namespace opencv_test
