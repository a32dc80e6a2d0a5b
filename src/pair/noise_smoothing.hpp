// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_NOISE_SMOOTHING_HPP
#define OPENCV_HDPSTEREO_NOISE_SMOOTHING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

/** A Gaussian of half a pixel, over 3 x 3 pixels, for the images of a noisy pair. Of what a row or a column is mixed
of, 27 / 256 are a pixel's neighbour on either side; the sum is rounded once. cv::GaussianBlur() does the same to
numbers of 16 bits in several times as long.
@param image CV_16UC1, values up to 1023; its border is repeated.
@param smoothed Receives another image. */
CV_EXPORTS void smoothNoise(const Mat& image, Mat& smoothed);

}}} // namespace cv::stereo::hdp

#endif
