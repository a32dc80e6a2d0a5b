// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef HDPSTEREO_SAMPLES_STRICT_ARGUMENTS_HPP
#define HDPSTEREO_SAMPLES_STRICT_ARGUMENTS_HPP

// What cv::CommandLineParser lets pass is an error, cv::Exception.

#include <algorithm>
#include <cstdlib>

#include "opencv2/core/utility.hpp"

namespace hdp_samples {

//! No options that the parser does not know, and no more files
inline void checkArguments(int argc, const char* const argv[], const cv::CommandLineParser& parser, int maxFiles)
{
    for (int i = 1; i < argc; i++)
    {
        const cv::String argument = argv[i];
        if (argument.empty() || argument[0] != '-')
        {
            if (maxFiles-- == 0)
                CV_Error(cv::Error::StsBadArg, "unexpected argument '" + argument + "'");
            continue;
        }
        const size_t end = std::min(argument.find('='), argument.size());
        const size_t begin = std::min(argument.find_first_not_of('-'), end);
        parser.has(argument.substr(begin, end - begin)); // throws
    }
}

//! Nothing behind the number, such as 64x
inline int integerOf(const cv::CommandLineParser& parser, const cv::String& option, int low, int high)
{
    const cv::String text = parser.get<cv::String>(option);
    char* end = nullptr;
    const long number = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != 0 || number < low || number > high)
        CV_Error(cv::Error::StsBadArg,
                 cv::format("--%s=%s: not a whole number from %d to %d", option.c_str(), text.c_str(), low, high));
    return (int)number;
}

//! Nothing behind the number, and it is not NaN
inline double numberOf(const cv::CommandLineParser& parser, const cv::String& option, double low, double high)
{
    const cv::String text = parser.get<cv::String>(option);
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != 0 || !(number >= low && number <= high))
        CV_Error(cv::Error::StsBadArg,
                 cv::format("--%s=%s: not a number from %.10g to %.10g", option.c_str(), text.c_str(), low, high));
    return number;
}

} // namespace hdp_samples

#endif
