// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What the samples share: command line checks, disparity and point cloud files, masks and errors, pictures.
//
// A disparity map is a CV_32FC1 Mat here, in pixels; NO_DISPARITY marks pixels that have none.

#ifndef OPENCV_HDPSTEREO_SAMPLES_COMMON_HPP
#define OPENCV_HDPSTEREO_SAMPLES_COMMON_HPP

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/hdpstereo.hpp"

namespace hdp_samples {

using cv::Mat;
using cv::String;

const float NO_DISPARITY = std::numeric_limits<float>::infinity();

inline void fail(const String& message) { throw std::runtime_error(message); }

inline Mat knownPixels(const Mat& disparity) { return disparity < NO_DISPARITY; }

// ---- Command line

//! Refuses what cv::CommandLineParser ignores: unknown options, options without their value ("--output FILE"),
//! flags with a value, and more positional arguments than declared.
inline void checkArguments(int argc, const char* const argv[], const cv::CommandLineParser& parser,
                           const std::vector<String>& flags, int maxPositional)
{
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
        const String option = argument.substr(0, argument.find('='));
        const String name = option.substr(option.compare(0, 2, "--") == 0 ? 2 : 1);
        try
        {
            parser.has(name);
        }
        catch (const cv::Exception&)
        {
            fail("unknown option '" + option + "'");
        }
        const bool isFlag = std::find(flags.begin(), flags.end(), name) != flags.end();
        if (isFlag && option != argument)
            fail("option '" + option + "' takes no value");
        if (!isFlag && option.size() + 1 >= argument.size())
            fail("option '" + option + "' needs a value: " + option + "=VALUE");
    }
}

//! The number given for an option, all of it a number within [low, high].
inline double getNumber(const cv::CommandLineParser& parser, const String& name, double low, double high)
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

//! As getNumber() for whole numbers.
inline int getInteger(const cv::CommandLineParser& parser, const String& name, int low, int high)
{
    const double value = getNumber(parser, name, low, high);
    if (value != std::floor(value))
        fail("--" + name + "=" + parser.get<String>(name) + ": not a whole number");
    return int(value);
}

inline String lowerCase(String text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](char c) { return char(std::tolower(uchar(c))); });
    return text;
}

inline String upperCase(String text)
{
    for (char& letter : text)
        letter = (char)std::toupper((unsigned char)letter);
    return text;
}

//! The module's trees, by the names that the samples know them by.
const char* const TREES[] = { "mst", "st", "rt" };

inline cv::Ptr<cv::stereo::TreeStrategy> createTree(const String& name)
{
    if (name == TREES[0])
        return cv::stereo::createMinimumSpanningTree();
    if (name == TREES[1])
        return cv::stereo::createSegmentTree();
    if (name != TREES[2])
        fail("--tree=" + name + ": unknown, there are: mst, st, rt");
    return cv::stereo::createRandomTree();
}

//! The module's presets, by the names that the samples know them by.
struct Preset
{
    const char* name;
    int value;
};
const Preset PRESETS[] = { { "ultrafast", cv::stereo::HDPTreeMatcher::PRESET_ULTRAFAST },
                           { "fast", cv::stereo::HDPTreeMatcher::PRESET_FAST },
                           { "quality", cv::stereo::HDPTreeMatcher::PRESET_QUALITY },
                           { "tree", cv::stereo::HDPTreeMatcher::PRESET_TREE },
                           { "paper", cv::stereo::HDPTreeMatcher::PRESET_PAPER } };

inline int getPreset(const cv::CommandLineParser& parser, const String& option)
{
    const String name = parser.get<String>(option);
    String names;
    for (const Preset& preset : PRESETS)
    {
        if (name == preset.name)
            return preset.value;
        names += (names.empty() ? "" : ", ") + String(preset.name);
    }
    fail("--" + option + "=" + name + ": unknown, there are: " + names);
    return -1;
}

//! The range that --min-disparity and --num-disparities give; by default a fifth of the width.
inline cv::Range getDisparities(const cv::CommandLineParser& parser, cv::Size size)
{
    const int limit = 1 << 15; // the matchers themselves are stricter
    const int minDisparity = getInteger(parser, "min-disparity", -limit, limit);
    const int numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, limit)
                                                             : std::max(int(cv::alignSize(size.width / 5, 16)), 16);
    return cv::Range(minDisparity, minDisparity + numDisparities);
}

//! main() of a sample: its exit status. Errors are reported in one line.
inline int runSample(int argc, char** argv, const String& keys, const String& about, const std::vector<String>& flags,
                     int maxPositional, const std::function<void(const cv::CommandLineParser&)>& run)
{
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    try
    {
        cv::CommandLineParser parser(argc, argv, keys);
        parser.about(about);
        checkArguments(argc, argv, parser, flags, maxPositional);
        if (parser.has("help"))
            parser.printMessage();
        else
            run(parser);
        return 0;
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
    }
    catch (const std::exception& e)
    {
        std::cerr << "error: " << e.what() << std::endl;
    }
    return 1;
}

