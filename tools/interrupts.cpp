// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "interrupts.hpp"

#include <csignal>

namespace hdp_tools {

static volatile std::sig_atomic_t interrupted = 0;

extern "C" {
static void interrupt(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}
}

void catchInterrupts()
{
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
}

bool isInterrupted() { return interrupted != 0; }

} // namespace hdp_tools
