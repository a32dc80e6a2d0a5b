// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_REPEATED_SURFACES_HPP
#define OPENCV_HDPSTEREO_REPEATED_SURFACES_HPP

#include "cost_volume.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Regular patterns, as of a fence or a facade. Several candidates of a pixel fit, a period apart, and noise or the
surface behind would decide between them. Only where the pattern ends, fewer of them do: what is a period off has no
match for the last period. So the right surface is the largest one.

A run is what fits of a pixel's candidates without a clearly higher cost in between. Runs of neighbouring pixels that
differ by little are one surface, which goes on beyond small gaps. An area is the pixels that have several surfaces,
together with those that share one of these. A surface's size is the number of its pixels in the area, and beside it by
up to a period, that repeat in the left image a period to the left or to the right, with some contrast in between. In
each pixel of an area, all candidates but those of its largest surface get higher costs; the lowest one wins a tie.
@param own The census of the layer, for its grey levels.
@param volume The costs, which are raised.
@return Number of pixels in areas; small ones are noise, and change nothing, as does a volume of which a sample of
pixels says that too few repeat. */
CV_EXPORTS int preferLargestSurfaces(const CensusCost& own, CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
