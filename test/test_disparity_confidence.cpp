// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/cost/census_cost.hpp"
#include "../src/paper/color_gradient_cost.hpp"
#include "../src/map/disparity_confidence.hpp"
#include "../src/base/units.hpp"
#include "../src/pair/image_levels.hpp"
#include "../src/pair/pair_pyramids.hpp"

namespace opencv_test { namespace {

////////////////////////////////////////////// the stage //////////////////////////////////////////////

const hdp::ColorGradientParams colorGradient = { 10, 2, 0.11f, 1 };

//! A map that no median has changed, without a layer above
hdp::ConfidenceMaps mapAlone(const Mat& disparity)
{
    const hdp::ConfidenceMaps maps = { disparity, disparity, Mat() };
    return maps;
}

//! The confidence of a map of a pair of grey images
Mat confidenceOf(const Mat& left, const Mat& right, const hdp::ConfidenceMaps& maps, int numDisparities, bool isCensus,
                 int blockSize = 7)
{
    Mat confidence;
    if (isCensus)
    {
        Mat leftGrey, rightGrey;
        hdp::greyLevels(left, hdp::LevelScale(), leftGrey);
        hdp::greyLevels(right, hdp::LevelScale(), rightGrey);
        hdp::CensusCost cost;
        cost.prepare(leftGrey, rightGrey, numDisparities, blockSize);
        hdp::disparityConfidence(maps, numDisparities, cost, confidence);
    }
    else
    {
        hdp::ColorGradientCost cost;
        cost.prepare(left, right, numDisparities, colorGradient);
        hdp::disparityConfidence(maps, numDisparities, cost, confidence);
    }
    return confidence;
}

//! The confidence of every n-th pixel is that of its definition.
template <typename Formula>
void expectDefinition(const hdp::ConfidenceMaps& maps, int numDisparities, const Formula& cost, const Mat& confidence,
                      int n)
{
    const Mat& disparity = maps.disparity;
    ASSERT_EQ(CV_8UC1, confidence.type());
    ASSERT_EQ(disparity.size(), confidence.size());
    for (int i = 0; i < disparity.size().area(); i += n)
    {
        const int x = i % disparity.cols, y = i / disparity.cols;
        const double expected = oracle::confidence(maps, numDisparities, cost, y, x);
        ASSERT_NEAR(expected, confidence.at<uchar>(y, x), 0.501) << "at " << x << ", " << y;
    }
}

void expectDefinitionForPatches(RNG& rng, const Size& size, int numDisparities, bool isCensus, int blockSize = 7)
{
    SCOPED_TRACE(testing::Message() << "census " << isCensus << ", " << blockSize << ", " << size << ", "
                                    << numDisparities << " disparities");
    const Mat right = patchyImage(rng, size, CV_8UC1);
    Mat left, disparity;
    cv::add(right, randomImage(rng, size, CV_8UC1, 10), left);
    // Blocks of disparities that differ within themselves by less than a pixel
    patchyImage(rng, size, CV_8UC1, 12).convertTo(disparity, CV_16U, (numDisparities - 1) * hdp::subpixelScale / 255.);
    // Both agree with the map in most places
    Mat unfiltered = disparity.clone(), upper;
    resize(disparity, upper, Size(std::max(size.width / 2, 1), std::max(size.height / 2, 1)), 0, 0, INTER_NEAREST);
    upper /= 2;
    for (int i = 0; i < size.area() / 8; ++i)
    {
        unfiltered.at<ushort>(rng.uniform(0, size.height), rng.uniform(0, size.width)) = (ushort)rng.uniform(0, 200);
        upper.at<ushort>(rng.uniform(0, upper.rows), rng.uniform(0, upper.cols)) = (ushort)rng.uniform(0, 200);
    }
    const hdp::ConfidenceMaps maps = { disparity, unfiltered, blockSize == 7 ? upper : Mat() };
    const Mat confidence = confidenceOf(left, right, maps, numDisparities, isCensus, blockSize);
    const int n = size.area() > 1000 ? 29 : 1; // the definition is slow
    if (isCensus)
    {
        const oracle::CensusCost cost(oracle::greyLevels(left), oracle::greyLevels(right), blockSize);
        return expectDefinition(maps, numDisparities, cost, confidence, n);
    }
    const oracle::ColorGradientCost cost(left, right, colorGradient);
    const auto rounded = [&](int y, int x, int candidate) { return cvRound(512 * cost(y, x, candidate)) / 512.; };
    expectDefinition(maps, numDisparities, rounded, confidence, n);
}

TEST(HDPStereo_DisparityConfidence, by_its_definition)
{
    RNG rng(41);
    for (bool isCensus : { true, false })
        for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(43, 31), Size(5, 300), Size(150, 20) })
            for (int numDisparities : { 1, 2, 3, 12 })
                expectDefinitionForPatches(rng, size, numDisparities, isCensus);
    for (int blockSize : { 3, 5 })
        expectDefinitionForPatches(rng, Size(43, 31), 12, true, blockSize);
}

