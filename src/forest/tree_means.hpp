// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_MEANS_HPP
#define OPENCV_HDPSTEREO_TREE_MEANS_HPP

#include "cost_volume.hpp"
#include "disparity_forest.hpp"
#include "../base/parallel_for.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What the means over a tree need to know of a pixel: shares are in units of 1 / MeanNode::unit.
struct MeanNode
{
    short toParent, fromParent; // shares s(p) and t(p), see aggregateMeans()
    short hasChildren;          // -1, or 0 if there are none, or none with a share
    short hasSibling;           // -1, or 0 for the last child of its parent: there is no sum of others to be added to
    static const int unit = 1 << 15;
    static const int meanScale = 1 << 10; // of the means of bits
};

//! Memory of one thread for the trees it works on, by position in the walk
struct MeanScratch
{
    TreeWalk walk;
    std::vector<float> sums; // of similarities
    std::vector<MeanNode> nodes;
    std::vector<uchar> costs; // of some candidates, in units of the volume
    std::vector<short> means;
};

typedef ScratchPool<MeanScratch> MeanBuffers;

/** The weighted means of the cost M over each tree, sum over q of S(p, q) M(q, x) / sum over q of S(p, q). Unlike the
paper's sums they can be compared between pixels, also of different trees. They are computed in whole numbers of 16
bits, in units of 1 / MeanNode::meanScale of a bit.
With w(p) = 1 + sum over p's children c of S(p, c) w(c), and W(p) = S W(parent) + (1 -
S^2) w(p), S = S(p, parent), W = w at the root, which are sums of S over the pixels behind p and over the whole tree, in
floats, children from the last one of the walk on,
s(p) = floor(unit S(p, parent) w(p) / w(parent)), t(p) = floor(unit S(p, parent) W(parent) / W(p)), unit =
MeanNode::unit, both less than unit,
U(p) = M(p) + sum over p's children c of round(s(c) (U(c) - M(p)) / unit), from the leaves to the root, and
V(p) = U(p) + round(t(p) (V(parent) - U(p)) / unit), from the root to the leaves; V = U at the root.
Halves are rounded up. So means of equal costs are these costs, and all means are in the range of the costs, but for
some 1 / 1024 of a bit.
@param numDisparities Candidates of all trees, from 0 on.
@param volume Receives V times CostVolume::scale, rounded. */
CV_EXPORTS void aggregateMeans(const DisparityForest& forest, const TwoLayerCost& cost, int numDisparities,
                               double gamma, MeanBuffers& buffers, CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
