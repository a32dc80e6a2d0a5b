// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "../src/base/units.hpp"
#include "../src/cost/census_cost.hpp"
#include "../src/map/disparity_output.hpp"
#include "../src/map/disparity_confidence.hpp"
#include "../src/pair/image_levels.hpp"

namespace opencv_test { namespace {

typedef HDPTreeMatcher M;

const float infinity = std::numeric_limits<float>::infinity();

Mat sigmaOf(const M& matcher)
{
    Mat sigma;
    matcher.getDisparitySigma(sigma);
    return sigma;
}

Mat reasonsOf(const M& matcher)
{
    Mat reasons;
    matcher.getReasons(reasons);
    return reasons;
}

//! A pixel's, from the definition
double mismatchAt(const Mat& left, const Mat& right, const Mat& disparity, int x0, int y0)
{
    const auto level = [](const Mat& image, int x, int y) {
        return (double)image.at<uchar>(y, std::min(std::max(x, 0), image.cols - 1));
    };
    double sum = 0, squares = 0, gradients = 0;
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i)
        {
            const int x = std::min(std::max(x0 + i, 0), left.cols - 1),
                      y = std::min(std::max(y0 + j, 0), left.rows - 1);
            const int d = disparity.at<ushort>(y, x);
            const double fraction = d % 16 / 16.;
            const double matched =
                (1 - fraction) * level(right, x - d / 16, y) + fraction * level(right, x - d / 16 - 1, y);
            const double difference = level(left, x, y) - matched,
                         gradient = (level(left, x + 1, y) - level(left, x - 1, y)) / 2;
            sum += difference / 81;
            squares += difference * difference / 81;
            gradients += gradient * gradient / 81;
        }
    return std::sqrt(std::max(squares - sum * sum, 0.)) / (std::sqrt(gradients) + 0.5);
}

//! Each pixel of the layer is a block of the image, and the last ones go on beyond it, as in the map.
TEST(HDPStereo_DisparitySigma, of_images_that_are_no_multiples_of_the_layer)
{
    const SyntheticPair pair = makeSyntheticPair(Size(187, 103), 32, 3);
    for (int layer : { 1, 2, 3 })
    {
        const Ptr<M> matcher = M::create(0, 256); // enough for five layers
        M::Params params;
        params.finestLayer = layer;
        params.numLayers = layer + 2;
        matcher->setParams(params);
        match(*matcher, pair.left, pair.right);
        Mat confidence;
        matcher->getConfidence(confidence);
        const Mat sigma = sigmaOf(*matcher), reasons = reasonsOf(*matcher);
        EXPECT_EQ(pair.left.size(), confidence.size());
        EXPECT_GT(countNonZero(reasons != M::REASON_MATCHED), 0);
        for (int y = 0; y < sigma.rows; ++y)
            for (int x = 0; x < sigma.cols; ++x)
            {
                const int lastX = (sigma.cols >> layer) - 1, lastY = (sigma.rows >> layer) - 1;
                const Point first(std::min(x >> layer, lastX) << layer, std::min(y >> layer, lastY) << layer);
                ASSERT_EQ(sigma.at<float>(first), sigma.at<float>(y, x)) << Point(x, y);
                ASSERT_EQ(reasons.at<uchar>(first), reasons.at<uchar>(y, x)) << Point(x, y);
            }
    }
}

TEST(HDPStereo_DisparitySigma, mismatch_is_that_of_the_definition)
{
    RNG rng(81);
    for (const Size size : { Size(70, 41), Size(9, 3), Size(1, 1) })
    {
        const Mat left = randomImage(rng, size, CV_8UC1), right = randomImage(rng, size, CV_8UC1);
        Mat leftGrey, rightGrey, disparity(size, CV_16U), mismatch;
        rng.fill(disparity, RNG::UNIFORM, 0, 19 * 16 + 1);
        hdp::greyLevels(left, hdp::LevelScale(), leftGrey);
        hdp::greyLevels(right, hdp::LevelScale(), rightGrey);
        hdp::CensusCost cost;
        cost.prepare(leftGrey, rightGrey, 20, 7);
        hdp::levelMismatch(disparity, cost, mismatch);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                ASSERT_NEAR(mismatchAt(left, right, disparity, x, y), mismatch.at<float>(y, x), 1e-4) << x << ", " << y;
    }
}

TEST(HDPStereo_DisparitySigma, falls_with_confidence_and_rises_with_mismatch)
{
    Mat confidence(60, 256, CV_8U), mismatch(60, 256, CV_32F), sigma, whole;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 256; ++x)
        {
            confidence.at<uchar>(y, x) = (uchar)x;
            mismatch.at<float>(y, x) = 0.06f * y;
        }
    hdp::disparitySigma(confidence, mismatch, 0, 0, 0, sigma);
    hdp::disparitySigma(confidence, mismatch, 0, 0, 0.34f, whole);
    EXPECT_TRUE(cv::checkRange(sigma, true, nullptr, 0.18, 4));
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 256; ++x)
        {
            const float value = sigma.at<float>(y, x);
            EXPECT_LE(value, sigma.at<float>(y, std::max(x - 1, 0)) + 1e-6f);
            EXPECT_GE(value, sigma.at<float>(std::max(y - 1, 0), x) - 1e-6f);
            EXPECT_NEAR(std::sqrt(value * value + 0.34 * 0.34), whole.at<float>(y, x), 1e-5);
        }
}

