// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "opencv2/core.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! The sum of four rows with weights in 1/1024, rounded and kept in the range of the type.
template <typename T> void mixRows(const T* const rows[4], const int weights[4], int begin, int end, T* mixed);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

template <typename T> void mixRows(const T* const rows[4], const int weights[4], int begin, int end, T* mixed)
{
    const T *const a = rows[0], *const b = rows[1], *const c = rows[2], *const d = rows[3];
    const int wa = weights[0], wb = weights[1], wc = weights[2], wd = weights[3];
    const int largest = (1 << 8 * sizeof(T)) - 1;
    HDP_VECTORIZED for (int x = begin; x < end; ++x)
    {
        const int sum = (wa * a[x] + wb * b[x] + wc * c[x] + wd * d[x] + 512) >> 10;
        mixed[x] = (T)(sum < 0 ? 0 : sum > largest ? largest : sum);
    }
}

template void mixRows(const uchar* const*, const int*, int, int, uchar*);
template void mixRows(const ushort* const*, const int*, int, int, ushort*);

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
