// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "opencv2/core.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of alignLight(), in place: levels r become offset + r (gain(x) + r (square + r cube)), with the gain
gain[0] + gain[1] x + gain[2] x^2 + gain[3] x^4.
@param levels
@param origin Number of the first column.
@param cols
@param first x of column 0.
@param step From a column to the next.
@param gain
@param curve The offset, the square and the cube.
@param largest Of the levels. */
void alignLightRow(ushort* levels, int origin, int cols, float first, float step, const float gain[4],
                   const float curve[3], float largest);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void alignLightRow(ushort* levels, int origin, int cols, float first, float step, const float gain[4],
                   const float curve[3], float largest)
{
    const float g0 = gain[0], g1 = gain[1], g2 = gain[2], g4 = gain[3];
    const float offset = curve[0], square = curve[1], cube = curve[2];
    HDP_VECTORIZED for (int i = 0; i < cols; ++i)
    {
        const float x = first + step * (float)(origin + i), r = (float)levels[i];
        const float x2 = x * x, local = g0 + g1 * x + x2 * (g2 + g4 * x2);
        const float value = offset + r * (local + r * (square + r * cube)) + 0.5f;
        const float low = value < 0 ? 0.f : value;
        levels[i] = (ushort)(int)(low > largest ? largest : low);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
