// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/forest/cost_volume.hpp"
#include "../src/pair/disparity_ranges.hpp"
#include "../src/scanlines/candidate_windows.hpp"

namespace opencv_test { namespace {

const float unlimited = std::numeric_limits<float>::quiet_NaN();

//! Limits around the truth and elsewhere, some of them no numbers, of the size of the images or coarser
void makeRanges(RNG& rng, const Mat& truth, Size size, Mat& smallest, Mat& largest)
{
    smallest.create(size, CV_32F);
    largest.create(size, CV_32F);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const float middle = truth.at<float>(y * truth.rows / size.height, x * truth.cols / size.width);
            const float half = rng.uniform(0, 120) / 10.f, off = rng.uniform(0, 10) ? 0.f : 20.f;
            smallest.at<float>(y, x) = rng.uniform(0, 20) ? middle - half + off : unlimited;
            largest.at<float>(y, x) = rng.uniform(0, 20) ? middle + half + off : unlimited;
        }
}

TEST(HDPStereo_DisparityRanges, an_empty_map_limits_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(160, 100), 30, 3);
    for (int type : { CV_16S, CV_32F })
    {
        const Mat none(10, 16, CV_32F, Scalar(unlimited)), limits(10, 16, type, Scalar(12));
        const Mat inFloats(10, 16, CV_32F, Scalar(12));
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 30), other = HDPTreeMatcher::create(0, 30);
        for (bool isSmallest : { false, true })
        {
            matcher->setDisparityRange(isSmallest ? limits : Mat(), isSmallest ? Mat() : limits);
            other->setDisparityRange(isSmallest ? inFloats : none, isSmallest ? none : inFloats);
            expectIdentical(match(*other, pair.left, pair.right).clone(), match(*matcher, pair.left, pair.right));
            // It does not say either which disparities there are.
            for (HDPTreeMatcher* const m : { matcher.get(), other.get() })
                m->setNumDisparities(0);
            expectIdentical(match(*other, pair.left, pair.right).clone(), match(*matcher, pair.left, pair.right));
            EXPECT_LT(matcher->getFindings().numDisparities, 100);
            for (HDPTreeMatcher* const m : { matcher.get(), other.get() })
                m->setNumDisparities(30);
        }
    }
}

TEST(HDPStereo_DisparityRanges, no_other_disparities_occur)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    for (const System& preset : presets)
        for (int minDisparity : { 0, -13, 4 })
            for (int depth : { CV_16S, CV_32F })
            {
                SCOPED_TRACE(testing::Message() << preset.name << ", from " << minDisparity << ", depth " << depth);
                RNG rng(7);
                Mat smallest, largest;
                const Size size = depth == CV_16S ? pair.left.size() : Size(50, 17);
                makeRanges(rng, pair.truth, size, smallest, largest);
                const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 41, minDisparity);
                matcher->setDisparityDepth(depth);
                matcher->setDisp12MaxDiff(minDisparity == 4 ? 1 : -1);
                matcher->setDisparityRange(smallest, largest);
                Mat disparity;
                match(*matcher, pair.left, pair.right).convertTo(disparity, CV_32F, depth == CV_16S ? 1. / 16 : 1);
                for (int y = 0; y < disparity.rows; ++y)
                    for (int x = 0; x < disparity.cols; ++x)
                    {
                        const Point coarse((int)((x + 0.5) * size.width / disparity.cols),
                                           (int)((y + 0.5) * size.height / disparity.rows));
                        const float d = disparity.at<float>(y, x), lowest = smallest.at<float>(coarse),
                                    highest = largest.at<float>(coarse);
                        if (d == minDisparity - 1)
                            continue;
                        ASSERT_FALSE(d < lowest || d > highest) << d << " in " << lowest << ".." << highest;
                        ASSERT_FALSE(d < minDisparity || d > minDisparity + 40);
                    }
                if (minDisparity != 4) // nothing is rejected but where there is no candidate
                {
                    Mat confidence;
                    matcher->getConfidence(confidence);
                    EXPECT_EQ(0, cv::countNonZero(confidence & (disparity == minDisparity - 1)));
                    EXPECT_LT(cv::countNonZero(disparity == minDisparity - 1), (int)disparity.total() / 4);
                }
            }
}

