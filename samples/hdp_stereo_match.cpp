// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a rectified stereo pair with cv::stereo::HDPTreeMatcher: writes the disparity, a picture of it and a point
// cloud, and prints the time of each stage, the share of the disparity range searched, and the error if the truth is
// known.

#include <iostream>

#include "opencv2/hdpstereo.hpp"

#include "hdp_samples_common.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?         |       | print this and exit }"
    "{@left            |       | left image of a rectified pair }"
    "{@right           |       | right image }"
    "{preset           | fast  | set of parameters: ultrafast, fast, quality, tree, or paper (the paper's tables) }"
    "{tree             |       | spanning tree: mst (minimum), st (segment) or rt (random); by default the preset's }"
    "{no-prediction    |       | the plain tree algorithm over the full range }"
    "{median-prefilter |       | edge weights from a 3 x 3 median of the image }"
    "{min-disparity    | 0     | smallest disparity in pixels }"
    "{num-disparities  |       | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{threads          |       | number of threads; all processors if not given }"
    "{output           |       | disparity: FILE.png (16 bit, times 256, 0 = none) or FILE.pfm (float, inf = none) }"
    "{picture          |       | disparity in colors: far blue, near orange, none black; with --truth, errors of 2 and "
    "more are red, and pixels that are not judged black }"
    "{truth            |       | left disparity: PNG of 8 bit (0 = unknown) or 16 bit (times 256, 0 = unknown) or PFM }"
    "{truth-right      |       | right disparity; occluded pixels are then not judged }"
    "{truth-scale      |       | what a disparity of 1 is in the truth files, if not 1 (8 bit, PFM) or 256 (16 bit) }"
    "{point-cloud      |       | colored points: FILE.ply; needs --Q, or --focal and --baseline }"
    "{Q                |       | file with the 4 x 4 matrix Q of cv::stereoRectify }"
    "{focal            |       | focal length in pixels; the principal point is the center of the image }"
    "{baseline         |       | distance of the cameras, in the unit of the points }";

static const std::vector<String> FLAGS = { "help", "h", "?", "no-prediction", "median-prefilter" };

static void checkOptions(const CommandLineParser& parser)
{
    const String output = parser.get<String>("output"), picture = parser.get<String>("picture");
    if (!output.empty() && !hasExtension(output, ".png") && !hasExtension(output, ".pfm"))
        fail("--output=" + output + ": neither a .png nor a .pfm file");
    if (!picture.empty() && !haveImageWriter(picture))
        fail("--picture=" + picture + ": not a kind of image that can be written");

    const bool camera = parser.has("focal") && parser.has("baseline");
    if (parser.has("point-cloud") && parser.has("Q") == camera)
        fail("--point-cloud needs either --Q, or --focal and --baseline");
    if (!parser.has("point-cloud") && (parser.has("Q") || parser.has("focal") || parser.has("baseline")))
        fail("--Q, --focal and --baseline need --point-cloud");
}

static Matx44d readCamera(const CommandLineParser& parser, Size size)
{
    if (!parser.has("Q"))
    {
        const double f = getNumber(parser, "focal", 1e-3, 1e9), b = getNumber(parser, "baseline", 1e-9, 1e9);
        return Matx44d(1, 0, 0, -0.5 * (size.width - 1),  //
                       0, 1, 0, -0.5 * (size.height - 1), //
                       0, 0, 0, f,                        //
                       0, 0, 1 / b, 0);
    }
    Mat Q;
    try
    {
        FileStorage(parser.get<String>("Q"), FileStorage::READ)["Q"] >> Q;
    }
    catch (const cv::Exception&)
    {
    }
    if (Q.size() != Size(4, 4) || Q.channels() != 1)
        fail("cannot read a 4 x 4 matrix Q from '" + parser.get<String>("Q") + "'");
    Q.convertTo(Q, CV_64F);
    return Matx44d(Q.ptr<double>());
}

static Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, Size size)
{
    const Range disparities = getDisparities(parser, size);
    Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(disparities.start, disparities.size(), getPreset(parser, "preset"));
    if (parser.has("tree"))
        matcher->setTreeStrategy(createTree(parser.get<String>("tree")));
    matcher->setUsePrediction(!parser.has("no-prediction"));
    matcher->setUseMedianPrefilter(parser.has("median-prefilter"));
    return matcher;
}

