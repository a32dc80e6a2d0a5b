// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "pictures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "opencv2/imgproc.hpp"

namespace hdp_tools {

cv::Vec2f colorRange(const Mat& disparity)
{
    std::vector<float> values;
    for (int y = 0; y < disparity.rows; y++)
        std::copy_if(disparity.ptr<float>(y), disparity.ptr<float>(y) + disparity.cols, std::back_inserter(values),
                     [](float d) { return d < NO_DISPARITY; });
    std::sort(values.begin(), values.end());
    const float low = values.empty() ? 0.f : values[values.size() / 100];
    const float high = values.empty() ? 1.f : std::max(values[values.size() - 1 - values.size() / 100], low + 1.f);
    return cv::Vec2f(low, high);
}

Mat colorPicture(const Mat& disparity, const cv::Vec2f& range)
{
    // Both ends of the color map are left out: they are near black and red, which mean something else here.
    const float low = range[0], high = range[1];
    Mat levels = cv::max(cv::min(disparity, high), low), picture;
    levels.convertTo(levels, CV_8U, 150. / (high - low), 20 - 150. / (high - low) * low);
    cv::applyColorMap(levels, picture, cv::COLORMAP_TURBO);
    picture.setTo(cv::Scalar::all(0), ~knownPixels(disparity));
    return picture;
}

Mat colorPicture(const Mat& disparity) { return colorPicture(disparity, colorRange(disparity)); }

Mat resultPicture(const Mat& disparity, const Pair& pair)
{
    if (pair.protocol == Pair::NO_TRUTH)
        return colorPicture(disparity);
    Mat picture = colorPicture(disparity, colorRange(pair.truth));
    picture.setTo(cv::Scalar(0, 0, 255), wrongPixels(disparity, pair));
    if (pair.protocol != Pair::KITTI) // whose truth is too sparse for it
        picture.setTo(cv::Scalar::all(0), ~pair.judged);
    return picture;
}

Mat forestPicture(const Mat& trees)
{
    Mat picture(trees.size(), CV_8UC3);
    for (int y = 0; y < trees.rows; y++)
        for (int x = 0; x < trees.cols; x++)
        {
            const unsigned hash = (unsigned(trees.at<int>(y, x)) + 1) * 2654435761u;
            picture.at<cv::Vec3b>(y, x) = cv::Vec3b(uchar(hash >> 24), uchar(hash >> 16), uchar(hash >> 8));
        }
    return picture;
}

Mat widthPicture(const Mat& intervals, int numDisparities)
{
    Mat picture(intervals.size(), CV_8U);
    for (int y = 0; y < intervals.rows; y++)
        for (int x = 0; x < intervals.cols; x++)
        {
            const cv::Vec2w interval = intervals.at<cv::Vec2w>(y, x);
            const double width = std::max(interval[1] - interval[0] + 1, 1);
            picture.at<uchar>(y, x) =
                cv::saturate_cast<uchar>(255 * std::log(width) / std::log(std::max(numDisparities, 2)));
        }
    cv::applyColorMap(picture, picture, cv::COLORMAP_VIRIDIS);
    return picture;
}

Mat matrixPicture(const cv::Mat_<double>& matrix)
{
    Mat picture(matrix.size(), CV_8U);
    for (int i = 0; i < matrix.rows; i++)
    {
        double largest = 0;
        cv::minMaxLoc(matrix.row(i), 0, &largest);
        matrix.row(i).convertTo(picture.row(i), CV_8U, largest > 0 ? 255 / largest : 0);
    }
    Mat enlarged;
    const int factor = std::max(256 / picture.cols, 1);
    cv::resize(picture, enlarged, cv::Size(), factor, factor * 2, cv::INTER_NEAREST); // D_{l+1} counts double
    cv::applyColorMap(enlarged, picture, cv::COLORMAP_INFERNO);
    return picture;
}

} // namespace hdp_tools
