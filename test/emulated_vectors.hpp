// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// For src/*.simd.hpp once more, with OpenCV's emulation of vectors in place of those of the machine, in namespace
// opt_emulated: the first header of a test, before theirs.
#ifndef OPENCV_HDPSTEREO_TEST_EMULATED_VECTORS_HPP
#define OPENCV_HDPSTEREO_TEST_EMULATED_VECTORS_HPP

#define CV_FORCE_SIMD128_CPP

#include "test_precomp.hpp"

#undef CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
#undef CV_CPU_OPTIMIZATION_NAMESPACE_END
#define CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN namespace opt_emulated {
#define CV_CPU_OPTIMIZATION_NAMESPACE_END }

#endif
