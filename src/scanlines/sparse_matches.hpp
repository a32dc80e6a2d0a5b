// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SPARSE_MATCHES_HPP
#define OPENCV_HDPSTEREO_SPARSE_MATCHES_HPP

#include "../cost/census_cost.hpp"
#include "../base/disparity_units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of findSparseMatches() that others need
struct SparseMatches
{
    enum
    {
        spacing = 24, // pixels between points: more cost time, fewer miss surfaces; even, as a pixel of the layer above
                      // is two wide
        radius = 7,   // pixels of a point's window, which is one row: a wider one sees two surfaces, a narrower one is
                      // seldom unique
        noMatch = 0xffff
    };
};

/** Matches single points of a layer over the full range. What the layers above have lost, as a texture finer than their
pixels, is found again here, if it is unique.

The cost of a candidate is the sum of the census costs over the point's window, at most 255. The candidate of the lowest
cost is a match if its window is inside the right image, if every rival costs clearly more,
and if the left window has texture: flat areas match each other perfectly.
@param cost The layer's census cost.
@param size Of the layer.
@param numDisparities Of the layer.
@param matches Receives CV_16UC1, a disparity or noMatch per square of spacing x spacing pixels: that of the point in
the middle of the square. */
CV_EXPORTS void findSparseMatches(const CensusCost& cost, Size size, int numDisparities, Mat& matches);

}}} // namespace cv::stereo::hdp

#endif
