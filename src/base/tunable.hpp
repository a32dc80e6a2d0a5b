// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TUNABLE_HPP
#define OPENCV_HDPSTEREO_TUNABLE_HPP

/** A constant at the top of a stage's file whose value was found by trying:

    HDP_TUNABLE(int, minPixels, 400, "pixels", "smaller trees have too few samples for a plane");

It is a const of the language; unit and reason are for those who read it. Built with HDPSTEREO_TUNABLE, which is for the
developers' tools alone, it is a variable that `--set FILE.NAME=VALUE` changes without a rebuild. FILE is the name of
the file without its extension.

The type is int, bool, float or double. Not for *.simd.hpp: those get values as arguments. Not where the compiler needs
a value, such as the size of an array. */
#ifndef HDPSTEREO_TUNABLE
#define HDP_TUNABLE(type, name, value, unit, reason) const type name = value
#else
#define HDP_TUNABLE(type, name, value, unit, reason)                                                                   \
    const ::cv::stereo::hdp::Tunable<type> name(__FILE__, #name, value, unit, reason)

#include "opencv2/core.hpp"

#include <limits>
#include <vector>

namespace cv { namespace stereo { namespace hdp {

//! What is known of a tunable
struct TunableInfo
{
    String name; // "tree_planes.minPixels"
    double value, initial;
    bool isWhole;
    double least, most; // that its type can have
    String unit, reason;
};

/** Sets a tunable for all matchers, whenever they were made. Reads are not synchronised: not while one computes.

Throws an exception that lists all names if there is none of this name, and one that says what is expected if the value
is none of its type. Whether the stage can do with the value is not checked. */
CV_EXPORTS void setTunable(const String& name, const String& value);

//! All tunables, by name
CV_EXPORTS std::vector<TunableInfo> listTunables();

//! Lists a tunable by its name from now on, and forever: it is a global variable.
void addTunable(const char* file, TunableInfo& info);

template <typename T> class Tunable final
{
public:
    typedef std::numeric_limits<T> Limits;

    Tunable(const char* file, const char* name, T value, const char* unit, const char* reason)
        : info_({ name, (double)value, (double)value, Limits::is_integer, (double)Limits::lowest(),
                  (double)Limits::max(), unit, reason })
    {
        addTunable(file, info_);
    }

    operator T() const { return (T)info_.value; }

private:
    TunableInfo info_;
};

}}} // namespace cv::stereo::hdp

#endif // HDPSTEREO_TUNABLE

#endif