TEST(HDPStereo_DisparitySigma, rises_with_the_row_error_and_the_noise)
{
    const Mat confidence(1, 3, CV_8U, Scalar(100));
    const auto sigmaFor = [&](double rowError, double noise) {
        Mat sigma;
        hdp::disparitySigma(confidence, Mat(), rowError, noise, 0, sigma);
        return sigma.at<float>(0, 1);
    };
    EXPECT_NEAR(1.2, sigmaFor(1.44 * 0.1, 0) / sigmaFor(0.1, 0), 1e-5);
    EXPECT_EQ(sigmaFor(0.12, 0), sigmaFor(0, 0)) << "unknown";
    EXPECT_EQ(sigmaFor(0.03, 0), sigmaFor(1e-6, 0));
    EXPECT_EQ(sigmaFor(0.25, 0), sigmaFor(1e6, 0));
    EXPECT_NEAR(1.1, sigmaFor(0.1, 1.21 * 1.5) / sigmaFor(0.1, 1.5), 1e-5);
    EXPECT_EQ(sigmaFor(0.1, 1), sigmaFor(0.1, 0)) << "unknown";
    EXPECT_EQ(sigmaFor(0.1, 2), sigmaFor(0.1, 1e6));
}

TEST(HDPStereo_DisparitySigma, is_true_of_a_pair)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 48, 8);
    for (const int preset :
         { +M::PRESET_PAPER, +M::PRESET_FAST, +M::PRESET_ULTRAFAST, +M::PRESET_QUALITY, +M::PRESET_TREE })
    {
        SCOPED_TRACE(preset);
        const Ptr<M> matcher = M::create(0, 48, preset);
        EXPECT_TRUE(sigmaOf(*matcher).empty());
        matcher->setDisparityDepth(CV_32F);
        const Mat disparity = match(*matcher, pair.left, pair.right), sigma = sigmaOf(*matcher);
        ASSERT_EQ(CV_32FC1, sigma.type());
        ASSERT_EQ(disparity.size(), sigma.size());
        const Mat error = cv::abs(disparity - pair.truth), within = error <= sigma;
        EXPECT_GE(cv::countNonZero(within), 0.5 * within.total());
        const Mat isWrong = error > 3, isRight = error < 1;
        EXPECT_GT(cv::mean(sigma, isWrong)[0], 2 * cv::mean(sigma, isRight)[0]);
        Mat_<uchar> other;
        EXPECT_THROW(matcher->getDisparitySigma(other), cv::Exception);
        for (const int threads : { 1, 5 })
        {
            const ScopedThreads number(threads);
            expectIdentical(sigma, sigmaOf(*matcher));
        }
    }
}

