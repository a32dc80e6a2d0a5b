// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"

namespace opencv_test { namespace {

// Disparities that the coarser layers make hard to find: at the ends of the range, of thin structures, and of texture that
// is finer than the pixels of these layers.

Mat whiteNoise(uint64 seed, Size size)
{
    RNG rng(seed);
    Mat noise(size, CV_8UC1);
    rng.fill(noise, RNG::UNIFORM, 0, 256);
    return noise;
}

Mat disparityOf(int preset, int minDisparity, int numDisparities, const Mat& left, const Mat& right)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, numDisparities, preset);
    matcher->setDisparityDepth(CV_32F);
    return match(*matcher, left, right);
}

//! Percentage of pixels in some columns that are off by a pixel or more
double wrong(const Mat& disparity, double truth, const Range& columns)
{
    const Mat part = disparity.colRange(columns);
    return 100. * countNonZero(abs(part - truth) >= 1) / (double)part.total();
}

void expectWholeRange(const System& preset, int numDisparities)
{
    const Size size(numDisparities + 640, 400);
    const int last = numDisparities - 1;
    const double limit = preset.preset == HDPTreeMatcher::PRESET_ULTRAFAST ? 2 : 0.5;
    for (int minDisparity : { 0, -16, 7 })
        for (int d : { 0, 1, 2, numDisparities / 2, last - 2, last - 1, last })
        {
            if (minDisparity != 0 && d != 0 && d != last)
                continue; // the ends tell whether all are moved
            // Columns before numDisparities lie outside the right image for some candidates; so do the last 16 for
            // negative disparities.
            const int truth = minDisparity + d, margin = 16;
            const Mat texture = whiteNoise(1000 * numDisparities + d, size + Size(numDisparities + 2 * margin + 7, 0));
            const Mat left = texture.colRange(margin, margin + size.width);
            const Mat right = texture.colRange(margin + truth, margin + truth + size.width);
            const Mat disparity = disparityOf(preset.preset, minDisparity, numDisparities, left, right);
            EXPECT_LE(wrong(disparity, truth, Range(std::max(numDisparities, truth), size.width - margin)), limit)
                << preset.name << ", " << numDisparities << " disparities from " << minDisparity << " on, " << truth;
        }
}

TEST(HDPStereo_SlowWholeRange, each_disparity_of_a_small_range_is_found)
{
    for (const System& preset : presets)
        expectWholeRange(preset, 16);
}

TEST(HDPStereo_SlowWholeRange, each_disparity_is_found)
{
    for (const System& preset : presets)
        for (int numDisparities : { 48, 64, 65, 100, 128, 256 })
            expectWholeRange(preset, numDisparities);
}

//! The mean over several pictures at the ends of the range, which have candidates on one side only. In so small ones no
//! noise is found that smooths: ULTRAFAST, whose only layer has 1 as half a pixel, then has 0 for one pixel in twenty.
//! Of the largest disparity, if that is half a pixel, too, one in fifty has less.
TEST(HDPStereo_SlowWholeRange, ends_in_several_pictures)
{
    const int pictures = 5;
    for (const System& preset : presets)
        for (int numDisparities : { 16, 48, 96, 128 })
            for (int d : { 0, 1, 2, numDisparities - 2, numDisparities - 1 })
            {
                const bool isUltrafast = preset.preset == HDPTreeMatcher::PRESET_ULTRAFAST;
                if (isUltrafast && d == 1)
                    continue; // see above, and each_disparity_is_found for larger pictures
                const Size size(numDisparities + 320, 200);
                double sum = 0;
                for (int i = 0; i < pictures; ++i)
                {
                    const Mat texture = whiteNoise(7000 * i + 10 * numDisparities + d, size + Size(numDisparities, 0));
                    const Mat left = texture.colRange(0, size.width), right = texture.colRange(d, d + size.width);
                    sum += wrong(disparityOf(preset.preset, 0, numDisparities, left, right), d,
                                 Range(numDisparities, size.width - 16));
                }
                EXPECT_LE(sum / pictures, isUltrafast ? 2.5 : 0.5)
                    << preset.name << ", " << numDisparities << " disparities, " << d;
            }
}

//! A background at the smallest disparity behind a square
TEST(HDPStereo_WholeRange, background_at_the_smallest_disparity)
{
    for (const System& preset : presets)
        for (int minDisparity : { 0, 5, -7 })
        {
            const Size size(320, 240);
            const Rect square(150, 70, 100, 100);
            const Mat back = whiteNoise(3, size + Size(40, 0)), front = whiteNoise(4, square.size());
            Mat left = back.colRange(10, 10 + size.width).clone();
            Mat right = back.colRange(10 + minDisparity, 10 + minDisparity + size.width).clone();
            front.copyTo(left(square));
            front.copyTo(right(square - Point(minDisparity + 20, 0)));
            const Mat disparity = disparityOf(preset.preset, minDisparity, 32, left, right);
            EXPECT_LE(wrong(disparity.rowRange(0, 50), minDisparity, Range(40, 300)), 2) << preset.name << minDisparity;
            EXPECT_LE(wrong(disparity(square), minDisparity + 20, Range(15, 85)), 10) << preset.name << minDisparity;
        }
}

