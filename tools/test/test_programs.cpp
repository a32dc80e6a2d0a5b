// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The programs as a user calls them: exit status, and what they print and write.

#include "test_precomp.hpp"
#include "programs.hpp"

#ifdef __unix__
#include <cstdio>
#include <sys/stat.h>
#include <unistd.h>

namespace opencv_test { namespace {

TEST(HDPStereo_Programs, help_and_wrong_arguments)
{
    for (const char* program : { "hdpstereo", "example_hdpstereo_hdp_own_tree" })
        testHelpAndWrongArguments(program);
}

#ifdef __linux__
//! What is printed and lost on a full disk is an error.
TEST(HDPStereo_Programs, full_disk)
{
    const DatasetFolder folder;
    writePair(folder);
    for (const String program : { "hdpstereo", "example_hdpstereo_hdp_own_tree" })
    {
        SCOPED_TRACE(program);
        EXPECT_EQ(1, run(folder, program + pairOf(folder), "/dev/full").status);
    }
}
#endif

//! What cv::CommandLineParser lets pass
TEST(HDPStereo_Programs, samples_are_strict)
{
    const DatasetFolder folder;
    writePair(folder);
    const String left = folder.path("dataset/a/left.png"),
                 images = " " + left + " " + folder.path("dataset/a/right.png"),
                 match = "example_hdpstereo_hdp_stereo_match" + images + " " + folder.path("map.png"),
                 tree = "example_hdpstereo_hdp_own_tree" + images;
    for (const String& program : { match, tree })
    {
        EXPECT_EQ("error: --num-disparities=64x: not a whole number from 0 to 2047\n",
                  run(folder, program + " --num-disparities=64x").errors);
        EXPECT_EQ("error: unexpected argument 'more.png'\n", run(folder, program + " more.png").errors);
        EXPECT_EQ(1, run(folder, program + " --num-disparities=32 --unknown=1").status);
    }
    EXPECT_EQ(0, run(folder, match + " --num-disparities=32").status);
    EXPECT_EQ("error: --max-weight=300: not a whole number from 0 to 255\n",
              run(folder, tree + " --max-weight=300").errors);
    folder.write("truth.png", Mat(12, 16, CV_8U, Scalar(3)));
    EXPECT_EQ("error: --truth must have the size of the images\n",
              run(folder, tree + " --truth=" + folder.path("truth.png")).errors);
}

TEST(HDPStereo_Programs, stereo_match_writes_all_it_is_asked_for)
{
    const DatasetFolder folder;
    writePair(folder);
    const String png = folder.path("map.png"), pfm = folder.path("map.pfm"), ply = folder.path("points.ply");
    const String program = "hdpstereo" + pairOf(folder);
    const Execution result =
        run(folder, program + " --preset=quality --output=" + png + " --picture=" + folder.path("picture.jpg") +
                        " --point-cloud=" + ply +
                        " --focal=100 --baseline=2 --truth=" + folder.path("dataset/a/disp_left.png"));
    EXPECT_EQ(0, result.status) << result.errors;
    EXPECT_NE(String::npos, result.output.find("err>=2"));
    EXPECT_EQ(0, run(folder, program + " --preset=quality --output=" + pfm).status);
    const Mat map = cv::imread(png, IMREAD_UNCHANGED), exact = cv::imread(pfm, IMREAD_UNCHANGED);
    ASSERT_EQ(CV_16UC1, map.type());
    ASSERT_EQ(CV_32FC1, exact.type());
    Mat fromPng;
    map.convertTo(fromPng, CV_32F, 1. / 256);
    EXPECT_LT(cv::norm(fromPng, exact, NORM_INF), 1. / 128);
    EXPECT_EQ(Size(160, 120), cv::imread(folder.path("picture.jpg")).size());

    // Every pixel has a disparity above 0 here, and so is a point: 3 floats and 3 bytes.
    const String points = readText(ply), end = "end_header\n";
    EXPECT_NE(String::npos, points.find("element vertex 19200\n"));
    EXPECT_EQ(19200u * 15, points.size() - points.find(end) - end.size());
    float z = 0;
    std::memcpy(&z, points.data() + points.find(end) + end.size() + 8, sizeof(z));
    EXPECT_NEAR(100 * 2 / exact.at<float>(0, 0), z, 1e-3 * z);

    // The principal point of Q is not the centre of the image.
    folder.writeText("extrinsics.yml",
                     "%YAML:1.0\n---\nQ: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [ 1., "
                     "0., 0., -50., 0., 1., 0., -40., 0., 0., 0., 100., 0., 0., 0.5, 0. ]\n");
    EXPECT_EQ(
        0, run(folder, program + " --point-cloud=" + ply + " --reprojection=" + folder.path("extrinsics.yml")).status);
    const String moved = readText(ply);
    float first[3];
    std::memcpy(first, moved.data() + moved.find(end) + end.size(), sizeof(first));
    EXPECT_NEAR(-50 / 100. * first[2], first[0], 1e-4 * first[2]);
    EXPECT_NEAR(-40 / 100. * first[2], first[1], 1e-4 * first[2]);

    // How far it is right, and why it is so; floats have all disparities, in whatever letters files are named.
    const String far = " --output=" + folder.path("far.TIF") + " --sigma=" + folder.path("sigma.tif") +
                       " --reasons=" + folder.path("reasons.png") + " --confidence=" + folder.path("confidence.pfm"),
                 mask = " --left-mask=" + folder.path("mask.png");
    Mat data(120, 160, CV_8U, Scalar(255));
    data.rowRange(0, 30).setTo(0);
    folder.write("mask.png", data);
    const Execution told = run(folder, program + " --min-disparity=-8" + far + mask);
    EXPECT_EQ(0, told.status) << told.errors;
    const Mat below = cv::imread(folder.path("far.TIF"), IMREAD_UNCHANGED),
              sigma = cv::imread(folder.path("sigma.tif"), IMREAD_UNCHANGED),
              reasons = cv::imread(folder.path("reasons.png"), IMREAD_UNCHANGED),
              confidence = cv::imread(folder.path("confidence.pfm"), IMREAD_UNCHANGED);
    ASSERT_EQ(CV_32FC1, below.type());
    EXPECT_EQ(0, cv::countNonZero((below < FLT_MAX) != data)); // NaN stands for none
    ASSERT_EQ(CV_32FC1, sigma.type());
    EXPECT_EQ(0, cv::countNonZero((sigma < FLT_MAX) != data));
    ASSERT_EQ(CV_8UC1, reasons.type());
    EXPECT_EQ(0, cv::countNonZero((reasons != cv::stereo::HDPTreeMatcher::REASON_MASKED) != data));
    ASSERT_EQ(CV_32FC1, confidence.type());
    EXPECT_EQ(0, cv::countNonZero((confidence > 0) & ~data));

    const Execution compared = run(folder, program + " --compare --picture=" + folder.path("picture.jpg") +
                                               " --truth=" + folder.path("dataset/a/disp_left.png"));
    EXPECT_EQ(0, compared.status) << compared.errors;
    EXPECT_NE(String::npos, compared.output.find("times faster"));
    EXPECT_NE(String::npos, compared.output.find("err>=2  StereoSGBM, 3WAY"));
    EXPECT_EQ(Size(3 * 160, 120), cv::imread(folder.path("picture.jpg")).size());

    const Execution version = run(folder, "hdpstereo --version");
    EXPECT_EQ(0, version.status);
    EXPECT_EQ(0u, version.output.find("hdpstereo 2."));
    const String twice = "hdpstereo a.png b.png --num-disparities=";
    EXPECT_EQ("error: --num-disparities=abc is not a number\n", run(folder, twice + "abc").errors);
    EXPECT_EQ("error: --num-disparities=1.5 is not an integer\n", run(folder, twice + "1.5").errors);
    EXPECT_EQ(String::npos, run(folder, "hdpstereo --help").output.find("value:true"));

    for (const char* wrong :
         { " --preset=FAST", " --min-disparity=near", " --reprojection=/no/such.yml --point-cloud=x.ply",
           " --focal=0 --baseline=1 --point-cloud=x.ply", " --num-disparities=-1", " --output=/no/such/folder/map.png",
           " --output=map.unknown", " --point-cloud=x.ply", " --truth=/no/such/file.png" })
        EXPECT_EQ(1, run(folder, program + wrong).status) << wrong;
}

TEST(HDPStereo_Programs, findings_of_another_pair)
{
    const DatasetFolder folder;
    writePair(folder);
    const String model = folder.path("rig.yml"), program = "hdpstereo" + pairOf(folder), map = folder.path("map.pfm"),
                 again = folder.path("again.pfm");
    EXPECT_EQ(0, run(folder, program + " " + map + " --save-findings=" + model).status);
    const Execution good = run(folder, program + " " + again + " --findings=" + model);
    EXPECT_EQ(0, good.status) << good.errors;
    EXPECT_EQ(readText(map), readText(again));

    folder.write("small.png", Mat(cv::imread(folder.path("dataset/a/left.png")), Rect(0, 0, 100, 100)));
    const String small = folder.path("small.png");
    const Execution other = run(folder, "hdpstereo " + small + " " + small + " --findings=" + model);
    EXPECT_EQ(1, other.status);
    EXPECT_EQ(0u, other.errors.find("error: left must have 160 x 120 pixels as the pair model, not 100 x 100"))
        << other.errors;
    EXPECT_EQ(1, run(folder, program + " --findings=" + map).status);
    EXPECT_EQ(1, run(folder, program + " --save-findings=/no/such/folder/rig.yml").status);
    EXPECT_EQ(1, run(folder, "hdpstereo --batch a b c --save-findings=" + model).status);
}

TEST(HDPStereo_Programs, rectifies_raw_pairs)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 22);
    folder.write("lefts/a.png", pair.left);
    folder.write("rights/a.png", pair.right);
    const String chain = writeCalibration(folder);
    const String left = folder.path("lefts/a.png"), right = folder.path("rights/a.png"), map = folder.path("map.pfm");
    const String program = "hdpstereo " + left + " " + right + " --num-disparities=32 ";
    const String calibrated = program + map + " --calibration=" + chain;
    const Execution done = run(folder, calibrated + " --depth=" + folder.path("depth.png") +
                                           " --point-cloud=" + folder.path("points.ply"));
    EXPECT_EQ(0, done.status) << done.errors;
    const Mat depth = cv::imread(folder.path("depth.png"), IMREAD_ANYDEPTH),
              disparity = cv::imread(map, IMREAD_ANYDEPTH);
    ASSERT_EQ(CV_16UC1, depth.type());
    EXPECT_NEAR(1000 * 200 * 0.2 / disparity.at<float>(60, 100), depth.at<ushort>(60, 100), 1);
    EXPECT_EQ(0, run(folder, calibrated + " --depth=" + folder.path("depth.pfm")).status);
    EXPECT_NEAR(depth.at<ushort>(60, 100) / 1000.,
                cv::imread(folder.path("depth.pfm"), IMREAD_ANYDEPTH).at<float>(60, 100), 0.001);
    EXPECT_EQ("error: --depth needs --calibration\n", run(folder, program + " --depth=x.png").errors);
    EXPECT_EQ("error: --calibration2 needs --calibration\n", run(folder, program + " --calibration2=" + chain).errors);

