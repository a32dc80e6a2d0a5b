// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! weighEdges() for a row of pixels of 1 or 3 bytes, or for grey levels of 16 bits; next: the row below
template <typename T> void weighRow(const T* row, const T* next, int width, int channels, uchar* weights);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! w of two pixels
template <int channels> CV_ALWAYS_INLINE uchar weightOf(const uchar* a, const uchar* b)
{
    uchar largest = 0;
    for (int c = 0; c < channels; ++c)
        largest = std::max(largest, difference(a[c], b[c]));
    return largest;
}

//! The same by their grey levels
template <int> CV_ALWAYS_INLINE uchar weightOf(const ushort* a, const ushort* b)
{
    const int unit = 8 * greyScale;
    const ushort rounded = (ushort)(9 * (std::max(*a, *b) - std::min(*a, *b)) + unit - 1);
    return (uchar)std::min<ushort>(rounded / unit, UCHAR_MAX);
}

template <int channels, typename T> void weighPixels(const T* row, const T* next, int width, uchar* weights)
{
    const int last = width - 1;
    HDP_VECTORIZED for (int x = 0; x < last; ++x)
    {
        const T* const p = row + x * channels;
        weights[2 * x] = weightOf<channels>(p, p + channels);
        weights[2 * x + 1] = weightOf<channels>(p, next + x * channels);
    }
    weights[2 * last] = 0; // there is no pixel
    weights[2 * last + 1] = weightOf<channels>(row + last * channels, next + last * channels);
}

} // namespace

template <typename T> void weighRow(const T* row, const T* next, int width, int channels, uchar* weights)
{
    channels == 1 ? weighPixels<1>(row, next, width, weights) : weighPixels<3>(row, next, width, weights);
}

template void weighRow(const uchar*, const uchar*, int, int, uchar*);
template void weighRow(const ushort*, const ushort*, int, int, uchar*);

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
