// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_OCCLUSION_FILLING_HPP
#define OPENCV_HDPSTEREO_OCCLUSION_FILLING_HPP

#include "../base/mask.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Memory for a row of fillOccluded(), by pixel, or by column of the right image from 1 on. A row may begin later in
//! the left image: its pixels map to all columns of the right one.
struct OcclusionScratch
{
    explicit OcclusionScratch(int width)
        : columns(width), nearest((size_t)width + 1), keys(width), bestKeys((size_t)width + 1), isBest(width),
          visibility(width)
    {
    }

    std::vector<int> columns;       // of the right image that each pixel maps to, from 1 on; 0: none
    std::vector<int> nearest;       // by column: the maximum disparity that maps to it
    std::vector<unsigned> keys;     // by which the minimum wins a column: residual, then disparity
    std::vector<unsigned> bestKeys; // by column: the key that won it
    std::vector<uchar> isBest;      // whether the pixel has the disparity that won its column
    std::vector<uchar> visibility;  // whether nearer pixels hide it, whatever the residuals are
};

/** Gives pixels that the right image does not show the disparity of the farther of the pixels beside them. Not
shown are
- pixels that map to no column of the right image;
- pixels whose disparity is not that of the column's winner: of those that map to it, the one with the lowest residual;
- up to three pixels between two gaps that are no shorter;
- what is left of the surface at the border of the right image: the last run of four pixels without steps, all of them
  winners of their columns, that
  - begins in the first three columns of the right image;
  - or has at most one winner among seven pixels before it;
  - or is nearer than what is before it, of which at most one pixel in eight is visible, and three quarters map to
    columns of nearer pixels, or to none.

The surface at the border is continued to the left border, half as steep as its first columns are. The borders are
where the rows of the images begin, see rowStart().
@param disparity CV_16UC1, a disparity map; changed.
@param residual Matching costs, CV_8UC1.
@param masks Of both images, or empty. */
CV_EXPORTS void fillOccluded(Mat& disparity, const Mat& residual, const PairMasks& masks = PairMasks());

}}} // namespace cv::stereo::hdp

#endif
