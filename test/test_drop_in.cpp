// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The matcher in the place of cv::StereoSGBM: what OpenCV's samples and filters do with its disparities. (OpenCV's two
// samples stereo_match themselves are run by scripts/check_drop_in.sh.)

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"

#include <map>

#ifdef HDPSTEREO_TEST_XIMGPROC
#include "opencv2/ximgproc/disparity_filter.hpp"
#endif

namespace opencv_test { namespace {

const int minDisparity = 2, numDisparities = 32;
const double focal = 250, baseline = 0.5;

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(203, 121), 30, 3);
    return pair;
}

//! What a program has that may use either matcher, with the filters that stereo_match.cpp turns on
Ptr<cv::StereoMatcher> createMatcher(bool filters)
{
    Ptr<cv::StereoMatcher> matcher = HDPTreeMatcher::create(minDisparity, numDisparities);
    matcher->setBlockSize(5);
    if (filters)
    {
        matcher->setDisp12MaxDiff(1);
        matcher->setSpeckleWindowSize(100);
        matcher->setSpeckleRange(32);
    }
    return matcher;
}

//! Q of two cameras as cv::stereoRectify makes it
Matx44d rectify(Size size)
{
    const Matx33d camera(focal, 0, 0.5 * size.width, 0, focal, 0.5 * size.height, 0, 0, 1);
    const Mat none = Mat::zeros(1, 5, CV_64F);
    Mat R1, R2, P1, P2, Q;
    cv::stereoRectify(camera, none, camera, none, size, Mat::eye(3, 3, CV_64F), Vec3d(-baseline, 0, 0), R1, R2, P1, P2,
                      Q);
    EXPECT_NEAR(focal, P1.at<double>(0, 0), 1e-3 * focal);
    return Matx44d(Q.ptr<double>());
}

//! Each block size that cv::StereoSGBM takes, which counts 0 as 5 and an even one as the next larger one, in every preset
TEST(HDPStereo_DropIn, block_sizes)
{
    const SyntheticPair pair = makeSyntheticPair(Size(73, 41), 12, 8);
    for (const System& system : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16, system.preset);
        const auto mapOf = [&](int blockSize) {
            matcher->setBlockSize(blockSize);
            return match(*matcher, pair.left, pair.right).clone();
        };
        const bool isCensus = matcher->getParams().matchingCost == HDPTreeMatcher::COST_CENSUS;
        std::map<int, Mat> maps;
        for (int side : { 1, 3, 5, 7, 9, 31 })
            maps[side] = mapOf(side);
        for (int blockSize :
             { INT_MIN, -1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 15, 21, 30, 31, 33, 51, 255, INT_MAX })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", blockSize " << blockSize);
            cv::StereoSGBM::create(0, 16)->setBlockSize(blockSize); // takes all
            const Mat map = mapOf(blockSize);
            EXPECT_EQ(blockSize, matcher->getBlockSize());
            const int odd = blockSize <= 0 ? 5 : blockSize % 2 == 0 ? blockSize + 1 : blockSize;
            const int side = isCensus ? std::min(std::max(odd, 3), 7) : std::min(odd, 31);
            if (maps.count(side))
                expectIdentical(maps[side], map);
            else
                EXPECT_GT(cv::countNonZero(map), map.size().area() / 2);
        }
        EXPECT_GT(cv::norm(maps[3], maps[5], NORM_L1), 0) << system.name;
        EXPECT_GT(cv::norm(maps[5], maps[7], NORM_L1), 0) << system.name;
    }
}

//! What a cv::StereoSGBM is set to where both have a parameter; the rest is the preset's.
TEST(HDPStereo_DropIn, matcher_like_a_cv_StereoSGBM)
{
    const Ptr<StereoSGBM> sgbm = StereoSGBM::create(-7, 48, 5, 8 * 3 * 25, 32 * 3 * 25, 2, 63, 10, 100, 3);
    for (const System& system : presets)
    {
        const Ptr<HDPTreeMatcher> expected = HDPTreeMatcher::create(-7, 48, system.preset);
        expected->setDisp12MaxDiff(2);
        expected->setSpeckleWindowSize(100);
        expected->setSpeckleRange(3);
        EXPECT_EQ(serialized(*expected), serialized(*HDPTreeMatcher::createLike(sgbm, system.preset)));
    }
    sgbm->setSpeckleRange(-1);
    EXPECT_EQ(0, HDPTreeMatcher::createLike(sgbm)->getSpeckleRange());
    EXPECT_EQ(7, HDPTreeMatcher::createLike(sgbm)->getBlockSize());
    sgbm->setNumDisparities(0);
    expectRejected([&] { HDPTreeMatcher::createLike(sgbm); }, "numDisparities");
}

TEST(HDPStereo_DropIn, from_a_rectified_pair_to_points)
{
    const SyntheticPair& pair = testPair();
    const Size size = pair.left.size();
    const Mat disparity16 = match(*createMatcher(true), pair.left, pair.right);
    Mat disparity, points;
    disparity16.convertTo(disparity, CV_32F, 1. / StereoMatcher::DISP_SCALE);
    cv::reprojectImageTo3D(disparity, points, rectify(size));

    int count = 0, near = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            if (disparity.at<float>(y, x) < minDisparity)
                continue;
            ++count;
            const Vec3f point = points.at<Vec3f>(y, x);
            const double depth = focal * baseline / disparity.at<float>(y, x);
            const double trueDepth = focal * baseline / pair.truth.at<float>(y, x);
            ASSERT_NEAR(depth, point[2], 2e-3 * depth);
            ASSERT_NEAR(x, focal * point[0] / point[2] + 0.5 * size.width, 1.);
            ASSERT_NEAR(y, focal * point[1] / point[2] + 0.5 * size.height, 1.);
            near += std::abs(point[2] - trueDepth) < 0.1 * trueDepth;
        }
    EXPECT_GT(count, 0.7 * size.area());
    EXPECT_LT(count, size.area());
    EXPECT_GT(near, 0.85 * count);
}

