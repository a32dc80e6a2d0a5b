// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Makes the pictures of the tutorial, from a rectified pair with truth: what the stages of HDPTreeMatcher give.

#include <iostream>

#include "hdp_report.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@left           |     | left image of a rectified pair }"
    "{@right          |     | right image }"
    "{truth           |     | left disparity: PNG of 8 bit (0 = unknown) or 16 bit (times 256, 0 = unknown) or PFM }"
    "{truth-right     |     | right disparity; occluded pixels are then not judged }"
    "{truth-scale     |     | what a disparity of 1 is in the truth files, if not 1 (8 bit, PFM) or 256 (16 bit) }"
    "{min-disparity   | 0   | smallest disparity in pixels }"
    "{num-disparities |     | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{output          | .   | folder for the pictures }"
    "{width           | 400 | width of each of the pictures that are put side by side }";

static const std::vector<String> FLAGS = { "help", "h", "?" };

//! Pictures side by side, of a width each
static Mat sideBySide(const std::vector<Mat>& pictures, int width, int interpolation)
{
    std::vector<Mat> resized;
    for (const Mat& picture : pictures)
    {
        Mat scaled;
        resize(picture, scaled, Size(width, cvRound((double)picture.rows * width / picture.cols)), 0, 0, interpolation);
        copyMakeBorder(scaled, scaled, 0, 0, resized.empty() ? 0 : 4, 0, BORDER_CONSTANT, Scalar::all(255));
        resized.push_back(scaled);
    }
    Mat row;
    hconcat(resized, row);
    return row;
}

static Mat withErrors(const Mat& disparity, const Truth& truth, const Vec2f& range)
{
    Mat picture = colorPicture(disparity, range);
    picture.setTo(Scalar::all(0), ~truth.judged);
    picture.setTo(Scalar(0, 0, 255), wrongPixels(disparity, truth.disparity, truth.judged, 2));
    return picture;
}

static void run(const CommandLineParser& parser)
{
    Mat left, right;
    readPair(parser, left, right);
    const Truth truth = readTruth(parser, left.size());
    if (truth.disparity.empty())
        fail("--truth is needed");
    const Range disparities = getDisparities(parser, left.size());
    const int width = getInteger(parser, "width", 16, 4096);
    const Vec2f range = colorRange(truth.disparity);

    const auto create = [&](int preset) {
        return HDPTreeMatcher::create(disparities.start, disparities.size(), preset);
    };
    const auto match = [&](HDPTreeMatcher& matcher) {
        Mat disparity;
        matcher.compute(left, right, disparity);
        return toPixels(disparity, disparities.start);
    };
    const auto save = [&](const String& name, const std::vector<Mat>& pictures, int interpolation) {
        const String path = parser.get<String>("output") + "/hdpstereo_" + name;
        writeImage(path, sideBySide(pictures, width, interpolation));
        std::cout << "written    " << path << std::endl;
    };

    save("pair.jpg", { left, right, colorPicture(truth.disparity, range) }, INTER_AREA);

    const Ptr<HDPTreeMatcher> paper = create(HDPTreeMatcher::PRESET_PAPER), fast = create(HDPTreeMatcher::PRESET_FAST);
    for (const Ptr<HDPTreeMatcher>& matcher : { paper, fast })
    {
        std::vector<Mat> maps;
        for (int layer = 2; layer >= 0; layer--) // both have at least 3 of them
        {
            matcher->setFinestLayer(layer);
            maps.push_back(colorPicture(match(*matcher), range));
        }
        save(matcher == paper ? "layers_paper.jpg" : "layers_fast.jpg", maps, INTER_AREA);
    }

    match(*paper);
    Mat trees, intervals;
    paper->getForest(trees, intervals);
    save("forest.png", { forestPicture(trees), widthPicture(intervals, 16) }, INTER_NEAREST);

    const Mat ofFast = match(*fast);
    Mat confidence;
    fast->getConfidence(confidence);
    cvtColor(confidence, confidence, COLOR_GRAY2BGR);
    save("confidence.jpg", { colorPicture(ofFast, range), withErrors(ofFast, truth, range), confidence }, INTER_AREA);

    fast->setFillOcclusions(false);
    save("occlusions.jpg", { colorPicture(match(*fast), range), colorPicture(ofFast, range) }, INTER_AREA);

    std::vector<Mat> errors;
    for (const int preset : { HDPTreeMatcher::PRESET_PAPER, HDPTreeMatcher::PRESET_TREE, HDPTreeMatcher::PRESET_FAST })
        errors.push_back(withErrors(match(*create(preset)), truth, range));
    save("errors.jpg", errors, INTER_AREA);
}

int main(int argc, char** argv)
{
    return runSample(argc, argv, KEYS,
                     "The pictures of the tutorial: pair, maps of the layers, disparity forest, confidence, errors.\n",
                     FLAGS, 2, run);
}