//! What is found of thin structures: the share that is right, in percent, and means of confidences
struct FoundBars
{
    double share, ofLost, ofOthers;
};

//! Bars of disparity 40 before a background of 10, right within a pixel
FoundBars matchBars(int preset, int width, bool isHorizontal, int seed)
{
    const Size size(640, 480);
    Mat back = whiteNoise(seed + width, size + Size(10, 0)), front = whiteNoise(seed + 1 + width, size + Size(40, 0));
    GaussianBlur(back, back, Size(), 0.7);
    GaussianBlur(front, front, Size(), 0.7);
    Mat left = back.colRange(0, size.width).clone(), right = back.colRange(10, 10 + size.width).clone();
    Mat bars(size, CV_8UC1, Scalar(0));
    for (int at = 90; at + width < (isHorizontal ? size.height : size.width) - 20; at += 110)
    {
        const Rect bar = isHorizontal ? Rect(0, at, size.width, width) : Rect(at, 0, width, size.height);
        front(bar).copyTo(left(bar));
        if (isHorizontal)
            front(bar + Point(40, 0)).copyTo(right(bar));
        else
            front(bar).copyTo(right(bar - Point(40, 0)));
        bars(bar).setTo(255);
    }
    bars.colRange(0, 80).setTo(0);

    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, preset);
    matcher->setDisparityDepth(CV_32F);
    const Mat disparity = match(*matcher, left, right);
    Mat confidence;
    matcher->getConfidence(confidence);
    const Mat isRight = abs(disparity - 40) <= 1;
    const FoundBars found = { 100. * countNonZero(bars & isRight) / countNonZero(bars),
                              mean(confidence, bars & ~isRight)[0], mean(confidence, bars == 0)[0] };
    return found;
}

TEST(HDPStereo_SlowWholeRange, thin_structures_are_kept_or_not_confident)
{
    const struct
    {
        int preset, width;
        double vertical, horizontal;
    } limits[] = {
        { HDPTreeMatcher::PRESET_FAST, 3, 69, 86 },    { HDPTreeMatcher::PRESET_FAST, 4, 94, 95 },
        { HDPTreeMatcher::PRESET_FAST, 6, 94, 95 },    { HDPTreeMatcher::PRESET_FAST, 8, 95, 95 },
        { HDPTreeMatcher::PRESET_QUALITY, 3, 61, 79 }, { HDPTreeMatcher::PRESET_QUALITY, 4, 93, 95 },
        { HDPTreeMatcher::PRESET_QUALITY, 6, 98, 98 }, { HDPTreeMatcher::PRESET_QUALITY, 8, 98, 98 },
        { HDPTreeMatcher::PRESET_TREE, 3, 56, 70 },    { HDPTreeMatcher::PRESET_TREE, 4, 94, 95 },
        { HDPTreeMatcher::PRESET_TREE, 6, 95, 95 },    { HDPTreeMatcher::PRESET_TREE, 8, 95, 95 }
    }; // at most 5 points less than today
    for (const auto& limit : limits)
        for (bool isHorizontal : { false, true })
        {
            SCOPED_TRACE(testing::Message() << "preset " << limit.preset << ", width " << limit.width);
            const int pictures = 4;
            double share = 0;
            for (int i = 0; i < pictures; ++i)
            {
                const FoundBars found = matchBars(limit.preset, limit.width, isHorizontal, 5 + 20 * i);
                share += found.share / pictures;
                EXPECT_LT(found.ofLost, found.ofOthers);
            }
            EXPECT_GE(share, isHorizontal ? limit.horizontal : limit.vertical);
        }
}

//! Texture that varies along rows only, or that has no low frequencies
TEST(HDPStereo_SlowWholeRange, texture_that_coarse_layers_do_not_have)
{
    const Size size(500, 160);
    const int numDisparities = 64;
    for (int preset : { +HDPTreeMatcher::PRESET_FAST, +HDPTreeMatcher::PRESET_QUALITY })
        for (bool isBarcode : { true, false })
        {
            double sum = 0;
            int count = 0;
            for (int d = 1; d < numDisparities; d += 2, ++count)
            {
                Mat texture, smooth;
                if (isBarcode)
                    repeat(whiteNoise(d, Size(size.width + numDisparities, 1)), size.height, 1, texture);
                else
                {
                    whiteNoise(d, size + Size(numDisparities, 0)).convertTo(texture, CV_32F);
                    GaussianBlur(texture, smooth, Size(), 1);
                    Mat(texture - smooth + 128).convertTo(texture, CV_8U);
                }
                const Mat left = texture.colRange(0, size.width), right = texture.colRange(d, d + size.width);
                const double share =
                    wrong(disparityOf(preset, 0, numDisparities, left, right), d, Range(numDisparities, size.width));
                EXPECT_LE(share, 10) << "preset " << preset << ", disparity " << d;
                sum += share;
            }
            EXPECT_LE(sum / count, 2) << "preset " << preset << (isBarcode ? ", barcode" : ", high frequencies");
        }
}

}} // namespace opencv_test
