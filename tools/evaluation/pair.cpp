// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "pair.hpp"

#include <algorithm>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include "command_line.hpp"

namespace hdp_tools {

const char* const PAIR_KEYS =
    "{@left           |     | left image of a rectified pair, of 8 or 16 bit }"
    "{@right          |     | right image }"
    "{min-disparity   | 0   | smallest disparity in pixels }"
    "{num-disparities |     | number of disparities; by default a fifth of the width, rounded up to a multiple of 16 }"
    "{truth           |     | left disparity: PNG of 8 bit (0 = unknown) or 16 bit (times 256, 0 = unknown) or PFM }"
    "{truth-right     |     | right disparity; occluded pixels are then not judged }"
    "{truth-scale     |     | value of a disparity of 1 in the truth files, if not 1 (8 bit, PFM) or 256 (16 bit) }";

int defaultNumDisparities(int width) { return std::max(int(cv::alignSize(size_t(width / 5), 16)), 16); }

static Mat readTruthFile(const cv::CommandLineParser& parser, const String& option, cv::Size size)
{
    const double scale = parser.has("truth-scale") ? getNumber(parser, "truth-scale", 1e-3, 1e6) : 0;
    const Mat disparity = readDisparity(parser.get<String>(option), scale);
    if (disparity.size() != size)
        fail(cv::format("--%s is %d x %d, the images are %d x %d", option.c_str(), disparity.cols, disparity.rows,
                        size.width, size.height));
    return disparity;
}

static void readTruth(const cv::CommandLineParser& parser, Pair& pair)
{
    const bool hasRight = parser.has("truth-right");
    if (!parser.has("truth"))
    {
        if (hasRight || parser.has("truth-scale"))
            fail("--truth-right and --truth-scale need --truth");
        return;
    }
    const cv::Size size = pair.left.size();
    pair.protocol = Pair::MIDDLEBURY;
    pair.truth = readTruthFile(parser, "truth", size);
    pair.judged =
        hasRight ? nonOccludedPixels(pair.truth, readTruthFile(parser, "truth-right", size)) : knownPixels(pair.truth);
    if (cv::countNonZero(pair.judged) == 0)
        fail("--truth knows no pixel" + String(hasRight ? " that --truth-right agrees with" : ""));
}

void toColors(Mat& left, Mat& right)
{
    const double largest = std::max(cv::norm(left, cv::NORM_INF), cv::norm(right, cv::NORM_INF));
    for (Mat* image : { &left, &right })
        if (image->depth() == CV_16U)
        {
            Mat bytes;
            image->convertTo(bytes, CV_8U, 255 / std::max(largest, 1.));
            cv::cvtColor(bytes, *image, cv::COLOR_GRAY2BGR);
        }
}

Pair readPair(const cv::CommandLineParser& parser)
{
    if (!parser.has("@left") || !parser.has("@right"))
        fail("a left and a right image are needed, see --help");
    Pair pair;
    pair.protocol = Pair::NO_TRUTH;
    pair.left = readPicture(parser.get<String>("@left"));
    pair.right = readPicture(parser.get<String>("@right"));
    if (pair.left.size() != pair.right.size())
        fail(cv::format("the images differ in size: %d x %d and %d x %d", pair.left.cols, pair.left.rows,
                        pair.right.cols, pair.right.rows));

    const int limit = 1 << 15; // the matchers themselves are stricter
    const int minDisparity = getInteger(parser, "min-disparity", -limit, limit);
    const int numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, limit)
                                                             : defaultNumDisparities(pair.left.cols);
    pair.disparities = cv::Range(minDisparity, minDisparity + numDisparities);
    readTruth(parser, pair);
    return pair;
}

} // namespace hdp_tools
