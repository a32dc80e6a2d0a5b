// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// hdpstereo --tiles, and what it does not do to files

#include "test_precomp.hpp"
#include "programs.hpp"

#ifdef __unix__
#include <array>

namespace opencv_test { namespace {

//! A grey TIFF of strips, little-endian, with GDAL's tag of no data if there is a text. missing: the strip that a sparse
//! file of GDAL does not have
void writeTiff(const String& path, const Mat& image, const String& noData = String(), int missing = -1)
{
    const int rows = 16, strips = (image.rows + rows - 1) / rows;
    const size_t rowBytes = image.cols * image.elemSize();
    String bytes("II*\0\0\0\0\0", 8);
    const auto put = [&](size_t number, int count) {
        for (int i = 0; i < count; ++i)
            bytes += (char)(number >> 8 * i & 255);
    };
    for (int y = 0; y < image.rows; ++y)
        bytes.append(image.ptr<char>(y), rowBytes);
    const size_t offsets = bytes.size(), counts = offsets + 4 * strips, text = counts + 4 * strips;
    for (int i = 0; i < strips; ++i)
        put(i == missing ? 0 : 8 + i * rows * rowBytes, 4);
    for (int i = 0; i < strips; ++i)
        put(i == missing ? 0 : std::min(rows, image.rows - i * rows) * rowBytes, 4);
    bytes += noData + String(4, '\0');
    const size_t directory = (bytes.size() + 1) / 2 * 2;
    bytes.resize(directory);
    const size_t textSize = noData.size() + 1, isFloat = image.depth() == CV_32F;
    CV_Assert(noData.empty() || textSize > 4); // or it is in the field itself
    const std::vector<std::array<size_t, 4>> fields = { { { 256, 4, 1, (size_t)image.cols } },
                                                        { { 257, 4, 1, (size_t)image.rows } },
                                                        { { 258, 3, 1, 8 * image.elemSize() } },
                                                        { { 259, 3, 1, 1 } },
                                                        { { 262, 3, 1, 1 } },
                                                        { { 273, 4, (size_t)strips, offsets } },
                                                        { { 277, 3, 1, 1 } },
                                                        { { 278, 3, 1, (size_t)rows } },
                                                        { { 279, 4, (size_t)strips, counts } },
                                                        { { 339, 3, 1, isFloat ? 3u : 1u } },
                                                        { { 42113, 2, textSize, text } } };
    const size_t count = fields.size() - noData.empty();
    put(count, 2);
    for (size_t i = 0; i < count; ++i)
    {
        put(fields[i][0], 2);
        put(fields[i][1], 2);
        put(fields[i][2], 4);
        put(fields[i][3], 4);
    }
    put(0, 4);
    for (int i = 0; i < 4; ++i)
        bytes[4 + i] = (char)(directory >> 8 * i & 255);
    std::ofstream(path.c_str(), std::ios::binary) << bytes;
}

//! The pair in 16 bit, with room for a level of no data below
Mat sixteenBit(const Mat& image)
{
    Mat grey;
    cvtColor(image, grey, COLOR_BGR2GRAY);
    grey.convertTo(grey, CV_16U, 16, 1000);
    return grey;
}

Mat greyFloats(const Mat& image)
{
    Mat floats;
    cvtColor(image, floats, COLOR_BGR2GRAY);
    floats.convertTo(floats, CV_32F, 0.01, -1);
    return floats;
}

//! Tiles that know their place have no seams, whatever the file is read by.
TEST(HDPStereo_SlowTiles, make_the_map_of_the_whole)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSlantedPlane(Size(1000, 600), 32, 9);
    const String whole = folder.path("whole.pfm"), tiled = folder.path("tiled.tif"), model = folder.path("rig.yml");
    for (const char* const extension : { "png", "tif", "tiff" })
    {
        SCOPED_TRACE(extension);
        const String left = String("left.") + extension, right = String("right.") + extension;
        const bool isFloat = extension == String("tiff");
        folder.write(left, isFloat ? greyFloats(pair.left) : pair.left);
        folder.write(right, isFloat ? greyFloats(pair.right) : pair.right);
        const String images = " " + folder.path(left) + " " + folder.path(right) + " --num-disparities=32 ";
        EXPECT_EQ(0, run(folder, "hdpstereo" + images + whole + " --save-findings=" + model).status);
        const Mat expected = cv::imread(whole, IMREAD_UNCHANGED);
        for (const bool isGiven : { false, true }) // what is found in reduced images is a bit different
        {
            if (!isGiven && extension != String("png"))
                continue; // one kind of files is enough for that
            const Execution result = run(folder, "hdpstereo --tiles --memory=96" + images + tiled +
                                                     (isGiven ? " --findings=" + model : String()));
            EXPECT_EQ(0, result.status) << result.errors;
            EXPECT_EQ(String::npos, result.output.find("tiles      1 of")) << result.output;
            const Mat map = cv::imread(tiled, IMREAD_UNCHANGED);
            ASSERT_EQ(expected.size(), map.size());
            EXPECT_EQ((int)map.total(), cv::countNonZero(map == map)); // no NaN
            EXPECT_LE(cv::countNonZero(cv::abs(expected - map) > (isGiven ? 0 : 1)), isGiven ? 6000 : 1500);
            EXPECT_LE(cv::countNonZero(cv::abs(expected - map) > 1), 1500);
        }
    }
    const String images = " " + folder.path("left.png") + " " + folder.path("right.png") + " ";
    for (const String& wrong : { "--memory=1 out.tif" + String(), "--picture=a.png out.tif" + String(), String(),
                                 "--memory=x out.tif" + String(), "/no/such/folder/out.tif" + String() })
        EXPECT_EQ(1, run(folder, "hdpstereo --tiles" + images + wrong).status) << wrong;
}

//! Inputs, and maps that are there, are as they were, and no part of a map is left.
TEST(HDPStereo_Tiles, errors_change_no_file)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 21);
    writeTiff(folder.path("left.tif"), sixteenBit(pair.left));
    writeTiff(folder.path("right.tif"), sixteenBit(pair.right));
    folder.write("deep.tif", pair.left);
    writeTiff(folder.path("wide.tif"), Mat(120, 170, CV_16U, Scalar(5)));
    const String left = folder.path("left.tif"), right = folder.path("right.tif"), out = folder.path("out.tif"),
                 link = folder.path("link.tif"), model = folder.path("model.yml"), before = readText(left),
                 images = left + " " + right + " ";
    ASSERT_EQ(0, symlink(left.c_str(), link.c_str()));
    const String program = "hdpstereo --num-disparities=32 ";
    EXPECT_EQ(0, run(folder, program + images + " --save-findings=" + model).status);
    PairModel changed = PairModel::load(model);
    changed.width = changed.tileWidth = 150;
    changed.save(folder.path("narrow.yml"));
    changed = PairModel::load(model);
    changed.depth = CV_8U;
    changed.bits = 8;
    changed.save(folder.path("bytes.yml"));
    folder.write("map.png", Mat(120, 160, CV_8U));
    Mat limit(120, 160, CV_32F, Scalar(8));
    writeTiff(folder.path("smallest.tif"), limit);
    limit.at<float>(119, 159) = 7;
    writeTiff(folder.path("largest.tif"), limit);
    limit.at<float>(119, 159) = 3000;
    writeTiff(folder.path("beyond.tif"), limit);
    writeTiff(folder.path("nine.tif"), Mat(120, 160, CV_32F, Scalar(9)));
    writeTiff(folder.path("below.tif"), Mat(120, 160, CV_32F, Scalar(-3000)));

    const std::pair<String, String> wrong[] = {
        { images + left, "cannot write '" + left + "': it is LEFT" },
        { images + link, "cannot write '" + link + "': it is LEFT" },
        { images + "--output=" + right, "cannot write '" + right + "': it is RIGHT" },
        { images + out + " --findings=" + folder.path("narrow.yml"),
          "--findings=" + folder.path("narrow.yml") + " is of images of 150 x 120 pixels, and these have 160 x 120" },
        { images + out + " --findings=" + folder.path("bytes.yml"),
          "--findings=" + folder.path("bytes.yml") + " is of images of 8 bit, and these are of 16 bit" },
        { images + out + " --save-findings=/no/x.yml", "cannot write '/no/x.yml': there is no folder '/no'" },
        { images + folder.path("out.xyz"), "cannot write '" + folder.path("out.xyz") + "': no image format has" },
        { images + folder.path("out.jpg"), "cannot write '" + folder.path("out.jpg") + "': disparities need .png" },
        { images + folder.path("out.png") + " --min-disparity=-8", "PNG has no disparities below 0" },
        { left + " " + folder.path("wide.tif") + " " + out, "RIGHT must have the size of LEFT, 160 x 120, not 170" },
        { left + " " + folder.path("deep.tif") + " " + out, "RIGHT must have the type of LEFT" },
        { images + out + " --right-mask=" + folder.path("wide.tif"), "--right-mask must have the size of LEFT" },
        { images + out + " --prior=" + folder.path("map.png"), "'" + folder.path("map.png") + "' must have dispariti" },
        { images + out + " --prior=" + folder.path("wide.tif"), "--prior must have the size of LEFT" },
        { images + out + " --prior=" + left + " --prior-sigma=x", "--prior-sigma=x is not a number" },
        { images + out + " --prior=" + left + " --prior-sigma=-1", "--prior-sigma must be >= 0" },
        { images + out + " --smallest=" + folder.path("smallest.tif") + " --largest=" + folder.path("largest.tif"),
          "--largest must not be less than --smallest, as it is in 1 pixels" },
        { images + out + " --smallest=" + folder.path("nine.tif") + " --largest=" + folder.path("smallest.tif"),
          "--largest must not be less than --smallest, as it is in 19200 pixels" },
        { images + out + " --smallest=" + folder.path("beyond.tif") + " --largest=" + folder.path("beyond.tif") +
              " --save-findings=" + folder.path("found.yml"),
          "--smallest must be below 2048 and --largest at least -2048, as they are not in 1 pixels" },
        { images + out + " --largest=" + folder.path("below.tif"),
          "--smallest must be below 2048 and --largest at least -2048, as they are not in 19200 pixels" },
    };
    folder.writeText("out.tif", "an old map");
    for (const auto& call : wrong)
    {
        const Execution result = run(folder, program + "--tiles " + call.first);
        EXPECT_EQ(1, result.status) << call.first;
        EXPECT_EQ("", result.output) << call.first;
        EXPECT_EQ(0u, result.errors.find("error: " + call.second)) << call.first << "\n" << result.errors;
        EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
    }
    EXPECT_TRUE(readText(out) == "an old map");
    EXPECT_TRUE(readText(left) == before);
    EXPECT_FALSE(fs::exists(folder.path("found.yml")));
    EXPECT_FALSE(fs::exists(out + ".part"));
}

