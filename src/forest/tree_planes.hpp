// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TREE_PLANES_HPP
#define OPENCV_HDPSTEREO_TREE_PLANES_HPP

#include "cost_volume.hpp"
#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

/** Bare surfaces. A tree of pixels of similar colour is often one surface, and nearly a plane. Where the costs of a
pixel tell little, those of its whole tree do. Of the planes through three disparities of a tree, its plane is the one
that raises the costs least above those of the disparities, and is not tilted without need, fitted to those near it.
If few disparities lie on it, as where noise is stronger than texture, it is the one disparity whose costs are clearly
lowest in sum, of which at most a bit of each pixel counts. If its plane raises the costs by little, all pixels of the
tree get its disparities, but for those whose costs contradict them.
@param forest The forest that the volume belongs to.
@param disparity CV_16UC1, the winners of the volume, of which those of planes are replaced.
@return Number of trees that have a plane. */
CV_EXPORTS int takeTreePlanes(const DisparityForest& forest, const CostVolume& volume, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
