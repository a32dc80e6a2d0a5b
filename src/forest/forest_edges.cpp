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

//! DT-Rule 1: the weight of an edge that is kept, or EdgeRow::none.
ushort weightIfKept(int weight, const DisparityInterval& a, const DisparityInterval& b)
{
    const bool isKept = (weight <= largestSparedWeight) | intersect(a, b); // without a branch
    return isKept ? (ushort)weight : (ushort)EdgeRow::none;
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

EdgeRow::EdgeRow(int width) : width_(width), buffer_(3 * (width + 2))
{
    right = &buffer_[1];
    below = right + width + 2;
    uniform = below + width + 2;
}

void EdgeRow::load(const Mat& weights, const Mat& pixelIntv, int y)
{
    const int width = width_, padded = width + 2;
    std::fill(buffer_.begin(), buffer_.begin() + 2 * padded, none + 0);
    std::fill(buffer_.begin() + 2 * padded, buffer_.end(), (ushort)0);
    if (y < 0 || y >= weights.rows)
        return;
    const uchar* weight = weights.ptr(y);
    const DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
    for (int x = 0; x + 1 < width; ++x)
        right[x] = weightIfKept(weight[2 * x], interval[x], interval[x + 1]);
    if (y + 1 == weights.rows)
        return;
    const DisparityInterval* next = pixelIntv.ptr<DisparityInterval>(y + 1);
    for (int x = 0; x < width; ++x)
        below[x] = weightIfKept(weight[2 * x + 1], interval[x], next[x]);
    for (int x = 0; x + 1 < width; ++x)
        uniform[x] = isUniform(interval + x, next + x);
}

void selectEdges(const Mat& weights, const Mat& pixelIntv, std::vector<int>& edges)
{
    const int width = weights.cols;
    EdgeRow row(width);
    edges.clear();
    for (int y = 0; y < weights.rows; ++y)
    {
        row.load(weights, pixelIntv, y);
        for (int x = 0; x < width; ++x)
        {
            const int edge = 2 * (y * width + x);
            if (row.right[x] != EdgeRow::none)
                edges.push_back(edge);
            if (row.below[x] != EdgeRow::none)
                edges.push_back(edge + 1);
        }
    }
}

void sortByWeight(const Mat& weights, const std::vector<int>& edges, SortedEdges& sorted)
{
    const uchar* weight = weights.ptr();
    int places[256] = { 0 }, sum = 0; // the number of edges of each weight, then the place of the next one
    for (int edge : edges)
        ++places[weight[edge]];
    for (int w = 0; w < 256; ++w)
    {
        const int count = places[w];
        places[w] = sum;
        sum += count;
        sorted.ends[w] = sum;
    }
    sorted.edges.resize(sum);
    for (int edge : edges)
        sorted.edges[places[weight[edge]]++] = edge;
}

}}} // namespace cv::stereo::hdp
