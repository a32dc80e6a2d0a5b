// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "matching_costs.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/cost/census_cost.hpp"
#include "../src/pair/missing_pixels.hpp"

namespace opencv_test { namespace {

const float notANumber = std::numeric_limits<float>::quiet_NaN();

//! A pair and its masks: rows and columns without data, a disc, and single pixels
struct MaskedPair
{
    SyntheticPair scene;
    Mat left, right, leftMask, rightMask;

    explicit MaskedPair(int type, Size size = Size(200, 120), int numDisparities = 40)
        : scene(makeSyntheticPair(size, numDisparities, 3)), leftMask(size, CV_8UC1, Scalar(255)),
          rightMask(size, CV_8UC1, Scalar(7)) // any but 0
    {
        left = ofType(scene.left, type);
        right = ofType(scene.right, type);
        leftMask.rowRange(size.height - 20, size.height).setTo(0);
        rightMask.rowRange(size.height - 17, size.height).setTo(0);
        leftMask.colRange(0, 9).setTo(0);
        rightMask.colRange(0, 14).setTo(0);
        cv::circle(leftMask, Point(100, 60), 15, Scalar(0), -1);
        cv::circle(rightMask, Point(60, 50), 12, Scalar(0), -1);
        RNG rng(11);
        for (int i = 0; i < 100; ++i)
            for (Mat* mask : { &leftMask, &rightMask })
            {
                const int y = rng.uniform(0, size.height), x = rng.uniform(0, size.width);
                mask->at<uchar>(y, x) = 0;
            }
    }

    //! Other levels, brighter than any of the pair's, where there is no data
    void overwrite(RNG& rng)
    {
        for (int side = 0; side < 2; ++side)
        {
            Mat& image = side ? right : left;
            Mat noise(image.size(), image.type());
            rng.fill(noise, RNG::UNIFORM, 0, image.depth() == CV_8U ? 256 : 65536);
            if (image.depth() == CV_32F)
                noise.setTo(std::numeric_limits<float>::infinity(), noise < 3000);
            noise.copyTo(image, (side ? rightMask : leftMask) == 0);
        }
    }

    void set(HDPTreeMatcher& matcher) const { matcher.setMasks(leftMask, rightMask); }
};

Mat confidenceOf(const HDPTreeMatcher& matcher)
{
    Mat confidence;
    matcher.getConfidence(confidence);
    return confidence;
}

std::vector<double> findingsOf(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    std::vector<double> values = findings.rows;
    values.insert(values.end(), findings.light.begin(), findings.light.end());
    values.push_back(findings.noise);
    return values;
}

const int types[] = { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_32FC1 };

TEST(HDPStereo_Masks, levels_without_data_have_no_influence)
{
    for (const System& preset : presets)
        for (int type : types)
            for (int minDisparity : { 0, -13, 5 })
            {
                if (minDisparity != 0 && type != CV_8UC1)
                    continue; // the types share what knows of a range
                SCOPED_TRACE(testing::Message() << preset.name << ", type " << type << ", from " << minDisparity);
                RNG rng(5);
                MaskedPair pair(type);
                const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45, minDisparity);
                pair.set(*matcher);
                pair.overwrite(rng);
                const Mat first = match(*matcher, pair.left, pair.right).clone();
                const Mat confidence = confidenceOf(*matcher);
                const std::vector<double> findings = findingsOf(*matcher);
                pair.overwrite(rng);
                expectIdentical(first, match(*matcher, pair.left, pair.right));
                expectIdentical(confidence, confidenceOf(*matcher));
                EXPECT_EQ(findings, findingsOf(*matcher));
            }
}

TEST(HDPStereo_Masks, levels_without_data_have_no_influence_on_filters_and_videos)
{
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        RNG rng(6);
        const Ptr<HDPTreeMatcher> a = createSystem(preset, 45), b = createSystem(preset, 45);
        for (const Ptr<HDPTreeMatcher>& matcher : { a, b })
        {
            matcher->setDisp12MaxDiff(1);
            matcher->setSpeckleWindowSize(30);
            matcher->setSpeckleRange(1);
            matcher->setDisparityDepth(CV_32F);
            matcher->setUseTemporalPrediction(preset.preset != HDPTreeMatcher::PRESET_PAPER);
        }
        MaskedPair pair(CV_8UC3);
        pair.set(*a);
        pair.set(*b);
        for (int frame = 0; frame < 3; ++frame)
        {
            pair.overwrite(rng);
            const Mat first = match(*a, pair.left, pair.right).clone(), confidence = confidenceOf(*a);
            pair.overwrite(rng);
            expectIdentical(first, match(*b, pair.left, pair.right));
            expectIdentical(confidence, confidenceOf(*b));
        }
    }
}

