// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PRIOR_HPP

#include "cost_volume.hpp"
#include "temporal_sources.hpp"

namespace cv {
namespace stereo {
namespace hdp {

/** P(D_t | D_(t-1)): raises the costs of disparities other than the one that the last frame predicts, see
CostVolume::prefer(). Where the image stands still and looks moved as well, with different disparities, it predicts
none. If nothing moves, the costs stay: joinLastFrame() keeps disparities then.
@param state What findSources() found; the first frame of a video has none.
@param side Of the volume's pixels, in pixels of the layer that the state is of.
@param volume The costs, changed. */
CV_EXPORTS void preferLastFrame(const TemporalState& state, int side, CostVolume& volume);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
