// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const int radius = 3; // of the window, that of the largest median
HDP_TUNABLE(int, minShare, 30, "percent of the window",
            "of the structure: less restores noise, more only what is thick");
HDP_TUNABLE(int, minDistance, 5, "pixels",
            "in front of what the median left: nearer ones are rather noise of a surface");
const int groupColumns = 64; // that are tested at once: most groups have none, and are left out

//! Whether enough pixels around this one have its disparity
bool isInStructure(const Mat& disparity, int y, int x)
{
    const int maxStep = subpixelScale; // inside the structure: exact equality fails by rounding
    const Range rows(std::max(y - radius, 0), std::min(y + radius + 1, disparity.rows));
    const Range inside(std::max(x - radius, 0), std::min(x + radius + 1, disparity.cols));
    const int own = disparity.at<ushort>(y, x);
    int count = 0;
    for (int v = rows.start; v < rows.end; ++v)
    {
        const ushort* row = disparity.ptr<ushort>(v);
        for (int u = inside.start; u < inside.end; ++u)
            count += std::abs(row[u] - own) <= maxStep;
    }
    return 100 * count >= minShare * rows.size() * inside.size();
}

} // namespace

void restoreThinStructures(const Mat& unfiltered, Mat& disparity)
{
    const ushort minRise = (ushort)(minDistance * subpixelScale);
    parallelForRows(disparity.size(), [&](int y) {
        const ushort* before = unfiltered.ptr<ushort>(y);
        ushort* row = disparity.ptr<ushort>(y);
        for (int begin = 0; begin < disparity.cols; begin += groupColumns)
        {
            const int end = std::min(begin + groupColumns, disparity.cols);
            ushort isAnyNearer = 0;
            HDP_VECTORIZED for (int x = begin; x < end; ++x) isAnyNearer |=
                (ushort)((ushort)(std::max(before[x], row[x]) - row[x]) >= minRise);
            for (int x = begin; x < end && isAnyNearer; ++x)
                if (before[x] - row[x] >= minRise && isInStructure(unfiltered, y, x))
                    row[x] = before[x];
        }
    });
}

}}} // namespace cv::stereo::hdp
