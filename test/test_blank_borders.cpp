// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/pair/missing_pixels.hpp"

namespace opencv_test { namespace {

//! A pair without dark pixels, whose rectification left other wedges black in each image
struct RectifiedPair
{
    Mat left, right, leftMask, rightMask; // the masks: without the pixels at the ends of the wedges, too

    explicit RectifiedPair(int type, double brightness = 1, Size size = Size(240, 160))
    {
        const SyntheticPair scene = makeSyntheticPair(size, 40, 3);
        for (int side = 0; side < 2; ++side)
        {
            Mat& image = side ? right : left;
            image = ofType(side ? scene.right : scene.left, type);
            const double offset = image.depth() == CV_8U ? 60 : 240;
            image.convertTo(image, -1, brightness, offset * brightness);
            Mat blank(size, CV_8UC1, Scalar(0)), grown;
            for (int y = 0; y < size.height; ++y)
            {
                const int above = side ? 24 : 20, besides = 24 + (side ? (size.height - y) / 16 : y / 10);
                if (y < above)
                    blank.row(y).setTo(Scalar(255));
                blank.row(y).colRange(0, besides).setTo(Scalar(255));
                blank.row(y).colRange(size.width - besides, size.width).setTo(Scalar(255));
            }
            image.setTo(Scalar::all(0), blank);
            dilate(blank, grown, getStructuringElement(MORPH_CROSS, Size(3, 3)));
            (side ? rightMask : leftMask) = grown == 0;
        }
    }
};

TEST(HDPStereo_BlankBorders, have_no_data)
{
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 })
        for (double brightness : { 1., 0.3 })
        {
            SCOPED_TRACE(testing::Message() << "type " << type << ", brightness " << brightness);
            const RectifiedPair pair(type, brightness);
            hdp::CompletePair complete;
            hdp::completePair(pair.left, pair.right, Mat(), Mat(), PairModel(), complete);
            ASSERT_FALSE(complete.masks.isEmpty());
            expectIdentical(pair.leftMask, complete.masks.left);
            expectIdentical(pair.rightMask, complete.masks.right);
        }
}

//! Whether it is found or told, what is masked has the same map, confidence and reasons.
TEST(HDPStereo_BlankBorders, are_as_if_they_were_masked)
{
    const RectifiedPair pair(CV_8UC3);
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> found = createSystem(preset, 45), told = createSystem(preset, 45);
        told->setMasks(pair.leftMask, pair.rightMask);
        const Mat expected = match(*told, pair.left, pair.right).clone();
        expectIdentical(expected, match(*found, pair.left, pair.right));
        Mat confidence, expectedConfidence, reasons;
        found->getConfidence(confidence);
        told->getConfidence(expectedConfidence);
        expectIdentical(expectedConfidence, confidence);
        found->getReasons(reasons);
        expectIdentical(pair.leftMask == 0, reasons == HDPTreeMatcher::REASON_MASKED);
        EXPECT_EQ(0, told->getPairModel().borderLevel);

        const PairModel model = found->getPairModel();
        EXPECT_GE(model.borderLevel, 8);
        found->setPairModel(model);
        expectIdentical(expected, match(*found, pair.left, pair.right));
        found->setPairModel(PairModel());

        // Masks without a 0 turn it off.
        found->setMasks(Mat(pair.left.size(), CV_8UC1, Scalar(255)), Mat());
        match(*found, pair.left, pair.right);
        EXPECT_EQ(0, found->getPairModel().borderLevel);
        found->getReasons(reasons);
        EXPECT_EQ(0, countNonZero(reasons == HDPTreeMatcher::REASON_MASKED));
    }
}

TEST(HDPStereo_BlankBorders, survive_compression)
{
    const RectifiedPair pair(CV_8UC3);
    Mat images[2] = { pair.left, pair.right };
    for (Mat& image : images)
    {
        std::vector<uchar> file;
        cv::imencode(".jpg", image, file, { IMWRITE_JPEG_QUALITY, 90 });
        image = cv::imdecode(file, IMREAD_COLOR);
    }
    hdp::CompletePair complete;
    hdp::completePair(images[0], images[1], Mat(), Mat(), PairModel(), complete);
    ASSERT_FALSE(complete.masks.isEmpty());
    for (int side = 0; side < 2; ++side)
    {
        const Mat found = side ? complete.masks.right : complete.masks.left,
                  expected = side ? pair.rightMask : pair.leftMask;
        EXPECT_LE(countNonZero((found == 0) & (expected != 0)), 0.01 * (double)found.total()) << "data is lost";
        EXPECT_LE(countNonZero((found != 0) & (expected == 0)), 0.02 * (double)found.total()) << "borders are left";
    }
}