    // A folder remembers it, however long it is.
    std::ofstream(chain.c_str(), std::ios::app) << "# " << String(5000, 'x') << "\n";
    const String batch = "hdpstereo --batch " + folder.path("lefts") + " " + folder.path("rights") + " " +
                         folder.path("maps") + " --num-disparities=32 --format=pfm";
    EXPECT_EQ(0, run(folder, batch + " --calibration=" + chain).status);
    EXPECT_EQ(0, cvtest::norm(disparity, cv::imread(folder.path("maps/a.pfm"), IMREAD_ANYDEPTH), NORM_INF));
    EXPECT_EQ(1, run(folder, batch).status);

    // No pair is matched without a mask that does not fit.
    folder.write("mask.png", Mat(60, 80, CV_8UC1, Scalar(255)));
    folder.write("lefts/b.png", pair.left);
    folder.write("rights/b.png", pair.right);
    const String others = "hdpstereo --batch " + folder.path("lefts") + " " + folder.path("rights") + " " +
                          folder.path("others") + " --num-disparities=32 --calibration=" + chain;
    const Execution masked = run(folder, others + " --left-mask=" + folder.path("mask.png"));
    EXPECT_NE(0, masked.status);
    EXPECT_NE(String::npos, masked.errors.find("--left-mask must have the size of the raw images, 160 x 120"))
        << masked.errors;
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("others/a.png")));
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("others/b.png")));
}

TEST(HDPStereo_Programs, warns_of_a_swapped_pair)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(320, 240), 64, 5);
    folder.write("left.png", pair.left);
    folder.write("right.png", pair.right);
    const String left = folder.path("left.png"), right = folder.path("right.png"), out = " " + folder.path("out.png");
    EXPECT_EQ("", run(folder, "hdpstereo " + left + " " + right + out).errors);
    EXPECT_EQ(0u, run(folder, "hdpstereo " + right + " " + left + out).errors.find("warning: "));
}

