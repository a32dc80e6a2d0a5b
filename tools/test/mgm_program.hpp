// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_TEST_MGM_PROGRAM_HPP
#define OPENCV_HDPSTEREO_TOOLS_TEST_MGM_PROGRAM_HPP

#include "programs.hpp"

#ifdef __unix__

namespace opencv_test {

const float none = std::numeric_limits<float>::quiet_NaN();

//! hdpstereo-mgm as programs of photogrammetry call it
class MgmTest
{
public:
    MgmTest() : pair(makeSyntheticPair(Size(240, 160), 32, 5))
    {
        cvtColor(pair.left, left, COLOR_BGR2GRAY);
        cvtColor(pair.right, right, COLOR_BGR2GRAY);
        save(left, right);
    }

    void save(const Mat& leftImage, const Mat& rightImage)
    {
        folder.write("left.tif", leftImage);
        folder.write("right.tif", rightImage);
    }

    Execution call(const String& options, const String& environment = "")
    {
        const String command = "hdpstereo-mgm " + options + " " + folder.path("left.tif") + " " +
                               folder.path("right.tif") + " " + folder.path("out.tif");
        return run(folder, command, String(), environment);
    }

    //! What a call that succeeds writes
    Mat match(const String& options, const String& environment = "")
    {
        const Execution result = call(options, environment);
        EXPECT_EQ(0, result.status) << result.errors;
        return image("out.tif");
    }

    Mat image(const String& name) const { return cv::imread(folder.path(name), IMREAD_UNCHANGED); }

    //! The share of visible pixels that are wrong by more than 1, with OpenCV's sign
    double wrong(const Mat& disparity, int shift = 0) const
    {
        EXPECT_EQ(CV_32FC1, disparity.type());
        EXPECT_EQ(pair.truth.size(), disparity.size());
        const Mat expected = pair.truth + shift;
        const Mat isRight = cv::abs(disparity - expected) <= 1; // NaN is not
        return 1 - cv::countNonZero(isRight & pair.visible) / (double)cv::countNonZero(pair.visible);
    }

    const DatasetFolder folder;
    const SyntheticPair pair;
    Mat left, right;
};

} // namespace opencv_test

#endif // __unix__

#endif
