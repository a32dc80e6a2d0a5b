// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include <opencv2/hdpstereo.hpp>
#include <iostream>
int main()
{
    cv::Mat scene(60, 200, CV_8UC3), disparity;
    cv::randu(scene, 0, 256);
    cv::stereo::HDPTreeMatcher::create(0, 16)->compute(scene.colRange(0, 190), scene.colRange(5, 195), disparity);
    std::cout << cv::mean(disparity)[0] << " " << cv::norm(disparity) << std::endl;
    return cvRound(disparity.at<short>(30, 100) / (double)cv::StereoMatcher::DISP_SCALE) == 5 ? 0 : 1;
}
