// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FOREST_EDGES_HPP
#define OPENCV_HDPSTEREO_FOREST_EDGES_HPP

#include "../base/disparity_units.hpp"

namespace cv { namespace stereo { namespace hdp {

// The edges of a layer's graph, their weights and order, and those that DT-Rule 1 keeps (section 3.2). An edge is a
// number: edge 2 * p joins pixel p = y * width + x to its right neighbour, edge 2 * p + 1 to the neighbour below.

//! The end of an edge on the left or above
inline int firstPixel(int edge) { return edge >> 1; }

//! The end of an edge on the right or below
inline int secondPixel(int edge, int width) { return (edge & 1) ? firstPixel(edge) + width : firstPixel(edge) + 1; }

//! Bits of the neighbours that a pixel is joined to
struct TreeLink
{
    enum
    {
        RIGHT = 1,
        BELOW = 2,
        LEFT = 4,
        ABOVE = 8
    };
};

//! w(p, q) of all edges: the largest absolute difference over the colour channels, as in the authors' program; the
//! paper has the difference of intensities. weights: CV_8UC2, weights.ptr()[e] is that of edge e; 0 at the border.
void weighEdges(const Mat& image, Mat& weights);

//! Whether two intervals have a disparity in common.
inline bool intersect(const DisparityInterval& a, const DisparityInterval& b)
{
    return std::max(a.first, b.first) <= std::min(a.last, b.last);
}

//! Whether the four pixels of a square search the same disparities. interval, below: of its two pixels on the left.
inline bool isUniform(const DisparityInterval* interval, const DisparityInterval* below)
{
    // Without branches, so that a loop over squares is vectorised
    const int first = interval[0].first, last = interval[0].last;
    const int differences = (first ^ interval[1].first) | (first ^ below[0].first) | (first ^ below[1].first) |
                            (last ^ interval[1].last) | (last ^ below[0].last) | (last ^ below[1].last);
    return differences == 0 && first <= last;
}

//! The edges of a row of pixels that DT-Rule 1 keeps.
class EdgeRow
{
public:
    static const ushort none = 256; // more than any weight

    // By x = -1 .. width:
    ushort *right, *below; // the weight of the edge, or none if there is no such edge or it is not kept
    ushort* uniform;       // 1 if the square to the right and below is there and isUniform(), else 0

    explicit EdgeRow(int width);

    //! Loads row y. A row outside of the image has no edges.
    void load(const Mat& weights, const Mat& pixelIntv, int y);

private:
    int width_;
    std::vector<ushort> buffer_;
};

//! The edges of the image, by number, that DT-Rule 1 keeps.
void selectEdges(const Mat& weights, const Mat& pixelIntv, std::vector<int>& edges);

//! Edges by ascending weight, those of one weight by number
struct SortedEdges
{
    std::vector<int> edges;
    int ends[256]; // by weight: the position after its last edge

    int begin(int weight) const { return weight > 0 ? ends[weight - 1] : 0; }
};

//! Sorts edges by weight; those of one weight stay in the order given.
void sortByWeight(const Mat& weights, const std::vector<int>& edges, SortedEdges& sorted);

//! A number by which edges are in the order of SortedEdges
inline uint64 orderOf(int edge, int weight) { return ((uint64)weight << 32) | (unsigned)edge; }

inline int edgeOf(uint64 order) { return (int)(order & 0xffffffffu); }

}}} // namespace cv::stereo::hdp

#endif
