// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// HDPTreeMatcher behind the command line of mgm, for programs that call that one for each tile: the Ames Stereo
// Pipeline and s2p. Their sign of disparities is the opposite of OpenCV's: a left pixel (x, y) is (x + d, y) in the
// right image.

#include "hdpstereo/files.hpp"
#include "paths.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using hdp_tools::placeOf;

static const char* const usage =
    "HDPTreeMatcher behind the command line of mgm\n"
    "usage: hdpstereo-mgm [OPTION VALUE]... LEFT RIGHT OUT [COST [BACKFLOW]]\n"
    "       hdpstereo-mgm --help | --version\n"
    "LEFT, RIGHT: a rectified pair, 8 or 16 bit or grey floats, NaN = no data. OUT: NaN = no disparity.\n"
    "All maps are files of floats: .tif, .pfm, and .exr if OpenCV has it.\n"
    "A left pixel (x, y) is (x + d, y) in the right image: the sign is the opposite of OpenCV's.\n"
    "  -r MIN -R MAX    smallest and largest disparity, fractions rounded outwards; without both, or if both are nan,\n"
    "                   they are found in the pair, -30 and 30 if that fails or with -m; one alone: the other is that\n"
    "  -m FILE -M FILE  the same for each pixel, in fractions, too; no others occur. Not finite: no limit of its own\n"
    "  -s none          whole disparities; with anything else they have fractions (none)\n"
    "  -l FILE          the map before the left-right check and the removal of small regions, by a second match\n"
    "  -Rd FILE         disparities of the right image\n"
    "  -confidence_consensusL FILE, -confidence_consensusR FILE  confidence from 0 to 1\n"
    "Accepted without effect: -O -P1 -P2 -p -t -truncDist -aP1 -aP2 -aThresh -S -wl -wr -Rc -confidence_costL\n"
    "-confidence_costR -confidence_pkrL -confidence_pkrR -inputCostVolume, COST and BACKFLOW.\n"
    "Environment, as mgm has it: TESTLRRL=0: no left-right check, which leaves out what the right image hides or does\n"
    "not have; TESTLRRL_TAU=1: its threshold in whole pixels, fractions rounded up; REMOVESMALLCC=0: size of the\n"
    "smallest region; OMP_NUM_THREADS.\n"
    "Its own: HDPSTEREO_PRESET=quality: ultrafast, fast, quality or tree; HDPSTEREO_VERBOSE=1: says what has no "
    "effect.\n";

static const float none = std::numeric_limits<float>::quiet_NaN();

static void fail(const String& message) { CV_Error(Error::StsBadArg, message); }

static double toNumber(const String& name, const String& text)
{
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != 0 || !std::isfinite(number))
        fail(name + " must be a number, not '" + text + "'");
    return number;
}

static String environment(const char* name, const char* otherwise)
{
    const char* const value = std::getenv(name);
    return value && *value ? value : otherwise;
}

//! What the command line says
class Call
{
public:
    Call(int argc, char** argv)
    {
        static const char* const known[] = {
            "r", "R", "m", "M", "s", "l", "Rd", "confidence_consensusL", "confidence_consensusR"
        };
        static const char* const ignored[] = { "O",
                                               "P1",
                                               "P2",
                                               "p",
                                               "t",
                                               "truncDist",
                                               "aP1",
                                               "aP2",
                                               "aThresh",
                                               "S",
                                               "wl",
                                               "wr",
                                               "Rc",
                                               "confidence_costL",
                                               "confidence_costR",
                                               "confidence_pkrL",
                                               "confidence_pkrR",
                                               "inputCostVolume" };
        for (int i = 1; i < argc; i++)
        {
            const String word = argv[i], name = word.substr(word.empty() ? 0 : 1);
            const bool isKnown = std::find(std::begin(known), std::end(known), name) != std::end(known);
            const bool isIgnored = std::find(std::begin(ignored), std::end(ignored), name) != std::end(ignored);
            if (word.size() < 2 || word[0] != '-')
                files_.push_back(word);
            else if (!isKnown && !isIgnored)
                fail("the option " + word + " is unknown");
            else if (++i == argc)
                fail("the option " + word + " needs a value");
            else if (isKnown)
                values_[name] = argv[i];
            else
                tell(word + " has no effect");
        }
        if (files_.size() < 3 || files_.size() > 5)
            fail(files_.size() < 3 ? "LEFT, RIGHT and OUT are needed, see --help" : "there are too many files");
        for (size_t i = 3; i < files_.size(); i++)
            tell("'" + files_[i] + "' is not written");
    }

