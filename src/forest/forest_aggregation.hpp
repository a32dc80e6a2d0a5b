// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FOREST_AGGREGATION_HPP
#define OPENCV_HDPSTEREO_FOREST_AGGREGATION_HPP

#include "cost_volume.hpp"
#include "../base/parallel_for.hpp"

namespace cv { namespace stereo { namespace hdp {

//! S(p, q) of neighbours: exp(-w / gamma) for each weight w.
struct CV_EXPORTS EdgeSimilarity
{
    explicit EdgeSimilarity(double gamma);
    float table[256];
};

//! The winner of some successive candidates, and the costs that its fraction needs, or may need when it is compared
//! with that of the candidates after
struct RunWinner
{
    float lowest;        // its cost
    float before, after; // costs of the candidates beside it, negative where there are none
    float first, last;   // costs of the first and the last candidate
    int candidate;
};

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
struct AggregationScratch
{
    TreeWalk walk;
    std::vector<float> costs;                    // of some candidates
    std::vector<std::vector<RunWinner>> winners; // of groups of candidates
    std::vector<float> sums;                     // of similarities
    std::vector<MeanNode> nodes;
    std::vector<uchar> meanCosts; // of some candidates, in units of the volume
    std::vector<short> means;
};

typedef ScratchPool<AggregationScratch> AggregationBuffers;

//! What winners are taken of: the candidates of each tree, their costs, and the disparity that a winner stands for
class AggregationProblem
{
public:
    virtual ~AggregationProblem() {}

    virtual Range candidates(const TreeWalk& walk, const DisparityTree& tree) const = 0;

    //! The cost of pixel i and candidate first + k at [i * lanes + k], k < lanes; pixels: y * width + x each.
    virtual void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const = 0;

    //! From the winners of some pixels to disparity[pixels[i]]
    virtual void setDisparities(const int* pixels, const RunWinner* winners, int count, ushort* disparity) const = 0;
};

/** Winner-takes-all over an aggregated cost, C(p, x) = sum over q in the tree of S(p, q) M(q, x) (section 3.3), in two
passes; the lowest candidate wins a tie.
@param disparity CV_16UC1 of the layer's size; pixels of trees without candidates keep what they have. */
CV_EXPORTS void takeWinners(const DisparityForest& forest, const AggregationProblem& problem, double gamma,
                            AggregationBuffers& buffers, Mat& disparity);

/** Winner-takes-all over C(p, x), x in TreeIntv of the pixel's tree; the lowest disparity wins a tie.
@param subpixel Whether to add the minimum of the parabola through the winner's cost and its neighbours' in TreeIntv;
otherwise all disparities are whole.
@param disparity Receives CV_16UC1 of the layer's size, a disparity map; 0 where TreeIntv is empty. */
CV_EXPORTS void aggregateForest(const DisparityForest& forest, const MatchingCost& cost, double gamma, bool subpixel,
                                AggregationBuffers& buffers, Mat& disparity);

/** The weighted means of M over each tree, C(p, x) / sum over q in the tree of S(p, q). Unlike C they can be compared
between pixels, of other trees as well. They are computed in whole numbers of 16 bits, in units of 1 /
MeanNode::meanScale of a bit. With w(p) = 1 + sum over p's children c of S(p, c) w(c), and W(p) = S W(parent) + (1 -
S^2) w(p), S = S(p, parent), W = w at the root, which are sums of S over the pixels behind p and over the whole tree, in
floats, children from the last one of the walk on,
s(p) = floor(unit S(p, parent) w(p) / w(parent)), t(p) = floor(unit S(p, parent) W(parent) / W(p)), unit =
MeanNode::unit, both less than unit,
U(p) = M(p) + sum over p's children c of round(s(c) (U(c) - M(p)) / unit), from the leaves to the root, and
V(p) = U(p) + round(t(p) (V(parent) - U(p)) / unit), from the root to the leaves; V = U at the root.
Halves are rounded up. So means of equal costs are these costs, and all means are in the range of the costs, but for
some 1 / 1024 of a bit.
@param volume Receives V times CostVolume::scale, rounded. */
CV_EXPORTS void aggregateMeans(const DisparityForest& forest, const TwoLayerCost& cost, double gamma,
                               AggregationBuffers& buffers, CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
