// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "light_alignment.hpp"
#include "light_alignment.simd.hpp"
#include "pair/light_alignment.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

#include "image_levels.hpp"
#include "../base/robust_fit.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

const double white = 255 * greyScale;
const int meanRadius = 3; // of the square around a corner
const int leastMatches = 24;
const double leastDeviation = 0.5 / 255; // of the levels that matches see
const double leastChange = 1. / 255;     // root of the mean square at the matches that is worth a change
const double largestRest = 4. / 255;     // median difference of the levels that a model may leave, and
const double largestShare = 0.7;         // as a share of what it was

typedef LightModel::Coefficients Coefficients;
typedef FitSample<LightModel::terms> LevelPair; // a match: the basis of the right level, the left level

// Expected deviation of the coefficients from those of the same light. What vignetting and gamma do is within them; what
// few matches cannot tell stays as it is.
const Coefficients expected(0.3, 0.1, 0.1, 0.15, 0.15, 0.15, 1, 0.1, 0.15, 0.15);

HDP_DISPATCH(alignLightRow)

double meanLevel(const Mat& image, Point centre)
{
    int sum = 0;
    for (int y = centre.y - meanRadius; y <= centre.y + meanRadius; ++y)
        for (int x = centre.x - meanRadius; x <= centre.x + meanRadius; ++x)
            sum += image.at<ushort>(y, x);
    return sum / ((2 * meanRadius + 1) * (2 * meanRadius + 1) * white);
}

std::vector<LevelPair> toLevels(const CoarseMatches& coarse)
{
    const Mat &left = coarse.left[coarse.layer], &right = coarse.right[coarse.layer];
    const Rect inside(meanRadius, meanRadius, left.cols - 2 * meanRadius, left.rows - 2 * meanRadius);
    std::vector<LevelPair> pairs;
    for (const CornerMatch& match : coarse.matches)
    {
        const Point matched(cvRound(match.x), cvRound(match.y));
        if (!match.isValid || !inside.contains(match.left) || !inside.contains(matched))
            continue;
        const double x = (match.x + 0.5) / right.cols - 0.5, y = (match.y + 0.5) / right.rows - 0.5;
        const LevelPair pair = { LightModel::basis(meanLevel(right, matched), x, y), meanLevel(left, match.left),
                                 leastDeviation };
        pairs.push_back(pair);
    }
    return pairs;
}

} // namespace

bool estimateLight(const CoarseMatches& coarse, LightModel& model)
{
    model = LightModel();
    if (coarse.matches.empty())
        return false;
    const std::vector<LevelPair> pairs = toLevels(coarse);
    if ((int)pairs.size() < leastMatches)
        return false;
    const FitPrior<LightModel::terms> same = { LightModel::identity(), expected };
    model.coefficients = fitRobustly(pairs, same, same.coefficients).coefficients;
    double change = 0;
    for (const LevelPair& pair : pairs)
    {
        const double difference = model.coefficients.dot(pair.basis) - pair.basis[0];
        change += difference * difference / pairs.size();
    }
    const double before = leastDeviation * medianOf(fitResiduals(pairs, same.coefficients));
    const double rest = leastDeviation * medianOf(fitResiduals(pairs, model.coefficients));
    return change > leastChange * leastChange && rest < largestRest && rest < largestShare * before;
}

void alignLight(Mat& levels, const LightModel& model)
{
    const Coefficients& c = model.coefficients;
    const float curve[3] = { (float)(c[7] * white), (float)(c[8] / white), (float)(c[9] / (white * white)) };
    const float step = 1.f / levels.cols, first = 0.5f * step - 0.5f;
    parallel_for_(Range(0, levels.rows), [&](const Range& rows) {
        for (int row = rows.start; row < rows.end; ++row)
        {
            const double y = (row + 0.5) / levels.rows - 0.5, y2 = y * y;
            const float gain[4] = { (float)(c[0] + c[2] * y + c[5] * y2 + c[6] * y2 * y2), (float)(c[1] + c[4] * y),
                                    (float)(c[3] + 2 * c[6] * y2), (float)c[6] };
            dispatched::alignLightRow(levels.ptr<ushort>(row), levels.cols, first, step, gain, curve, (float)white);
        }
    });
}

}}} // namespace cv::stereo::hdp