//! Few steps: the distances to them go as far as they count, and farther.
TEST(HDPStereo_DisparityConfidence, far_from_steps)
{
    RNG rng(46);
    const Size size(201, 163);
    const int numDisparities = 8;
    const Mat image = randomImage(rng, size, CV_8UC1);
    const oracle::CensusCost cost(oracle::greyLevels(image), oracle::greyLevels(image), 7);
    for (const std::vector<Point>& spots :
         { std::vector<Point>(), { Point(100, 80) }, { Point(0, 0) }, { Point(30, 150), Point(200, 90) } })
    {
        Mat disparity(size, CV_16U, Scalar(0));
        for (const Point& spot : spots)
            disparity.at<ushort>(spot) = (numDisparities - 1) * hdp::subpixelScale;
        const hdp::ConfidenceMaps maps = mapAlone(disparity);
        expectDefinition(maps, numDisparities, cost, confidenceOf(image, image, maps, numDisparities, true), 211);
    }
}

//! A pair of a textured plane in front of nothing, with some noise, and its confidence for a map
struct TexturedPlane
{
    enum
    {
        numDisparities = 16,
        disparity = 6
    };
    Mat left, right;
    bool isCensus;

    explicit TexturedPlane(bool census) : isCensus(census)
    {
        RNG rng(42);
        const Mat texture = randomImage(rng, Size(200, 120), CV_8UC1, 200);
        left = texture(Rect(0, 0, 180, 120)).clone();
        right = texture(Rect(disparity, 0, 180, 120)).clone();
        left += randomImage(rng, left.size(), CV_8UC1, 8);
        right += randomImage(rng, right.size(), CV_8UC1, 8);
    }

    Mat map() const { return Mat(left.size(), CV_16U, Scalar(16 * disparity)); }

    Mat confidence(const hdp::ConfidenceMaps& maps) const
    {
        return confidenceOf(left, right, maps, numDisparities, isCensus);
    }
    Mat confidence(const Mat& map) const { return confidence(mapAlone(map)); }
};

TEST(HDPStereo_DisparityConfidence, texture)
{
    for (bool isCensus : { true, false })
    {
        TexturedPlane plane(isCensus);
        RNG rng(43);
        for (Mat* image : { &plane.left, &plane.right }) // noise alone
            Mat(randomImage(rng, Size(90, 120), CV_8UC1, 8) + 100).copyTo(image->colRange(90, 180));
        const Mat confidence = plane.confidence(plane.map());
        const double textured = cv::mean(confidence.colRange(25, 65))[0],
                     plain = cv::mean(confidence.colRange(115, 155))[0];
        EXPECT_GT(textured, 2 * plain) << "census " << isCensus;
    }
}

TEST(HDPStereo_DisparityConfidence, mismatch)
{
    for (bool isCensus : { true, false })
    {
        const TexturedPlane plane(isCensus);
        Mat wrong = plane.map();
        const Rect patch(60, 30, 60, 60), inside(75, 45, 30, 30);
        wrong(patch).setTo(Scalar(16 * (TexturedPlane::disparity + 4)));
        const double correct = cv::mean(plane.confidence(plane.map())(inside))[0];
        EXPECT_GT(correct, 3 * cv::mean(plane.confidence(wrong)(inside))[0]) << "census " << isCensus;
    }
}