TEST(HDPStereo_Programs, batch_of_folders)
{
    const DatasetFolder folder;
    writePair(folder);
    const Mat left = cv::imread(folder.path("dataset/a/left.png")),
              right = cv::imread(folder.path("dataset/a/right.png"));
    for (const char* name : { "one.png", "small.png", "three.png", "torn.png", "two.png" })
    {
        folder.write(String("lefts/") + name, left);
        folder.write(String("rights/") + name, right);
    }
    folder.write("rights/small.png", Mat(right, Rect(0, 0, 100, 100)));
    folder.writeText("lefts/torn.png", "no picture");
    folder.writeText("lefts/readme.txt", "left images");
    folder.write("lefts/alone.png", left);
    folder.writeText("out/two.png.part", "of a run that was killed");

    const String lefts = folder.path("lefts"), rights = folder.path("rights"), out = folder.path("out"),
                 program = "hdpstereo --num-disparities=32 ",
                 command = program + "--batch " + lefts + " " + rights + " " + out;
    const Execution first = run(folder, command);
    EXPECT_EQ(2, first.status);
    EXPECT_EQ("3 pairs matched, 0 were there, 3 left out\n", first.output);
    for (const char* line : { "1/6 alone left out: cannot read the image", "2/6 one\n", "3/6 small left out: ",
                              "4/6 three\n", "5/6 torn left out: cannot read the image", "6/6 two\n" })
        EXPECT_NE(String::npos, first.errors.find(line)) << line << first.errors;
    std::vector<String> files;
    fs::glob_relative(out, "*.png", files);
    EXPECT_EQ(std::vector<String>({ "one.png", "three.png", "two.png" }), files);
    EXPECT_EQ(
        0, run(folder, program + lefts + "/one.png " + rights + "/one.png --output=" + folder.path("map.png")).status);
    const String map = readText(folder.path("map.png"));
    for (const String& file : files)
        EXPECT_TRUE(readText(fs::join(out, file)) == map) << file;

    // The second run does what the first one has not.
    folder.writeText("out/one.png", "kept");
    folder.write("rights/alone.png", right);
    const Execution second = run(folder, command);
    EXPECT_EQ(2, second.status);
    EXPECT_EQ("1 pairs matched, 3 were there, 2 left out\n", second.output);
    EXPECT_EQ("kept", readText(fs::join(out, "one.png")));
    EXPECT_TRUE(readText(fs::join(out, "alone.png")) == map);

    // Options that make no map are not kept.
    const String retried = program + "--batch " + lefts + " " + rights + " " + folder.path("retried");
    EXPECT_EQ(2, run(folder, retried + " --num-disparities=9999").status);
    EXPECT_EQ(2, run(folder, retried).status);
    EXPECT_TRUE(fs::exists(folder.path("retried/one.png")));

    // Maps of other options are not continued.
    const Execution others = run(folder, command + " --preset=quality");
    EXPECT_EQ(1, others.status);
    EXPECT_NE(String::npos, others.errors.find("hdpstereo.yml': take another folder")) << others.errors;
    EXPECT_EQ("error: there is no folder '" + folder.path("nowhere") + "'\n",
              run(folder, program + "--batch " + lefts + " " + folder.path("nowhere") + " " + out).errors);

    // A mask is what it has, by whatever name.
    const String mask = folder.path("mask.png"), masked = folder.path("masked"),
                 withMask = program + "--batch " + lefts + " " + rights + " " + masked + " --left-mask=";
    cv::imwrite(mask, Mat(left.size(), CV_8U, Scalar(255)));
    EXPECT_EQ(2, run(folder, withMask + mask).status);
    EXPECT_EQ(2, run(folder, withMask + fs::join(folder.path("."), "mask.png")).status);
    cv::imwrite(mask, Mat(left.size(), CV_8U, Scalar(0)));
    EXPECT_EQ(1, run(folder, withMask + mask).status);

    // Mistakes of the call are found before any work.
    const String other = " " + folder.path("lefts") + " " + folder.path("rights") + " " + folder.path("other");
    for (const String& wrong : { String("--batch"), "--batch " + lefts + " " + rights, "--batch --preset=none" + other,
                                 "--batch --format=jpg" + other, "--batch --output=x.png" + other,
                                 "--batch --num-disparities=-1" + other, "--batch " + folder.path("empty/") + ". x y" })
    {
        const Execution result = run(folder, "hdpstereo " + wrong);
        EXPECT_EQ(1, result.status) << wrong;
        EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
    }
    EXPECT_FALSE(fs::exists(folder.path("other")));
#ifdef __linux__
    // A disk that is full is no fault of the pair.
    folder.writeText("full/readme.txt", "");
    ASSERT_EQ(0, symlink("/dev/full", folder.path("full/one.png.part").c_str()));
    const Execution full = run(folder, program + "--batch " + lefts + " " + rights + " " + folder.path("full"));
    EXPECT_EQ(1, full.status);
    EXPECT_NE(String::npos, full.errors.find("error: cannot write '")) << full.errors;
    EXPECT_FALSE(fs::exists(folder.path("full/one.png")));
#endif
}

