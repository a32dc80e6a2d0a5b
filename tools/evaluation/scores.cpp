// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "scores.hpp"

#include <algorithm>
#include <cmath>

namespace hdp_tools {

Score::Score()
    : error1(NO_SCORE), error2(NO_SCORE), badHalf(NO_SCORE), bad1(NO_SCORE), bad2(NO_SCORE), bad4(NO_SCORE),
      d1(NO_SCORE), d1NonOccluded(NO_SCORE), invalid(NO_SCORE), average(NO_SCORE)
{
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

Mat wrongPixels(const Mat& disparity, const Pair& pair)
{
    if (pair.protocol == Pair::KITTI)
        return wrongPixelsD1(disparity, pair.truth, pair.judged);
    if (pair.protocol == Pair::MIDDLEBURY)
        return wrongPixels(disparity, pair.truth, pair.judged, 2);
    Mat error;
    cv::absdiff(disparity, pair.truth, error);
    return (error > 2) & pair.judged;
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

} // namespace hdp_tools
