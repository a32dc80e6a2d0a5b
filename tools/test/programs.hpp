// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_TEST_PROGRAMS_HPP
#define OPENCV_HDPSTEREO_TOOLS_TEST_PROGRAMS_HPP

#include "test_precomp.hpp"
#include "dataset_folder.hpp"
#include "synthetic_pair.hpp"

#include <cstdlib>

#ifdef __unix__
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace opencv_test {

struct Execution
{
    int status;
    String output, errors;
};

inline String readText(const String& path)
{
    std::ifstream file(path.c_str(), std::ios::binary);
    return String(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

//! Where the programs are: of this build, or those that the environment names
inline String programFolder()
{
    const char* const others = std::getenv("HDPSTEREO_PROGRAMS");
    return others ? others : HDP_PROGRAMS;
}

//! Runs a program of the build's bin/, by the shell, with additions to the environment such as A=1 B=2.
inline Execution run(const DatasetFolder& folder, const String& command, const String& output = String(),
                     const String& environment = String())
{
    const String out = output.empty() ? folder.path("stdout") : output, err = folder.path("stderr");
    const String line = environment + " " + programFolder() + "/" + command + " >'" + out + "' 2>'" + err + "'";
    const int status = std::system(line.c_str());
    const bool exited = status != -1 && WIFEXITED(status);
    EXPECT_TRUE(exited) << command;
    return { exited ? WEXITSTATUS(status) : -1, output.empty() ? readText(out) : String(), readText(err) };
}

//! The most that a program takes, in KiB
inline long peakMemory(const DatasetFolder& folder, const String& command)
{
    const String line = "exec " + programFolder() + "/" + command + " >/dev/null 2>'" + folder.path("stderr") + "'";
    const pid_t child = fork();
    if (child == 0)
    {
        execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = -1;
    struct rusage usage = rusage();
    EXPECT_EQ(child, wait4(child, &status, 0, &usage));
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << readText(folder.path("stderr"));
    return usage.ru_maxrss;
}

//! A calibration of cameras of 160 x 120 pixels that are rectified already; returns its file.
inline String writeCalibration(const DatasetFolder& folder)
{
    const String chain = folder.path("camchain.yaml");
    std::ofstream file(chain.c_str());
    for (int camera = 0; camera < 2; ++camera)
        file << "cam" << camera << ":\n  camera_model: pinhole\n  distortion_model: none\n  resolution: [160, 120]\n"
             << "  intrinsics: [200, 200, 79.5, 59.5]\n";
    file << "  T_cn_cnm1: [1, 0, 0, -0.2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";
    file.close();
    return chain;
}

//! A pair of 160 x 120 pixels and 32 disparities, and three scenes of it: dataset/half/{a,b,c}
inline void writePair(const DatasetFolder& folder)
{
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 21);
    Mat truth;
    pair.truth.convertTo(truth, CV_16U, 256);
    truth.setTo(0, ~pair.visible);
    for (const char* scene : { "dataset/a/", "dataset/b/", "dataset/c/" })
    {
        folder.write(String(scene) + "left.png", pair.left);
        folder.write(String(scene) + "right.png", pair.right);
        folder.write(String(scene) + "disp_left.png", truth);
    }
}

inline String pairOf(const DatasetFolder& folder)
{
    return " " + folder.path("dataset/a/left.png") + " " + folder.path("dataset/a/right.png") + " --num-disparities=32";
}

inline String firstLine(const String& text) { return text.substr(0, text.find('\n')); }

//! Two scenes of one pair in 16 bit: rounded to 8, the texture of faint has 13 levels; that of rounded is rounded.
struct FaintPair
{
    FaintPair() : pair(makeSyntheticPair(Size(160, 120), 32, 23))
    {
        Mat truth;
        pair.truth.convertTo(truth, CV_16U, 256);
        for (const String scene : { "scenes/faint/", "scenes/rounded/" })
        {
            for (const String side : { "left", "right" })
            {
                Mat image;
                cv::cvtColor(side == "left" ? pair.left : pair.right, image, COLOR_BGR2GRAY);
                image.convertTo(image, CV_16U, 8, 61000);
                if (scene == "scenes/rounded/")
                    image.convertTo(image, CV_8U, 1. / 257);
                folder.write(scene + side + ".png", image);
            }
            folder.write(scene + "disp_left.png", truth);
        }
    }

    String images(const String& scene) const
    {
        return " " + folder.path("scenes/" + scene + "/left.png") + " " +
               folder.path("scenes/" + scene + "/right.png") + " --num-disparities=32";
    }

    int countErrors(const String& map, double scale) const
    {
        Mat disparity;
        cv::imread(folder.path(map), IMREAD_UNCHANGED).convertTo(disparity, CV_32F, scale);
        EXPECT_EQ(pair.truth.size(), disparity.size());
        return disparity.empty() ? INT_MAX : cv::countNonZero(cv::abs(disparity - pair.truth) >= 1);
    }

    DatasetFolder folder;
    SyntheticPair pair;
};

//! --help, and what is not: one line that says so
inline void testHelpAndWrongArguments(const char* program)
{
    SCOPED_TRACE(program);
    const DatasetFolder folder;
    const Execution help = run(folder, String(program) + " --help");
    EXPECT_EQ(0, help.status);
    EXPECT_NE(String::npos, help.output.find("--help"));
    for (const char* arguments : { "", "--no-such-option=1", "no/such/file.png no/such/file.png" })
    {
        SCOPED_TRACE(arguments);
        const Execution wrong = run(folder, String(program) + " " + arguments);
        EXPECT_EQ(1, wrong.status);
        EXPECT_EQ(0u, wrong.errors.find("error: ")) << wrong.errors;
        EXPECT_EQ(firstLine(wrong.errors) + "\n", wrong.errors);
    }
}

} // namespace opencv_test

#endif // __unix__

#endif
