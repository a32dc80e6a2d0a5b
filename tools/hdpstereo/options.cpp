// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"
#include "options.hpp"
#include "windows.hpp"

#include <climits>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

#include "opencv2/imgcodecs.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;

double numberOf(const CommandLineParser& parser, const String& option)
{
    const String text = parser.get<String>(option);
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != 0 || !std::isfinite(number))
        CV_Error(Error::StsBadArg, "--" + option + "=" + text + " is not a number");
    return number;
}

int integerOf(const CommandLineParser& parser, const String& option)
{
    const double number = numberOf(parser, option);
    if (number != std::floor(number) || std::abs(number) > INT_MAX)
        CV_Error(Error::StsBadArg, "--" + option + "=" + parser.get<String>(option) + " is not an integer");
    return (int)number;
}

int numDisparitiesOf(const CommandLineParser& parser, int width)
{
    return parser.has("num-disparities") ? integerOf(parser, "num-disparities")
                                         : std::max((width / 5 + 15) / 16 * 16, 16);
}

cv::stereo::PairModel findingsOf(const CommandLineParser& parser)
{
    try
    {
        return cv::stereo::PairModel::load(parser.get<String>("findings"));
    }
    catch (const cv::Exception& e) // names the file, after a parameter
    {
        CV_Error(e.code, "--findings=" + e.err.substr(std::min(e.err.find('\''), e.err.size())));
    }
}

void checkOutputs(const CommandLineParser& parser)
{
    const char* const inputs[] = { "@left", "@right", "left-mask",   "right-mask",   "smallest", "largest",
                                   "prior", "truth",  "calibration", "calibration2", "findings", "reprojection" };
    std::vector<String> outputs;
    for (const char* option :
         { "@out", "output", "sigma", "depth", "confidence", "reasons", "picture", "point-cloud", "save-findings" })
    {
        const String path = parser.get<String>(option), name = option;
        if (path.empty())
            continue;
        const String extension = extensionOf(path);
        if (name == "save-findings" && extension != ".yml" && extension != ".yaml" && extension != ".xml" &&
            extension != ".json")
            CV_Error(Error::StsBadArg, "cannot write '" + path + "': --save-findings takes .yml, .xml or .json");
        if (name == "point-cloud" || name == "save-findings")
            requireFolderOf(path);
        else if (name == "picture")
            requirePictureWriter(path);
        else
            requireMapWriter(path);
        for (const String input : inputs)
            if (isSameFile(path, parser.get<String>(input)))
                CV_Error(Error::StsBadArg, "cannot write '" + path + "': it is " +
                                               (input == "@left"    ? "LEFT"
                                                : input == "@right" ? "RIGHT"
                                                                    : "the file of --" + input));
        for (const String& other : outputs)
            if (isSameFile(path, other))
                CV_Error(Error::StsBadArg, "cannot write '" + path + "' twice: each output needs a file of its own");
        outputs.push_back(path);
    }
    const String map = parser.get<String>(parser.has("output") ? "output" : "@out");
    if (extensionOf(map) == ".png")
        requireDisparitiesOfPng(parser);
}

void requireDisparitiesOfPng(const CommandLineParser& parser)
{
    const int min = integerOf(parser, "min-disparity");
    if (min < 0)
        CV_Error(Error::StsBadArg, "PNG has no disparities below 0, and --min-disparity=" +
                                       parser.get<String>("min-disparity") + " asks for some: take .tif, .pfm or .exr");
    if (min > 255)
        CV_Error(Error::StsBadArg,
                 "PNG has no disparities above 255, and --min-disparity=" + parser.get<String>("min-disparity") +
                     " asks for no others: take .tif, .pfm or .exr");
}

void setKnownDisparities(const CommandLineParser& parser, const Mat& smallest, const Mat& largest, const Mat& prior,
                         HDPTreeMatcher& matcher)
{
    matcher.setDisparityRange(smallest, largest);
    matcher.setPriorDisparity(prior, Mat(1, 1, CV_64F, Scalar(numberOf(parser, "prior-sigma"))));
}

Ptr<HDPTreeMatcher> createPlainMatcher(const CommandLineParser& parser, int width)
{
    const std::map<String, int> presets = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                                            { "fast", HDPTreeMatcher::PRESET_FAST },
                                            { "quality", HDPTreeMatcher::PRESET_QUALITY },
                                            { "tree", HDPTreeMatcher::PRESET_TREE },
                                            { "paper", HDPTreeMatcher::PRESET_PAPER } };
    const auto preset = presets.find(parser.get<String>("preset"));
    if (preset == presets.end())
        CV_Error(Error::StsBadArg,
                 "--preset=" + parser.get<String>("preset") + " is none of ultrafast, fast, quality, tree and paper");
    const int minDisparity = integerOf(parser, "min-disparity"), numDisparities = numDisparitiesOf(parser, width);
    if (numDisparities == 0 && minDisparity != 0)
        CV_Error(Error::StsBadArg, "--min-disparity does not go with --num-disparities=0, which finds it, too");
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, numDisparities, preset->second);
    if (parser.has("findings"))
        matcher->setPairModel(findingsOf(parser));
    return matcher;
}

Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, int width)
{
    const Ptr<HDPTreeMatcher> matcher = createPlainMatcher(parser, width);
    const auto mapOf = [&](const char* option) {
        const String path = parser.get<String>(option);
        Mat mask;
        const Mat map = path.empty() ? Mat() : readPicture(path, mask);
        return path.empty() ? Mat() : toDisparity(map, mask, path);
    };
    setKnownDisparities(parser, mapOf("smallest"), mapOf("largest"), mapOf("prior"), *matcher);
    return matcher;
}

static Mat maskOf(const CommandLineParser& parser, const char* option)
{
    return parser.has(option) ? readMask(parser.get<String>(option)) : Mat();
}

MaskFiles::MaskFiles(const CommandLineParser& parser)
    : left_(maskOf(parser, "left-mask")), right_(maskOf(parser, "right-mask"))
{
}

void MaskFiles::apply(const Mat& ofLeft, const Mat& ofRight, HDPTreeMatcher& matcher) const
{
    matcher.setMasks(joinMasks(left_, ofLeft), joinMasks(right_, ofRight));
}

Mat inPixels(const Mat& disparity16, int minDisparity)
{
    Mat disparity;
    disparity16.convertTo(disparity, CV_32F, 1. / StereoMatcher::DISP_SCALE);
    disparity.setTo(std::numeric_limits<float>::infinity(), disparity < minDisparity);
    return disparity;
}

Mat computeDisparity(HDPTreeMatcher& matcher, const Mat& left, const Mat& right)
{
    Mat disparity16;
    matcher.compute(left, right, disparity16);
    return inPixels(disparity16, matcher.getFindings().minDisparity);
}
