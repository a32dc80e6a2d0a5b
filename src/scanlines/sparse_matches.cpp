// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "sparse_matches.hpp"
#include "sparse_matches.simd.hpp"
#include "scanlines/sparse_matches.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "../base/tunable.hpp"

#include <cstring>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, rivalDistance, 2, "pixels", "candidates as near to the best one are no rivals: its minimum is there");
HDP_TUNABLE(int, uniqueness, 2, "costs of the best match",
            "by which rivals cost more: a smaller factor lets wrong matches in, a larger one finds few");
HDP_TUNABLE(int, comparisonsPerDarker, 4, "comparisons of the census",
            "of which one finds a darker pixel in a window with texture: flat ones match each other perfectly");

HDP_DISPATCH(sumWindowCosts)

//! Whether enough of the window's comparisons found a darker pixel
bool hasTexture(const CensusCost& cost, const uchar* left)
{
    const unsigned mask = 0xffffff >> (8 * (3 - cost.planes()));
    int darker = 0;
    for (int i = 0; i <= 2 * SparseMatches::radius; ++i, left += 4)
        darker += countCensusBits((left[0] | (unsigned)left[1] << 8 | (unsigned)left[2] << 16) & mask);
    return darker * comparisonsPerDarker >= cost.comparisons() * (2 * SparseMatches::radius + 1);
}

//! Whether all of the window has
bool hasData(const CostLimits& limits, int y, int x)
{
    return limits.isEmpty() ||
           std::memchr(limits.left(y) + x - SparseMatches::radius, 0, 2 * SparseMatches::radius + 1) == nullptr;
}

HDP_DISPATCH(lowestCost)

//! The disparity of a unique minimum
ushort uniqueMatch(const uchar* costs, int count)
{
    const int lowest = dispatched::lowestCost(costs, count);
    const int best = (int)(std::find(costs, costs + count, (uchar)lowest) - costs);
    const int before = std::max(best - rivalDistance, 0);
    const int after = std::min(best + rivalDistance + 1, count);
    if (before == 0 && after == count) // no rivals
        return (ushort)SparseMatches::noMatch;
    const int rival =
        std::min(dispatched::lowestCost(costs, before), dispatched::lowestCost(costs + after, count - after));
    return (ushort)(lowest * uniqueness < rival ? best * subpixelScale : SparseMatches::noMatch);
}

} // namespace

void findSparseMatches(const CensusCost& cost, Size size, int numDisparities, Mat& matches)
{
    const int spacing = SparseMatches::spacing, radius = SparseMatches::radius;
    matches.create((size.height + spacing - 1) / spacing, (size.width + spacing - 1) / spacing, CV_16U);
    parallel_for_(Range(0, matches.rows), [&](const Range& range) {
        std::vector<uchar> costs(alignSize(numDisparities, 32));
        for (int i = range.start; i < range.end; ++i)
            for (int j = 0; j < matches.cols; ++j)
            {
                const int x = j * spacing + spacing / 2, y = std::min(i * spacing + spacing / 2, size.height - 1);
                const int count = std::min(x - radius + 1, numDisparities); // those inside the right image
                ushort& match = matches.at<ushort>(i, j);
                match = SparseMatches::noMatch;
                if (count <= 0 || x + radius >= size.width)
                    continue;
                const uchar* left = cost.leftPixels(y) + 4 * (x - radius);
                if (!hasTexture(cost, left) || !hasData(cost.limits(), y, x))
                    continue;
                const uchar* right = cost.rightPlane(0, y) + size.width - 1 - (x - radius);
                dispatched::sumWindowCosts(left, right, cost.planeStride(), cost.planes(), count, costs.data());
                match = uniqueMatch(costs.data(), count);
            }
    });
}

}}} // namespace cv::stereo::hdp
