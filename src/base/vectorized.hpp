// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VECTORIZED_HPP
#define OPENCV_HDPSTEREO_VECTORIZED_HPP

#include "opencv2/core/cvdef.h"
#include <algorithm>

/** HDP_VECTORIZED before a loop whose iterations are independent of one another, for the compiler to make vector
operations of: what one writes is neither read nor written in another, but for sums, extremes and bits in a local
variable; and GCC does not unroll the loop before it could see that it is one for vectors. HDP_FOR_LANES(k, lanes) is
such a loop over 4, 8, 16, 32 or 64 lanes, a number that is known to the compiler, in groups of 8 that are unrolled. */
#if defined(__clang__)
#define HDP_VECTORIZED _Pragma("clang loop vectorize(assume_safety)")
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HDP_SANITIZED // what is unrolled or has many cases takes minutes to compile with all checks
#define HDP_UNROLLED
#else
#define HDP_UNROLLED _Pragma("clang loop unroll(full)")
#endif
#elif defined(__GNUC__)
#define HDP_VECTORIZED _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HDP_SANITIZED // as above
#define HDP_UNROLLED
#else
#define HDP_UNROLLED _Pragma("GCC unroll 8")
#endif
#else
#define HDP_VECTORIZED
#define HDP_UNROLLED
#endif
#define HDP_FOR_LANES(k, lanes)                                                                                        \
    HDP_UNROLLED for (int group = 0; group < (lanes); group += (lanes) < 8 ? (lanes) : 8)                              \
        HDP_VECTORIZED for (int k = group; k < group + ((lanes) < 8 ? (lanes) : 8); ++k)

namespace cv { namespace stereo { namespace hdp {

// What follows is always inlined, so that no instruction set has a symbol of it.

//! |a - b| of numbers without sign, in their own lanes
template <typename T> CV_ALWAYS_INLINE T difference(T a, T b) { return (T)(std::max(a, b) - std::min(a, b)); }

//! condition ? a : b, condition being 0 or 1, without a branch
CV_ALWAYS_INLINE int choose(int condition, int a, int b) { return b ^ ((a ^ b) & -condition); }

//! The value, or the limit that it is beyond
template <typename T> CV_ALWAYS_INLINE T clamped(T value, T min, T max) { return std::min(std::max(value, min), max); }

//! Task<lanes>::run(args...) for 4, 8, 16, 32 or 64 lanes, then known to the compiler
template <template <int> class Task, typename... Args> CV_ALWAYS_INLINE void runTask(int lanes, Args&&... args)
{
    switch (lanes)
    {
    case 4:
        return Task<4>::run(args...);
    case 8:
        return Task<8>::run(args...);
    case 16:
        return Task<16>::run(args...);
    case 32:
        return Task<32>::run(args...);
    default:
        return Task<64>::run(args...);
    }
}

}}} // namespace cv::stereo::hdp

#endif
