// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "raw_pair.hpp"

#include "calibration_texts.hpp"
#include "helpers.hpp"

#include "opencv2/core/utils/filesystem.hpp"

namespace opencv_test { namespace {

struct Lens
{
    const char* name;
    int coefficients;
    bool isFisheye;
    double fieldOfView;
};

const Lens lenses[] = { { "pinhole4", 4, false, 0 },   { "pinhole5", 5, false, 0 },    { "pinhole8", 8, false, 0 },
                        { "pinhole12", 12, false, 0 }, { "pinhole14", 14, false, 0 },  { "pinhole_wide", 5, false, 75 },
                        { "fisheye", 4, true, 0 },     { "fisheye_wide", 4, true, 90 } };

void PrintTo(const Lens& lens, std::ostream* out) { *out << lens.name; }

StereoCalibration calibrationOf(const Lens& lens)
{
    StereoCalibration c = makeCalibration(lens.coefficients, lens.isFisheye);
    if (lens.isFisheye) // of 120 degrees
        for (Mat* matrix : { &c.cameraMatrix1, &c.cameraMatrix2 })
            *matrix = Mat(Matx33d(230, 0, 239, 0, 231, 180, 0, 0, 1), true);
    return c;
}

//! Pixels whose neighbours have the same surface, and that both images show
Mat innerPixels(const Mat& depth, const StereoRig& rig)
{
    Mat left, right, nearest, farthest;
    rig.getMasks(left, right);
    for (Mat* mask : { &left, &right })
        cv::erode(*mask, *mask, Mat::ones(9, 9, CV_8U), Point(-1, -1), 1, cv::BORDER_CONSTANT, Scalar(0));
    cv::erode(depth, nearest, Mat::ones(9, 9, CV_8U));
    cv::dilate(depth, farthest, Mat::ones(9, 9, CV_8U));
    Mat inner = left & (farthest < nearest * 1.1f) & (depth < 100);
    for (int y = 0; y < depth.rows; ++y)
        for (int x = 0; x < depth.cols; ++x)
        {
            const int matched = cvRound(x - rig.getFocalLength() * rig.getBaseline() / depth.at<float>(y, x));
            if (matched < 0 || !right.at<uchar>(y, matched))
                inner.at<uchar>(y, x) = 0;
        }
    return inner;
}

typedef testing::TestWithParam<Lens> HDPStereo_RigDepth;

TEST_P(HDPStereo_RigDepth, is_that_of_the_scene)
{
    const StereoCalibration c = calibrationOf(GetParam());
    const Ptr<StereoRig> rig = StereoRig::create(c, GetParam().fieldOfView);
    Mat R1, R2, P1, P2, Q;
    rig->getRectification(R1, R2, P1, P2, Q);
    EXPECT_NEAR(cvtest::norm(c.T, NORM_L2), rig->getBaseline(), 1e-9);
    EXPECT_NEAR(P1.at<double>(0, 0), rig->getFocalLength(), 1e-9);

    const double near = 0.7 * rig->getFocalLength() / 400; // a disparity of 68 pixels
    // A sphere before a slanted wall
    const RawScene scene(Vec3d(0.2, -0.1, 0.97), 1.8 * near, Vec3d(0.1, 0, 1.5 * near), 0.3 * near, near * 0.012);
    Mat left, right, disparity, depth;
    rig->rectify(scene.render(c, 0), scene.render(c, 1), left, right);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 80, HDPTreeMatcher::PRESET_QUALITY);
    matcher->setDisparityDepth(CV_32F);
    matcher->compute(left, right, disparity);
    rig->computeDepth(disparity, depth);

    const Mat truth = scene.depth(R1, P1, rig->getSize()), inner = innerPixels(truth, *rig);
    EXPECT_GT(cv::countNonZero(inner), 30000);
    Mat error;
    cv::divide(depth - truth, truth, error);
    cv::patchNaNs(error, 1); // no disparity
    EXPECT_NEAR(0, cv::mean(error, inner)[0], 0.001);
    EXPECT_GT(cv::countNonZero((cv::abs(error) < 0.005) & inner), 0.97 * cv::countNonZero(inner));

