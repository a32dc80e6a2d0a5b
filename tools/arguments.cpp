// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "arguments.hpp"

#include <algorithm>

using cv::String;

namespace hdp_tools {

static void fail(const String& message) { CV_Error(cv::Error::StsBadArg, message); }

String optionName(const String& argument)
{
    if (argument.size() < 2 || argument[0] != '-')
        return String();
    const size_t begin = argument[1] == '-' ? 2 : 1;
    return argument.substr(begin, std::max(argument.find('='), begin) - begin);
}

void checkArguments(int argc, const char* const argv[], const cv::CommandLineParser& parser, std::vector<String> flags,
                    int maxPositional)
{
    flags.insert(flags.end(), { "help", "h", "?" });
    int positional = 0;
    for (int i = 1; i < argc; i++)
    {
        const String argument = argv[i];
        if (argument.size() < 2 || argument[0] != '-')
        {
            if (++positional > maxPositional)
                fail("unexpected argument '" + argument + "'");
            continue;
        }
        const String option = argument.substr(0, argument.find('=')), name = optionName(argument);
        try
        {
            parser.has(name);
        }
        catch (const cv::Exception&)
        {
            fail("unknown option '" + option + "'");
        }
        if (std::find(flags.begin(), flags.end(), name + "=") != flags.end())
            continue;
        const bool isFlag = std::find(flags.begin(), flags.end(), name) != flags.end();
        if (isFlag && option != argument)
            fail("option '" + option + "' takes no value");
        if (!isFlag && option.size() + 1 >= argument.size())
            fail("option '" + option + "' needs a value: " + option + "=VALUE");
    }
}

} // namespace hdp_tools
