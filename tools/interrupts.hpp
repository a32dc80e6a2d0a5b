// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_INTERRUPTS_HPP
#define OPENCV_HDPSTEREO_TOOLS_INTERRUPTS_HPP

namespace hdp_tools {

//! From now on SIGINT and SIGTERM only make isInterrupted() true; the second one ends the program.
void catchInterrupts();

bool isInterrupted();

} // namespace hdp_tools

#endif
