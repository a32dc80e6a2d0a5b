// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "../src/range_search.hpp"

namespace opencv_test { namespace {

using hdp::CornerMatch;

const int truthEnd = 64; // disparities of the pair are below

SyntheticPair makeScene(int seed) { return makeSyntheticPair(Size(480, 320), truthEnd, seed); }

const SyntheticPair& scene()
{
    static const SyntheticPair pair = makeScene(4);
    return pair;
}

CornerMatch matchAt(Point left, double disparity)
{
    CornerMatch match;
    match.left = left;
    match.x = left.x - disparity;
    match.y = left.y;
    match.variance = match.residual = 0;
    match.isValid = true;
    return match;
}

Range foundRange(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    return Range(findings.minDisparity, findings.minDisparity + findings.numDisparities);
}

//! The range has all true disparities, which are moved by some. Returns how many times as large it is.
double expectCovers(const Range& found, const Mat& truth, int moved)
{
    double first, last;
    cv::minMaxLoc(truth, &first, &last);
    EXPECT_LE(found.start, first + moved);
    EXPECT_GE(found.end - 1, last + moved);
    return found.size() / (last - first);
}

//! The same of the scene, whose range is not three times as large
void expectCovers(const Range& found) { EXPECT_LE(expectCovers(found, scene().truth, 0), 3); }

//! A single corner that is matched wrongly may make a range four times as large as necessary.
TEST(HDPStereo_SlowRangeSearch, any_sign_and_type)
{
    const struct
    {
        int moved, type; // columns of the left image that are cut off, or of the right one
    } cases[] = { { 0, CV_8UC3 },   { -30, CV_8UC3 }, { -80, CV_8UC3 },  { 25, CV_8UC3 },
                  { -80, CV_8UC1 }, { 25, CV_16UC1 }, { -30, CV_32FC1 }, { 0, CV_32FC1 } };
    double sum = 0;
    int count = 0;
    for (int seed = 1; seed <= 4; ++seed)
        for (const auto& c : cases)
        {
            SCOPED_TRACE(format("moved by %d, type %d, seed %d", c.moved, c.type, seed));
            const SyntheticPair pair = makeScene(seed);
            const int columns = pair.left.cols - std::abs(c.moved);
            const int leftStart = std::max(-c.moved, 0), rightStart = std::max(c.moved, 0);
            Mat images[] = { pair.left.colRange(leftStart, leftStart + columns).clone(),
                             pair.right.colRange(rightStart, rightStart + columns).clone() };
            for (Mat& image : images)
            {
                if (c.type != CV_8UC3)
                    cv::cvtColor(image, image, COLOR_BGR2GRAY);
                if (c.type == CV_16UC1)
                    image.convertTo(image, c.type, 16, 100);
                if (c.type == CV_32FC1)
                    image.convertTo(image, c.type, 1 / 255.);
            }
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(7, 0);
            const Mat disparity = match(*matcher, images[0], images[1]);
            EXPECT_EQ(7, matcher->getMinDisparity()) << "parameters stay";
            EXPECT_EQ(0, matcher->getNumDisparities());
            const Range found = foundRange(*matcher);
            const double times = expectCovers(found, pair.truth, c.moved);
            EXPECT_LE(times, 4.5);
            sum += times;
            ++count;
            const Ptr<HDPTreeMatcher> told = HDPTreeMatcher::create(found.start, found.size());
            expectIdentical(match(*told, images[0], images[1]), disparity);
        }
    EXPECT_LE(sum / count, 2.25);
}

TEST(HDPStereo_SlowRangeSearch, all_presets_and_threads)
{
    Range first;
    for (int preset = HDPTreeMatcher::PRESET_PAPER; preset <= HDPTreeMatcher::PRESET_TREE; ++preset)
        for (const int threads : { 1, 3 })
        {
            const ScopedThreads scoped(threads);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0, preset);
            match(*matcher, scene().left, scene().right);
            if (first.empty())
                first = foundRange(*matcher);
            EXPECT_EQ(first, foundRange(*matcher)) << preset << ", " << threads;
        }
    expectCovers(first);
}

//! By more than corners are matched over
TEST(HDPStereo_SlowRangeSearch, rows_are_off)
{
    for (const int rows : { 12, -16, -20 })
    {
        SCOPED_TRACE(rows);
        const Range all(std::max(rows, 0), scene().left.rows + std::min(rows, 0));
        const Mat left = scene().left.rowRange(all).clone(),
                  right = scene().right.rowRange(all.start - rows, all.end - rows).clone();
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
        match(*matcher, left, right);
        expectCovers(foundRange(*matcher));
        matcher->setMaxRowOffset(0);
        Mat disparity;
        expectRejected([&] { matcher->compute(left, right, disparity); }, "too few corners");
    }
}

//! Texture that the layer whose corners are matched first does not have, and images with few of its cells
TEST(HDPStereo_RangeSearch, fine_texture_and_small_images)
{
    for (const Size& size : { Size(640, 480), Size(100, 75), Size(64, 48) })
        for (int seed = 1; seed <= 3; ++seed)
        {
            SCOPED_TRACE(format("%d x %d, seed %d", size.width, size.height, seed));
            const int behind = size.width / 20, before = size.width / 8;
            RNG rng(seed);
            Mat canvas(size + Size(behind, 0), CV_32F);
            rng.fill(canvas, RNG::UNIFORM, -1, 1);
            cv::GaussianBlur(canvas, canvas, Size(), 1.2);
            canvas.convertTo(canvas, CV_8U, 300, 128);
            const Mat left = canvas.colRange(0, size.width).clone(),
                      right = canvas.colRange(behind, behind + size.width).clone();
            const Rect box(size.width / 2, size.height / 3, size.width / 4, size.height / 3);
            const Mat texture = randomImage(rng, box.size(), CV_8U);
            texture.copyTo(left(box));
            texture.copyTo(right(box - Point(before, 0)));
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
            match(*matcher, left, right);
            EXPECT_LE(foundRange(*matcher).start, behind);
            EXPECT_GT(foundRange(*matcher).end, before);
            EXPECT_LT(foundRange(*matcher).end, 2 * before + 8);
        }
}

//! Lower than a cell of the corners' grid would be
TEST(HDPStereo_SlowRangeSearch, long_and_low_images)
{
    RNG rng(6);
    for (const Size& size : { Size(6000, 22), Size(2000, 26), Size(60, 3000) })
    {
        Mat canvas(size + Size(8, 0), CV_32F);
        rng.fill(canvas, RNG::UNIFORM, -1, 1);
        cv::GaussianBlur(canvas, canvas, Size(), 1.2);
        canvas.convertTo(canvas, CV_8U, 300, 128);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
        match(*matcher, canvas.colRange(0, size.width).clone(), canvas.colRange(8, size.width + 8).clone());
        EXPECT_LE(foundRange(*matcher).start, 8) << size;
        EXPECT_GT(foundRange(*matcher).end, 8) << size;
        EXPECT_LT(foundRange(*matcher).size(), 40) << size;
    }
}

TEST(HDPStereo_RangeSearch, nothing_to_find)
{
    const Size size(320, 240);
    RNG rng(5);
    const Mat pairs[][2] = {
        { Mat(size, CV_8U, Scalar(90)), Mat(size, CV_8U, Scalar(90)) },
        { randomImage(rng, size, CV_8U), randomImage(rng, size, CV_8U) },
        { patchyImage(rng, size, CV_8U), patchyImage(rng, size, CV_8U) },
        { Mat(1, 1, CV_8U, Scalar(3)), Mat(1, 1, CV_8U, Scalar(3)) },
        { randomImage(rng, Size(5, 300), CV_16U), randomImage(rng, Size(5, 300), CV_16U) },
    };
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
    for (const auto& pair : pairs)
    {
        Mat disparity(2, 2, CV_8U, Scalar(7));
        const Mat before = disparity.clone();
        expectRejected([&] { matcher->compute(pair[0], pair[1], disparity); }, "numDisparities must be > 0");
        expectIdentical(before, disparity);
        EXPECT_EQ(Range(), foundRange(*matcher));
    }
    match(*matcher, scene().left, scene().right);
    expectCovers(foundRange(*matcher));

    // What does not depend on the range is an error before any work.
    matcher->setMasks(Mat::ones(3, 3, CV_8U), noArray());
    expectRejected([&] { match(*matcher, scene().left, scene().right); }, "leftMask");
}

TEST(HDPStereo_RangeSearch, what_is_masked_has_no_influence)
{
    Mat left = scene().left.clone(), right = scene().right.clone();
    Mat leftMask(left.size(), CV_8U, Scalar(255)), rightMask = leftMask.clone();
    leftMask.rowRange(0, 60).setTo(0);
    rightMask.rowRange(0, 60).setTo(0);
    RNG rng(9);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
    matcher->setMasks(leftMask, rightMask);
    match(*matcher, left, right);
    const Range found = foundRange(*matcher);
    // The same texture there, 200 pixels apart
    const Mat noise = patchyImage(rng, Size(left.cols, 60), CV_8UC3);
    noise.copyTo(left.rowRange(0, 60));
    noise.colRange(200, left.cols).copyTo(right.rowRange(0, 60).colRange(0, left.cols - 200));
    match(*matcher, left, right);
    EXPECT_EQ(found, foundRange(*matcher));
    matcher->setMasks(noArray(), noArray());
    match(*matcher, left, right);
    EXPECT_GT(foundRange(*matcher).end, 200) << "it would have";
}

TEST(HDPStereo_RangeSearch, a_video_keeps_its_range)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
    matcher->setUseTemporalPrediction(true);
    match(*matcher, scene().left, scene().right);
    const Range first = foundRange(*matcher);
    // The same with a little less noise, as the next frame is
    Mat left, right;
    cv::GaussianBlur(scene().left, left, Size(3, 3), 0.4);
    cv::GaussianBlur(scene().right, right, Size(3, 3), 0.4);
    match(*matcher, left, right);
    EXPECT_EQ(first, foundRange(*matcher));
    const Mat blank(left.size(), left.type(), Scalar::all(80));
    match(*matcher, blank, blank);
    EXPECT_EQ(first, foundRange(*matcher)) << "a frame in which nothing is found";
    expectRejected([&] { match(*matcher, blank.rowRange(0, 90), blank.rowRange(0, 90)); }, "numDisparities");
    match(*matcher, blank, blank);
    EXPECT_EQ(first, foundRange(*matcher)) << "what fails changes nothing";
    match(*matcher, left.colRange(100, left.cols), right.colRange(0, right.cols - 100));
    EXPECT_LT(foundRange(*matcher).start, -50) << "another size";
    matcher->clear();
    expectRejected([&] { match(*matcher, blank, blank); }, "numDisparities");
}