// ---- Files

inline bool hasExtension(const String& path, const String& extension)
{
    const size_t dot = path.rfind('.');
    String end = dot == String::npos ? String() : path.substr(dot);
    std::transform(end.begin(), end.end(), end.begin(), [](char c) { return char(std::tolower(uchar(c))); });
    return end == extension;
}

inline Mat readImage(const String& path, int flags)
{
    Mat image;
    try
    {
        image = cv::imread(path, flags);
    }
    catch (const cv::Exception&)
    {
    }
    if (image.empty())
        fail("cannot read the image '" + path + "'");
    return image;
}

inline void writeImage(const String& path, const Mat& image)
{
    bool written = false;
    try
    {
        written = cv::imwrite(path, image);
    }
    catch (const cv::Exception&)
    {
    }
    if (!written)
        fail("cannot write '" + path + "'");
}

//! The disparity map of an image read from the path: 8 bit (disparity * 1), 16 bit (disparity * 256), both with 0 where
//! there is no disparity, or PFM (not finite where there is none). A scale other than 0 takes the place of 1 and 256.
inline Mat toDisparity(const Mat& image, const String& path, double scale = 0)
{
    if (image.channels() != 1)
        fail("'" + path + "' is a color image, not a disparity map");
    const bool isFloat = image.depth() == CV_32F;
    if (scale == 0)
        scale = image.depth() == CV_16U ? 256 : 1;

    Mat disparity;
    image.convertTo(disparity, CV_32F);
    disparity /= scale; // not a factor of 1 / scale, which rounds differently
    const Mat known = isFloat ? Mat(cv::abs(image) <= std::numeric_limits<float>::max()) : Mat(image != 0);
    disparity.setTo(NO_DISPARITY, ~known);
    return disparity;
}

inline Mat readDisparity(const String& path, double scale = 0)
{
    return toDisparity(readImage(path, cv::IMREAD_UNCHANGED), path, scale);
}

//! The rectified pair given as @left and @right, CV_8UC3.
inline void readPair(const cv::CommandLineParser& parser, Mat& left, Mat& right)
{
    if (!parser.has("@left") || !parser.has("@right"))
        fail("a left and a right image are needed, see --help");
    left = readImage(parser.get<String>("@left"), cv::IMREAD_COLOR);
    right = readImage(parser.get<String>("@right"), cv::IMREAD_COLOR);
    if (left.size() != right.size())
        fail(
            cv::format("the images differ in size: %d x %d and %d x %d", left.cols, left.rows, right.cols, right.rows));
}

//! Writes FILE.pfm (NO_DISPARITY is infinity) or a 16-bit FILE.png: disparity * 256, where 0 means no disparity, so
//! that a disparity of 0 is written as 1. Returns how many disparities a PNG cannot hold: those below 0 or from 256
//! on. They are written as none.
inline int writeDisparity(const String& path, const Mat& disparity)
{
    if (hasExtension(path, ".pfm"))
    {
        writeImage(path, disparity);
        // cv::imwrite does not notice a full disk here.
        std::ifstream file(path.c_str(), std::ios::binary | std::ios::ate);
        if (file.tellg() < std::streamoff(disparity.total() * sizeof(float)))
            fail("cannot write '" + path + "'");
        return 0;
    }
    const Mat fits = (disparity >= 0) & (disparity < 256);
    Mat fitting = disparity.clone(), image;
    fitting.setTo(0, ~fits);
    fitting.convertTo(image, CV_16U, 256);
    image.setTo(1, fits & (image == 0));
    writeImage(path, image);
    return cv::countNonZero(knownPixels(disparity)) - cv::countNonZero(fits);
}

//! Writes the pixels that have a disparity, in the colors of the CV_8UC3 image, as a binary PLY file. Returns how many.
inline int writePointCloud(const String& path, const Mat& disparity, const Mat& image, const cv::Matx44d& Q)
{
    Mat points, depth;
    cv::reprojectImageTo3D(disparity, points, Q);
    cv::extractChannel(points, depth, 2);
    const Mat finite = knownPixels(disparity) & (cv::abs(depth) < std::numeric_limits<float>::max());
    const int count = cv::countNonZero(finite);

    const uint16_t one = 1;
    const bool littleEndian = *reinterpret_cast<const uchar*>(&one) == 1;
    std::ofstream file(path.c_str(), std::ios::binary);
    file << "ply\nformat binary_" << (littleEndian ? "little" : "big") << "_endian 1.0\nelement vertex " << count
         << "\nproperty float x\nproperty float y\nproperty float z"
         << "\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    for (int y = 0; y < points.rows; y++)
    {
        for (int x = 0; x < points.cols; x++)
        {
            const cv::Vec3b bgr = image.at<cv::Vec3b>(y, x), rgb(bgr[2], bgr[1], bgr[0]);
            if (finite.at<uchar>(y, x))
            {
                file.write(points.ptr<char>(y, x), sizeof(cv::Vec3f));
                file.write(reinterpret_cast<const char*>(rgb.val), sizeof(rgb.val));
            }
        }
    }
    file.close();
    if (!file)
        fail("cannot write '" + path + "'");
    return count;
}

