// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! weighEdges() for a row of pixels of 1 or 3 channels; next: the row below
void weighRow(const uchar* row, const uchar* next, int width, int channels, uchar* weights);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The largest absolute difference over the channels of two pixels
template <int channels> CV_ALWAYS_INLINE uchar largestDifference(const uchar* a, const uchar* b)
{
    uchar largest = 0;
    for (int c = 0; c < channels; ++c)
        largest = std::max(largest, difference(a[c], b[c]));
    return largest;
}

template <int channels> void weighPixels(const uchar* row, const uchar* next, int width, uchar* weights)
{
    const int last = width - 1;
    HDP_VECTORIZED for (int x = 0; x < last; ++x)
    {
        const uchar* const p = row + x * channels;
        weights[2 * x] = largestDifference<channels>(p, p + channels);
        weights[2 * x + 1] = largestDifference<channels>(p, next + x * channels);
    }
    weights[2 * last] = 0; // there is no pixel
    weights[2 * last + 1] = largestDifference<channels>(row + last * channels, next + last * channels);
}

} // namespace

void weighRow(const uchar* row, const uchar* next, int width, int channels, uchar* weights)
{
    channels == 1 ? weighPixels<1>(row, next, width, weights) : weighPixels<3>(row, next, width, weights);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