//! Neither an old map nor a part of a new one
TEST(HDPStereo_Tiles, a_map_is_whole_or_not_there)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSlantedPlane(Size(400, 1200), 32, 9);
    const String left = folder.path("left.tif"), right = folder.path("right.tif"), out = folder.path("out.tif"),
                 torn = folder.path("torn.tif"), model = folder.path("model.yml"),
                 program = "hdpstereo --num-disparities=32 ", tiles = "--tiles --memory=96 --findings=" + model + " ";
    writeTiff(left, sixteenBit(pair.left));
    writeTiff(right, sixteenBit(pair.right));
    EXPECT_EQ(0, run(folder, program + left + " " + right + " --save-findings=" + model).status);
    folder.writeText("out.tif", "an old map");

    String bytes = readText(left);
    const int pixels = 2 * 400 * 1200, strips = 1200 / 16;
    bytes[8 + pixels + 4 * strips - 1] = 0x70; // the last strip is where the file has ended
    std::ofstream(torn.c_str(), std::ios::binary) << bytes;
    const Execution failed = run(folder, program + tiles + torn + " " + right + " " + out);
    EXPECT_EQ(1, failed.status);
    EXPECT_EQ("error: cannot read the image '" + torn + "'\n", failed.errors);
    EXPECT_TRUE(readText(out) == "an old map");
    EXPECT_FALSE(fs::exists(out + ".part"));

    const String killed = "sh -c '\"$0\" \"$@\" & while [ ! -s " + out +
                          ".part ] && kill -0 $! 2>/dev/null; do sleep 0.01;" +
                          " done; kill $!; wait $!'"; // once tiles are matched
    const Execution interrupted = run(folder, program + tiles + left + " " + right + " " + out, String(), killed);
    EXPECT_EQ(130, interrupted.status);
    EXPECT_EQ("interrupted: no map is written\n", interrupted.errors);
    EXPECT_TRUE(readText(out) == "an old map");
    EXPECT_FALSE(fs::exists(out + ".part"));

    EXPECT_EQ(0, run(folder, program + tiles + left + " " + right + " " + out).status);
    EXPECT_EQ(CV_32FC1, cv::imread(out, IMREAD_UNCHANGED).type());
    EXPECT_FALSE(fs::exists(out + ".part"));
}

