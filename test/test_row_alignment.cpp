// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"

#include "../src/pair/image_levels.hpp"
#include "../src/pair/row_alignment.hpp"
#include "../src/pair/corner_matches.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

namespace opencv_test { namespace {

using hdp::RowModel;

RowModel makeModel(double offset, double shear = 0, double stretch = 0, double keystone = 0, double bow = 0)
{
    RowModel model;
    model.coefficients = RowModel::Coefficients(offset, shear, stretch, keystone, bow);
    return model;
}

const RowModel models[] = { makeModel(0.5),
                            makeModel(-3),
                            makeModel(7),
                            makeModel(0, 5.2e-3),
                            makeModel(0.7, 3e-3, 4e-3),
                            makeModel(-1.5, -1e-3, 2e-3, 4e-6, -5e-6) };

Point2d fromCentre(int x, int y, Size size) { return Point2d(x + 0.5 - 0.5 * size.width, y + 0.5 - 0.5 * size.height); }

//! The right image of a camera whose rows are off: bad(x, y + model(x, y)) = right(x, y)
Mat misalign(const Mat& right, const RowModel& model)
{
    Mat rows(right.size(), CV_32F), columns(right.size(), CV_32F), bad;
    for (int y = 0; y < right.rows; ++y)
        for (int x = 0; x < right.cols; ++x)
        {
            double row = y;
            for (int i = 0; i < 20; ++i)
            {
                const Point2d place = fromCentre(x, y, right.size());
                row = y - model.at(Point2d(place.x, place.y + row - y));
            }
            rows.at<float>(y, x) = (float)row;
            columns.at<float>(y, x) = (float)x;
        }
    remap(right, bad, columns, rows, INTER_CUBIC, BORDER_REPLICATE);
    return bad;
}

//! Root of the mean square difference of two models over the image
double distance(const RowModel& a, const RowModel& b, Size size)
{
    double sum = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const double difference = a.at(fromCentre(x, y, size)) - b.at(fromCentre(x, y, size));
            sum += difference * difference;
        }
    return std::sqrt(sum / size.area());
}

RowModel foundBy(const HDPTreeMatcher& matcher, bool isExpected = true)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const std::vector<double>& found = findings.rows;
    EXPECT_EQ(isExpected, findings.areRowsMoved);
    RowModel model;
    EXPECT_EQ((size_t)RowModel::terms, found.size());
    std::copy(found.begin(), found.end(), model.coefficients.val);
    return model;
}

void addNoise(Mat& image, double deviation, RNG& rng)
{
    Mat noise(image.size(), CV_16SC3), sum;
    rng.fill(noise, RNG::NORMAL, 0, deviation);
    cv::add(image, noise, sum, cv::noArray(), CV_8U);
    image = sum;
}

////////////////////////////////////////////// the stage //////////////////////////////////////////////

//! Catmull and Rom's interpolation, from the formula
double interpolate(const Mat& image, double row, int x, int channel)
{
    double sum = 0;
    for (int y = cvFloor(row) - 1; y <= cvFloor(row) + 2; ++y)
    {
        const double t = std::abs(row - y);
        const double weight = t <= 1 ? 1.5 * t * t * t - 2.5 * t * t + 1 : -0.5 * t * t * t + 2.5 * t * t - 4 * t + 2;
        const int inside = std::min(std::max(y, 0), image.rows - 1), element = x * image.channels() + channel;
        sum += weight * (image.depth() == CV_8U ? image.ptr(inside)[element] : image.ptr<ushort>(inside)[element]);
    }
    return std::min(std::max(sum, 0.), image.depth() == CV_8U ? 255. : 65535.);
}

