// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_JOINER_HPP
#define OPENCV_HDPSTEREO_TREE_JOINER_HPP

#include "../base/units.hpp"
#include "tree_strategy.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Trees under construction: a union-find structure over the pixels
struct GrowingTrees
{
    struct Node
    {
        int parent;                 // another pixel of the tree; of a root: minus the tree's number of pixels
        DisparityInterval interval; // of a root: TreeIntv
    };
    std::vector<Node> nodes;       // by pixel
    std::vector<uchar> maxWeights; // by root: TreeState::maxWeight
};

//! Memory of a thread of joinTrees() for the stripe that it works on
struct JoinerStripe
{
    std::vector<int> edges;          // in the order in which they are tried
    std::vector<int> sorted;         // to sort them
    std::vector<int> undecidedEdges; // those that wait until all stripes are done
    std::vector<int> frozenRoots;    // of the trees that must not grow until then
};

//! How trees are joined
struct JoinerParams
{
    double beta; // threshold of DT-Rule 2
    bool link;   // whether to join what Rule 2 left apart, by a second pass without it
};

/** Kruskal's algorithm: tries one edge after the other in the order of Rule 1, and joins the trees at its ends if Rule
2 and DT-Rule 2 allow it. Edges by ascending weight are tried in stripes of the image side by side; the trees and their
roots are those of trying one edge after the other, for any number of stripes.
@param strategy Rule 1 and Rule 2.
@param weights From weighEdges().
@param pixelIntv CV_16UC2 of the same size.
@param params The rest.
@param trees Receives the trees.
@param stripes Memory to work in.
@param links CV_8UC1 zeros of the same size; receives the bits of TreeLink. */
void joinTrees(const TreeStrategy& strategy, const Mat& weights, const Mat& pixelIntv, const JoinerParams& params,
               GrowingTrees& trees, std::vector<JoinerStripe>& stripes, Mat& links);

}}} // namespace cv::stereo::hdp

#endif
