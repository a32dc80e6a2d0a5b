// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SUPPORT_POINTS_HPP
#define OPENCV_HDPSTEREO_SUPPORT_POINTS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

struct SupportPointBuffers
{
    Mat grey, derivative, horizontal, vertical; // of one image, and its gradients
    Mat descriptors[2];                         // of the pixels in each second row, CV_8U, 16 columns per pixel
    Mat matches;
};

/** Finds support points @cite Geiger2010ELAS: every 4th pixel in x and y, matched by descriptors of gradients.

A pixel's descriptor is 16 gradients around it; the dissimilarity of two pixels is the L1 distance of the descriptors
at (+-2, +-2) around them. A point is kept if it has texture, its best dissimilarity is below 0.95 times the second
one, the match of its match is at most 2 pixels away, and at least 4 of the points within +-4 grid places (itself
among them) differ from it by at most 4.

The authors' program has them instead of the paper's grid of 5 x 5 pixels; it counts those of the right image, too.
@param left,right CV_8UC1 or CV_8UC3.
@param numDisparities Disparities 0 .. numDisparities - 1 are compared.
@param points Receives CV_16SC1 of ceil(rows / 4) x ceil(cols / 4), the disparity at (4 y, 4 x) or -1. */
CV_EXPORTS void findSupportPoints(const Mat& left, const Mat& right, int numDisparities, SupportPointBuffers& buffers,
                                  Mat& points);

//! P(D_l) (section 3.1) up to a factor: how many points have each disparity. Uniform if there is none.
//! (The authors' program leaves out disparity 0, which is "unknown" there: the smallest one is then never predicted.)
CV_EXPORTS void disparityHistogram(const Mat& points, int numDisparities, std::vector<double>& histogram);

}}} // namespace cv::stereo::hdp

#endif
