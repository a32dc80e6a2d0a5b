// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SRC_TREE_STRATEGY_HPP
#define OPENCV_HDPSTEREO_SRC_TREE_STRATEGY_HPP

namespace cv { namespace stereo { namespace hdp {

//! One of the library's strategies with default parameters, or an empty pointer if none has this name.
Ptr<TreeStrategy> createTreeStrategy(const String& name);

}}} // namespace cv::stereo::hdp

#endif