TEST(HDPStereo_RowAlignment, rows_are_interpolated)
{
    RNG rng(1);
    for (const int type : { CV_8UC1, CV_8UC3, CV_16UC1 })
        for (const RowModel& model : models)
        {
            SCOPED_TRACE(format("%d, %f", type, model.coefficients[0]));
            const Mat image = randomImage(rng, Size(171, 53), type, type == CV_16UC1 ? 1024 : 256);
            Mat aligned;
            hdp::alignRows(image, model, hdp::ImageFrame(image.size()), aligned);
            ASSERT_EQ(image.size(), aligned.size());
            ASSERT_EQ(image.type(), aligned.type());
            const double tolerance = type == CV_16UC1 ? 20 : 6; // a row's place is one of 64
            for (int y = 0; y < image.rows; ++y)
                for (int x = 0; x < image.cols; ++x)
                    for (int c = 0; c < image.channels(); ++c)
                    {
                        const double row = y + model.at(fromCentre(x, y, image.size()));
                        const int i = x * image.channels() + c;
                        const double value = type == CV_16UC1 ? aligned.ptr<ushort>(y)[i] : aligned.ptr(y)[i];
                        ASSERT_NEAR(interpolate(image, row, x, c), value, tolerance) << x << ", " << y;
                    }
        }
}

TEST(HDPStereo_RowAlignment, whole_rows_are_copied)
{
    RNG rng(2);
    const Mat image = randomImage(rng, Size(64, 40), CV_8UC3);
    Mat aligned;
    hdp::alignRows(image, makeModel(0), hdp::ImageFrame(image.size()), aligned);
    expectIdentical(image, aligned);
    hdp::alignRows(image, makeModel(-3), hdp::ImageFrame(image.size()), aligned);
    expectIdentical(image.rowRange(0, 37), aligned.rowRange(3, 40));
    for (int y = 0; y < 3; ++y)
        expectIdentical(image.row(0), aligned.row(y));
    hdp::alignRows(image, makeModel(1000), hdp::ImageFrame(image.size()), aligned);
    for (int y = 0; y < image.rows; ++y)
        expectIdentical(image.row(39), aligned.row(y));
}

//! On all layers, about another point
TEST(HDPStereo_RowAlignment, model_of_a_layer)
{
    const RowModel model = makeModel(-1.5, -1e-3, 2e-3, 4e-6, -5e-6);
    const Point2d place(120, -64);
    EXPECT_NEAR(-1.5 - 0.12 - 0.128 - 0.03072 - 0.02048, model.at(place), 1e-9);
    EXPECT_NEAR(model.at(place) / 4, model.ofLayer(2).at(Point2d(30, -16)), 1e-9);
    EXPECT_NEAR(model.at(place), model.about(20).at(Point2d(100, -64)), 1e-9);
}

//! Normalised cross-correlation, from the formula
double correlation(const Mat& left, const Mat& right, Point a, Point b)
{
    const int side = hdp::CornerMatching::searchSide;
    const Rect l(a.x - side / 2, a.y - side / 2, side, side), r(b.x - side / 2, b.y - side / 2, side, side);
    Mat_<double> x, y;
    left(l).convertTo(x, CV_64F);
    right(r).convertTo(y, CV_64F);
    x -= mean(x)[0];
    y -= mean(y)[0];
    return x.dot(y) / std::sqrt(x.dot(x) * y.dot(y));
}

TEST(HDPStereo_RowAlignment, matches_correlate_best)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 150), 24, 3);
    Mat left, right;
    hdp::greyLevels(pair.left, hdp::LevelScale(), left);
    hdp::greyLevels(misalign(pair.right, makeModel(1)), hdp::LevelScale(), right);
    hdp::SearchWindows windows;
    std::vector<hdp::CornerMatch> matches;
    hdp::findCornerMatches(left, right, hdp::PairMasks(), Range(0, 25), 4, windows, matches);
    int valid = 0, oneRow = 0;
    for (const hdp::CornerMatch& match : matches)
    {
        if (!match.isValid)
            continue;
        ++valid;
        oneRow += match.y - match.left.y == 1;
        const double best = correlation(left, right, match.left, Point((int)match.x, (int)match.y));
        EXPECT_GE(best, 0.8 - 1e-6);
        for (int y = match.left.y - hdp::CornerMatching::searchRadius;
             y <= match.left.y + hdp::CornerMatching::searchRadius; ++y)
            for (int x = std::max(match.left.x - 24, hdp::CornerMatching::searchSide / 2); x <= match.left.x; ++x)
                ASSERT_LE(correlation(left, right, match.left, Point(x, y)), best + 1e-6);
    }
    EXPECT_GE(valid, 100);
    EXPECT_GE(oneRow, 0.9 * valid);
}