TEST(HDPStereo_RangeSearch, a_single_pair_ends_a_video)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
    const Mat &left = scene().left, &right = scene().right;
    match(*matcher, left, right);
    const Range alone = foundRange(*matcher);

    matcher->setUseTemporalPrediction(true);
    Mat moved; // by 12: a range that has the other one, too, and would be kept
    cv::copyMakeBorder(right.colRange(12, right.cols), moved, 0, 0, 0, 12, BORDER_REPLICATE);
    match(*matcher, left, moved);
    ASSERT_NE(alone, foundRange(*matcher));
    matcher->setUseTemporalPrediction(false);
    matcher->setNumDisparities(truthEnd);
    match(*matcher, left, right);
    matcher->setUseTemporalPrediction(true);
    matcher->setNumDisparities(0);
    match(*matcher, left, right);
    EXPECT_EQ(alone, foundRange(*matcher));

    // So does a frame whose range is known.
    matcher->clear();
    match(*matcher, left, moved);
    ASSERT_NE(alone, foundRange(*matcher));
    matcher->setNumDisparities(truthEnd);
    match(*matcher, left, right);
    matcher->setNumDisparities(0);
    match(*matcher, left, right);
    EXPECT_EQ(alone, foundRange(*matcher));
}

TEST(HDPStereo_RangeSearch, belongs_to_the_pair_model)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
    const Mat expected = match(*matcher, scene().left, scene().right);
    const Range found = foundRange(*matcher);
    const PairModel model = matcher->getPairModel();
    EXPECT_EQ(found, Range(model.minDisparity, model.minDisparity + model.numDisparities));

    const Ptr<HDPTreeMatcher> other = HDPTreeMatcher::create(0, 0);
    other->setPairModel(model);
    expectIdentical(expected, match(*other, scene().left, scene().right));
    const Mat blank(scene().left.size(), CV_8UC3, Scalar::all(80));
    EXPECT_NO_THROW(match(*other, blank, blank)) << "nothing is looked for";
    EXPECT_EQ(found, foundRange(*other));
}