//! One sentence, before anything is matched or written
TEST(HDPStereo_Programs, stereo_match_names_what_is_not_there)
{
    const DatasetFolder folder;
    writePair(folder);
    const String a = folder.path("dataset/a"), none = folder.path("none"), out = folder.path("out"),
                 truth = a + "/disp_left.png", left = a + "/left.png", right = a + "/right.png",
                 pair = " " + left + " " + right + " ", batch = " --batch " + a + " " + a + " " + out;
    folder.writeText("words.yml", "no: [ calibration");
    const String words = folder.path("words.yml");
    folder.writeText("leaves.txt", left + " " + right + " ../x\n");
    folder.writeText("twice.txt", left + " " + right + " x\n" + left + " " + right + " ./x\n");
    folder.writeText("image.txt", left + " " + right + " left\n");
    folder.writeText("torn.txt", none + " " + right + " a\n" + left + " " + right + " b\n");
    folder.write("unknown.png", Mat(120, 160, CV_16U, Scalar(0)));
    folder.write("truth.pfm", Mat(120, 160, CV_32F, Scalar(3)));
    Mat deep;
    cv::cvtColor(cv::imread(left), deep, COLOR_BGR2GRAY);
    deep.convertTo(deep, CV_16U, 257);
    folder.write("deep.png", deep);
    folder.write("colors.tif", Mat(120, 160, CV_32FC3, Scalar::all(3)));
    const String colors = folder.path("colors.tif");
    const struct
    {
        String arguments, error;
    } cases[] = {
        { " --batch " + none + " " + a + " " + out, "there is no folder '" + none + "'" },
        { " --batch " + a + " " + none + " " + out, "there is no folder '" + none + "'" },
        { " --batch " + none + " " + out, "there is no file or folder '" + none + "'" },
        { " --batch " + left + " " + out, "'" + left + "': line 1 is not a left image, a right one and a name" },
        { " --batch " + a + " " + a + " " + left, "cannot make the folder '" + left + "'" },
        { " --batch " + folder.path("torn.txt") + " " + left, "cannot make the folder '" + left + "'" },
        { batch + " --calibration=" + none, "there is no file '" + none + "'" },
        { batch + " --calibration=" + left + " --calibration2=" + none, "there is no file '" + none + "'" },
        { batch + " --findings=" + none, "--findings='" + none + "' does not hold a pair model" },
        { batch + " --left-mask=" + none, "cannot read the image '" + none + "'" },
        { batch + " --prior=" + none, "cannot read the image '" + none + "'" },
        { " " + none + " " + right, "cannot read the image '" + none + "'" },
        { " " + left + " " + none, "cannot read the image '" + none + "'" },
        { pair + "--calibration=" + a, "there is no file '" + a + "'" },
        { pair + "--findings=" + a, "--findings='" + a + "' does not hold a pair model" },
        { pair + "--findings=" + words, "--findings='" + words + "' does not hold a pair model" },
        { pair + "--largest=" + none, "cannot read the image '" + none + "'" },
        { pair + "--truth=" + none, "cannot read the image '" + none + "'" },
        { pair + "--truth=" + folder.path("truth.pfm"), "--truth must be a PNG of 8 or 16 bits per pixel" },
        { pair + "-num-disparity=16", "unknown option '-num-disparity'" },
        { pair + "map.png more.png", "unexpected argument 'more.png'" },
        { pair + "--preset", "option '--preset' needs a value: --preset=VALUE" },
        { pair + "--prior=", "option '--prior' needs a value: --prior=VALUE" },
        { pair + "--compare=yes", "option '--compare' takes no value" },
        { " " + folder.path("deep.png") + " " + folder.path("deep.png") + " --compare",
          "--compare needs images of 8 bit: cv::StereoSGBM takes no others" },
        { pair + "map.tif --sigma=./map.tif", "cannot write './map.tif' twice: each output needs a file of its own" },
        { " --batch " + folder.path("twice.txt") + " " + out, "two pairs have the name 'x'" },
        { " --batch " + folder.path("image.txt") + " " + a, "the map '" + left + "' must not be one of the images" },
        { pair + "--truth=" + folder.path("unknown.png"), "--truth must have disparities that both images show" },
        { " --batch " + folder.path("leaves.txt") + " " + out,
          "'" + folder.path("leaves.txt") + "': line 1: the name '../x' is not in OUT" },
        { pair + "--point-cloud=x.ply --reprojection=" + none, "there is no file '" + none + "'" },
        { pair + "--point-cloud=x.ply --reprojection=" + words, "'" + words + "' has no matrix Q" },
        { pair + none + "/map.png", "cannot write '" + none + "/map.png': there is no folder '" + none + "'" },
        { pair + "--picture=map.xyz", "cannot write 'map.xyz': no image format has this extension" },
        { pair + "--picture=map.pgm", "cannot write 'map.pgm': this OpenCV does not write colors as .pgm" },
        { pair + "--picture=map.pbm", "cannot write 'map.pbm': this OpenCV does not write colors as .pbm" },
        { pair + "--picture=map.exr", "cannot write 'map.exr': this OpenCV does not write colors as .exr" },
        { pair + "--output=" + out, "cannot write '" + out + "': no image format has this extension" },
        { pair + left, "cannot write '" + left + "': it is LEFT" },
        { pair + "--picture=" + a + "/../a/right.png", "cannot write '" + a + "/../a/right.png': it is RIGHT" },
        { pair + "--sigma=" + left, "cannot write '" + left + "': it is LEFT" },
        { pair + "--truth=" + truth + " --output=" + truth, "cannot write '" + truth + "': it is the file of --truth" },
        { pair + a, "cannot write '" + a + "': it is a folder" },
        { pair + "map.jpg", "cannot write 'map.jpg': disparities need .png, .pfm, .tif or .exr" },
        { pair + "--reasons=map.jpg", "cannot write 'map.jpg': disparities need .png, .pfm, .tif or .exr" },
        { pair + "map.png --min-disparity=256",
          "PNG has no disparities above 255, and --min-disparity=256 asks for no" },
        { pair + "map.PNG --min-disparity=-3", "PNG has no disparities below 0, and --min-disparity=-3 asks for some" },
        { batch + " --min-disparity=-3", "PNG has no disparities below 0, and --min-disparity=-3 asks for some" },
        { " --batch " + a + " " + a + " " + a, "OUT must be another folder than that of the images, '" + a + "'" },
        { pair + "--save-findings=" + none + "/rig.yml", "cannot write '" + none + "/rig.yml': there is no folder" },
        { pair + "--save-findings=rig.png", "cannot write 'rig.png': --save-findings takes .yml" },
        { " --tiles " + none + " " + right + " " + out + ".tif", "cannot read the image '" + none + "'" },
        { " --tiles" + pair + out + ".tif --findings=" + none, "--findings='" + none + "' does not hold a pair model" },
        { " --tiles" + pair + out + ".tif --calibration=" + none, "--calibration does not go with --tiles" },
        { pair + out + ".tif --memory=100", "--memory needs --tiles" },
        { pair + out + ".tif -unit=mm", "--unit needs --calibration" },
        { pair + out + ".tif --format=tif", "--format needs --batch" },
        { pair + out + ".tif --prior-sigma=1", "--prior-sigma needs --prior" },
        { pair + out + ".tif --unit=1", "--unit needs --calibration" },
        { pair + out + ".tif --focal=100", "--focal needs --point-cloud" },
        { pair + out + ".tif --baseline=1", "--baseline needs --point-cloud" },
        { pair + out + ".tif --reprojection=" + none, "--reprojection needs --point-cloud" },
        { pair + "--point-cloud=x.ply --calibration=" + words + " --reprojection=" + words,
          "--reprojection does not go with --calibration" },
        { pair + "--point-cloud=x.ply --reprojection=" + words + " --focal=100",
          "--focal does not go with --reprojection" },
        { " " + colors + " " + right + " " + out + ".tif", "'" + colors + "' has colours of floats: " },
        { " --tiles " + left + " " + colors + " " + out + ".tif", "'" + colors + "' has colours of floats: " },
        { " --preset=paper --prior=" + none + " " + none + " " + none, "--prior does not go with --preset=paper" },
        { " --preset=paper --prior=" + none + " --tiles " + none + " " + none + " " + out + ".tif",
          "--prior does not go with --preset=paper" },
        { batch + " --preset=paper --prior=" + truth, "--prior does not go with --preset=paper" },
        { pair + out + ".tif --field-of-view=80", "--field-of-view needs --calibration" },
    };
    for (const auto& c : cases)
    {
        const Execution result = run(folder, "hdpstereo --num-disparities=32" + c.arguments);
        EXPECT_EQ(1, result.status) << c.arguments;
        EXPECT_EQ("", result.output) << c.arguments;
        EXPECT_EQ(0u, result.errors.find("error: " + c.error)) << c.arguments << "\n" << result.errors;
        EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
        EXPECT_FALSE(fs::exists(out)) << c.arguments;
    }
}

