// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PAIR_INPUTS_HPP
#define OPENCV_HDPSTEREO_PAIR_INPUTS_HPP

#include "../map/prior_join.hpp"
#include "../pair/disparity_ranges.hpp"

namespace cv { namespace stereo { namespace hdp {

struct PairPlan;

//! What is known of the pairs beforehand. It is no parameter: files do not have it.
struct PairInputs
{
    Mat leftMask, rightMask;                       // CV_8UC1, 0 where there is no data; empty: there is everywhere
    Mat smallest, largest;                         // CV_32FC1, disparities of the pixels; empty: there are no ranges
    Mat prior, sigma;                              // CV_32FC1, disparities that are about known; empty: none are
    double highestSmallest = 0, lowestLargest = 0; // of the ranges
    int changes = 0;                               // of the ranges or of the prior

    bool hasRanges() const { return !smallest.empty(); }
    //! Whether a pixel may not have all of these disparities
    bool limit(const Range& disparities) const
    {
        return hasRanges() && (highestSmallest > disparities.start || lowestLargest < disparities.end - 1);
    }
    bool hasPrior() const { return !prior.empty(); }
};

//! The image in a caller's array; throws if there are several
Mat imageOf(InputArray array, const char* name);

// What a caller tells, copied; see the methods of HDPTreeMatcher. They throw if it is not that, and change nothing.
void setMasks(InputArray left, InputArray right, PairInputs& inputs);
CV_EXPORTS void setRange(InputArray smallest, InputArray largest, PairInputs& inputs);
void setPrior(InputArray disparity, InputArray sigma, PairInputs& inputs);

//! The disparities that pixels of images of this width may have, if all of them are limited; else empty.
CV_EXPORTS Range rangeOf(const PairInputs& inputs, int width);

//! Throws if an input is not for images of this size.
void checkInputs(const PairInputs& inputs, Size size);

//! The ranges and the prior of a caller in terms of the layers
struct KnownDisparities
{
    PixelRanges ranges;
    std::vector<Mat> intervals;                  // of the layers, if there are ranges
    std::vector<Mat> candidates;                 // the same in what a layer compares, see LayerPlan::seesBelow
    std::vector<Mat> hulls;                      // of those of 2 x 2 pixels, for windows
    std::vector<std::vector<PriorPoint>> points; // of the layers, if there is a prior
    std::vector<Mat> units;                      // memory of buildIntervals(), kept from pair to pair
    std::vector<int> key;                        // what takeKnown() has made it from
};

//! Nothing is done again for pairs that differ in nothing but their images.
void takeKnown(const PairInputs& inputs, const PairPlan& plan, KnownDisparities& known);

}}} // namespace cv::stereo::hdp

#endif
