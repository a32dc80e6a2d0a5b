// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"

#include "../src/pair/image_levels.hpp"
#include "../src/pair/light_alignment.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

using hdp::LightModel;

//! What a right image's level becomes in another camera: levels from 0 to 1, places from the centre as in LightModel
typedef double (*Light)(double level, double x, double y);

// clang-format off
const Light lights[] = {
    [](double level, double, double) { return 0.6 * level; },
    [](double level, double, double) { return 1.2 * level; },
    [](double level, double, double) { return level + 0.08; },
    [](double level, double, double) { return std::pow(level, 1.5); },
    [](double level, double x, double y) { return level * (1 - 1.2 * (x * x + y * y)); },
    [](double level, double x, double y) { return level * (0.8 + 0.2 * x - 0.1 * y); },
};
// clang-format on

Mat relight(const Mat& image, Light light)
{
    Mat changed(image.size(), CV_8UC3);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            for (int c = 0; c < 3; ++c)
            {
                const double level =
                    light(image.at<Vec3b>(y, x)[c] / 255., (x + 0.5) / image.cols - 0.5, (y + 0.5) / image.rows - 0.5);
                changed.at<Vec3b>(y, x)[c] = saturate_cast<uchar>(255 * level);
            }
    return changed;
}

LightModel foundBy(const HDPTreeMatcher& matcher, bool isExpected)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const std::vector<double>& found = findings.light;
    EXPECT_EQ(isExpected, findings.isLightChanged);
    LightModel model;
    EXPECT_EQ((size_t)LightModel::terms, found.size());
    std::copy(found.begin(), found.end(), model.coefficients.val);
    return model;
}

//! A level from 0 to 1 between the black and the white of a pair
double stretched(double level, const PairModel& model)
{
    return (256 * level - model.black) / (model.white - model.black);
}

//! By the formula, pixel by pixel
TEST(HDPStereo_LightAlignment, levels_follow_the_model)
{
    RNG rng(1);
    LightModel model;
    model.coefficients = LightModel::Coefficients(1.3, 0.1, -0.2, 0.3, 0.1, 0.4, 0.5, -0.03, -0.2, 0.1);
    for (const Size size : { Size(101, 37), Size(1, 1), Size(16, 3) })
    {
        const Mat levels = randomImage(rng, size, CV_16UC1, 1021);
        Mat aligned = levels.clone();
        hdp::alignLight(aligned, model, hdp::ImageFrame(aligned.size()));
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const double value = 1020 * model.at(levels.at<ushort>(y, x) / 1020., (x + 0.5) / size.width - 0.5,
                                                     (y + 0.5) / size.height - 0.5);
                EXPECT_NEAR(std::min(std::max(value, 0.), (double)hdp::whiteLevel), aligned.at<ushort>(y, x), 0.51);
            }
    }
}

TEST(HDPStereo_SlowLightAlignment, finds_what_was_done)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 1);
    for (size_t i = 0; i < sizeof lights / sizeof *lights; ++i)
    {
        SCOPED_TRACE(format("light %d", (int)i));
        const Mat right = relight(pair.right, lights[i]);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
        match(*matcher, pair.left, right);
        const LightModel model = foundBy(*matcher, true);
        const PairModel ofPair = matcher->getPairModel();
        double before = 0, after = 0;
        for (int y = 0; y < 480; y += 5)
            for (int x = 0; x < 640; x += 5)
            {
                const double u = (x + 0.5) / 640 - 0.5, v = (y + 0.5) / 480 - 0.5;
                for (const double level : { 0.3, 0.5, 0.7 }) // those of the pair
                {
                    const double is = stretched(level, ofPair), changed = stretched(lights[i](level, u, v), ofPair);
                    before += std::pow(changed - is, 2);
                    after += std::pow(model.at(changed, u, v) - is, 2);
                }
            }
        EXPECT_LE(std::sqrt(after / before), 0.25);
    }
}

TEST(HDPStereo_SlowLightAlignment, errors_are_those_of_the_same_light)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 2);
    for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_ULTRAFAST,
                              (int)HDPTreeMatcher::PRESET_QUALITY, (int)HDPTreeMatcher::PRESET_TREE })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, preset);
        const double clean = badPixels(match(*matcher, pair.left, pair.right), pair.truth, pair.visible, 1);
        for (const Light light : lights)
        {
            const Mat disparity = match(*matcher, pair.left, relight(pair.right, light));
            EXPECT_LE(badPixels(disparity, pair.truth, pair.visible, 1), 1.1 * clean + 0.7);
        }
    }
}

