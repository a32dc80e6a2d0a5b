// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_IMAGE_PYRAMID_HPP
#define OPENCV_HDPSTEREO_IMAGE_PYRAMID_HPP

#include "opencv2/core.hpp"

#include <vector>

namespace cv { namespace stereo { namespace hdp {

// The graph pyramid of section 2.1 with S = 2

//! d_l + 1, the number of candidates of layer l: floor((numDisparities - 1) / 2^l) + 1 for whole disparities (section
//! 2.1). Sub-pixel disparities keep their fraction from layer to layer, so the largest one needs the next candidate,
//! too.
inline int layerDisparities(int numDisparities, int layer, bool subpixel)
{
    const int64 largest = numDisparities - 1, step = (int64)1 << layer;
    return (int)((subpixel ? largest + step - 1 : largest) >> layer) + 1;
}

//! G_{l+1} of G_l: means of 2 x 2 pixels, rounded down (CV_8U) or to the nearest (CV_16U); an odd last row or column is
//! left out. The authors' program truncates and leaves out, too; the paper rounds sizes up.
CV_EXPORTS void halveImage(const Mat& image, Mat& half);

//! Halves an image layer by layer. given: its first layers, at least one, which the pyramid has as they are; the others
//! are in memory that is used again.
CV_EXPORTS void buildPyramid(const std::vector<Mat>& given, size_t layers, std::vector<Mat>& pyramid);

//! pixelsWithData() of a layer of a mask; none for an empty one
Mat dataOfLayer(const Mat& mask, int layer);

}}} // namespace cv::stereo::hdp

#endif
