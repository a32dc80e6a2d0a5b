// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_TEST_DATASET_FOLDER_HPP
#define OPENCV_HDPSTEREO_TOOLS_TEST_DATASET_FOLDER_HPP

#include "test_precomp.hpp"

#include <fstream>

#include "opencv2/core/utils/filesystem.hpp"

namespace opencv_test {

namespace fs = cv::utils::fs;

const Size pairSize(24, 12);

//! A folder that is removed in the end
class DatasetFolder
{
public:
    DatasetFolder() : root(cv::tempfile("_dataset")) { fs::createDirectories(root); }
    ~DatasetFolder() { fs::remove_all(root); }

    //! The path of a file; makes the folders above it.
    String path(const String& name) const
    {
        const String file = fs::join(root, name);
        fs::createDirectories(fs::getParent(file));
        return file;
    }

    void write(const String& name, const Mat& image) const { ASSERT_TRUE(cv::imwrite(path(name), image)) << name; }
    void writeText(const String& name, const String& text) const { std::ofstream(path(name).c_str()) << text; }
    void writePicture(const String& name, int level = 90, Size size = pairSize) const
    {
        write(name, Mat(size, CV_8UC3, Scalar::all(level)));
    }

    //! Left and right of level 50 and 60, and truth of 4 disparities left of column 12 and 8 right of it
    void writeScene(const String& folder, const char* const (&names)[4], int divisor = 1, Size size = pairSize) const
    {
        writePicture(folder + "/" + names[0], 50, size);
        writePicture(folder + "/" + names[1], 60, size);
        write(folder + "/" + names[2], halves(size, CV_8U, 4 * divisor, 8 * divisor));
        write(folder + "/" + names[3], halves(size, CV_8U, 4 * divisor, 8 * divisor));
    }

    static Mat halves(Size size, int type, double left, double right)
    {
        Mat map(size, type, Scalar(right));
        map.colRange(0, size.width / 2).setTo(left);
        return map;
    }

    const String root;
};

} // namespace opencv_test

#endif