//! The map that a cv::StereoMatcher computed, in pixels.
inline Mat toPixels(const Mat& disparity16, int minDisparity)
{
    Mat disparity;
    disparity16.convertTo(disparity, CV_32F, 1.0 / 16);
    disparity.setTo(NO_DISPARITY, disparity < minDisparity);
    return disparity;
}

//! How many disparities to search in a pair that nothing is known of
inline int defaultNumDisparities(int width) { return std::max(int(cv::alignSize(width / 5, 16)), 16); }

// ---- Errors

//! Pixels of known truth that the right image shows too: those where the right truth, at x - floor(d), is equal, or
//! differs by no more than the tolerance.
inline Mat nonOccludedPixels(const Mat& truth, const Mat& rightTruth, double tolerance = 0)
{
    Mat mask = Mat::zeros(truth.size(), CV_8U);
    for (int y = 0; y < truth.rows; y++)
    {
        for (int x = 0; x < truth.cols; x++)
        {
            const float d = truth.at<float>(y, x);
            const float xr = d < NO_DISPARITY ? float(x) - std::floor(d) : -1.f;
            if (xr >= 0 && xr < float(truth.cols) && std::abs(rightTruth.at<float>(y, int(xr)) - d) <= tolerance)
                mask.at<uchar>(y, x) = 255;
        }
    }
    return mask;
}

//! Pixels of the mask whose error is at least the threshold, or that have no disparity.
inline Mat wrongPixels(const Mat& disparity, const Mat& truth, const Mat& mask, double threshold)
{
    Mat error;
    cv::absdiff(disparity, truth, error);
    return (error >= threshold) & mask;
}

//! Share of the mask in percent.
inline double percent(const Mat& pixels, const Mat& mask)
{
    return 100. * cv::countNonZero(pixels) / std::max(cv::countNonZero(mask), 1);
}

struct Truth
{
    Mat disparity; // empty if there is no truth
    Mat judged;    // mask of the pixels that count
    bool nonOccluded;
};

inline Mat readTruthFile(const cv::CommandLineParser& parser, const String& option, cv::Size size)
{
    const double scale = parser.has("truth-scale") ? getNumber(parser, "truth-scale", 1e-3, 1e6) : 0;
    const Mat disparity = readDisparity(parser.get<String>(option), scale);
    if (disparity.size() != size)
        fail(cv::format("--%s is %d x %d, the images are %d x %d", option.c_str(), disparity.cols, disparity.rows,
                        size.width, size.height));
    return disparity;
}

//! The truth given by --truth, --truth-right and --truth-scale.
inline Truth readTruth(const cv::CommandLineParser& parser, cv::Size size)
{
    Truth truth = { Mat(), Mat(), parser.has("truth-right") };
    if (!parser.has("truth"))
    {
        if (truth.nonOccluded || parser.has("truth-scale"))
            fail("--truth-right and --truth-scale need --truth");
        return truth;
    }
    truth.disparity = readTruthFile(parser, "truth", size);
    truth.judged = truth.nonOccluded ? nonOccludedPixels(truth.disparity, readTruthFile(parser, "truth-right", size))
                                     : knownPixels(truth.disparity);
    if (cv::countNonZero(truth.judged) == 0)
        fail("--truth knows no pixel" + String(truth.nonOccluded ? " that --truth-right agrees with" : ""));
    return truth;
}

// ---- Pictures

//! The disparities that a map's colors are to tell apart: all of them but a few outliers
inline cv::Vec2f colorRange(const Mat& disparity)
{
    std::vector<float> values;
    for (int y = 0; y < disparity.rows; y++)
        std::copy_if(disparity.ptr<float>(y), disparity.ptr<float>(y) + disparity.cols, std::back_inserter(values),
                     [](float d) { return d < NO_DISPARITY; });
    std::sort(values.begin(), values.end());
    const float low = values.empty() ? 0.f : values[values.size() / 100];
    const float high = values.empty() ? 1.f : std::max(values[values.size() - 1 - values.size() / 100], low + 1.f);
    return cv::Vec2f(low, high);
}

//! The map in colors, from blue (far) by green to orange (near); black where there is no disparity.
inline Mat colorPicture(const Mat& disparity, const cv::Vec2f& range)
{
    // Both ends of the color map are left out: they are near black and red, which mean something else here.
    const float low = range[0], high = range[1];
    Mat levels = cv::max(cv::min(disparity, high), low), picture;
    levels.convertTo(levels, CV_8U, 150. / (high - low), 20 - 150. / (high - low) * low);
    cv::applyColorMap(levels, picture, cv::COLORMAP_TURBO);
    picture.setTo(cv::Scalar::all(0), ~knownPixels(disparity));
    return picture;
}

inline Mat colorPicture(const Mat& disparity) { return colorPicture(disparity, colorRange(disparity)); }

} // namespace hdp_samples

#endif