//! Not even one of the name that a map has until it is whole
TEST(HDPStereo_Programs, checks_of_outputs_change_no_file)
{
    const DatasetFolder folder;
    folder.writeText("keep.png.part", "kept");
    const String none = folder.path("none.png") + " ";
    EXPECT_EQ(1, run(folder, "hdpstereo " + none + none + folder.path("keep.png")).status);
    EXPECT_EQ("kept", readText(folder.path("keep.png.part")));
    EXPECT_FALSE(fs::exists(folder.path("keep.png")));
    EXPECT_EQ(1, run(folder, "hdpstereo " + none + none + folder.path("new.png")).status);
    EXPECT_FALSE(fs::exists(folder.path("new.png.part")));
}

#ifdef __linux__
//! Whoever reads a pipe gets the map, and nothing before it.
TEST(HDPStereo_Programs, stereo_match_writes_to_a_pipe)
{
    const DatasetFolder folder;
    writePair(folder);
    const String pipe = folder.path("pipe.pfm"), copy = folder.path("copy.pfm"), map = folder.path("map.pfm");
    ASSERT_EQ(0, mkfifo(pipe.c_str(), 0600));
    EXPECT_EQ(0, run(folder, "hdpstereo" + pairOf(folder) + " " + map).status);
    const Execution piped = run(folder, "hdpstereo" + pairOf(folder) + " " + pipe, String(),
                                "sh -c 'timeout 30 cat " + pipe + " >" + copy +
                                    " & timeout 30 \"$0\" \"$@\"; status=$?; wait; exit $status'");
    EXPECT_EQ(0, piped.status) << piped.errors;
    EXPECT_TRUE(readText(copy) == readText(map));
}
#endif

TEST(HDPStereo_Programs, stereo_match_takes_masks)
{
    const DatasetFolder folder;
    writePair(folder);
    Mat mask(120, 160, CV_8UC1, Scalar(255));
    mask(Rect(30, 100, 90, 20)).setTo(0);
    folder.write("mask.png", mask);
    const String pfm = folder.path("map.pfm"), program = "hdpstereo" + pairOf(folder) + " --output=" + pfm;
    const Execution result =
        run(folder, program + " --left-mask=" + folder.path("mask.png") + " --right-mask=" + folder.path("mask.png"));
    EXPECT_EQ(0, result.status) << result.errors;
    const Mat map = cv::imread(pfm, IMREAD_UNCHANGED);
    EXPECT_EQ(0, cv::countNonZero((map == std::numeric_limits<float>::infinity()) != (mask == 0)));
    // Whatever its depth, what is not black has data.
    Mat wide;
    mask.convertTo(wide, CV_16U, 1. / 255);
    folder.write("wide.png", wide);
    EXPECT_EQ(
        0, run(folder, program + " --left-mask=" + folder.path("wide.png") + " --right-mask=" + folder.path("wide.png"))
               .status);
    EXPECT_EQ(0, cv::countNonZero(map != cv::imread(pfm, IMREAD_UNCHANGED)));
    folder.write("small.png", mask.colRange(1, 100));
    for (const char* wrong : { "small.png", "none.png" })
    {
        const Execution bad = run(folder, program + " --right-mask=" + folder.path(wrong));
        EXPECT_EQ(1, bad.status);
        EXPECT_EQ(firstLine(bad.errors) + "\n", bad.errors);
    }
}

