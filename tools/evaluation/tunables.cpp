// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "tunables.hpp"

#include <cmath>
#include <iostream>
#include <sstream>

#include "command_line.hpp"
#include "../../src/base/tunable.hpp"

namespace hdp_tools {

const char* const TUNABLE_KEYS =
    "{set             |     | NAME=VALUE, a tuned constant of the library; may be given several times, or as a list "
    "that "
    "is separated by commas; for a library that was built with HDPSTEREO_TUNABLE }"
    "{list-tunables   |     | print the names of these constants, their values, units and reasons, and exit }";

TunableSetting parseSetting(const String& option, const String& text)
{
    const size_t equals = text.find('=');
    if (equals == String::npos || equals == 0 || equals + 1 == text.size())
        fail("--" + option + " " + text + ": not NAME=VALUE");
    return { text.substr(0, equals), text.substr(equals + 1) };
}

#ifdef HDPSTEREO_TUNABLE

//! As many digits as are needed to read it
static String toText(double value)
{
    std::ostringstream out;
    out.precision(17);
    for (int digits = 6; digits < 17; ++digits)
        if (std::stod(cv::format("%.*g", digits, value)) == value)
            return cv::format("%.*g", digits, value);
    out << value;
    return out.str();
}

static cv::stereo::hdp::TunableInfo find(const String& name)
{
    for (const cv::stereo::hdp::TunableInfo& info : cv::stereo::hdp::listTunables())
        if (info.name == name)
            return info;
    cv::stereo::hdp::setTunable(name, "0"); // says which names there are
    return cv::stereo::hdp::TunableInfo();
}

TunableSetting applySetting(const TunableSetting& setting)
{
    const TunableSetting before = { setting.name, toText(find(setting.name).value) };
    cv::stereo::hdp::setTunable(setting.name, setting.value);
    return before;
}

std::vector<TunableSetting> parseSweep(const String& option, const String& list)
{
    std::vector<TunableSetting> settings;
    for (const String& item : splitList(option, list))
    {
        if (item.find('=') == String::npos)
        {
            const cv::stereo::hdp::TunableInfo info = find(item);
            const double value = info.value;
            settings.push_back({ item, toText(info.isWhole ? std::floor(value / 2) : value / 2) });
            settings.push_back({ item, toText(value * 2) });
            continue;
        }
        const TunableSetting values = parseSetting(option, item);
        std::istringstream in(values.value);
        for (String value; std::getline(in, value, ':');)
            settings.push_back({ values.name, value });
    }
    for (const TunableSetting& setting : settings)
        applySetting(applySetting(setting)); // a wrong one is found before hours of work
    return settings;
}

static void printAll()
{
    for (const cv::stereo::hdp::TunableInfo& info : cv::stereo::hdp::listTunables())
        std::cout << info.name << " = " << toText(info.value)
                  << (info.value == info.initial ? String() : " (built with " + toText(info.initial) + ")") << " ["
                  << info.unit << "] " << info.reason << "\n";
}

#else

static void failWithout(const String& option)
{
    fail("--" + option +
         " needs a library that was built with HDPSTEREO_TUNABLE (the preset tune), and this one was not");
}

TunableSetting applySetting(const TunableSetting& setting)
{
    failWithout("set");
    return setting;
}

std::vector<TunableSetting> parseSweep(const String& option, const String&)
{
    failWithout(option);
    return std::vector<TunableSetting>();
}

static void printAll() { failWithout("list-tunables"); }

#endif

bool useTunables(const cv::CommandLineParser& parser)
{
    String text;
    for (const String& item : parser.has("set") ? splitList("set", parser.get<String>("set")) : std::vector<String>())
    {
        const TunableSetting setting = parseSetting("set", item), before = applySetting(setting);
        text += (text.empty() ? "With " : ", ") + setting.name + " = " + setting.value + " (was " + before.value + ")";
    }
    if (parser.has("list-tunables"))
    {
        printAll();
        return true;
    }
    std::cout << text << (text.empty() ? "" : "\n\n");
    return false;
}

} // namespace hdp_tools