    const String& left() const { return files_[0]; }
    const String& right() const { return files_[1]; }
    const String& out() const { return files_[2]; }

    String value(const char* name, const char* otherwise = "") const
    {
        const auto found = values_.find(name);
        return found == values_.end() ? otherwise : found->second;
    }

private:
    static void tell(const String& message)
    {
        if (environment("HDPSTEREO_VERBOSE", "0") != "0")
            std::cerr << "hdpstereo-mgm: " << message << std::endl;
    }

    std::vector<String> files_;
    std::map<String, String> values_;
};

static Mat readImage(const String& path)
{
    Mat image = readImage(path, IMREAD_UNCHANGED);
    requireKnownColors(path, image);
    if (image.channels() > 1)
        cvtColor(image, image, image.channels() == 4 ? COLOR_BGRA2GRAY : COLOR_BGR2GRAY);
    if (image.depth() != CV_8U && image.depth() != CV_16U)
        image.convertTo(image, CV_32F);
    return image;
}

//! Whether a format of images keeps floats: .png and .jpg would round disparities to 0 to 255.
static bool keepsFloats(const String& path)
{
    try
    {
        const Mat read = imdecode(encode(extensionOf(path), Mat(1, 1, CV_32F, Scalar(-0.5))), IMREAD_UNCHANGED);
        return read.type() == CV_32FC1 && read.at<float>(0, 0) == -0.5f;
    }
    catch (const cv::Exception&)
    {
        return false; // there is no such format, or not in this OpenCV
    }
}

//! Leaves what is there as it is.
static void requireWritable(const String& name, const String& path)
{
    if (!keepsFloats(path))
        fail(name + " must be a file of floats, such as .tif, not '" + path + "'");
    const bool wasThere = utils::fs::exists(path);
    if (!std::ofstream(path.c_str(), std::ios::binary | std::ios::app))
        fail(name + ": cannot write '" + path + "'");
    if (!wasThere)
        std::remove(path.c_str());
}

static void writeImage(const String& path, const Mat& image)
{
    if (!path.empty())
        writeWholeFile(path, encode(extensionOf(path), image));
}

static Mat extended(const Mat& image, Size size, double value)
{
    Mat larger;
    copyMakeBorder(image, larger, 0, size.height - image.rows, 0, size.width - image.cols, BORDER_CONSTANT,
                   Scalar(value));
    return larger;
}

//! One type and one size for both; what only one of them has is no data.
static void makeAlike(Mat& left, Mat& right)
{
    if (left.type() == right.type() && left.size() == right.size())
        return;
    const Size size(std::max(left.cols, right.cols), std::max(left.rows, right.rows));
    for (Mat* image : { &left, &right })
    {
        image->convertTo(*image, CV_32F);
        *image = extended(*image, size, none);
    }
}

//! In mgm's sign
struct DisparityRange
{
    int min, max;
    bool isUnknown;
    Mat mins, maxs; // of each pixel of the left image; empty if not given
};

//! -m or -M, NaN where there is no limit
static Mat readLimits(const Call& call, const char* name, Size size)
{
    Mat limits = readImage(call.value(name));
    if (limits.size() != size)
        fail(format("-%s must have the size of LEFT, %d x %d, not %d x %d", name, size.width, size.height, limits.cols,
                    limits.rows));
    limits.convertTo(limits, CV_32F);
    limits.setTo(none, abs(limits) == std::numeric_limits<float>::infinity());
    return limits;
}

//! Maps of the matcher have no others.
static double toDisparity(const String& name, double number)
{
    const double most = SHRT_MAX / StereoMatcher::DISP_SCALE;
    if (std::abs(number) > most)
        fail(format("%s must be from %g to %g, not %g", name.c_str(), -most, most, number));
    return number;
}

//! -r or -R, if it is there and not nan
static String limitOf(const Call& call, const char* name)
{
    const String text = call.value(name);
    return text == "nan" || text == "NaN" ? String() : text;
}

