// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_BLANK_BORDERS_HPP
#define OPENCV_HDPSTEREO_BLANK_BORDERS_HPP

#include "../base/image_frame.hpp"
#include "../base/mask.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Finds black borders in a pair, as rectification leaves them: more than one pixel in 100 of an image, and less than
half of it.
@param left CV_8UC1, CV_8UC3, CV_8UC4 or CV_16UC1.
@param right Of the same type and size.
@param masks Receives those of maskBorders(), if there are any.
@return The level that ends them: a quarter of the mean over both images, at least 8 of 8 bits and 1 of 16; 0 if there
are none. */
CV_EXPORTS double findBorders(const Mat& left, const Mat& right, PairMasks& masks);

/** Masks black borders: they show nothing, and their edges are at the same place in both images, whatever the disparity
is. Along a side of the image, a border has at least a quarter of its rows (or columns), one after the other, that begin
with black: up to 2 of 8 bits, 0 of 16. Three quarters of these end sharply, about where the row before ends: at most 10
pixels after the black ones, one has the level that ends a border. These pixels belong to it, too: resampling and JPEG
mix them from both. A border that reaches no corner has 10 pixels at most in its first and its last row, and nine
tenths of its rows end within a pixel of the row before. The brightest channel counts. Round outlines after JPEG are
not found: they end less smoothly.
@param image As above.
@param level That ends a border, > 0.
@param frame Where the image lies, if it is a tile: borders begin at the sides of the whole that it has, and may go on
behind a cut, where they may be of any length.
@param mask Receives CV_8UC1 of the size of the image, 0 in borders, else 255. */
CV_EXPORTS void maskBorders(const Mat& image, double level, const ImageFrame& frame, Mat& mask);

}}} // namespace cv::stereo::hdp

#endif