TEST(HDPStereo_Masks, pixels_without_data_have_no_disparity_and_no_confidence)
{
    const MaskedPair pair(CV_8UC3);
    for (const System& preset : presets)
        for (int depth : { CV_16S, CV_32F })
        {
            SCOPED_TRACE(testing::Message() << preset.name << ", depth " << depth);
            const int minDisparity = -5;
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45, minDisparity);
            matcher->setDisparityDepth(depth);
            pair.set(*matcher);
            Mat disparity = match(*matcher, pair.left, pair.right), none = pair.leftMask == 0;
            expectIdentical(none, disparity == (depth == CV_16S ? (minDisparity - 1) * 16 : minDisparity - 1));
            expectIdentical(none, disparity < minDisparity * (depth == CV_16S ? 16 : 1));
            EXPECT_EQ(0, cv::countNonZero(confidenceOf(*matcher) & none));
        }
}

TEST(HDPStereo_Masks, stay_until_others_are_set)
{
    MaskedPair pair(CV_8UC3);
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45);
        const Mat without = match(*matcher, pair.left, pair.right).clone();
        Mat own = pair.leftMask.clone();
        matcher->setMasks(own, pair.rightMask);
        own.setTo(0); // it was copied
        const Mat with = match(*matcher, pair.left, pair.right).clone();
        EXPECT_NE(0, countDifferent(without, with));
        expectIdentical(with, match(*matcher, pair.left, pair.right));
        matcher->setMasks(Mat(pair.left.size(), CV_8UC1, Scalar(1)), noArray()); // all have data
        expectIdentical(without, match(*matcher, pair.left, pair.right));
        pair.set(*matcher);
        matcher->setMasks(noArray(), noArray());
        expectIdentical(without, match(*matcher, pair.left, pair.right));
        for (const Mat& all : { pair.leftMask, pair.rightMask }) // alone
        {
            matcher->setMasks(&all == &pair.leftMask ? all : Mat(), &all == &pair.leftMask ? Mat() : all);
            EXPECT_NO_THROW(match(*matcher, pair.left, pair.right));
        }
    }
}

TEST(HDPStereo_Masks, nothing_has_data)
{
    const MaskedPair pair(CV_16UC1);
    const Mat none(pair.left.size(), CV_8UC1, Scalar(0));
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45);
        matcher->setMasks(none, none);
        EXPECT_EQ(0, cv::countNonZero(match(*matcher, pair.left, pair.right) != -16)) << preset.name;
        EXPECT_NO_THROW(createSystem(preset, 45)->setPairModel(matcher->getPairModel())) << preset.name;
        matcher->setMasks(noArray(), none);
        EXPECT_EQ(0, cv::countNonZero(match(*matcher, pair.left, pair.right) < 0)) << preset.name;
        const Mat nan(pair.left.size(), CV_32FC1, Scalar(notANumber));
        matcher->setMasks(noArray(), noArray());
        EXPECT_EQ(0, cv::countNonZero(match(*matcher, nan, nan) != -16)) << preset.name;
    }
}

//! Beside masks maps are nearly as good as without them, where both images have data.
TEST(HDPStereo_SlowMasks, surfaces_go_on_beside_masks)
{
    Mat leftMask(160, 240, CV_8UC1, Scalar(255));
    cv::circle(leftMask, Point(140, 60), 25, Scalar(0), -1); // the same place in both, as what the cameras carry
    leftMask.rowRange(130, 160).setTo(0);
    const Mat rightMask = leftMask.clone();
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 40);
        double whole = 0, without = 0, masked = 0;
        const int pairs = 4;
        for (int i = 0; i < pairs; ++i)
        {
            const SyntheticPair pair = makeSlantedPlane(leftMask.size(), 40, 8 + i);
            Mat left = pair.left.clone(), right = pair.right.clone();
            RNG rng(3 + i);
            randomImage(rng, left.size(), left.type()).copyTo(left, leftMask == 0);
            randomImage(rng, left.size(), left.type()).copyTo(right, rightMask == 0);
            const Mat counts = leftMask & pair.visible;
            matcher->setMasks(noArray(), noArray());
            whole += badPixels(match(*matcher, pair.left, pair.right), pair.truth, counts, 1) / pairs;
            without += badPixels(match(*matcher, left, right), pair.truth, counts, 1) / pairs;
            matcher->setMasks(leftMask, rightMask);
            masked += badPixels(match(*matcher, left, right), pair.truth, counts, 1) / pairs;
        }
        const double few = 0.2; // percent: of so few pixels it is luck
        EXPECT_LE(masked, whole + few + 0.5 * std::max(without - whole, 0.))
            << preset.name << ", whole " << whole << " %";
    }
}

