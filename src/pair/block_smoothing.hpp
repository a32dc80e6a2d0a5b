// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_BLOCK_SMOOTHING_HPP
#define OPENCV_HDPSTEREO_BLOCK_SMOOTHING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The blocks of 8 columns that JPEG compression leaves in an image
struct BlockGrid
{
    static const int side = 8;
    int begin = 0;   // the first column that begins a block, less than side
    double step = 0; // mean step from block to block, in the units of the levels, less if it is not sure; 0: none
};

/** Finds the blocks that strong compression makes visible: the mean of small steps between flat pixels is several times
as large at one column in eight as at the others, and at one row in eight. The contours of a faint slope are so in one
direction at most. The lower ratio tells how sure it is: from 6 on, the step of the grid is the mean one, down to 4.5 a
part of it.
@param grey See greyLevels().
@param gain What a level of the camera has become, see LevelScale::gain(): compression came before. */
CV_EXPORTS BlockGrid findBlocks(const Mat& grey, double gain = 1);

/** Makes ramps of the steps between blocks in the grey levels of a pair, if both images have some: as these are at the
same columns, they match at multiples of 8, whatever the scene is. A step is what levels change by between two columns,
less the mean change beside them; if it is less than 4 times the mean, the four pixels on each side take 7/16, 5/16,
3/16 and 1/16 of it. Larger steps are edges of the scene. */
CV_EXPORTS void smoothBlocks(Mat& left, Mat& right, const BlockGrid& ofLeft, const BlockGrid& ofRight);

}}} // namespace cv::stereo::hdp

#endif