//! Whether the file of a map is this one, to the bit, NaN being equal
bool isMap(const String& path, const Mat& expected)
{
    Mat map = cv::imread(path, IMREAD_UNCHANGED), other = expected.clone();
    cv::patchNaNs(map, -1);
    cv::patchNaNs(other, -1);
    return map.size() == other.size() && cvtest::norm(map, other, NORM_INF) == 0;
}

//! What a file declares as no data, and masks, are as masks of the whole are; ranges and a prior, likewise.
TEST(HDPStereo_Tiles, cut_all_that_is_known)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(700, 400), 32, 9);
    const Rect empty(200, 150, 250, 150);
    Mat mask(pair.left.size(), CV_8U, Scalar(255)), prior, smallest(mask.size(), CV_32F, Scalar(4)),
        largest(mask.size(), CV_32F, Scalar(31));
    mask(empty).setTo(0);
    folder.write("mask.png", mask);
    pair.truth.convertTo(prior, CV_32F);
    prior.colRange(0, 300).setTo(-9999);
    largest.rowRange(300, 400).setTo(-9999); // less than smallest
    writeTiff(folder.path("prior.tif"), prior, "-9999");
    writeTiff(folder.path("smallest.tif"), smallest);
    writeTiff(folder.path("largest.tif"), largest, "-9999");
    const String out = folder.path("out.tif"), whole = folder.path("whole.tif"), mine = folder.path("rig.yml");
    const String masks = " --left-mask=" + folder.path("mask.png") + " --right-mask=" + folder.path("mask.png");
    const String known = " --prior=" + folder.path("prior.tif") + " --smallest=" + folder.path("smallest.tif") +
                         " --largest=" + folder.path("largest.tif");
    for (const bool isFloat : { false, true })
    {
        SCOPED_TRACE(isFloat);
        for (const String side : { "left", "right" })
        {
            Mat image = sixteenBit(side == "left" ? pair.left : pair.right);
            if (isFloat)
                image.convertTo(image, CV_32F);
            writeTiff(folder.path(side + ".tif"), image);
            image.setTo(isFloat ? -9999 : 300, ~mask);
            writeTiff(folder.path("holed_" + side + ".tif"), image, isFloat ? "-9999" : "300.0");
        }
        const String images = " " + folder.path("left.tif") + " " + folder.path("right.tif") + " ",
                     holed = " " + folder.path("holed_left.tif") + " " + folder.path("holed_right.tif") + " ",
                     options = "--num-disparities=32 --preset=ultrafast",
                     tiles = "hdpstereo --tiles --memory=88 " + options;
        ASSERT_EQ(
            0,
            run(folder, "hdpstereo " + options + images + whole + masks + known + " --save-findings=" + mine).status);
        const Mat expected = cv::imread(whole, IMREAD_UNCHANGED);
        EXPECT_EQ(0, cv::countNonZero((expected < FLT_MAX) != mask)); // where it is NaN
        EXPECT_EQ(0, run(folder, "hdpstereo " + options + holed + out + known).status);
        EXPECT_TRUE(isMap(out, expected));
        folder.writeText("list.txt", folder.path("holed_left.tif") + " " + folder.path("holed_right.tif") + " map\n");
        const String maps = folder.path(isFloat ? "of_floats" : "of_levels");
        EXPECT_EQ(0, run(folder, "hdpstereo --batch --format=tif " + options + known + " " + folder.path("list.txt") +
                                     " " + maps)
                         .status);
        EXPECT_TRUE(isMap(maps + "/map.tif", expected));
        for (const String& call : { images + out + masks, holed + out })
        {
            const Execution result = run(folder, tiles + call + known + " --findings=" + mine);
            ASSERT_EQ(0, result.status) << result.errors;
            EXPECT_EQ(String::npos, result.output.find("tiles      1 of")) << result.output;
            const Mat map = cv::imread(out, IMREAD_UNCHANGED);
            EXPECT_EQ(0, cv::countNonZero((map < FLT_MAX) != mask));
            EXPECT_EQ(0, cv::countNonZero(map < 4));
            EXPECT_LE(cv::countNonZero(cv::abs(expected - map) > 1), 2800);
        }
        // The reduced pair has no data there either.
        const Execution found = run(folder, tiles + holed + out);
        EXPECT_EQ(0, found.status) << found.errors;
    }
}

