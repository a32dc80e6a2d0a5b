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

//! Makes (level - black) * gain / 65536 of each level of a row, from 0 to white. gain: 1 to 2^30, of any contrast
void stretchRow(ushort* levels, int width, int black, int gain, int white);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void greyRow(const uchar* pixels, int channels, int width, int times, ushort* levels)
{
    const int shift = 14 - times, half = 1 << (shift - 1);
    static_assert(65536 / greyScale == 1 << 14, "greyOf() is in 1 / 65536.");
    if (channels == 3) // known to the compiler
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)((greyOf(pixels + 3 * x) + half) >> shift);
    else
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)((greyOf(pixels + 4 * x) + half) >> shift);
}

void stretchRow(ushort* levels, int width, int black, int gain, int white)
{
    const int most = (int)(((int64)(white + 1) << 16) / gain) + 1; // that becomes white: products stay below 2^31
    HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
        (ushort)std::min(std::min(std::max(levels[x] - black, 0), most) * gain >> 16, white);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