//! Fewer than the search has in a vector; at the left border the image ends before them
TEST(HDPStereo_RowAlignment, matches_within_few_disparities)
{
    const SyntheticPair pair = makeSyntheticPair(Size(120, 90), 4, 3);
    Mat left, right;
    hdp::greyLevels(pair.left, hdp::LevelScale(), left);
    hdp::greyLevels(pair.right, hdp::LevelScale(), right);
    hdp::SearchWindows windows;
    std::vector<hdp::CornerMatch> matches;
    hdp::findCornerMatches(left, right, hdp::PairMasks(), Range(0, 4), 4, windows, matches);
    int valid = 0, atBorder = 0;
    for (const hdp::CornerMatch& match : matches)
    {
        if (!match.isValid)
            continue;
        ++valid;
        atBorder += match.left.x < hdp::SearchArea::minColumns + hdp::CornerMatching::searchSide / 2;
        EXPECT_GE(match.left.x, match.x);
        EXPECT_LE(match.left.x - match.x, 3);
    }
    EXPECT_GE(valid, 100);
    EXPECT_GE(atBorder, 3);
}

TEST(HDPStereo_RowAlignment, matches_are_tracked_to_a_fraction)
{
    const SyntheticPair pair = makeSlantedPlane(Size(320, 240), 32, 4);
    const RowModel model = makeModel(0.4, 2e-3);
    Mat left, right;
    hdp::greyLevels(pair.left, hdp::LevelScale(), left);
    hdp::greyLevels(misalign(pair.right, model) * 0.7 + Scalar::all(20), hdp::LevelScale(), right); // other light
    std::vector<hdp::CornerMatch> matches;
    for (int y = 20; y < 220; y += 10)
        for (int x = 60; x < 300; x += 10)
        {
            const double disparity = cvRound(pair.truth.at<float>(y, x));
            const hdp::CornerMatch match = { Point(x, y), x - disparity, (double)y, 0.1, 0, true };
            matches.push_back(match);
        }
    hdp::trackCornerMatches(left, right, matches);
    std::vector<double> errors;
    for (const hdp::CornerMatch& match : matches)
        if (match.isValid)
            errors.push_back(
                std::abs(match.y - match.left.y - model.at(fromCentre((int)match.x, match.left.y, left.size()))));
    ASSERT_GE(errors.size(), 0.8 * matches.size());
    std::sort(errors.begin(), errors.end());
    EXPECT_LE(errors[errors.size() / 2], 0.05);
    EXPECT_LE(errors[errors.size() * 9 / 10], 0.15);
}

TEST(HDPStereo_SlowRowAlignment, noise_level)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 15);
    for (const double noise : { 3., 6. }) // more leaves too few matches on the image itself
        for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_ULTRAFAST })
        {
            RNG rng(16);
            Mat left = pair.left.clone(), right = pair.right.clone();
            addNoise(left, noise, rng);
            addNoise(right, noise, rng);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, preset);
            match(*matcher, left, right);
            const double grey = noise * std::sqrt(0.299 * 0.299 + 0.587 * 0.587 + 0.114 * 0.114); // of three channels
            const double ofLayer = preset == HDPTreeMatcher::PRESET_ULTRAFAST ? grey / 2 : grey;
            EXPECT_GE(matcher->getFindings().noise, 0.85 * ofLayer);
            EXPECT_LE(matcher->getFindings().noise, 1.15 * ofLayer + 1.5); // the pair has noise and texture of its own
        }
}

