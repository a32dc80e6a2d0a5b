// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PARABOLA_HPP
#define OPENCV_HDPSTEREO_PARABOLA_HPP

#include <algorithm>

namespace cv { namespace stereo { namespace hdp {

//! Where a parabola through three successive values has its minimum: from the middle one, in steps, at most half of
//! one; 0 if it has none. Real: float or double, in which it is computed.
template <typename Real> Real parabolaOffset(Real before, Real middle, Real after)
{
    const Real curvature = (before - middle) + (after - middle), half = Real(0.5);
    return curvature > 0 ? std::max(-half, std::min(half, (before - after) / curvature / 2)) : 0;
}

}}} // namespace cv::stereo::hdp

#endif