//! What the matcher is; a system of the paper by its name in the tables there, such as HDP+MST.
static String systemName(const HDPTreeMatcher& matcher)
{
    String tree;
    for (const char* name : TREES)
        if (createTree(name)->getDefaultName() == matcher.getTreeStrategy()->getDefaultName())
            tree = upperCase(name);
    const String prefilter = matcher.getUseMedianPrefilter() ? "M+" : "";
    if (matcher.getUsePrediction() && matcher.getAggregation() == HDPTreeMatcher::AGGREGATION_SCANLINES)
        return "scanlines, " + prefilter + tree + " on the top layer";
    return prefilter + (matcher.getUsePrediction() ? "HDP+" : "") + tree +
           (matcher.getMatchingCost() == HDPTreeMatcher::COST_CENSUS ? ", census cost" : "");
}

static void printWork(const HDPTreeMatcher& matcher, double totalMilliseconds)
{
    std::vector<String> stages;
    std::vector<double> milliseconds, ratios;
    matcher.getStageTimes(stages, milliseconds);
    matcher.getSearchRatios(ratios);
    for (size_t i = 0; i < stages.size(); i++)
        std::cout << format("%-11s%-24s%10.1f ms\n", i == 0 ? "time" : "", stages[i].c_str(), milliseconds[i]);
    std::cout << format("%-11s%-24s%10.1f ms\n", "", "in all", totalMilliseconds);
    for (size_t i = 0; i < ratios.size(); i++)
        std::cout << format("%-11slayer %-18d%10.2f %%\n", i == 0 ? "searched" : "", int(i), 100 * ratios[i]);
}

static void printErrors(const Mat& disparity, const Truth& truth)
{
    for (int threshold = 1; threshold <= 2; threshold++)
        std::cout << format("%-11serr>=%-19d%10.2f %%\n", threshold == 1 ? "wrong" : "", threshold,
                            percent(wrongPixels(disparity, truth.disparity, truth.judged, threshold), truth.judged));
    std::cout << format("%-11sof %d pixels with known truth%s\n", "", countNonZero(truth.judged),
                        truth.nonOccluded ? " that are not occluded" : "");
}

static void saveDisparity(const String& path, const Mat& disparity)
{
    const int lost = writeDisparity(path, disparity);
    std::cout << "written    " << path << std::endl;
    if (lost > 0)
        std::cerr << "warning: " << lost << " disparities are below 0 or above 255.99, which a 16-bit PNG cannot hold; "
                  << "they are written as 0 (none). A .pfm file holds all." << std::endl;
}

static void savePicture(const String& path, const Mat& disparity, const Truth& truth)
{
    Mat picture = colorPicture(disparity);
    if (!truth.disparity.empty())
    {
        picture.setTo(Scalar::all(0), ~truth.judged);
        const Mat wrong = wrongPixels(disparity, truth.disparity, truth.judged, 2);
        picture.setTo(Scalar(0, 0, 255), wrong & knownPixels(disparity));
    }
    writeImage(path, picture);
    std::cout << "written    " << path << std::endl;
}

static void savePointCloud(const String& path, const Mat& disparity, const Mat& image, const Matx44d& Q)
{
    const int count = writePointCloud(path, disparity, image, Q);
    std::cout << "written    " << path << " (" << count << " points)" << std::endl;
}

static void run(const CommandLineParser& parser)
{
    checkOptions(parser);
    if (parser.has("threads"))
        setNumThreads(getInteger(parser, "threads", 1, 1024));

    Mat left, right;
    readPair(parser, left, right);
    const Truth truth = readTruth(parser, left.size());
    const Matx44d Q = parser.has("point-cloud") ? readCamera(parser, left.size()) : Matx44d();

    Ptr<HDPTreeMatcher> matcher = createMatcher(parser, left.size());
    const int minDisparity = matcher->getMinDisparity();
    std::cout << format("images     %d x %d, disparities %d to %d\n", left.cols, left.rows, minDisparity,
                        minDisparity + matcher->getNumDisparities() - 1)
              << "system     " << systemName(*matcher) << " (preset " << parser.get<String>("preset") << ", threads "
              << getNumThreads() << ")" << std::endl;

    Mat disparity16;
    TickMeter timer;
    timer.start();
    matcher->compute(left, right, disparity16);
    timer.stop();
    const Mat disparity = toPixels(disparity16, minDisparity);

    printWork(*matcher, timer.getTimeMilli());
    if (!truth.disparity.empty())
        printErrors(disparity, truth);
    if (parser.has("output"))
        saveDisparity(parser.get<String>("output"), disparity);
    if (parser.has("picture"))
        savePicture(parser.get<String>("picture"), disparity, truth);
    if (parser.has("point-cloud"))
        savePointCloud(parser.get<String>("point-cloud"), disparity, left, Q);
}

int main(int argc, char** argv)
{
    return runSample(argc, argv, KEYS,
                     "Disparity of a rectified stereo pair: non-local matching, hierarchical disparity "
                     "prediction.\n",
                     FLAGS, 2, run);
}
