// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "progress.hpp"

#include <iostream>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace hdp_tools {

int endOfRun(size_t bad, size_t all, const char* what)
{
    if (isInterrupted())
        std::cerr << "interrupted: this is what was finished" << std::endl;
    if (bad > 0)
        std::cerr << bad << " of " << all << " " << what << " were skipped or failed, see above" << std::endl;
    return isInterrupted() ? 130 : bad > 0 ? 2 : 0;
}

static bool isTerminal()
{
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) != 0;
#endif
}

static const char* const clearLine = "\r\x1b[K";

Progress::Progress(size_t total) : total_(total), done_(0), isTerminal_(isTerminal()) {}

void Progress::step(const String& what)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    done_++;
    if (!isTerminal_)
    {
        std::cerr << done_ << "/" << total_ << " " << what << std::endl;
        return;
    }
    const size_t width = 30, filled = width * done_ / total_;
    std::cerr << clearLine << "[" << String(filled, '#') << String(width - filled, '.') << "] " << done_ << "/"
              << total_ << " " << what << std::flush;
}

void Progress::skip(size_t steps)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ += steps;
}

void Progress::message(const String& text)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    std::cerr << (isTerminal_ ? clearLine : "") << text << std::endl;
}

void Progress::finish()
{
    if (isTerminal_)
        std::cerr << clearLine << std::flush;
}

} // namespace hdp_tools