    Mat points, z;
    cv::reprojectImageTo3D(disparity, points, Q);
    cv::extractChannel(points, z, 2);
    EXPECT_LT(cvtest::norm(z, depth, NORM_INF, inner), 1e-4);
}

INSTANTIATE_TEST_CASE_P(Lenses, HDPStereo_RigDepth, testing::ValuesIn(lenses));

TEST(HDPStereo_StereoRig, sees_a_plane_at_two_metres)
{
    StereoCalibration c = makeCalibration();
    c.R = Mat::eye(3, 3, CV_64F);
    c.T = (Mat_<double>(3, 1) << -0.3, 0, 0);
    const Ptr<StereoRig> rig = StereoRig::create(c);
    const RawScene scene(Vec3d(0, 0, 1), 2, Vec3d(), 0, 0.012);
    Mat left, right, disparity, metres, millimetres, mask, rightMask;
    rig->rectify(scene.render(c, 0), scene.render(c, 1), left, right);
    rig->getMasks(mask, rightMask);
    HDPTreeMatcher::create(0, 96, HDPTreeMatcher::PRESET_QUALITY)->compute(left, right, disparity);
    rig->computeDepth(disparity, metres);
    rig->computeDepth(disparity, millimetres, CV_16U);
    const Rect inner(100, 10, 370, 340);

    EXPECT_NEAR(2, cv::mean(metres(inner))[0], 0.006); // 0.17 pixels of disparity: fractions tend to whole ones
    EXPECT_NEAR(2000, cv::mean(millimetres(inner))[0], 6);
    EXPECT_GT(cv::countNonZero(cv::abs(metres(inner) - 2) < 0.01), 0.99 * inner.area());
    EXPECT_EQ(0, cv::countNonZero(mask == 0)); // nothing is empty without a field of view
}

TEST(HDPStereo_StereoRig, masks_what_no_raw_pixel_reaches)
{
    for (const bool isFisheye : { false, true })
    {
        const StereoCalibration c = makeCalibration(isFisheye ? 4 : 5, isFisheye);
        const Ptr<StereoRig> rig = StereoRig::create(c, 100, Size(500, 300));
        const Mat white(c.imageSize, CV_8U, Scalar(255));
        Mat left, right, masks[2];
        rig->rectify(white, white, left, right);
        rig->getMasks(masks[0], masks[1]);
        expectIdentical(left, masks[0]);
        expectIdentical(right, masks[1]);
        EXPECT_EQ(Size(500, 300), left.size());
        EXPECT_EQ(0, left.at<uchar>(0, 0));
        EXPECT_EQ(255, left.at<uchar>(150, 250));
    }
}

//! A lens whose polynomial turns back at r = sqrt(1 / 0.9): it would show the picture's middle again.
TEST(HDPStereo_StereoRig, masks_where_the_distortion_folds_back)
{
    StereoCalibration c = makeCalibration(4);
    c.distCoeffs1 = c.distCoeffs2 = (Mat_<double>(1, 4) << -0.3, 0, 0, 0);
    Mat left, right, R1, R2, P1, P2, Q;
    const Ptr<StereoRig> rig = StereoRig::create(c, 160, Size(800, 600));
    rig->getMasks(left, right);
    rig->getRectification(R1, R2, P1, P2, Q);
    const Matx33d toCamera = Matx33d(R1).t() * Matx33d(Mat(P1.colRange(0, 3))).inv();
    for (int y = 0; y < left.rows; y += 7)
        for (int x = 0; x < left.cols; x += 7)
        {
            const Vec3d ray = toCamera * Vec3d(x, y, 1);
            const double u = ray[0] / ray[2], v = ray[1] / ray[2], square = u * u + v * v;
            const Vec3d raw = Matx33d(c.cameraMatrix1) * Vec3d(u * (1 - 0.3 * square), v * (1 - 0.3 * square), 1);
            const bool isInside = Rect(1, 1, 478, 358).contains(Point(cvRound(raw[0]), cvRound(raw[1])));
            EXPECT_FALSE((square > 1.12 || ray[2] < 0) && left.at<uchar>(y, x)) << x << ", " << y;
            EXPECT_FALSE(square < 1.1 && ray[2] > 0 && isInside && !left.at<uchar>(y, x)) << x << ", " << y;
        }
}

TEST(HDPStereo_StereoRig, shows_all_of_a_lens_that_does_not_fold_back)
{
    StereoCalibration c = makeCalibration(4, true);
    c.cameraMatrix1 = c.cameraMatrix2 = (Mat_<double>(3, 3) << 150, 0, 240, 0, 150, 180, 0, 0, 1);
    c.distCoeffs1 = c.distCoeffs2 = Mat::zeros(1, 4, CV_64F);
    Mat left, right;
    StereoRig::create(c, 170, Size(800, 100))->getMasks(left, right); // the raw image is of 180 degrees
    EXPECT_EQ(left.total(), (size_t)cv::countNonZero(left));
    EXPECT_EQ(right.total(), (size_t)cv::countNonZero(right));
}

TEST(HDPStereo_StereoRig, rectifies_all_types_of_images)
{
    const StereoCalibration c = makeCalibration();
    const Ptr<StereoRig> rig = StereoRig::create(c);
    RNG rng(5);
    Mat smoothed = randomImage(rng, c.imageSize, CV_8UC1), grey, ignored;
    cv::GaussianBlur(smoothed, smoothed, Size(), 3);
    rig->rectify(smoothed, smoothed, grey, ignored);
    for (const int type : { CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_32FC1 })
    {
        Mat image, result;
        cv::merge(std::vector<Mat>(CV_MAT_CN(type), smoothed), image);
        image.convertTo(image, CV_MAT_DEPTH(type));
        rig->rectify(image, image, result, ignored);
        ASSERT_EQ(type, result.type());
        Mat channel;
        cv::extractChannel(result, channel, 0);
        channel.convertTo(channel, CV_8U);
        EXPECT_LE(cvtest::norm(grey, channel, NORM_INF), 1);
    }
    Mat same = smoothed.clone(); // in place
    rig->rectify(same, same, same, ignored);
    expectIdentical(grey, same);
}

TEST(HDPStereo_StereoRig, rectifies_the_largest_images)
{
    StereoCalibration c = makeCalibration();
    c.imageSize.width = 32766;
    const Mat row(c.imageSize, CV_8U, Scalar(1));
    for (const Size& size : { Size(32766, 3), Size(3, 32766) })
    {
        Mat left, right;
        StereoRig::create(c, 90, size)->rectify(row, row, left, right);
        EXPECT_EQ(size, left.size());
    }
}

TEST(HDPStereo_StereoRig, computes_depth_of_what_has_a_disparity)
{
    const Ptr<StereoRig> rig = StereoRig::create(makeCalibration());
    const double product = rig->getBaseline() * rig->getFocalLength();
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const Mat pixels = (Mat_<float>(1, 8) << 16, 0.5f, 0, -1, nan, inf, 1e-38f, 1e-30f);
    const Mat whole = (Mat_<short>(1, 4) << 256, 8, 0, -16);
    Mat depth;
    rig->computeDepth(pixels, depth);
    ASSERT_EQ(CV_32FC1, depth.type());
    EXPECT_FLOAT_EQ((float)(product / 16), depth.at<float>(0));
    EXPECT_FLOAT_EQ((float)(product / 0.5), depth.at<float>(1));
    for (int i = 2; i < 7; ++i)
        EXPECT_TRUE(cvIsNaN(depth.at<float>(i))) << i;
    EXPECT_FLOAT_EQ((float)(product / 1e-30f), depth.at<float>(7));
    rig->computeDepth(whole, depth, CV_16U);
    ASSERT_EQ(CV_16UC1, depth.type());
    EXPECT_EQ(cvRound(1000 * product / 16), depth.at<ushort>(0));
    EXPECT_EQ(product / 0.5 > 65.535 ? 0 : cvRound(2000 * product), depth.at<ushort>(1));
    EXPECT_EQ(0, depth.at<ushort>(2));
    EXPECT_EQ(0, depth.at<ushort>(3));
    rig->computeDepth(whole, depth, CV_16U, 17);
    EXPECT_EQ(0, depth.at<ushort>(0));
}

//! The type of the output says nothing: depthType does.
TEST(HDPStereo_StereoRig, depth_of_a_fixed_type)
{
    const Ptr<StereoRig> rig = StereoRig::create(makeCalibration());
    const Mat pixels(4, 5, CV_32F, Scalar(16)), small(2, 5, CV_32F);
    Mat_<ushort> millimetres;
    Mat_<float> metres;
    expectRejected([&] { rig->computeDepth(pixels, millimetres); }, "depth must be CV_32FC1, not CV_16UC1");
    expectRejected([&] { rig->computeDepth(pixels, metres, CV_16U); }, "depth must be CV_16UC1, not CV_32FC1");
    EXPECT_TRUE(millimetres.empty() && metres.empty());
    expectRejected([&] { rig->computeDepth(pixels, noArray()); }, "depth must be an array, not noArray()");
    expectRejected([&] { rig->computeDepth(pixels, small); }, "depth must have 5 x 4 pixels, not 5 x 2");
    rig->computeDepth(pixels, millimetres, CV_16U);
    rig->computeDepth(pixels, metres);
    EXPECT_NEAR(1000 * metres(3, 4), millimetres(3, 4), 0.51);
}

TEST(HDPStereo_StereoRig, results_in_place)
{
    const Ptr<StereoRig> rig = StereoRig::create(makeCalibration(), 40, Size(150, 110));
    const Mat raw(rig->getCalibration().imageSize, CV_8UC3, Scalar(50, 90, 130)), whole(4, 5, CV_16S, Scalar(256));
    Mat expected, other, depth;
    rig->rectify(raw, raw, expected, other);
    rig->computeDepth(whole, depth);
    UMat left, right, inPlace;
    raw.copyTo(left);
    raw.copyTo(right);
    whole.copyTo(inPlace);
    rig->rectify(left, right, left, right);
    rig->computeDepth(inPlace, inPlace);
    expectIdentical(expected, left.getMat(ACCESS_READ));
    expectIdentical(other, right.getMat(ACCESS_READ));
    expectIdentical(depth, inPlace.getMat(ACCESS_READ));

    // Both images or none
    Mat first;
    Mat_<float> ofOtherType;
    expectRejected([&] { rig->rectify(raw, raw, first, noArray()); }, "rectifiedRight must be an array, not noArray()");
    expectRejected([&] { rig->rectify(raw, raw, first, ofOtherType); }, "rectifiedRight must be CV_8UC3, not CV_32FC1");
    EXPECT_TRUE(first.empty());
}

TEST(HDPStereo_StereoRig, results_that_are_not_wanted)
{
    const Ptr<StereoRig> rig = StereoRig::create(makeCalibration(), 100);
    Mat R1, R2, P1, P2, Q, left, right, alone;
    rig->getRectification(R1, R2, P1, P2, Q);
    rig->getRectification(noArray(), noArray(), noArray(), noArray(), alone);
    expectIdentical(Q, alone);
    rig->getRectification(noArray(), noArray(), noArray(), alone, noArray());
    expectIdentical(P2, alone);
    rig->getMasks(left, right);
    rig->getMasks(noArray(), alone);
    expectIdentical(right, alone);
}

TEST(HDPStereo_StereoRig, refuses_what_is_impossible)
{
    const StereoCalibration good = makeCalibration();
    const auto expectBad = [&](const std::function<void(StereoCalibration&)>& change, const std::string& name) {
        StereoCalibration c = makeCalibration();
        change(c);
        expectRejected([&] { StereoRig::create(c); }, name);
    };
    expectBad([](StereoCalibration& c) { c = StereoCalibration(); }, "imageSize");
    expectBad([](StereoCalibration& c) { c.cameraMatrix1.release(); }, "cameraMatrix1");
    expectBad([](StereoCalibration& c) { c.cameraMatrix2.at<double>(1, 0) = 1; }, "cameraMatrix2");
    expectBad([](StereoCalibration& c) { c.distCoeffs1 = Mat::zeros(1, 6, CV_64F); }, "distCoeffs1");
    expectBad([](StereoCalibration& c) { c.isFisheye = true; }, "distCoeffs1");
    expectBad([](StereoCalibration& c) { c.distCoeffs2.at<double>(2) = std::nan(""); }, "distCoeffs2");
    expectBad([](StereoCalibration& c) { c.R.at<double>(1, 1) = -1; }, "R must be a rotation");
    expectBad([](StereoCalibration& c) { c.T.release(); }, "T ");
    for (const double angle : { -1., 0.5, 171., std::nan("") })
        expectRejected([&] { StereoRig::create(good, angle); }, "fieldOfView");
    for (const Size& size : { Size(0, 5), Size(32767, 1), Size(1, 32767) })
        expectRejected([&] { StereoRig::create(good, 0, size); }, "size");
    expectBad([](StereoCalibration& c) { c.imageSize.width = 32767; }, "imageSize");
    const auto turn = [](int axis, double degrees, StereoCalibration& c) {
        Vec3d angles;
        angles[axis] = degrees * CV_PI / 180;
        Rodrigues(angles, c.R);
        c.T = -c.R * (Mat_<double>(3, 1) << 0.1, 0, 0);
    };
    for (const double degrees : { 95., 180. })
        expectBad([&](StereoCalibration& c) { turn(2, degrees, c); }, "side by side");
    const auto movePrincipalPoints = [&](StereoCalibration& c) { // of lenses without distortion
        turn(0, 0, c);
        c.cameraMatrix1.at<double>(0, 2) = 0;
        c.cameraMatrix2.at<double>(0, 2) = c.imageSize.width;
        c.distCoeffs1 = c.distCoeffs2 = Mat::zeros(1, 5, CV_64F);
    };
    expectBad(movePrincipalPoints, "principal points");
    for (const double degrees : { 120., 179. })
        expectBad([&](StereoCalibration& c) { turn(1, degrees, c); }, "same direction");

    const Ptr<StereoRig> rig = StereoRig::create(good);
    const Mat image(good.imageSize, CV_8U, Scalar(1)), other(10, 10, CV_8U), deep(good.imageSize, CV_64F);
    Mat a, b;
    expectRejected([&] { rig->rectify(Mat(), image, a, b); }, "left");
    expectRejected([&] { rig->rectify(image, other, a, b); }, "right");
    expectRejected([&] { rig->rectify(deep, deep, a, b); }, "left");
    expectRejected([&] { rig->rectify(image, Mat(good.imageSize, CV_8UC3), a, b); }, "one type");
    EXPECT_TRUE(a.empty() && b.empty());
    expectRejected([&] { rig->computeDepth(image, a); }, "disparity");
    expectRejected([&] { rig->computeDepth(Mat(5, 5, CV_32F), a, CV_8U); }, "depthType");
    expectRejected([&] { rig->computeDepth(Mat(), a); }, "disparity");
    expectRejected([&] { rig->computeDepth(Mat(good.imageSize + Size(1, 0), CV_32F), a); }, "disparity must be of");
    expectRejected([&] { rig->computeDepth(Mat(0, 0, CV_32F), a); }, "disparity");
}

//! The pairs of a drone in HDPSTEREO_DATA/raw_euroc: two cameras that were calibrated once
TEST(HDPStereo_StereoRig, brings_rows_of_a_real_rig_together)
{
    const char* const data = std::getenv("HDPSTEREO_DATA");
    const std::string folder = std::string(data ? data : "") + "/raw_euroc/";
    std::vector<String> names;
    if (data && cv::utils::fs::exists(folder))
        cv::glob(folder + "left/*.png", names);
    if (names.empty())
        throw SkipTestException("HDPSTEREO_DATA does not name a folder with raw_euroc");
    const Ptr<StereoRig> rig =
        StereoRig::create(readStereoCalibration(folder + "cam0_sensor.yaml", folder + "cam1_sensor.yaml"));
    EXPECT_NEAR(0.11, rig->getBaseline(), 0.001);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 64);
    for (const String& name : names)
    {
        String other = name;
        other.replace(name.rfind("/left/"), 6, "/right/");
        Mat left, right, disparity;
        rig->rectify(cv::imread(name, IMREAD_GRAYSCALE), cv::imread(other, IMREAD_GRAYSCALE), left, right);
        matcher->compute(left, right, disparity);
        const std::vector<double> m = matcher->getFindings().rows;
        double squares = 0;
        for (int i = 0; i < 64; ++i)
        {
            const double u = (i % 8 - 3.5) / 8 * left.cols, v = (i / 8 - 3.5) / 8 * left.rows;
            squares += std::pow(m[0] + m[1] * u + m[2] * v + m[3] * u * v + m[4] * v * v, 2) / 64;
        }
        EXPECT_LT(std::sqrt(squares), 0.2) << name << Mat(m);
        EXPECT_NE(0, m[0]);
    }
}

}} // namespace opencv_test
