// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "smoothness_weights.hpp"
#include "smoothness_weights.simd.hpp"
#include "scanlines/smoothness_weights.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/window_sums.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, typical, 7.3, "natural logarithms per logarithm",
            "of pairs that the penalties are right for as they are: more loses bare surfaces, less loses details");
HDP_TUNABLE(double, leastShare, 0.001, "share of neighbours",
            "that may be apart where none are: more makes flat scenes rough, less drags surfaces across borders");

HDP_DISPATCH(findTermsOfRow)

const int stripeHeight = 64; // rows that are in the caches at once: fewer find the rows between stripes more often

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

//! The costs and the breaks of a layer in the windows around some of its rows
struct WindowTerms
{
    Mat matchedSums, breakSums;

    WindowTerms(const Mat& upper, const Mat& residual, int bits, int radius, const Range& rows,
                SmoothnessScratch& scratch)
    {
        const Range seen(std::max(rows.start - radius, 0), std::min(rows.end + radius, upper.rows));
        const int cols = upper.cols;
        Mat matched(seen.size(), cols, CV_8U, grown(scratch.matched, (size_t)seen.size() * cols));
        Mat breaks(seen.size(), cols, CV_8U, grown(scratch.breaks, (size_t)seen.size() * cols));
        for (int y = seen.start; y < seen.end; ++y)
            dispatched::findTermsOfRow(upper.ptr<ushort>(y), upper.ptr<ushort>(std::min(y + 1, upper.rows - 1)),
                                       residual.ptr(y), cols, bits, matched.ptr(y - seen.start),
                                       breaks.ptr(y - seen.start));
        const Range own = rows - seen.start;
        matchedSums = Mat(own.size(), cols, CV_16U, grown(scratch.matchedSums, (size_t)own.size() * cols));
        breakSums = Mat(own.size(), cols, CV_16U, grown(scratch.breakSums, (size_t)own.size() * cols));
        sumOverWindows(matched, own, sideOf(radius), CV_16U, matchedSums);
        sumOverWindows(breaks, own, sideOf(radius), CV_16U, breakSums);
    }
};

} // namespace

void weighSmoothness(const Mat& upper, const Mat& residual, int bits, const SmoothnessPlan& plan,
                     SmoothnessBuffers& buffers, Mat& weights)
{
    const std::vector<ushort> steps = stepCosts(plan.radius), inverse = inverseEvidence(plan.radius, bits);
    const int unit = productUnit / SmoothnessWeight::one;
    weights.create(upper.size(), CV_8U);
    const int stripes = (upper.rows + stripeHeight - 1) / stripeHeight;
    parallelFor(stripes, [&](int i) {
        const Range rows(i * stripeHeight, std::min((i + 1) * stripeHeight, upper.rows));
        const WindowTerms terms(upper, residual, bits, plan.radius, rows, buffers.getRef());
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* const matched = terms.matchedSums.ptr<ushort>(y - rows.start);
            const ushort* const breaks = terms.breakSums.ptr<ushort>(y - rows.start);
            uchar* const weight = weights.ptr(y);
            for (int x = 0; x < upper.cols; ++x)
            {
                const int product = steps[breaks[x]] * inverse[matched[x] >> sumBits];
                weight[x] = (uchar)clamped(product / unit, plan.least, plan.most);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
