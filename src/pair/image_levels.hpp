// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP
#define OPENCV_HDPSTEREO_IMAGE_LEVELS_HPP

#include "../base/mask.hpp"
#include "../base/units.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

// All parameters in intensity levels are for images of 8 bits. Images of 16 bits are brought to the same range.

// One of so many pixels may be too dark, and one too bright: defects and highlights are fewer, parts of the scene more.
const int pixelsPerOutlier = 1024;

//! How the levels of a pair become those that are matched
struct LevelScale
{
    static const int end = 1 << 16; // of black and white

    explicit LevelScale(int bitsInUse = 8, double brightened = 1) : bits(bitsInUse), brightness(brightened) {}

    bool isStretched() const { return black > 0 || white < end; }
    double gain() const { return brightness * end / (white - black); } // of differences of levels, about
    double darkest() const { return std::ldexp(black, bits - 16); }    // level of the image that becomes black
    double contrast() const { return std::ldexp(white - black, bits - 16); }

    int bits;                   // in use, see bitsInUse()
    int black = 0, white = end; // what becomes black and white, in 1 / end of the bits in use, see findEnds()
    double brightness;          // what levels are brightened by then, see greyLevels()
};

/** Number of bits in use in a pair: 8 for images of 8 bits. For CV_16UC1, the minimum from 8 to 16 that is enough for
all pixels of both images but one in 1024; what is brighter is white.
@param share Of the pixels that count; the others are black. */
CV_EXPORTS int bitsInUse(const Mat& left, const Mat& right, double share = 1);

//! Whether all pixels have a grey level alone, or the same of each colour
CV_EXPORTS bool hasNoColours(const Mat& image);

/** The colours or grey levels of an image in 8 bits, the upper ones of those in use; parameters as of greyLevels().
@param buffer Memory for the result.
@return CV_8UC1 or CV_8UC3: the image itself, if it is that. */
CV_EXPORTS Mat byteLevels(const Mat& image, const LevelScale& scale, Mat& buffer);

/** Grey levels 0.299 R + 0.587 G + 0.114 B in 1 / greyScale of a level: the upper 10 of the bits in use, if there are
more than 8, between black and white. Means of many pixels tell faint texture apart that 8 bits lose: the census cost of
the coarse layers lives on it.

A brightness is 1 to 4. Levels are doubled once for one up to 2, and twice above. In the last doubling, those above a
knee only move up the line to white; the knee is (brightness - 1) of white up to 2, and (brightness / 2 - 1) above. So
levels depend on the brightness without a jump.
@param image CV_8UC1, CV_8UC3, CV_8UC4, whose alpha is left out, or CV_16UC1.
@param grey Receives CV_16UC1. */
CV_EXPORTS void greyLevels(const Mat& image, const LevelScale& scale, Mat& grey);

/** Finds black and white of a pair whose contrast is low, by haze, a black level of the sensor or its exposure: a
sixth of the contrast below the darkest and above the brightest channel of any pixel but one in 1024, and at least a
quarter of all levels apart. So a pair of full contrast stays as it is. Pixels that are black or white do not count.
@param scale Its bits are known; receives black and white. */
CV_EXPORTS void findEnds(const Mat& left, const Mat& right, const PairMasks& masks, LevelScale& scale);

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