TEST(HDPStereo_Programs, stereo_match_takes_ranges_and_a_prior)
{
    const DatasetFolder folder;
    writePair(folder);
    const String pfm = folder.path("map.pfm"), program = "hdpstereo" + pairOf(folder) + " --output=" + pfm;
    const auto match = [&](const String& options) {
        const Execution result = run(folder, program + options);
        EXPECT_EQ(0, result.status) << options << result.errors;
        return cv::imread(pfm, IMREAD_UNCHANGED).clone();
    };
    const Mat plain = match("");
    const float none = std::numeric_limits<float>::quiet_NaN();
    Mat least(60, 80, CV_32F, Scalar(none)), most(60, 80, CV_16U, Scalar(0)); // coarser than the images
    least.rowRange(0, 30).setTo(9);
    most.rowRange(20, 60).setTo(12 * 256);
    folder.write("least.pfm", least);
    folder.write("most.png", most);
    const String smallest = " --smallest=" + folder.path("least.pfm"),
                 largest = " --largest=" + folder.path("most.png");
    const auto within = [](const Mat& map, int first, int last, double from, double to) {
        const Mat rows = map.rowRange(first, last);
        return cv::countNonZero((rows < from) | (rows > to)) == 0;
    };
    const Mat above = match(smallest), below = match(largest), both = match(smallest + largest);
    EXPECT_FALSE(within(plain, 0, 60, 9, 31));
    EXPECT_FALSE(within(plain, 40, 120, 0, 12));
    EXPECT_TRUE(within(above, 0, 60, 9, 31));
    EXPECT_FALSE(within(above, 60, 120, 9, 31));
    EXPECT_TRUE(within(below, 40, 120, 0, 12));
    EXPECT_FALSE(within(below, 0, 40, 0, 12));
    EXPECT_TRUE(within(both, 40, 60, 9, 12));

    // The pair's own map as a prior changes little, for the better; another one that is dense and sure, more.
    folder.write("prior.pfm", plain);
    const String prior = " --prior=" + folder.path("prior.pfm");
    const Mat again = match(prior), truth = cv::imread(folder.path("dataset/a/disp_left.png"), IMREAD_UNCHANGED);
    const auto countWrong = [&](const Mat& map) {
        Mat inPixels;
        truth.convertTo(inPixels, CV_32F, truth.depth() == CV_16U ? 1. / 256 : 1);
        return cv::countNonZero((abs(map - inPixels) > 1) & (truth != 0));
    };
    EXPECT_LT(cv::countNonZero(abs(again - plain) > 1), 0.02 * plain.total());
    EXPECT_LE(countWrong(again), countWrong(plain));
    EXPECT_EQ(0, run(folder, program + prior + " --prior-sigma=2").status);
    folder.write("small.pfm", plain.colRange(0, 100));
    folder.write("large.pfm", Mat(300, 300, CV_32F, Scalar(3)));
    folder.write("bytes.png", Mat(120, 160, CV_8U, Scalar(3)));
    folder.write("high.pfm", Mat(60, 80, CV_32F, Scalar(20)));
    const std::pair<String, String> wrong[] = {
        { " --prior=" + folder.path("small.pfm"), "the disparity of the prior must have the size of the images" },
        { prior + " --prior-sigma=-1", "sigma must be finite and >= 0" },
        { prior + " --prior-sigma=much", "--prior-sigma=much is not a number" },
        { prior + " --preset=paper", "--prior does not go with --preset=paper" },
        { " --prior=" + folder.path("none.pfm"), "cannot read the image" },
        { " --smallest=" + folder.path("bytes.png"), "must have disparities of 16 bit, times 256, or floats" },
        { " --smallest=" + folder.path("large.pfm"), "smallest and largest must have at most the size of the images" },
        { " --smallest=" + folder.path("high.pfm") + largest, "largest must not be less than smallest" },
        { " --smallest=" + folder.path("large.pfm") + largest, "largest must have the size and type of smallest" },
    };
    for (const auto& options : wrong)
    {
        const Execution bad = run(folder, program + options.first);
        EXPECT_EQ(1, bad.status) << options.first;
        EXPECT_NE(String::npos, bad.errors.find(options.second)) << bad.errors;
        EXPECT_EQ(firstLine(bad.errors) + "\n", bad.errors);
    }
}

TEST(HDPStereo_Programs, stereo_match_finds_the_range)
{
    const DatasetFolder folder;
    writePair(folder);
    const String pair = " " + folder.path("dataset/a/left.png") + " " + folder.path("dataset/a/right.png"),
                 map = folder.path("map.pfm"), again = folder.path("again.pfm"), model = folder.path("rig.yml");
    const Execution found =
        run(folder, "hdpstereo" + pair + " " + map + " --num-disparities=0 --save-findings=" + model);
    EXPECT_EQ(0, found.status) << found.errors;
    int first = 0, last = 0;
    ASSERT_EQ(2, std::sscanf(found.output.c_str(), "found disparities %d..%d", &first, &last)) << found.output;
    const String range = cv::format(" --min-disparity=%d --num-disparities=%d", first, last - first + 1);
    EXPECT_EQ(0, run(folder, "hdpstereo" + pair + " " + again + range).status);
    EXPECT_EQ(readText(map), readText(again));
    EXPECT_EQ(0, run(folder, "hdpstereo" + pair + " " + again + " --num-disparities=0 --findings=" + model).status);
    EXPECT_EQ(readText(map), readText(again));
    const Execution tiles = run(folder, "hdpstereo --tiles" + pair + " " + again + " --num-disparities=0");
    EXPECT_EQ(0, tiles.status) << tiles.errors;
    EXPECT_EQ(readText(map), readText(again));

    const Execution both = run(folder, "hdpstereo" + pair + " --num-disparities=0 --min-disparity=3");
    EXPECT_EQ(1, both.status);
    EXPECT_EQ("error: --min-disparity does not go with --num-disparities=0, which finds it, too\n", both.errors);
    folder.write("blank.png", Mat(120, 160, CV_8U, Scalar(90)));
    const String blank = " " + folder.path("blank.png");
    const Execution none = run(folder, "hdpstereo" + blank + blank + " --num-disparities=0");
    EXPECT_EQ(1, none.status);
    EXPECT_EQ(0u, none.errors.find("error: numDisparities must be > 0 for this pair")) << none.errors;
}

TEST(HDPStereo_Programs, batch_of_a_list)
{
    const DatasetFolder folder;
    writePair(folder);
    const String program = "hdpstereo --num-disparities=32 --format=pfm --batch ";
    const auto list = [&](int pairs) {
        String text = "\n";
        for (int i = 0; i < pairs; i++)
            text += folder.path("dataset/a/left.png") + " " + folder.path("dataset/a/right.png") +
                    cv::format(" night/%02d\r\n", i);
        folder.writeText("list.txt", text);
        return folder.path("list.txt") + " ";
    };
    const long few = peakMemory(folder, program + list(3) + folder.path("few"));
    const long many = peakMemory(folder, program + list(60) + folder.path("many"));
    EXPECT_EQ(CV_32FC1, cv::imread(folder.path("many/night/59.pfm"), IMREAD_UNCHANGED).type());
    const long more = std::getenv("ASAN_OPTIONS") ? LONG_MAX / 2 : 2000; // AddressSanitizer keeps what is freed
    EXPECT_LT(many, few + more);
    for (const char* wrong : { "", "a.png b.png\n", "a.png b.png c d\n", "a.png b.png c\na.png b.png c\n" })
    {
        folder.writeText("wrong.txt", wrong);
        EXPECT_EQ(1, run(folder, program + folder.path("wrong.txt") + " " + folder.path("other")).status) << wrong;
    }
    folder.writeText("tabs.txt", folder.path("no such left.png") + "\t" + folder.path("right.png") + "\tc d\n");
    fs::createDirectories(folder.path("named/night/01.pfm"));
    const Execution named = run(folder, program + list(2) + folder.path("named"));
    EXPECT_EQ(2, named.status);
    EXPECT_EQ("1 pairs matched, 0 were there, 1 left out\n", named.output);
    EXPECT_NE(String::npos, named.errors.find("night/01 left out: '" + folder.path("named/night/01.pfm") + "' is a f"))
        << named.errors;
    const Execution tabs = run(folder, program + folder.path("tabs.txt") + " " + folder.path("other"));
    EXPECT_EQ(2, tabs.status);
    EXPECT_NE(String::npos, tabs.errors.find("1/1 c d left out: ")) << tabs.errors;
    const String marked = "\xEF\xBB\xBF" + folder.path("dataset/a/left.png") + " "; // as editors of Windows begin files
    folder.writeText("marked.txt", marked + folder.path("dataset/a/right.png") + " a\r\n");
    const Execution ofMarked = run(folder, program + folder.path("marked.txt") + " " + folder.path("marked"));
    EXPECT_EQ(0, ofMarked.status) << ofMarked.errors;
}