TEST(HDPStereo_DisparityConfidence, steps)
{
    const TexturedPlane plane(true);
    Mat map = plane.map();
    map.rowRange(0, 40) += 24; // 1.5 pixels are none
    expectIdentical(Mat(1, 180, CV_8U, Scalar(0)), Mat(plane.confidence(map).row(39) == 0));
    map.rowRange(0, 40) += 1;
    const Mat confidence = plane.confidence(map);
    EXPECT_EQ(0, cv::countNonZero(confidence.rowRange(39, 41)));
    double last = 0;
    for (int y = 41; y < 110; y += 10) // away from the step
    {
        const double now = cv::mean(confidence(Range(y, y + 10), Range(60, 120)))[0];
        EXPECT_GT(now, last);
        last = now;
    }
}

//! The pixels beside a nearer surface that it hides from the right image, and as many on its other side that it does not
TEST(HDPStereo_DisparityConfidence, hidden_pixels)
{
    const TexturedPlane plane(true);
    Mat map = plane.map(), mirrored = plane.map();
    const int nearer = 16 * (TexturedPlane::disparity + 8);
    map.colRange(80, 180).setTo(Scalar(nearer));    // maps to columns from 66 on, the pixels 72..79 to 66..73
    mirrored.colRange(0, 64).setTo(Scalar(nearer)); // hides none of the pixels behind it
    const Range rows(30, 90);
    const double hidden = cv::mean(plane.confidence(map)(rows, Range(72, 79)))[0];
    const double visible = cv::mean(plane.confidence(mirrored)(rows, Range(65, 72)))[0];
    EXPECT_GT(visible, 1.5 * hidden);
    EXPECT_GT(hidden, 0);

    // Those whose match is outside of the right image
    const Mat confidence = plane.confidence(plane.map());
    EXPECT_GT(cv::mean(confidence.colRange(6, 10))[0], 1.5 * cv::mean(confidence.colRange(2, 6))[0]);
}

//! A surface without data hides no pixel beside it, whatever its disparity is.
TEST(HDPStereo_DisparityConfidence, pixels_without_data_hide_none)
{
    const TexturedPlane plane(true);
    const int numDisparities = TexturedPlane::numDisparities;
    const Mat all(plane.left.size(), CV_8U, Scalar(255));
    const hdp::PairMasks masks = { all.clone(), all };
    masks.left.colRange(80, 180).setTo(Scalar(0));
    Mat leftGrey, rightGrey, confidence[2];
    hdp::greyLevels(plane.left, hdp::LevelScale(), leftGrey);
    hdp::greyLevels(plane.right, hdp::LevelScale(), rightGrey);
    hdp::CensusCost cost;
    cost.prepare(leftGrey, rightGrey, numDisparities, 7, 0, masks);
    for (const bool isNearer : { false, true })
    {
        Mat map = plane.map();
        map.colRange(80, 180).setTo(Scalar(16 * (isNearer ? numDisparities - 1 : 1)));
        hdp::disparityConfidence(mapAlone(map), numDisparities, cost, confidence[isNearer]);
    }
    EXPECT_GT(cv::countNonZero(confidence[0].colRange(70, 79)), 500) << "maps without any are equal, too";
    expectIdentical(confidence[0].colRange(0, 80), confidence[1].colRange(0, 80));
}

