// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MASK_HPP
#define OPENCV_HDPSTEREO_MASK_HPP

#include "opencv2/core.hpp"

#include <algorithm>

namespace cv { namespace stereo { namespace hdp {

/** Which pixels of a pair have data, CV_8UC1 each: 255 where, else 0, and on the layers above means of these. Both are
empty if all pixels have. */
struct PairMasks
{
    PairMasks() {}
    PairMasks(const Mat& leftMask, const Mat& rightMask) : left(leftMask), right(rightMask) {}

    bool isEmpty() const { return left.empty(); }

    Mat left, right;
    int leftBegin = 0, rightBegin = 0; // the columns of the images' first ones: before them there are copies of these
    int wholeWidth = 0;                // of the image that they are tiles of; 0: that of the masks
};

//! Whether more than half of the image's pixels that a pixel of a mask stands for have data: means are rounded down.
inline bool hasData(uchar share) { return share >= 128; }

//! hasData() of all pixels of a mask: CV_8UC1, 255 where, else 0
inline Mat pixelsWithData(const Mat& mask) { return mask >= 128; }

//! The columns in which a row of both images begins
struct RowStart
{
    static const int widthsPerLag = 8; // of the right image behind the left one: more is no border on the left
    int left, right;
};

//! The first ones with data. If that is farther on in the right image by more than an eighth of the whole width, a row
//! is masked from above or below: then it begins at the border of the images.
inline RowStart rowStart(const PairMasks& masks, int y)
{
    const auto first = [y](const Mat& mask) {
        const uchar* const row = mask.ptr(y);
        return (int)(std::find_if(row, row + mask.cols, hasData) - row);
    };
    const RowStart none = { 0, 0 };
    if (masks.isEmpty())
        return none;
    const RowStart start = { first(masks.left), first(masks.right) };
    const int width = masks.wholeWidth > 0 ? masks.wholeWidth : masks.left.cols,
              lag = std::max(start.right - masks.rightBegin, 0) - std::max(start.left - masks.leftBegin, 0);
    return lag > width / RowStart::widthsPerLag ? none : start;
}

}}} // namespace cv::stereo::hdp

#endif