TEST(HDPStereo_Programs, read_16_bit)
{
    const FaintPair faint;
    const DatasetFolder& folder = faint.folder;
    for (const String scene : { "faint", "rounded" })
    {
        const Execution result =
            run(folder, "hdpstereo" + faint.images(scene) + " --output=" + folder.path(scene + ".pfm") +
                            " --focal=100" + " --baseline=2 --point-cloud=" + folder.path(scene + ".ply"));
        EXPECT_EQ(0, result.status) << result.errors;
    }
    EXPECT_LT(faint.countErrors("faint.pfm", 1), 0.75 * faint.countErrors("rounded.pfm", 1));
    EXPECT_EQ(0, run(folder, "example_hdpstereo_hdp_own_tree" + faint.images("faint")).status);
}

//! Pixels without data do not say what is black and white.
TEST(HDPStereo_Programs, points_have_colors_of_pixels_with_data)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 22);
    Mat left, right, mask(120, 160, CV_8U, Scalar(255));
    cv::cvtColor(pair.left, left, COLOR_BGR2GRAY);
    cv::cvtColor(pair.right, right, COLOR_BGR2GRAY);
    left.convertTo(left, CV_32F);
    right.convertTo(right, CV_32F);
    mask.rowRange(0, 10).setTo(0);
    folder.write("right.pfm", right);
    folder.write("mask.png", mask);
    const String ply = folder.path("points.ply"), end = "end_header\n";
    const float levels[] = { std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), -9999 };
    for (const float noData : levels)
    {
        SCOPED_TRACE(noData);
        left.rowRange(0, 10).setTo(noData);
        folder.write("left.pfm", left);
        const Execution result =
            run(folder, "hdpstereo " + folder.path("left.pfm") + " " + folder.path("right.pfm") +
                            " --num-disparities=32 --focal=100 --baseline=2 --point-cloud=" + ply +
                            (noData == -9999 ? " --left-mask=" + folder.path("mask.png") : String()));
        ASSERT_EQ(0, result.status) << result.errors;
        const String points = readText(ply);
        std::vector<uchar> colors;
        for (size_t i = points.find(end) + end.size() + 12; i < points.size(); i += 15)
            colors.push_back((uchar)points[i]);
        ASSERT_LT(160u * 100, colors.size());
        const Mat inside = (Mat(colors) > 0) & (Mat(colors) < 255);
        EXPECT_LT(0.9 * colors.size(), cv::countNonZero(inside));
        EXPECT_EQ(0, *std::min_element(colors.begin(), colors.end()));
        EXPECT_EQ(255, *std::max_element(colors.begin(), colors.end()));
    }
}

//! Three frames, as two numbered sequences and as two folders, and the calibration of cameras that are rectified already
struct CameraFrames
{
    const DatasetFolder folder;
    const SyntheticPair pair;
    const String intrinsics, program, options, sequences;

    CameraFrames()
        : pair(makeSyntheticPair(Size(160, 120), 32, 22)), intrinsics(folder.path("intrinsics.yml")),
          program("example_hdpstereo_hdp_camera "),
          options(" --no-gui --num-disparities=32 -c=" + intrinsics +
                  " --calibration2=" + folder.path("extrinsics.yml") + " --unit=0.1"),
          sequences(program + folder.path("left%02d.png") + " " + folder.path("right%02d.png") + options)
    {
        cv::utils::fs::createDirectories(folder.path("lefts"));
        cv::utils::fs::createDirectories(folder.path("rights"));
        for (const String number : { "01", "02", "03" })
        {
            folder.write("left" + number + ".png", pair.left);
            folder.write("right" + number + ".png", pair.right);
            folder.write("lefts/" + number + ".png", pair.left);
            folder.write("rights/" + number + ".png", pair.right);
        }
        Mat both;
        cv::hconcat(pair.left, pair.right, both);
        folder.write("both.png", both);
        const Mat camera = (Mat_<double>(3, 3) << 200, 0, 79.5, 0, 200, 59.5, 0, 0, 1), none = Mat::zeros(1, 5, CV_64F);
        FileStorage in(intrinsics, FileStorage::WRITE), out(folder.path("extrinsics.yml"), FileStorage::WRITE);
        in << "M1" << camera << "D1" << none << "M2" << camera << "D2" << none;
        out << "R" << Mat::eye(3, 3, CV_64F) << "T" << (Mat_<double>(3, 1) << -2, 0, 0);
    }
};

TEST(HDPStereo_Programs, camera_sequences)
{
    const CameraFrames frames;
    const DatasetFolder& folder = frames.folder;
    const Execution all = run(folder, frames.sequences + " --output=" + folder.path("shown%02d.png") + " --watch");
    EXPECT_EQ(0, all.status) << all.errors;
    EXPECT_NE(String::npos, all.output.find("3 frames, ")) << all.output;
    EXPECT_NE(String::npos, all.output.find("right camera after ")) << all.output;
    EXPECT_EQ(Size(320, 120), cv::imread(folder.path("shown02.png")).size());
    EXPECT_NE(String::npos, all.output.find("flicker 0.00 px")) << all.output; // the frames are the same
    const String single = run(folder, frames.sequences + " --frames=2 --scale=0.5 --single-frames").output;
    EXPECT_EQ(0u, single.find("2 frames, ")) << single;
    EXPECT_EQ(1, run(folder, frames.sequences + " --preset=tree").status);
    const String uncalibrated = frames.program + folder.path("lefts") + " " + folder.path("rights") + " --no-gui";
    for (const String wrong : { " --num-disparites=32", " lefts", " --watch", " --calibration2=extrinsics.yml" })
        EXPECT_EQ(1, run(folder, uncalibrated + wrong).status) << wrong;
}

