// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SCANLINE_STRIPES_HPP
#define OPENCV_HDPSTEREO_SCANLINE_STRIPES_HPP

#include "../base/image_frame.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Rows of an image that are aggregated by themselves, and those that the directions from above and from below are
//! followed over; both from an even one on
struct ScanlineStripe
{
    Range rows, reach;
};

/** The stripes of an image, or what a tile of it has of them: one, or an even number of them, so that also two threads
have as much to do.
@param height Rows of it that are there.
@param rows About as many in a stripe. */
CV_EXPORTS std::vector<ScanlineStripe> stripesOf(const ImageFrame& frame, int height, int rows);

}}} // namespace cv::stereo::hdp

#endif