TEST(HDPStereo_Masks, bad_masks_change_nothing)
{
    const MaskedPair pair(CV_8UC3);
    const Mat good = pair.leftMask;
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45);
        pair.set(*matcher);
        const Mat expected = match(*matcher, pair.left, pair.right).clone();
        for (int type : { CV_8UC3, CV_8SC1, CV_16UC1, CV_32FC1 })
        {
            const Mat bad(pair.left.size(), type, Scalar::all(1));
            expectRejected([&] { matcher->setMasks(bad, good); }, "leftMask must be CV_8UC1");
            expectRejected([&] { matcher->setMasks(noArray(), bad); }, "rightMask must be CV_8UC1");
        }
        expectIdentical(expected, match(*matcher, pair.left, pair.right));

        Mat disparity;
        matcher->setMasks(good.colRange(1, good.cols), noArray());
        expectRejected([&] { matcher->compute(pair.left, pair.right, disparity); }, "leftMask must have the size");
        matcher->setMasks(noArray(), good.rowRange(1, good.rows));
        expectRejected([&] { matcher->compute(pair.left, pair.right, disparity); }, "rightMask must have the size");
        EXPECT_TRUE(disparity.empty());
        pair.set(*matcher);
        expectIdentical(expected, match(*matcher, pair.left, pair.right));
    }
}

TEST(HDPStereo_Masks, floats_are_levels_of_16_bits)
{
    const MaskedPair pair(CV_16UC1);
    Mat floats[2];
    const Mat images[2] = { pair.left, pair.right };
    for (int i = 0; i < 2; ++i)
        images[i].convertTo(floats[i], CV_32F, 1. / 256, -7);
    hdp::CompletePair whole;
    hdp::completePair(floats[0], floats[1], Mat(), Mat(), PairModel(), whole);
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45);
        const Mat expected = match(*matcher, whole.left, whole.right).clone();
        expectIdentical(expected, match(*matcher, floats[0], floats[1]));
        Mat byNumbers[2] = { floats[0].clone(), floats[1].clone() };
        byNumbers[0].setTo(notANumber, pair.leftMask == 0);
        byNumbers[1].setTo(-std::numeric_limits<float>::infinity(), pair.rightMask == 0);
        const Mat masked = match(*matcher, byNumbers[0], byNumbers[1]).clone();
        pair.set(*matcher);
        expectIdentical(masked, match(*matcher, floats[0], floats[1]));
    }
}

TEST(HDPStereo_Masks, scale_of_floats)
{
    RNG rng(9);
    for (int round = 0; round < 20; ++round)
    {
        const Size size(rng.uniform(1, 90), rng.uniform(1, 90));
        Mat images[2];
        std::vector<float> values;
        const hdp::PairMasks masks = { randomImage(rng, size, CV_8UC1, 2) * 255,
                                       randomImage(rng, size, CV_8UC1, 2) * 255 };
        for (int i = 0; i < 2; ++i)
        {
            images[i].create(size, CV_32F);
            rng.fill(images[i], RNG::NORMAL, round, 1 + round * round);
            for (int k = 0; k < size.area(); ++k)
                if ((i ? masks.right : masks.left).ptr(k / size.width)[k % size.width])
                    values.push_back(images[i].ptr<float>(k / size.width)[k % size.width]);
        }
        hdp::CompletePair whole;
        hdp::completePair(images[0], images[1], masks.left, masks.right, PairModel(), whole);
        std::sort(values.begin(), values.end());
        const size_t outliers = values.size() / 1024;
        for (int i = 0; i < 2 && !values.empty(); ++i)
            for (int k = 0; k < size.area(); ++k)
            {
                const int x = k % size.width, y = k / size.width;
                if (!(i ? masks.right : masks.left).ptr(y)[x])
                    continue;
                const double low = values[outliers], high = values[values.size() - 1 - outliers];
                const double share = (images[i].ptr<float>(y)[x] - low) / (high - low);
                ASSERT_NEAR(high > low ? 65535 * std::min(std::max(share, 0.), 1.) : 0,
                            (i ? whole.right : whole.left).ptr<ushort>(y)[x], 0.501);
            }
    }
}

