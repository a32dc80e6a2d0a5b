// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "sparse_matches.hpp"
#include "../base/vectorized.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/byte_lanes.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** The costs of a point's candidates, see findSparseMatches().
@param left The first pixel of the window, see CensusCost::leftPixels().
@param right Its candidates in the first plane, see CensusCost::rightPlane().
@param planeStride From a plane to the next.
@param planes Their number.
@param numDisparities Number of candidates.
@param costs Receives them; up to 31 more are written. */
void sumWindowCosts(const uchar* left, const uchar* right, size_t planeStride, int planes, int numDisparities,
                    uchar* costs);

//! The lowest of count costs, 255 if there are none
uchar lowestCost(const uchar* costs, int count);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

uchar lowestCost(const uchar* costs, int count)
{
    uchar lowest = UCHAR_MAX;
    HDP_VECTORIZED for (int i = 0; i < count; ++i) lowest = costs[i] < lowest ? costs[i] : lowest;
    return lowest;
}

void sumWindowCosts(const uchar* left, const uchar* right, size_t planeStride, int planes, int numDisparities,
                    uchar* costs)
{
    for (int first = 0; first < numDisparities; first += 16 * ByteLanes::groups)
    {
        ByteLanes sum = ByteLanes::repeat(0);
        for (int i = 0; i <= 2 * SparseMatches::radius; ++i)
            for (int plane = 0; plane < planes; ++plane)
            {
                const ByteLanes candidates = ByteLanes::load(right + plane * planeStride + first - i);
                sum = sum + (ByteLanes::repeat(left[4 * i + plane]) ^ candidates).countBits();
            }
        sum.store(costs + first);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
