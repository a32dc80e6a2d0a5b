// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TWO_LAYER_COST_HPP
#define OPENCV_HDPSTEREO_TWO_LAYER_COST_HPP

#include "census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

/** The matching cost of a layer's pixels at the disparities of the layer below, which has the texture that means of
2 x 2 pixels take away, and twice as many disparities. With C of the layer, C' of the one below, and the four pixels q
that pixel p is the mean of, candidate h, a disparity of h / 2 pixels, costs

cost(p, h) = (C(p, floor(h / 2)) + C(p, ceil(h / 2))) / 8 + 3 / 16 * sum over q of C'(q, h).

Without a layer below, candidates are those of the layer, and cost(p, d) = C(p, d). */
class CV_EXPORTS TwoLayerCost
{
public:
    enum
    {
        scale = 8 // of the costs, for their fractions
    };
    /** Takes the costs of a layer, and of the one below, twice as large, or null. They have to stay where they are. */
    void prepare(const CensusCost& own, const CensusCost* below);

    //! Candidates per pixel of disparity
    int steps() const { return below_ ? 2 : 1; }
    //! CensusCost::evaluate(), times scale and rounded up. With a layer below, first is even.
    void evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const;

private:
    const CensusCost *own_ = nullptr, *below_ = nullptr;
};

}}} // namespace cv::stereo::hdp

#endif
