// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_KNOWN_DISPARITIES_HPP
#define OPENCV_HDPSTEREO_KNOWN_DISPARITIES_HPP

#include "pair_inputs.hpp"
#include "pair_plan.hpp"
#include "../map/prior_join.hpp"
#include "../pair/disparity_ranges.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is known of disparities beforehand, in terms of the layers
struct KnownDisparities
{
    PixelRanges ranges;
    std::vector<Mat> intervals;                  // of the layers, if there are ranges
    std::vector<std::vector<PriorPoint>> points; // of the layers
    std::vector<Mat> units;                      // memory of buildIntervals(), kept from pair to pair
};

//! From the ranges and the prior of a caller to those of the layers
void takeKnown(const PairInputs& inputs, const PairPlan& plan, KnownDisparities& known);

}}} // namespace cv::stereo::hdp

#endif
