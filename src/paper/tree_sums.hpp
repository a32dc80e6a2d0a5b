// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_SUMS_HPP
#define OPENCV_HDPSTEREO_TREE_SUMS_HPP

#include "../base/parallel_for.hpp"
#include "../cost/matching_cost.hpp"
#include "../forest/disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The winner of some successive candidates, and the costs that its fraction needs, or may need when it is compared
//! with that of the candidates after
struct RunWinner
{
    float lowest;        // its cost
    float before, after; // costs of the candidates beside it, negative where there are none
    float first, last;   // costs of the first and the last candidate
    int candidate;
};

//! Memory of one thread for the trees it works on, by position in the walk
struct SumScratch
{
    TreeWalk walk;
    std::vector<float> costs;                    // of some candidates
    std::vector<std::vector<RunWinner>> winners; // of groups of candidates
};

typedef ScratchPool<SumScratch> SumBuffers;

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
                            SumBuffers& buffers, Mat& disparity);

/** Winner-takes-all over C(p, x), x in TreeIntv of the pixel's tree; the lowest disparity wins a tie.
@param subpixel Whether to add the minimum of the parabola through the winner's cost and its neighbours' in TreeIntv;
otherwise all disparities are whole.
@param disparity Receives CV_16UC1 of the layer's size, a disparity map; 0 where TreeIntv is empty. */
CV_EXPORTS void aggregateForest(const DisparityForest& forest, const MatchingCost& cost, double gamma, bool subpixel,
                                SumBuffers& buffers, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
