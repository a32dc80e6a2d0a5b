// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "scanline_aggregation.hpp"
#include "scanline_aggregation.simd.hpp"
#include "scanlines/scanline_aggregation.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, stripeHeight, 128, "rows", "about: fewer rows are more warm-up, more leave threads without work");
HDP_TUNABLE(double, bluntSlope, 13, "bits per direction",
            "of a minimum's steeper side: up to it the fraction is mostly noise, and the tip of two lines is better");
HDP_TUNABLE(double, sharpSlope, 22, "bits per direction",
            "from which on the tip is too near to whole disparities, and its root is better");

HDP_DISPATCH(aggregateStripe)

} // namespace

void ScanlineScratch::Windows::prepare(size_t pairs)
{
    const size_t columns = pairs + 2 * margin;
    for (std::vector<uchar>* ofCandidates : { &priors, &intoSide, &intoNext })
        ofCandidates->resize(columns * CandidateWindow::candidates);
    isContiguous.assign(columns, 0);
    small.resize(columns + 16); // some more to read
    for (int run = 0; run < CandidateWindow::runs; ++run)
    {
        first[run].assign(columns, 0); // of the margins' candidates, too, the addresses are valid
        distance[run].resize(columns);
        firstOfColumn[run].resize(2 * pairs);
    }
    for (std::vector<uchar>* ofColumn : { &slopes, &large, &least })
        ofColumn->resize(2 * pairs);
}

void ScanlineScratch::Block::prepare(size_t pairs)
{
    const size_t columns = maxRows * (2 * pairs + 2 * margin);
    edges.resize(2 * columns + 16); // some more to read
    winners.resize(columns);
    winnerCosts.resize(columns);
    for (std::vector<uchar>& sums : winnerSums)
        sums.resize(columns);
}

void ScanlineScratch::prepare(int width, int numDisparities)
{
    const size_t pairs = ((size_t)width + 1) / 2;
    vertical.assign((2 * pairs + 2 * margin) * CandidateWindow::candidates + alignment, 0);
    for (int i = 0; i < blocks; ++i)
    {
        windows[i].prepare(pairs);
        ofBlocks[i].prepare(pairs);
    }
    const int length = CandidateWindow::runLength, farthest = numDisparities + CandidateWindow::candidates;
    for (int run = 0; run < CandidateWindow::runs; ++run)
    {
        orders[run].assign(2 * (farthest + length), 255);
        for (int i = 0; i < length; ++i)
            orders[run][farthest + length + i] = (uchar)(run * length + i);
    }
}

void aggregateScanlines(const CensusCost& cost, const Mat& weights, const ImageFrame& frame, int numDisparities,
                        int maxDisparity, const Mat& windows, const Mat& smoothness, const ScanlinePenalties& penalties,
                        ScanlineBuffers& buffers, Mat& disparity, Mat& residual)
{
    const Size size = weights.size();
    const float blunt = 4 * (float)bluntSlope, sharp = 4 * (float)sharpSlope; // of sums of four directions
    Mat ofPairs[] = { windows, smoothness };
    for (Mat& pairs : ofPairs) // an odd last column belongs to the pixel of the layer above that the one before does
        copyMakeBorder(pairs, pairs, 0, 0, 0, (size.width + 1) / 2 - pairs.cols, BORDER_REPLICATE);
    const ScanlineProblem problem = { &cost,       &weights,    size,      numDisparities, maxDisparity,
                                      &ofPairs[0], &ofPairs[1], penalties, blunt,          sharp };
    const std::vector<ScanlineStripe> stripes = stripesOf(frame, size.height, stripeHeight);
    disparity.create(size, CV_16U);
    residual.create(size, CV_8U);
    int storedRows = ScanlineScratch::blocks * ScanlineScratch::maxRows;
    for (const ScanlineStripe& stripe : stripes)
        storedRows = std::max(storedRows, (stripe.rows.end - stripe.reach.start + 1) / 2 * 2);
    parallelFor((int)stripes.size(), buffers, [&](int i, ScanlineScratch& scratch) {
        scratch.stored.create(storedRows, (int)ScanlineScratch::storedBytes(size.width), CV_8U);
        dispatched::aggregateStripe(problem, stripes[i], scratch, disparity, residual);
    });
}

}}} // namespace cv::stereo::hdp