//! Defective pixels, one of a hundred in each image, are not noise.
TEST(HDPStereo_RowAlignment, difference_of_quiet_rows)
{
    RNG rng(71);
    const Size size(640, 480);
    const double noise = 8, defect = 400;
    Mat texture(size, CV_32F), images[2];
    rng.fill(texture, RNG::NORMAL, 512, 300);
    GaussianBlur(texture, texture, Size(), 2);
    std::vector<hdp::CornerMatch> matches;
    for (int y = 20; y < size.height - 20; y += 20)
        for (int x = 20; x < size.width - 20; x += 20)
            matches.push_back({ Point(x, y), (double)x, (double)y, 0.1, DBL_MAX, true });
    for (const bool hasDefects : { false, true })
    {
        for (Mat& image : images)
        {
            Mat levels(size, CV_32F);
            rng.fill(levels, RNG::NORMAL, 0, noise);
            levels += texture;
            for (int i = hasDefects ? size.area() / 100 : 0; i > 0; --i)
                levels.at<float>(rng.uniform(0, size.height), rng.uniform(0, size.width)) += (float)defect;
            levels.convertTo(image, CV_16U);
        }
        std::vector<double> quiet;
        for (const hdp::CornerMatch& match : matches)
            quiet.push_back(hdp::quietDifference(images[0], images[1], match));
        std::nth_element(quiet.begin(), quiet.begin() + quiet.size() / 2, quiet.end());
        EXPECT_NEAR(2 * noise * noise, quiet[quiet.size() / 2], 0.15 * 2 * noise * noise) << hasDefects;
    }
    const Mat plain(size, CV_16U, Scalar(500));
    const hdp::CornerMatch bare = { Point(100, 100), 90.5, 100, 0.1, 7, true };
    EXPECT_EQ(7, hdp::quietDifference(plain, images[1], bare)) << "its residual";
    EXPECT_EQ(7, hdp::quietDifference(images[0], images[1], bare)) << "no more than that";
}

//! Noisy pairs of a camera whose lens is no sharper than its pixels are smoothed: fewer errors. Others are not.
TEST(HDPStereo_SlowRowAlignment, noise_threshold)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 17);
    RNG rng(18);
    Mat left, right;
    GaussianBlur(pair.left, left, Size(), 1);
    GaussianBlur(pair.right, right, Size(), 1);
    addNoise(left, 14, rng);
    addNoise(right, 14, rng);
    for (const int preset :
         { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_QUALITY, (int)HDPTreeMatcher::PRESET_TREE })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, preset);
        const Mat smoothed = match(*matcher, left, right), clean = match(*matcher, pair.left, pair.right);
        matcher->setNoiseThreshold(0);
        expectIdentical(clean, match(*matcher, pair.left, pair.right));
        const Mat noisy = match(*matcher, left, right);
        EXPECT_LT(badPixels(smoothed, pair.truth, pair.visible, 2), badPixels(noisy, pair.truth, pair.visible, 2));
        matcher->setNoiseThreshold(100);
        expectIdentical(noisy, match(*matcher, left, right));
    }
}

////////////////////////////////////////////// of the matcher //////////////////////////////////////////////

TEST(HDPStereo_SlowRowAlignment, finds_what_was_done)
{
    const int presets[] = { HDPTreeMatcher::PRESET_FAST, HDPTreeMatcher::PRESET_ULTRAFAST,
                            HDPTreeMatcher::PRESET_QUALITY, HDPTreeMatcher::PRESET_TREE };
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 5);
    for (size_t i = 0; i < sizeof models / sizeof *models; ++i)
        for (const double noise : { 0., 8. })
        {
            const int rounds = noise > 0 ? 4 : 1; // one noise is luck
            double error = 0;
            RNG rng(i);
            for (int round = 0; round < rounds; ++round)
            {
                Mat left = pair.left.clone(), right = misalign(pair.right, models[i]);
                addNoise(left, noise, rng);
                addNoise(right, noise, rng);
                const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, presets[i % 4]);
                match(*matcher, left, right);
                error += distance(models[i], foundBy(*matcher), left.size()) / rounds;
            }
            EXPECT_LE(error, noise > 0 ? 0.23 : 0.1) << "model " << i << ", noise " << noise;
        }
}

