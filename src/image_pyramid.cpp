// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "image_pyramid.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

//! Means of 2 x 2 pixels of one or three channels; `rounding` is added to the sum of four.
template <typename T, int rounding> void halve(const Mat& image, Mat& half)
{
    const int channels = image.channels();
    parallel_for_(Range(0, half.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const T* upper = image.ptr<T>(2 * y);
            const T* lower = image.ptr<T>(2 * y + 1);
            T* mean = half.ptr<T>(y);
            for (int x = 0; x < half.cols; ++x, upper += 2 * channels, lower += 2 * channels)
                for (int c = 0; c < channels; ++c)
                    *mean++ = (T)((upper[c] + upper[c + channels] + lower[c] + lower[c + channels] + rounding) / 4);
        }
    });
}

} // namespace

int countLayers(Size size, int numLayers)
{
    int layers = 1;
    while (layers < numLayers && std::min(size.width, size.height) >> layers > 0)
        ++layers;
    return layers;
}

void halveImage(const Mat& image, Mat& half)
{
    half.create(image.rows / 2, image.cols / 2, image.type());
    if (image.depth() == CV_16U)
        halve<ushort, 2>(image, half);
    else
        halve<uchar, 0>(image, half);
}

void greyLevels(const Mat& image, Mat& grey)
{
    const int channels = image.channels();
    grey.create(image.size(), CV_16U);
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const uchar* pixel = image.ptr(y);
            ushort* level = grey.ptr<ushort>(y);
            if (channels == 1)
                for (int x = 0; x < image.cols; ++x)
                    level[x] = (ushort)(pixel[x] * greyScale);
            else
                for (int x = 0; x < image.cols; ++x, pixel += 3)
                    level[x] = (ushort)((7471 * pixel[0] + 38470 * pixel[1] + 19595 * pixel[2] + 32768 / greyScale) /
                                        (65536 / greyScale));
        }
    });
}

void shiftColumns(const Mat& right, int minDisparity, Mat& shifted)
{
    const int width = right.cols;
    // Of the columns of the result, [begin, end) come from inside the image. 64 bit: minDisparity is any int.
    const int begin = (int)std::min<int64>(std::max<int64>(minDisparity, 0), width);
    const int end = (int)std::max<int64>(std::min<int64>((int64)width + minDisparity, width), 0);
    shifted.create(right.size(), right.type());
    if (begin < end)
        right.colRange(begin - minDisparity, end - minDisparity).copyTo(shifted.colRange(begin, end));
    for (int x = 0; x < std::min(begin, width); ++x)
        right.col(0).copyTo(shifted.col(x));
    for (int x = std::max(end, 0); x < width; ++x)
        right.col(width - 1).copyTo(shifted.col(x));
}

} // namespace hdp
} // namespace stereo
} // namespace cv