//! The documentation of completePair(), pixel by pixel
TEST(HDPStereo_Masks, missing_pixels_get_the_nearest_ones_of_their_row)
{
    RNG rng(10);
    for (int round = 0; round < 60; ++round)
    {
        const Size size(rng.uniform(1, 30), rng.uniform(1, 12));
        const Mat image = randomImage(rng, size, round % 3 == 0 ? CV_8UC3 : round % 3 == 1 ? CV_16UC1 : CV_8UC1);
        Mat mask = (randomImage(rng, size, CV_8UC1, 9) < rng.uniform(0, 9));
        for (int y = 0; y < size.height; ++y)
            if (rng.uniform(0, 3) == 0)
                mask.row(y).setTo(0);
        hdp::CompletePair complete;
        hdp::completePair(image, image, mask, mask, PairModel(), complete);
        const auto rowHas = [&](int y) { return y >= 0 && y < size.height && cv::countNonZero(mask.row(y)) > 0; };
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                int row = -1, column = -1;
                for (int d = 0; d < size.height && row < 0; ++d)
                    row = rowHas(y - d) ? y - d : rowHas(y + d) ? y + d : -1;
                for (int d = 0; row >= 0 && column < 0; ++d)
                    for (int side : { x - d, x + d })
                        if (column < 0 && side >= 0 && side < size.width && mask.at<uchar>(row, side))
                            column = side;
                const Mat expected = row < 0 ? Mat::zeros(1, 1, image.type()) : image(Rect(column, row, 1, 1)).clone();
                expectIdentical(expected, complete.left(Rect(x, y, 1, 1)).clone());
            }
    }
}

TEST(HDPStereo_Masks, costs_of_pixels_without_data)
{
    RNG rng(12);
    const Size size(50, 20);
    const int numDisparities = 70;
    const Mat left = randomImage(rng, size, CV_16UC1, 1021), right = randomImage(rng, size, CV_16UC1, 1021);
    const hdp::PairMasks masks = { randomImage(rng, size, CV_8UC1), randomImage(rng, size, CV_8UC1) };
    hdp::CensusCost plain, limited;
    plain.prepare(left, right, numDisparities, 7, 2);
    limited.prepare(left, right, numDisparities, 7, 2, masks);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int lanes : { 4, 8, 16, 32, 64 })
            {
                const int pixel = y * size.width + x, mostFirst = numDisparities + hdp::costPadding - lanes,
                          first = rng.uniform(0, std::min(mostFirst + 1, numDisparities));
                std::vector<float> expected(lanes), costs(lanes);
                std::vector<uchar> bytes(lanes);
                plain.evaluate(&pixel, 1, first, lanes, expected.data());
                limited.evaluate(&pixel, 1, first, lanes, costs.data());
                limited.evaluate(&pixel, 1, first, lanes, bytes.data());
                for (int k = 0; k < lanes && first + k < numDisparities; ++k)
                {
                    const int matched = std::max(x - first - k, 0);
                    const float cost = masks.left.at<uchar>(y, x) < 128              ? 0
                                       : oracle::isMissing(masks, Point(matched, y)) ? std::min(expected[k], 8.f)
                                                                                     : expected[k];
                    ASSERT_EQ(cost, costs[k]);
                    ASSERT_EQ(cost, bytes[k]);
                }
            }
}

TEST(HDPStereo_Masks, where_rows_begin)
{
    const int width = 80;
    const Mat all(4, width, CV_8UC1, Scalar(255));
    hdp::PairMasks masks = { all.clone(), all.clone() };
    masks.left.colRange(0, 5).setTo(Scalar(127));
    masks.right.colRange(0, 15).setTo(Scalar(0)); // an eighth of the width farther on
    masks.right.row(1).col(15).setTo(Scalar(0));  // more
    masks.left.row(2).setTo(Scalar(0));
    masks.right.row(3).setTo(Scalar(0));
    const int left[] = { 5, 0, width, 0 }, right[] = { 15, 0, 15, 0 };
    for (int y = 0; y < all.rows; ++y)
    {
        EXPECT_EQ(left[y], hdp::rowStart(masks, y).left) << y;
        EXPECT_EQ(right[y], hdp::rowStart(masks, y).right) << y;
    }
    EXPECT_EQ(0, hdp::rowStart(hdp::PairMasks(), 0).right);
    masks.wholeWidth = width - 8; // tiles of images of which this is more than an eighth
    EXPECT_EQ(0, hdp::rowStart(masks, 0).right);
    masks.rightBegin = 1; // what is masked is a column less
    EXPECT_EQ(15, hdp::rowStart(masks, 0).right);
    masks.leftBegin = 1; // in both
    EXPECT_EQ(0, hdp::rowStart(masks, 0).right);
}

