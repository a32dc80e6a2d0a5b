// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "smoothness_weights.hpp"

#include "../base/vectorized.hpp"
#include "../base/window_sums.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, typical, 7.3, "natural logarithms per logarithm",
            "of pairs that the penalties are right for as they are: more loses bare surfaces, less loses details");
HDP_TUNABLE(double, leastShare, 0.001, "share of neighbours",
            "that may be apart where none are: more makes flat scenes rough, less drags surfaces across borders");

// Units of the tables: residuals in the sum of a window, parts of what is in them
const int sumBits = 7, stepUnit = 256, evidenceUnit = 4096, productUnit = stepUnit * evidenceUnit;

int sideOf(int radius) { return 2 * radius + 1; }

//! What a step costs, -ln(q + least), by the number of breaks in a window
std::vector<ushort> stepCosts(int radius)
{
    const int edges = 2 * sideOf(radius) * sideOf(radius);
    std::vector<ushort> costs(edges + 1);
    for (int breaks = 0; breaks <= edges; ++breaks)
        costs[breaks] = saturate_cast<ushort>(stepUnit * -std::log(std::min((double)breaks / edges + leastShare, 1.)));
    return costs;
}

//! 1 / (typical * evidence(r)), by the sum of the residuals in a window
std::vector<ushort> inverseEvidence(int radius, int bits)
{
    const double pixels = sideOf(radius) * sideOf(radius), half = 1 << (sumBits - 1);
    std::vector<ushort> inverse((int)(pixels * (bits / 2)) / (1 << sumBits) + 1);
    for (size_t i = 0; i < inverse.size(); ++i)
    {
        const double r = std::min((i * (1 << sumBits) + half) / (pixels * bits), 0.45); // of chance, nearly
        inverse[i] = saturate_cast<ushort>(evidenceUnit / (typical * (0.5 - r) * std::log((1 - r) / r)));
    }
    return inverse;
}

ushort isBreak(ushort a, ushort b) { return (ushort)(difference(a, b) > (ushort)subpixelScale); }

/** What a row shows of both terms.
@param below Those of the next row, or its own if it is the last one.
@param matched Receives the costs, by chance at most; pixels without data have a usual one.
@param breaks Receives how many of a pixel's neighbours to the right and below are another surface. */
void findTerms(const ushort* upper, const ushort* below, const uchar* residual, int width, int bits, uchar* matched,
               uchar* breaks)
{
    const uchar usual = (uchar)(bits / 8), chance = (uchar)(bits / 2);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const uchar cost = std::min(residual[x], chance);
        matched[x] = residual[x] == UCHAR_MAX ? usual : cost;
    }
    HDP_VECTORIZED for (int x = 0; x < width - 1; ++x) breaks[x] =
        (uchar)(isBreak(upper[x], upper[x + 1]) + isBreak(upper[x], below[x]));
    breaks[width - 1] = (uchar)isBreak(upper[width - 1], below[width - 1]);
}

} // namespace

void weighSmoothness(const Mat& upper, const Mat& residual, int bits, const SmoothnessPlan& plan, Mat& weights)
{
    const Size size = upper.size();
    Mat matched(size, CV_8U), breaks(size, CV_8U), matchedSums, breakSums;
    parallelForRows(size, [&](int y) {
        findTerms(upper.ptr<ushort>(y), upper.ptr<ushort>(std::min(y + 1, size.height - 1)), residual.ptr(y),
                  size.width, bits, matched.ptr(y), breaks.ptr(y));
    });
    sumOverWindows(matched, sideOf(plan.radius), CV_16U, matchedSums);
    sumOverWindows(breaks, sideOf(plan.radius), CV_16U, breakSums);
    const std::vector<ushort> steps = stepCosts(plan.radius), inverse = inverseEvidence(plan.radius, bits);
    const int unit = productUnit / SmoothnessWeight::one;
    weights.create(size, CV_8U);
    parallelForRows(size, [&](int y) {
        const ushort *matchedSum = matchedSums.ptr<ushort>(y), *breakSum = breakSums.ptr<ushort>(y);
        uchar* const weight = weights.ptr(y);
        for (int x = 0; x < size.width; ++x)
        {
            const int product = steps[breakSum[x]] * inverse[matchedSum[x] >> sumBits];
            weight[x] = (uchar)clamped(product / unit, plan.least, plan.most);
        }
    });
}

}}} // namespace cv::stereo::hdp