TEST(HDPStereo_SlowRowAlignment, errors_are_those_of_a_good_pair)
{
    for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_QUALITY })
        for (const RowModel& model : models)
        {
            double clean = 0, misaligned = 0;
            for (int seed = 4; seed <= 6; ++seed)
            {
                const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, seed);
                Mat judged = pair.visible.clone(); // without rows that the right image does not have
                judged.rowRange(0, 12) = 0;
                judged.rowRange(468, 480) = 0;
                const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64, preset);
                clean += badPixels(match(*matcher, pair.left, pair.right), pair.truth, judged, 1) / 3;
                const Mat disparity = match(*matcher, pair.left, misalign(pair.right, model));
                misaligned += badPixels(disparity, pair.truth, judged, 1) / 3;
            }
            EXPECT_LE(misaligned, 1.1 * clean + 0.3) << "preset " << preset << ", " << model.coefficients[0];
        }
}

TEST(HDPStereo_RowAlignment, good_pairs_stay_as_they_are)
{
    const SyntheticPair pair = makeSyntheticPair(Size(500, 360), 48, 7);
    for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_ULTRAFAST })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, preset);
        const Mat disparity = match(*matcher, pair.left, pair.right);
        EXPECT_LE(distance(makeModel(0), foundBy(*matcher, false), pair.left.size()), 0.1);
        matcher->setMaxRowOffset(0);
        expectIdentical(disparity, match(*matcher, pair.left, pair.right));
        EXPECT_EQ(0, cv::norm(foundBy(*matcher, false).coefficients));
    }
}

//! Levels that differ by a factor alone leave nothing between windows, and rounding may leave less.
TEST(HDPStereo_RowAlignment, no_noise)
{
    RNG rng(17);
    const Mat texture = randomImage(rng, Size(208, 150), CV_8UC1, 10);
    for (const Size factors : { Size(7, 19), Size(11, 15), Size(22, 9), Size(25, 11), Size(23, 26) })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
        match(*matcher, texture.colRange(0, 200) * factors.width, texture.colRange(8, 208) * factors.height);
        EXPECT_LE(0, matcher->getFindings().noise) << factors;
        EXPECT_NO_THROW(matcher->setPairModel(matcher->getPairModel())) << factors;
    }
}

//! Nothing to match, or nothing but what is ambiguous
TEST(HDPStereo_RowAlignment, no_evidence)
{
    RNG rng(8);
    const Size size(400, 300);
    Mat stripes(size, CV_8UC1), columns(size, CV_8UC1);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            stripes.at<uchar>(y, x) = (uchar)(y / 4 % 2 * 100 + 50);
            columns.at<uchar>(y, x) = (uchar)(x / 4 % 2 * 100 + 50);
        }
    const auto images = [&] {
        return std::vector<Mat>{ Mat(size, CV_8UC1, Scalar(128)),
                                 stripes,
                                 columns,
                                 randomImage(rng, size, CV_8UC1),
                                 randomImage(rng, Size(1, 1), CV_8UC1),
                                 randomImage(rng, Size(300, 3), CV_8UC1) };
    };
    const std::vector<Mat> left = images(), right = images();
    for (size_t i = 0; i < left.size(); ++i)
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
        match(*matcher, left[i], right[i]);
        foundBy(*matcher, false);
    }
}

//! A third of the image moves by itself.
TEST(HDPStereo_RowAlignment, moving_things)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 9);
    Mat right = misalign(pair.right, makeModel(1));
    const Rect moving(200, 100, 320, 300);
    misalign(pair.right, makeModel(4))(moving).copyTo(right(moving));
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
    match(*matcher, pair.left, right);
    EXPECT_LE(distance(makeModel(1), foundBy(*matcher), right.size()), 0.3);
}

TEST(HDPStereo_RowAlignment, limit)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 32, 10);
    const Mat right = misalign(pair.right, makeModel(4));
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
    matcher->setMaxRowOffset(3);
    const Mat limited = match(*matcher, pair.left, right);
    foundBy(*matcher, false);
    matcher->setMaxRowOffset(0);
    expectIdentical(limited, match(*matcher, pair.left, right));
    matcher->setMaxRowOffset(5);
    match(*matcher, pair.left, right);
    EXPECT_LE(distance(makeModel(4), foundBy(*matcher), right.size()), 0.1);
}

