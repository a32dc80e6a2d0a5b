// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The memory that a method needs, on Linux.

#ifndef OPENCV_HDPSTEREO_TOOLS_MEMORY_HPP
#define OPENCV_HDPSTEREO_TOOLS_MEMORY_HPP

#include "methods.hpp"
#include "pair.hpp"

namespace hdp_tools {

//! What compute() adds to the memory of this process at its peak, beside the images and the disparities; bytes per pixel
double measureMemory(const Method& method, const Pair& pair);

/** Runs this program again with --memory-of, in which it prints what measureMemory() gives.
@param argv That of main().
@return Why there is no result, or an empty string.
*/
String runMemoryOf(const Method& method, const char* const argv[], double& bytesPerPixel);

} // namespace hdp_tools

#endif