//! Where the layer above had another disparity, and where the median had to change many
TEST(HDPStereo_DisparityConfidence, other_maps)
{
    const TexturedPlane plane(true);
    const Rect patch(60, 20, 80, 80), inside(80, 40, 40, 40);
    const double alone = cv::mean(plane.confidence(plane.map())(inside))[0];
    hdp::ConfidenceMaps maps = { plane.map(), plane.map(), Mat(60, 90, CV_16U, Scalar(8 * TexturedPlane::disparity)) };
    EXPECT_EQ(alone, cv::mean(plane.confidence(maps)(inside))[0]);
    maps.upper(Rect(30, 10, 40, 40)) += 16;
    EXPECT_GT(alone, 2 * cv::mean(plane.confidence(maps)(inside))[0]);
    maps = mapAlone(plane.map());
    maps.unfiltered = plane.map();
    for (int y = patch.y; y < patch.y + patch.height; y += 2)
        maps.unfiltered.row(y).colRange(patch.x, patch.x + patch.width) += 32;
    EXPECT_GT(alone, 2 * cv::mean(plane.confidence(maps)(inside))[0]);
}

TEST(HDPStereo_DisparityConfidence, any_number_of_threads)
{
    const int threads = cv::getNumThreads();
    RNG rng(44);
    const Mat left = patchyImage(rng, Size(90, 500), CV_8UC1);
    Mat disparity, right;
    cv::add(left, randomImage(rng, left.size(), CV_8UC1, 10), right);
    patchyImage(rng, left.size(), CV_8UC1, 40).convertTo(disparity, CV_16U, 0.5);
    for (bool isCensus : { true, false })
    {
        Mat expected;
        for (int n : { 1, 2, 8 })
        {
            cv::setNumThreads(n);
            const Mat confidence = confidenceOf(left, right, mapAlone(disparity), 9, isCensus);
            cv::setNumThreads(threads);
            if (expected.empty())
                expected = confidence;
            EXPECT_GT(cv::countNonZero(confidence), 1000);
            expectIdentical(expected, confidence);
        }
    }
}

////////////////////////////////////////////// the matcher //////////////////////////////////////////////

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(301, 181), 48, 9);
    return pair;
}

Mat confidenceOf(const HDPTreeMatcher& matcher)
{
    Mat confidence;
    matcher.getConfidence(confidence);
    return confidence;
}

//! Percentages of the pixels whose disparities are wrong by 2 or more: of all, and of the more confident half
void badOfAllAndOfBetterHalf(const Mat& disparity, const Mat& confidence, const SyntheticPair& pair, double& all,
                             double& better)
{
    std::vector<std::pair<int, bool>> pixels; // less confidence, whether it is bad: so bad ones come last among equals
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const double error = disparity.at<short>(y, x) / 16. - pair.truth.at<float>(y, x);
            pixels.push_back(std::make_pair(255 - confidence.at<uchar>(y, x), std::abs(error) >= 2));
        }
    std::sort(pixels.begin(), pixels.end());
    const auto percentage = [&](size_t count) {
        const auto isBad = [](const std::pair<int, bool>& pixel) { return pixel.second; };
        return 100. * (double)std::count_if(pixels.begin(), pixels.begin() + (ptrdiff_t)count, isBad) / (double)count;
    };
    all = percentage(pixels.size());
    better = percentage(pixels.size() / 2);
}

TEST(HDPStereo_DisparityConfidence, better_half_has_a_third_of_the_errors)
{
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
        const Mat disparity = match(*matcher, testPair().left, testPair().right);
        double all, better;
        badOfAllAndOfBetterHalf(disparity, confidenceOf(*matcher), testPair(), all, better);
        EXPECT_GT(all, 1);
        EXPECT_LT(3 * better, all);
    }
}

TEST(HDPStereo_DisparityConfidence, of_the_last_pair)
{
    const Mat left = testPair().left, right = testPair().right;
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
        EXPECT_TRUE(confidenceOf(*matcher).empty());
        const Mat disparity = match(*matcher, left, right);
        const Mat confidence = confidenceOf(*matcher);
        ASSERT_EQ(CV_8UC1, confidence.type());
        ASSERT_EQ(left.size(), confidence.size());
        EXPECT_GT(cv::countNonZero(confidence), left.size().area() / 2);

        expectIdentical(confidence, confidenceOf(*matcher));
        matcher->setNumDisparities(3); // for the next pair
        matcher->setMinDisparity(5);
        change(*matcher, [&](Params& p) { p.useSubpixel = !p.useSubpixel; });
        matcher->setDisp12MaxDiff(1);
        expectIdentical(confidence, confidenceOf(*matcher));
        const Mat smaller = match(*matcher, left.rowRange(0, 90).clone(), right.rowRange(0, 90).clone());
        EXPECT_EQ(smaller.size(), confidenceOf(*matcher).size());

        matcher->setNumDisparities(48);
        matcher->setMinDisparity(0);
        change(*matcher, [&](Params& p) { p.useSubpixel = !p.useSubpixel; });
        matcher->setDisp12MaxDiff(-1);
        expectIdentical(disparity, match(*matcher, left, right)); // asking for the confidence has changed nothing
        expectIdentical(confidence, confidenceOf(*matcher));
    }
}

