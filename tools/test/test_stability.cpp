// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Changes that must not matter, and what is counted of them: with a matcher whose maps are known.

#include "test_precomp.hpp"
#include "helpers.hpp"

#include "evaluation/stability.hpp"

namespace opencv_test { namespace {

using namespace hdp_tools;

//! Its map is in the left image: the levels are the disparities. The pixels of an area are off by 3, if a number of
//! disparities is searched.
class LevelMatcher : public StereoMatcher
{
public:
    LevelMatcher(Range disparities, int wrongNumber, Rect wrong)
        : disparities_(disparities), wrongNumber_(wrongNumber), wrong_(wrong)
    {
    }

    void compute(InputArray left, InputArray, OutputArray disparity) override
    {
        Mat levels, map;
        cv::extractChannel(left, levels, 0);
        levels.convertTo(map, CV_16S, 16);
        if (disparities_.size() == wrongNumber_)
            cv::add(map(wrong_), Scalar(3 * 16), map(wrong_));
        map.copyTo(disparity);
    }

    int getMinDisparity() const override { return disparities_.start; }
    void setMinDisparity(int) override {}
    int getNumDisparities() const override { return disparities_.size(); }
    void setNumDisparities(int) override {}
    int getBlockSize() const override { return 1; }
    void setBlockSize(int) override {}
    int getSpeckleWindowSize() const override { return 0; }
    void setSpeckleWindowSize(int) override {}
    int getSpeckleRange() const override { return 0; }
    void setSpeckleRange(int) override {}
    int getDisp12MaxDiff() const override { return 0; }
    void setDisp12MaxDiff(int) override {}

private:
    const Range disparities_;
    const int wrongNumber_;
    const Rect wrong_;
};

const Size size(48, 24);

Method levelMethod(int wrongNumber = -1, Rect wrong = Rect())
{
    return { "levels", String(), true, false, [=](Range disparities) -> Ptr<StereoMatcher> {
                return makePtr<LevelMatcher>(disparities, wrongNumber, wrong);
            } };
}

//! A background of 4 disparities, and a front of 8 in columns 20 .. 31 of the left image, 12 .. 23 of the right one
Pair makeLevelPair(bool hasRightTruth = true)
{
    Pair pair;
    pair.protocol = Pair::MIDDLEBURY;
    pair.disparities = Range(0, 16);
    pair.truth = Mat(size, CV_32F, Scalar(4));
    pair.truth.colRange(20, 32).setTo(8);
    Mat right(size, CV_32F, Scalar(4));
    right.colRange(12, 24).setTo(8);
    pair.judged = nonOccludedPixels(pair.truth, right);
    if (hasRightTruth)
        pair.rightTruth = right;
    for (Mat* map : { &pair.truth, &right })
    {
        Mat levels;
        map->convertTo(levels, CV_8U);
        cv::cvtColor(levels, map == &right ? pair.right : pair.left, COLOR_GRAY2BGR);
    }
    return pair;
}

HarmlessChange changeOf(const String& name) { return selectChanges("changes", name).at(0); }

TEST(HDPStereo_Stability, every_change_is_undone)
{
    const std::vector<HarmlessChange> changes = selectChanges(
        "changes", "clean,left1,left2,left4,left8,top1,top2,top4,move1,flip,mirror,range1,range16,bits12");
    for (const bool hasRightTruth : { true, false })
    {
        const Pair pair = makeLevelPair(hasRightTruth);
        // Columns 0 .. 3 leave the picture, 16 .. 19 are hidden by the front.
        ASSERT_EQ((48 - 8) * 24, countNonZero(pair.judged));
        const Stability stability = measureStability(levelMethod(), pair, changes, "scene");
        EXPECT_EQ(0, stability.cleanError);
        for (size_t i = 0; i < changes.size(); ++i)
        {
            EXPECT_EQ(changes[i].name == "bits12" ? 100 : 0, stability.errors[i]) << changes[i].name;
            EXPECT_EQ(0, stability.cleanErrors[i]) << changes[i].name;
            EXPECT_EQ(changes[i].name == "bits12" ? 100 : 0, stability.unstable[i]) << changes[i].name;
        }
    }
}

//! All 18 at once: none fails on a picture of the smallest sizes, or of 16 bits.
TEST(HDPStereo_Stability, all_changes)
{
    const std::vector<HarmlessChange> changes = selectChanges("changes", ALL_CHANGES);
    ASSERT_EQ(18u, changes.size());
    Pair pair;
    pair.disparities = Range(0, 16);
    for (int type : { CV_8UC3, CV_16UC1 })
    {
        pair.left = Mat(8, 12, type, Scalar::all(90));
        pair.right = Mat(8, 12, type, Scalar::all(100));
        pair.right.ptr()[0] = 0;
        for (const HarmlessChange& change : changes)
        {
            SCOPED_TRACE(change.name);
            const Mat left = pair.left.clone(), right = pair.right.clone();
            const Pair changed = changePair(change, pair, "scene"), again = changePair(change, pair, "scene");
            expectIdentical(changed.left, again.left);
            expectIdentical(changed.right, again.right);
            expectIdentical(left, pair.left); // the pair is as it was
            expectIdentical(right, pair.right);
            EXPECT_EQ(change.name == "bits12" ? CV_16UC1 : CV_8UC3, changed.left.type());
            EXPECT_EQ(changed.left.size(), changed.right.size());
            const Mat map(changed.left.size(), CV_32F, Scalar(5));
            EXPECT_EQ(pair.left.size(), restoreMap(change, map, pair.left.size()).size());
        }
    }
    EXPECT_EQ(Range(0, 17), changePair(changeOf("range1"), pair, "scene").disparities);
    EXPECT_EQ(Range(0, 32), changePair(changeOf("range16"), pair, "scene").disparities);
    EXPECT_EQ(Range(0, 16), changePair(changeOf("scale.98"), pair, "scene").disparities);
    pair.disparities = Range(-5, 100);
    EXPECT_EQ(Range(-3, 50), changePair(changeOf("scale.5"), pair, "scene").disparities);
    EXPECT_ANY_THROW(changePair(changeOf("left12"), pair, "scene"));
}

//! Another scene gets other noise.
TEST(HDPStereo_Stability, noise_by_the_name_of_the_scene)
{
    const Pair pair = makeLevelPair();
    const HarmlessChange noise = changeOf("noise.5");
    EXPECT_GT(cv::norm(changePair(noise, pair, "a").left, changePair(noise, pair, "b").left, NORM_INF), 0);
    EXPECT_GT(cv::norm(changePair(noise, pair, "a").left, pair.left, NORM_INF), 0);
    EXPECT_LT(cv::norm(changePair(noise, pair, "a").left, pair.left, NORM_INF), 5);
}

TEST(HDPStereo_Stability, pixels_that_are_kept)
{
    const Mat truth = Mat_<float>({ 1, 10 }, { 0, 3, 2, 3, 3, 4, 3, 6, NO_DISPARITY, 1 });
    // Cut off, or seen at column 0 or 1 of the right image; what leaves the picture has no say.
    expectIdentical(Mat_<uchar>({ 1, 10 }, { 0, 0, 0, 0, 0, 0, 255, 0, 255, 255 }),
                    keptPixels(changeOf("left2"), truth));
    const Mat down = Mat(3, 4, CV_32F, Scalar(2)), kept = keptPixels(changeOf("move1"), down);
    expectIdentical(Mat_<uchar>({ 3, 4 }, { 255, 255, 255, 0, 255, 255, 255, 0, 0, 0, 0, 0 }), kept);
    expectIdentical(Mat(3, 4, CV_8U, Scalar(255)), keptPixels(changeOf("flip"), down));
}

TEST(HDPStereo_Stability, maps_of_scaled_pairs)
{
    const Mat small = Mat_<float>({ 1, 2 }, { 3, NO_DISPARITY });
    expectIdentical(Mat_<float>({ 1, 4 }, { 6, 6, NO_DISPARITY, NO_DISPARITY }),
                    restoreMap(changeOf("scale.5"), small, Size(4, 1)));
    const Mat large = Mat_<float>({ 1, 4 }, { 2, 4, 6, 8 });
    expectIdentical(Mat_<float>({ 1, 2 }, { 2, 4 }), restoreMap(changeOf("scale2"), large, Size(2, 1)));
}

//! 5 columns and 2 rows of the background are off by 3 if 17 disparities are searched.
TEST(HDPStereo_Stability, counted_by_hand)
{
    const Rect area(34, 5, 5, 2); // columns 34 to 36 are within 4 of the step between 31 and 32
    const std::vector<HarmlessChange> changes = selectChanges("changes", "range1,range16");
    const double visible = 40 * 24;
    const Stability s = measureStability(levelMethod(17, area), makeLevelPair(), changes, "scene");
    EXPECT_EQ(0, s.cleanError);
    EXPECT_DOUBLE_EQ(100 * 10 / visible, s.errors[0]);
    EXPECT_EQ(0, s.errors[1]);
    EXPECT_EQ(0, s.worstChange());
    EXPECT_EQ(0, s.bistableChange());
    EXPECT_DOUBLE_EQ(100 * 10 / visible, s.unstable[0]);
    EXPECT_EQ(0, s.unstable[1]);
    EXPECT_DOUBLE_EQ(100 * 6 / visible / 2, s.edge);
    EXPECT_DOUBLE_EQ(100 * 4 / visible / 2, s.bare);
    EXPECT_DOUBLE_EQ(100 * 10 / visible / 2, s.inBlobs); // 10 of 1152 pixels
    EXPECT_EQ(0, s.occluded);

    // Two pixels are no blob, and no other map. Half of what is hidden is another share.
    const Stability small = measureStability(levelMethod(17, Rect(40, 5, 2, 1)), makeLevelPair(), changes, "scene");
    EXPECT_EQ(0, small.inBlobs);
    EXPECT_EQ(-1, small.bistableChange());
    const Stability hidden = measureStability(levelMethod(17, Rect(0, 0, 4, 24)), makeLevelPair(), changes, "scene");
    EXPECT_EQ(0, hidden.unstable[0]);
    EXPECT_DOUBLE_EQ(100. / 2 / 2, hidden.occluded);
}

TEST(HDPStereo_Stability, without_truth)
{
    Pair pair = makeLevelPair();
    pair.protocol = Pair::NO_TRUTH;
    pair.truth = pair.rightTruth = pair.judged = Mat();
    const Stability s =
        measureStability(levelMethod(17, Rect(34, 5, 5, 2)), pair, selectChanges("changes", "range1,mirror"), "scene");
    EXPECT_DOUBLE_EQ(100. * 10 / (40 * 24), s.unstable[0]); // the same pixels are visible
    EXPECT_EQ(0, s.unstable[1]);
    EXPECT_EQ(-1, s.worstChange());
    EXPECT_EQ(-1, s.bistableChange());
    for (double figure : { s.cleanError, s.errors[0], s.edge, s.occluded })
        EXPECT_TRUE(std::isnan(figure));
}

TEST(HDPStereo_Stability, bistable_by_hand)
{
    Stability s;
    s.cleanErrors = { 2, 2, 4, 0.5, NO_SCORE };
    s.errors = { 3, 2.9, 5.9, 0.1, NO_SCORE }; // 1.5 x, 0.9 points, 1.475 x, 0.4 points
    EXPECT_EQ(-1, s.bistableChange());
    EXPECT_EQ(2, s.worstChange());
    s.errors[2] = 2.5;
    EXPECT_EQ(2, s.bistableChange()); // a better one is another one, too
    s.errors[0] = 4;
    EXPECT_EQ(0, s.bistableChange());
    s.errors = { 3, 3.5, 5.9, 0, NO_SCORE };
    s.cleanErrors[3] = 1.5;
    EXPECT_EQ(3, s.bistableChange()); // from something to nothing
}

TEST(HDPStereo_Stability, confidence_by_hand)
{
    ConfidenceCounts counts, half;
    half.pixels[200] = 4;
    half.pixels[100] = 1;
    half.unstable[100] = 0.5;
    counts.add(half);
    counts.add(half);
    EXPECT_DOUBLE_EQ(10, counts.unstableShare(1));
    EXPECT_DOUBLE_EQ(0, counts.unstableShare(0.8));
    EXPECT_NEAR(100 * 0.5 / 9, counts.unstableShare(0.9), 1e-9);
    EXPECT_NEAR(-8 / (40 * 0.3), counts.correlation(), 1e-9); // covariance and standard deviations
    counts.unstable[100] = 0;
    EXPECT_TRUE(std::isnan(counts.correlation()));
    EXPECT_TRUE(std::isnan(ConfidenceCounts().unstableShare(0.8)));
}

TEST(HDPStereo_Stability, kinds_of_pixels)
{
    const float none = NO_DISPARITY;
    Mat truth(1, 40, CV_32F, Scalar(10)), expected = Mat::zeros(1, 40, CV_8U);
    // A step of 4 over two unknown pixels; one of 2 is none.
    truth.colRange(20, 40).setTo(14);
    truth.colRange(18, 20).setTo(none);
    truth.colRange(34, 40).setTo(16);
    expected.colRange(17 - 4, 20 + 5).setTo(255);
    expectIdentical(expected, edgePixels(truth));
    expectIdentical(expected.t(), edgePixels(truth.t()));
    // A slope of one disparity per pixel is none, either.
    for (int x = 0; x < 40; ++x)
        truth.at<float>(0, x) = x % 3 ? none : (float)x;
    EXPECT_EQ(0, countNonZero(edgePixels(truth)));

    Mat image(9, 60, CV_8UC3, Scalar::all(100));
    for (int x = 30; x < 60; x += 2)
        image.col(x).setTo(Scalar::all(103));
    const Mat bare = barePixels(image);
    EXPECT_EQ(9 * 30, countNonZero(bare.colRange(0, 30)));
    EXPECT_EQ(0, countNonZero(bare.colRange(34, 60)));

    Mat blobs = Mat::zeros(10, 100, CV_8U), large = blobs.clone();
    large(Rect(5, 5, 3, 1)).setTo(255);
    blobs(Rect(50, 5, 2, 1)).setTo(255);
    expectIdentical(large, largeBlobs(large | blobs, 0.002));
}

TEST(HDPStereo_Stability, right_view_by_hand)
{
    const float none = NO_DISPARITY;
    const Mat left = Mat_<float>({ 1, 6 }, { 1, 1, 2, 0, 3, none }), all(1, 6, CV_8U, Scalar(255)),
              warped = warpToRight(left, all);
    expectIdentical(Mat_<float>({ 1, 6 }, { 2, 3, none, 0, none, none }), warped); // the nearer one of two
}

}} // namespace opencv_test
