// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "image_pyramid.hpp"
#include "vectorized.hpp"

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! Means of 2 x 2 pixels of one or three channels, truncated. width: of the means, in pixels.
void halveRow(const uchar* upper, const uchar* lower, int width, int channels, uchar* means);

//! Means of 2 x 2 grey levels, rounded.
void halveGreyRow(const ushort* upper, const ushort* lower, int width, ushort* means);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void halveRow(const uchar* upper, const uchar* lower, int width, int channels, uchar* means)
{
    if (channels == 1)
    {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) means[x] =
            (uchar)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]) / 4);
        return;
    }
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const uchar *a = upper + 6 * x, *b = lower + 6 * x;
        means[3 * x] = (uchar)((a[0] + a[3] + b[0] + b[3]) / 4);
        means[3 * x + 1] = (uchar)((a[1] + a[4] + b[1] + b[4]) / 4);
        means[3 * x + 2] = (uchar)((a[2] + a[5] + b[2] + b[5]) / 4);
    }
}

void halveGreyRow(const ushort* upper, const ushort* lower, int width, ushort* means)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x) means[x] =
        (ushort)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) / 4);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
