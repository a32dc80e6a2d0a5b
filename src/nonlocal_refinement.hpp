// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_NONLOCAL_REFINEMENT_HPP
#define OPENCV_HDPSTEREO_NONLOCAL_REFINEMENT_HPP

#include "forest_aggregation.hpp"

namespace cv {
namespace stereo {
namespace hdp {

/** The tree-based refinement of MST and ST (Yang 2012, "A Non-Local Cost Aggregation Method for Stereo Matching"): the
cost of candidate x is |x - d(p)| at a stable pixel p of disparity d(p), and 0 at others. Its sum over a tree is convex
in x, with the minimum at the median of the tree's stable disparities, weighted by their similarity to the pixel: so
only candidates between the smallest and the largest of them can win. */
class CV_EXPORTS NonLocalRefinement
{
public:
    //! disparity: CV_16UC1, times scale, 1 or an even number; stable: CV_8UC1, not 0 where it is. Both must outlive the
    //! object.
    NonLocalRefinement(const Mat& disparity, int scale, const Mat& stable)
        : disparity_(disparity.ptr<ushort>()), stable_(stable.ptr()), scale_(scale)
    {
    }

    //! Those between the smallest and the largest stable disparity, and one more on both sides; none without a stable
    //! pixel.
    Range candidates(const TreeWalk& walk, const DisparityTree& tree) const;

    //! The cost of pixel i and candidate first + k at [i * lanes + k], k < lanes.
    void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const;

    /** The refined disparity of a pixel, times scale. If its own one is stable and the winner, rounded, it stays as it
    is. Elsewhere the fraction is that of the tip of a V through the costs of the winner and of the candidates beside it,
    which is exact where all stable disparities that matter are equal. */
    int disparity(int pixel, const RunWinner& winner) const;

private:
    const ushort* disparity_;
    const uchar* stable_;
    int scale_;
};

/** Replaces each disparity by the weighted median of the stable ones in its tree, see NonLocalRefinement.
@param forest The forest.
@param disparity CV_16UC1, times scale.
@param scale Units of a pixel, 1 or an even number.
@param stable CV_8UC1, not 0 where the disparity is stable.
@param gamma Of the similarity.
@param buffers Memory to work in.
@param refined Receives CV_16UC1 of its size, times scale; another Mat than disparity. The pixels of a tree without
stable ones keep their disparity, as does a pixel to which none of them has a similarity > 0 in float. */
CV_EXPORTS void refineNonLocal(const DisparityForest& forest, const Mat& disparity, int scale, const Mat& stable,
                               double gamma, AggregationBuffers& buffers, Mat& refined);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
