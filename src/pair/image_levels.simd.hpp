// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "image_levels.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! Grey levels of BGR pixels, doubled some times and not cut off, see greyLevels(). channels: 3, or 4 with alpha.
void greyRow(const uchar* pixels, int channels, int width, int times, ushort* levels);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

template <int channels> void greyRow(const uchar* pixels, int width, int times, ushort* levels)
{
    const int shift = 14 - times, half = 1 << (shift - 1);
    static_assert(65536 / greyScale == 1 << 14, "greyOf() is in 1 / 65536.");
    HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
        (ushort)((greyOf(pixels + channels * x) + half) >> shift);
}

} // namespace

void greyRow(const uchar* pixels, int channels, int width, int times, ushort* levels)
{
    if (channels == 3)
        greyRow<3>(pixels, width, times, levels);
    else
        greyRow<4>(pixels, width, times, levels);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
