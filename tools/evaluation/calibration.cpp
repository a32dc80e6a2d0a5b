// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "opencv2/hdpstereo.hpp"

#include "command_line.hpp"
#include "scores.hpp"

namespace hdp_tools {

using cv::stereo::HDPTreeMatcher;

// Where levels of sigma begin, in pixels
static const std::vector<float> LEVELS = { 0, 0.25f, 0.3f, 0.35f, 0.4f, 0.5f, 0.7f, 1, 2, 3 };
static const int LEAST_PIXELS = 1000; // for a share

struct Share
{
    double pixels = 0, within = 0;
};

static void addPixels(const Mat& disparity, const Mat& sigma, const Pair& pair, std::vector<Share>& shares)
{
    for (int y = 0; y < sigma.rows; y++)
        for (int x = 0; x < sigma.cols; x++)
        {
            const float limit = sigma.at<float>(y, x), truth = pair.truth.at<float>(y, x);
            if (pair.judged.at<uchar>(y, x) == 0 || limit == std::numeric_limits<float>::infinity())
                continue;
            const size_t level = std::upper_bound(LEVELS.begin(), LEVELS.end(), limit) - LEVELS.begin() - 1;
            const bool isWithin = std::abs(disparity.at<float>(y, x) - truth) <= limit;
            for (const size_t i : { level, LEVELS.size() }) // the last one is of all
            {
                shares[i].pixels++;
                shares[i].within += isWithin;
            }
        }
}

Table calibrationTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities)
{
    std::map<String, std::vector<Share>> sets;
    for (const Scene& scene : scenes)
    {
        if (scene.truth.empty())
            continue;
        const Pair pair = readPair(scene);
        const cv::Range range = numDisparities > 0 ? cv::Range(0, numDisparities) : pair.disparities;
        const Ptr<cv::StereoMatcher> matcher = method.create(range);
        const HDPTreeMatcher* const hdp = dynamic_cast<const HDPTreeMatcher*>(matcher.get());
        if (!hdp)
            fail("--calibration: " + method.name + " knows no errors");
        const std::array<Mat, 2> images = imagesFor(method, pair.left, pair.right);
        const Mat disparity = matchDensely(method, *matcher, images[0], images[1]);
        Mat sigma;
        hdp->getDisparitySigma(sigma);
        std::vector<Share>& shares = sets[scene.set];
        shares.resize(LEVELS.size() + 1);
        addPixels(disparity, sigma, pair, shares);
    }

    Table table;
    table.title = "Errors within sigma, " + method.name;
    table.note =
        "Percent of the pixels of known truth with a sigma from this one on; 68 if it is true. -: fewer than " +
        cv::format("%d pixels.", LEAST_PIXELS);
    table.header.push_back("sigma, pixels");
    for (const auto& set : sets)
        table.header.push_back(set.first);
    for (size_t i = 0; i <= LEVELS.size(); i++)
    {
        table.addRow(i < LEVELS.size() ? cv::format("%.2f", LEVELS[i]) : String("all"));
        for (const auto& set : sets)
        {
            const Share& share = set.second[i];
            table.addNumber(share.pixels < LEAST_PIXELS ? NO_SCORE : 100 * share.within / share.pixels, "%.0f");
        }
    }
    return table;
}

} // namespace hdp_tools