TEST(HDPStereo_DisparityRanges, of_all_disparities_are_none)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    const Mat lowest(1, 1, CV_16SC1, Scalar(-100)), highest(1, 1, CV_16SC1, Scalar(100));
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 40, -3);
        const Mat without = match(*matcher, pair.left, pair.right).clone();
        matcher->setDisparityRange(lowest, highest);
        expectIdentical(without, match(*matcher, pair.left, pair.right));
        matcher->setDisparityRange(Mat(1, 1, CV_32FC1, Scalar(unlimited)), Mat(1, 1, CV_32FC1, Scalar(unlimited)));
        expectIdentical(without, match(*matcher, pair.left, pair.right));
        matcher->setDisparityRange(Mat(1, 1, CV_32FC1, Scalar(7)), Mat(1, 1, CV_32FC1, Scalar(9)));
        EXPECT_NE(0, countDifferent(without, match(*matcher, pair.left, pair.right)));
        matcher->setDisparityRange(noArray(), noArray());
        expectIdentical(without, match(*matcher, pair.left, pair.right));
    }
}

//! What is made of ranges and of a prior is kept for the next pair, but not for one that needs something else.
TEST(HDPStereo_DisparityRanges, follow_what_changes)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3),
                        wide = makeSyntheticPair(Size(230, 120), 40, 4);
    const Mat none, lowest(12, 20, CV_32FC1, Scalar(5.4)), highest(12, 20, CV_32FC1, Scalar(20.6)),
        higher(12, 20, CV_32FC1, Scalar(70.6));
    Mat prior(pair.truth.size(), CV_32FC1, Scalar(unlimited));
    pair.truth(Rect(0, 0, 200, 60)).copyTo(prior(Rect(0, 0, 200, 60)));
    typedef HDPTreeMatcher::Params Params;
    Params quality(HDPTreeMatcher::PRESET_QUALITY), half(HDPTreeMatcher::PRESET_ULTRAFAST), whole,
        paper(HDPTreeMatcher::PRESET_PAPER), sums;
    whole.useSubpixel = paper.useSubpixel = false;
    sums.topAggregation = HDPTreeMatcher::AGGREGATION_TREES;
    const struct
    {
        const char* what;
        SyntheticPair pair;
        Params params;
        int minDisparity, numDisparities;
        Mat smallest, largest, prior;
    } steps[] = {
        { "first", pair, quality, 0, 40, lowest, highest, none },
        { "largest", pair, quality, 0, 40, lowest, higher, none },
        { "more layers", pair, Params(), 0, 40, lowest, higher, none },
        { "no candidates of the layer below", pair, sums, 0, 40, lowest, higher, none },
        { "and with these again", pair, Params(), 0, 40, lowest, higher, none },
        { "whole disparities", pair, whole, 0, 40, lowest, higher, none },
        { "no fractions of layers", pair, paper, 0, 40, lowest, higher, none },
        { "minDisparity", pair, paper, 1, 40, lowest, higher, none },
        { "minDisparity < 0", pair, paper, -8, 40, lowest, higher, none },
        { "numDisparities", pair, paper, -8, 33, lowest, higher, none },
        { "width", wide, paper, -8, 33, lowest, higher, none },
        { "height and width", { wide.left.t(), wide.right.t(), Mat(), Mat() }, paper, -8, 33, lowest, higher, none },
        { "a prior", pair, half, 0, 40, lowest, higher, prior },
        { "finest layer", pair, Params(), 0, 40, lowest, higher, prior },
        { "a prior alone", pair, Params(), 0, 40, none, none, prior },
        { "none", pair, Params(), 0, 40, none, none, none },
        { "first again", pair, quality, 0, 40, lowest, highest, none },
    };
    const Ptr<HDPTreeMatcher> kept = HDPTreeMatcher::create();
    Mat largest, lastPrior; // that it has
    for (const auto& step : steps)
    {
        SCOPED_TRACE(step.what);
        const Ptr<HDPTreeMatcher> fresh = HDPTreeMatcher::create();
        for (const Ptr<HDPTreeMatcher>& matcher : { kept, fresh })
        {
            matcher->setParams(step.params);
            matcher->setMinDisparity(step.minDisparity);
            matcher->setNumDisparities(step.numDisparities);
            if (matcher == fresh || step.largest.data != largest.data)
                matcher->setDisparityRange(step.smallest, step.largest);
            if (matcher == fresh || step.prior.data != lastPrior.data)
                matcher->setPriorDisparity(step.prior, 0.5);
        }
        largest = step.largest;
        lastPrior = step.prior;
        const Mat expected = match(*fresh, step.pair.left, step.pair.right).clone();
        expectIdentical(expected, match(*kept, step.pair.left, step.pair.right));
        expectIdentical(expected, match(*kept, step.pair.left, step.pair.right));
    }
}

