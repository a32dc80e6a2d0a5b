// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include "pictures.hpp"
#include "tables.hpp"

namespace hdp_tools {

static const int pictureWidth = 360;

String base64(const std::vector<uchar>& bytes)
{
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    String text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3)
    {
        const size_t count = std::min(bytes.size() - i, size_t(3));
        unsigned group = 0;
        for (size_t k = 0; k < 3; k++)
            group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

String figure(const Mat& picture, const String& caption, const String& extension, int interpolation)
{
    Mat shown = picture;
    if (picture.cols > pictureWidth)
        cv::resize(picture, shown, cv::Size(pictureWidth, std::max(picture.rows * pictureWidth / picture.cols, 1)), 0,
                   0, interpolation);
    std::vector<uchar> bytes;
    cv::imencode(extension, shown, bytes,
                 extension == ".jpg" ? std::vector<int>{ cv::IMWRITE_JPEG_QUALITY, 75 } : std::vector<int>());
    std::ostringstream out;
    out << "<figure><img width=\"" << shown.cols << "\" height=\"" << shown.rows << "\" alt=\"" << htmlText(caption)
        << "\" src=\"data:image/" << (extension == ".jpg" ? "jpeg" : "png") << ";base64," << base64(bytes)
        << "\"><figcaption>" << htmlText(caption) << "</figcaption></figure>\n";
    return out.str();
}

cv::Mat_<double> predictedMatrix(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior)
{
    cv::Mat_<double> matrix((int(prior.size()) - 1) / 2 + 1, int(prior.size()));
    for (int i = 0; i < matrix.rows; i++)
        for (int j = 0; j < matrix.cols; j++)
            matrix(i, j) = model.density(layer, i - j / 2) * prior[j];
    return matrix;
}

cv::Mat_<double> sampledMatrix(const Mat& truth, const Mat& upper, int numDisparities)
{
    cv::Mat_<double> matrix = cv::Mat_<double>::zeros((numDisparities - 1) / 2 + 1, numDisparities);
    for (int y = 0; y < truth.rows; y++)
        for (int x = 0; x < truth.cols; x++)
        {
            const float above = upper.at<float>(std::min(y / 2, upper.rows - 1), std::min(x / 2, upper.cols - 1));
            const float here = truth.at<float>(y, x);
            if (!(here < NO_DISPARITY && above < NO_DISPARITY))
                continue;
            const int j = int(std::floor(here)), i = cvRound(above);
            if (i >= 0 && i < matrix.rows && j >= 0 && j < matrix.cols)
                matrix(i, j)++;
        }
    return matrix;
}

String predictionFigures(const String& name, const HDPTreeMatcher& matcher, const Pair& pair)
{
    std::ostringstream out;
    Mat trees, intervals;
    matcher.getForest(trees, intervals);
    double last = 0;
    cv::minMaxLoc(trees, 0, &last);
    const std::vector<double> ratios = matcher.getFindings().searchRatios;
    std::vector<double> prior;
    out << figure(forestPicture(trees), cv::format("%s: %d disparity trees", name.c_str(), int(last) + 1), ".jpg",
                  cv::INTER_NEAREST);
    out << figure(widthPicture(intervals, matcher.getNumDisparities()),
                  cv::format("%s: candidates of each pixel, violet 1 to yellow %d (logarithmic), mean %.2f",
                             name.c_str(), matcher.getNumDisparities(), ratios[0] * matcher.getNumDisparities()));
    Ptr<DisparityPredictionModel> model = matcher.getParams().predictionModel;
    if (!model)
        model = publishedModel(pair.left.cols);
    for (int layer = 0; pair.protocol != Pair::NO_TRUTH && layer + 1 < int(ratios.size()); layer++)
    {
        matcher.getLayerPrior(layer, prior);
        if (prior.empty()) // nothing was predicted
            continue;
        Mat upper;
        matcher.getLayerDisparity(layer + 1, upper);
        const String of = cv::format("P(D%d | D%d), %s: ", layer, layer + 1, name.c_str());
        out << "<div class=\"pair\">\n"
            << figure(matrixPicture(predictedMatrix(*model, layer, prior)), of + "predicted", ".png")
            << figure(matrixPicture(sampledMatrix(truthOfLayer(pair.truth, layer), upper, int(prior.size()))),
                      of + "sampled", ".png")
            << "</div>\n";
    }
    return out.str();
}

String runtimeChart(const String& title, const std::vector<RuntimePair>& pairs)
{
    double low = std::numeric_limits<double>::max(), high = 0, fastest = 0;
    for (const RuntimePair& p : pairs)
    {
        fastest = std::max(fastest, p.other / p.method);
        low = std::min(low, std::min(p.other, p.method));
        high = std::max(high, std::max(p.other, p.method));
    }
    if (!(high > 0))
        return String();
    const double bottom = std::floor(std::log10(low)), top = std::max(std::ceil(std::log10(high)), bottom + 1);
    const int left = 60, height = 220, above = 56, step = 54,
              width = std::max(left + step * int(pairs.size()) + 10, 460);
    const auto level = [&](double seconds) { return above + height * (top - std::log10(seconds)) / (top - bottom); };

    std::ostringstream out;
    out << "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\""
        << above + height + 80 << "\">\n<text x=\"0\" y=\"16\" class=\"title\">" << htmlText(title) << "</text>\n";
    for (double power = bottom; power <= top; power++)
    {
        const double y = level(std::pow(10., power));
        out << cv::format("<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" class=\"grid\"/>"
                          "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g s</text>\n",
                          left, width, y, y, left - 6, y + 4, std::pow(10., power));
    }
    for (size_t i = 0; i < pairs.size(); i++)
    {
        const RuntimePair& p = pairs[i];
        const double x = left + 10 + double(i) * step, seconds[2] = { p.other, p.method };
        for (int bar = 0; bar < 2; bar++)
            out << cv::format("<rect x=\"%.1f\" y=\"%.1f\" width=\"16\" height=\"%.1f\" class=\"%s\"><title>%.3f s"
                              "</title></rect>\n",
                              x + 18 * bar, level(seconds[bar]), above + height - level(seconds[bar]),
                              bar ? "hdp" : "plain", seconds[bar]);
        const double speedUp = p.other / p.method, y = above + height * (1 - speedUp / fastest);
        out << cv::format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/><text x=\"%.1f\" y=\"%.1f\" "
                          "text-anchor=\"middle\">%.1fx</text>\n",
                          x + 17, y, x + 17, y - 8, speedUp);
        out << cv::format("<text transform=\"translate(%.1f,%d) rotate(-45)\" text-anchor=\"end\">%s</text>\n", x + 20,
                          above + height + 14, htmlText(p.scene).c_str());
    }
    out << "</svg>\n";
    return out.str();
}

String htmlPage(const String& title, const String& body)
{
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + htmlText(title) +
           "</title>\n<style>\n"
           "body { font: 15px/1.4 sans-serif; margin: 24px; color: #222; }\n"
           "table { border-collapse: collapse; font-size: 13px; }\n"
           "th, td { padding: 3px 8px; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap; }\n"
           "th { white-space: normal; vertical-align: bottom; max-width: 130px; }\n"
           "th:first-child, td:first-child { text-align: left; }\n"
           ".wide th, .wide td { padding: 3px 5px; }\n"
           ".wide th:not(:first-child) { writing-mode: vertical-rl; transform: rotate(180deg); white-space: nowrap; "
           "text-align: left; }\n"
           "td.best { font-weight: bold; }\n"
           ".problem { color: #c0392b; }\n"
           ".scroll { overflow-x: auto; }\n"
           ".figures { display: flex; flex-wrap: wrap; gap: 12px; align-items: flex-start; margin-bottom: 12px; }\n"
           ".pair { display: flex; gap: 12px; }\n"
           "figure { margin: 0; max-width: 360px; }\n"
           "figcaption { font-size: 12px; color: #555; }\n"
           ".chart { display: inline-block; font-size: 11px; margin: 12px 0; }\n"
           ".chart .title { font-size: 14px; font-weight: bold; }\n"
           ".chart .grid { stroke: #ddd; }\n"
           ".chart .plain { fill: #9db4c8; }\n"
           ".chart .hdp { fill: #1f5a8c; }\n"
           ".chart circle { fill: #c0392b; }\n"
           ".chart text { paint-order: stroke; stroke: #fff; stroke-width: 3px; }\n"
           "</style>\n</head>\n<body>\n<h1>" +
           htmlText(title) + "</h1>\n" + body + "</body>\n</html>\n";
}

} // namespace hdp_tools