//! Ranges that limit all pixels are that of all tiles: a thing that few corners are on is not lost.
TEST(HDPStereo_Tiles, find_the_range_in_those_of_pixels)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(700, 400), 32, 9);
    folder.write("left.png", pair.left);
    folder.write("right.png", pair.right);
    Mat truth;
    pair.truth.convertTo(truth, CV_32F);
    const Rect box(100, 100, 60, 40);
    Mat smallest = truth - 3, largest = truth + 3;
    smallest(box).setTo(70);
    largest(box).setTo(75);
    writeTiff(folder.path("smallest.tif"), smallest);
    writeTiff(folder.path("largest.tif"), largest);
    const String out = folder.path("out.tif");
    const Execution result =
        run(folder, "hdpstereo --tiles --memory=96 --num-disparities=0 " + folder.path("left.png") + " " +
                        folder.path("right.png") + " " + out + " --smallest=" + folder.path("smallest.tif") +
                        " --largest=" + folder.path("largest.tif"));
    ASSERT_EQ(0, result.status) << result.errors;
    const Mat map = cv::imread(out, IMREAD_UNCHANGED);
    EXPECT_EQ(0, cv::countNonZero(~((map >= smallest) & (map <= largest))));
}

//! Of raw pairs, too; a pair without is matched as before.
TEST(HDPStereo_Tiles, no_data_of_raw_pairs)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 22);
    const String chain = writeCalibration(folder);
    const Rect empty(60, 40, 50, 30);
    Mat left = sixteenBit(pair.left);
    writeTiff(folder.path("left.tif"), left);
    writeTiff(folder.path("right.tif"), sixteenBit(pair.right));
    left(empty).setTo(300);
    writeTiff(folder.path("holed.tif"), left, "300.0");
    const String right = " " + folder.path("right.tif"), options = " --num-disparities=32 --calibration=" + chain;
    const auto missingOf = [&](const String& name) {
        const Mat map = cv::imread(folder.path(name), IMREAD_UNCHANGED);
        return map.empty() ? -1 : (int)map.total() - cv::countNonZero(map == map);
    };
    EXPECT_EQ(
        0, run(folder, "hdpstereo " + folder.path("holed.tif") + right + " " + folder.path("a.tif") + options).status);
    folder.writeText("list.txt", folder.path("left.tif") + right + " b\n" + folder.path("holed.tif") + right + " c\n" +
                                     folder.path("left.tif") + right + " d\n");
    EXPECT_EQ(0, run(folder,
                     "hdpstereo --batch --format=tif " + folder.path("list.txt") + " " + folder.path("maps") + options)
                     .status);
    const int atBorder = missingOf("maps/b.tif"); // that no raw pixel reaches
    EXPECT_LE(atBorder, 160);
    EXPECT_GE(missingOf("a.tif") - atBorder, empty.area());
    EXPECT_LE(missingOf("a.tif") - atBorder, 1.2 * empty.area());
    EXPECT_EQ(missingOf("a.tif"), missingOf("maps/c.tif"));
    EXPECT_EQ(atBorder, missingOf("maps/d.tif"));
}