//! With a range around the truth the map is nearer to it.
TEST(HDPStereo_DisparityRanges, improve_maps)
{
    const SyntheticPair pair = makeSyntheticPair(Size(240, 160), 48, 9);
    const Mat all(pair.left.size(), CV_8U, Scalar(255));
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 48);
        const double without = meanError(match(*matcher, pair.left, pair.right), pair.truth, all);
        matcher->setDisparityRange(pair.truth - 6, pair.truth + 6);
        EXPECT_LE(meanError(match(*matcher, pair.left, pair.right), pair.truth, all), 0.9 * without) << preset.name;
    }
}

//! Where the range of a pixel contradicts the images, the reports say so.
TEST(HDPStereo_DisparityRanges, what_is_moved_into_them_is_not_certain)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    Mat smallest(pair.truth.size(), CV_32F, Scalar(unlimited)), isAlone(smallest.size(), CV_8U, Scalar(0));
    for (int y = 5; y < smallest.rows; y += 10)
        for (int x = 45; x < smallest.cols; x += 10)
        {
            smallest.at<float>(y, x) = 36;
            isAlone.at<uchar>(y, x) = 255;
        }
    for (const System& preset : presets)
        for (const int minDisparity : { 0, -5 })
        {
            SCOPED_TRACE(testing::Message() << preset.name << " " << minDisparity);
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 48, minDisparity);
            Mat confidence, sigma, reasons, disparity;
            matcher->setDisparityRange(smallest, noArray());
            match(*matcher, pair.left, pair.right).convertTo(disparity, CV_32F, 1 / 16.);
            matcher->getConfidence(confidence);
            matcher->getDisparitySigma(sigma);
            matcher->getReasons(reasons);
            const Mat isMoved = reasons == HDPTreeMatcher::REASON_RANGE;
            EXPECT_EQ(0, countNonZero(isMoved & ~isAlone));
            EXPECT_GT(countNonZero(isMoved), 20);
            EXPECT_EQ(0, countNonZero(isMoved & (confidence > 0)));
            EXPECT_EQ(0, countNonZero(isMoved & (sigma < 1)));
            EXPECT_EQ(0, countNonZero(isMoved & (disparity != 36)));
        }
}

