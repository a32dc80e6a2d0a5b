// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP
#define OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP

#include "../base/grey_levels.hpp"
#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// All parameters in intensity levels are for images of 8 bits. Images of 16 bits are brought to the same range.

/** Number of bits in use in a pair: 8 for images of 8 bits. For CV_16UC1, the minimum from 8 to 16 that is enough for
all pixels of both images but one in 1024; what is brighter is white. Images of 8 bits times 2^k are then these images
again, if more than one pixel in 1024 has a level of 128 or more.
@param left The images.
@param right
@param share Of the pixels that count; the others are black. */
CV_EXPORTS int countBits(const Mat& left, const Mat& right, double share = 1);

/** The colours or grey levels of an image in 8 bits, the upper ones of those in use. If fewer than 8 are in use, levels
are doubled as often; what is brighter then is white.
@param image CV_8UC1, CV_8UC3, CV_8UC4, whose alpha is left out, or CV_16UC1.
@param bits See countBits(); of a dark pair, less countUnusedBits().
@param buffer Memory for the result.
@return CV_8UC1 or CV_8UC3: the image itself, if it is that. */
CV_EXPORTS Mat byteLevels(const Mat& image, int bits, Mat& buffer);

/** Grey levels 0.299 R + 0.587 G + 0.114 B in 1 / greyScale of a level: the upper 10 of the bits in use, if there are
more than 8. Means of many pixels tell faint texture apart that 8 bits lose: the census cost of the coarse layers lives
on it.
@param image CV_8UC1, CV_8UC3, CV_8UC4, whose alpha is left out, or CV_16UC1.
@param bits See byteLevels().
@param grey Receives CV_16UC1. */
CV_EXPORTS void greyLevels(const Mat& image, int bits, Mat& grey);

/** How many upper bits a dark pair leaves unused: the maximum, up to 2, with which all pixels but one in 128 are below
white when their levels are doubled as often. As few are lamps and what they shine on. More than 2 would make noise look
like texture.
@param left,right See greyLevels().
@param share See countBits(). */
CV_EXPORTS int countUnusedBits(const Mat& left, const Mat& right, double share = 1);

}}} // namespace cv::stereo::hdp

#endif
