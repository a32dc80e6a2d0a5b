// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_OCCLUSION_FILLING_HPP
#define OPENCV_HDPSTEREO_OCCLUSION_FILLING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of fillOccluded()
struct OcclusionFilling
{
    enum
    {
        minSurface = 4, // columns of a surface at the border of the right image: fewer are there by chance
        nearBorder = 3, // columns of the right image, from 1 on, that are its border: matches there are off by some
        // Of the pixels left of a surface, at most one in so many
        pixelsPerBest = 7,    // is the best match of its column, if the surface begins at the border: a smaller number
                              // takes other surfaces for it
        pixelsPerVisible = 8, // is visible, if the surface hides them: some match by chance
        pixelsPerShown = 4,   // is not behind nearer ones then: a smaller number takes things farther inside for the
                              // border
        mostByChance = 3,    // columns between two gaps that are no shorter, and match by chance: more lose thin things
        minSlopeColumns = 8, // of the surface at the border, to tell its slope: fewer tell noise
        maxSlopeColumns = 32 // of it, to be as many as are filled: more are bent
    };
    static_assert(pixelsPerVisible % pixelsPerShown == 0, "mapToRight() divides them");
};

//! Memory for a row of fillOccluded(), by pixel, or by column of the right image from 1 on
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
- up to mostByChance pixels between two gaps that are no shorter;
- what is left of the surface at the border of the right image: the last run of four pixels without steps that is shown,
  if it begins in the first three columns, or if it is nearer than what is before it, nearer pixels hide three quarters
  of that (1 - 1 / pixelsPerShown) from the right image, or it maps to no column, and no more than one in
  pixelsPerVisible is visible in columns that are not blank.

The surface at the border is continued to the left border, half as steep as its first columns are.
@param disparity CV_16UC1, a disparity map; changed.
@param residual Matching costs, CV_8UC1.
@param right Grey levels of the right image, CV_16UC1, see greyLevels(): columns on its left are blank that are black,
as rectification leaves them. None if empty.
@param rightMask If not empty, the mask of the right image: columns on its left without data are blank instead. */
CV_EXPORTS void fillOccluded(Mat& disparity, const Mat& residual, const Mat& right = Mat(),
                             const Mat& rightMask = Mat());

}}} // namespace cv::stereo::hdp

#endif
