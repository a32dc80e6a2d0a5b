// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Progress of a long run on the standard error, and its end.

#ifndef OPENCV_HDPSTEREO_TOOLS_PROGRESS_HPP
#define OPENCV_HDPSTEREO_TOOLS_PROGRESS_HPP

#include <mutex>

#include "opencv2/core.hpp"

#include "../interrupts.hpp"

namespace hdp_tools {

using cv::String;

/** Says in the end whether something is missing.
@param bad How many of all pairs, or of what else there is, were skipped or failed.
@return The exit status: 130 if interrupted, 2 if something is bad, or 0. */
int endOfRun(size_t bad, size_t all, const char* what = "pairs");

//! A bar on a terminal, lines elsewhere; for any thread.
class Progress
{
public:
    explicit Progress(size_t total);

    void step(const String& what);
    void skip(size_t steps);
    void message(const String& text);
    void finish();

private:
    std::mutex mutex_;
    const size_t total_;
    size_t done_;
    const bool isTerminal_;
};

} // namespace hdp_tools

#endif
