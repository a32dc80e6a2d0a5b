// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_WALK_HPP
#define OPENCV_HDPSTEREO_TREE_WALK_HPP

#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

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

}}} // namespace cv::stereo::hdp

#endif
