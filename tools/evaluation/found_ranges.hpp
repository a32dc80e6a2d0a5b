// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// How good the ranges of disparities are that a matcher finds by itself.

#ifndef OPENCV_HDPSTEREO_TOOLS_FOUND_RANGES_HPP
#define OPENCV_HDPSTEREO_TOOLS_FOUND_RANGES_HPP

#include <set>

#include "datasets.hpp"
#include "methods.hpp"
#include "tables.hpp"

namespace hdp_tools {

//! What a range leaves out of the true one at both ends, less than 0 if it goes beyond it, and its size, in shares of the
//! true one's size
struct RangeError
{
    double before, behind, size;
};

/** Compares a range with the disparities of a pair.
@param found First disparity, and the one behind the last.
@param truth CV_32FC1, that of the pair.
@param judged CV_8UC1, 0 where the truth does not count. It must count somewhere.
@param leftOut Share of the true disparities that is left out at each end. */
RangeError rangeError(const cv::Range& found, const Mat& truth, const Mat& judged, double leftOut = 0.001);

/** Of the ranges that a method finds, by sets.
@param method Whose matcher is an HDPTreeMatcher.
@param scenes With truth.
@param bad See forEachPair().
@return Without rows if no scene was read. */
Table foundRangesTable(const Method& method, const std::vector<Scene>& scenes, std::set<String>& bad);

} // namespace hdp_tools

#endif
