// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_WINDOW_SUMS_HPP
#define OPENCV_HDPSTEREO_WINDOW_SUMS_HPP

#include "opencv2/imgproc.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Sums over the windows around all pixels, by several threads.
@param values Whole numbers.
@param side Of the windows, in pixels; odd.
@param depth CV_16U, CV_16S or CV_32S.
@param sums Receives the sums; another Mat.
@param border What is beyond the image: its border, or with BORDER_CONSTANT 0. */
inline void sumOverWindows(const Mat& values, int side, int depth, Mat& sums, int border = BORDER_REPLICATE)
{
    const int stripe = 128; // rows of a thread: fewer compute the rows between stripes more often
    sums.create(values.size(), CV_MAKETYPE(depth, values.channels()));
    parallel_for_(Range(0, (values.rows + stripe - 1) / stripe), [&](const Range& stripes) {
        const Range rows(stripes.start * stripe, std::min(stripes.end * stripe, values.rows)); // which see those beside
        Mat part = sums.rowRange(rows);
        boxFilter(values.rowRange(rows), part, depth, Size(side, side), Point(-1, -1), false, border);
    });
}

}}} // namespace cv::stereo::hdp

#endif