//! reprojectImageTo3D() puts what the filters rejected, (minDisparity - 1) * 16, to Z = 10000 if it is told to.
TEST(HDPStereo_DropIn, missing_values_of_reprojectImageTo3D)
{
    const SyntheticPair& pair = testPair();
    const Mat disparity = match(*createMatcher(true), pair.left, pair.right);
    const Mat invalid = disparity == (minDisparity - 1) * 16;
    double smallest = 0;
    cv::minMaxLoc(disparity, &smallest);
    EXPECT_EQ((minDisparity - 1) * 16, smallest);

    Mat points;
    cv::reprojectImageTo3D(disparity, points, rectify(pair.left.size()), true);
    for (int y = 0; y < points.rows; ++y)
        for (int x = 0; x < points.cols; ++x)
            ASSERT_EQ(invalid.at<uchar>(y, x) != 0, points.at<Vec3f>(y, x)[2] == 10000.f) << x << ", " << y;
}

TEST(HDPStereo_DropIn, valid_range)
{
    const SyntheticPair& pair = testPair();
    const Rect whole(Point(), pair.left.size());
    const Ptr<cv::StereoMatcher> matcher = createMatcher(false);
    const Mat disparity = match(*matcher, pair.left, pair.right);

    // Every pixel has a disparity within the range, also those that getValidDisparityROI() leaves out.
    EXPECT_TRUE(
        cv::checkRange(disparity, true, nullptr, minDisparity * 16, (minDisparity + numDisparities - 1) * 16 + 1));
    const Rect roi =
        cv::getValidDisparityROI(whole, whole, minDisparity, numDisparities, matcher->getBlockSize()) & whole;
    ASSERT_GT(roi.area(), whole.area() / 2);
    EXPECT_LT(badPixels(disparity(roi), pair.truth(roi), pair.visible(roi), 1), 10.);

    // The check between left and right that OpenCV has as a function is the one that setDisp12MaxDiff() turns on.
    matcher->setDisp12MaxDiff(1);
    const Mat checked = match(*matcher, pair.left, pair.right);
    Mat validated = disparity.clone();
    cv::validateDisparity(validated, Mat::zeros(disparity.size(), CV_16S), minDisparity, numDisparities, 1);
    const int different = countDifferent(checked == (minDisparity - 1) * 16, validated == (minDisparity - 1) * 16);
    EXPECT_LT(different, 0.12 * disparity.total()); // 0.101
}

#include <map>

#ifdef HDPSTEREO_TEST_XIMGPROC
//! The filter's result for the disparities of both images, and the confidence that it has in them
Mat filterByWLS(const Mat& left, const Mat& right, bool useConfidence, Mat& confidence)
{
    const Ptr<ximgproc::DisparityWLSFilter> filter = ximgproc::createDisparityWLSFilterGeneric(useConfidence);
    filter->setLambda(8000);
    filter->setSigmaColor(1.5);
    Mat filtered;
    filter->filter(left, testPair().left, filtered, right);
    if (useConfidence)
        confidence = filter->getConfidenceMap();
    return filtered;
}

TEST(HDPStereo_DropIn, weighted_least_squares_filter_of_ximgproc)
{
    const SyntheticPair& pair = testPair();
    // The right image's disparities: the images are swapped, and so is the sign.
    const int rightMinDisparity = -(minDisparity + numDisparities) + 1;
    const Mat left = match(*createMatcher(false), pair.left, pair.right);
    const Mat right = match(*HDPTreeMatcher::create(rightMinDisparity, numDisparities), pair.right, pair.left);
    const int P1 = 8 * 3 * 25, P2 = 32 * 3 * 25;
    const Mat leftSGBM = match(*StereoSGBM::create(minDisparity, numDisparities, 5, P1, P2), pair.left, pair.right);
    const Mat rightSGBM =
        match(*StereoSGBM::create(rightMinDisparity, numDisparities, 5, P1, P2), pair.right, pair.left);

    for (bool useConfidence : { false, true })
    {
        SCOPED_TRACE(testing::Message() << "use_confidence " << useConfidence);
        Mat confidence, confidenceSGBM;
        const Mat filtered = filterByWLS(left, right, useConfidence, confidence);
        const Mat filteredSGBM = filterByWLS(leftSGBM, rightSGBM, useConfidence, confidenceSGBM);
        ASSERT_EQ(left.type(), filtered.type());
        ASSERT_EQ(left.size(), filtered.size());
        EXPECT_GT(countDifferent(left, filtered), (int)left.total() / 10);
        // What it makes of these disparities is better than what it makes of those of StereoSGBM, which have a border.
        EXPECT_LT(meanError(filtered, pair.truth, pair.visible), 1.);
        EXPECT_LT(badPixels(filtered, pair.truth, pair.visible, 2),
                  badPixels(filteredSGBM, pair.truth, pair.visible, 2));
        EXPECT_LT(meanError(filtered, pair.truth, pair.visible), meanError(filteredSGBM, pair.truth, pair.visible));
        if (useConfidence)
        {
            // It compares the two, and so knows what only the left image shows.
            ASSERT_EQ(left.size(), confidence.size());
            EXPECT_GT(cv::mean(confidence, pair.visible)[0], cv::mean(confidence, ~pair.visible)[0] + 50);
        }
    }
}
#else
TEST(HDPStereo_DropIn, weighted_least_squares_filter_of_ximgproc)
{
    throw SkipTestException("built without opencv_ximgproc");
}
#endif

}} // namespace opencv_test
