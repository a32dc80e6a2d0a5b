// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "range_scanlines.hpp"
#include "range_scanlines.simd.hpp"
#include "scanlines/range_scanlines.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../forest/forest_edges.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, rangeStripeHeight, 96, "rows", "about: more do not fit into a cache, fewer are more warm-up");

HDP_DISPATCH(aggregateRangeStripe)

} // namespace

void RangeProblem::prepare(const RangePenalties& penalties)
{
    small = (uchar)penalties.small;
    const EdgeSimilarity similarity(penalties.gamma);
    for (int w = 0; w < 256; ++w)
        large[w] = (uchar)std::max(penalties.leastLarge, cvRound(penalties.large * similarity.table[w]));
    priors.clear();
    for (int distance = -candidates; distance < candidates + longestVector; ++distance)
        priors.push_back((uchar)std::min(std::abs(distance) / penalties.priorDistance, penalties.maxPrior));
    outside.assign(3 * pixelBytes(), UCHAR_MAX);
    std::fill_n(outside.begin() + pixelBytes(), pixelBytes(), (uchar)0);
}

void RangeScratch::prepare(const RangeProblem& problem, int rows)
{
    width = problem.size.width;
    pixelBytes = problem.pixelBytes();
    bytes.resize((block * (size_t)(width + 4) + width * (size_t)(1 + rows)) * pixelBytes + 3 * alignment);
    const size_t pixelsOfBlock = (size_t)block * width;
    whole.resize(pixelsOfBlock);
    rise.resize(pixelsOfBlock);
    slope.resize(pixelsOfBlock);
}

void aggregateRange(const CensusCost& below, const ImageFrame& frame, int candidates, const Mat& upper,
                    const Mat& weights, const Mat& intervals, const RangePenalties& penalties, RangeBuffers& buffers,
                    Mat& disparity)
{
    CV_DbgAssert(std::max(std::max(penalties.small, penalties.large), penalties.leastLarge) <=
                     RangePenalties::largest &&
                 penalties.maxPrior <= RangePenalties::mostPrior && candidates <= RangeProblem::mostCandidates);
    const Size size = weights.size();
    RangeProblem problem = { below, size, candidates, upper, weights, intervals, 0, {}, {}, {} };
    problem.prepare(penalties);

    disparity.create(size, CV_16U);
    const std::vector<ScanlineStripe> stripes = stripesOf(frame, size.height, rangeStripeHeight);
    int rows = 0;
    for (const ScanlineStripe& stripe : stripes)
        rows = std::max(rows, stripe.rows.size());
    parallelFor((int)stripes.size(), buffers, [&](int i, RangeScratch& scratch) {
        scratch.prepare(problem, rows);
        dispatched::aggregateRangeStripe(problem, stripes[i], scratch, disparity);
    });
}

}}} // namespace cv::stereo::hdp
