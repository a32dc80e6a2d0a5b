// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP
#define OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP

#include "disparity_units.hpp"
#include "opencv2/hdpstereo/tree_strategy.hpp"

namespace cv {
namespace stereo {
namespace hdp {

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
    enum Link
    {
        RIGHT = 1,
        BELOW = 2,
        LEFT = 4,
        ABOVE = 8
    };

    Mat weights;                      // CV_8UC2: weights of the edges to the right and below, 0 at the image's border
    Mat links;                        // CV_8UC1: the neighbours a pixel is joined to, bits of Link
    std::vector<DisparityTree> trees; // by root
};

struct ForestBuffers
{
    struct Node // of the union-find forest
    {
        int parent;                 // of a root: minus the tree's size
        DisparityInterval interval; // TreeIntv of a root
    };
    struct SortedEdges
    {
        std::vector<int> edges; // by weight, those of the same weight by number
        int ends[256];          // where those of each weight end
    };
    struct Stripe // Rows whose trees are grown apart from the others
    {
        std::vector<int> selected; // edges by number
        SortedEdges sorted, undecided;
        std::vector<int> frozen;                // roots
        std::vector<uint64> restored, rejected; // edges by weight and number; the first are a heap
        std::vector<int> everRestored;          // by number
    };
    std::vector<Node> nodes;
    std::vector<uchar> maxWeights; // of roots
    std::vector<Stripe> stripes;   // and at last all of the image
    std::vector<int> edges;        // in the order of other strategies
};

/** Builds the forest of a layer.
@param image CV_8UC1 or CV_8UC3, the image that gives the edge weights.
@param pixelIntv CV_16UC2 of its size.
@param strategy Rule 1 and Rule 2.
@param beta Threshold of DT-Rule 2.
@param link Whether to join what Rule 2 left apart, by a second pass without it.
@param buffers Memory to work in.
@param forest The result. */
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
        int pixel, parent;
        int from; // the link to the parent
    };
    std::vector<Step> pending;
};

//! Walks a tree of the forest. The vectors of the walk only ever grow; entries from tree.size on mean nothing.
CV_EXPORTS void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk);

//! R_l of the paper's Table 1: mean over the pixels of |TreeIntv| / numDisparities.
CV_EXPORTS double searchRatio(const DisparityForest& forest, int numDisparities);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
