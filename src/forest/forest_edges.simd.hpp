// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "opencv2/core/hal/intrin.hpp"
#include <algorithm>
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! weighEdges() for a row of pixels of 1 or 3 channels; next: the row below
void weighRow(const uchar* row, const uchar* next, int width, int channels, uchar* weights);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The largest absolute difference over the channels of two pixels
int difference(const uchar* a, const uchar* b, int channels)
{
    int largest = 0;
    for (int c = 0; c < channels; ++c)
        largest = std::max(largest, std::abs(a[c] - b[c]));
    return largest;
}

#if CV_SIMD128
//! difference() of 16 pairs of pixels
v_uint8x16 differences(const uchar* a, const uchar* b, int channels)
{
    if (channels == 1)
        return v_absdiff(v_load(a), v_load(b));
    v_uint8x16 a0, a1, a2, b0, b1, b2;
    v_load_deinterleave(a, a0, a1, a2);
    v_load_deinterleave(b, b0, b1, b2);
    return v_max(v_max(v_absdiff(a0, b0), v_absdiff(a1, b1)), v_absdiff(a2, b2));
}
#endif

} // namespace

void weighRow(const uchar* row, const uchar* next, int width, int channels, uchar* weights)
{
    int x = 0;
#if CV_SIMD128
    for (; x + 16 < width; x += 16)
    {
        const uchar *p = row + x * channels, *right = p + channels, *below = next + x * channels;
        v_store_interleave(weights + 2 * x, differences(p, right, channels), differences(p, below, channels));
    }
#endif
    for (; x < width; ++x)
    {
        const uchar *p = row + x * channels, *right = x + 1 < width ? p + channels : p;
        weights[2 * x] = (uchar)difference(p, right, channels);
        weights[2 * x + 1] = (uchar)difference(p, next + x * channels, channels);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
