// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// frames LEFT RIGHT DISPARITIES METHOD FRAMES: matches a pair of .ppm pictures so many times, with one thread. METHOD is
// sgbm-3way, fast, or unaligned: FAST without the alignment of rows and light.

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;

//! Without opencv_imgcodecs, whose libraries take longer to load than all else
static Mat readPicture(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    std::string format;
    int width = 0, height = 0, levels = 0;
    file >> format >> width >> height >> levels;
    file.get();
    Mat picture(height, width, CV_8UC3);
    file.read(reinterpret_cast<char*>(picture.data), std::streamsize(3 * picture.total()));
    if (!file || format != "P6")
        std::exit(1);
    cvtColor(picture, picture, COLOR_RGB2BGR);
    return picture;
}

int main(int, char** argv)
{
    const Mat left = readPicture(argv[1]), right = readPicture(argv[2]);
    const int numDisparities = std::atoi(argv[3]);
    const std::string method = argv[4];
    setNumThreads(1);
    Ptr<StereoMatcher> matcher;
    if (method == "sgbm-3way")
        matcher =
            StereoSGBM::create(0, numDisparities, 5, 8 * 25, 32 * 25, 1, 63, 10, 0, 0, StereoSGBM::MODE_SGBM_3WAY);
    else
    {
        const Ptr<stereo::HDPTreeMatcher> ours = stereo::HDPTreeMatcher::create(0, numDisparities);
        if (method == "unaligned")
        {
            ours->setMaxRowOffset(0);
            ours->setUseLightAlignment(false);
            ours->setNoiseThreshold(0);
        }
        matcher = ours;
    }
    Mat disparity;
    for (int i = 0; i < std::atoi(argv[5]); i++)
        matcher->compute(left, right, disparity);
    std::cout << disparity.total() << std::endl;
}
