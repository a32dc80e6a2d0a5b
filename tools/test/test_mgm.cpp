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

TEST(HDPStereo_Mgm, map_before_the_check)
{
    MgmTest test;
    const String options = "-r -31 -R 0 -s vfit";
    const Mat all = test.match(options, "TESTLRRL=0");
    const Mat checked = test.match(options, "REMOVESMALLCC=100");
    const Mat again = test.match(options + " -l " + test.folder.path("all.tif"), "REMOVESMALLCC=100");
    EXPECT_EQ(0, cv::norm(all, test.image("all.tif"), NORM_INF));
    EXPECT_EQ(0, cv::countNonZero((checked == checked) != (again == again)));
    EXPECT_EQ(0, cv::norm(checked, again, NORM_INF, checked == checked));
    EXPECT_LT(cv::countNonZero(checked == checked), (int)all.total());
}

TEST(HDPStereo_Mgm, all_options_of_mgm)
{
    MgmTest test;
    const Mat expected = test.match("-r -31 -R 0 -s vfit");
    // s2p's call of mgm_multi, and what else both programs have
    const char* const others[] = { "-S 6 -s vfit -t census -O 8 -wl wl.tif -wr wr.tif -P1 12.0 -P2 48.0",
                                   "-s parabola -p census -truncDist inf -aP1 1 -aP2 1 -aThresh 5 -Rc cost.tif",
                                   "-s cubic -confidence_costL a.tif -confidence_costR b.tif -confidence_pkrL c.tif",
                                   "-s vfit -confidence_pkrR d.tif -inputCostVolume volume.bin" };
    for (const String options : others)
    {
        SCOPED_TRACE(options);
        const Mat map = test.match("-r -31 -R 0 " + options, "SUBPIX=2 MEDIAN=1 CENSUS_NCC_WIN=5 MINDIFF=1");
        EXPECT_EQ(0, cv::countNonZero((map == map) != (expected == expected)));
        EXPECT_EQ(0, cv::norm(map, expected, NORM_INF, map == map));
    }
    EXPECT_EQ(0, run(test.folder, "hdpstereo-mgm -h").status);
    EXPECT_EQ(0u, run(test.folder, "hdpstereo-mgm --version").output.find("hdpstereo-mgm "));
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
    const Mat truth = -test.pair.truth; // of mgm's sign
    Mat least = truth - 3.4, most = truth + 2.7;
    const Rect wrong(60, 30, 60, 60), free(150, 70, 60, 60); // another range; none at all
    least(wrong) += 9;
    most(wrong) += 9;
    least(free).setTo(none);
    most(free).setTo(std::numeric_limits<float>::infinity());
    const auto match = [&](const String& options, const String& environment) {
        test.folder.write("least.tif", least);
        test.folder.write("most.tif", most);
        return test.match(options + " -m " + test.folder.path("least.tif") + " -M " + test.folder.path("most.tif"),
                          environment);
    };
    for (const String options : { "-r -31 -R 0 -s vfit", "-r -31 -R 0" })
    {
        SCOPED_TRACE(options);
        for (const String environment : { "TESTLRRL=0", "TESTLRRL=1" })
        {
            const Mat disparity = match(options, environment);
            EXPECT_EQ(0, cv::countNonZero((disparity < least) | (disparity > most)));
        }
        const Mat disparity = match(options, "TESTLRRL=0");
        EXPECT_EQ(0, cv::countNonZero(~(disparity == disparity))) << "it is looked for in the range";
        const Mat isRight = cv::abs(disparity - truth) <= 1;
        EXPECT_GT(cv::countNonZero(isRight(free)), 0.8 * free.area());
    }
    // Where there is none, that of all holds, whatever others have.
    const Mat narrow = match("-r -20 -R -12 -s none", "TESTLRRL=0")(free);
    EXPECT_EQ(0, cv::countNonZero(~((narrow >= -20) & (narrow <= -12))));
    // These ranges say all; the right map is matched over that of all.
    least = truth - 3;
    most = truth + 3;
    EXPECT_LT(test.wrong(-match("-s vfit -Rd " + test.folder.path("right_map.tif"), "")), 0.1);
    const Mat ofRight = test.image("right_map.tif");
    EXPECT_GT(cv::countNonZero(ofRight == ofRight), 0.7 * ofRight.total());
}

TEST(HDPStereo_Mgm, ranges_of_a_smaller_left_image)
{
    MgmTest test;
    test.save(test.left.rowRange(0, 130), test.right);
    const Mat truth = -test.pair.truth.rowRange(0, 130);
    test.folder.write("least.tif", truth - 2);
    test.folder.write("most.tif", truth + 2);
    const Mat disparity =
        test.match("-s vfit -m " + test.folder.path("least.tif") + " -M " + test.folder.path("most.tif"));
    ASSERT_EQ(truth.size(), disparity.size());
    EXPECT_EQ(0, cv::countNonZero(cv::abs(disparity - truth) > 2));
    EXPECT_GT(cv::countNonZero(disparity == disparity), 0.7 * disparity.total());
}

