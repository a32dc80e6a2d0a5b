// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The reader of datasets, on small generated folders of each layout.

#include "test_precomp.hpp"
#include "dataset_folder.hpp"

#include "evaluation/datasets.hpp"

#include <cmath>

namespace opencv_test { namespace {

using namespace hdp_tools;

const char* const plainNames[4] = { "left.png", "right.png", "disp_left.png", "disp_right.png" };
const char* const officialNames[4] = { "view1.png", "view5.png", "disp1.png", "disp5.png" };
const char* const oldNames[4] = { "im2.png", "im6.png", "disp2.png", "disp6.png" };

std::vector<String> setsAndNames(const std::vector<Scene>& scenes)
{
    std::vector<String> names;
    for (const Scene& scene : scenes)
        names.push_back(scene.set + "/" + scene.name);
    return names;
}

//! Expects the truth of halves(): columns 0 .. 11 have 4 disparities, the others 8.
void expectHalves(const Pair& pair)
{
    ASSERT_EQ(pair.left.size(), pair.truth.size());
    EXPECT_EQ(CV_8UC3, pair.left.type());
    EXPECT_EQ(50, pair.left.at<Vec3b>(3, 5)[1]);
    EXPECT_EQ(60, pair.right.at<Vec3b>(3, 5)[1]);
    EXPECT_EQ(4.f, pair.truth.at<float>(2, 11));
    EXPECT_EQ(8.f, pair.truth.at<float>(2, 12));
}

//! Expects an exception that names the file.
template <typename Action> void expectFailure(const Action& action, const String& text)
{
    try
    {
        action();
        ADD_FAILURE() << "no exception about " << text;
    }
    catch (const std::exception& e)
    {
        EXPECT_NE(std::string::npos, String(e.what()).find(text))
            << "the message does not have " << text << ": " << e.what();
    }
}

TEST(HDPStereo_Datasets, middlebury_2006_trees)
{
    DatasetFolder folder;
    const struct
    {
        const char *tree, *resolution;
        int divisor;
    } trees[] = { { "FullSize", "full", 1 }, { "HalfSize", "half", 2 }, { "ThirdSize", "third", 3 } };
    for (const auto& tree : trees)
        for (const char* scene : { "Aloe", "Wood1" })
            folder.writeScene(String(tree.tree) + "/" + scene, officialNames, tree.divisor);

    const std::vector<Scene> scenes = findScenes(folder.root);
    EXPECT_EQ((std::vector<String>{ "FullSize/Aloe", "FullSize/Wood1", "HalfSize/Aloe", "HalfSize/Wood1",
                                    "ThirdSize/Aloe", "ThirdSize/Wood1" }),
              setsAndNames(scenes));
    for (size_t i = 0; i < scenes.size(); ++i)
    {
        EXPECT_EQ(trees[i / 2].resolution, scenes[i].resolution);
        const Pair pair = readPair(scenes[i]);
        expectHalves(pair);
        EXPECT_EQ(Pair::MIDDLEBURY, pair.protocol);
        EXPECT_EQ(256 / trees[i / 2].divisor, pair.disparities.end);
        EXPECT_DOUBLE_EQ(std::sqrt(1 / 12.) / trees[i / 2].divisor, pair.truthDeviation); // whole pixels of full size
        // Columns 0 .. 3 leave the image, 12 .. 19 come to disparities of 4, and 20 .. 23 to 8.
        EXPECT_EQ(0, countNonZero(pair.judged.colRange(0, 4)));
        EXPECT_EQ(8 * 12, countNonZero(pair.judged.colRange(4, 12)));
        EXPECT_EQ(0, countNonZero(pair.judged.colRange(12, 20)));
        EXPECT_EQ(4 * 12, countNonZero(pair.judged.colRange(20, 24)));
    }
}

//! The sets of 7 views have the truth once, above the images of every illumination and exposure.
TEST(HDPStereo_Datasets, middlebury_2006_of_seven_views)
{
    DatasetFolder folder;
    for (const char* name : { "disp1.png", "disp5.png" })
        folder.write(String("HalfSize/Aloe/") + name, DatasetFolder::halves(pairSize, CV_8U, 8, 16));
    for (const char* images :
         { "HalfSize/Aloe/Illum1/Exp0/", "HalfSize/Aloe/Illum3/Exp2/", "HalfSize/Art/Illum1/Exp0/" })
    {
        folder.writePicture(String(images) + "view1.png", 50);
        folder.writePicture(String(images) + "view5.png", 60);
    }
    const std::vector<Scene> scenes = findScenes(folder.root);
    EXPECT_EQ((std::vector<String>{ "HalfSize/Aloe_Illum1_Exp0", "HalfSize/Aloe_Illum3_Exp2",
                                    "HalfSize/Art/Illum1/Exp0" }), // as published, without truth
              setsAndNames(scenes));
    for (int i = 0; i < 2; ++i)
    {
        EXPECT_EQ("half", scenes[i].resolution);
        expectHalves(readPair(scenes[i]));
    }
    EXPECT_EQ(Pair::NO_TRUTH, readPair(scenes[2]).protocol);
}

TEST(HDPStereo_Datasets, plain_names_and_roots_of_any_depth)
{
    DatasetFolder folder;
    folder.writeScene("data/middlebury2006/half/Aloe", plainNames, 2);
    folder.writeScene("data/middlebury2003/quarter/cones", oldNames, 4);
    folder.writePicture("data/lowquality/street/left.jpg");
    folder.writePicture("data/lowquality/street/right.jpg");
    folder.writePicture("data/.hidden/scene/left.png");
    folder.writePicture("data/other/photograph.png");

    std::vector<Scene> scenes = findScenes(folder.path("data"));
    EXPECT_EQ((std::vector<String>{ "lowquality/street", "middlebury2003/quarter/cones", "middlebury2006/half/Aloe" }),
              setsAndNames(scenes));
    EXPECT_EQ("", scenes[0].resolution);
    const Pair street = readPair(scenes[0]);
    EXPECT_EQ(Pair::NO_TRUTH, street.protocol);
    EXPECT_TRUE(street.truth.empty());
    EXPECT_EQ(16, street.disparities.end);
    EXPECT_EQ("quarter", scenes[1].resolution);
    EXPECT_EQ(64, readPair(scenes[1]).disparities.end);
    expectHalves(readPair(scenes[1]));
    EXPECT_EQ("half", scenes[2].resolution);
    expectHalves(readPair(scenes[2]));

    for (const char* root :
         { "data/middlebury2006/half", "data/middlebury2006/half/", "data/middlebury2006/half/Aloe" })
    {
        scenes = findScenes(folder.path(root));
        EXPECT_EQ(std::vector<String>{ "half/Aloe" }, setsAndNames(scenes)) << root;
        EXPECT_EQ("half", scenes[0].resolution) << root;
    }
}

TEST(HDPStereo_Datasets, scenes_of_a_set_are_not_parted)
{
    DatasetFolder folder;
    for (const char* scene : { "data/a", "data/between/b", "data/c" })
        folder.writeScene(scene, plainNames);
    EXPECT_EQ((std::vector<String>{ "data/a", "data/c", "between/b" }), setsAndNames(findScenes(folder.path("data"))));
}

TEST(HDPStereo_Datasets, resolution_by_height)
{
    DatasetFolder folder;
    for (int divisor = 1; divisor <= 3; ++divisor)
        folder.writeScene(cv::format("mine/scene%d", divisor), officialNames, divisor, Size(24, 1110 / divisor));
    folder.writeScene("mine/scene4", officialNames, 1, Size(24, 100)); // whole disparities of any other size
    const std::vector<Scene> scenes = findScenes(folder.root);
    ASSERT_EQ(4u, scenes.size());
    const char* const resolutions[] = { "full", "half", "third", "" };
    for (int i = 0; i < 4; ++i)
    {
        EXPECT_EQ(resolutions[i], scenes[i].resolution);
        EXPECT_EQ(8.f, readPair(scenes[i]).truth.at<float>(5, 20));
    }
}

TEST(HDPStereo_Datasets, middlebury_2014_and_eval3)
{
    DatasetFolder folder;
    Mat truth = DatasetFolder::halves(pairSize, CV_32F, 4, 8.25);
    truth.at<float>(0, 5) = std::numeric_limits<float>::infinity();
    const struct
    {
        const char *scene, *left, *right;
    } scenes[] = { { "trainingH/Piano", "disp0GT.pfm", "disp1GT.pfm" }, { "2014/Pipes", "disp0.pfm", "disp1.pfm" } };
    for (const auto& scene : scenes)
    {
        const String name = String(scene.scene) + "/";
        folder.writePicture(name + "im0.png", 50);
        folder.writePicture(name + "im1.png", 60);
        folder.write(name + scene.left, truth);
        folder.write(name + scene.right, truth + 0.5f);
        folder.writeText(name + "calib.txt", "cam0=[1 0 0; 0 1 0; 0 0 1]\nwidth=24\nheight=12\nndisp=70\nisint=0\n");
    }
    folder.writePicture("testH/Plants/im0.png"); // without truth
    folder.writePicture("testH/Plants/im1.png");
    folder.writeText("testH/Plants/calib.txt", "ndisp=290\r\n");

    std::vector<Scene> found = findScenes(folder.root);
    EXPECT_EQ((std::vector<String>{ "2014/Pipes", "testH/Plants", "trainingH/Piano" }), setsAndNames(found));
    EXPECT_EQ("half", found[2].resolution);
    for (int i : { 0, 2 })
    {
        const Pair pair = readPair(found[i]);
        EXPECT_EQ(Pair::BAD, pair.protocol);
        EXPECT_EQ(0, pair.truthDeviation); // floats are not rounded
        EXPECT_EQ(70, pair.disparities.end);
        EXPECT_EQ(8.25f, pair.truth.at<float>(3, 20));
        EXPECT_EQ(NO_DISPARITY, pair.truth.at<float>(0, 5));
        EXPECT_EQ(0, pair.judged.at<uchar>(0, 5));
        EXPECT_EQ(255, pair.judged.at<uchar>(1, 5)); // half a pixel is within the tolerance
        EXPECT_EQ(0, pair.judged.at<uchar>(1, 12));
        EXPECT_EQ(255, pair.judged.at<uchar>(1, 21));
    }
    EXPECT_EQ(Pair::NO_TRUTH, readPair(found[1]).protocol);
    EXPECT_EQ(290, readPair(found[1]).disparities.end);

    // The mask goes before the right truth.
    Mat mask(pairSize, CV_8U, Scalar(128));
    mask.colRange(12, 24).setTo(255);
    folder.write("trainingH/Piano/mask0nocc.png", mask);
    found = findScenes(folder.root);
    EXPECT_EQ(12 * 12, countNonZero(readPair(found[2]).judged));
    EXPECT_FALSE(readPair(found[2]).rightTruth.empty());

    // With the mask, no right truth is needed: MiddEval3 as published, and SceneFlow in its layout.
    ASSERT_EQ(0, std::remove(folder.path("trainingH/Piano/disp1GT.pfm").c_str()));
    const Pair masked = readPair(findScenes(folder.root)[2]);
    EXPECT_EQ(12 * 12, countNonZero(masked.judged));
    EXPECT_TRUE(masked.rightTruth.empty());
    EXPECT_EQ(Pair::BAD, masked.protocol);

    for (const char* text : { "", "ndisp=\n", "ndisp=many\n", "ndisp=70x\n", "ndisp=0\n", "ndisp=-5\n", "ndisp=99999\n",
                              "ndisp=9999999999999999999999\n" })
    {
        folder.writeText("2014/Pipes/calib.txt", text);
        expectFailure([&] { readPair(findScenes(folder.root)[0]); }, "calib.txt");
    }
    std::remove(folder.path("2014/Pipes/calib.txt").c_str());
    expectFailure([&] { readPair(findScenes(folder.root)[0]); }, "calib.txt");
}

//! MiddEval3 and ETH3D with plain names: truth in PFM, and a mask
TEST(HDPStereo_Datasets, plain_names_with_a_mask)
{
    DatasetFolder folder;
    Mat truth = DatasetFolder::halves(pairSize, CV_32F, 4, 8), mask(pairSize, CV_8U, Scalar(255));
    truth.at<float>(0, 5) = std::numeric_limits<float>::infinity();
    truth.at<float>(1, 5) = 0; // known
    mask.col(23).setTo(128);
    for (const char* scene : { "eth3d/forest/", "middeval3/Piano/" })
    {
        folder.writePicture(String(scene) + "left.png", 50);
        folder.writePicture(String(scene) + "right.png", 60);
        folder.write(String(scene) + "disp_left.pfm", truth);
        folder.write(String(scene) + "nonoccluded.png", mask);
    }
    // ETH3D does not know the range, and gives the width.
    folder.writeText("eth3d/forest/calib.txt", cv::format("width=%d\nndisp=%d\n", pairSize.width, pairSize.width));
    folder.writeText("middeval3/Piano/calib.txt", "ndisp=70\n");
    const std::vector<Scene> scenes = findScenes(folder.root);
    ASSERT_EQ((std::vector<String>{ "eth3d/forest", "middeval3/Piano" }), setsAndNames(scenes));
    for (int i = 0; i < 2; ++i)
    {
        const Pair pair = readPair(scenes[i]);
        EXPECT_EQ(Pair::BAD, pair.protocol);
        EXPECT_EQ(i == 0 ? 64 : 70, pair.disparities.end);
        EXPECT_EQ(0.f, pair.truth.at<float>(1, 5));
        EXPECT_EQ(0, pair.judged.at<uchar>(0, 5));
        EXPECT_EQ(23 * 12 - 1, countNonZero(pair.judged));
    }

    // A pair without truth may have a calibration, too.
    folder.writePicture("video/still/left.png");
    folder.writePicture("video/still/right.png");
    folder.writeText("video/still/calib.txt", "ndisp=290\n");
    EXPECT_EQ(290, readPair(findScenes(folder.path("video")).at(0)).disparities.end);
}

TEST(HDPStereo_Datasets, kitti_video)
{
    DatasetFolder folder;
    Mat truth = Mat::zeros(pairSize, CV_16U); // of a few pixels only
    truth.at<ushort>(3, 7) = 5 * 256;
    truth.at<ushort>(4, 20) = 6 * 256 + 64;
    for (const char* frame : { "0000000000.png", "0000000001.png" })
    {
        folder.write(String("video/left/") + frame, Mat(pairSize, CV_8U, Scalar(50)));
        folder.write(String("video/right/") + frame, Mat(pairSize, CV_8U, Scalar(60)));
        folder.write(String("video/disp_lidar/") + frame, truth);
    }
    const std::vector<Scene> scenes = findScenes(folder.path("video"));
    ASSERT_EQ((std::vector<String>{ "video/0000000000", "video/0000000001" }), setsAndNames(scenes));
    const Pair pair = readPair(scenes[1]);
    EXPECT_EQ(Pair::KITTI, pair.protocol);
    EXPECT_EQ(CV_8UC3, pair.left.type());
    EXPECT_EQ(2, countNonZero(pair.judged));
    EXPECT_EQ(6.25f, pair.truth.at<float>(4, 20));
    EXPECT_TRUE(pair.judgedNonOccluded.empty());
}

TEST(HDPStereo_Datasets, kitti)
{
    DatasetFolder folder;
    Mat all = DatasetFolder::halves(pairSize, CV_16U, 4 * 256, 8 * 256 + 128), some = all.clone();
    all.row(0).setTo(0);
    some.rowRange(0, 6).setTo(0);
    const struct
    {
        const char *root, *left, *right, *all, *some;
    } layouts[] = { { "2015/training", "image_2", "image_3", "disp_occ_0", "disp_noc_0" },
                    { "2012/training", "colored_0", "colored_1", "disp_occ", "disp_noc" },
                    { "grey/training", "image_0", "image_1", "disp_occ", "disp_noc" } };
    for (const auto& layout : layouts)
        for (const char* frame : { "000000_10.png", "000001_10.png" })
        {
            const auto file = [&](const char* kind) { return String(layout.root) + "/" + kind + "/" + frame; };
            folder.writePicture(file(layout.left), 50);
            folder.writePicture(file(layout.right), 60);
            folder.write(file(layout.all), all);
            folder.write(file(layout.some), some);
        }
    for (const char* other : { "000000_11.png", "000001_00.png", "000001_20.png" }) // of other times
    {
        folder.writePicture(String("2015/training/image_2/") + other);
        folder.writePicture(String("2015/training/image_3/") + other);
    }
    folder.writePicture("2015/testing/image_2/000000_10.png");
    folder.writePicture("2015/testing/image_3/000000_10.png");

    for (const auto& layout : layouts)
    {
        const std::vector<Scene> scenes = findScenes(folder.path(layout.root));
        EXPECT_EQ((std::vector<String>{ "training/000000_10", "training/000001_10" }), setsAndNames(scenes));
        const Pair pair = readPair(scenes[1]);
        EXPECT_EQ(Pair::KITTI, pair.protocol);
        EXPECT_EQ(256, pair.disparities.end);
        EXPECT_EQ(NO_DISPARITY, pair.truth.at<float>(0, 0));
        EXPECT_EQ(4.f, pair.truth.at<float>(1, 0));
        EXPECT_EQ(8.5f, pair.truth.at<float>(1, 20));
        EXPECT_EQ(11 * 24, countNonZero(pair.judged));
        EXPECT_EQ(6 * 24, countNonZero(pair.judgedNonOccluded));
    }
    const std::vector<Scene> both = findScenes(folder.path("2015"));
    EXPECT_EQ((std::vector<String>{ "testing/000000_10", "training/000000_10", "training/000001_10" }),
              setsAndNames(both));
    EXPECT_EQ(Pair::NO_TRUTH, readPair(both[0]).protocol);

    std::remove(folder.path("2015/training/image_3/000001_10.png").c_str());
    std::remove(folder.path("2015/training/disp_occ_0/000000_10.png").c_str());
    expectFailure([&] { readPair(both[1]); }, "disp_occ_0/000000_10.png");
    expectFailure([&] { readPair(both[2]); }, "image_3/000001_10.png");
}

//! Pictures of one's own in KITTI's folders may have any number.
TEST(HDPStereo_Datasets, kitti_folders_without_truth)
{
    DatasetFolder folder;
    for (const char* frame : { "walk_01.png", "walk_11.png", "x.png" })
    {
        folder.writePicture(String("mine/image_0/") + frame);
        folder.writePicture(String("mine/image_1/") + frame);
    }
    EXPECT_EQ((std::vector<String>{ "mine/walk_01", "mine/walk_11", "mine/x" }), setsAndNames(findScenes(folder.root)));
}

TEST(HDPStereo_Datasets, kitti_by_scene)
{
    DatasetFolder folder;
    folder.writePicture("kitti2015/000005_10/left.png", 50);
    folder.writePicture("kitti2015/000005_10/right.png", 60);
    folder.write("kitti2015/000005_10/disp_left.png", DatasetFolder::halves(pairSize, CV_16U, 4 * 256, 8 * 256));
    const Pair pair = readPair(findScenes(folder.root).at(0));
    EXPECT_EQ(Pair::KITTI, pair.protocol);
    expectHalves(pair);
    EXPECT_EQ(int(pairSize.area()), countNonZero(pair.judged));
    EXPECT_TRUE(pair.judgedNonOccluded.empty());
}

TEST(HDPStereo_Datasets, bad_scenes_are_named)
{
    for (int i = 0; i < 4; ++i)
    {
        SCOPED_TRACE(officialNames[i]);
        DatasetFolder folder;
        folder.writeScene("full/Aloe", officialNames);
        const String file = folder.path(String("full/Aloe/") + officialNames[i]);
        readPair(findScenes(folder.root).at(0));

        std::remove(file.c_str()); // missing
        expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, officialNames[i]);
        std::ofstream(file.c_str()) << "no image"; // unreadable
        expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, officialNames[i]);
        std::ofstream(file.c_str(), std::ios::trunc); // empty
        expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, officialNames[i]);
        if (i == 0)
            continue; // the others are then of a wrong size
        cv::imwrite(file, Mat(pairSize.height, pairSize.width + 1, CV_8U, Scalar(4)));
        expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, officialNames[i]);
        expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, "25 x 12");
    }
    DatasetFolder folder;
    folder.writeScene("full/Aloe", officialNames);
    folder.write("full/Aloe/disp1.png", Mat::zeros(pairSize, CV_8U));
    expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, "disp1.png' knows no pixel");
    folder.writePicture("full/Aloe/disp1.png");
    expectFailure([&] { readPair(findScenes(folder.root).at(0)); }, "color image");
}

TEST(HDPStereo_Datasets, bad_roots)
{
    DatasetFolder folder;
    expectFailure([&] { findScenes(folder.root); }, folder.root);
    expectFailure([&] { findScenes(folder.path("none")); }, "none' is not a folder");
    folder.writePicture("file.png");
    expectFailure([&] { findScenes(folder.path("file.png")); }, "file.png' is not a folder");
    expectFailure([&] { findScenes(""); }, "is not a folder");
}

}} // namespace opencv_test
