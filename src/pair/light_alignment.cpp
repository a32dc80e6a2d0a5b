// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "light_alignment.hpp"
#include "light_alignment.simd.hpp"
#include "pair/light_alignment.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "image_levels.hpp"
#include "../base/fits.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const double white = 255 * greyScale; // level 1 of the model
HDP_TUNABLE(int, meanRadius, 3, "pixels", "of the square around a corner whose mean level counts: noise averages out");
const double levelDeviation = 0.5 / 255; // of white, by which matched levels differ at best: they are rounded
HDP_TUNABLE(double, maxRest, 4. / 255, "of white", "median difference that a model which fits may leave");
HDP_TUNABLE(double, maxRestShare, 0.7, "share", "of that difference before the model: one that explains less is none");

// Expected deviations of the coefficients from those of the same light. What vignetting and gamma do is within them;
// what few matches cannot tell stays as it is.
HDP_TUNABLE(double, deviation, 0.3, "factor, or of white", "exposures differ by half a stop, and all else by no more");
HDP_TUNABLE(double, rimDeviation, 1, "factor per fourth power of the width",
            "vignetting of the corners, where it is steep");

HDP_DISPATCH(relightRow)

typedef LightModel::Coefficients Coefficients;
typedef FitSample<LightModel::terms> LevelPair; // a match: the basis of the right level, the left level

double meanLevel(const Mat& image, Point centre)
{
    const int side = 2 * meanRadius + 1;
    const Rect square(centre.x - meanRadius, centre.y - meanRadius, side, side);
    return sum(image(square))[0] / (side * side * white);
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
        pairs.push_back(
            { LightModel::basis(meanLevel(right, matched), x, y), meanLevel(left, match.left), levelDeviation });
    }
    return pairs;
}

} // namespace

bool estimateLight(const CoarseMatches& coarse, LightModel& model)
{
    model = LightModel();
    const std::vector<LevelPair> pairs = toLevels(coarse);
    if ((int)pairs.size() < CornerMatching::minMatches)
        return false;
    FitPrior<LightModel::terms> same = { LightModel::identity(), Coefficients::all(deviation) };
    same.deviations[LightModel::rim] = rimDeviation;
    model.coefficients = fitRobustly(pairs, same, same.coefficients).coefficients;
    const double before = levelDeviation * medianOf(fitResiduals(pairs, same.coefficients));
    const double rest = levelDeviation * medianOf(fitResiduals(pairs, model.coefficients));
    return rest < maxRest && rest < maxRestShare * before;
}

void alignLight(Mat& levels, const LightModel& model, const ImageFrame& frame)
{
    typedef LightModel L;
    const Coefficients& c = model.coefficients;
    RowLight ofAll = RowLight();
    ofAll.offset = (float)(c[L::offset] * white);
    ofAll.square = (float)(c[L::square] / white);
    ofAll.cube = (float)(c[L::cube] / (white * white));
    ofAll.largest = (float)whiteLevel;
    ofAll.step = 1.f / frame.whole.width;
    ofAll.first = 0.5f * ofAll.step - 0.5f;
    ofAll.origin = frame.origin.x;
    parallelForRows(levels.size(), [&](int i) {
        const double y = (i + frame.origin.y + 0.5) / frame.whole.height - 0.5, y2 = y * y;
        RowLight light = ofAll;
        // (x^2 + y^2)^2 = y^4 + 2 y^2 x^2 + x^4
        light.gain[0] = (float)(c[L::gain] + c[L::gainY] * y + c[L::gainYY] * y2 + c[L::rim] * y2 * y2);
        light.gain[1] = (float)(c[L::gainX] + c[L::gainXY] * y);
        light.gain[2] = (float)(c[L::gainXX] + 2 * c[L::rim] * y2);
        light.gain[3] = (float)c[L::rim];
        dispatched::relightRow(light, levels.cols, levels.ptr<ushort>(i));
    });
}

}}} // namespace cv::stereo::hdp
