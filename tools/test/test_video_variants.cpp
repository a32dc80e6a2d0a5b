// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"

#include "evaluation/video_variants.hpp"

namespace opencv_test { namespace {

using namespace hdp_tools;

std::vector<int> indicesOf(const String& name, int frames)
{
    std::vector<int> indices;
    const VideoVariant variant = selectVariants(name, frames).at(0);
    for (const VariantFrame& frame : variant.frames)
        indices.push_back(frame.index);
    return indices;
}

TEST(HDPStereo_VideoVariants, orders)
{
    EXPECT_EQ((std::vector<int>{ 0, 1, 2, 3 }), indicesOf("recorded", 4));
    EXPECT_EQ((std::vector<int>{ 0, 3, 6 }), indicesOf("every3", 7));
    EXPECT_EQ((std::vector<int>{ 3, 2, 1, 0 }), indicesOf("reversed", 4));
    EXPECT_EQ((std::vector<int>{ 0, 0, 0, 1, 1, 1 }), indicesOf("three-times", 2));
    EXPECT_EQ((std::vector<int>{ 0, 1, 2, 3, 9, 5, 6, 7, 8, 4 }), indicesOf("foreign", 10));
    std::vector<int> random = indicesOf("random", 9);
    EXPECT_EQ(random, indicesOf("random", 9));
    EXPECT_FALSE(std::is_sorted(random.begin(), random.end()));
    std::sort(random.begin(), random.end());
    EXPECT_EQ(indicesOf("recorded", 9), random);
    EXPECT_EQ(14u, selectVariants("", 5).size());
}

//! One pixel of each row tells which row it was.
Pair rowsPair()
{
    Pair pair;
    pair.left.create(20, 3, CV_8UC3);
    pair.truth.create(20, 3, CV_32F);
    pair.judged = Mat(20, 3, CV_8U, Scalar(255));
    for (int y = 0; y < 20; ++y)
    {
        pair.left.row(y).setTo(Scalar::all(10 * y));
        pair.truth.row(y).setTo(Scalar(y));
    }
    pair.right = pair.left.clone();
    return pair;
}

Pair changed(const String& name, int index)
{
    Pair pair = rowsPair();
    RNG rng(1);
    changeFrame(selectVariants(name, 11).at(0).frames.at(index), rng, pair);
    return pair;
}

void expectRows(const Pair& pair, int rows, int rightRows)
{
    for (int y = 0; y < 20; ++y)
    {
        EXPECT_EQ(10 * std::max(y - rows, 0), pair.left.at<Vec3b>(y, 1)[1]) << y;
        EXPECT_EQ(10 * std::max(y - rows - rightRows, 0), pair.right.at<Vec3b>(y, 1)[1]) << y;
        EXPECT_EQ(y < rows ? NO_DISPARITY : (float)(y - rows), pair.truth.at<float>(y, 1)) << y;
        EXPECT_EQ(y < rows ? 0 : 255, pair.judged.at<uchar>(y, 1)) << y;
    }
}

TEST(HDPStereo_VideoVariants, changes)
{
    expectRows(changed("recorded", 3), 0, 0);
    expectRows(changed("shake6", 2), 0, 0);
    expectRows(changed("shake6", 3), 6, 0);
    expectRows(changed("rows3", 3), 0, 3);
    EXPECT_EQ(70, changed("exposure.7", 1).left.at<Vec3b>(10, 0)[0]);
    EXPECT_EQ(0, countNonZero(changed("fade", 5).right.reshape(1)));
    EXPECT_EQ(100, changed("fade", 10).right.at<Vec3b>(10, 0)[0]);
    const Pair foreign = changed("foreign", 4);
    EXPECT_EQ(190, foreign.left.at<Vec3b>(0, 0)[0]);
    EXPECT_EQ(19.f, foreign.truth.at<float>(0, 0));
    Mat noise;
    absdiff(changed("noise15", 2).left, rowsPair().left, noise);
    EXPECT_GT(cv::mean(noise)[0], 6);
    EXPECT_EQ(0, cv::norm(changed("noise15", 1).left, rowsPair().left));
}

TEST(HDPStereo_VideoVariants, a_camera_that_pans_sees_parts_of_one_size)
{
    const std::vector<VariantFrame> left = panOver(7, Size(30, 20), Point(-4, 2), 4);
    ASSERT_EQ(4u, left.size());
    for (int i = 0; i < 4; ++i)
    {
        EXPECT_EQ(7, left[i].index);
        EXPECT_EQ(Rect(12 - 4 * i, 2 * i, 18, 14), left[i].part);
    }
    EXPECT_EQ(Rect(0, 0, 30, 20), panOver(0, Size(30, 20), Point(), 3)[2].part) << "stands still";

    Pair pair = rowsPair();
    RNG rng(1);
    VariantFrame frame;
    frame.part = Rect(1, 2, 2, 10);
    changeFrame(frame, rng, pair);
    for (const Mat& map : { pair.left, pair.right, pair.truth, pair.judged })
        ASSERT_EQ(Size(2, 10), map.size());
    EXPECT_EQ(20, pair.left.at<Vec3b>(0, 0)[0]);
    EXPECT_EQ(110, pair.right.at<Vec3b>(9, 1)[0]);
    EXPECT_EQ(2.f, pair.truth.at<float>(0, 0));
    EXPECT_EQ(0, countNonZero(pair.judged)) << "the part of the right image does not show disparities above 1";
    frame.part = Rect(0, 0, 3, 3);
    Pair first = rowsPair();
    changeFrame(frame, rng, first);
    EXPECT_EQ(3 + 2 + 1, countNonZero(first.judged)) << "disparities 0, 1, 2 in three columns";
}

}} // namespace opencv_test