TEST(HDPStereo_DisparityRanges, bad_ranges_change_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(200, 120), 40, 3);
    const Mat lowest(10, 20, CV_32FC1, Scalar(5)), highest(10, 20, CV_32FC1, Scalar(20));
    for (const System& preset : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 40);
        matcher->setDisparityRange(lowest, highest);
        const Mat expected = match(*matcher, pair.left, pair.right).clone();
        for (int type : { CV_8UC1, CV_32SC1, CV_32FC2, CV_64FC1 })
            expectRejected([&] { matcher->setDisparityRange(Mat(10, 20, type, Scalar::all(1)), highest); },
                           "smallest must be CV_16SC1 or CV_32FC1");
        expectRejected([&] { matcher->setDisparityRange(lowest, highest.colRange(1, 20)); }, "largest must have");
        expectRejected([&] { matcher->setDisparityRange(highest, lowest); }, "largest must not be less than smallest");
        const Mat far = lowest + 2043, near = highest - 2068.1;
        expectRejected([&] { matcher->setDisparityRange(far, far); }, "smallest must be below 2048");
        expectRejected([&] { matcher->setDisparityRange(near, near); },
                       "largest at least -2048, as they are not in 200");
        expectIdentical(expected, match(*matcher, pair.left, pair.right));

        Mat disparity;
        const Mat large(121, 200, CV_16SC1, Scalar(3));
        matcher->setDisparityRange(large, large);
        expectRejected([&] { matcher->compute(pair.left, pair.right, disparity); }, "at most the size of the images");
        EXPECT_TRUE(disparity.empty());
        matcher->setDisparityRange(lowest, highest);
        expectIdentical(expected, match(*matcher, pair.left, pair.right));
    }
}

//! The documentation of buildIntervals(), pixel by pixel
TEST(HDPStereo_DisparityRanges, candidates_of_layers)
{
    RNG rng(4);
    for (int round = 0; round < 20; ++round)
    {
        const Size size(rng.uniform(8, 40), rng.uniform(8, 30));
        const int extension = rng.uniform(0, 3) * 8, minDisparity = rng.uniform(-20, 10);
        const std::vector<int> counts = { 33, 17, 9 };
        hdp::PixelRanges ranges;
        Mat smallest(size, CV_32F), largest(size, CV_32F);
        rng.fill(smallest, RNG::UNIFORM, minDisparity - 5, minDisparity + 40);
        rng.fill(largest, RNG::UNIFORM, 0, 20);
        largest += smallest;
        hdp::expandRanges(smallest, largest, size, Range(minDisparity, minDisparity + 32), round % 2 == 0, ranges);
        std::vector<Mat> units, intervals;
        hdp::buildIntervals(ranges, minDisparity, extension, counts, units, intervals);
        ASSERT_EQ(3u, intervals.size());
        for (int layer = 0; layer < 3; ++layer)
        {
            const int side = 1 << layer;
            ASSERT_EQ(Size((size.width + extension) >> layer, size.height >> layer), intervals[layer].size());
            for (int y = 0; y < intervals[layer].rows; ++y)
                for (int x = 0; x < intervals[layer].cols; ++x)
                {
                    double first = DBL_MAX, last = -1;
                    for (int i = 0; i < side * side; ++i)
                    {
                        const Point at(std::max(x * side + i % side - extension, 0), y * side + i / side);
                        const double lowest = ranges.smallest.at<short>(at) / 16. - minDisparity,
                                     highest = ranges.largest.at<short>(at) / 16. - minDisparity;
                        first = std::min(first, std::min(std::max(lowest, 0.), 32.));
                        last = std::max(last, std::min(std::max(highest, 0.), 32.));
                    }
                    const hdp::DisparityInterval& own = intervals[layer].ptr<hdp::DisparityInterval>(y)[x];
                    const int begin = std::min((int)std::floor(first / side), counts[layer] - 1);
                    ASSERT_EQ(begin, own.first);
                    ASSERT_EQ(std::min(std::max((int)std::ceil(last / side), begin), counts[layer] - 1), own.last);
                }
        }
    }
}

