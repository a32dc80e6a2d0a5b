// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a rectified stereo pair with cv::stereo::HDPTreeMatcher, and writes the disparities in grey levels. The program
// hdpstereo does more.

#include "strict_arguments.hpp"

#include <iostream>
#include <map>

#include "opencv2/core/utility.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;

static const char* const keys = "{help h ?        |      | print this and exit }"
                                "{@left           |      | left image of a rectified pair }"
                                "{@right          |      | right image }"
                                "{@out            |      | disparities: a 16-bit PNG, times 256 }"
                                "{preset          | fast | ultrafast, fast, quality, tree or paper }"
                                "{num-disparities | 128  | number of disparities, from 0 on }";

static void match(const CommandLineParser& parser)
{
    const std::map<String, int> presets = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                                            { "fast", HDPTreeMatcher::PRESET_FAST },
                                            { "quality", HDPTreeMatcher::PRESET_QUALITY },
                                            { "tree", HDPTreeMatcher::PRESET_TREE },
                                            { "paper", HDPTreeMatcher::PRESET_PAPER } };
    const auto preset = presets.find(parser.get<String>("preset"));
    if (preset == presets.end())
        CV_Error(Error::StsBadArg, "--preset=" + parser.get<String>("preset") + " is unknown");
    const Mat left = imread(parser.get<String>("@left")), right = imread(parser.get<String>("@right"));
    if (left.empty() || right.empty())
        CV_Error(Error::StsError, "cannot read the images");
    const int numDisparities = hdp_samples::integerOf(parser, "num-disparities", 0, 2047);
    if (!parser.has("@out"))
        CV_Error(Error::StsBadArg, "OUT is missing: hdp_stereo_match LEFT RIGHT OUT.png");

    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, preset->second);
    Mat disparity, confidence;
    matcher->compute(left, right, disparity); // CV_16SC1, times 16
    matcher->getConfidence(confidence);       // CV_8UC1

    const HDPTreeMatcher::Findings findings = matcher->getFindings();
    for (size_t i = 0; i < findings.stages.size(); i++)
        std::cout << findings.stages[i] << ": " << findings.stageTimes[i] << " ms\n";
    std::cout << "noise: " << findings.noise << " grey levels\nmean confidence: " << mean(confidence)[0] << " of 255\n";

    Mat disparity256;
    disparity.convertTo(disparity256, CV_16U, 256. / StereoMatcher::DISP_SCALE);
    if (!imwrite(parser.get<String>("@out"), disparity256))
        CV_Error(Error::StsError, "cannot write '" + parser.get<String>("@out") + "'");
}

int main(int argc, char** argv)
{
    const CommandLineParser parser(argc, argv, keys);
    if (parser.has("help"))
    {
        parser.printMessage();
        return 0;
    }
    try
    {
        hdp_samples::checkArguments(argc, argv, parser, 3);
        match(parser);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return std::cout.flush() ? 0 : 1;
}
