// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "thin_structures.hpp"

#include "../base/disparity_units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

//! Whether one of count disparities before the median is nearer than after it by ThinStructures::minDistance
bool isAnyNearer(const ushort* before, const ushort* after, int count)
{
    const ushort minDistance = ThinStructures::minDistance * subpixelScale;
    ushort any = 0;
    HDP_VECTORIZED for (int x = 0; x < count; ++x)
    {
        const ushort nearer = (ushort)(std::max(before[x], after[x]) - after[x]);
        any |= (ushort)(nearer >= minDistance);
    }
    return any != 0;
}

//! Whether enough pixels around this one have its disparity
bool isInStructure(const Mat& disparity, int y, int x)
{
    const int radius = ThinStructures::window / 2, maxDifference = ThinStructures::maxDifference * subpixelScale;
    const Range rows(std::max(y - radius, 0), std::min(y + radius + 1, disparity.rows));
    const Range columns(std::max(x - radius, 0), std::min(x + radius + 1, disparity.cols));
    const int own = disparity.at<ushort>(y, x);
    int count = 0;
    for (int v = rows.start; v < rows.end; ++v)
    {
        const ushort* row = disparity.ptr<ushort>(v);
        for (int u = columns.start; u < columns.end; ++u)
            count += std::abs(row[u] - own) <= maxDifference;
    }
    return 100 * count >= ThinStructures::minShare * rows.size() * columns.size();
}

} // namespace

void restoreThinStructures(const Mat& unfiltered, Mat& disparity)
{
    const int minDistance = ThinStructures::minDistance * subpixelScale;
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* before = unfiltered.ptr<ushort>(y);
            ushort* row = disparity.ptr<ushort>(y);
            for (int begin = 0; begin < disparity.cols; begin += ThinStructures::columns)
            {
                // Hardly a group of columns has any.
                const int end = std::min(begin + ThinStructures::columns, disparity.cols);
                if (!isAnyNearer(before + begin, row + begin, end - begin))
                    continue;
                for (int x = begin; x < end; ++x)
                    if (before[x] - row[x] >= minDistance && isInStructure(unfiltered, y, x))
                        row[x] = before[x];
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
