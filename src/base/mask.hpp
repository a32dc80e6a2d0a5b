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
    Mat left, right;

    bool isEmpty() const { return left.empty(); }
};

//! Of the pixel of a mask: whether half of the image's pixels that it stands for have data
inline bool hasData(uchar share) { return share >= 128; }

//! hasData() of all pixels of a mask: CV_8UC1, 255 where, else 0
inline Mat pixelsWithData(const Mat& mask) { return mask >= 128; }

//! The number of columns of a mask's row without data, from the left border on
inline int countBlank(const Mat& mask, int y)
{
    const uchar* const row = mask.ptr(y);
    return (int)(std::find_if(row, row + mask.cols, hasData) - row);
}

}}} // namespace cv::stereo::hdp

#endif
