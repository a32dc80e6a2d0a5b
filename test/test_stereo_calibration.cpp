// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "calibration_texts.hpp"

#include "../src/rig/calibration_text.hpp"
#include "helpers.hpp"

#include <fstream>
#include <regex>

namespace opencv_test { namespace {

using hdp::CalibrationText;

typedef std::vector<CalibrationFile> Files;

struct Kind
{
    const char* name;
    Files (*write)(const StereoCalibration&);
    int coefficients;
    bool isFisheye;
    Size size; // of the images
};

const Size small(480, 360), hd(1280, 720);

const Kind kinds[] = { { "OpenCV", inOpenCVFiles, 14, false, small },
                       { "OpenCV_fisheye", inOpenCVFiles, 4, true, small },
                       { "ROS", inRosFiles, 5, false, small },
                       { "ROS_rational", inRosFiles, 8, false, small },
                       { "ROS_fisheye", inRosFiles, 4, true, small },
                       { "Kalibr", inKalibrFile, 4, false, small },
                       { "Kalibr_fisheye", inKalibrFile, 4, true, small },
                       { "EuRoC", inEurocFiles, 4, false, small },
                       { "ZED", inZedFile, 5, false, hd },
                       { "ZED_rational", inZedFile, 8, false, hd } };

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

StereoCalibration calibrationOf(const Kind& kind)
{
    StereoCalibration c = makeCalibration(kind.coefficients, kind.isFisheye);
    c.imageSize = kind.size;
    return c;
}

StereoCalibration read(const Files& files, Size size)
{
    std::vector<CalibrationText> texts;
    for (const CalibrationFile& file : files)
        texts.push_back(CalibrationText(file.name, file.text()));
    return hdp::toCalibration(texts, size, 1);
}

void expectNear(const StereoCalibration& expected, const StereoCalibration& actual)
{
    EXPECT_EQ(expected.imageSize, actual.imageSize);
    EXPECT_EQ(expected.isFisheye, actual.isFisheye);
    const Mat pairs[][2] = { { expected.cameraMatrix1, actual.cameraMatrix1 },
                             { expected.cameraMatrix2, actual.cameraMatrix2 },
                             { expected.distCoeffs1, actual.distCoeffs1 },
                             { expected.distCoeffs2, actual.distCoeffs2 },
                             { expected.R, actual.R },
                             { expected.T, actual.T } };
    for (const auto& pair : pairs)
    {
        ASSERT_EQ(pair[0].size(), pair[1].size());
        ASSERT_EQ(CV_64FC1, pair[1].type());
        EXPECT_LT(cvtest::norm(pair[0], pair[1], NORM_INF), 1e-8) << pair[0] << "\n" << pair[1];
    }
}

//! Expects one sentence that names the file and the field.
void expectRefused(const Files& files, Size size, const std::string& file, const std::string& field)
{
    expectRejected([&] { read(files, size); }, "'" + file + "'");
    expectRejected([&] { read(files, size); }, field);
}

typedef testing::TestWithParam<Kind> HDPStereo_CalibrationFiles;

TEST_P(HDPStereo_CalibrationFiles, is_read_as_it_was_written)
{
    const StereoCalibration c = calibrationOf(GetParam());
    expectNear(c, read(GetParam().write(c), GetParam().size));
}

TEST_P(HDPStereo_CalibrationFiles, is_read_with_line_ends_of_windows)
{
    const StereoCalibration c = calibrationOf(GetParam());
    Files files = GetParam().write(c);
    for (CalibrationFile& file : files)
    {
        file.fields = { { "all", std::regex_replace(file.text(), std::regex("\n"), "\r\n") } };
        file.head.clear();
    }
    expectNear(c, read(files, GetParam().size));
}

TEST_P(HDPStereo_CalibrationFiles, names_each_field_that_is_missing)
{
    const Files files = GetParam().write(calibrationOf(GetParam()));
    for (size_t i = 0; i < files.size(); ++i)
        for (size_t j = 0; j < files[i].fields.size(); ++j)
        {
            const std::string path = files[i].fields[j].path, key = path.substr(path.find('/') + 1);
            if (path == "LEFT_CAM_HD/FX" || key == "K4" || key == "K5" || key == "K6")
                continue; // tells which sizes the file is for; are optional
            SCOPED_TRACE(path);
            Files incomplete = files;
            std::string& text = incomplete[i].fields[j].text;
            text =
                std::regex_replace(text, std::regex("(^|\n)( *)" + key + "(?=[:=])", std::regex::icase), "$1$2other");
            expectRefused(incomplete, GetParam().size, files[i].name, path);
        }
}

TEST_P(HDPStereo_CalibrationFiles, names_each_number_that_is_none)
{
    const Files files = GetParam().write(calibrationOf(GetParam()));
    for (size_t i = 0; i < files.size(); ++i)
        for (size_t j = 0; j < files[i].fields.size(); ++j)
            for (const char* number : { ".nan", "-.inf", "1e999", "one", "1.5.2" })
            {
                Files wrong = files;
                std::string& text = wrong[i].fields[j].text;
                const size_t digit = text.find_last_of("0123456789");
                const size_t begin = text.find_last_of(" [,=", digit) + 1;
                if (text.find("model") != std::string::npos && text.find("intrinsics") == std::string::npos)
                    continue;
                if (files[i].fields[j].path.find("resolution") != std::string::npos &&
                    text.find("rostopic") != std::string::npos)
                    continue; // the last digit is another field's
                SCOPED_TRACE(files[i].fields[j].path + " " + number);
                text.replace(begin, digit + 1 - begin, number);
                expectRefused(wrong, GetParam().size, files[i].name, files[i].fields[j].path);
            }
}

//! A rig that cannot be is told by the file and the field that say so.
TEST_P(HDPStereo_CalibrationFiles, refuses_impossible_rigs)
{
    const auto writer = GetParam().write;
    const auto expect =
        [&](const std::function<void(StereoCalibration&)>& change, const std::string& name, const std::string& text) {
        StereoCalibration c = calibrationOf(GetParam());
        change(c);
        const Files files = writer(c);
        SCOPED_TRACE(text);
        expectRejected([&] { read(files, GetParam().size); }, name + " must be " + text);
    };
    const struct
    {
        Files (*write)(const StereoCalibration&);
        std::string focal, center, distortion, rotation, translation;
    } all[] = { { inOpenCVFiles, "'intrinsics.yml': M2/data", "'intrinsics.yml': M1", "'intrinsics.yml': D2/data",
                  "'extrinsics.yml': R/data", "'extrinsics.yml': T/data" },
                { inRosFiles, "'right.yaml': camera_matrix/data", "'left.yaml': camera_matrix/data",
                  "'right.yaml': distortion_coefficients/data", "", "" },
                { inKalibrFile, "'camchain.yaml': cam1/intrinsics", "'camchain.yaml': cam0/intrinsics",
                  "'camchain.yaml': cam1/distortion_coeffs", "'camchain.yaml': cam1/T_cn_cnm1",
                  "'camchain.yaml': cam1/T_cn_cnm1" },
                { inEurocFiles, "'cam1.yaml': intrinsics", "'cam0.yaml': intrinsics",
                  "'cam1.yaml': distortion_coefficients", "'cam1.yaml': T_BS/data",
                  "'cam0.yaml' with 'cam1.yaml': T_BS/data" },
                { inZedFile, "'SN12345.conf': RIGHT_CAM_HD/FX, FY", "'SN12345.conf': LEFT_CAM_HD/CX, CY",
                  "'SN12345.conf': RIGHT_CAM_HD/K1, K2, P1, P2, K3", "", "'SN12345.conf': STEREO/BASELINE, TY, TZ" } };
    const auto& names =
        *std::find_if(std::begin(all), std::end(all), [&](decltype(*all) n) { return n.write == writer; });
    expect([](StereoCalibration& c) { c.cameraMatrix1.at<double>(0, 2) = 3000; }, names.center, "of a principal point");
    const bool isRational = writer == inZedFile && GetParam().coefficients == 8;
    expect([](StereoCalibration& c) { c.distCoeffs2.at<double>(1) = 2e6; },
           names.distortion + (isRational ? ", K4, K5, K6" : ""), "of finite numbers of a magnitude below");
    if (writer == inRosFiles)
        return; // their rectification is made for a possible one; see refuses_ros_files_of_impossible_rigs
    expect([](StereoCalibration& c) { c.cameraMatrix2.at<double>(1, 1) = 0; }, names.focal, "of focal lengths");
    expect([](StereoCalibration& c) { c.T *= 0; }, names.translation, "of a baseline above 0");
    expect([](StereoCalibration& c) { c.T *= -1; }, names.translation, "that of a second camera to the right");
    expect([](StereoCalibration& c) { c.T = (Mat_<double>(3, 1) << 0, -0.1, 0); }, names.translation,
           "that of cameras side by side");
    if (writer == inZedFile)
        return; // three angles are always a rotation
    const std::string rotation = writer == inOpenCVFiles ? "a rotation" : "a pose, with a rotation";
    expect([](StereoCalibration& c) { c.R *= 1.5; }, names.rotation, rotation);
    expect([](StereoCalibration& c) { c.R.row(1) *= -1; }, names.rotation, rotation);
}

TEST_P(HDPStereo_CalibrationFiles, is_scaled_to_images_of_the_same_aspect)
{
    const StereoCalibration c = calibrationOf(GetParam());
    const Files files = GetParam().write(c);
    if (GetParam().write == inOpenCVFiles)
        return; // they do not have the size
    const StereoCalibration half = read(files, Size(c.imageSize.width / 2, c.imageSize.height / 2));
    EXPECT_EQ(c.imageSize.width / 2, half.imageSize.width);
    EXPECT_NEAR(c.cameraMatrix1.at<double>(0, 0) / 2, half.cameraMatrix1.at<double>(0, 0), 1e-9);
    EXPECT_NEAR((c.cameraMatrix1.at<double>(0, 2) + 0.5) / 2 - 0.5, half.cameraMatrix1.at<double>(0, 2), 1e-9);
    EXPECT_LT(cvtest::norm(c.T, half.T, NORM_INF), 1e-8);
    expectRefused(files, Size(c.imageSize.width, c.imageSize.height - 40), files[0].name,
                  cv::format("%d x %d", c.imageSize.width, c.imageSize.height - 40));
}

INSTANTIATE_TEST_CASE_P(Kinds, HDPStereo_CalibrationFiles, testing::ValuesIn(kinds));

TEST(HDPStereo_StereoCalibration, refuses_ros_files_of_other_order)
{
    Files files = inRosFiles(makeCalibration());
    std::swap(files[0], files[1]);
    expectRefused(files, Size(), "right.yaml", "'left.yaml': projection_matrix/data must be that of a second camera");
}

//! ROS has the pose in the rectification: its projections have the baseline, its rotations are to be rotations.
TEST(HDPStereo_StereoCalibration, refuses_ros_files_of_impossible_rigs)
{
    const auto expect = [](int file, const char* field, int index, double value, const std::string& text) {
        Files files = inRosFiles(makeCalibration());
        for (CalibrationField& f : files[file].fields)
            if (f.path.find(field) == 0)
            {
                const size_t begin = f.text.find('[') + 1, end = f.text.find(']');
                std::vector<std::string> numbers;
                std::istringstream all(f.text.substr(begin, end - begin));
                for (std::string number; std::getline(all, number, ',');)
                    numbers.push_back(number);
                numbers[index] = cv::format("%g", value);
                std::string joined;
                for (const std::string& number : numbers)
                    joined += (joined.empty() ? "" : ", ") + number;
                f.text.replace(begin, end - begin, joined);
            }
        SCOPED_TRACE(text);
        expectRefused(files, Size(), files[file].name, text);
    };
    expect(1, "projection_matrix", 3, 0, "projection_matrix/data must be of a baseline");
    expect(1, "projection_matrix", 0, 0, "projection_matrix/data must be of a focal length");
    for (int i = 0; i < 2; ++i)
    {
        expect(i, "rectification_matrix", 4, -1, "rectification_matrix/data must be a rotation");
        expect(i, "camera_matrix", 0, 0, "camera_matrix/data must be of focal lengths");
    }
}

TEST(HDPStereo_StereoCalibration, wants_the_number_of_files_of_its_kind)
{
    const StereoCalibration c = makeCalibration(4);
    Files files = inRosFiles(c);
    files.pop_back();
    expectRefused(files, Size(), "left.yaml", "second");
    files = inKalibrFile(c);
    files.push_back(files[0]);
    expectRefused(files, Size(), "camchain.yaml", "one file");
    files = inOpenCVFiles(c);
    expectRefused(files, Size(), "intrinsics.yml", "imageSize");
    expectRefused(files, Size(240, 180), "intrinsics.yml", "240 x 180"); // not that of the calibration
    files[0].fields.insert(files[0].fields.end(), files[1].fields.begin(), files[1].fields.end());
    files.pop_back();
    expectNear(c, read(files, c.imageSize));
}

TEST(HDPStereo_StereoCalibration, knows_sections_of_the_zed)
{
    Files files = inZedFile(calibrationOf(kinds[8]));
    expectRefused(files, Size(), "SN12345.conf", "imageSize");
    expectRefused(files, Size(672, 376), "SN12345.conf", "1280 x 720");
    EXPECT_EQ(Size(640, 360), read(files, Size(640, 360)).imageSize);
    files[0].fields[0].text = "[left_cam_hd]\nother=1\n";
    expectRefused(files, hd, "SN12345.conf", "LEFT_CAM_HD/FX");
    // Halves are those of their own mode, and no mode is scaled to another one.
    CalibrationFile factory = { "SN2.conf", "", {} };
    const std::pair<const char*, int> focalLengths[] = {
        { "2K", 1399 }, { "FHD", 1401 }, { "HD", 700 }, { "VGA", 350 }
    };
    factory.head = "[STEREO]\nBaseline=120\nTY=0\nTZ=0\n";
    for (const auto& mode : focalLengths)
        for (const char* const name : { "CV", "RX", "RZ" })
            factory.head += format("%s_%s=0\n", name, mode.first);
    for (const auto& mode : focalLengths)
        for (const char* const side : { "LEFT", "RIGHT" })
            factory.head += format("[%s_CAM_%s]\nfx=%d\nfy=%d\ncx=300\ncy=200\nk1=0\nk2=0\np1=0\np2=0\nk3=0\n", side,
                                   mode.first, mode.second, mode.second);
    const auto focalLength = [&](Size size) { return read({ factory }, size).cameraMatrix1.at<double>(0, 0); };
    EXPECT_DOUBLE_EQ(350, focalLength(Size(640, 360)));
    EXPECT_DOUBLE_EQ(700.5, focalLength(Size(960, 540)));
    EXPECT_DOUBLE_EQ(175, focalLength(Size(320, 180)));
    EXPECT_DOUBLE_EQ(175, focalLength(Size(336, 188)));
    EXPECT_DOUBLE_EQ(699.5, focalLength(Size(1104, 621)));
    expectRefused({ factory }, Size(1000, 562), "SN2.conf", "1280 x 720");
    // Lenses with a section of their own; without tangential terms they are of fisheyes.
    CalibrationFile file = { "SN1.conf", "", {} };
    for (const std::string side : { "LEFT", "RIGHT" })
        file.head += "[" + side + "_CAM_SVGA]\nfx = 400\nfy = 401\ncx=480\ncy=300\n[" + side +
                     "_DISTO]\nk1=.1\nk2=.2\nk3=.3\nk4=.4\n";
    file.head += "[STEREO]\nBaseline = 50\nTY = 0.1\nTZ = 0\nCV_SVGA=0\nRX_SVGA=0\nRZ_SVGA=0";
    const StereoCalibration c = read({ file }, Size(960, 600));
    EXPECT_TRUE(c.isFisheye);
    EXPECT_EQ("0.1, 0.2, 0.3, 0.4", inWords(c.distCoeffs2));
    EXPECT_EQ("-0.05, -0.0001, -0", inWords(c.T));
}

TEST(HDPStereo_StereoCalibration, reads_files_and_names_those_that_are_none)
{
    const StereoCalibration c = makeCalibration();
    const Files files = inOpenCVFiles(c);
    const TemporaryFile in(".yml"), out(".yml"), none(".yml");
    std::ofstream(in.name.c_str()) << files[0].text();
    std::ofstream(out.name.c_str()) << files[1].text();
    expectNear(c, readStereoCalibration(in.name, out.name, c.imageSize));
    EXPECT_NEAR(0.025,
                cvtest::norm(readStereoCalibration(in.name, out.name, c.imageSize, 0.025).T, NORM_L2) /
                    cvtest::norm(c.T, NORM_L2),
                1e-9);
    expectRejected([&] { readStereoCalibration(none.name, out.name, c.imageSize); }, none.name);
    expectRejected([&] { readStereoCalibration(in.name, out.name, c.imageSize, 0); }, "unit");
    expectRejected([&] { readStereoCalibration(in.name, out.name, Size(-1, 5)); }, "imageSize");
    std::ofstream(none.name.c_str()) << "nothing: 1\n";
    expectRejected([&] { readStereoCalibration(none.name); }, none.name);
    std::ofstream(none.name.c_str()) << std::string(2 << 20, ' ');
    expectRejected([&] { readStereoCalibration(none.name); }, "too large");
}

TEST(HDPStereo_StereoCalibration, refuses_other_models)
{
    Files files = inKalibrFile(makeCalibration(4));
    const auto replaced = [&](const std::string& from, const std::string& to) {
        Files others = files;
        others[0].fields = { { "all", std::regex_replace(files[0].text(), std::regex(from), to) } };
        others[0].head.clear();
        return others;
    };
    expectRefused(replaced("pinhole", "omni"), Size(), "camchain.yaml", "cam0/camera_model");
    expectRefused(replaced("radtan", "fov"), Size(), "camchain.yaml", "cam0/distortion_model");
    expectRefused(replaced("radtan\n  intrinsics: \\[399", "equidistant\n  intrinsics: [399"), Size(), "camchain.yaml",
                  "fisheye");
    expectRefused(replaced("- \\[0, 0, 0, 1\\]", "- [0, 0, 1, 1]"), Size(), "camchain.yaml", "cam1/T_cn_cnm1");
    expectRefused(replaced("resolution: \\[480", "resolution: [480.5"), Size(), "camchain.yaml", "cam0/resolution");
    EXPECT_EQ(0, cvtest::norm(read(replaced("radtan", "none"), Size()).distCoeffs1, NORM_INF));

    files = inRosFiles(makeCalibration(5));
    for (const char* side : { "image_width", "image_height" })
    {
        const std::string key = std::string(side) + ": ";
        expectRefused({ replaced(key, key + "-")[0], files[1] }, Size(), "left.yaml", side);
    }
}

//! A file of one program may have another one's name for a model: its coefficients count.
TEST(HDPStereo_StereoCalibration, reads_coefficients_of_any_model)
{
    for (const int coefficients : { 5, 8 })
        for (const auto& write : { inKalibrFile, inEurocFiles })
        {
            const StereoCalibration c = makeCalibration(coefficients);
            Files files = write(c);
            const char* const model = coefficients == 5 ? "plumb_bob" : "rational_polynomial";
            for (CalibrationFile& file : files)
                for (CalibrationField& field : file.fields)
                    field.text = std::regex_replace(field.text, std::regex("radtan|radial-tangential"), model);
            expectNear(c, read(files, Size()));
        }
}

TEST(HDPStereo_CalibrationText, reads_what_yaml_has)
{
    const CalibrationText text("f",
                               "%YAML 1.2\n---\na: 1 # one\nb: !!tag\n   c: 'x # y'\n   d: [ 1, [2,\n 3 ], \"4\" ]\n"
                               "e:\n- 5\n- [6, 7]\n-   - 8\n    - 9\nurl: http://a:1/b\n\"q\": 0\n...\n");
    EXPECT_EQ(1, text.number("a"));
    EXPECT_EQ("x # y", text.word("b/c"));
    EXPECT_EQ(std::vector<double>({ 1, 2, 3, 4 }), text.numbers("b/d", 0));
    EXPECT_EQ(6, text.numbers("e", 5)[1]);
    EXPECT_EQ("http://a:1/b", text.word("url"));
    EXPECT_EQ(0, text.number("q"));
    EXPECT_TRUE(text.hasBelow("b/"));
    EXPECT_FALSE(text.hasBelow("c"));
}

TEST(HDPStereo_CalibrationText, names_the_line_that_is_not_understood)
{
    const struct
    {
        const char *text, *line;
    } cases[] = { { "a: 1\nb\n", "line 2" },
                  { "a: 1\n\tb: 2\n", "line 2" },
                  { "- 1\n", "line 1" },
                  { "a: [1, 2\nb: 3\n", "line 2" },
                  { "a: ]\n", "" },
                  { "a: [1]]\n", "line 1" },
                  { "a: [1] 2\n", "line 1" },
                  { "a: 1\na: 2\n", "line 2" },
                  { "a: |\n  text\n", "line 1" },
                  { ": 1\n", "line 1" },
                  { "[A]\nb\n", "line 2" },
                  { "[A]\nb=1\nB=2\n", "line 3" } };
    for (const auto& c : cases)
        if (*c.line)
            expectRejected([&] { CalibrationText("file", c.text); }, c.line);
    expectRejected([] { CalibrationText("file", std::string("a: 1\0", 5)); }, "byte 0");
    expectRejected([] { CalibrationText("file", std::string("[a]\nb=1 \0c", 10)); }, "byte 0");
}

}} // namespace opencv_test
