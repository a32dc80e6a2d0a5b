// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "left_right_check.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/** The visibility test: compares each disparity of a row with the maximum of those that map to the same column.
@param disparity In 1 / subpixelScale pixel.
@param columns Of the right image that each pixel maps to, from 1 on; 0: none.
@param count Of pixels.
@param width Of the right image.
@param maxDifference Of a visible pixel, in 1 / subpixelScale pixel.
@param nearest Memory for width + 1 columns.
@param visibility Receives a Visibility per pixel. */
template <typename T>
CV_ALWAYS_INLINE void testVisibility(const T* disparity, const int* columns, int count, int width, int maxDifference,
                                     int* nearest, uchar* visibility)
{
    HDP_VECTORIZED for (int column = 0; column <= width; ++column) nearest[column] = SHRT_MIN;
    for (int x = 0; x < count; ++x)
        nearest[columns[x]] = std::max(nearest[columns[x]], (int)disparity[x]);
    HDP_VECTORIZED for (int x = 0; x < count; ++x)
    {
        const int column = columns[x], inside = nearest[column] - disparity[x] > maxDifference ? OCCLUDED : VISIBLE;
        visibility[x] = (uchar)(column == 0 ? OUTSIDE : inside);
    }
}

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
