// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

void buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, const JoinerParams& params,
                 ForestBuffers& buffers, DisparityForest& forest)
{
    forest.trees.clear(); // those of other links must not be walked if the strategy throws
    weighEdges(image, forest.weights);
    forest.links.create(image.size(), CV_8U);
    forest.links.setTo(Scalar::all(0));
    JoinerParams joined = params;
    joined.link &= strategy.linksTrees();
    joinTrees(strategy, forest.weights, pixelIntv, joined, buffers.trees, buffers.stripes, forest.links);
    const std::vector<GrowingTrees::Node>& nodes = buffers.trees.nodes;
    for (size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent < 0)
            forest.trees.push_back({ (int)i, -nodes[i].parent, nodes[i].interval });
}

double searchRatio(const DisparityForest& forest, int numDisparities)
{
    double searched = 0;
    for (const DisparityTree& tree : forest.trees)
        searched += (double)tree.size * tree.interval.size();
    return searched / ((double)forest.links.total() * numDisparities);
}

}}} // namespace cv::stereo::hdp