//! What is rectified to a larger view has bent sides: black between the corners, which show something.
TEST(HDPStereo_BlankBorders, of_bent_sides)
{
    const Size size(240, 160);
    for (int type : { CV_8UC1, CV_16UC1 })
    {
        SyntheticPair pair = makeSyntheticPair(size, 40, 5);
        Mat images[2] = { ofType(pair.left, type), ofType(pair.right, type) }, blank[2];
        for (int side = 0; side < 2; ++side)
        {
            images[side].convertTo(images[side], -1, 1, type == CV_8UC1 ? 60 : 240);
            blank[side] = Mat(size, CV_8UC1, Scalar(0));
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    const double u = (x - 119.5) / 120, v = (y - 79.5) / 80, bend = 0.08 + 0.02 * side;
                    const bool isShown =
                        std::abs(u) < 1 - bend * (1 - 1.2 * v * v) && std::abs(v) < 1 - bend * (1 - 1.2 * u * u);
                    blank[side].at<uchar>(y, x) = isShown ? 0 : 255;
                }
            images[side].setTo(Scalar::all(0), blank[side]);
        }
        hdp::PairMasks masks;
        ASSERT_GT(hdp::findBorders(images[0], images[1], masks), 0);
        for (int side = 0; side < 2; ++side)
        {
            const Mat found = (side ? masks.right : masks.left) == 0;
            Mat grown;
            dilate(blank[side], grown, getStructuringElement(MORPH_CROSS, Size(3, 3)));
            EXPECT_EQ(0, countNonZero(blank[side] & ~found)) << side;
            EXPECT_EQ(0, countNonZero(found & ~grown)) << side;
        }
    }
}

//! Scenes have dark places at their sides, too.
TEST(HDPStereo_BlankBorders, darkness_is_none)
{
    const auto hasBorders = [](const Mat& left, const Mat& right) {
        hdp::PairMasks masks;
        return hdp::findBorders(left, right, masks) > 0 || !masks.isEmpty();
    };
    const Size size(240, 160);
    const SyntheticPair scene = makeSyntheticPair(size, 40, 3);
    EXPECT_FALSE(hasBorders(scene.left, scene.right));
    const Mat nothing(size, CV_8UC1, Scalar(0));
    EXPECT_FALSE(hasBorders(nothing, nothing));

    Mat fading(size, CV_8UC1);
    for (int x = 0; x < size.width; ++x)
        fading.col(x).setTo(Scalar(std::max(x - 20, 0)));
    EXPECT_FALSE(hasBorders(fading, fading));

    RNG rng(3);
    Mat noisy(size, CV_8UC1);
    rng.fill(noisy, RNG::UNIFORM, 0, 8); // as cameras have it in the dark
    noisy.colRange(60, size.width) += Scalar(100);
    EXPECT_FALSE(hasBorders(noisy, noisy));

    const Mat bright = scene.left + Scalar::all(20);
    for (const Rect& spot :
         { Rect(0, 40, 10, 10), Rect(100, 40, 60, 60), Rect(0, 40, 30, 80) }) // small; inside; square
    {
        Mat image = bright.clone();
        image(spot).setTo(Scalar::all(0));
        EXPECT_FALSE(hasBorders(image, image));
    }

    // Along a whole side, with an outline that is sharp, but rough: leaves, things on a shelf
    for (int seed = 1; seed <= 8; ++seed)
    {
        RNG steps(seed);
        Mat image = bright.clone();
        for (int y = 0, length = 30; y < size.height; ++y)
        {
            length = std::min(std::max(length + steps.uniform(-4, 5), 10), 60);
            image.row(y).colRange(0, length).setTo(Scalar::all(0));
        }
        EXPECT_FALSE(hasBorders(image, image)) << seed;
    }
}

//! They begin at the sides of the whole, and may end beyond a tile.
TEST(HDPStereo_BlankBorders, of_a_tile_are_those_of_the_whole)
{
    const RectifiedPair pair(CV_8UC1);
    Mat left = pair.left.clone();
    left(Rect(96, 70, 20, 20)).setTo(Scalar(0)); // begins at a tile's side
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 40, HDPTreeMatcher::PRESET_FAST);
    match(*matcher, left, pair.right);
    const PairModel whole = matcher->getPairModel();
    for (const Rect& rect : { Rect(0, 0, 96, 96), Rect(96, 64, 144, 96), Rect(128, 0, 112, 64), Rect(64, 0, 64, 64) })
    {
        SCOPED_TRACE(rect);
        matcher->setPairModel(whole.tile(rect));
        match(*matcher, left(rect).clone(), pair.right(rect).clone());
        Mat reasons;
        matcher->getReasons(reasons);
        expectIdentical(pair.leftMask(rect) == 0, reasons == HDPTreeMatcher::REASON_MASKED);
    }
    // A tile that lies in a border as a whole
    matcher->setPairModel(whole.tile(Rect(64, 0, 32, 8)));
    Mat reasons;
    match(*matcher, left(Rect(64, 0, 32, 8)).clone(), pair.right(Rect(64, 0, 32, 8)).clone());
    matcher->getReasons(reasons);
    EXPECT_EQ(0, countNonZero(reasons != HDPTreeMatcher::REASON_MASKED));
}

}} // namespace opencv_test
