// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "calibration.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

#include "opencv2/hdpstereo.hpp"

#include "evaluation.hpp"
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
            const double distance = disparity.at<float>(y, x) - truth, ofTruth = pair.truthDeviation;
            const bool isWithin = distance * distance <= limit * limit + ofTruth * ofTruth;
            for (const size_t i : { level, LEVELS.size() }) // the last one is of all
            {
                shares[i].pixels++;
                shares[i].within += isWithin;
            }
        }
}

//! Matches the scenes; use is called with each, its pair, matcher and disparities.
static void matchScenes(const Method& method, const std::vector<Scene>& scenes, int numDisparities,
                        std::set<String>& bad,
                        const std::function<void(const Scene&, const Pair&, const HDPTreeMatcher&, const Mat&)>& use)
{
    forEachPair(method, scenes, bad, [&](const Scene& scene, const Pair& pair) {
        const cv::Range range = numDisparities > 0 ? cv::Range(0, numDisparities) : pair.disparities;
        const Ptr<cv::StereoMatcher> matcher = method.create(range);
        const Mat disparity = matchDensely(method, *matcher, pair.left, pair.right);
        use(scene, pair, dynamic_cast<const HDPTreeMatcher&>(*matcher), disparity);
    });
}

Table calibrationTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities,
                       std::set<String>& bad)
{
    std::map<String, std::vector<Share>> sets;
    matchScenes(method, scenes, numDisparities, bad,
                [&](const Scene& scene, const Pair& pair, const HDPTreeMatcher& matcher, const Mat& disparity) {
        Mat sigma;
        matcher.getDisparitySigma(sigma);
        std::vector<Share>& shares = sets[scene.set];
        shares.resize(LEVELS.size() + 1);
        addPixels(disparity, sigma, pair, shares);
    });

    Table table;
    table.title = "Errors within sigma, " + method.name;
    table.note =
        "Percent of the non-occluded pixels of known truth, of all of KITTI's, with a sigma from this one on; 68 if it "
        "is true. Where the truth is rounded to steps of s pixels, sigma is sqrt(sigma^2 + s^2 / 12). -: fewer than " +
        cv::format("%d pixels.", LEAST_PIXELS);
    table.header.push_back("sigma, pixels");
    for (const auto& set : sets)
        table.header.push_back(set.first);
    for (size_t i = 0; i <= LEVELS.size() && !sets.empty(); i++)
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

String calibrationPlot(const Table& table)
{
    const char* const colors[] = { "#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd",
                                   "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf" };
    const int left = 50, top = 10, width = 420, height = 300, sets = (int)table.header.size() - 1,
              levels = (int)table.rows.size() - 1; // the last row is of all
    const auto x = [&](int level) { return left + width * (level + 0.5) / levels; };
    const auto y = [&](double percent) { return top + height * (1 - percent / 100); };
    std::ostringstream svg;
    const auto text = [&](double textX, double textY, const char* anchor, const String& words) {
        svg << "<text x='" << textX << "' y='" << textY << "' text-anchor='" << anchor << "'>" << htmlText(words)
            << "</text>\n";
    };
    const auto line = [&](double percent, const char* color) {
        svg << "<line x1='" << left << "' x2='" << left + width << "' y1='" << y(percent) << "' y2='" << y(percent)
            << "' stroke='" << color << "'/>\n";
    };
    svg << "<svg xmlns='http://www.w3.org/2000/svg' width='640' height='360' font-family='sans-serif' "
           "font-size='12'>\n<rect width='640' height='360' fill='white'/>\n<rect x='"
        << left << "' y='" << y(80) << "' width='" << width << "' height='" << y(50) - y(80) << "' fill='#e8f4e8'/>\n";
    for (int percent = 0; percent <= 100; percent += 20)
    {
        line(percent, "#cccccc");
        text(left - 6, y(percent) + 4, "end", std::to_string(percent));
    }
    line(68, "#444444");
    for (int i = 0; i < levels; i++)
        text(x(i), top + height + 18, "middle", table.rows[i][0].text);
    text(left + width / 2, top + height + 40, "middle", "sigma in pixels, from");
    text(left, top + height + 40, "start", "% within sigma");
    for (int set = 0; set < sets; set++)
    {
        const char* const color = colors[set % (sizeof(colors) / sizeof(colors[0]))];
        svg << "<polyline fill='none' stroke-width='2' stroke='" << color << "' points='";
        for (int i = 0; i < levels; i++)
            if (table.rows[i][set + 1].text != "-")
                svg << x(i) << ',' << y(std::stod(table.rows[i][set + 1].text)) << ' ';
        svg << "'/>\n<rect x='480' y='" << top + 20 * set << "' width='12' height='12' fill='" << color << "'/>\n";
        text(498, top + 20 * set + 11, "start", table.header[set + 1]);
    }
    svg << "</svg>\n";
    return svg.str();
}

void ConfidenceErrors::add(const Mat& confidence, const Mat& disparity, const Mat& truth)
{
    const Mat known = knownPixels(truth);
    for (int y = 0; y < truth.rows; y++)
        for (int x = 0; x < truth.cols; x++)
            if (known.at<uchar>(y, x))
            {
                const int level = confidence.at<uchar>(y, x);
                pixels_[level]++;
                wrong_[level] += !(std::abs(disparity.at<float>(y, x) - truth.at<float>(y, x)) <= 1);
            }
}

double ConfidenceErrors::share(int least) const
{
    const double all = std::accumulate(pixels_.begin(), pixels_.end(), 0.);
    return all > 0 ? 100 * std::accumulate(pixels_.begin() + least, pixels_.end(), 0.) / all : NO_SCORE;
}

double ConfidenceErrors::wrong(int least) const
{
    const double pixels = std::accumulate(pixels_.begin() + least, pixels_.end(), 0.);
    return pixels < LEAST_PIXELS ? NO_SCORE : 100 * std::accumulate(wrong_.begin() + least, wrong_.end(), 0.) / pixels;
}

Table confidenceErrorsTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities,
                            std::set<String>& bad)
{
    std::map<String, ConfidenceErrors> sets;
    matchScenes(method, scenes, numDisparities, bad,
                [&](const Scene& scene, const Pair& pair, const HDPTreeMatcher& matcher, const Mat& disparity) {
        Mat confidence;
        matcher.getConfidence(confidence);
        sets[scene.set].add(confidence, disparity, pair.truth);
    });

    Table table;
    table.title = "Errors by confidence, " + method.name;
    table.note = "Percent of the pixels of known truth, occluded ones too, that have at least this confidence; percent "
                 "of these that are wrong by more than a pixel, or have no disparity.";
    table.header.push_back("confidence >=");
    for (const auto& set : sets)
        for (const char* what : { ": pixels", ": wrong" })
            table.header.push_back(set.first + what);
    for (int least = 0; least <= 200 && !sets.empty(); least += 20)
    {
        table.addRow(cv::format("%d", least));
        for (const auto& set : sets)
        {
            table.addNumber(set.second.share(least), "%.1f");
            table.addNumber(set.second.wrong(least), "%.2f");
        }
    }
    return table;
}

} // namespace hdp_tools
