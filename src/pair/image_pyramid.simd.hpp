// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "image_pyramid.hpp"
#include "../base/vectorized.hpp"

#include <cstring>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! Means of 2 x 2 pixels of one or three channels, see halveImage(). width: of the means, in pixels.
template <typename T> void halveRow(const T* upper, const T* lower, int width, int channels, T* means);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

template <typename T> void halveRow(const T* upper, const T* lower, int width, int channels, T* means)
{
    const int half = sizeof(T) == 1 ? 0 : 2;
    if (channels == 1)
    {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) means[x] =
            (T)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + half) / 4);
        return;
    }
    // Also where no pixel begins, for vectors; then every second one is taken.
    const int block = 64;
    T all[6 * block];
    for (int begin = 0; begin < width; begin += block)
    {
        const int count = std::min(block, width - begin);
        const T *a = upper + 6 * begin, *b = lower + 6 * begin;
        HDP_VECTORIZED for (int i = 0; i < 6 * count - 3; ++i) all[i] =
            (T)((a[i] + a[i + 3] + b[i] + b[i + 3] + half) / 4);
        for (int x = 0; x < count; ++x)
            std::memcpy(means + 3 * (begin + x), all + 6 * x, 3 * sizeof(T));
    }
}

template void halveRow(const uchar*, const uchar*, int, int, uchar*);
template void halveRow(const ushort*, const ushort*, int, int, ushort*);

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
