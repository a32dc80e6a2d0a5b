// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "raw_pair.hpp"

#include "calibration_texts.hpp"
#include "helpers.hpp"

#include "opencv2/core/utils/filesystem.hpp"

namespace opencv_test { namespace {

const double degree = CV_PI / 180;

//! Pitch up, yaw to the right, roll clockwise, in degrees: from points of the camera before to those of it now. The
//! camera's axes are turned one after the other, which is another rotation than RigDrift's, by their product.
Matx33d turnOf(double pitch, double yaw, double roll)
{
    const auto cosine = [](double a) { return std::cos(a * degree); };
    const auto sine = [](double a) { return std::sin(a * degree); };
    const Matx33d up(1, 0, 0, 0, cosine(pitch), sine(pitch), 0, -sine(pitch), cosine(pitch));
    const Matx33d right(cosine(yaw), 0, -sine(yaw), 0, 1, 0, sine(yaw), 0, cosine(yaw));
    const Matx33d clockwise(cosine(roll), sine(roll), 0, -sine(roll), cosine(roll), 0, 0, 0, 1);
    return clockwise * right * up;
}

const Size size(640, 480);
const Matx33d K(520, 0, 325, 0, 520, 236, 0, 0, 1);

//! Findings::rows of points as a turned camera sees them: least squares over the image
std::vector<double> rowsOf(const Matx33d& turn, double growth = 0)
{
    Mat A, b;
    for (int i = 0; i < 400; ++i)
    {
        const double x = (i % 20 + 0.5) / 20 * size.width, y = (i / 20 + 0.5) / 20 * size.height;
        const Vec3d seen = turn * K.inv() * Vec3d(x, y, 1);
        const double nowX = K(0, 0) * seen[0] / seen[2] * (1 + growth) + K(0, 2),
                     nowY = K(1, 1) * seen[1] / seen[2] * (1 + growth) + K(1, 2);
        const double u = nowX - 0.5 * (size.width - 1), v = y - 0.5 * (size.height - 1);
        A.push_back(Mat(Matx<double, 1, 5>(1, u, v, u * v, v * v), true));
        b.push_back(nowY - y);
    }
    Mat m;
    cv::solve(A, b, m, DECOMP_SVD);
    return std::vector<double>(m.begin<double>(), m.end<double>());
}

std::vector<double> estimate(const RigDrift& drift, std::vector<double>* deviations = 0)
{
    std::vector<double> values, all;
    drift.getEstimate(values, all);
    if (deviations)
        *deviations = all;
    return values;
}

TEST(HDPStereo_RigDrift, finds_a_turn_from_its_rows)
{
    for (const Vec4d& turn : { Vec4d(0.02, 0, 0, 0), Vec4d(0, 0, -0.02, 0), Vec4d(0.5, 0, 0, 0),
                               Vec4d(-0.5, 0.5, 0.5, 0), Vec4d(0.1, -0.3, -0.2, 0.4), Vec4d(0, 0, 0.3, -1) })
    {
        const Ptr<RigDrift> drift = RigDrift::create(K, size);
        ASSERT_TRUE(drift->add(rowsOf(turnOf(turn[0], turn[1], turn[2]), turn[3] / 100)));
        const std::vector<double> found = estimate(*drift);
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(turn[i], found[i], i == 1 ? 0.03 : 0.006) << turn << " " << i;
    }
}

TEST(HDPStereo_RigDrift, knows_what_it_does_not_know)
{
    std::vector<double> deviations;
    const Ptr<RigDrift> drift = RigDrift::create(K, size);
    EXPECT_EQ(std::vector<double>(4, 0.), estimate(*drift, &deviations));
    EXPECT_EQ(std::vector<double>(4, std::numeric_limits<double>::infinity()), deviations);
    EXPECT_EQ(0, cvtest::norm(drift->getRotation(), Mat::eye(3, 3, CV_64F), NORM_INF));
    EXPECT_FALSE(drift->add(std::vector<double>(5))); // too few corners were matched
    EXPECT_EQ(0, drift->getFrames());

    // Rows that differ by 0.05 pixels from frame to frame
    RNG rng(3);
    std::vector<double> rows = rowsOf(turnOf(0.1, 0, 0)), before;
    for (int i = 0; i < 40; ++i)
    {
        std::vector<double> noisy = rows;
        noisy[0] += rng.gaussian(0.05);
        noisy[1] += rng.gaussian(0.05 / 200);
        ASSERT_TRUE(drift->add(noisy));
        if (i == 0)
            estimate(*drift, &before);
    }
    const std::vector<double> found = estimate(*drift, &deviations);
    EXPECT_EQ(40, drift->getFrames());
    EXPECT_NEAR(0.1, found[0], 3 * deviations[0]);
    EXPECT_NEAR(0, found[2], 3 * deviations[2]);
    EXPECT_LT(deviations[0], before[0]);
    EXPECT_LT(deviations[0], 0.005);
    EXPECT_GT(deviations[1], 0.02); // yaw remains unknown
    EXPECT_GT(deviations[1], 8 * deviations[0]);
}

TEST(HDPStereo_RigDrift, forgets_after_a_knock)
{
    const Ptr<RigDrift> drift = RigDrift::create(K, size, 10);
    for (int i = 0; i < 20; ++i)
        EXPECT_TRUE(drift->add(rowsOf(turnOf(0.1, 0, 0))));
    for (int i = 0; i < 4; ++i)
        EXPECT_FALSE(drift->add(rowsOf(turnOf(-0.4, 0, 0))));
    EXPECT_NEAR(0.1, estimate(*drift)[0], 0.005);
    EXPECT_TRUE(drift->add(rowsOf(turnOf(0.1, 0, 0)))); // it was none
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(i == 4, drift->add(rowsOf(turnOf(-0.4, 0, 0))));
    EXPECT_NEAR(-0.4, estimate(*drift)[0], 0.005);
    EXPECT_EQ(1, drift->getFrames());
    for (int i = 0; i < 60; ++i) // slowly enough, it follows
        drift->add(rowsOf(turnOf(-0.4 + 0.001 * i, 0, 0)));
    EXPECT_NEAR(-0.35, estimate(*drift)[0], 0.02);
}

TEST(HDPStereo_RigDrift, refuses_what_is_no_rig_and_no_rows)
{
    expectRejected([] { RigDrift::create(Mat(), size); }, "P2");
    expectRejected([] { RigDrift::create(Matx33d(), size); }, "P2");
    expectRejected([] { RigDrift::create(K, Size(5, 5)); }, "imageSize");
    expectRejected([] { RigDrift::create(K, size, 0); }, "memory");
    const Ptr<RigDrift> drift = RigDrift::create(K, size);
    expectRejected([&] { drift->add(std::vector<double>(4)); }, "rows");
    expectRejected([&] { drift->add(std::vector<double>(5, std::nan(""))); }, "rows");
    for (int term = 0; term < 5; ++term) // of which each would be a rig that folds
    {
        std::vector<double> rows(5);
        rows[term] = 200;
        expectRejected([&] { drift->add(rows); }, "a quarter of the image's height");
    }
    EXPECT_EQ(0, drift->getFrames());
    for (const Mat& bad : { Mat(), Mat(Mat::zeros(3, 3, CV_64F)), Mat(Mat::eye(4, 3, CV_64F)) })
        expectRejected([&] { drift->correct(makeCalibration(), bad); }, "R2 must be a rotation");
    expectRejected([&] { drift->correct(StereoCalibration(), Mat::eye(3, 3, CV_64F)); }, "calibration");
}

//! R and T may be parts of a larger matrix, such as a pose.
TEST(HDPStereo_RigDrift, corrects_parts_of_matrices)
{
    const Ptr<RigDrift> drift = RigDrift::create(K, size);
    drift->add(rowsOf(turnOf(0.5, 0, 0.3)));
    const StereoCalibration c = makeCalibration();
    StereoCalibration parts = c;
    const Mat pose = poseOf(c.R, c.T), R2 = Mat::eye(3, 3, CV_64F);
    parts.R = pose(Rect(0, 0, 3, 3));
    parts.T = pose(Rect(3, 0, 1, 3));
    const StereoCalibration expected = drift->correct(c, R2), corrected = drift->correct(parts, R2);
    EXPECT_EQ(0, cvtest::norm(expected.R, corrected.R, NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.T, corrected.T, NORM_INF));
}

struct Turn
{
    double pitch, yaw, roll;
};

void PrintTo(const Turn& turn, std::ostream* out) { *out << turn.pitch << ", " << turn.yaw << ", " << turn.roll; }

typedef testing::TestWithParam<Turn> HDPStereo_SlowRigDrift;

double rootOfSquares(const std::vector<double>& m, Size imageSize)
{
    double squares = 0;
    for (int i = 0; i < 64; ++i)
    {
        const double u = (i % 8 - 3.5) / 8 * imageSize.width, v = (i / 8 - 3.5) / 8 * imageSize.height;
        squares += std::pow(m[0] + m[1] * u + m[2] * v + m[3] * u * v + m[4] * v * v, 2) / 64;
    }
    return std::sqrt(squares);
}

TEST_P(HDPStereo_SlowRigDrift, is_found_in_twenty_noisy_frames)
{
    const StereoCalibration asCalibrated = makeCalibration();
    const Ptr<StereoRig> rig = StereoRig::create(asCalibrated);
    Mat R1, R2, P1, P2, Q;
    rig->getRectification(R1, R2, P1, P2, Q);
    // The right camera as it is now, turned in rectified coordinates
    const Turn& turn = GetParam();
    const Matx33d turned = Matx33d(R2).t() * turnOf(turn.pitch, turn.yaw, turn.roll) * Matx33d(R2);
    StereoCalibration now = asCalibrated;
    now.R = Mat(turned * Matx33d(asCalibrated.R), true);
    now.T = Mat(turned * Vec3d(asCalibrated.T.ptr<double>()), true);

    const Ptr<RigDrift> drift = RigDrift::create(P2, rig->getSize());
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(-16, 96, HDPTreeMatcher::PRESET_ULTRAFAST);
    const int frames = 20;
    RNG rng(7);
    const auto rowsOfFrame = [&](const StereoRig& by, int frame) {
        const double distance = 0.9 + 0.15 * (frame % 7);
        const RawScene scene(Vec3d(0.05 * (frame % 5 - 2), 0.1 * (frame % 3 - 1), 1), distance,
                             Vec3d(0.1 * (frame % 4 - 2), 0, 0.9 * distance), 0.2, 0.01 + 0.0003 * frame);
        Mat raw[2], left, right, disparity;
        for (int i = 0; i < 2; ++i)
        {
            Mat noise(asCalibrated.imageSize, CV_16S), noisy;
            rng.fill(noise, RNG::NORMAL, 0, 2);
            scene.render(now, i).convertTo(noisy, CV_16S);
            Mat(noisy + noise).convertTo(raw[i], CV_8U);
        }
        by.rectify(raw[0], raw[1], left, right);
        matcher->compute(left, right, disparity);
        return matcher->getFindings().rows;
    };
    for (int i = 0; i < frames; ++i)
        drift->add(rowsOfFrame(*rig, i));
    EXPECT_GE(drift->getFrames(), frames - 2);
    std::vector<double> deviations;
    const std::vector<double> found = estimate(*drift, &deviations);
    EXPECT_NEAR(turn.pitch, found[0], 0.01);
    EXPECT_NEAR(turn.roll, found[2], 0.01);
    EXPECT_NEAR(turn.yaw, found[1], 4 * deviations[1]);
    EXPECT_LT(std::max(deviations[0], deviations[2]), 0.01);
    EXPECT_GT(deviations[1], 0.03); // a pixel of disparity is 0.14 degrees

    const Ptr<StereoRig> corrected = StereoRig::create(drift->correct(asCalibrated, R2));
    EXPECT_LT(rootOfSquares(rowsOfFrame(*corrected, 3), rig->getSize()), 0.1);
}

INSTANTIATE_TEST_CASE_P(Turns, HDPStereo_SlowRigDrift,
                        testing::Values(Turn{ 0.02, 0, -0.02 }, Turn{ -0.5, 0, 0.3 }, Turn{ 0.2, 0.5, -0.5 }));

//! The scenes of HDPSTEREO_DATA/rows_off, whose rows are off by one to three pixels: from a pair to a rig that fits
TEST(HDPStereo_RigDrift, corrects_real_rigs)
{
    const char* const data = std::getenv("HDPSTEREO_DATA");
    const std::string folder = std::string(data ? data : "") + "/rows_off/";
    if (!data || !cv::utils::fs::exists(folder))
        throw SkipTestException("HDPSTEREO_DATA does not name a folder with rows_off");
    const struct
    {
        const char* scene;
        double focalLength, centerX, centerY, baseline;
        int numDisparities;
    } scenes[] = { { "artroom1", 1733.74, 792.27, 541.89, 0.53662, 170 },
                   { "chess1", 1758.23, 953.34, 552.29, 0.11153, 290 },
                   { "octogons1", 1742.11, 804.90, 541.22, 0.22176, 100 },
                   { "podium1", 1746.24, 14.88, 534.11, 0.67837, 310 } };
    for (const auto& scene : scenes)
    {
        SCOPED_TRACE(scene.scene);
        const Mat left = cv::imread(folder + scene.scene + "/left.png");
        const Mat right = cv::imread(folder + scene.scene + "/right.png");
        const double f = scene.focalLength;
        StereoCalibration c;
        c.imageSize = left.size();
        c.cameraMatrix1 = Mat(Matx33d(f, 0, scene.centerX, 0, f, scene.centerY, 0, 0, 1), true);
        c.cameraMatrix2 = c.cameraMatrix1.clone();
        c.distCoeffs1 = c.distCoeffs2 = Mat::zeros(1, 4, CV_64F);
        c.R = Mat::eye(3, 3, CV_64F);
        c.T = (Mat_<double>(3, 1) << -scene.baseline, 0, 0);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, scene.numDisparities);
        Mat disparity, rectifiedLeft, rectifiedRight;
        for (int step = 0; step < 3; ++step) // each measures what the one before has left
        {
            const Ptr<StereoRig> rig = StereoRig::create(c);
            Mat R1, R2, P1, P2, Q;
            rig->getRectification(R1, R2, P1, P2, Q);
            rig->rectify(left, right, rectifiedLeft, rectifiedRight);
            matcher->compute(rectifiedLeft, rectifiedRight, disparity);
            const std::vector<double> rows = matcher->getFindings().rows;
            const double off = rootOfSquares(rows, c.imageSize);
            if (step == 0)
                EXPECT_GT(off, 0.5);
            else
                EXPECT_LT(off, step == 1 ? 0.2 : 0.1);
            const Ptr<RigDrift> drift = RigDrift::create(P2, rig->getSize());
            ASSERT_TRUE(drift->add(rows));
            std::cout << scene.scene << ": rows " << off << " px; " << Mat(estimate(*drift)).t() << std::endl;
            c = drift->correct(c, R2);
        }
    }
}

}} // namespace opencv_test
