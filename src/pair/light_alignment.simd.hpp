// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "light_alignment.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

void relightRow(const RowLight& light, int width, ushort* levels);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void relightRow(const RowLight& light, int width, ushort* levels)
{
    const RowLight own = light;
    HDP_VECTORIZED for (int k = 0; k < width; ++k)
    {
        const float x = own.first + own.step * (float)(own.origin + k), x2 = x * x, level = (float)levels[k];
        const float gain = own.gain[0] + own.gain[1] * x + x2 * (own.gain[2] + own.gain[3] * x2);
        const float value = own.offset + level * (gain + level * (own.square + level * own.cube)) + 0.5f;
        const float low = value < 0 ? 0.f : value;
        levels[k] = (ushort)(int)(low > own.largest ? own.largest : low);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