//! -m and -M, where these are no numbers -r and -R, or the other one if that is beyond; and the range of all
static void readPixelRanges(const Call& call, Size size, DisparityRange& range)
{
    range.mins = readLimits(call, "m", size);
    range.maxs = readLimits(call, "M", size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
        {
            float &least = range.mins.at<float>(y, x), &most = range.maxs.at<float>(y, x);
            if (least > most)
                fail(format("-m must be nowhere above -M, but at (%d, %d) they are %g and %g", x, y, least, most));
            if (cvIsNaN(least))
                least = cvIsNaN(most) ? (float)range.min : std::min((float)range.min, most);
            if (cvIsNaN(most))
                most = std::max((float)range.max, least);
        }
    double lowest, highest;
    minMaxLoc(range.mins, &lowest, nullptr);
    minMaxLoc(range.maxs, nullptr, &highest);
    range.min = cvFloor(toDisparity("-m", lowest));
    range.max = cvCeil(toDisparity("-M", highest));
}

static DisparityRange readRange(const Call& call, Size size)
{
    const String least = limitOf(call, "r"), most = limitOf(call, "R");
    DisparityRange range = { least.empty() ? -30 : cvFloor(toDisparity("-r", toNumber("-r", least))),
                             most.empty() ? 30 : cvCeil(toDisparity("-R", toNumber("-R", most))),
                             least.empty() && most.empty() && call.value("m").empty(), Mat(), Mat() };
    if (range.max < range.min)
        fail(format("-R (%d) must not be less than -r (%d); without, they are 30 and -30", range.max, range.min));
    if (call.value("m").empty() != call.value("M").empty())
        fail("-m and -M need each other");
    if (!call.value("m").empty())
        readPixelRanges(call, size, range);
    return range;
}

static int presetOf(const String& name)
{
    static const std::map<String, int> presets = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                                                   { "fast", HDPTreeMatcher::PRESET_FAST },
                                                   { "quality", HDPTreeMatcher::PRESET_QUALITY },
                                                   { "tree", HDPTreeMatcher::PRESET_TREE } };
    const auto preset = presets.find(name);
    if (preset == presets.end())
        fail("HDPSTEREO_PRESET must be ultrafast, fast, quality or tree, not '" + name + "'");
    return preset->second;
}

static Ptr<HDPTreeMatcher> createMatcher(const Call& call)
{
    const Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(0, 64, presetOf(environment("HDPSTEREO_PRESET", "quality")));
    HDPTreeMatcher::Params params = matcher->getParams();
    params.useSubpixel = call.value("s", "none") != "none";
    params.disparityDepth = CV_32F;
    matcher->setParams(params);
    return matcher;
}

//! What the right image does not have: mgm's left-right check looks where it ends, at the nearest pixel. Where its data
//! end is no different.
static void rejectOutside(const Mat& right, Mat& disparity)
{
    const Mat zeros = right - right, hasData = zeros == 0; // NaN and infinity leave NaN
    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++)
        {
            float& value = disparity.at<float>(y, x);
            const float column = std::round((float)x - value);
            if (!(column >= 0 && column < (float)right.cols && hasData.at<uchar>(y, (int)column)))
                value = none;
        }
}

//! Disparities of OpenCV's sign, NaN where there is none, and the confidence from 0 to 1
static void match(HDPTreeMatcher& matcher, const Mat& left, const Mat& right, Mat& disparity, Mat& confidence)
{
    disparity.release();
    matcher.compute(left, right, disparity);
    matcher.getConfidence(confidence);
    disparity.setTo(none, disparity < matcher.getFindings().minDisparity);
    if (matcher.getDisp12MaxDiff() > 0)
        rejectOutside(right, disparity);
    confidence.convertTo(confidence, CV_32F, 1. / 255);
    confidence.setTo(0, ~(disparity == disparity)); // OpenCV may have NaN != NaN false
}

//! -r and -R, or what is found in the pair
static void takeRange(const DisparityRange& range, const Mat& left, const Mat& right, HDPTreeMatcher& matcher)
{
    matcher.setMinDisparity(-range.max);
    matcher.setNumDisparities(range.max - range.min + 1);
    if (!range.isUnknown)
        return;
    const Ptr<HDPTreeMatcher> coarse = HDPTreeMatcher::create(0, 0, HDPTreeMatcher::PRESET_ULTRAFAST);
    Mat disparity;
    try
    {
        coarse->compute(left, right, disparity);
    }
    catch (const cv::Exception&)
    {
        return; // too few points match, as on water: the caller expects a map nevertheless
    }
    const HDPTreeMatcher::Findings found = coarse->getFindings();
    matcher.setMinDisparity(found.minDisparity);
    matcher.setNumDisparities(found.numDisparities);
}