//! A strip that a sparse file does not have is no data, or black where the file declares none.
TEST(HDPStereo_Tiles, sparse_files)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 22);
    Mat left = sixteenBit(pair.left);
    const int missing = 3; // rows 48 to 63
    writeTiff(folder.path("right.tif"), sixteenBit(pair.right));
    writeTiff(folder.path("sparse.tif"), left, "300.0", missing);
    writeTiff(folder.path("undeclared.tif"), left, String(), missing);
    left.rowRange(16 * missing, 16 * missing + 16).setTo(0);
    writeTiff(folder.path("black.tif"), left);
    left.rowRange(16 * missing, 16 * missing + 16).setTo(300);
    writeTiff(folder.path("holed.tif"), left, "300.0");
    const auto mapOf = [&](const String& name, const String& options) {
        const Execution result =
            run(folder, "hdpstereo " + options + folder.path(name) + " " + folder.path("right.tif") + " " +
                            folder.path("out.tif") + " --num-disparities=32");
        EXPECT_EQ(0, result.status) << name << result.errors;
        return cv::imread(folder.path("out.tif"), IMREAD_UNCHANGED);
    };
    for (const String options : { "", "--tiles " })
        for (const auto& names :
             { std::make_pair("holed.tif", "sparse.tif"), std::make_pair("black.tif", "undeclared.tif") })
        {
            const Mat expected = mapOf(names.first, options);
            mapOf(names.second, options);
            EXPECT_TRUE(isMap(folder.path("out.tif"), expected)) << names.second << options;
        }
}

