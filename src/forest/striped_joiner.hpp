// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_STRIPED_JOINER_HPP
#define OPENCV_HDPSTEREO_STRIPED_JOINER_HPP

#include "tree_joiner.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Memory of a stripe of rows. A uint64 is an edge by its orderOf().
struct JoinerStripe
{
    std::vector<int> selected;     // edges to be tried when their turn comes, by number
    SortedEdges sorted;            // the same
    SortedEdges undecided;         // edges that wait until all stripes are done
    std::vector<int> frozen;       // roots of frozen trees
    std::vector<uint64> rejected;  // in order
    std::vector<uint64> restored;  // a heap of edges that were left out, but have to be tried
    std::vector<int> everRestored; // all edges that were in it
};

/** Kruskal's algorithm with edges by ascending weight, those of one weight by number, in stripes of the image side by
side. The trees and their roots are those of trying one edge after the other, for any number of stripes.
@param strategy Rule 2; its Rule 1 is not asked.
@param weights From weighEdges().
@param pixelIntv CV_16UC2 of the same size.
@param beta Threshold of DT-Rule 2.
@param link Whether to join what Rule 2 left apart, by a second pass without it.
@param trees Receives the trees; trees.nodes has the size of the image.
@param stripes Memory to work in.
@param links CV_8UC1 zeros of the same size; receives the bits of TreeLink. */
void joinByWeight(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, double beta, bool link,
                  GrowingTrees& trees, std::vector<JoinerStripe>& stripes, Mat& links);

}}} // namespace cv::stereo::hdp

#endif
