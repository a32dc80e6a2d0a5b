// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/map/prior_join.hpp"

namespace opencv_test { namespace {

const float unknown = std::numeric_limits<float>::quiet_NaN();
const System presetsWithPrior[] = { presetFast, presetUltrafast, presetQuality, presetTree };

//! Some points of the truth, of which a share is off
Mat makePrior(RNG& rng, const Mat& truth, int count, double share, float off)
{
    Mat prior(truth.size(), CV_32F, Scalar(unknown));
    for (int i = 0; i < count; ++i)
    {
        const int y = rng.uniform(0, truth.rows), x = rng.uniform(0, truth.cols);
        prior.at<float>(y, x) = truth.at<float>(y, x) + (rng.uniform(0., 1.) < share ? off : 0);
    }
    return prior;
}

TEST(HDPStereo_SlowDisparityPrior, is_believed_as_far_as_the_images_do_not_contradict_it)
{
    const Mat all(Size(320, 200), CV_8U, Scalar(255));
    for (const System& preset : presetsWithPrior)
    {
        double none = 0, good = 0, some = 0, bad = 0, off = 0;
        const bool isHalf = createSystem(preset, 64)->getParams().finestLayer == 1;
        for (int seed = 1; seed <= 16; ++seed)
        {
            const SyntheticPair pair = makeSyntheticPair(all.size(), 64, seed);
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 64);
            const auto errors = [&] { return badPixels(match(*matcher, pair.left, pair.right), pair.truth, all, 2); };
            RNG rng(seed);
            none += errors();
            matcher->setPriorDisparity(makePrior(rng, pair.truth, 400, 0, 0), 0.5);
            good += errors();
            matcher->setPriorDisparity(makePrior(rng, pair.truth, 400, 0.1, 20), 0.5);
            some += errors();
            matcher->setPriorDisparity(makePrior(rng, pair.truth, 400, 1, 20), 0.5);
            bad += errors();
            Mat prior = makePrior(rng, pair.truth, 400, 0, 0), part = prior.colRange(0, 160);
            part += 12;
            matcher->setPriorDisparity(prior, 0.5);
            off += errors();
        }
        // 0.83 to 0.85, and 0.916 with ULTRAFAST, at half the resolution
        EXPECT_LT(good, (isHalf ? 0.92 : 0.9) * none) << preset.name;
        EXPECT_LT(some, none) << preset.name;
        EXPECT_LE(bad, 1.05 * none) << preset.name;
        EXPECT_LE(off, 1.05 * none) << preset.name << ", half of the image";
    }
}

//! Textured boxes before a wall at 6, with texture or without
SyntheticPair boxesBeforeWall(int seed, bool isBare)
{
    const Size size(320, 200);
    RNG rng(seed);
    const auto texture = [&](double contrast) {
        Mat image(size, CV_32F);
        rng.fill(image, RNG::NORMAL, 0, 1);
        cv::GaussianBlur(image, image, Size(), 1.5);
        return Mat(image * contrast + 120);
    };
    SyntheticPair pair;
    pair.left = texture(isBare ? 0 : 200);
    pair.right.create(size, CV_32F);
    pair.left.copyTo(pair.right);
    Mat shifted = pair.right.colRange(0, size.width - 6);
    pair.left.colRange(6, size.width).copyTo(shifted);
    pair.truth = Mat(size, CV_32F, Scalar(6));
    for (int i = 0; i < 3; ++i)
    {
        const Rect box(70 + 80 * i, rng.uniform(20, 100), rng.uniform(25, 50), rng.uniform(40, 80));
        const int disparity = rng.uniform(15, 35);
        const Mat front = texture(200)(box);
        front.copyTo(pair.left(box));
        front.copyTo(pair.right(box - Point(disparity, 0)));
        pair.truth(box).setTo(disparity);
    }
    for (Mat* image : { &pair.left, &pair.right })
    {
        Mat noise(size, CV_32F);
        rng.fill(noise, RNG::NORMAL, 0, 1.5);
        *image += noise;
        image->convertTo(*image, CV_8U);
    }
    return pair;
}

TEST(HDPStereo_SlowDisparityPrior, a_bare_wall)
{
    const Mat all(Size(320, 200), CV_8U, Scalar(255));
    for (const System& preset : presetsWithPrior)
    {
        double none = 0, sparse = 0, dense = 0;
        for (int seed = 1; seed <= 6; ++seed)
        {
            const SyntheticPair pair = boxesBeforeWall(seed, true);
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 48);
            const auto errors = [&] { return badPixels(match(*matcher, pair.left, pair.right), pair.truth, all, 1); };
            RNG rng(seed);
            none += errors();
            matcher->setPriorDisparity(makePrior(rng, pair.truth, 300, 0, 0), 0.1);
            sparse += errors();
            matcher->setPriorDisparity(pair.truth, 0.1);
            dense += errors();
        }
        EXPECT_LT(sparse, 0.15 * none) << preset.name;
        EXPECT_LT(dense, 0.15 * none) << preset.name;
    }
}

