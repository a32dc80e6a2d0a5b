// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MATCHING_COST_HPP
#define OPENCV_HDPSTEREO_MATCHING_COST_HPP

#include "cost_limits.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The matching cost M(p, x) of a layer (section 3.3): how unlike are pixel p of the left and p - x of the right image.
class CV_EXPORTS MatchingCost
{
public:
    virtual ~MatchingCost();

    /** Costs M(p, x) of some pixels.
    @param pixels The pixels, y * width + x each.
    @param count Their number.
    @param first The first of the candidates x.
    @param lanes The number of candidates, 4, 8, 16 or 32; costs of those past the last one mean nothing.
    @param cost Receives M(pixels[i], first + k) at [i * lanes + k]. */
    virtual void evaluate(const int* pixels, int count, int first, int lanes, float* cost) const = 0;

    //! The cost of one candidate of each pixel, CV_32SC1, in 1/512; that of the census is CV_8UC1, in bits. disparity:
    //! CV_16UC1, a disparity map.
    virtual void ofDisparities(const Mat& disparity, Mat& costs) const;

    //! What pixels without data cost at most
    const CostLimits& limits() const { return limits_; }

protected:
    CostLimits limits_;
};

// All costs hold the rows of the right image mirrored and padded, so that the candidates of a pixel follow one another
// in memory.

//! Columns behind the last candidate that evaluate() may read
const int costPadding = 32;

/** Copies rows of a channel and adds borders, whose pixels are the nearest ones of the image.
@param image Of 8 or 16 bits.
@param channel Its channel.
@param first The row to copy first; those above and below the image are borders.
@param before Columns added on the left of the copy.
@param after Columns added on its right.
@param mirrored Whether the copy has the columns from right to left.
@param bordered Receives the copy, as many rows as it has. */
void copyBordered(const Mat& image, int channel, int first, int before, int after, bool mirrored, Mat bordered);

//! y of pixel y * width + x; rowsPerPixel: 1. / width. Exact: the error of the product is far less than half a pixel.
CV_ALWAYS_INLINE int rowOf(int pixel, double rowsPerPixel) { return (int)((pixel + 0.5) * rowsPerPixel); }

}}} // namespace cv::stereo::hdp

#endif
