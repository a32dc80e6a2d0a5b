// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Whether what a matcher says of its errors is true

#ifndef OPENCV_HDPSTEREO_TOOLS_CALIBRATION_HPP
#define OPENCV_HDPSTEREO_TOOLS_CALIBRATION_HPP

#include "datasets.hpp"
#include "methods.hpp"
#include "tables.hpp"

namespace hdp_tools {

/** Of the pixels with a HDPTreeMatcher::getDisparitySigma() of some level, the share whose error is within it, by sets:
68 % if it is true.
@param method Whose matcher is an HDPTreeMatcher; fails otherwise.
@param scenes Those without truth are left out.
@param numDisparities 0: those of the dataset. */
Table calibrationTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities);

} // namespace hdp_tools

#endif