//! How maps are filtered
struct Filters
{
    bool isChecked; // left against right
    int maxDifference, smallestRegion;
};

static double numberInEnvironment(const char* name, const char* otherwise)
{
    return toNumber(name, environment(name, otherwise));
}

static Filters readFilters()
{
    // A check that accepts no difference at all would be none for the matcher.
    const double difference = std::max(numberInEnvironment("TESTLRRL_TAU", "1"), 1.);
    return { numberInEnvironment("TESTLRRL", "1") != 0, cvCeil(std::min(difference, (double)SHRT_MAX)),
             cvRound(numberInEnvironment("REMOVESMALLCC", "0")) };
}

//! All of them can be written, and each is a file of its own.
static void checkOutputs(const Call& call)
{
    std::map<String, String> names; // of files
    names[placeOf(call.left())] = "LEFT";
    names[placeOf(call.right())] = "RIGHT";
    for (const char* name : { "m", "M" })
        if (!call.value(name).empty())
            names[placeOf(call.value(name))] = String("the file of -") + name;
    const auto check = [&](const String& name, const String& path) {
        const auto other = names.find(placeOf(path));
        if (other != names.end())
            fail(name + ": cannot write '" + path + "': it is " + other->second);
        requireWritable(name, path);
        names[placeOf(path)] = name;
    };
    check("OUT", call.out());
    for (const char* name : { "l", "Rd", "confidence_consensusL", "confidence_consensusR" })
        if (!call.value(name).empty())
            check(String("-") + name, call.value(name));
}

static void run(const Call& call)
{
    const Filters filters = readFilters();
    const Ptr<HDPTreeMatcher> matcher = createMatcher(call);
    checkOutputs(call);
    Mat left = readImage(call.left()), right = readImage(call.right());
    const Rect leftImage(Point(), left.size()), rightImage(Point(), right.size());
    const DisparityRange range = readRange(call, left.size());
    makeAlike(left, right);
    takeRange(range, left, right, *matcher);
    if (!range.mins.empty())
        matcher->setDisparityRange(extended(-range.maxs, left.size(), none), extended(-range.mins, left.size(), none));
    Mat disparity, confidence;
    if (!call.value("l").empty())
    {
        match(*matcher, left, right, disparity, confidence);
        writeImage(call.value("l"), -disparity(leftImage));
    }
    if (filters.isChecked)
        matcher->setDisp12MaxDiff(filters.maxDifference);
    matcher->setSpeckleWindowSize(filters.smallestRegion);
    matcher->setSpeckleRange(1);
    match(*matcher, left, right, disparity, confidence);
    writeImage(call.out(), -disparity(leftImage));
    writeImage(call.value("confidence_consensusL"), confidence(leftImage));
    if (call.value("Rd").empty() && call.value("confidence_consensusR").empty())
        return;

    // The right image is the left one of a scene that is mirrored; -m and -M are not about its pixels.
    matcher->setDisparityRange(noArray(), noArray());
    Mat mirroredLeft, mirroredRight;
    flip(right, mirroredLeft, 1);
    flip(left, mirroredRight, 1);
    match(*matcher, mirroredLeft, mirroredRight, disparity, confidence);
    flip(disparity, disparity, 1);
    flip(confidence, confidence, 1);
    writeImage(call.value("Rd"), disparity(rightImage));
    writeImage(call.value("confidence_consensusR"), confidence(rightImage));
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    const String only = argc == 2 ? argv[1] : "";
    if (only == "--help" || only == "-h")
        return std::cout << usage << std::flush ? 0 : 1;
    if (only == "--version")
        return std::cout << "hdpstereo-mgm " << HDPSTEREO_VERSION << std::endl ? 0 : 1;
    try
    {
        const String threads = environment("OMP_NUM_THREADS", "");
        if (!threads.empty())
            setNumThreads(std::max(cvRound(toNumber("OMP_NUM_THREADS", threads)), 1));
        run(Call(argc, argv));
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return 0;
}
