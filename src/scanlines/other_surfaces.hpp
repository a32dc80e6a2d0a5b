// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_OTHER_SURFACES_HPP
#define OPENCV_HDPSTEREO_OTHER_SURFACES_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Memory of findOtherSurfaces()
struct SurfaceBuffers
{
    Mat min[2], max[2]; // disparities around each pixel, filtered or not
};

//! A row of disparities of the layer above, and the minimum and maximum around each
struct DisparityRow
{
    const ushort *own, *min, *max;
};

/** Finds the surface that a pixel of the layer above may belong to beside its own, at least otherSurfaceDistance away
from it: the first one there is of
- the pixel's own disparity before the median,
- the farthest one of the disparities in 7 x 7 pixels,
- the farthest one of those before the median.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param unfiltered The same before the median, which removes thin structures.
@param buffers Memory to work in.
@param others Receives CV_16UC1 of the size of the layer above, in 1 / subpixelScale pixel of the layer: the other
surface, or the pixel's own disparity if there is none. */
CV_EXPORTS void findOtherSurfaces(const Mat& upper, const Mat& unfiltered, SurfaceBuffers& buffers, Mat& others);

//! Pixels of the layer between disparities of different surfaces: what is nearer is in one window of candidates
const int otherSurfaceDistance = 5;

}}} // namespace cv::stereo::hdp

#endif
