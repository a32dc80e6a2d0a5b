// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "scores.hpp"

#include <algorithm>
#include <cmath>

namespace hdp_tools {

Score::Score()
    : error1(NO_SCORE), error2(NO_SCORE), badHalf(NO_SCORE), bad1(NO_SCORE), bad2(NO_SCORE), bad4(NO_SCORE),
      d1(NO_SCORE), d1NonOccluded(NO_SCORE), invalid(NO_SCORE), average(NO_SCORE), occluded(NO_SCORE),
      sparsification(NO_SCORE), leastSparsification(NO_SCORE)
{
}

//! Pixels of a mask that are wrong by the pair's main score
static Mat wrongPixelsOf(const Mat& disparity, const Pair& pair, const Mat& pixels)
{
    if (pair.protocol == Pair::KITTI)
        return wrongPixelsD1(disparity, pair.truth, pixels);
    if (pair.protocol == Pair::MIDDLEBURY)
        return wrongPixels(disparity, pair.truth, pixels, 2);
    Mat error;
    cv::absdiff(disparity, pair.truth, error);
    return (error > 2) & pixels;
}

//! Of known truth
static Mat occludedPixels(const Pair& pair)
{
    return pair.judgedNonOccluded.empty() ? knownPixels(pair.truth) & ~pair.judged
                                          : pair.judged & ~pair.judgedNonOccluded;
}

Score scoreMap(const Mat& disparity, const Pair& pair)
{
    Score score;
    if (pair.protocol == Pair::NO_TRUTH)
        return score;
    const auto share = [&](const Mat& pixels) { return percent(pixels & pair.judged, pair.judged); };
    Mat error;
    cv::absdiff(disparity, pair.truth, error);
    score.error1 = share(error >= 1);
    score.error2 = share(error >= 2);
    score.badHalf = share(error > 0.5);
    score.bad1 = share(error > 1);
    score.bad2 = share(error > 2);
    score.bad4 = share(error > 4);
    score.d1 = percent(wrongPixelsD1(disparity, pair.truth, pair.judged), pair.judged);
    if (!pair.judgedNonOccluded.empty())
        score.d1NonOccluded =
            percent(wrongPixelsD1(disparity, pair.truth, pair.judgedNonOccluded), pair.judgedNonOccluded);
    score.invalid = share(~knownPixels(disparity));
    error.setTo(0, ~pair.judged);
    score.average = cv::sum(cv::min(error, 64))[0] / std::max(cv::countNonZero(pair.judged), 1);
    const Mat occluded = occludedPixels(pair);
    if (cv::countNonZero(occluded) > 0)
        score.occluded = percent(wrongPixelsOf(disparity, pair, occluded), occluded);
    return score;
}

String mainScoreName(Pair::Protocol protocol)
{
    return protocol == Pair::KITTI ? "D1" : protocol == Pair::BAD ? "bad 2.0" : "err>=2";
}

double mainScore(const Score& score, Pair::Protocol protocol)
{
    return protocol == Pair::KITTI ? score.d1 : protocol == Pair::BAD ? score.bad2 : score.error2;
}

Mat wrongPixels(const Mat& disparity, const Pair& pair) { return wrongPixelsOf(disparity, pair, pair.judged); }

void findSparsification(const Mat& wrong, const Mat& judged, const Mat& confidence, Score& score)
{
    double count[256] = {}, wrongCount[256] = {}; // by confidence
    for (int y = 0; y < judged.rows; y++)
        for (int x = 0; x < judged.cols; x++)
            if (judged.at<uchar>(y, x))
            {
                count[confidence.at<uchar>(y, x)]++;
                wrongCount[confidence.at<uchar>(y, x)] += wrong.at<uchar>(y, x) != 0;
            }
    double pixels = 0, wrongPixels = 0, area = 0;
    for (int level = 255; level >= 0; level--)
    {
        if (count[level] == 0)
            continue;
        // Integral of (wrongPixels + rate * (n - pixels)) / n over n, the number of pixels so far
        const double rate = wrongCount[level] / count[level];
        area += rate * count[level];
        if (pixels > 0)
            area += (wrongPixels - rate * pixels) * std::log1p(count[level] / pixels);
        pixels += count[level];
        wrongPixels += wrongCount[level];
    }
    const double right = pixels - wrongPixels;
    const double least = right > 0 ? wrongPixels - right * std::log(pixels / right) : wrongPixels;
    score.sparsification = 100 * area / std::max(pixels, 1.);
    score.leastSparsification = 100 * least / std::max(pixels, 1.);
}

double meanOf(const std::vector<double>& values)
{
    double sum = 0;
    int count = 0;
    for (double value : values)
        if (!std::isnan(value))
        {
            sum += value;
            count++;
        }
    return count > 0 ? sum / count : NO_SCORE;
}

Score meanScore(const std::vector<Score>& scores)
{
    Score mean;
    for (double Score::*figure : { &Score::error1, &Score::error2, &Score::badHalf, &Score::bad1, &Score::bad2,
                                   &Score::bad4, &Score::d1, &Score::d1NonOccluded, &Score::invalid, &Score::average,
                                   &Score::occluded, &Score::sparsification, &Score::leastSparsification })
    {
        std::vector<double> values;
        for (const Score& score : scores)
            values.push_back(score.*figure);
        mean.*figure = meanOf(values);
    }
    return mean;
}

} // namespace hdp_tools