//! Corners of a slanted surface
std::vector<CornerMatch> surface()
{
    std::vector<CornerMatch> matches;
    for (int y = 10; y < 100; y += 9)
        for (int x = 40; x < 160; x += 9)
            matches.push_back(matchAt(Point(x, y), 5 + 0.05 * x));
    return matches;
}

//! A slanted surface that comes nearer and has corners at its far end alone, before two that stand upright
TEST(HDPStereo_RangeSearch, goes_on_where_disparities_end_with_what_was_searched)
{
    const Size size(600, 300);
    const float nearest = 60;
    for (int seed = 1; seed <= 3; ++seed)
    {
        RNG rng(seed);
        Mat right(size, CV_32F), left, mapX(size, CV_32F), mapY(size, CV_32F);
        rng.fill(right, RNG::UNIFORM, -1, 1);
        cv::GaussianBlur(right, right, Size(), 1.2);
        right = right * 300 + 128;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const bool isSlanted = x > 380 && x < 500 && y > 100 && y < 200;
                const float behind = y > 150 ? 14.f : 10.f, before = 12 + (nearest - 12) * (float)(y - 100) / 100;
                mapX.at<float>(y, x) = (float)x - (isSlanted ? before : behind);
                mapY.at<float>(y, x) = (float)y;
            }
        cv::remap(right, left, mapX, mapY, INTER_LINEAR, BORDER_REFLECT);
        left.convertTo(left, CV_8U);
        right.convertTo(right, CV_8U);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
        match(*matcher, left, right);
        EXPECT_LE(foundRange(*matcher).start, 10);
        EXPECT_GT(foundRange(*matcher).end, nearest);
        EXPECT_LT(foundRange(*matcher).end, 2 * nearest);
    }
}

