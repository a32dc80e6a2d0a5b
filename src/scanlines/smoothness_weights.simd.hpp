// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "smoothness_weights.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** What a row shows of both terms.
@param below Those of the next row, or its own if it is the last one.
@param matched Receives the costs, by chance at most; pixels without data have a usual one.
@param breaks Receives how many of a pixel's neighbours to the right and below are another surface. */
void findTermsOfRow(const ushort* upper, const ushort* below, const uchar* residual, int width, int bits,
                    uchar* matched, uchar* breaks);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

CV_ALWAYS_INLINE ushort isBreak(ushort a, ushort b) { return (ushort)(difference(a, b) > (ushort)subpixelScale); }

} // namespace

void findTermsOfRow(const ushort* upper, const ushort* below, const uchar* residual, int width, int bits,
                    uchar* matched, uchar* breaks)
{
    const uchar usual = (uchar)(bits / 8), chance = (uchar)(bits / 2);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const uchar cost = std::min(residual[x], chance);
        matched[x] = residual[x] == UCHAR_MAX ? usual : cost;
    }
    HDP_VECTORIZED for (int x = 0; x < width - 1; ++x) breaks[x] =
        (uchar)(isBreak(upper[x], upper[x + 1]) + isBreak(upper[x], below[x]));
    breaks[width - 1] = (uchar)isBreak(upper[width - 1], below[width - 1]);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
