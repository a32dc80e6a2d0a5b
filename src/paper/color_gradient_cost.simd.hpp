// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "color_gradient_cost.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! ColorGradientCost::evaluate()
void evaluateColorGradientCost(const ColorGradientPlanes& planes, const int* pixels, int count, int first, int lanes,
                               float* cost);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

inline short absolute(short value) { return std::max<short>(value, (short)-value); }

template <int lanes, int channels>
void evaluateCosts(const ColorGradientPlanes& planes, const int* pixels, int size, int first, float* cost)
{
    const double rowsPerPixel = 1. / planes.width;
    const float colorWeight = planes.colorWeight, colorTruncation = planes.colorTruncation,
                gradientWeight = planes.gradientWeight, gradientTruncation = planes.gradientTruncation;
    for (int i = 0; i < size; ++i, cost += lanes)
    {
        const int y = rowOf(pixels[i], rowsPerPixel), x = pixels[i] - y * planes.width;
        const int mirroredX = planes.width - 1 - x + planes.blockSize - 1 + first;
        float sum[lanes] = { 0 };
        for (int dy = 0; dy < planes.blockSize; ++dy)
            for (int dx = 0; dx < planes.blockSize; ++dx)
            {
                const size_t left = (y + dy) * planes.left.step + x + dx;
                const size_t right = (y + dy) * planes.right.step + mirroredX - dx;
                const uchar *pixel = planes.left.color + left, *candidates = planes.right.color + right;
                const short slope = planes.left.gradient[left], blue = pixel[0],
                            green = channels > 1 ? pixel[planes.left.plane] : 0,
                            red = channels > 1 ? pixel[2 * planes.left.plane] : 0;
                const short* slopes = planes.right.gradient + right;
                const size_t plane = channels > 1 ? planes.right.plane : 0;
                const uchar *greens = candidates + plane, *reds = greens + plane;
                short color[lanes];
                HDP_VECTORIZED for (int k = 0; k < lanes; ++k)
                {
                    short difference = absolute((short)(blue - candidates[k]));
                    if (channels > 1)
                        difference = (short)(difference + absolute((short)(green - greens[k])) +
                                             absolute((short)(red - reds[k])));
                    color[k] = difference;
                }
                HDP_VECTORIZED for (int k = 0; k < lanes; ++k) sum[k] +=
                    colorWeight * std::min((float)color[k], colorTruncation) +
                    gradientWeight * std::min((float)std::abs(slope - slopes[k]), gradientTruncation);
            }
        HDP_VECTORIZED for (int k = 0; k < lanes; ++k) cost[k] = sum[k];
    }
}

template <int lanes> struct EvaluateTask
{
    static void run(const ColorGradientPlanes& planes, const int* pixels, int size, int first, float* cost)
    {
        if (planes.count == 3)
            evaluateCosts<lanes, 3>(planes, pixels, size, first, cost);
        else
            evaluateCosts<lanes, 1>(planes, pixels, size, first, cost);
    }
};

} // namespace

void evaluateColorGradientCost(const ColorGradientPlanes& planes, const int* pixels, int count, int first, int lanes,
                               float* cost)
{
    runTask<EvaluateTask>(lanes, planes, pixels, count, first, cost);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