//! Whatever the range begins with
TEST(HDPStereo_Masks, rows_of_any_range_begin_with_data)
{
    const SyntheticPair pair = makeSyntheticPair(Size(240, 120), 64, 41);
    Mat mask(pair.right.size(), CV_8U, Scalar(255)), map, reasons;
    mask.colRange(0, 20).setTo(Scalar(0));
    for (int minDisparity : { -32, 0, 30 })
    {
        Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, 64 - minDisparity);
        matcher->setMasks(noArray(), mask);
        matcher->setDisparityDepth(CV_32F);
        matcher->compute(pair.left, pair.right, map);
        matcher->getReasons(reasons);
        int hidden = 0, outside = 0;
        for (int y = 0; y < map.rows; ++y)
            for (int x = 0; x < map.cols; ++x)
            {
                const float column = x - map.at<float>(y, x);
                hidden += column > 0 && column < 19;
                outside += column > 0 && column < 19 && reasons.at<uchar>(y, x) == HDPTreeMatcher::REASON_OUTSIDE;
            }
        EXPECT_GT(hidden, 100) << minDisparity;
        EXPECT_EQ(hidden, outside) << minDisparity;
    }
}

//! What the right image does not show because it is masked is not matched.
TEST(HDPStereo_Masks, what_matches_masked_pixels_is_occluded)
{
    const SyntheticPair pair = makeSyntheticPair(Size(240, 120), 32, 42);
    Mat mask(pair.right.size(), CV_8U, Scalar(255)), map, reasons;
    const Rect hole(120, 40, 40, 40);
    mask(hole).setTo(Scalar(0));
    Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
    matcher->setMasks(noArray(), mask);
    matcher->setDisparityDepth(CV_32F);
    matcher->compute(pair.left, pair.right, map);
    matcher->getReasons(reasons);
    int masked = 0;
    for (int y = hole.y; y < hole.br().y; ++y)
        for (int x = 0; x < map.cols; ++x)
            if (hole.contains(Point(cvRound(x - map.at<float>(y, x)), y)))
            {
                ++masked;
                EXPECT_NE(HDPTreeMatcher::REASON_MATCHED, (int)reasons.at<uchar>(y, x)) << x << ", " << y;
            }
    EXPECT_GT(masked, 1000);
}

TEST(HDPStereo_Masks, reason_and_sigma)
{
    const MaskedPair pair(CV_8UC1);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 40);
    matcher->setMasks(pair.leftMask, pair.rightMask);
    for (bool isFiltered : { false, true })
    {
        matcher->setDisp12MaxDiff(isFiltered ? 1 : 0);
        matcher->setSpeckleWindowSize(isFiltered ? 50 : 0);
        match(*matcher, pair.left, pair.right);
        Mat reasons, sigma;
        matcher->getReasons(reasons);
        matcher->getDisparitySigma(sigma);
        expectIdentical(pair.leftMask == 0, reasons == HDPTreeMatcher::REASON_MASKED);
        EXPECT_EQ(0, countNonZero((pair.leftMask == 0) & (sigma < 1e30)));
    }
}

//! Pixels without data hide none of the others: those that the filter does not reject are not occluded, unless they match
//! such pixels.
TEST(HDPStereo_Masks, reasons_are_those_of_the_filter)
{
    const MaskedPair pair(CV_8UC1);
    for (const System& preset : { presetPaper, presetFast, presetQuality, presetTree }) // whose layer is the image
        for (const int minDisparity : { 0, -12 }) // even ones: half a pixel is rounded as without them
        {
            SCOPED_TRACE(testing::Message() << preset.name << ", from " << minDisparity);
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 45, minDisparity);
            matcher->setMasks(pair.leftMask, pair.rightMask);
            matcher->setDisp12MaxDiff(-1);
            const Mat map = match(*matcher, pair.left, pair.right).clone();
            Mat reasons, filtered;
            matcher->getReasons(reasons);
            matcher->setDisp12MaxDiff(1);
            match(*matcher, pair.left, pair.right);
            matcher->getReasons(filtered);
            const Mat isOccluded = reasons == HDPTreeMatcher::REASON_OCCLUDED,
                      isKept = filtered != HDPTreeMatcher::REASON_UNSTABLE;
            for (int y = 0; y < map.rows; ++y)
                for (int x = 0; x < map.cols; ++x)
                {
                    const int column = x - cvFloor(map.at<short>(y, x) / 16. + 0.5);
                    const bool isMatched = isOccluded.at<uchar>(y, x) & isKept.at<uchar>(y, x);
                    EXPECT_TRUE(!isMatched || pair.rightMask.at<uchar>(y, column) == 0) << x << ", " << y;
                }
        }
}

}} // namespace opencv_test
