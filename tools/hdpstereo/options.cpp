// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"
#include "options.hpp"

#include <climits>
#include <cmath>
#include <cstdlib>
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

Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, int width)
{
    const std::map<String, int> presets = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                                            { "fast", HDPTreeMatcher::PRESET_FAST },
                                            { "quality", HDPTreeMatcher::PRESET_QUALITY },
                                            { "tree", HDPTreeMatcher::PRESET_TREE },
                                            { "paper", HDPTreeMatcher::PRESET_PAPER } };
    const auto preset = presets.find(parser.get<String>("preset"));
    if (preset == presets.end())
        CV_Error(Error::StsBadArg, "--preset=" + parser.get<String>("preset") + " is unknown, see --help");
    const Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(integerOf(parser, "min-disparity"), numDisparitiesOf(parser, width), preset->second);
    if (parser.has("findings"))
        matcher->setPairModel(cv::stereo::PairModel::load(parser.get<String>("findings")));
    const auto maskOf = [&](const char* option) {
        return parser.has(option) ? readImage(parser.get<String>(option), IMREAD_GRAYSCALE) : Mat();
    };
    matcher->setMasks(maskOf("left-mask"), maskOf("right-mask"));
    return matcher;
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
    return inPixels(disparity16, matcher.getMinDisparity());
}
