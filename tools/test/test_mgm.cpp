// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "mgm_program.hpp"

#ifdef __unix__

namespace opencv_test { namespace {

TEST(HDPStereo_Mgm, call_of_s2p)
{
    MgmTest test;
    const String environment =
        "OMP_NUM_THREADS=1 MEDIAN=1 CENSUS_NCC_WIN=5 TSGM=3 TESTLRRL=1 TESTLRRL_TAU=1.0 MINDIFF=-1";
    const String confidence = test.folder.path("out_confidence.tif");
    const Mat disparity =
        test.match("-r -31 -R 0 -s vfit -t census -O 8 -confidence_consensusL " + confidence, environment);
    EXPECT_LT(test.wrong(-disparity), 0.1);
    Mat known = disparity == disparity;
    EXPECT_LT(cv::countNonZero(known), (int)known.total()); // what only the left image shows
    double least, most;
    cv::minMaxLoc(disparity, &least, &most, nullptr, nullptr, known);
    EXPECT_GE(least, -31.5);
    EXPECT_LE(most, 0.5);
    const Mat map = test.image("out_confidence.tif");
    ASSERT_EQ(CV_32FC1, map.type());
    cv::minMaxLoc(map, &least, &most);
    EXPECT_GE(least, 0);
    EXPECT_LE(most, 1);
    EXPECT_GT(most, least);

    // Without the check, and with whole disparities
    const Mat whole = test.match("-r -31 -R 0 -s none", "TESTLRRL=0");
    known = whole == whole;
    EXPECT_EQ((int)known.total(), cv::countNonZero(known));
    Mat rounded;
    whole.convertTo(rounded, CV_32S);
    rounded.convertTo(rounded, CV_32F);
    EXPECT_EQ(0, cv::norm(rounded, whole, NORM_INF));
}

TEST(HDPStereo_Mgm, depths)
{
    MgmTest test;
    const double expected = test.wrong(-test.match("-r -31 -R 0 -s vfit"));
    EXPECT_LT(expected, 0.1);
    Mat left, right;
    test.left.convertTo(left, CV_16U, 13, 500);
    test.right.convertTo(right, CV_16U, 13, 500);
    test.save(left, right);
    EXPECT_NEAR(expected, test.wrong(-test.match("-r -31 -R 0 -s vfit")), 0.02);
    test.left.convertTo(left, CV_32F, 1 / 255.);
    test.right.convertTo(right, CV_32F, 1 / 255.);
    test.save(left, right);
    EXPECT_NEAR(expected, test.wrong(-test.match("-r -31 -R 0 -s vfit")), 0.02);
}

TEST(HDPStereo_Mgm, no_data)
{
    MgmTest test;
    Mat left, right;
    test.left.convertTo(left, CV_32F, 1 / 255.);
    test.right.convertTo(right, CV_32F, 1 / 255.);
    const Rect wedge(0, 0, 60, 70);
    left(wedge).setTo(none);
    right.colRange(200, 240).setTo(none);
    test.save(left, right);
    const Mat disparity = test.match("-r -31 -R 0 -s vfit");
    const Mat known = disparity == disparity;
    EXPECT_EQ(0, cv::countNonZero(known(wedge)));
    const Rect kept(70, 0, 100, 160);
    EXPECT_GT(cv::countNonZero(known(kept)), 0.8 * kept.area());
}

TEST(HDPStereo_Mgm, signs_and_sizes)
{
    MgmTest test;
    // The right image, 40 columns farther right: disparities that are negative in OpenCV's sign
    Mat moved;
    cv::copyMakeBorder(test.right, moved, 0, 0, 40, 0, BORDER_REPLICATE);
    test.save(test.left, moved);
    const Mat disparity = test.match("-r 9 -R 40 -s vfit");
    EXPECT_EQ(test.left.size(), disparity.size());
    EXPECT_LT(test.wrong(-disparity, -40), 0.12);

    // Disparities of the right image
    test.save(test.left, test.right);
    const Mat ofRight = [&] {
        test.match("-r -31 -R 0 -s vfit -Rd " + test.folder.path("right_map.tif"));
        return test.image("right_map.tif");
    }();
    const Mat ofLeft = -test.image("out.tif");
    int agree = 0, known = 0;
    for (int y = 0; y < ofLeft.rows; y++)
        for (int x = 0; x < ofLeft.cols; x++)
        {
            const float d = ofLeft.at<float>(y, x);
            if (!(x - d >= 0))
                continue;
            known++;
            agree += std::abs(ofRight.at<float>(y, cvRound(x - d)) - d) <= 1;
        }
    EXPECT_GT(agree, 0.9 * known);
}

TEST(HDPStereo_Mgm, unknown_range)
{
    MgmTest test;
    // Beyond mgm's own range of 30
    Mat moved;
    cv::copyMakeBorder(test.right, moved, 0, 0, 60, 0, BORDER_REPLICATE);
    test.save(test.left, moved);
    for (const String options : { "-s vfit", "-r nan -R nan -s vfit" })
        EXPECT_LT(test.wrong(-test.match(options), -60), 0.15) << options;
    test.save(Mat(160, 240, CV_8U, Scalar(90)), Mat(160, 240, CV_8U, Scalar(90)));
    EXPECT_EQ(Size(240, 160), test.match("").size()) << "nothing to be found";
}

TEST(HDPStereo_Mgm, ranges_of_pixels)
{
    MgmTest test;
    Mat least = -test.pair.truth - 3, most = -test.pair.truth + 3;
    least.at<float>(5, 5) = none;
    test.folder.write("least.tif", least);
    test.folder.write("most.tif", most);
    const Mat disparity =
        test.match("-r -31 -R 0 -s vfit -m " + test.folder.path("least.tif") + " -M " + test.folder.path("most.tif"),
                   "TESTLRRL=0");
    const Mat known = disparity == disparity;
    EXPECT_GT(cv::countNonZero(known), 0.8 * known.total());
    const Mat outside = (disparity < least - 1.5) | (disparity > most + 1.5);
    EXPECT_EQ(0, cv::countNonZero(outside));
}

TEST(HDPStereo_Mgm, wrong_calls)
{
    MgmTest test;
    const std::pair<String, String> calls[] = {
        { "-r -31 -R", "LEFT, RIGHT and OUT are needed" },
        { "-q 3", "the option -q is unknown" },
        { "-r near -R 0", "-r must be a number, not 'near'" },
        { "-r 5 -R 4", "-R must be at least -r, 5, not 4" },
        { "-r -2048 -R 0", "-r must be from -2047 to 2047, not -2048" },
        { "-r 0 -R 1e30", "-R must be from -2047 to 2047, not 1e+30" },
        { "-m a.tif", "-m and -M need each other" },
        { "-m /no/a.tif -M /no/b.tif", "cannot read the image '/no/a.tif'" },
    };
    for (const auto& wrong : calls)
    {
        const Execution result = test.call(wrong.first);
        EXPECT_EQ(1, result.status) << wrong.first;
        EXPECT_EQ(0u, result.errors.find("error: ")) << result.errors;
        EXPECT_NE(String::npos, result.errors.find(wrong.second)) << result.errors;
        EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
    }
    for (const String setting : { "TESTLRRL", "TESTLRRL_TAU", "REMOVESMALLCC", "OMP_NUM_THREADS" })
        EXPECT_EQ("error: " + setting + " must be a number, not 'some'\n",
                  test.call("-r -31 -R 0", setting + "=some").errors);
    EXPECT_EQ(1, run(test.folder, "hdpstereo-mgm").status);
    EXPECT_EQ(0, run(test.folder, "hdpstereo-mgm --help").status);
    EXPECT_EQ(1, test.call("-r -31 -R 0", "HDPSTEREO_PRESET=best").status);
    const Execution told = test.call("-r -31 -R 0 -O 8", "HDPSTEREO_VERBOSE=1");
    EXPECT_EQ("hdpstereo-mgm: -O has no effect\n", told.errors);
    EXPECT_EQ("", test.call("-r -31 -R 0 -O 8").errors);
}

TEST(HDPStereo_Mgm, outputs_that_cannot_be)
{
    MgmTest test;
    const auto callFor = [&](const String& options, const String& images, const String& out) {
        return run(test.folder, "hdpstereo-mgm -r -31 -R 0 " + options + " " + images + " " + out).errors;
    };
    // Such errors come first, here before that there are no images.
    const String out = test.folder.path("out.tif"), images = "no_left.tif no_right.tif";
    EXPECT_EQ("error: OUT: cannot write '/no/d6.tif'\n", callFor("", images, "/no/d6.tif"));
    for (const String wrong : { "map.png", "map.jpg", "map", "map.none", "-" })
        EXPECT_EQ("error: OUT must be a file of floats, such as .tif, not '" + wrong + "'\n",
                  callFor("", images, wrong));
    for (const String option : { "-Rd", "-confidence_consensusL", "-confidence_consensusR" })
    {
        EXPECT_EQ("error: " + option + ": cannot write '/no/d6.tif'\n", callFor(option + " /no/d6.tif", images, out));
        EXPECT_EQ("error: " + option + " must be a file of floats, such as .tif, not 'map.png'\n",
                  callFor(option + " map.png", images, out));
    }
    EXPECT_FALSE(fs::exists(out));
    const String kept = test.folder.path("kept.tif");
    test.folder.writeText("kept.tif", "kept");
    EXPECT_EQ("error: cannot read the image 'no_left.tif'\n", callFor("", images, kept));
    EXPECT_EQ("kept", readText(kept));

    const String pair = test.folder.path("left.tif") + " " + test.folder.path("right.tif");
    EXPECT_EQ("", callFor("", pair, out));
    EXPECT_EQ("", callFor("", pair, test.folder.path("out.pfm")));
    const Mat map = test.image("out.tif"), same = test.image("out.pfm");
    EXPECT_EQ(0, cv::countNonZero((map == map) != (same == same)));
    EXPECT_EQ(0, cv::norm(map, same, NORM_INF, map == map));
}

}} // namespace opencv_test

#endif // __unix__
