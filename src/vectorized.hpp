// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VECTORIZED_HPP
#define OPENCV_HDPSTEREO_VECTORIZED_HPP

/** Before a loop whose rounds are independent of one another, for the compiler to make vector operations of:
what is written in one round is neither read nor written in another, and GCC does not unroll it before it could see that
it is one for vectors. */
#if defined(__clang__)
#define HDP_VECTORIZED _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define HDP_VECTORIZED _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define HDP_VECTORIZED
#endif

#endif