//! The files of images are not mapped into memory; what matches them has as much as it may.
TEST(HDPStereo_SlowTiles, take_the_memory_they_may)
{
    const DatasetFolder folder;
    {
        const SyntheticPair pair = makeSlantedPlane(Size(3600, 2400), 32, 9); // a fork's memory counts, too
        writeTiff(folder.path("left.tif"), sixteenBit(pair.left));
        writeTiff(folder.path("right.tif"), sixteenBit(pair.right));
    }
    const long peak =
        peakMemory(folder, "hdpstereo --tiles --preset=ultrafast --memory=110 --num-disparities=32 " +
                               folder.path("left.tif") + " " + folder.path("right.tif") + " " + folder.path("out.tif"));
    EXPECT_LT(peak, std::getenv("ASAN_OPTIONS") ? LONG_MAX : 110 * 1024); // AddressSanitizer keeps what is freed
}

//! A grey picture that is read in colours beside one that is not
TEST(HDPStereo_Tiles, grey_pictures_of_two_kinds)
{
    const DatasetFolder folder;
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 22);
    Mat left, right;
    cvtColor(pair.left, left, COLOR_BGR2GRAY);
    cvtColor(pair.right, right, COLOR_BGR2GRAY);
    writeTiff(folder.path("left.tif"), left);
    folder.write("left.png", left);
    folder.write("right.png", right);
    const String model = folder.path("model.yml"), options = " --num-disparities=32 --findings=" + model;
    const auto call = [&](const String& first, const String& more) {
        return run(folder, "hdpstereo " + folder.path(first) + " " + folder.path("right.png") + " " +
                               folder.path("out.tif") + more);
    };
    ASSERT_EQ(0, call("left.png", " --num-disparities=32 --save-findings=" + model).status);
    const Mat expected = cv::imread(folder.path("out.tif"), IMREAD_UNCHANGED);
    for (const String tiles : { "", " --tiles" })
    {
        const Execution result = call("left.tif", options + tiles);
        EXPECT_EQ(0, result.status) << result.errors;
        EXPECT_TRUE(isMap(folder.path("out.tif"), expected)) << tiles;
    }
}

//! Of more pixels than a number of 32 bit has
TEST(HDPStereo_Tiles, count_pixels_beyond_32_bits)
{
    const DatasetFolder folder;
    String bytes("II*\0\10\0\0\0\12\0", 10);
    const auto put = [&](unsigned number, int count) {
        for (int i = 0; i < count; ++i)
            bytes += (char)(number >> 8 * i & 255);
    };
    const unsigned side = 60000, tile = 30000 / 16 * 16, tiles = 9;
    const unsigned fields[][3] = { { 256, 1, side },  { 257, 1, side }, { 258, 1, 8 },    { 259, 1, 1 },
                                   { 262, 1, 1 },     { 277, 1, 1 },    { 322, 1, tile }, { 323, 1, tile },
                                   { 324, tiles, 8 }, { 325, tiles, 8 } };
    for (const auto& field : fields)
    {
        put(field[0], 2);
        put(4, 2);
        put(field[1], 4);
        put(field[2], 4);
    }
    put(0, 4);
    std::ofstream(folder.path("huge.tif").c_str(), std::ios::binary) << bytes;
    const String image = folder.path("huge.tif") + " ";
    const Execution result = run(folder, "hdpstereo --tiles --memory=1 " + image + image + folder.path("out.tif"));
    EXPECT_EQ(1, result.status);
    EXPECT_EQ(0u, result.errors.find("error: --memory must be more than ")) << result.errors;
}

}} // namespace opencv_test

#endif