TEST(HDPStereo_Programs, camera_folders_and_their_results)
{
    const CameraFrames frames;
    const DatasetFolder& folder = frames.folder;
    const String results = folder.path("results"),
                 command = frames.program + folder.path("lefts") + " " + folder.path("rights") + frames.options;
    EXPECT_EQ(0u, run(folder, command + " --results=" + results).output.find("3 frames, "));
    const Mat depth = cv::imread(results + "/000002_depth.png", IMREAD_ANYDEPTH);
    const Mat disparity = cv::imread(results + "/000002_disparity.pfm", IMREAD_ANYDEPTH);
    ASSERT_EQ(CV_16UC1, depth.type());
    ASSERT_EQ(frames.pair.left.size(), depth.size());
    EXPECT_NEAR(1000 * 200 * 0.2 / disparity.at<float>(60, 100), depth.at<ushort>(60, 100), 1);
    const Mat metres = cv::imread(results + "/000002_depth.pfm", IMREAD_ANYDEPTH);
    EXPECT_NEAR(metres.at<float>(60, 100), depth.at<ushort>(60, 100) / 1000., 0.001);
    EXPECT_TRUE(cv::utils::fs::exists(results + "/000002_points.ply"));
}

//! Both images in one picture, and images of other types
TEST(HDPStereo_Programs, camera_images)
{
    const CameraFrames frames;
    const DatasetFolder& folder = frames.folder;
    EXPECT_EQ(0u, run(folder, frames.program + folder.path("both.png") + frames.options).output.find("1 frames, "));
    for (int type : { CV_8UC1, CV_16UC1, CV_8UC4 })
    {
        for (const String side : { "left", "right" })
        {
            Mat image = side == "left" ? frames.pair.left : frames.pair.right;
            cv::cvtColor(image, image, type == CV_8UC4 ? COLOR_BGR2BGRA : COLOR_BGR2GRAY);
            image.convertTo(image, type, CV_MAT_DEPTH(type) == CV_16U ? 16 : 1);
            folder.write(side + "01.png", image);
        }
        EXPECT_EQ(0u, run(folder, frames.sequences + " --frames=1").output.find("1 frames, ")) << "type " << type;
    }
}

//! Grey floats of any range, with NaN, and with what no raw pixel reaches
TEST(HDPStereo_Programs, camera_floats)
{
    const CameraFrames frames;
    const DatasetFolder& folder = frames.folder;
    const cv::Rect hole(60, 70, 20, 20);
    Mat grey[2];
    for (int i = 0; i < 2; ++i)
    {
        cv::cvtColor(i ? frames.pair.right : frames.pair.left, grey[i], COLOR_BGR2GRAY);
        cv::normalize(grey[i], grey[i], 0, 255, cv::NORM_MINMAX);
    }
    for (const Point2d& range : { Point2d(0.01, 280), Point2d(1e-6, -1e-4), Point2d(1e6, -1e9) }) // scale, smallest
    {
        SCOPED_TRACE(range);
        for (int i = 0; i < 2; ++i)
        {
            Mat levels;
            grey[i].convertTo(levels, CV_32F, range.x, range.y);
            levels(hole) = std::numeric_limits<float>::quiet_NaN();
            folder.write(i ? "right.pfm" : "left.pfm", levels);
        }
        for (const bool hasRig : { false, true })
        {
            const String options = hasRig ? frames.options + " --field-of-view=60" : " --no-gui --num-disparities=32";
            const Execution result =
                run(folder, frames.program + folder.path("left.pfm") + " " + folder.path("right.pfm") + options +
                                " --output=" + folder.path("shown%02d.png") + " --results=" + folder.path("results"));
            EXPECT_EQ(0u, result.output.find("1 frames, ")) << result.errors;
            const Mat left = cv::imread(folder.path("results/000000_left.png"), IMREAD_GRAYSCALE),
                      shown = cv::imread(folder.path("shown00.png"), IMREAD_GRAYSCALE);
            ASSERT_EQ(Size(160, 120), left.size());
            ASSERT_EQ(Size(320, 120), shown.size());
            const cv::Rect lower(0, 60, 160, 60); // below the text
            EXPECT_EQ(0, cv::norm(left(lower), shown(lower), NORM_INF));
            Mat expected = grey[0].clone();
            expected(hole) = 0;
            if (hasRig) // sees 44 degrees
                EXPECT_NEAR(cv::mean(expected, expected != 0)[0], cv::mean(left, left != 0)[0], 10);
            else
                EXPECT_GE(1, cv::norm(expected, left, NORM_INF));
        }
    }
}

TEST(HDPStereo_Programs, camera_mistakes)
{
    const CameraFrames frames;
    const DatasetFolder& folder = frames.folder;
    const String both = folder.path("both.png") + " --no-gui", results = folder.path("results");
    const std::pair<String, String> wrong[] = {
        { " --no-gui", "a source is needed" },
        { "no/such/video.avi --no-gui", "cannot open the source no/such/video.avi" },
        { folder.path("lefts") + " no/such/folder --no-gui", "cannot open the source no/such/folder" },
        { both + " -c=no/such.yml --results=" + results, "cannot read the calibration 'no/such.yml'" },
        { both + " -c=" + frames.intrinsics + " --results=" + results,
          "'" + frames.intrinsics + "': T/data is missing" },
        { "no/such/video.avi --no-gui --results=" + results, "cannot open the source no/such/video.avi" },
        { both + " --results=" + folder.path("both.png"), "cannot make the folder '" + folder.path("both.png") },
        { both + " --num-disparities=many", "--num-disparities=many: not a whole number from 0 to 4095" },
        { both + " --min-disparity=1.5", "--min-disparity=1.5: not a whole number from -2047 to 2047" },
        { both + " --field-of-view=abc", "--field-of-view=abc: not a number from 0 to 170" },
        { both + " --unit=abc", "--unit=abc: not a number from 0 to 1000000" },
        { both + " --unit=nan", "--unit=nan: not a number from 0 to 1000000" },
        { both + " --scale=2", "--scale=2: not a number from 0.05 to 1" },
        { both + " --scale=0.5x", "--scale=0.5x: not a number from 0.05 to 1" },
        { both + " --frames=0", "--frames=0: not a whole number from 1 to " },
        { both + " --frames=-3", "--frames=-3: not a whole number from 1 to " },
    };
    for (const auto& call : wrong)
    {
        const Execution bad = run(folder, frames.program + call.first);
        EXPECT_EQ(1, bad.status) << call.first;
        EXPECT_EQ(0u, bad.errors.find("error: " + call.second)) << bad.errors;
        EXPECT_EQ(firstLine(bad.errors) + "\n", bad.errors);
    }
    EXPECT_FALSE(cv::utils::fs::exists(results)); // no empty folder stays
}

}} // namespace opencv_test

#endif
