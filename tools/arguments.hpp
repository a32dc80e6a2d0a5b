// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_ARGUMENTS_HPP
#define OPENCV_HDPSTEREO_TOOLS_ARGUMENTS_HPP

#include <vector>

#include "opencv2/core/utility.hpp"

namespace hdp_tools {

//! NAME of --NAME=VALUE, and with one dash; empty if it is no option
cv::String optionName(const cv::String& argument);

/** Checks the arguments more strictly than cv::CommandLineParser does: unknown options, options without a value, flags
with one, and too many positional arguments are errors, cv::Exception.
@param flags Options without a value; --help is one anyway. "NAME=" is one that may have a value or not. */
void checkArguments(int argc, const char* const argv[], const cv::CommandLineParser& parser,
                    std::vector<cv::String> flags, int maxPositional);

} // namespace hdp_tools

#endif
