// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// --set and --list-tunables: the tuned constants of src/, if the library was built with them as variables.

#ifndef OPENCV_HDPSTEREO_TOOLS_TUNABLES_HPP
#define OPENCV_HDPSTEREO_TOOLS_TUNABLES_HPP

#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"

namespace hdp_tools {

using cv::String;

//! The options
extern const char* const TUNABLE_KEYS;

/** Does what --set asks for, and prints it. --list-tunables prints all tunables, with these values.
@return Whether that was all: with --list-tunables, the program is to end. */
bool useTunables(const cv::CommandLineParser& parser);

//! A tunable with a value, "NAME=VALUE" of --set
struct TunableSetting
{
    String name, value;
};

//! Fails if the text is not of the kind NAME=VALUE.
TunableSetting parseSetting(const String& option, const String& text);

/** The values to try that an option asks for, a list like NAME or NAME=VALUE:VALUE. Without values, they are half and
double the present one. Fails if there is no such tunable. */
std::vector<TunableSetting> parseSweep(const String& option, const String& list);

//! Sets a tunable; returns what it was before.
TunableSetting applySetting(const TunableSetting& setting);

} // namespace hdp_tools

#endif
