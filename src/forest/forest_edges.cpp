// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "forest_edges.hpp"

#include "forest_edges.simd.hpp"
#include "forest/forest_edges.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include <cmath>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

// DT-Rule 1 of the paper drops each edge between pixels without a common disparity. The authors' program, which made
// the paper's tables, keeps those of at most this weight.
const int largestSparedWeight = 7;

HDP_DISPATCH(weighRow)

//! DT-Rule 1, without a branch
int isKept(int weight, const DisparityInterval& a, const DisparityInterval& b)
{
    return (int)(weight <= largestSparedWeight) | (int)(std::max(a.first, b.first) <= std::min(a.last, b.last));
}

} // namespace

void weighEdges(const Mat& image, Mat& weights)
{
    weights.create(image.size(), CV_8UC2);
    parallelForRows(image.size(), [&](int y) {
        const int next = std::min(y + 1, image.rows - 1); // the last row itself below it
        if (image.depth() == CV_16U)
            dispatched::weighRow(image.ptr<ushort>(y), image.ptr<ushort>(next), image.cols, 1, weights.ptr(y));
        else
            dispatched::weighRow(image.ptr(y), image.ptr(next), image.cols, image.channels(), weights.ptr(y));
    });
}

EdgeSimilarity::EdgeSimilarity(double gamma)
{
    for (int w = 0; w < 256; ++w)
        table[w] = w > 0 ? (float)std::exp(-w / gamma) : 1.f; // 0 / gamma is none if it is too small for a number
}

void selectEdges(const Mat& weights, const Mat& pixelIntv, const Range& rows, std::vector<int>& edges)
{
    const int width = weights.cols, begin = std::max(rows.start - 1, 0);
    edges.resize((size_t)(rows.end - begin) * width * 2);
    size_t count = 0;
    for (int y = begin; y < rows.end; ++y)
    {
        const uchar* const weight = weights.ptr(y);
        const DisparityInterval* const interval = pixelIntv.ptr<DisparityInterval>(y);
        const DisparityInterval* const next = pixelIntv.ptr<DisparityInterval>(std::min(y + 1, weights.rows - 1));
        const int hasRight = (int)(y >= rows.start), hasBelow = (int)(y + 1 < weights.rows);
        for (int x = 0; x < width; ++x) // without branches, which would often be mispredicted
        {
            const int edge = 2 * (y * width + x), right = std::min(x + 1, width - 1);
            edges[count] = edge;
            count += hasRight & (int)(x < right) & isKept(weight[2 * x], interval[x], interval[right]);
            edges[count] = edge + 1;
            count += hasBelow & isKept(weight[2 * x + 1], interval[x], next[x]);
        }
    }
    edges.resize(count);
}

void sortByWeight(const Mat& weights, std::vector<int>& edges)
{
    const uchar* weight = weights.ptr();
    int places[257] = { 0 };
    for (int edge : edges)
        ++places[weight[edge] + 1];
    std::partial_sum(places, places + 257, places);
    const std::vector<int> unsorted = edges;
    for (int edge : unsorted)
        edges[places[weight[edge]]++] = edge;
}

}}} // namespace cv::stereo::hdp
