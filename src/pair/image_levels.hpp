// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP
#define OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP

#include "../base/units.hpp"
#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// All parameters in intensity levels are for images of 8 bits. Images of 16 bits are brought to the same range.

/** Number of bits in use in a pair: 8 for images of 8 bits. For CV_16UC1, the minimum from 8 to 16 that is enough for
all pixels of both images but one in 1024; what is brighter is white.
@param share Of the pixels that count; the others are black. */
CV_EXPORTS int bitsInUse(const Mat& left, const Mat& right, double share = 1);

//! Whether all pixels have a grey level alone, or the same of each colour
CV_EXPORTS bool hasNoColours(const Mat& image);

/** The colours or grey levels of an image in 8 bits, the upper ones of those in use; parameters as of greyLevels().
@param buffer Memory for the result.
@return CV_8UC1 or CV_8UC3: the image itself, if it is that. */
CV_EXPORTS Mat byteLevels(const Mat& image, int bits, Mat& buffer, double brightness = 1);

/** Grey levels 0.299 R + 0.587 G + 0.114 B in 1 / greyScale of a level: the upper 10 of the bits in use, if there are
more than 8. Means of many pixels tell faint texture apart that 8 bits lose: the census cost of the coarse layers lives
on it.

A brightness is 1 to 4: 2 or 4 doubles levels once or twice; what is brighter then is white. One between doubles, the
last time, levels below a knee alone, the share b - 1 of white for b < 2 and b / 2 - 1 for b > 2; those above it are on
the line from there to white. So the levels depend on the brightness without a jump.
@param image CV_8UC1, CV_8UC3, CV_8UC4, whose alpha is left out, or CV_16UC1.
@param bits See bitsInUse(). The levels are CV_16UC1. */
CV_EXPORTS void greyLevels(const Mat& image, int bits, Mat& grey, double brightness = 1);

/** What a dark pair is brightened by, see greyLevels(). Its levels are doubled, once or twice, if not more than one
pixel in 128 becomes white by that, not if more than one in 16 would, and in between by less. What is white already has
nothing to lose, and does not count as far as it is no more than what stays dark.
@param share See bitsInUse(). */
CV_EXPORTS double findBrightness(const Mat& left, const Mat& right, double share = 1);

//! The power of two that is about a brightness, for what is found in a brightened pair and told in levels of the
//! images: a model that is divided by it gives the same map.
inline int roundedBrightness(double brightness) { return brightness < 1.5 ? 1 : brightness < 3 ? 2 : 4; }

}}} // namespace cv::stereo::hdp

#endif
