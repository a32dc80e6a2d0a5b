// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SMOOTHNESS_WEIGHTS_HPP
#define OPENCV_HDPSTEREO_SMOOTHNESS_WEIGHTS_HPP

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What penalties are multiplied by, in 1 / one
struct SmoothnessWeight
{
    static const int one = 64;
    static const int min = one * 2 / 5; // beyond these few pixels say too much
    static const int max = one * 9 / 5;
};

//! How smoothness is weighed: the radius of the windows, 1 pixel of the layer above or more, and limits of the weights
struct SmoothnessPlan
{
    int radius, least, most;
};

/** Weighs smoothness against matching costs, by what the layer above has of both around each of its pixels
@cite Zhang2007Parameters :

weight = -ln(q + least) / (typical * evidence(r)), evidence(r) = (1/2 - r) ln((1 - r) / r).

q is the share of neighbours whose disparities are more than a pixel apart; minus its logarithm is what a step between
two surfaces costs. r is the share of a cost's bits that differ although the disparity is right; evidence(r) is the mean
of what a bit says for it, against a wrong one, with which half of the bits differ. Where bits say little, or surfaces
are large, penalties count more; where bits agree, or surfaces are many, they count less.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param residual The costs of its winners, CV_8UC1; UCHAR_MAX: a pixel without data.
@param bits That a cost is the number of.
@param plan The windows, and limits from SmoothnessWeight::min to SmoothnessWeight::max.
@param weights Receives CV_8UC1, a SmoothnessWeight per pixel of the layer above. */
CV_EXPORTS void weighSmoothness(const Mat& upper, const Mat& residual, int bits, const SmoothnessPlan& plan,
                                Mat& weights);

}}} // namespace cv::stereo::hdp

#endif
