// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "image_pyramid.hpp"
#include "../base/mask.hpp"
#include "image_pyramid.simd.hpp"
#include "pair/image_pyramid.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

HDP_DISPATCH(halveRow)

void halveImage(const Mat& image, Mat& half)
{
    half.create(image.rows / 2, image.cols / 2, image.type());
    const int width = half.cols, channels = half.channels();
    parallelForRows(half.size(), [&](int y) {
        if (image.depth() == CV_16U)
            dispatched::halveRow(image.ptr<ushort>(2 * y), image.ptr<ushort>(2 * y + 1), width, channels,
                                 half.ptr<ushort>(y));
        else
            dispatched::halveRow(image.ptr(2 * y), image.ptr(2 * y + 1), width, channels, half.ptr(y));
    });
}

void buildPyramid(const std::vector<Mat>& given, size_t layers, std::vector<Mat>& pyramid)
{
    pyramid.resize(layers);
    std::copy_n(given.begin(), std::min(given.size(), layers), pyramid.begin());
    for (size_t layer = given.size(); layer < layers; ++layer)
        halveImage(pyramid[layer - 1], pyramid[layer]);
}

Mat dataOfLayer(const Mat& mask, int layer)
{
    if (mask.empty())
        return Mat();
    std::vector<Mat> pyramid;
    buildPyramid({ mask }, layer + 1, pyramid);
    return pixelsWithData(pyramid.back());
}

}}} // namespace cv::stereo::hdp
