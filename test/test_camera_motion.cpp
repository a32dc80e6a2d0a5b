// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_video.hpp"
#include "../src/video/camera_motion.hpp"

namespace opencv_test { namespace {

using namespace cv::stereo::hdp;

const Size imageSize(600, 400);

//! A rigid motion of cameras with this focal length and baseline, in pixels and disparities; rotation: about the axes
Matx44d rigidMotion(const Vec3d& rotation, const Vec3d& translation, double focal, double baseline)
{
    const Vec3d c(std::cos(rotation[0]), std::cos(rotation[1]), std::cos(rotation[2])),
        s(std::sin(rotation[0]), std::sin(rotation[1]), std::sin(rotation[2]));
    const Matx33d r = Matx33d(1, 0, 0, 0, c[0], -s[0], 0, s[0], c[0]) *
                      Matx33d(c[1], 0, s[1], 0, 1, 0, -s[1], 0, c[1]) * Matx33d(c[2], -s[2], 0, s[2], c[2], 0, 0, 0, 1);
    const double cx = imageSize.width / 2., cy = imageSize.height / 2.;
    const Matx44d toSpace(1, 0, 0, -cx, 0, 1, 0, -cy, 0, 0, 0, focal, 0, 0, 1 / baseline, 0); // reprojectImageTo3D()
    const Matx44d moved(r(0, 0), r(0, 1), r(0, 2), translation[0], r(1, 0), r(1, 1), r(1, 2), translation[1], r(2, 0),
                        r(2, 1), r(2, 2), translation[2], 0, 0, 0, 1);
    return toSpace.inv() * moved * toSpace;
}

Vec3d project(const Matx44d& motion, const Vec3d& p)
{
    const Vec4d moved = motion * Vec4d(p[0], p[1], p[2], 1);
    return Vec3d(moved[0], moved[1], moved[2]) * (1 / moved[3]);
}

//! Random points, of which some move by themselves
std::vector<TrackedPoint> randomPoints(const Matx44d& motion, int count, double outliers, double noise, RNG& rng)
{
    std::vector<TrackedPoint> points(count);
    for (TrackedPoint& point : points)
    {
        const double x = rng.uniform(0., 600.), y = rng.uniform(0., 400.), d = rng.uniform(1., 60.);
        const Vec3d now = project(motion, Vec3d(x, y, d));
        point.before = Point2d(x, y);
        point.disparity = d;
        point.now = Point2d(now[0] + rng.gaussian(noise), now[1] + rng.gaussian(noise));
        if (rng.uniform(0., 1.) < outliers)
            point.now += Point2d(rng.uniform(-30., 30.), rng.uniform(-30., 30.));
    }
    return points;
}

//! The motion is that of the points, and takes disparities to what they are in the next frame.
TEST(HDPStereo_CameraMotion, rigid_motions)
{
    RNG rng(41);
    for (int i = 0; i < 20; ++i)
    {
        const double focal = rng.uniform(300., 900.), baseline = rng.uniform(0.1, 0.6), step = 0.3 * baseline;
        const Vec3d rotation(rng.uniform(-.02, .02), rng.uniform(-.03, .03), rng.uniform(-.02, .02));
        const Vec3d translation(rng.uniform(-step, step), rng.uniform(-step, step), rng.uniform(-step, step));
        const Matx44d motion = rigidMotion(rotation, translation, focal, baseline);
        const CameraMotion found = fitMotion(randomPoints(motion, 300, 0.3, 0.1, rng), imageSize, 4);
        ASSERT_FALSE(found.isStill);
        for (int k = 0; k < 50; ++k)
        {
            const double x = rng.uniform(50., 550.), y = rng.uniform(50., 350.), d = rng.uniform(5., 50.);
            const Vec3d expected = project(motion, Vec3d(x, y, d)), actual = project(found.forward, Vec3d(x, y, d));
            EXPECT_LE(cv::norm(expected - actual), 0.5) << "pair " << i << " at " << Vec3d(x, y, d);
        }
    }
}

TEST(HDPStereo_CameraMotion, camera_at_rest)
{
    RNG rng(42);
    EXPECT_TRUE(fitMotion(randomPoints(Matx44d::eye(), 300, 0.4, 0.1, rng), imageSize, 4).isStill);
    EXPECT_TRUE(fitMotion(randomPoints(Matx44d::eye(), 300, 0.9, 0.1, rng), imageSize, 4).isStill);
    EXPECT_TRUE(fitMotion(randomPoints(Matx44d::eye(), 5, 0, 0.1, rng), imageSize, 4).isStill);
    EXPECT_TRUE(fitMotion(std::vector<TrackedPoint>(), imageSize, 4).isStill);
}

TEST(HDPStereo_CameraMotion, points_without_a_motion)
{
    std::vector<TrackedPoint> points(100);
    for (TrackedPoint& point : points) // all at one place
    {
        point.before = point.now = Point2d(100, 100);
        point.disparity = 10;
    }
    EXPECT_TRUE(fitMotion(points, imageSize, 4).isStill);
}

//! Back from where a motion leads is where it came from.
TEST(HDPStereo_CameraMotion, backward)
{
    RNG rng(44);
    const double minDisparity = -3;
    CameraMotion motion;
    motion.forward = rigidMotion(Vec3d(.01, .02, -.01), Vec3d(.05, -.02, .1), 500, 0.4);
    const BackwardMotion backward(motion, minDisparity, 100);
    for (int i = 0; i < 200; ++i)
    {
        const int x = rng.uniform(0, 600), y = rng.uniform(0, 400);
        const double now = rng.uniform(5., 60.);
        const Vec3d before = project(motion.forward.inv(), Vec3d(x, y, now + minDisparity));
        const Point2f place = backward.placeBefore(x, y, (float)now);
        EXPECT_NEAR(before[0], place.x, 1e-2);
        EXPECT_NEAR(before[1], place.y, 1e-2);
        const DisparityChange& change = backward.change;
        EXPECT_NEAR(now, change.now((float)(before[2] - minDisparity), x, y), 1e-3);
    }
}

//! A third of the measured disparities are anything.
TEST(HDPStereo_CameraMotion, corrected)
{
    RNG rng(45);
    const double minDisparity = -3, factor = 1.008, offset = -0.3;
    CameraMotion motion;
    motion.forward = rigidMotion(Vec3d(.01, .02, -.01), Vec3d(.05, -.02, .1), 500, 0.4);
    const DisparityChange before = BackwardMotion(motion, minDisparity, 100).change;
    std::vector<float> predicted, measured;
    for (int i = 0; i < 600; ++i)
    {
        predicted.push_back((float)rng.uniform(1., 60.));
        const double now = factor * (predicted.back() + minDisparity) + offset - minDisparity + rng.gaussian(0.2);
        measured.push_back((float)(i % 3 ? now : rng.uniform(0., 60.)));
    }
    const DisparityChange change = correctedChange(before, predicted, measured);
    for (int i = 0; i < 50; ++i)
    {
        const int x = rng.uniform(0, 600), y = rng.uniform(0, 400);
        const float d = rng.uniform(8.f, 50.f);
        const double uncorrected = before.now(d, x, y) + minDisparity;
        EXPECT_NEAR(factor * uncorrected + offset - minDisparity, change.now(d, x, y), 0.1);
    }

    const DisparityChange same = correctedChange(before, std::vector<float>(), std::vector<float>());
    EXPECT_EQ(before.now(20, 300, 200), same.now(20, 300, 200));
}

TEST(HDPStereo_CameraMotion, scaled)
{
    const Matx44d motion = rigidMotion(Vec3d(.01, .02, -.01), Vec3d(.05, -.02, .1), 500, 0.4);
    CameraMotion half;
    half.forward = motion;
    half.isStill = false;
    // Pixel (x, y) of half the size is around (2 x + 1 / 2, 2 y + 1 / 2).
    const Vec3d p(123, 77, 20), now = project(motion, p);
    const Vec3d whole = project(scaled(half, 2).forward, Vec3d(2 * p[0] + .5, 2 * p[1] + .5, 2 * p[2]));
    EXPECT_LE(cv::norm(whole - Vec3d(2 * now[0] + .5, 2 * now[1] + .5, 2 * now[2])), 1e-6);
    EXPECT_TRUE(scaled(CameraMotion(), 2).isStill);
}

std::vector<Mat> pyramidOf(const Mat& image)
{
    std::vector<Mat> pyramid(1, image);
    while ((int)pyramid.size() < trackingLevels(image.size()))
    {
        Mat half;
        cv::resize(pyramid.back(), half, Size(pyramid.back().cols / 2, pyramid.back().rows / 2), 0, 0, INTER_AREA);
        pyramid.push_back(half);
    }
    return pyramid;
}

TEST(HDPStereo_CameraMotion, tracks_points)
{
    RNG rng(43);
    const Mat image = patchyImage(rng, Size(700, 460), CV_8UC1, 9);
    for (const Point shift : { Point(0, 0), Point(7, -3), Point(-25, 18), Point(28, 20) })
    {
        SCOPED_TRACE(cv::format("(%d, %d)", shift.x, shift.y));
        const Rect area(50, 35, 600, 400);
        std::vector<TrackedPoint> points;
        const std::vector<Mat> before = pyramidOf(image(area).clone()), now = pyramidOf(image(area - shift).clone());
        choosePoints(before, points);
        trackPoints(before, now, hdp::FROM_BEFORE, points);
        EXPECT_GE((int)points.size(), 200);
        int right = 0;
        for (const TrackedPoint& point : points)
            right += cv::norm(point.now - point.before - Point2d(shift)) <= 0.5;
        EXPECT_GE(right, 0.75 * points.size());

        CameraMotion near; // four pixels beside the right one
        near.forward(0, 3) = shift.x + 4;
        near.forward(1, 3) = shift.y - 4;
        movePoints(near, now[0].size(), points);
        trackPoints(before, now, hdp::FROM_GUESS, points);
        int again = 0;
        for (const TrackedPoint& point : points)
            again += cv::norm(point.now - point.before - Point2d(shift)) <= 0.5;
        EXPECT_GE(again, 0.75 * points.size());
    }
}

TEST(HDPStereo_CameraMotion, tracks_nothing_without_texture)
{
    std::vector<TrackedPoint> points;
    const std::vector<Mat> flat = pyramidOf(Mat(400, 600, CV_8U, Scalar(90)));
    choosePoints(flat, points);
    EXPECT_TRUE(points.empty());
    const std::vector<Mat> tiny(1, Mat(1, 1, CV_8U, Scalar(9)));
    choosePoints(tiny, points);
    EXPECT_TRUE(points.empty());
}

}} // namespace opencv_test
