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

HDP_TUNABLE(int, windowRadius, 12, "pixels of the upper layer",
            "of the window: more mixes surfaces that differ, less counts too few steps");
HDP_TUNABLE(double, typical, 7.3, "natural logarithms per logarithm",
            "of pairs that the penalties are right for as they are: more loses bare surfaces, less loses details");
HDP_TUNABLE(double, leastShare, 0.001, "share of neighbours",
            "that may be apart where none are: more makes flat scenes rough, less drags surfaces across borders");

HDP_DISPATCH(findTermsOfRow)

// Units of the tables: residuals in the sum of a window, parts of what is in them
const int sumBits = 7, stepUnit = 256, evidenceUnit = 4096, productUnit = stepUnit * evidenceUnit;

int windowSide() { return 2 * windowRadius + 1; }

//! What a step costs, -ln(q + least), by the number of breaks in a window
void tabulateStepCosts(std::vector<ushort>& stepCosts)
{
    const int edges = 2 * windowSide() * windowSide();
    stepCosts.resize(edges + 1);
    for (int breaks = 0; breaks <= edges; ++breaks)
        stepCosts[breaks] =
            saturate_cast<ushort>(stepUnit * -std::log(std::min((double)breaks / edges + leastShare, 1.)));
}

//! 1 / (typical * evidence(r)), by the sum of the residuals in a window
void tabulateInverseEvidence(int bits, std::vector<ushort>& inverseEvidence)
{
    const double pixels = windowSide() * windowSide(), half = 1 << (sumBits - 1);
    inverseEvidence.resize((int)(pixels * (bits / 2)) / (1 << sumBits) + 1);
    for (size_t i = 0; i < inverseEvidence.size(); ++i)
    {
        const double r = std::min((i * (1 << sumBits) + half) / (pixels * bits), 0.45); // of chance, nearly
        inverseEvidence[i] = saturate_cast<ushort>(evidenceUnit / (typical * (0.5 - r) * std::log((1 - r) / r)));
    }
}

} // namespace

void weighSmoothness(const Mat& upper, const Mat& residual, int bits, int least, SmoothnessBuffers& buffers,
                     Mat& weights)
{
    buffers.matched.create(upper.size(), CV_8U);
    buffers.breaks.create(upper.size(), CV_8U);
    parallelFor(upper.rows, [&](int y) {
        dispatched::findTermsOfRow(upper.ptr<ushort>(y), upper.ptr<ushort>(std::min(y + 1, upper.rows - 1)),
                                   residual.ptr(y), upper.cols, bits, buffers.matched.ptr(y), buffers.breaks.ptr(y));
    });
    sumOverWindows(buffers.matched, windowSide(), CV_16U, buffers.matchedSums);
    sumOverWindows(buffers.breaks, windowSide(), CV_16U, buffers.breakSums);
    tabulateStepCosts(buffers.stepCosts);
    tabulateInverseEvidence(bits, buffers.inverseEvidence);
    weights.create(upper.size(), CV_8U);
    const ushort *const stepCosts = buffers.stepCosts.data(), *const inverseEvidence = buffers.inverseEvidence.data();
    parallelFor(upper.rows, [&](int y) {
        const ushort* const matched = buffers.matchedSums.ptr<ushort>(y);
        const ushort* const breaks = buffers.breakSums.ptr<ushort>(y);
        uchar* const weight = weights.ptr(y);
        for (int x = 0; x < upper.cols; ++x)
        {
            const int product = stepCosts[breaks[x]] * inverseEvidence[matched[x] >> sumBits];
            weight[x] = (uchar)clamped(product / (productUnit / SmoothnessWeight::one), least, +SmoothnessWeight::max);
        }
    });
}

}}} // namespace cv::stereo::hdp
