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
#include <sys/wait.h>

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

//! Runs a program of the build's bin/, by the shell, with additions to the environment such as A=1 B=2.
inline Execution run(const DatasetFolder& folder, const String& command, const String& output = String(),
                     const String& environment = String())
{
    const String out = output.empty() ? folder.path("stdout") : output, err = folder.path("stderr");
    const String line = environment + " " + HDP_PROGRAMS + "/" + command + " >'" + out + "' 2>'" + err + "'";
    const int status = std::system(line.c_str());
    const bool exited = status != -1 && WIFEXITED(status);
    EXPECT_TRUE(exited) << command;
    return { exited ? WEXITSTATUS(status) : -1, output.empty() ? readText(out) : String(), readText(err) };
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

} // namespace opencv_test

#endif // __unix__

#endif
