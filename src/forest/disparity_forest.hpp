// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP
#define OPENCV_HDPSTEREO_DISPARITY_FOREST_HPP

#include "forest_edges.hpp"
#include "tree_joiner.hpp"

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

struct ForestBuffers
{
    GrowingTrees trees;
    std::vector<JoinerStripe> stripes;
};

/** Builds the forest of a layer.
@param image CV_8UC1 or CV_8UC3, the image that gives the edge weights.
@param pixelIntv CV_16UC2 of its size.
@param strategy Rule 1 and Rule 2.
@param params See joinTrees(); trees are linked if the strategy says so, too.
@param buffers Memory to work in.
@param forest The result. */
CV_EXPORTS void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy,
                            const JoinerParams& params, ForestBuffers& buffers, DisparityForest& forest);

//! R_l of the paper's Table 1: mean over the pixels of |TreeIntv| / numDisparities.
CV_EXPORTS double searchRatio(const DisparityForest& forest, int numDisparities);

}}} // namespace cv::stereo::hdp

#endif
