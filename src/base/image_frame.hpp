// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_IMAGE_FRAME_HPP
#define OPENCV_HDPSTEREO_IMAGE_FRAME_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Where an image lies in a larger one that it is a tile of, or in itself
struct ImageFrame
{
    Size whole;   // of the larger one
    Point origin; // of the image, in pixels of the larger one

    ImageFrame() {}
    explicit ImageFrame(Size size, Point first = Point()) : whole(size), origin(first) {}

    //! The same in the pixels of a layer
    ImageFrame ofLayer(int layer) const
    {
        return ImageFrame(Size(whole.width >> layer, whole.height >> layer),
                          Point(origin.x >> layer, origin.y >> layer));
    }
};

}}} // namespace cv::stereo::hdp

#endif