//! Whole disparities are the nearest ones, and known as well, whether layers have fractions or not.
TEST(HDPStereo_DisparitySigma, of_whole_disparities)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 150), 32, 9);
    const Ptr<M> matcher = M::create(0, 32);
    matcher->setDisparityDepth(CV_32F);
    const Mat exact = match(*matcher, pair.left, pair.right), sigma = sigmaOf(*matcher);
    change(*matcher, [](Params& p) { p.useSubpixel = false; });
    const Mat disparity = match(*matcher, pair.left, pair.right), whole = sigmaOf(*matcher);
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 200; ++x)
        {
            ASSERT_EQ(cvRound(exact.at<float>(y, x)), disparity.at<float>(y, x));
            ASSERT_NEAR(std::hypot(sigma.at<float>(y, x), 0.34), whole.at<float>(y, x), 1e-4);
        }
}

TEST(HDPStereo_DisparitySigma, and_reasons_of_rejected_pixels)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 150), 32, 9);
    for (const int minDisparity : { 0, -9 })
        for (const int filters : { 0, 1, 2, 3 })
        {
            SCOPED_TRACE(format("minDisparity %d, filters %d", minDisparity, filters));
            const Ptr<M> matcher = M::create(minDisparity, 32 - minDisparity);
            EXPECT_TRUE(reasonsOf(*matcher).empty());
            change(*matcher, [](Params& p) { p.fillOcclusions = false; });
            matcher->setDisp12MaxDiff(filters & 1 ? 1 : -1);
            const Mat unfiltered = match(*matcher, pair.left, pair.right);
            matcher->setSpeckleWindowSize(filters & 2 ? 100 : 0);
            const Mat disparity = match(*matcher, pair.left, pair.right), sigma = sigmaOf(*matcher),
                      reasons = reasonsOf(*matcher);
            const short invalid = (short)(16 * (minDisparity - 1));
            int rejected = 0;
            for (int y = 0; y < 150; ++y)
                for (int x = 0; x < 200; ++x)
                {
                    const bool isUnstable = unfiltered.at<short>(y, x) == invalid,
                               isRejected = disparity.at<short>(y, x) == invalid;
                    rejected += isRejected;
                    ASSERT_EQ(isRejected, sigma.at<float>(y, x) == infinity);
                    const int reason = reasons.at<uchar>(y, x);
                    if (isUnstable)
                        ASSERT_EQ((int)M::REASON_UNSTABLE, reason);
                    else if (isRejected)
                        ASSERT_EQ((int)M::REASON_SPECKLE, reason);
                    else
                        ASSERT_EQ(x * 16 - disparity.at<short>(y, x) <= -8, reason == M::REASON_OUTSIDE);
                }
            EXPECT_EQ(filters > 0, rejected > 0);
        }
}

//! Half a pixel before the right image nothing hides a pixel, whether its column is rounded into the image or not.
TEST(HDPStereo_DisparitySigma, reasons_at_the_border)
{
    const Mat disparity = (Mat_<ushort>(1, 6) << 8, 24, 40, 56, 72, 72);
    Mat reasons;
    hdp::findReasons(disparity, hdp::OutputPlan{ 0, 0, 0, false, 0, 0, 0 }, 6, hdp::CostLimits(), reasons);
    const int outside = M::REASON_OUTSIDE, matched = M::REASON_MATCHED;
    expectIdentical((Mat_<uchar>(1, 6) << outside, outside, outside, outside, outside, matched), reasons);
}

TEST(HDPStereo_DisparitySigma, reasons_are_those_of_the_scene)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 48, 10);
    for (const int preset : { +M::PRESET_FAST, +M::PRESET_ULTRAFAST, +M::PRESET_QUALITY, +M::PRESET_TREE })
    {
        SCOPED_TRACE(preset);
        const Ptr<M> matcher = M::create(0, 48, preset);
        match(*matcher, pair.left, pair.right);
        const Mat reasons = reasonsOf(*matcher), isMatched = reasons == +M::REASON_MATCHED;
        int outside = 0, found = 0;
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 400; ++x)
            {
                const bool isOutside = x - pair.truth.at<float>(y, x) < -1;
                outside += isOutside;
                found += isOutside && reasons.at<uchar>(y, x) == M::REASON_OUTSIDE;
            }
        EXPECT_GE(found, 0.9 * outside);
        EXPECT_GE(cv::countNonZero(isMatched & pair.visible), 0.93 * cv::countNonZero(pair.visible));
        const Mat hidden = pair.visible == 0;
        EXPECT_LE(cv::countNonZero(isMatched & hidden), 0.5 * cv::countNonZero(hidden));
    }
}

}} // namespace opencv_test
