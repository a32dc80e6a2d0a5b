// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tunable.hpp"

#ifdef HDPSTEREO_TUNABLE

#include <algorithm>
#include <cstdlib>

namespace cv { namespace stereo { namespace hdp {

namespace {

//! By name
std::vector<TunableInfo*>& allTunables()
{
    static std::vector<TunableInfo*> tunables; // made by the first one, in whatever file that is
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
    std::vector<TunableInfo*>& all = allTunables();
    const auto isBefore = [](const TunableInfo* a, const TunableInfo* b) { return a->name < b->name; };
    all.insert(std::upper_bound(all.begin(), all.end(), &info, isBefore), &info);
}

void setTunable(const String& name, const String& value)
{
    String names;
    for (TunableInfo* info : allTunables())
    {
        names += (names.empty() ? "" : ", ") + info->name;
        if (info->name != name)
            continue;
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        const bool isValid =
            number >= info->least && number <= info->most && (!info->isWhole || number == cvFloor(number));
        if (end == value.c_str() || *end != 0 || !isValid)
            CV_Error(Error::StsBadArg, "'" + value + "' is not " + (info->isWhole ? "a whole number" : "a number") +
                                           ", which " + name + " takes (" + info->unit + ")");
        info->value = number;
        return;
    }
    CV_Error(Error::StsBadArg, "no tunable is called '" + name + "', there are: " + names);
}

std::vector<TunableInfo> listTunables()
{
    std::vector<TunableInfo> infos;
    for (const TunableInfo* info : allTunables())
        infos.push_back(*info);
    return infos;
}

}}} // namespace cv::stereo::hdp

#endif