//! Its corners are few, and none of those of the wall is near its disparity.
TEST(HDPStereo_SlowRangeSearch, finds_a_bar_before_a_wall)
{
    const Size size(640, 480);
    for (const int width : { 8, 16, 32 })
        for (int seed = 1; seed <= 3; ++seed)
        {
            RNG rng(seed);
            Mat canvas(size + Size(100, 0), CV_32F), bar(canvas.size(), CV_32F);
            for (Mat* image : { &canvas, &bar })
            {
                rng.fill(*image, RNG::UNIFORM, -1, 1);
                cv::GaussianBlur(*image, *image, Size(), 1.5);
                image->convertTo(*image, CV_8U, 400, 128);
            }
            Mat left = canvas.colRange(0, size.width).clone(), right = canvas.colRange(10, 10 + size.width).clone();
            bar.colRange(0, width).rowRange(0, size.height).copyTo(left.colRange(330, 330 + width));
            bar.colRange(0, width).rowRange(0, size.height).copyTo(right.colRange(280, 280 + width));
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 0);
            match(*matcher, left, right);
            EXPECT_LE(foundRange(*matcher).start, 10) << width;
            EXPECT_GT(foundRange(*matcher).end, 50) << width;
            EXPECT_LT(foundRange(*matcher).end, 100) << width;
        }
}

TEST(HDPStereo_RangeSearch, single_corners_do_not_count)
{
    std::vector<CornerMatch> matches = surface();
    int support, withOthers;
    const Range range = hdp::supportedDisparities(matches, support);
    EXPECT_EQ((int)matches.size(), support);
    EXPECT_EQ(Range(7, 14), range);

    RNG rng(4);
    for (int i = 0; i < 12; ++i) // wrong ones, of all disparities
        matches.push_back(matchAt(Point(rng.uniform(40, 160), rng.uniform(10, 100)), i * 11 - 60.));
    EXPECT_EQ(range, hdp::supportedDisparities(matches, withOthers));
    EXPECT_EQ(support, withOthers);
    for (int i = 0; i < 4; ++i) // a thing in front
        matches.push_back(matchAt(Point(200 + 5 * (i % 2), 30 + 5 * (i / 2)), 44));
    EXPECT_EQ(Range(7, 45), hdp::supportedDisparities(matches, withOthers));
    EXPECT_EQ(support + 4, withOthers);
    for (CornerMatch& match : matches)
        match.isValid = false;
    EXPECT_EQ(Range(), hdp::supportedDisparities(matches, withOthers));
    EXPECT_EQ(0, withOthers);
}

TEST(HDPStereo_RangeSearch, corners_of_any_sign_that_match_both_ways)
{
    RNG rng(8);
    const Size size(200, 100);
    Mat canvas = patchyImage(rng, Size(size.width + 40, size.height), CV_8U);
    canvas.convertTo(canvas, CV_16U, 4);
    const Mat left = canvas.colRange(20, 20 + size.width);
    for (const int disparity : { -17, 0, 13 })
    {
        const Mat rightImage = canvas.colRange(20 + disparity, 20 + disparity + size.width);
        hdp::SearchWindows windows;
        std::vector<CornerMatch> matches;
        hdp::findCornerMatches(left, rightImage, hdp::PairMasks(), Range(-size.width, size.width), 4, windows, matches);
        int valid = 0, right = 0;
        for (const CornerMatch& match : matches)
        {
            valid += match.isValid;
            right += match.isValid && match.left.x - match.x == disparity;
        }
        EXPECT_GT(valid, 0.5 * matches.size());
        EXPECT_GT(right, 0.95 * valid);

        // Wrong ones, which lead back to another place
        std::vector<CornerMatch> mutual = matches;
        for (size_t i = 0; i < mutual.size(); i += 2)
            mutual[i].x = 20 + rng.uniform(0, size.width - 40);
        hdp::keepMutualMatches(left, rightImage, windows, mutual);
        int kept = 0;
        for (size_t i = 0; i < mutual.size(); ++i)
        {
            const double error = std::abs(mutual[i].left.x - mutual[i].x - disparity);
            if (error > 1)
                EXPECT_FALSE(mutual[i].isValid) << i;
            else
                kept += mutual[i].isValid;
        }
        EXPECT_GT(kept, 0.4 * right) << "of one half";
    }
}

}} // namespace opencv_test
