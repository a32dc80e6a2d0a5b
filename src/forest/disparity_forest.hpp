// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP
#define OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP

#include "forest_edges.hpp"

namespace cv { namespace stereo { namespace hdp {

//! One tree of the forest; the joined edges are in DisparityForest::links.
struct DisparityTree
{
    int root;                   // one of its pixels, y * width + x
    int size;                   // number of pixels
    DisparityInterval interval; // TreeIntv
};

//! The disparity prediction forest (HDPF) of a layer, section 3.2.
struct DisparityForest
{
    Mat weights;                      // CV_8UC2, of the edges, see weighEdges()
    Mat links;                        // CV_8UC1: the neighbours a pixel is joined to, bits of TreeLink
    std::vector<DisparityTree> trees; // by root
};

//! Memory to build a forest in: a union-find structure over the pixels
struct ForestBuffers
{
    struct Node
    {
        int parent;                 // another pixel of the tree; of a root: minus the tree's number of pixels
        DisparityInterval interval; // of a root: TreeIntv
    };
    struct Stripe // of the image, whose trees a thread joins
    {
        std::vector<int> edges;          // in the order in which they are tried
        std::vector<int> undecidedEdges; // those that wait until all stripes are done
        std::vector<int> frozenRoots;    // of the trees that must not grow until then
    };
    std::vector<Node> nodes;       // by pixel
    std::vector<uchar> maxWeights; // by root: TreeState::maxWeight
    std::vector<Stripe> stripes;   // the last one in use is for all of them together
};

/** Builds the forest of a layer by Kruskal's algorithm: tries one edge after the other in the order of Rule 1, and
joins the trees at its ends if Rule 2 and DT-Rule 2 allow it. Edges by ascending weight are tried in stripes of the
image side by side; the trees and their roots are those of trying one edge after the other, for any number of stripes.
@param image CV_8UC1, CV_8UC3 or CV_16UC1, the image that gives the edge weights, see weighEdges().
@param pixelIntv CV_16UC2 of its size.
@param beta Threshold of DT-Rule 2.
@param link Whether to join what Rule 2 left apart, by a second pass without it, if the strategy does so. */
CV_EXPORTS void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta,
                            bool link, ForestBuffers& buffers, DisparityForest& forest);

//! The pixels of a tree in the order of a walk from its root, depth first: parents come before their children.
struct TreeWalk
{
    std::vector<int> pixels;    // y * width + x
    std::vector<int> parents;   // position of the parent in the walk; 0 for the root
    std::vector<uchar> weights; // of the edge to the parent; 0 for the root

    struct Step
    {
        int pixel;
        int parent;     // its position in the walk
        int parentLink; // the side on which the parent is, a bit of TreeLink; 0 for the root
    };
    std::vector<Step> pending; // a stack of the pixels to be visited
};

//! Walks a tree of the forest. The vectors of the walk only ever grow; entries from tree.size on mean nothing.
CV_EXPORTS void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk);

//! The number of each pixel's tree, CV_32SC1, and its interval, CV_16UC2
void drawForest(const DisparityForest& forest, Mat& trees, Mat& intervals);

//! One of the library's strategies with default parameters, or an empty pointer if none has this name
Ptr<TreeStrategy> createTreeStrategy(const String& name);

//! R_l of the paper's Table 1: mean over the pixels of |TreeIntv| / numDisparities.
CV_EXPORTS double searchRatio(const DisparityForest& forest, int numDisparities);

}}} // namespace cv::stereo::hdp

#endif
