// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "scanline_aggregation.hpp"
#include "scanline_aggregation.simd.hpp"
#include "scanline_aggregation.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// Of a stripe, about: stripes are of even number, so that also two threads have as much to do.
const int stripeHeight = 128;

// Rows above a stripe from which on the direction from above is followed
const int warmUpRows = 16;

void dispatchStripe(const ScanlineProblem& problem, int above, const Range& rows, ScanlineScratch& scratch,
                    Mat& disparity, Mat& residual)
{
    CV_CPU_DISPATCH(aggregateStripe, (problem, above, rows, scratch, disparity, residual), CV_CPU_DISPATCH_MODES_ALL);
}

} // namespace

void ScanlineScratch::prepare(int width)
{
    const size_t pairs = ((size_t)width + 1) / 2, upperColumns = pairs + 2 * margin;
    const size_t stepBytes = 2 * maxBlock * CandidateWindow::candidates,
                 blockBytes = (pairs + maxBlock - 1) * stepBytes;
    const size_t blockColumns = maxBlock * (2 * pairs + 2 * margin);
    costs.resize(blockBytes);
    fromRight.resize(blockBytes);
    fromAbove.assign((2 * pairs + 2 * margin) * CandidateWindow::candidates, 0);
    columns.assign(upperColumns, Column()); // of the margins' candidates, too, the addresses are valid
    for (std::vector<uchar>* stored : { &priors, &intoRight, &intoLeft, &intoBelow })
        stored->resize(upperColumns * CandidateWindow::candidates);
    for (std::vector<short>& run : first)
        run.resize(2 * pairs);
    winners.resize(blockColumns);
    winnerCosts.resize(blockColumns);
    winnerSums.resize(blockColumns);
}

void aggregateScanlines(const CensusCost& cost, Size size, int numDisparities, int largest, const Mat& windows,
                        const ScanlinePenalties& penalties, ScanlineBuffers& buffers, Mat& disparity, Mat& residual)
{
    const ScanlineProblem problem = { &cost, size, numDisparities, largest, &windows, penalties };
    const int stripes =
        size.height < stripeHeight / 2 ? 1 : 2 * std::max(1, cvRound(size.height / (2. * stripeHeight)));
    disparity.create(size, CV_16U);
    residual.create(size, CV_8U);
    buffers.stripes.resize(stripes);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
        {
            const auto border = [&](int64 index) { return (int)(size.height * index / stripes / 2 * 2); };
            const Range rows(border(i), i + 1 < stripes ? border(i + 1) : size.height);
            buffers.stripes[i].prepare(size.width);
            dispatchStripe(problem, std::max(rows.start - warmUpRows, 0), rows, buffers.stripes[i], disparity,
                           residual);
        }
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
