// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "disparity_maps.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <vector>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include "command_line.hpp"

namespace hdp_tools {

Mat toPixels(const Mat& disparity16, int minDisparity)
{
    Mat disparity;
    disparity16.convertTo(disparity, CV_32F, 1.0 / 16);
    disparity.setTo(NO_DISPARITY, disparity < minDisparity);
    return disparity;
}

bool hasExtension(const String& path, const String& extension)
{
    const size_t dot = path.rfind('.');
    return dot != String::npos && lowerCase(path.substr(dot)) == extension;
}

Mat readImage(const String& path, int flags)
{
    Mat image;
    try
    {
        image = cv::imread(path, flags);
    }
    catch (const cv::Exception&)
    {
    }
    if (image.empty())
        fail("cannot read the image '" + path + "'");
    return image;
}

Mat readPicture(const String& path)
{
    Mat picture = readImage(path, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
    if (picture.depth() == CV_16U)
        cv::cvtColor(picture, picture, cv::COLOR_BGR2GRAY);
    return picture;
}

void writeImage(const String& path, const Mat& image)
{
    std::vector<uchar> bytes;
    cv::imencode(path.substr(std::min(path.rfind('.'), path.size())), image, bytes);
    // Unlike that of cv::imwrite(), this file notices a full disk.
    std::ofstream file(path.c_str(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        fail("cannot write '" + path + "'");
}

Mat toDisparity(const Mat& image, const String& path, double scale)
{
    if (image.channels() != 1)
        fail("'" + path + "' is a color image, not a disparity map");
    const bool isFloat = image.depth() == CV_32F;
    if (scale == 0)
        scale = image.depth() == CV_16U ? 256 : 1;

    Mat disparity;
    image.convertTo(disparity, CV_32F);
    disparity /= scale; // not a factor of 1 / scale, which rounds differently
    const Mat known = isFloat ? Mat(cv::abs(image) <= std::numeric_limits<float>::max()) : Mat(image != 0);
    disparity.setTo(NO_DISPARITY, ~known);
    return disparity;
}

Mat readDisparity(const String& path, double scale)
{
    return toDisparity(readImage(path, cv::IMREAD_UNCHANGED), path, scale);
}

void writeDisparity(const String& path, const Mat& disparity)
{
    const Mat fits = (disparity >= 0) & (disparity < 256);
    Mat fitting = disparity.clone(), image;
    fitting.setTo(0, ~fits);
    fitting.convertTo(image, CV_16U, 256);
    image.setTo(1, fits & (image == 0));
    writeImage(path, image);
}

Mat nonOccludedPixels(const Mat& truth, const Mat& rightTruth, double tolerance)
{
    Mat mask = Mat::zeros(truth.size(), CV_8U);
    for (int y = 0; y < truth.rows; y++)
    {
        for (int x = 0; x < truth.cols; x++)
        {
            const float d = truth.at<float>(y, x);
            const float xr = d < NO_DISPARITY ? float(x) - std::floor(d) : -1.f;
            if (xr >= 0 && xr < float(truth.cols) && std::abs(rightTruth.at<float>(y, int(xr)) - d) <= tolerance)
                mask.at<uchar>(y, x) = 255;
        }
    }
    return mask;
}

Mat wrongPixels(const Mat& disparity, const Mat& truth, const Mat& mask, double threshold)
{
    Mat error;
    cv::absdiff(disparity, truth, error);
    return (error >= threshold) & mask;
}

Mat wrongPixelsD1(const Mat& disparity, const Mat& truth, const Mat& mask)
{
    Mat error;
    cv::absdiff(disparity, truth, error);
    return (error > 3) & (error > 0.05 * truth) & mask;
}

double percent(const Mat& pixels, const Mat& mask)
{
    const int all = cv::countNonZero(mask);
    return all > 0 ? 100. * cv::countNonZero(pixels) / all : std::numeric_limits<double>::quiet_NaN();
}

} // namespace hdp_tools