TEST(HDPStereo_SlowDisparityPrior, of_a_scene_to_which_boxes_were_added)
{
    const Mat all(Size(320, 200), CV_8U, Scalar(255));
    for (const System& preset : presetsWithPrior)
        for (const int points : { 500, 64000 })
        {
            double none = 0, old = 0;
            for (int seed = 1; seed <= 3; ++seed)
            {
                const SyntheticPair pair = boxesBeforeWall(seed, false);
                const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 48);
                RNG rng(seed);
                none += badPixels(match(*matcher, pair.left, pair.right), pair.truth, all, 1);
                matcher->setPriorDisparity(makePrior(rng, Mat(all.size(), CV_32F, Scalar(6)), points, 0, 0), 0.5);
                old += badPixels(match(*matcher, pair.left, pair.right), pair.truth, all, 1);
            }
            EXPECT_LE(old, 1.5 * none) << preset.name << ", " << points << " points";
        }
}

TEST(HDPStereo_DisparityPrior, nothing_known_changes_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    for (const System& preset : presetsWithPrior)
        for (int minDisparity : { 0, -9 })
        {
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 40, minDisparity);
            const Mat without = match(*matcher, pair.left, pair.right).clone();
            matcher->setPriorDisparity(Mat(pair.left.size(), CV_32F, Scalar(unknown)), 1);
            expectIdentical(without, match(*matcher, pair.left, pair.right));
            matcher->setPriorDisparity(Mat(pair.left.size(), CV_32F, Scalar(1000)), 1); // no candidate
            expectIdentical(without, match(*matcher, pair.left, pair.right));
            matcher->setPriorDisparity(pair.truth, Mat(pair.left.size(), CV_32F, Scalar(0.5)));
            match(*matcher, pair.left, pair.right);
            matcher->setPriorDisparity(noArray(), noArray());
            expectIdentical(without, match(*matcher, pair.left, pair.right));
        }
}

TEST(HDPStereo_DisparityPrior, bad_priors_change_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    const Ptr<HDPTreeMatcher> matcher = createSystem(presetFast, 40);
    matcher->setPriorDisparity(pair.truth, 0.5);
    const Mat expected = match(*matcher, pair.left, pair.right).clone();
    for (int type : { CV_8UC1, CV_16SC1, CV_32FC2, CV_64FC1 })
        expectRejected([&] { matcher->setPriorDisparity(Mat(pair.left.size(), type, Scalar::all(1)), 0.5); },
                       "disparity must be CV_32FC1");
    for (double bad : { -1., (double)unknown, std::numeric_limits<double>::infinity() })
        expectRejected([&] { matcher->setPriorDisparity(pair.truth, bad); }, "sigma must be finite and >= 0");
    expectRejected([&] { matcher->setPriorDisparity(pair.truth, noArray()); }, "sigma must be a number");
    expectRejected([&] { matcher->setPriorDisparity(pair.truth, pair.truth.colRange(1, 99)); }, "sigma must be a");
    expectIdentical(expected, match(*matcher, pair.left, pair.right));

    Mat disparity;
    matcher->setPriorDisparity(pair.truth.colRange(1, 100), 0.5);
    expectRejected([&] { matcher->compute(pair.left, pair.right, disparity); }, "the disparity of the prior must have");
    const Ptr<HDPTreeMatcher> paper = createSystem(presetPaper, 40);
    paper->setPriorDisparity(pair.truth, 0.5);
    expectRejected([&] { paper->compute(pair.left, pair.right, disparity); }, "COST_CENSUS for setPriorDisparity()");
    EXPECT_TRUE(disparity.empty());
}

TEST(HDPStereo_DisparityPrior, points_of_a_layer)
{
    Mat disparity(16, 24, CV_32F, Scalar(unknown)), sigma(16, 24, CV_32F, Scalar(2));
    std::vector<hdp::PriorPoint> points;
    disparity.at<float>(5, 9) = 14; // pixel (2, 1) of layer 2; with 8 more columns (4, 1)
    disparity.at<float>(6, 10) = 18;
    disparity.at<float>(7, 8) = 6;    // behind both
    disparity.at<float>(12, 2) = 100; // no candidate
    hdp::pointsOfLayer(disparity, sigma, -2, 8, 2, 12, points);
    ASSERT_EQ(1u, points.size());
    EXPECT_EQ(Point(4, 1), points[0].place);
    EXPECT_EQ((16 + 2) / 4.f, points[0].disparity);
    EXPECT_EQ(0.5f, points[0].sigma);
}

}} // namespace opencv_test
