// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "left_right_check.hpp"
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! The left-right check of a row, see testVisibility(), with memory for its columns. invalid: disparity of pixels that
//! map to no column, or a value that none has.
template <typename T>
void visibilityRow(const T* disparity, int width, int invalid, int maxDifference, int* columns, int* nearest,
                   uchar* visibility);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

template <typename T>
void visibilityRow(const T* disparity, int width, int invalid, int maxDifference, int* columns, int* nearest,
                   uchar* visibility)
{
    static_assert(subpixelScale == 1 << 4, "divided by a shift, so that negative ones are rounded as others");
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        // As cvRound(disparity / 16.), for vectors: of two that are equally near the even one
        const int own = disparity[x], rounded = (own + subpixelScale / 2 - 1 + ((own >> 4) & 1)) >> 4;
        const int column = x + 1 - rounded;
        columns[x] = ((column > 0) & (column <= width) & (disparity[x] != invalid)) ? column : 0;
    }
    testVisibility(disparity, columns, width, width, maxDifference, nearest, visibility);
}

template void visibilityRow(const ushort*, int, int, int, int*, int*, uchar*);
template void visibilityRow(const short*, int, int, int, int*, int*, uchar*);

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
