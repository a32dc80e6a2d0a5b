// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TWO_LAYER_COST_HPP
#define OPENCV_HDPSTEREO_TWO_LAYER_COST_HPP

#include "census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

/** The census cost of a layer and of the layer below, whose census still has the texture that means of 2 x 2 pixels
take away. With C of the layer, C' of the one below, and the four pixels q that pixel p is the mean of,

cost(p, d) = C(p, d) / 2 + (sum over q of C'(q, 2 d)) / 8,

or C(p, d) without a layer below. */
class CV_EXPORTS TwoLayerCost
{
public:
    enum
    {
        scale = 8 // of the costs, for their fractions
    };
    /** Takes the cost of a layer, which has to stay where it is.
    @param own The layer's.
    @param below That of the layer below, twice as large; null for the layer's alone. It is not needed after this.
    @param numDisparities The number of candidates a pixel may be asked for. */
    void prepare(const CensusCost& own, const CensusCost* below, int numDisparities);

    //! CensusCost::evaluate(), times scale
    void evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const;

private:
    const CensusCost* own_ = nullptr;
    bool seesBelow_ = false;
    // Every second pixel of every second row of the layer below, from each of the four on: pairs of the layer's size
    CensusPlanes below_[4];
    Mat left_, right_; // their census, one after the other, as CensusCost has it; without grey levels of the right one
};

}}} // namespace cv::stereo::hdp

#endif
