// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Sums over the squares around the pixels of a row; beside it are the nearest ones.
@param rows The rows of the squares.
@param radius 1 or 2, from a square's centre to its side.
@param width Number of pixels.
@param columns Memory for a row, and radius elements on both sides.
@param sums Receives the sums. */
void sumSquares(const uchar* const* rows, int radius, int width, ushort* columns, ushort* sums);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void sumSquares(const uchar* const* rows, int radius, int width, ushort* columns, ushort* sums)
{
    const uchar *first = rows[0], *last = rows[2 * radius];
    const uchar *second = rows[radius == 2 ? 1 : 0], *fourth = rows[radius == 2 ? 3 : 0], *middle = rows[radius];
    const int inner = radius == 2;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) columns[x] =
        (ushort)(first[x] + middle[x] + last[x] + inner * (second[x] + fourth[x]));
    for (int k = 1; k <= radius; ++k)
    {
        columns[-k] = columns[0];
        columns[width - 1 + k] = columns[width - 1];
    }
    HDP_VECTORIZED for (int x = 0; x < width; ++x) sums[x] =
        (ushort)(columns[x - 1] + columns[x] + columns[x + 1] + inner * (columns[x - radius] + columns[x + radius]));
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
