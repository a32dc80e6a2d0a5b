// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The command lines of the programs.

#ifndef OPENCV_HDPSTEREO_TOOLS_COMMAND_LINE_HPP
#define OPENCV_HDPSTEREO_TOOLS_COMMAND_LINE_HPP

#include <exception>
#include <functional>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"

namespace hdp_tools {

using cv::String;

//! Throws what runProgram() reports in one line.
[[noreturn]] void fail(const String& message);

String lowerCase(String text);

//! What an exception says, in one line
String messageOf(const std::exception& error);

//! The items of a list that is separated by commas, the value of an option; empty ones are left out. Fails if none is left.
std::vector<String> splitList(const String& option, const String& text);

//! The number given for an option, within [low, high]
double getNumber(const cv::CommandLineParser& parser, const String& name, double low, double high);

//! As getNumber() for whole numbers
int getInteger(const cv::CommandLineParser& parser, const String& name, int low, int high);

//! Sets the number of threads that --threads asks for.
void setThreads(const cv::CommandLineParser& parser);

/** The main() of a program.

Checks the arguments by checkArguments(). Each error is reported in one line, and so is output that was lost, on a full
disk for instance.
@param flags See checkArguments(); --list-tunables is one anyway.
@param run Returns the exit status.
@return The exit status: 1 after an error.
*/
int runProgram(int argc, const char* const argv[], const String& keys, const String& about,
               const std::vector<String>& flags, int maxPositional,
               const std::function<int(const cv::CommandLineParser&)>& run);

} // namespace hdp_tools

#endif