TEST(HDPStereo_Mgm, wrong_ranges_of_pixels)
{
    MgmTest test;
    const auto errorsFor = [&](const Mat& least, const Mat& most) {
        test.folder.write("least.tif", least);
        test.folder.write("most.tif", most);
        return test.call("-r -31 -R 0 -m " + test.folder.path("least.tif") + " -M " + test.folder.path("most.tif"))
            .errors;
    };
    Mat least(test.left.size(), CV_32F, Scalar(-9)), most(test.left.size(), CV_32F, Scalar(-4));
    least.at<float>(7, 5) = -3.5;
    EXPECT_EQ("error: -m must be nowhere above -M, but at (5, 7) they are -3.5 and -4\n", errorsFor(least, most));
    least.at<float>(7, 5) = -3000;
    EXPECT_EQ("error: -m must be from -2047 to 2047, not -3000\n", errorsFor(least, most));
    least.at<float>(7, 5) = none;
    most.at<float>(7, 5) = 3000;
    EXPECT_EQ("error: -M must be from -2047 to 2047, not 3000\n", errorsFor(least, most));
    EXPECT_EQ("error: -M must have the size of LEFT, 240 x 160, not 240 x 159\n",
              errorsFor(least, most.rowRange(0, 159)));
    EXPECT_FALSE(fs::exists(test.folder.path("out.tif")));
}

TEST(HDPStereo_Mgm, wrong_calls)
{
    MgmTest test;
    const std::pair<String, String> calls[] = {
        { "-r -31 -R", "LEFT, RIGHT and OUT are needed" },
        { "-q 3", "the option -q is unknown" },
        { "-r near -R 0", "-r must be a number, not 'near'" },
        { "-r 5 -R 4", "-R (4) must not be less than -r (5)" },
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
    Mat colors;
    test.pair.left.convertTo(colors, CV_32F);
    test.save(colors, test.right);
    EXPECT_EQ(
        0u,
        test.call("-r -31 -R 0").errors.find("error: '" + test.folder.path("left.tif") + "' has colours of floats: "));
}

#ifdef __linux__
//! The file that was there before stays.
TEST(HDPStereo_Mgm, full_disk)
{
    MgmTest test;
    const String out = test.folder.path("out.tif");
    test.folder.writeText("out.tif", "kept");
    ASSERT_EQ(0, symlink("/dev/full", (out + ".part").c_str()));
    const Execution full = run(test.folder, "hdpstereo-mgm -r -31 -R 0 " + test.folder.path("left.tif") + " " +
                                                test.folder.path("right.tif") + " " + out);
    EXPECT_EQ(1, full.status);
    EXPECT_EQ("error: cannot write '" + out + ".part'\n", full.errors);
    EXPECT_EQ("kept", readText(out));
}
#endif

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
    for (const String option : { "-l", "-Rd", "-confidence_consensusL", "-confidence_consensusR" })
    {
        EXPECT_EQ("error: " + option + ": cannot write '/no/d6.tif'\n", callFor(option + " /no/d6.tif", images, out));
        EXPECT_EQ("error: " + option + " must be a file of floats, such as .tif, not 'map.png'\n",
                  callFor(option + " map.png", images, out));
    }
    EXPECT_EQ("error: -l: cannot write './x.tif': it is OUT\n", callFor("-l ./x.tif", images, "x.tif"));
    EXPECT_FALSE(fs::exists(out));
    const String kept = test.folder.path("kept.tif");
    test.folder.writeText("kept.tif", "kept");
    EXPECT_EQ("error: cannot read the image 'no_left.tif'\n", callFor("", images, kept));
    EXPECT_EQ("kept", readText(kept));

    const String left = test.folder.path("left.tif"), pair = left + " " + test.folder.path("right.tif");
    EXPECT_EQ("error: OUT: cannot write '" + left + "': it is LEFT\n", callFor("", pair, left));
    EXPECT_EQ("error: -Rd: cannot write '" + left + "': it is LEFT\n", callFor("-Rd " + left, pair, out));
    EXPECT_EQ("error: OUT: cannot write '" + kept + "': it is the file of -M\n",
              callFor("-m " + left + " -M " + kept, pair, kept));
    EXPECT_EQ(0, cvtest::norm(test.left, test.image("left.tif"), NORM_INF));
    EXPECT_EQ("", callFor("", pair, out));
    EXPECT_EQ("", callFor("", pair, test.folder.path("out.pfm")));
    const Mat map = test.image("out.tif"), same = test.image("out.pfm");
    EXPECT_EQ(0, cv::countNonZero((map == map) != (same == same)));
    EXPECT_EQ(0, cv::norm(map, same, NORM_INF, map == map));
}

}} // namespace opencv_test

#endif // __unix__
