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

typedef std::vector<TunableVariable*> Tunables;

//! By name
Tunables& allTunables()
{
    static Tunables tunables; // made by the first one, in whatever file that is
    return tunables;
}

//! "tree_planes" of "src/forest/tree_planes.cpp"
String stemOf(const String& file)
{
    const size_t slash = file.find_last_of("/\\"), begin = slash == String::npos ? 0 : slash + 1;
    return file.substr(begin, file.find('.', begin) - begin);
}

} // namespace

TunableVariable::TunableVariable(const char* file, const TunableInfo& information) : info(information)
{
    info.name = stemOf(file) + "." + info.name;
    Tunables& all = allTunables();
    const auto isBefore = [](const TunableVariable* a, const TunableVariable* b) {
        return a->info.name < b->info.name;
    };
    all.insert(std::upper_bound(all.begin(), all.end(), this, isBefore), this);
}

void setTunable(const String& name, const String& value)
{
    String names;
    for (TunableVariable* tunable : allTunables())
    {
        TunableInfo& info = tunable->info;
        names += (names.empty() ? "" : ", ") + info.name;
        if (info.name != name)
            continue;
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        const bool isValid =
            number >= info.least && number <= info.most && (!info.isWhole || number == cvFloor(number));
        if (end == value.c_str() || *end != 0 || !isValid)
            CV_Error(Error::StsBadArg, "'" + value + "' is not " + (info.isWhole ? "a whole number" : "a number") +
                                           ", which " + name + " takes (" + info.unit + ")");
        info.value = number;
        return;
    }
    CV_Error(Error::StsBadArg, "no tunable is called '" + name + "', there are: " + names);
}

std::vector<TunableInfo> listTunables()
{
    std::vector<TunableInfo> infos;
    for (const TunableVariable* tunable : allTunables())
        infos.push_back(tunable->info);
    return infos;
}

}}} // namespace cv::stereo::hdp

#endif