TEST(HDPStereo_DisparityConfidence, none_after_an_exception)
{
    const Mat left = testPair().left, right = testPair().right;
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    Mat disparity, confidence = match(*matcher, left, right).clone();
    EXPECT_FALSE(confidenceOf(*matcher).empty());
    EXPECT_THROW(matcher->compute(left, right.colRange(1, 100), disparity), cv::Exception);
    matcher->getConfidence(confidence);
    EXPECT_TRUE(confidence.empty());
    match(*matcher, left, right);
    EXPECT_FALSE(confidenceOf(*matcher).empty());
}

TEST(HDPStereo_DisparityConfidence, invalid_pixels_have_none)
{
    for (const System& system : { presetFast, presetUltrafast, presetPaper })
        for (int depth : { CV_16S, CV_32F })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", depth " << depth);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
            match(*matcher, testPair().left, testPair().right);
            Mat expected = confidenceOf(*matcher);
            matcher->setDisp12MaxDiff(1);
            matcher->setSpeckleWindowSize(200);
            matcher->setSpeckleRange(1);
            matcher->setDisparityDepth(depth);
            const Mat disparity = match(*matcher, testPair().left, testPair().right), invalid = disparity < 0;
            EXPECT_GT(cv::countNonZero(invalid), 0);
            EXPECT_GT(cv::countNonZero(expected & invalid), 0);
            expected.setTo(Scalar(0), invalid);
            expectIdentical(expected, confidenceOf(*matcher));
        }
}

TEST(HDPStereo_DisparityConfidence, minDisparity_does_not_matter)
{
    const int shift = 7;
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(shift, 48 - shift);
    match(*matcher, testPair().left, testPair().right);
    // Where the left pixels have matches inside, these are the same ones as of a right image moved by minDisparity.
    Mat memory;
    const Mat moved = hdp::shiftColumns(testPair().right, shift, 0, memory);
    const Ptr<HDPTreeMatcher> fromZero = HDPTreeMatcher::create(0, 48 - shift);
    match(*fromZero, testPair().left, moved);
    expectIdentical(confidenceOf(*fromZero), confidenceOf(*matcher));
}

TEST(HDPStereo_DisparityConfidence, kinds_of_arrays)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    const Mat fixed(testPair().left.size(), CV_8U);
    expectRejected([&] { matcher->getConfidence(fixed); }, "confidence must not have a fixed size");
    match(*matcher, testPair().left, testPair().right);
    const Mat expected = confidenceOf(*matcher);
    Mat_<uchar> typed;
    matcher->getConfidence(typed);
    expectIdentical(expected, typed);
    UMat device;
    matcher->getConfidence(device);
    expectIdentical(expected, device.getMat(ACCESS_READ));
    Mat_<float> other;
    EXPECT_THROW(matcher->getConfidence(other), cv::Exception);
}

TEST(HDPStereo_DisparityConfidence, images_of_any_size)
{
    RNG rng(45);
    for (const System& system : presets)
        for (const Size& size : { Size(1, 1), Size(2, 3), Size(1, 40), Size(40, 1), Size(63, 5), Size(7, 66) })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", " << size);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 20, system.preset);
            match(*matcher, randomImage(rng, size, CV_8UC3), randomImage(rng, size, CV_8UC3));
            EXPECT_EQ(size, confidenceOf(*matcher).size());
        }
}

}} // namespace opencv_test