TEST(HDPStereo_DisparityRanges, candidates_of_half_a_pixel)
{
    const Mat intervals = (Mat_<Vec2w>(1, 5) << Vec2w(0, 0), Vec2w(2, 5), Vec2w(7, 9), Vec2w(8, 8), Vec2w(9, 9));
    const Mat expected = (Mat_<Vec2w>(1, 5) << Vec2w(0, 1), Vec2w(4, 11), Vec2w(14, 16), Vec2w(16, 16), Vec2w(16, 16));
    expectIdentical(expected, hdp::doubleIntervals(intervals, 17));
}

TEST(HDPStereo_DisparityRanges, windows_have_candidates_of_their_pixels)
{
    RNG rng(5);
    const int numDisparities = 60;
    const Size size(31, 17);
    Mat windows(Size(15, 8), CV_16UC4), intervals(size, CV_16UC2);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const int first = rng.uniform(0, numDisparities);
            const hdp::DisparityInterval own = { (ushort)first, (ushort)rng.uniform(first, numDisparities) };
            intervals.ptr<hdp::DisparityInterval>(y)[x] = own;
        }
    for (int y = 0; y < windows.rows; ++y)
        for (int x = 0; x < windows.cols; ++x)
        {
            hdp::CandidateWindow& window = windows.ptr<hdp::CandidateWindow>(y)[x];
            window.first[0] = (short)rng.uniform(-1, 30);
            window.first[1] = (short)(window.first[0] + rng.uniform(8, 20));
            for (int run = 0; run < 2; ++run)
                window.predicted[run] = (ushort)(16 * (window.first[run] + 3));
        }
    const Mat before = windows.clone();
    Mat hulls;
    hdp::halveIntervals(intervals, hulls);
    hdp::restrictWindows(hulls, numDisparities, windows);
    for (int y = 0; y < windows.rows; ++y)
        for (int x = 0; x < windows.cols; ++x)
        {
            const hdp::CandidateWindow &window = windows.ptr<hdp::CandidateWindow>(y)[x],
                                       &old = before.ptr<hdp::CandidateWindow>(y)[x];
            int first = INT_MAX, last = 0;
            for (int i = 0; i < 4; ++i)
            {
                const Point at(2 * x + i % 2, 2 * y + i / 2);
                first = std::min(first, (int)intervals.ptr<hdp::DisparityInterval>(at.y)[at.x].first);
                last = std::max(last, (int)intervals.ptr<hdp::DisparityInterval>(at.y)[at.x].last);
            }
            int used = 0, usedBefore = 0;
            for (int run = 0; run < 2; ++run)
            {
                used += window.first[run] <= last && window.first[run] + 7 >= first;
                usedBefore += old.first[run] <= last && old.first[run] + 7 >= first;
            }
            EXPECT_GE(used, 1);
            EXPECT_GE(window.first[0], -1);
            EXPECT_LE(window.first[1] + 7, numDisparities);
            EXPECT_GE(window.first[1], window.first[0] + 8);
            EXPECT_TRUE(usedBefore < 2 || std::memcmp(&window, &old, sizeof(window)) == 0);
        }
}

//! It moves no winner into its range that would not be there without it.
TEST(HDPStereo_DisparityRanges, a_prior_that_says_nothing_changes_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(240, 160), 48, 8);
    Mat smallest(pair.left.size(), CV_32F), largest;
    RNG rng(8);
    rng.fill(smallest, RNG::UNIFORM, 0, 30);
    largest = smallest + 12;
    for (const System& preset : presets)
    {
        if (preset.preset == HDPTreeMatcher::PRESET_PAPER)
            continue; // a prior needs the census
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 48);
        matcher->setDisparityRange(smallest, largest);
        const Mat expected = match(*matcher, pair.left, pair.right).clone();
        Mat prior(pair.left.size(), CV_32F, Scalar(unlimited));
        matcher->setPriorDisparity(prior, 0.5);
        expectIdentical(expected, match(*matcher, pair.left, pair.right));
    }
}

}} // namespace opencv_test
