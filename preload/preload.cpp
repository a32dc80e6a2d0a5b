// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What hdpstereo-run preloads: cv::StereoSGBM::create() and cv::StereoBM::create(), which the dynamic linker takes in
// place of OpenCV's. They call OpenCV's own, and put an adapter of libhdpstereo_adapters.so around its matcher.
//
// This library is loaded into all that the program starts, so it is not linked to OpenCV: that OpenCV's functions would
// come before those of the program's own. The adapters are linked to it. They are loaded when a matcher is created, if
// the program's OpenCV is the one they were built for. If not, the program gets the matcher that it asked for.

#include "stereo_adapters.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <errno.h>
#include <stdexcept>
#include <string>

namespace {

using namespace cv;
using cv::stereo::HDPTreeMatcher;

//! A class of OpenCV whose create() this library defines
template <class Matcher> struct Replaced
{
    const char* name;
    const char* word;   // in HDPSTEREO_REPLACE
    const char* symbol; // of create()
    const char* adapt;  // the adapters' function for it
};

const Replaced<StereoSGBM> sgbm = { "cv::StereoSGBM", "sgbm", "_ZN2cv10StereoSGBM6createEiiiiiiiiiii",
                                    "hdpstereoAdaptSGBM" };
const Replaced<StereoBM> bm = { "cv::StereoBM", "bm", "_ZN2cv8StereoBM6createEii", "hdpstereoAdaptBM" };

//! Why a matcher is not replaced
struct Refusal : std::runtime_error
{
    explicit Refusal(const std::string& reason) : std::runtime_error(reason) {}
};

std::atomic_flag saidRefusal = ATOMIC_FLAG_INIT;

//! A line on stderr, once. said: whether it was.
void sayOnce(std::atomic_flag& said, const std::string& message)
{
    if (!said.test_and_set())
        std::fprintf(stderr, "hdpstereo: %s\n", message.c_str());
}

//! The value of a variable of the environment, or what to take if there is none or an empty one
std::string environment(const char* name, const char* otherwise)
{
    const char* const value = std::getenv(name);
    return value && *value ? value : otherwise;
}

//! Whether HDPSTEREO_REPLACE, a list such as "bm,sgbm", has the word
bool isToBeReplaced(const std::string& word)
{
    const std::string list = environment("HDPSTEREO_REPLACE", "sgbm");
    bool isListed = false;
    for (size_t begin = 0; begin <= list.size();)
    {
        const size_t end = std::min(list.find(',', begin), list.size());
        const std::string listed = list.substr(begin, end - begin);
        if (listed != sgbm.word && listed != bm.word)
            throw Refusal("HDPSTEREO_REPLACE must be sgbm, bm or bm,sgbm, not " + list);
        isListed = isListed || listed == word;
        begin = end + 1;
    }
    return isListed;
}

//! HDPSTEREO_PRESET as a preset of HDPTreeMatcher
int presetOf(const std::string& name)
{
    static const struct
    {
        const char* name;
        HDPTreeMatcher::Preset preset;
    } presets[] = { { "paper", HDPTreeMatcher::PRESET_PAPER },
                    { "fast", HDPTreeMatcher::PRESET_FAST },
                    { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                    { "quality", HDPTreeMatcher::PRESET_QUALITY },
                    { "tree", HDPTreeMatcher::PRESET_TREE } };
    for (const auto& known : presets)
        if (name == known.name)
            return known.preset;
    throw Refusal("HDPSTEREO_PRESET must be paper, fast, ultrafast, quality or tree, not " + name);
}

//! The file that an address is in; empty if there is none
std::string fileOf(const void* address)
{
    Dl_info info;
    return dladdr(address, &info) && info.dli_fname ? info.dli_fname : "";
}

//! A library of the process, by its file or its soname; nothing is loaded.
class LoadedLibrary
{
public:
    explicit LoadedLibrary(const std::string& name)
        : handle_(name.empty() ? nullptr : dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD))
    {
    }
    ~LoadedLibrary()
    {
        if (handle_)
            dlclose(handle_);
    }
    LoadedLibrary(const LoadedLibrary&) = delete;
    LoadedLibrary& operator=(const LoadedLibrary&) = delete;

    //! In it and in the libraries it is linked to; null if there is none.
    void* symbol(const char* name) const { return handle_ ? dlsym(handle_, name) : nullptr; }

private:
    void* const handle_;
};

//! OpenCV's own create(), as the caller would have it without this library
void* findOwn(const char* symbol, const void* caller)
{
    // What Python or GStreamer loads has libraries of its own, where RTLD_NEXT does not look.
    void* const own = LoadedLibrary(fileOf(caller)).symbol(symbol);
    static const int here = 0;
    return own && fileOf(own) != fileOf(&here) ? own : dlsym(RTLD_NEXT, symbol);
}

//! Throws unless create() is of the OpenCV that the adapters are linked to.
void checkVersion(const void* create)
{
    const std::string file = fileOf(create);
    const LoadedLibrary theirs(file), ours(HDPSTEREO_OPENCV_CORE);
    const auto version = [&](const char* symbol) { // of cv::getVersionMajor() or cv::getVersionMinor()
        void* const function = theirs.symbol(symbol);
        return function && function == ours.symbol(symbol) ? reinterpret_cast<int (*)()>(function)() : -1;
    };
    if (version("_ZN2cv15getVersionMajorEv") != CV_VERSION_MAJOR ||
        version("_ZN2cv15getVersionMinorEv") != CV_VERSION_MINOR)
        throw Refusal(file + " is not of OpenCV " + std::to_string(CV_VERSION_MAJOR) + "." +
                      std::to_string(CV_VERSION_MINOR) + " with " + HDPSTEREO_OPENCV_CORE);
}

//! A function of the adapters, which stay loaded
void* findAdapt(const char* symbol)
{
    static const int here = 0;
    const std::string file = fileOf(&here);
    const std::string adapters = file.substr(0, file.rfind('/') + 1) + HDPSTEREO_ADAPTERS;
    void* const library = dlopen(adapters.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = library ? dlsym(library, symbol) : nullptr;
    if (!function)
        throw Refusal(dlerror());
    return function;
}

//! The matcher that the program gets: that of OpenCV's own create(), behind which is HDPTreeMatcher if all is well.
template <class Matcher, typename... Arguments>
Ptr<Matcher> create(const Replaced<Matcher>& replaced, const void* caller, Arguments... arguments)
{
    static std::atomic_flag saidReplaced = ATOMIC_FLAG_INIT;
    void* const own = findOwn(replaced.symbol, caller);
    if (!own)
        throw std::runtime_error(std::string("hdpstereo: there is no ") + replaced.name + "::create() of OpenCV");
    Ptr<Matcher> matcher = reinterpret_cast<Ptr<Matcher> (*)(Arguments...)>(own)(arguments...);
    try
    {
        if (!isToBeReplaced(replaced.word))
            return matcher;
        const std::string preset = environment("HDPSTEREO_PRESET", "fast");
        const int number = presetOf(preset);
        checkVersion(own);
        reinterpret_cast<void (*)(Ptr<Matcher>&, int)>(findAdapt(replaced.adapt))(matcher, number);
        if (environment("HDPSTEREO_VERBOSE", "0") != "0")
            sayOnce(saidReplaced, std::string(replaced.name) + " is replaced by HDPTreeMatcher, preset " + preset +
                                      ", in " + program_invocation_short_name);
    }
    catch (const Refusal& refusal)
    {
        sayOnce(saidRefusal, std::string(refusal.what()) + "; the program keeps the matchers of its OpenCV");
    }
    return matcher;
}

} // namespace

namespace cv {

Ptr<StereoSGBM> StereoSGBM::create(int minDisparity, int numDisparities, int blockSize, int P1, int P2,
                                   int disp12MaxDiff, int preFilterCap, int uniquenessRatio, int speckleWindowSize,
                                   int speckleRange, int mode)
{
    return ::create(sgbm, __builtin_return_address(0), minDisparity, numDisparities, blockSize, P1, P2, disp12MaxDiff,
                    preFilterCap, uniquenessRatio, speckleWindowSize, speckleRange, mode);
}

Ptr<StereoBM> StereoBM::create(int numDisparities, int blockSize)
{
    return ::create(bm, __builtin_return_address(0), numDisparities, blockSize);
}

} // namespace cv
