// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP

#include "../forest/cost_volume.hpp"
#include "temporal_prediction.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Whether the last frame predicts disparities: not before a second pair has agreed with the first one, nor if nothing
//! moves, as joinLastFrame() keeps disparities then.
CV_EXPORTS bool hasPrior(const FrameMemory& last, const FramePrediction& prediction);

/** Whether this frame's own costs refuse the last frame: at many of the pixels that it predicts a disparity for,
another one is much better.
@param last The last frame.
@param prediction What predictFrame() found; the frame continues.
@param side That of the volume's pixels, in pixels of the layer that the prediction is of.
@param volume Means of costs over trees, as a single frame has them. */
CV_EXPORTS bool contradictsLastFrame(const FrameMemory& last, const FramePrediction& prediction, int side,
                                     const CostVolume& volume);

/** P(D_t | D_(t-1)): raises the costs of disparities other than the one that the last frame predicts, see
CostPreference. Where the image stands still and looks moved as well, with different disparities, it predicts
none.
@param last The last frame.
@param prediction What predictFrame() found; see hasPrior().
@param side That of the volume's pixels, in pixels of the layer that the prediction is of.
@param areMeans Whether the costs are means over trees; those that contradict then stay.
@param volume The costs, changed. */
CV_EXPORTS void preferLastFrame(const FrameMemory& last, const FramePrediction& prediction, int side, bool areMeans,
                                CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
