// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "image_pyramid.hpp"
#include "../base/vectorized.hpp"

#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! Means of 2 x 2 pixels of one or three channels, truncated. width: of the means, in pixels.
void halveRow(const uchar* upper, const uchar* lower, int width, int channels, uchar* means);

//! The same of grey levels, rounded. channels: 1
void halveRow(const ushort* upper, const ushort* lower, int width, int channels, ushort* means);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void halveRow(const uchar* upper, const uchar* lower, int width, int channels, uchar* means)
{
    if (channels == 1)
    {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) means[x] =
            (uchar)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]) / 4);
        return;
    }
    // Also where no pixel begins, for vectors; then every second one is taken.
    const int block = 64;
    uchar all[6 * block];
    for (int begin = 0; begin < width; begin += block)
    {
        const int count = std::min(block, width - begin);
        const uchar *a = upper + 6 * begin, *b = lower + 6 * begin;
        HDP_VECTORIZED for (int i = 0; i < 6 * count - 3; ++i) all[i] =
            (uchar)((a[i] + a[i + 3] + b[i] + b[i + 3]) / 4);
        for (int x = 0; x < count; ++x)
            std::memcpy(means + 3 * (begin + x), all + 6 * x, 3);
    }
}

void halveRow(const ushort* upper, const ushort* lower, int width, int, ushort* means)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x) means[x] =
        (ushort)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) / 4);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
