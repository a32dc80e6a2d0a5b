// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PRIOR_JOIN_HPP
#define OPENCV_HDPSTEREO_PRIOR_JOIN_HPP

#include "../cost/census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

//! A disparity that is known beforehand, in pixels of a layer
struct PriorPoint
{
    Point place;
    float disparity, sigma;
};

/** The points of a layer, of those of the image: means of the ones in a pixel, of the nearest surface if there are
several.
@param disparity CV_32FC1 of the image's size, NaN where nothing is known.
@param sigma Of the same size and type.
@param minDisparity Of the image, in its pixels.
@param extension Columns that are added on the left of the image.
@param layer The layer.
@param numDisparities Its candidates; others are left out.
@param points Receives them, row by row. */
CV_EXPORTS void pointsOfLayer(const Mat& disparity, const Mat& sigma, int minDisparity, int extension, int layer,
                              int numDisparities, std::vector<PriorPoint>& points);

/** Joins the winners of a layer with what is known beforehand. A point that the winners agree with speaks for those
around it which go on from it. Another one counts if points around agree with it, and the costs contradict neither it
nor, in the mean, the points around that differ from the winners as well; it speaks against winners that go on from
the one at its place. If the costs do contradict it, it speaks for these winners. Where less than two fifths of the
points around agree with the winners, the prior is of something else, and none counts; but where the costs of those that
differ are hardly higher, the winners are noise, and the points count if few are contradicted in the whole layer. Where
more speaks against a winner than for it, or nothing for it, it becomes the disparity of a plane through the points
around, unless the costs contradict; if nothing speaks against it either, less is enough for that.
@param points Of the layer, at most one per pixel.
@param guide Its image, CV_8UC1 or CV_8UC3: what has the colour of a point is more likely of its surface.
@param cost Its census.
@param layer Its number.
@param maxDisparity Of a map of the layer.
@param winners CV_16UC1, a disparity map, changed. */
CV_EXPORTS void joinPrior(const std::vector<PriorPoint>& points, const Mat& guide, const CensusCost& cost, int layer,
                          int maxDisparity, Mat& winners);

}}} // namespace cv::stereo::hdp

#endif
