// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FOREST_EDGES_HPP
#define OPENCV_HDPSTEREO_FOREST_EDGES_HPP

#include "../base/units.hpp"

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
    static const int RIGHT = 1, BELOW = 2, LEFT = 4, ABOVE = 8;
};

/** w(p, q) of all edges: the largest absolute difference over the colour channels, as in the authors' program; the
paper has the difference of intensities. Of grey levels it is 9 / 8 of their difference, rounded up: the largest of
three differences is a bit more, and hardly ever 0 where there is any.
@param image CV_8UC1 or CV_8UC3, or CV_16UC1, see greyLevels().
@param weights Receives CV_8UC2; weights.ptr()[e] is that of edge e; 0 at the border. */
void weighEdges(const Mat& image, Mat& weights);

//! S(p, q) of neighbours: exp(-w / gamma) for each weight w.
struct CV_EXPORTS EdgeSimilarity
{
    explicit EdgeSimilarity(double gamma);
    float table[256];
};

//! The edges of some rows that DT-Rule 1 keeps, by number; and those from the row above into them.
void selectEdges(const Mat& weights, const Mat& pixelIntv, const Range& rows, std::vector<int>& edges);

//! Sorts edges by ascending weight; those of one weight stay in the order given.
void sortByWeight(const Mat& weights, std::vector<int>& edges);

}}} // namespace cv::stereo::hdp

#endif
