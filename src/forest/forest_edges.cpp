// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "forest_edges.hpp"

#include "opencv2/core/hal/intrin.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

// DT-Rule 1 of the paper drops each edge between pixels without a common disparity. The authors' program, which made
// the paper's tables, keeps those of at most this weight.
const int largestSparedWeight = 7;

//! The largest absolute difference over the channels of two pixels
int difference(const uchar* a, const uchar* b, int channels)
{
    int largest = 0;
    for (int c = 0; c < channels; ++c)
        largest = std::max(largest, std::abs(a[c] - b[c]));
    return largest;
}

#if CV_SIMD128
//! difference() of 16 pairs of pixels
v_uint8x16 differences(const uchar* a, const uchar* b, int channels)
{
    if (channels == 1)
        return v_absdiff(v_load(a), v_load(b));
    v_uint8x16 a0, a1, a2, b0, b1, b2;
    v_load_deinterleave(a, a0, a1, a2);
    v_load_deinterleave(b, b0, b1, b2);
    return v_max(v_max(v_absdiff(a0, b0), v_absdiff(a1, b1)), v_absdiff(a2, b2));
}
#endif

//! DT-Rule 1, without a branch
bool isKept(int weight, const DisparityInterval& a, const DisparityInterval& b)
{
    return (weight <= largestSparedWeight) | (std::max(a.first, b.first) <= std::min(a.last, b.last));
}

} // namespace

void weighEdges(const Mat& image, Mat& weights)
{
    const int channels = image.channels(), width = image.cols;
    weights.create(image.size(), CV_8UC2);
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const uchar* row = image.ptr(y);
            const uchar* next = image.ptr(std::min(y + 1, image.rows - 1)); // the last row itself below it
            uchar* weight = weights.ptr(y);
            int x = 0;
#if CV_SIMD128
            for (; x + 16 < width; x += 16)
            {
                const uchar *p = row + x * channels, *right = p + channels, *below = next + x * channels;
                v_store_interleave(weight + 2 * x, differences(p, right, channels), differences(p, below, channels));
            }
#endif
            for (; x < width; ++x)
            {
                const uchar *p = row + x * channels, *right = x + 1 < width ? p + channels : p;
                weight[2 * x] = (uchar)difference(p, right, channels);
                weight[2 * x + 1] = (uchar)difference(p, next + x * channels, channels);
            }
        }
    });
}

void selectEdges(const Mat& weights, const Mat& pixelIntv, const Range& rows, std::vector<int>& edges)
{
    const int width = weights.cols, begin = std::max(rows.start - 1, 0);
    edges.resize((size_t)(rows.end - begin) * width * 2);
    size_t count = 0;
    for (int y = begin; y < rows.end; ++y)
    {
        const uchar* weight = weights.ptr(y);
        const DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
        const DisparityInterval* next = pixelIntv.ptr<DisparityInterval>(std::min(y + 1, weights.rows - 1));
        const bool hasRight = y >= rows.start, hasBelow = y + 1 < weights.rows;
        for (int x = 0; x < width; ++x) // without branches, which would often be mispredicted
        {
            const int edge = 2 * (y * width + x), right = std::min(x + 1, width - 1);
            edges[count] = edge;
            count += hasRight & (x < right) & isKept(weight[2 * x], interval[x], interval[right]);
            edges[count] = edge + 1;
            count += hasBelow & isKept(weight[2 * x + 1], interval[x], next[x]);
        }
    }
    edges.resize(count);
}

void sortByWeight(const Mat& weights, std::vector<int>& edges, std::vector<int>& sorted)
{
    const uchar* weight = weights.ptr();
    int places[257] = { 0 }; // the number of edges of each weight before, then the place of the next one
    for (int edge : edges)
        ++places[weight[edge] + 1];
    for (int w = 0; w < 256; ++w)
        places[w + 1] += places[w];
    sorted.resize(edges.size());
    for (int edge : edges)
        sorted[places[weight[edge]]++] = edge;
    edges.swap(sorted);
}

}}} // namespace cv::stereo::hdp
