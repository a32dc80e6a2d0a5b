// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "command_line.hpp"
#include "../arguments.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "opencv2/core/utils/logger.hpp"

namespace hdp_tools {

void fail(const String& message) { throw std::runtime_error(message); }

String lowerCase(String text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](char c) { return char(std::tolower(uchar(c))); });
    return text;
}

String messageOf(const std::exception& error)
{
    const cv::Exception* const ofOpenCV = dynamic_cast<const cv::Exception*>(&error);
    return ofOpenCV ? ofOpenCV->err : String(error.what());
}

std::vector<String> splitList(const String& option, const String& text)
{
    std::vector<String> items;
    std::istringstream in(text);
    for (String item; std::getline(in, item, ',');)
        if (!item.empty())
            items.push_back(item);
    if (items.empty())
        fail("--" + option + "=" + text + " names nothing");
    return items;
}

double getNumber(const cv::CommandLineParser& parser, const String& name, double low, double high)
{
    const String text = parser.get<String>(name);
    double value = 0;
    size_t end = 0;
    try
    {
        value = std::stod(text, &end);
    }
    catch (const std::logic_error&)
    {
        end = 0;
    }
    if (end == 0 || end != text.size() || !(value >= low && value <= high))
        fail(cv::format("--%s=%s: not a number from %g to %g", name.c_str(), text.c_str(), low, high));
    return value;
}

int getInteger(const cv::CommandLineParser& parser, const String& name, int low, int high)
{
    const double value = getNumber(parser, name, low, high);
    if (value != std::floor(value))
        fail("--" + name + "=" + parser.get<String>(name) + ": not a whole number");
    return int(value);
}

void setThreads(const cv::CommandLineParser& parser)
{
    if (parser.has("threads"))
        cv::setNumThreads(getInteger(parser, "threads", 1, 1024));
}

//! The arguments with `--set A=1 --set=B=2` as `--set=A=1,B=2`, for cv::CommandLineParser knows each option once.
static std::vector<String> joinSettings(int argc, const char* const argv[])
{
    std::vector<String> arguments;
    String settings;
    bool areThere = false;
    for (int i = 0; i < argc; i++)
    {
        String argument = argv[i];
        if (argument == "--set" && i + 1 < argc)
            argument += String("=") + argv[++i];
        if (argument.compare(0, 6, "--set=") != 0 || argument.size() == 6)
        {
            arguments.push_back(argument);
            continue;
        }
        settings += (areThere ? "," : "") + argument.substr(6);
        areThere = true;
    }
    if (areThere)
        arguments.push_back("--set=" + settings);
    return arguments;
}

int runProgram(int argc, const char* const argv[], const String& keys, const String& about,
               const std::vector<String>& flags, int maxPositional,
               const std::function<int(const cv::CommandLineParser&)>& run)
{
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    try
    {
        const std::vector<String> joined = joinSettings(argc, argv);
        std::vector<const char*> arguments;
        for (const String& argument : joined)
            arguments.push_back(argument.c_str());
        cv::CommandLineParser parser((int)arguments.size(), arguments.data(), keys);
        parser.about(about);
        std::vector<String> allFlags = flags;
        allFlags.push_back("list-tunables");
        checkArguments((int)arguments.size(), arguments.data(), parser, allFlags, maxPositional);
        int status = 0;
        if (parser.has("help"))
            parser.printMessage();
        else
            status = run(parser);
        std::cout.flush();
        if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout))
            fail("cannot write to the standard output");
        return status;
    }
    catch (const std::exception& e)
    {
        std::cerr << "error: " << messageOf(e) << std::endl;
    }
    return 1;
}

} // namespace hdp_tools
