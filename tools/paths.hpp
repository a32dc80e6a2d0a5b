// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_PATHS_HPP
#define OPENCV_HDPSTEREO_TOOLS_PATHS_HPP

#include "opencv2/core.hpp"

namespace hdp_tools {

//! A path without its folders
cv::String fileName(const cv::String& path);

//! The same for all paths of a file, which need not be there yet: absolute and without links
cv::String placeOf(const cv::String& path);

} // namespace hdp_tools

#endif
