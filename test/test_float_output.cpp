// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"

namespace opencv_test { namespace {

const int minDisparity = -3;

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(121, 67), 24, 8);
    return pair;
}

Ptr<HDPTreeMatcher> createMatcher(int preset) { return HDPTreeMatcher::create(minDisparity, 30, preset); }

//! The disparities in pixels of what CV_16S holds, which all are multiples of 1/16
Mat inPixels(const Mat& fixedPoint)
{
    Mat pixels(fixedPoint.size(), CV_32F);
    for (int y = 0; y < fixedPoint.rows; ++y)
        for (int x = 0; x < fixedPoint.cols; ++x)
            pixels.at<float>(y, x) = (float)fixedPoint.at<short>(y, x) / 16;
    return pixels;
}

TEST(HDPStereo_FloatOutput, pixels_instead_of_sixteenths)
{
    for (const System& system : presets)
        for (bool subpixel : { false, true })
            for (bool filters : { false, true })
            {
                SCOPED_TRACE(testing::Message() << system.name << ", subpixel " << subpixel << ", filters " << filters);
                const Ptr<HDPTreeMatcher> matcher = createMatcher(system.preset);
                change(*matcher, [&](Params& p) { p.useSubpixel = subpixel; });
                matcher->setDisp12MaxDiff(filters ? 1 : -1);
                matcher->setSpeckleWindowSize(filters ? 60 : 0);
                matcher->setSpeckleRange(1);
                const Mat fixedPoint = match(*matcher, testPair().left, testPair().right);
                ASSERT_EQ(CV_16SC1, fixedPoint.type());
                matcher->setDisparityDepth(CV_32F);
                const Mat pixels = match(*matcher, testPair().left, testPair().right);
                expectIdentical(inPixels(fixedPoint), pixels);
                EXPECT_EQ(filters, cv::countNonZero(pixels == minDisparity - 1) > 0);
                EXPECT_EQ(subpixel, cv::countNonZero(fixedPoint & 15) > 0);
            }
}

TEST(HDPStereo_FloatOutput, each_filter_by_itself)
{
    const Ptr<HDPTreeMatcher> matcher = createMatcher(HDPTreeMatcher::PRESET_FAST);
    matcher->setDisparityDepth(CV_32F);
    const Mat dense = match(*matcher, testPair().left, testPair().right);
    for (bool speckles : { false, true })
    {
        matcher->setDisp12MaxDiff(speckles ? -1 : 1);
        matcher->setSpeckleWindowSize(speckles ? 60 : 0);
        const Mat filtered = match(*matcher, testPair().left, testPair().right);
        Mat expected = dense.clone();
        expected.setTo(Scalar(minDisparity - 1), filtered == minDisparity - 1);
        EXPECT_GT(countDifferent(dense, filtered), 0);
        expectIdentical(expected, filtered);
    }
}

TEST(HDPStereo_FloatOutput, array_of_fixed_type_decides)
{
    const Ptr<HDPTreeMatcher> matcher = createMatcher(HDPTreeMatcher::PRESET_FAST);
    const Mat fixedPoint = match(*matcher, testPair().left, testPair().right);
    for (int depth : { CV_16S, CV_32F })
    {
        matcher->setDisparityDepth(depth);
        Mat_<float> pixels;
        matcher->compute(testPair().left, testPair().right, pixels);
        expectIdentical(inPixels(fixedPoint), pixels);
        Mat_<short> sixteenths;
        matcher->compute(testPair().left, testPair().right, sixteenths);
        expectIdentical(fixedPoint, sixteenths);
        EXPECT_EQ(depth, matcher->getDisparityDepth());
    }
}

TEST(HDPStereo_FloatOutput, other_arrays)
{
    const Ptr<HDPTreeMatcher> matcher = createMatcher(HDPTreeMatcher::PRESET_FAST);
    matcher->setDisparityDepth(CV_32F);
    const Mat expected = match(*matcher, testPair().left, testPair().right);

    Mat used(expected.size(), CV_16S); // of another type
    matcher->compute(testPair().left, testPair().right, used);
    expectIdentical(expected, used);

    UMat device;
    matcher->compute(testPair().left, testPair().right, device);
    expectIdentical(expected, device.getMat(ACCESS_READ));

    Mat canvas(expected.rows + 4, expected.cols + 6, CV_32F, Scalar(7));
    Mat region = canvas(Rect(2, 3, expected.cols, expected.rows));
    matcher->compute(testPair().left, testPair().right, region);
    expectIdentical(expected, canvas(Rect(2, 3, expected.cols, expected.rows)));
    EXPECT_EQ(7, canvas.at<float>(2, 2));
}

TEST(HDPStereo_FloatOutput, parameter)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(), read = HDPTreeMatcher::create();
    EXPECT_EQ(CV_16S, matcher->getDisparityDepth());
    matcher->setDisparityDepth(CV_32F);
    EXPECT_EQ(CV_32F, matcher->getDisparityDepth());
    for (int bad : { CV_8U, CV_16U, CV_32S, CV_64F, CV_32FC2, -1 })
        expectRejected([&] { matcher->setDisparityDepth(bad); }, "disparityDepth");
    EXPECT_EQ(CV_32F, matcher->getDisparityDepth());

    const std::string text = serialized(*matcher);
    deserialize(text, *read);
    EXPECT_EQ(CV_32F, read->getDisparityDepth());

    const std::string key = "disparityDepth: ";
    const size_t at = text.find(key);
    ASSERT_NE(std::string::npos, at);
    std::string hostile = text;
    hostile.replace(at + key.size(), 1, "6");
    expectRejected([&] { deserialize(hostile, *read); }, "disparityDepth");
    EXPECT_EQ(CV_32F, read->getDisparityDepth());
}

}} // namespace opencv_test
