// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FUZZ_INPUT_HPP
#define OPENCV_HDPSTEREO_FUZZ_INPUT_HPP

#include "opencv2/core.hpp"
#include "opencv2/core/utils/logger.hpp"

#include <fuzzer/FuzzedDataProvider.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

// What the fuzzers make of their bytes

typedef FuzzedDataProvider Input;

//! Exceptions are reported by their catchers. Returns what LLVMFuzzerInitialize() has to.
inline int silenceErrors()
{
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
    return 0;
}

inline void require(bool condition, const char* what)
{
    if (condition)
        return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

template <typename T, size_t count> T pick(Input& input, const T (&values)[count])
{
    return values[input.ConsumeIntegralInRange<size_t>(0, count - 1)];
}

inline double anyDouble(Input& input)
{
    typedef std::numeric_limits<double> Limits;
    const double corners[] = { 0,
                               -1,
                               0.5,
                               1,
                               Limits::denorm_min(),
                               Limits::min(),
                               Limits::max(),
                               -Limits::max(),
                               Limits::infinity(),
                               -Limits::infinity(),
                               Limits::quiet_NaN(),
                               1e30,
                               1e-30 };
    switch (input.ConsumeIntegralInRange(0, 2))
    {
    case 0:
        return pick(input, corners);
    case 1:
        return input.ConsumeProbability<double>();
    default:
        return input.ConsumeFloatingPoint<double>();
    }
}

//! A file with some of its text replaced
inline std::string mutated(Input& input, std::string text)
{
    const char* const values[] = { "0",    "-1",    "1",      "2147483647",   "-2147483648", "99999999999999999999",
                                   "0.5",  "1e300", ".Nan",   ".Inf",         "-.Inf",       "\"text\"",
                                   "[ ]",  "{ }",   "[ 1. ]", "[ 1., .Nan ]", "{ a: 1 }",    "!!binary |",
                                   "null", "",      "[ [",    "*x",           "&x" };
    for (int i = input.ConsumeIntegralInRange(0, 5); i > 0 && !text.empty(); --i)
    {
        const size_t at = input.ConsumeIntegralInRange<size_t>(0, text.size() - 1);
        switch (input.ConsumeIntegralInRange(0, 4))
        {
        case 0:
            text[at] = (char)input.ConsumeIntegral<uchar>();
            break;
        case 1:
            text.erase(at, input.ConsumeIntegralInRange<size_t>(0, 80));
            break;
        case 2:
            text.insert(at, input.ConsumeRandomLengthString(60));
            break;
        case 3:
            text.resize(at);
            break;
        default: // the value of a line
            const size_t colon = text.find(": ", at), end = text.find('\n', colon);
            if (colon != std::string::npos && end != std::string::npos)
                text.replace(colon + 2, end - colon - 2, pick(input, values));
        }
    }
    return text;
}

#endif
