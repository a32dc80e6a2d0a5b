// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tunable.hpp"

#ifdef HDPSTEREO_TUNABLE

#include <cstdlib>
#include <map>

namespace cv { namespace stereo { namespace hdp {

namespace {

std::map<String, TunableInfo*>& allTunables()
{
    static std::map<String, TunableInfo*> tunables; // made by the first one, in whatever file that is
    return tunables;
}

//! "tree_planes" of "src/forest/tree_planes.cpp"
String stemOf(const String& file)
{
    const size_t slash = file.find_last_of("/\\"), begin = slash == String::npos ? 0 : slash + 1;
    return file.substr(begin, file.find('.', begin) - begin);
}

} // namespace

void addTunable(const char* file, TunableInfo& info)
{
    info.name = stemOf(file) + "." + info.name;
    allTunables()[info.name] = &info;
}

void setTunable(const String& name, const String& value)
{
    const auto found = allTunables().find(name);
    if (found == allTunables().end())
    {
        String names;
        for (const auto& tunable : allTunables())
            names += (names.empty() ? "" : ", ") + tunable.first;
        CV_Error(Error::StsBadArg, "no tunable is called '" + name + "', there are: " + names);
    }
    TunableInfo& info = *found->second;
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    const bool isValid = number >= info.least && number <= info.most && (!info.isWhole || number == cvFloor(number));
    if (end == value.c_str() || *end != 0 || !isValid)
        CV_Error(Error::StsBadArg, "'" + value + "' is not " + (info.isWhole ? "a whole number" : "a number") +
                                       ", which " + name + " takes (" + info.unit + ")");
    info.value = number;
}

std::vector<TunableInfo> listTunables()
{
    std::vector<TunableInfo> infos;
    for (const auto& tunable : allTunables())
        infos.push_back(*tunable.second);
    return infos;
}

}}} // namespace cv::stereo::hdp

#endif