//! The documentation of Findings::light: the same levels, from black to white, whatever the range is
TEST(HDPStereo_LightAlignment, of_any_range)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 24, 7);
    const int moved = 40;
    Mat right; // 40 pixels farther to the left: disparities of 40 to 63
    cv::copyMakeBorder(pair.right.colRange(moved, 640), right, 0, 0, 0, moved, BORDER_REPLICATE);
    const Light light = [](double level, double x, double) { return level * (0.7 + 0.6 * x); };
    right = relight(right, light);
    for (const int minDisparity : { 0, 40, -150 })
    {
        SCOPED_TRACE(minDisparity);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, 64 - minDisparity);
        match(*matcher, pair.left, right);
        const LightModel model = foundBy(*matcher, true);
        const PairModel ofPair = matcher->getPairModel();
        EXPECT_EQ(ofPair.light, matcher->getFindings().light);
        for (int v = 40; v < 480; v += 80)
            for (int u = 40; u < 560; u += 80)
            {
                const double x = (u + 0.5 + minDisparity + ofPair.addedColumns) / (640 + ofPair.addedColumns) - 0.5;
                const double y = (v + 0.5) / 480 - 0.5;
                const double level = light(0.5, (u + 0.5) / 640 - 0.5, y);
                EXPECT_NEAR(stretched(0.5, ofPair), model.at(stretched(level, ofPair), x, y), 0.03) << u << ", " << v;
            }
    }
}

//! The same light, or none to compare
TEST(HDPStereo_LightAlignment, good_pairs_stay_as_they_are)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 32, 3);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
    const Mat disparity = match(*matcher, pair.left, pair.right);
    foundBy(*matcher, false);
    matcher->setUseLightAlignment(false);
    expectIdentical(disparity, match(*matcher, pair.left, pair.right));
    EXPECT_EQ(LightModel::identity(), foundBy(*matcher, false).coefficients);
    matcher->setUseLightAlignment(true);
    match(*matcher, Mat(200, 300, CV_8UC1, Scalar(90)), Mat(200, 300, CV_8UC1, Scalar(190)));
    EXPECT_EQ(LightModel::identity(), foundBy(*matcher, false).coefficients);
}

//! Whatever a model says: the cost of colours and gradients sees the levels of the images.
TEST(HDPStereo_LightAlignment, of_grey_levels_alone)
{
    const SyntheticPair pair = makeSyntheticPair(Size(64, 48), 16, 6);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16, HDPTreeMatcher::PRESET_PAPER);
    const Mat disparity = match(*matcher, pair.left, pair.right);
    PairModel model = matcher->getPairModel();
    model.isLightChanged = true;
    model.light[0] = 0.7;
    matcher->setPairModel(model);
    expectIdentical(disparity, match(*matcher, pair.left, pair.right));
    EXPECT_EQ(0.7, foundBy(*matcher, false).coefficients[0]);
}

//! Every part of the image has a lamp of its own: nothing that a model explains.
TEST(HDPStereo_LightAlignment, other_lamps)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 4);
    RNG rng(5);
    Mat right = pair.right.clone();
    for (int y = 0; y < 480; y += 60)
        for (int x = 0; x < 640; x += 64)
        {
            Mat part = right(Rect(x, y, 64, 60));
            part.convertTo(part, -1, rng.uniform(0.6, 1.4));
        }
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
    match(*matcher, pair.left, right);
    foundBy(*matcher, false);
}

//! Rows and light together, whatever the number of threads; then a good pair
TEST(HDPStereo_LightAlignment, with_rows)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 32, 6);
    Mat right;
    warpAffine(relight(pair.right, lights[3]), right, Matx23d(1, 0, 0, 0, 1, 2), pair.right.size(), INTER_CUBIC,
               BORDER_REPLICATE);
    const int threads = getNumThreads();
    for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_ULTRAFAST })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32, preset);
        const Mat good = match(*matcher, pair.left, pair.right), changed = match(*matcher, pair.left, right);
        const LightModel model = foundBy(*matcher, true);
        const HDPTreeMatcher::Findings findings = matcher->getFindings();
        EXPECT_TRUE(findings.areRowsMoved);
        EXPECT_NEAR(2, findings.rows[0], 0.1);
        const double clean = badPixels(good, pair.truth, pair.visible, 1);
        EXPECT_LE(badPixels(changed, pair.truth, pair.visible, 1), 1.1 * clean + 1.5);
        setNumThreads(3);
        expectIdentical(changed, match(*matcher, pair.left, right));
        EXPECT_EQ(model.coefficients, foundBy(*matcher, true).coefficients);
        expectIdentical(good, match(*matcher, pair.left, pair.right));
        setNumThreads(threads);
    }
}

}} // namespace opencv_test
