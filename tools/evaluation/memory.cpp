// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "memory.hpp"

#include <cstdio>
#include <fstream>
#include <vector>

#ifdef __linux__
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include "command_line.hpp"

namespace hdp_tools {

#ifdef __linux__

static long peakKilobytes()
{
    std::ifstream status("/proc/self/status");
    for (String line; std::getline(status, line);)
    {
        long kilobytes;
        if (std::sscanf(line.c_str(), "VmHWM: %ld kB", &kilobytes) == 1)
            return kilobytes;
    }
    fail("/proc/self/status does not say how much memory was used");
}

double measureMemory(const Method& method, const Pair& pair)
{
    // Threads, tables and the like are there after a first small pair.
    Mat noise(64, 128, CV_8UC3), disparity;
    cv::randu(noise, 0, 256);
    const std::array<Mat, 2> small = imagesFor(method, noise, noise);
    method.create(cv::Range(0, 16))->compute(small[0], small[1], disparity);

    const std::array<Mat, 2> images = imagesFor(method, pair.left, pair.right);
    disparity = Mat(images[0].size(), CV_16SC1, cv::Scalar(0));
    const Ptr<cv::StereoMatcher> matcher = method.create(pair.disparities);
#ifdef __GLIBC__
    malloc_trim(0); // or compute() would be given what reading the images left behind
#endif
    std::ofstream("/proc/self/clear_refs") << 5 << std::flush; // the peak starts again at what is in use
    const long before = peakKilobytes();
    matcher->compute(images[0], images[1], disparity);
    return (peakKilobytes() - before) * 1024. / double(disparity.total());
}

String runMemoryOf(const Method& method, const char* const argv[], double& bytesPerPixel)
{
    const String option = "--memory-of=" + method.name;
    std::vector<char*> arguments;
    for (const char* const* argument = argv; *argument; argument++)
        arguments.push_back(const_cast<char*>(*argument));
    arguments.push_back(const_cast<char*>(option.c_str()));
    arguments.push_back(nullptr);

    int ends[2];
    if (pipe(ends) != 0)
        fail("cannot start a process to measure memory in: no pipe");
    const pid_t child = fork();
    if (child < 0)
        fail("cannot start a process to measure memory in");
    if (child == 0)
    {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        execv("/proc/self/exe", arguments.data());
        _exit(127);
    }
    close(ends[1]);
    char text[64] = "";
    size_t length = 0;
    for (ssize_t n; length + 1 < sizeof(text) && (n = read(ends[0], text + length, sizeof(text) - 1 - length)) > 0;)
        length += size_t(n);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status))
        return cv::format("killed by signal %d (out of memory?)", WTERMSIG(status));
    if (status != 0 || std::sscanf(text, "%lf", &bytesPerPixel) != 1)
        return "failed, see above";
    return String();
}

#else

double measureMemory(const Method&, const Pair&) { fail("--memory-of: memory is only measured on Linux"); }

String runMemoryOf(const Method&, const char* const[], double&) { return String(); }

#endif

} // namespace hdp_tools
