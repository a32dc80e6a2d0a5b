// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef HDPSTEREO_SAMPLES_STEREO_FILES_HPP
#define HDPSTEREO_SAMPLES_STEREO_FILES_HPP

// What hdp_camera writes.

#include "stereo_view.hpp"

#include <fstream>

#include "opencv2/calib3d.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"

namespace hdp_samples {

using namespace cv;

//! A binary .ply file of the points that have a depth
inline void writePoints(const String& path, const Mat& disparity, const Mat& depth, const Mat& colors, const Mat& Q)
{
    Mat points;
    reprojectImageTo3D(disparity, points, Q);
    std::ofstream file(path.c_str(), std::ios::binary);
    const ushort one = 1; // its first byte tells the order of bytes in floats
    const char* const endian = *reinterpret_cast<const uchar*>(&one) == 1 ? "little" : "big";
    file << "ply\nformat binary_" << endian << "_endian 1.0\nelement vertex " << countNonZero(depth == depth)
         << "\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    for (int y = 0; y < depth.rows; y++)
        for (int x = 0; x < depth.cols; x++)
            if (!cvIsNaN(depth.at<float>(y, x)))
            {
                const Vec3b bgr = colors.at<Vec3b>(y, x), rgb(bgr[2], bgr[1], bgr[0]);
                file.write((const char*)points.ptr(y, x), sizeof(Vec3f));
                file.write((const char*)rgb.val, sizeof(rgb.val));
            }
    if (!file.flush())
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

inline void writeImage(const String& path, const Mat& image)
{
    if (!imwrite(path, image))
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

//! Of a frame: the rectified pair and its disparities; with a rig its depth, too, and points. base: begins all paths
inline void writeResults(const String& base, const Ptr<cv::stereo::StereoRig>& rig, const Mat& left, const Mat& right,
                         const Mat& disparity, int minDisparity)
{
    writeImage(base + "left.png", left);
    writeImage(base + "right.png", right);
    writeImage(base + "disparity.pfm", disparity);
    if (!rig)
        return;
    Mat metres, millimetres, R1, R2, P1, P2, Q;
    rig->computeDepth(disparity, metres, CV_32F, minDisparity);
    rig->computeDepth(disparity, millimetres, CV_16U, minDisparity);
    writeImage(base + "depth.pfm", metres);
    writeImage(base + "depth.png", millimetres);
    rig->getRectification(R1, R2, P1, P2, Q);
    writePoints(base + "points.ply", disparity, metres, colorsOf(left), Q);
}

} // namespace hdp_samples

#endif