//! The model is about the right image's centre, whatever columns are added.
//! By more than the search for corners sees at once
TEST(HDPStereo_SlowRowAlignment, rows_far_away)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 48, 4);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    const Mat all(pair.truth.size(), CV_8U, Scalar(255));
    const double expected = badPixels(match(*matcher, pair.left, pair.right), pair.truth, all, 1);
    for (const int offset : { 13, -20, 33, -60 })
    {
        const Mat right = misalign(pair.right, makeModel(offset));
        matcher->setMaxRowOffset(64);
        EXPECT_LT(badPixels(match(*matcher, pair.left, right), pair.truth, all, 1), expected + 0.5 * std::abs(offset));
        EXPECT_TRUE(matcher->getFindings().areRowsMoved);
        EXPECT_NEAR(offset, matcher->getFindings().rows[0], 0.2);
        matcher->setMaxRowOffset(std::abs(offset) - 4);
        match(*matcher, pair.left, right);
        EXPECT_FALSE(matcher->getFindings().areRowsMoved) << "beyond the limit";
    }
}

TEST(HDPStereo_RowAlignment, other_smallest_disparities)
{
    const SyntheticPair pair = makeSyntheticPair(Size(480, 360), 48, 11);
    const RowModel model = makeModel(1, 4e-3, 2e-3);
    const Mat right = misalign(pair.right, model);
    for (const int minDisparity : { -20, -3, 3 })
        for (const int preset : { (int)HDPTreeMatcher::PRESET_FAST, (int)HDPTreeMatcher::PRESET_ULTRAFAST })
        {
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, 64, preset);
            match(*matcher, pair.left, right);
            EXPECT_LE(distance(model, foundBy(*matcher), right.size()), 0.12) << minDisparity;
        }
}

//! The paper's cost takes the images themselves.
TEST(HDPStereo_RowAlignment, color_gradient)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 32, 12);
    const Mat right = misalign(pair.right, makeModel(2));
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32, HDPTreeMatcher::PRESET_PAPER);
    const double clean = badPixels(match(*matcher, pair.left, pair.right), pair.truth, pair.visible, 1);
    EXPECT_EQ(0, cv::norm(foundBy(*matcher, false).coefficients));
    matcher->setMaxRowOffset(8);
    EXPECT_LE(badPixels(match(*matcher, pair.left, right), pair.truth, pair.visible, 1), 1.1 * clean + 1);
    EXPECT_LE(distance(makeModel(2), foundBy(*matcher), right.size()), 0.1);
}

TEST(HDPStereo_RowAlignment, threads)
{
    const SyntheticPair pair = makeSyntheticPair(Size(333, 257), 32, 13);
    const Mat right = misalign(pair.right, models[4]);
    const int before = getNumThreads();
    Mat expected;
    RowModel found;
    for (const int threads : { 1, 2, 5 })
    {
        setNumThreads(threads);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
        const Mat disparity = match(*matcher, pair.left, right);
        if (expected.empty())
        {
            expected = disparity;
            found = foundBy(*matcher);
        }
        expectIdentical(expected, disparity);
        EXPECT_EQ(found.coefficients, foundBy(*matcher).coefficients);
    }
    setNumThreads(before);
}

//! What an earlier pair left is gone.
TEST(HDPStereo_RowAlignment, pair_by_pair)
{
    const SyntheticPair pair = makeSyntheticPair(Size(400, 300), 32, 14);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32);
    const Mat good = match(*matcher, pair.left, pair.right);
    match(*matcher, pair.left, misalign(pair.right, makeModel(2)));
    foundBy(*matcher);
    expectIdentical(good, match(*matcher, pair.left, pair.right));
    foundBy(*matcher, false);
    EXPECT_THROW(matcher->compute(Mat(), pair.right, Mat()), cv::Exception);
    EXPECT_EQ(0, cv::norm(foundBy(*matcher, false).coefficients));
}

}} // namespace opencv_test
