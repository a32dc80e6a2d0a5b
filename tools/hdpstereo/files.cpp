// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"

#include <cstdio>
#include <fstream>
#include <limits>

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;

String extensionOf(const String& path) { return path.substr(std::min(path.rfind('.'), path.size())); }

void requireFile(const String& path)
{
    if (!utils::fs::exists(path) || utils::fs::isDirectory(path))
        CV_Error(Error::StsObjectNotFound, "there is no file '" + path + "'");
}

void requireFolderOf(const String& path)
{
    const String folder = utils::fs::getParent(path);
    if (!folder.empty() && !utils::fs::isDirectory(folder))
        CV_Error(Error::StsObjectNotFound, "cannot write '" + path + "': there is no folder '" + folder + "'");
}

void requireImageWriter(const String& path)
{
    requireFolderOf(path);
    if (!haveImageWriter(path))
        CV_Error(Error::StsBadArg, "cannot write '" + path + "': no image format has this extension");
}

std::vector<uchar> encode(const String& extension, const Mat& image)
{
    std::vector<uchar> bytes;
    imencode(extension, image, bytes);
    return bytes;
}

void writeFile(const String& path, const std::vector<uchar>& bytes)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

void writeWholeFile(const String& path, const std::vector<uchar>& bytes)
{
    const String part = path + ".part";
    writeFile(part, bytes);
    if (std::rename(part.c_str(), path.c_str()) != 0)
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

Mat readImage(const String& path, int flags)
{
    const Mat image = imread(path, flags);
    if (image.empty())
        CV_Error(Error::StsError, "cannot read the image '" + path + "'");
    return image;
}

Mat readDisparity(const String& path)
{
    const float none = std::numeric_limits<float>::quiet_NaN();
    const Mat image = readImage(path, IMREAD_UNCHANGED);
    if (image.type() != CV_16UC1 && image.type() != CV_32FC1)
        CV_Error(Error::StsUnsupportedFormat, "'" + path + "' must have disparities of 16 bit, times 256, or floats");
    Mat disparity;
    image.convertTo(disparity, CV_32F, image.depth() == CV_16U ? 1. / 256 : 1);
    if (image.depth() == CV_16U)
        disparity.setTo(none, image == 0);
    else
        disparity.setTo(none, (disparity == std::numeric_limits<float>::infinity()) |
                                  (disparity == -std::numeric_limits<float>::infinity()));
    return disparity;
}

Mat readPicture(const String& path)
{
    Mat image = imread(path, IMREAD_COLOR | IMREAD_ANYDEPTH);
    if (image.empty()) // TIFF of grey floats is no colour image
        image = readImage(path, IMREAD_UNCHANGED);
    if (image.depth() != CV_8U && image.channels() > 1)
        cvtColor(image, image, image.channels() == 4 ? COLOR_BGRA2GRAY : COLOR_BGR2GRAY);
    if (image.depth() == CV_64F)
        image.convertTo(image, CV_32F);
    return image;
}

std::vector<uchar> encodeDisparity(const String& extension, const Mat& disparity)
{
    if (extension != ".png")
        return encode(extension, disparity);
    Mat disparity256;
    disparity.convertTo(disparity256, CV_16U, 256);
    disparity256.setTo(1, disparity256 == 0); // 0 stands for none
    disparity256.setTo(0, (disparity < 0) | (disparity >= 256));
    return encode(extension, disparity256);
}
