// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The pictures, charts and page of hdp_evaluate's report. All of it is in the page: pictures as data URIs, charts as
// inline SVG.

#ifndef OPENCV_HDPSTEREO_SAMPLES_REPORT_HPP
#define OPENCV_HDPSTEREO_SAMPLES_REPORT_HPP

#include "hdp_layers.hpp"
#include "hdp_tables.hpp"

namespace hdp_samples {

const int PICTURE_WIDTH = 360;

inline String base64(const std::vector<uchar>& bytes)
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

//! A figure of the page. Photographs and maps are reduced to PICTURE_WIDTH, small matrices enlarged.
inline String figure(const Mat& picture, const String& caption, const String& extension = ".jpg",
                     int interpolation = cv::INTER_AREA)
{
    Mat shown = picture;
    if (picture.cols > PICTURE_WIDTH)
        cv::resize(picture, shown, cv::Size(PICTURE_WIDTH, std::max(picture.rows * PICTURE_WIDTH / picture.cols, 1)), 0,
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

//! A map in colors; wrong pixels (err>=2, or KITTI's D1) red, pixels that are not judged black.
inline Mat resultPicture(const Mat& disparity, const Pair& pair)
{
    if (pair.protocol == Pair::NO_TRUTH)
        return colorPicture(disparity);
    Mat picture = colorPicture(disparity, colorRange(pair.truth));
    Mat error, wrong;
    cv::absdiff(disparity, pair.truth, error);
    if (pair.protocol == Pair::KITTI)
        wrong = (error > 3) & (error > 0.05 * pair.truth);
    else
        wrong = error >= 2;
    picture.setTo(cv::Scalar(0, 0, 255), wrong & pair.judged);
    if (pair.protocol == Pair::MIDDLEBURY) // KITTI's truth is too sparse for it
        picture.setTo(cv::Scalar::all(0), ~pair.judged);
    return picture;
}

//! Every tree in a color of its own, by its number
inline Mat forestPicture(const Mat& trees)
{
    Mat picture(trees.size(), CV_8UC3);
    for (int y = 0; y < trees.rows; y++)
        for (int x = 0; x < trees.cols; x++)
        {
            const unsigned hash = (unsigned(trees.at<int>(y, x)) + 1) * 2654435761u;
            picture.at<cv::Vec3b>(y, x) = cv::Vec3b(uchar(hash >> 24), uchar(hash >> 16), uchar(hash >> 8));
        }
    return picture;
}

//! Number of candidates of each pixel: violet for 1 to yellow for all, in equal steps of the logarithm
inline Mat widthPicture(const Mat& intervals, int numDisparities)
{
    Mat picture(intervals.size(), CV_8U);
    for (int y = 0; y < intervals.rows; y++)
        for (int x = 0; x < intervals.cols; x++)
        {
            const cv::Vec2w interval = intervals.at<cv::Vec2w>(y, x);
            const double width = std::max(interval[1] - interval[0] + 1, 1);
            picture.at<uchar>(y, x) =
                cv::saturate_cast<uchar>(255 * std::log(width) / std::log(std::max(numDisparities, 2)));
        }
    cv::applyColorMap(picture, picture, cv::COLORMAP_VIRIDIS);
    return picture;
}

//! P(D_l | D_{l+1}): a row for every D_{l+1}, its largest element white. Rows without any are black.
inline Mat matrixPicture(const cv::Mat_<double>& matrix)
{
    Mat picture(matrix.size(), CV_8U);
    for (int i = 0; i < matrix.rows; i++)
    {
        double largest = 0;
        cv::minMaxLoc(matrix.row(i), 0, &largest);
        matrix.row(i).convertTo(picture.row(i), CV_8U, largest > 0 ? 255 / largest : 0);
    }
    Mat enlarged;
    const int factor = std::max(256 / picture.cols, 1);
    cv::resize(picture, enlarged, cv::Size(), factor, factor * 2, cv::INTER_NEAREST); // D_{l+1} counts double
    cv::applyColorMap(enlarged, picture, cv::COLORMAP_INFERNO);
    return picture;
}

//! The model's P(D_l | D_{l+1}) up to a factor for each row: rows D_{l+1}, columns D_l.
inline cv::Mat_<double> predictedMatrix(const DisparityPredictionModel& model, int layer,
                                        const std::vector<double>& prior)
{
    cv::Mat_<double> matrix((int(prior.size()) - 1) / 2 + 1, int(prior.size()));
    for (int i = 0; i < matrix.rows; i++)
        for (int j = 0; j < matrix.cols; j++)
            matrix(i, j) = model.density(layer, i - j / 2) * prior[j];
    return matrix;
}

//! How often true D_l and estimated D_{l+1} come together; maps in pixels of their layers.
inline cv::Mat_<double> sampledMatrix(const Mat& truth, const Mat& upper, int numDisparities)
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

/** Figures of the forest, of the intervals, and of P(D_l | D_{l+1}) by the model and by the truth.
@param matcher One with predicted intervals that has just matched the pair.
@param create Makes another one like it, of so many candidates. */
inline String predictionFigures(const String& name, const HDPTreeMatcher& matcher,
                                const std::function<Ptr<cv::StereoMatcher>(int)>& create, const Pair& pair)
{
    std::ostringstream out;
    Mat trees, intervals;
    matcher.getForest(trees, intervals);
    double last = 0;
    cv::minMaxLoc(trees, 0, &last);
    std::vector<double> ratios, prior;
    matcher.getSearchRatios(ratios);
    out << figure(forestPicture(trees), cv::format("%s: %d disparity trees", name.c_str(), int(last) + 1), ".jpg",
                  cv::INTER_NEAREST);
    out << figure(widthPicture(intervals, matcher.getNumDisparities()),
                  cv::format("%s: candidates of each pixel, violet 1 to yellow %d (logarithmic), mean %.2f",
                             name.c_str(), matcher.getNumDisparities(), ratios[0] * matcher.getNumDisparities()));
    matcher.getLayerPrior(prior);
    if (pair.protocol == Pair::NO_TRUTH || prior.empty())
        return out.str();

    // Layer by layer downwards; the priors of the layers above, and the maps there, are those of smaller matchers.
    const int width = pair.left.cols, layers = int(ratios.size());
    Ptr<DisparityPredictionModel> model = matcher.getPredictionModel();
    if (!model)
        model = publishedModel(width);
    Mat left = pair.left, right = pair.right;
    for (int layer = 0; layer + 1 < layers; layer++)
    {
        left = nextLayer(left);
        right = nextLayer(right);
        const Ptr<HDPTreeMatcher> above =
            create(disparitiesOfLayer(matcher.getNumDisparities(), layer + 1)).dynamicCast<HDPTreeMatcher>();
        adaptToLayer(*above, layer + 1, layers, width, upperPart(*model, layer + 1));
        Mat upper;
        above->compute(left, right, upper);
        const int disparities = disparitiesOfLayer(matcher.getNumDisparities(), layer);
        const String of = cv::format("P(D%d | D%d), %s: ", layer, layer + 1, name.c_str());
        out << "<div class=\"pair\">\n"
            << figure(matrixPicture(predictedMatrix(*model, layer, prior)), of + "predicted", ".png")
            << figure(matrixPicture(sampledMatrix(truthOfLayer(pair.truth, layer), toPixels(upper, 0), disparities)),
                      of + "sampled", ".png")
            << "</div>\n";
        above->getLayerPrior(prior);
    }
    return out.str();
}

//! A bar of the paper's runtime figure
struct RuntimePair
{
    String scene;
    double fullRange, predicted; // seconds
};

//! The paper's runtime figure for one tree: two bars a scene, seconds on a logarithmic axis, and the speed-up as circles
//! on a linear one, whose top is the largest.
inline String runtimeChart(const String& title, const std::vector<RuntimePair>& pairs)
{
    double low = std::numeric_limits<double>::max(), high = 0, fastest = 0;
    for (const RuntimePair& p : pairs)
    {
        fastest = std::max(fastest, p.fullRange / p.predicted);
        low = std::min(low, std::min(p.fullRange, p.predicted));
        high = std::max(high, std::max(p.fullRange, p.predicted));
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
        const double x = left + 10 + double(i) * step, seconds[2] = { p.fullRange, p.predicted };
        for (int bar = 0; bar < 2; bar++)
            out << cv::format("<rect x=\"%.1f\" y=\"%.1f\" width=\"16\" height=\"%.1f\" class=\"%s\"><title>%.3f s"
                              "</title></rect>\n",
                              x + 18 * bar, level(seconds[bar]), above + height - level(seconds[bar]),
                              bar ? "hdp" : "plain", seconds[bar]);
        const double speedUp = p.fullRange / p.predicted, y = above + height * (1 - speedUp / fastest);
        out << cv::format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/><text x=\"%.1f\" y=\"%.1f\" "
                          "text-anchor=\"middle\">%.1fx</text>\n",
                          x + 17, y, x + 17, y - 8, speedUp);
        out << cv::format("<text transform=\"translate(%.1f,%d) rotate(-45)\" text-anchor=\"end\">%s</text>\n", x + 20,
                          above + height + 14, htmlText(p.scene).c_str());
    }
    out << "</svg>\n";
    return out.str();
}

inline String htmlPage(const String& title, const String& body)
{
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + htmlText(title) +
           "</title>\n<style>\n"
           "body { font: 15px/1.4 sans-serif; margin: 24px; color: #222; }\n"
           "table { border-collapse: collapse; font-size: 13px; }\n"
           "th, td { padding: 3px 8px; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap; }\n"
           "th:first-child, td:first-child { text-align: left; }\n"
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

} // namespace hdp_samples

#endif
