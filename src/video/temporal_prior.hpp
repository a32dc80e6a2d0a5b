// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP

#include "../forest/cost_volume.hpp"
#include "temporal_prediction.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Whether the last frame predicts disparities: not before a second pair can have agreed with the first one, nor if
//! nothing moves, as joinLastFrame() keeps disparities then.
CV_EXPORTS bool predictsDisparities(const FrameMemory& last, const FramePrediction& prediction);

/** The disparities that the last frame predicts for the pixels of a volume: those that more than one pair has had, as a
single pair is wrong as often as this one. Where the image stands still and looks moved as well, with different
disparities, it predicts none.
@param side That of the volume's pixels, in pixels of the layer that the prediction is of.
@param size That of the volume.
@param predicted CV_32FC1, receives them, in pixels of the volume; negative where there is none. */
CV_EXPORTS void predictDisparities(const FrameMemory& last, const FramePrediction& prediction, int side,
                                   const Size& size, Mat& predicted);

//! Whether this frame's own costs, means over trees, refuse the last frame: at many of the pixels that it predicts a
//! disparity for, another one is much better. Their predicted disparities are taken away.
CV_EXPORTS bool refusesLastFrame(const CostVolume& volume, Mat& predicted);

//! P(D_t | D_(t-1)): raises the costs of disparities other than the predicted one, see preferDisparity().
CV_EXPORTS void preferPredicted(const Mat& predicted, CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
