// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

struct Errors
{
    double bad[3]; // by at least 0.5, 1 and 2 pixels, in percent
    double mean;   // in pixels
};

//! Mean errors on synthetic pairs; the right images with other grey levels if asked for.
Errors errorsOf(const System& system, bool otherExposure)
{
    const int numDisparities = 48;
    Errors errors = {};
    const int pairs = 8;
    for (int seed = 1; seed <= pairs; ++seed)
    {
        const SyntheticPair pair = makeSyntheticPair(Size(320, 240), numDisparities, seed);
        Mat right = pair.right;
        if (otherExposure)
            pair.right.convertTo(right, -1, 0.8, 10);
        const Mat disparity = match(*createSystem(system, numDisparities), pair.left, right);
        for (int i = 0; i < 3; ++i)
            errors.bad[i] += badPixels(disparity, pair.truth, pair.visible, 0.5 * (1 << i)) / pairs;
        errors.mean += meanError(disparity, pair.truth, pair.visible) / pairs;
    }
    return errors;
}

//! What is allowed more than was measured
const double margin = 1.05;

//! A preset, and its errors as they were measured
struct Measured
{
    System preset;
    double bad[3], mean; // the larger one with either exposure
    double slanted;      // mean error on a slanted plane, of the worst seed
};

void PrintTo(const Measured& measured, std::ostream* out) { *out << measured.preset.name; }

const Measured measured[] = {
    { presetFast, { 2.076, 0.779, 0.432 }, 0.1573, 0.0844 },
    { presetUltrafast, { 10.767, 3.914, 2.12 }, 0.4839, 0.1642 },
    { presetQuality, { 2.136, 0.769, 0.394 }, 0.1499, 0.0742 },
    { presetTree, { 2.076, 0.779, 0.432 }, 0.1573, 0.0844 },
};

typedef testing::TestWithParam<Measured> HDPStereo_Preset;

TEST_P(HDPStereo_Preset, error_on_synthetic_pairs)
{
    for (bool otherExposure : { false, true })
    {
        const Errors errors = errorsOf(GetParam().preset, otherExposure);
        for (int i = 0; i < 3; ++i)
            EXPECT_LE(errors.bad[i], margin * GetParam().bad[i]) << i << ", other exposure " << otherExposure;
        EXPECT_LE(errors.mean, margin * GetParam().mean) << "other exposure " << otherExposure;
    }
}

//! The census cost does not depend on the exposure, the paper's cost does.
TEST_P(HDPStereo_Preset, error_with_another_exposure_is_less_than_the_papers)
{
    static const Errors paper = errorsOf(presetPaper, true); // 17.91, 10.76, 9.56 percent and 1.665 pixels
    const Errors errors = errorsOf(GetParam().preset, true);
    for (int i = 0; i < 3; ++i)
        EXPECT_LE(errors.bad[i], 0.8 * paper.bad[i]) << i;
    EXPECT_LE(errors.mean, 0.7 * paper.mean);
}

TEST_P(HDPStereo_Preset, sub_pixel_disparities_of_a_slanted_plane)
{
    const int numDisparities = 48;
    for (int seed : { 1, 2, 3 })
    {
        const SyntheticPair pair = makeSlantedPlane(Size(320, 240), numDisparities, seed);
        const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam().preset, numDisparities);
        const double subpixel = meanError(match(*matcher, pair.left, pair.right), pair.truth, pair.visible);
        change(*matcher, [&](Params& p) { p.useSubpixel = false; });
        const double whole = meanError(match(*matcher, pair.left, pair.right), pair.truth, pair.visible);
        // The whole disparity nearest to the truth is off by 0.25.
        EXPECT_LE(subpixel, margin * GetParam().slanted) << "seed " << seed;
        EXPECT_LE(subpixel, 0.75 * whole) << "seed " << seed;
    }
}

//! Texture all over, a box in front of a wall: nothing to be wrong about but the box's border, where the finest layer
//! does not tell which of both a pixel belongs to.
TEST_P(HDPStereo_Preset, textured_surfaces_are_nearly_perfect)
{
    const Size size(400, 300);
    const int back = 9, front = 37, border = 4;
    const Rect box(150, 90, 120, 110);
    RNG rng(47);
    // Texture that the coarse layers see, too
    Mat texture = randomImage(rng, Size(2 * size.width, size.height), CV_8UC3, 128), coarse;
    cv::resize(randomImage(rng, Size(200, 75), CV_8UC3, 128), coarse, texture.size(), 0, 0, INTER_NEAREST);
    texture += coarse;
    const Mat wall = texture.colRange(0, size.width + back),
              inFront = texture.colRange(size.width + back, texture.cols);
    Mat left = wall.colRange(0, size.width).clone(), right = wall.colRange(back, size.width + back).clone();
    inFront(box).copyTo(left(box));
    inFront(box).copyTo(right(box - Point(front, 0)));

    Mat truth(size, CV_32F, Scalar(back)), mask(size, CV_8U, Scalar(255));
    truth(box).setTo(front);
    mask.colRange(0, back).setTo(0); // the right image does not have it
    mask(Rect(box.x - front + back - border, box.y - border, box.width + front - back + 2 * border,
              box.height + 2 * border))
        .setTo(0);
    mask(Rect(box.x + border, box.y + border, box.width - 2 * border, box.height - 2 * border)).setTo(255);
    const Ptr<HDPTreeMatcher> matcher = createSystem(GetParam().preset, 64);
    const Mat disparity = match(*matcher, left, right);
    // At half the resolution nothing is left of the finest texture, and both disparities are between two candidates.
    const bool isHalf = matcher->getParams().finestLayer == 1;
    EXPECT_LE(badPixels(disparity, truth, mask, 1), isHalf ? 2.5 : 0.2); // 0.06, 1.56, 0.05, 0.10
    EXPECT_LE(meanError(disparity, truth, mask), isHalf ? 0.5 : 0.05);   // 0.031, 0.399, 0.021, 0.025
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_Preset, testing::ValuesIn(measured));

//! Real truth: percent of the pixels of OpenCV's Aloe pair that are wrong by 2 and more, occluded ones included
TEST(HDPStereo_PresetsOnAloe, error)
{
    const Mat left = readSample("aloeL.jpg", IMREAD_COLOR), right = readSample("aloeR.jpg", IMREAD_COLOR);
    const Mat truth8 = readSample("aloeGT.png", IMREAD_GRAYSCALE), known = truth8 > 0;
    Mat truth;
    truth8.convertTo(truth, CV_32F);
    const std::pair<System, double> errors[] = {
        { presetFast, 8.265 }, { presetQuality, 8.109 }, { presetUltrafast, 8.708 }, { presetTree, 8.722 }
    };
    for (const auto& preset : errors)
        EXPECT_LE(badPixels(match(*createSystem(preset.first, 256), left, right), truth, known, 2),
                  margin * preset.second)
            << preset.first.name;
}

}} // namespace opencv_test
