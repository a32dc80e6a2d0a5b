// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SRC_DISPARITY_PREDICTION_HPP
#define OPENCV_HDPSTEREO_SRC_DISPARITY_PREDICTION_HPP

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

/** PixelIntv of every disparity of layer l + 1 (section 3.1).
@param model The model; its mixture of this layer is used.
@param layer l.
@param prior P(D_l) up to a factor, for D_l = 0 .. d_l.
@param upperDisparities d_{l+1} + 1.
@param delta delta_l.
@param margin Candidates added on both sides of each interval that is not empty.
@param intervals intervals[i] receives PixelIntv given D_{l+1} = i: the mode of row i of P(D_l | D_{l+1}) and its
neighbours, in turns to the left and to the right while their share of the probability exceeds delta; empty if the
whole row is 0, as in the authors' program. */
CV_EXPORTS void predictIntervals(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior,
                                 int upperDisparities, double delta, int margin,
                                 std::vector<DisparityInterval>& intervals);

//! P(D_l) up to a factor, of what the layer above found: how many of its pixels have disparity floor(D_l / 2), and the
//! mean of these numbers besides, as no disparity is impossible. upper: CV_16UC1, a disparity map.
CV_EXPORTS void upperHistogram(const Mat& upper, int numDisparities, std::vector<double>& histogram);

//! PixelIntv of every pixel of a layer: intervals[D_{l+1}] of the pixel above it, or the nearest one of an odd last row
//! or column, which is wrong in the authors' program. upper: CV_16UC1, a disparity map; pixelIntv: CV_16UC2.
CV_EXPORTS void assignIntervals(const Mat& upper, Size size, const std::vector<DisparityInterval>& intervals,
                                Mat& pixelIntv);

}}} // namespace cv::stereo::hdp

#endif
