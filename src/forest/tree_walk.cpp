// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_walk.hpp"

namespace cv { namespace stereo { namespace hdp {

void walkTree(const DisparityForest& forest, const DisparityTree& tree, TreeWalk& walk)
{
    const int width = forest.links.cols;
    const uchar* links = forest.links.ptr();
    const uchar* weights = forest.weights.ptr();
    // By the side on which the parent of pixel p is: the number of the edge to it, less 2 * p
    const int edgeOffsets[] = { 0, 0, 1, 0, -2, 0, 0, 0, 1 - 2 * width };

    int* const pixels = grown(walk.pixels, tree.size);
    int* const parents = grown(walk.parents, tree.size);
    uchar* const edges = grown(walk.weights, tree.size);
    size_t capacity = 64;
    TreeWalk::Step* pending = grown(walk.pending, capacity);
    pending[0] = { tree.root, 0, 0 };
    size_t count = 1;
    for (int i = 0; count > 0; ++i)
    {
        // One by one: what was written in parts a moment ago is slow to read at once.
        const TreeWalk::Step& step = pending[--count];
        const int p = step.pixel, parent = step.parent, parentLink = step.parentLink;
        pixels[i] = p;
        parents[i] = parent;
        edges[i] = weights[2 * p + edgeOffsets[parentLink]];

        // All four neighbours are written and only children are counted: branches would often be mispredicted.
        if (count + 4 > capacity)
            pending = grown(walk.pending, capacity *= 2);
        const int children = links[p] & ~parentLink;
        pending[count] = { p - width, i, TreeLink::BELOW };
        count += (children / TreeLink::ABOVE) & 1;
        pending[count] = { p - 1, i, TreeLink::RIGHT };
        count += (children / TreeLink::LEFT) & 1;
        pending[count] = { p + width, i, TreeLink::ABOVE };
        count += (children / TreeLink::BELOW) & 1;
        pending[count] = { p + 1, i, TreeLink::LEFT };
        count += (children / TreeLink::RIGHT) & 1;
    }
    walk.weights[0] = 0;
}

void drawForest(const DisparityForest& forest, Mat& trees, Mat& intervals)
{
    trees.create(forest.links.size(), CV_32S);
    intervals.create(forest.links.size(), CV_16UC2);
    TreeWalk walk;
    for (size_t t = 0; t < forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        walkTree(forest, tree, walk);
        for (int i = 0; i < tree.size; ++i)
        {
            trees.ptr<int>()[walk.pixels[i]] = (int)t;
            intervals.ptr<DisparityInterval>()[walk.pixels[i]] = tree.interval;
        }
    }
}

}}} // namespace cv::stereo::hdp
