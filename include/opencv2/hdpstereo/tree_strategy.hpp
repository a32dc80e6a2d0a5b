// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_STRATEGY_HPP
#define OPENCV_HDPSTEREO_TREE_STRATEGY_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief A tree under construction, as Rule 2 sees it. */
struct TreeState
{
    int size;        //!< number of pixels of the layer, >= 1
    uchar maxWeight; //!< the largest weight of the edges inside the tree, in intensity levels; 0 for a single pixel
};

/** @brief Rule 1 and Rule 2 of the spanning trees of a layer (@cite Luo2015HDP , section 3.2).

The edges of the layer's graph are tried one after another (Rule 1 gives the order); an edge joins the two trees at its
ends if Rule 2 allows it. DT-Rule 1 and 2, which take disparity into account, belong to the matcher and apply to every
strategy where intervals are predicted, see HDPTreeMatcher::AGGREGATION_TREES.

Derive from this class for a custom strategy:

@code{.cpp}
    // Horizontal edges first, then the vertical ones, each by rows.
    class RowTree : public cv::stereo::TreeStrategy
    {
    public:
        void orderEdges(const cv::Mat&, std::vector<int>& edges) const
        {
            std::stable_partition(edges.begin(), edges.end(), [](int e) { return e % 2 == 0; });
        }
        bool mayJoin(int, const cv::stereo::TreeState&, const cv::stereo::TreeState&) const { return true; }
        cv::String getDefaultName() const { return "my.RowTree"; }
    };

    matcher->setTreeStrategy(cv::makePtr<RowTree>());
@endcode

Both rules must be pure functions of their arguments, or the results of the matcher are not reproducible. An exception
thrown by a rule leaves compute(); the matcher stays usable. In Python, the package hdpstereo has the same class.

cv::Algorithm::write() of a matcher stores the strategy's getDefaultName() and what its write() adds. Only the
strategies of this module can be created from a file, see HDPTreeMatcher. @ref tutorial_hdpstereo_own_tree has a
complete example.
 */
class CV_EXPORTS_W TreeStrategy : public Algorithm
{
public:
    /** @brief Rule 1: the order in which edges are tried.

    An edge is a number: edge 2 * i joins pixel i = y * width + x to its right neighbour, edge 2 * i + 1 to the
    neighbour below.
    @param weights The edges' weights: the largest absolute difference over the colour channels, 0..255; of grey
    images, for HDPTreeMatcher::COST_CENSUS, 9 / 8 of the difference of their levels, rounded up; of the levels that
    are matched, so after stretching and brightening, see HDPTreeMatcher. CV_8UC2 of the layer's size, continuous,
    so that weights.ptr()[e] is the weight of edge e. Those of the last column to its right and of the last row
    below belong to no edge.
    @param edges The edges that DT-Rule 1 left, by number; where no intervals are predicted, all edges. To be brought
    into the order in which they are tried. compute() throws cv::Exception if one is added, removed or repeated.

    The default is ascending weight, equal weights by number, see ordersByWeight().
     */
    virtual void orderEdges(const Mat& weights, std::vector<int>& edges) const;

    /** @brief Whether Rule 1 is to try edges by ascending weight, equal weights by number (false by default).

    If true, orderEdges() is not called: the matcher orders the edges itself, and joins trees in several parts of the
    image in parallel. The trees are the same as with orderEdges() in that order. mayJoin() is called from several
    threads at the same time then.
     */
    virtual bool ordersByWeight() const { return false; }

    /** @brief Rule 2: may this edge join these two trees?

    Called only for ends that are in different trees; from one thread, unless ordersByWeight().
    @param weight The edge's weight, 0..255.
    @param a, b The trees at the edge's two ends, before they are joined.
    @return Whether Rule 2 allows it. DT-Rule 2 may still forbid it.
     */
    virtual bool mayJoin(int weight, const TreeState& a, const TreeState& b) const = 0;

    /** @brief Whether a joined tree searches the hull of its parts' disparity intervals (true, the paper's
    DT-Rule 2; default), or keeps the interval of its larger part. */
    virtual bool unitesIntervals() const { return true; }

    /** @brief Whether, without prediction, the trees that Rule 2 left apart are joined into one spanning
    tree by a second pass over the edges in the same order (true, default), or stay apart. */
    virtual bool linksTrees() const { return true; }
};

/** @brief Minimum spanning tree @cite Yang2012MST : edges by ascending weight, every edge may join. */
CV_EXPORTS_W Ptr<TreeStrategy> createMinimumSpanningTree();

/** @brief Segment tree @cite Mei2013ST : edges by ascending weight; two trees a and b are joined by an edge
of weight w only if \f$w \le \min(w_{max}(a) + k/|a|,\; w_{max}(b) + k/|b|)\f$.

A joined tree keeps the disparity interval of its larger part. Without prediction the segments are linked
into one tree afterwards.
@param k In intensity levels times pixels, finite, >= 0. The larger, the larger the segments. 1200 is the value of the
authors' program.
@throws cv::Exception if k is out of range.
 */
CV_EXPORTS_W Ptr<TreeStrategy> createSegmentTree(double k = 1200);

/** @brief Random tree (section 4.1 of @cite Luo2015HDP ): edges in random order, every edge may join.
@param seed Seed of the shuffle, >= 0. The same seed gives the same tree on every machine.
@throws cv::Exception if seed is negative.
 */
CV_EXPORTS_W Ptr<TreeStrategy> createRandomTree(int seed = 0);

//! @}

} // namespace stereo
} // namespace cv

#endif
