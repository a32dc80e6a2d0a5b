// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "volume_scanlines.hpp"

#include "../forest/forest_edges.hpp"
#include "volume_scanlines.simd.hpp"
#include "scanlines/volume_scanlines.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

// The most scanlines that are followed side by side. Columns are side by side in memory, too: as many of them as leave
// work for all threads.
const int blockRows = 8;

// Columns whose winners become disparities together
const int columnGroup = 16;

int blockColumns(int width) { return std::min(std::max(width / 256 * columnGroup, 32), +VolumeProblem::maxScanlines); }

HDP_DISPATCH(aggregateRows)
HDP_DISPATCH(aggregateColumns)

//! Calls aggregate(scanlines, memory) for blocks of whole groups of scanlines; an even number of them, so that also two
//! threads have as much to do.
template <typename Aggregate>
void runBlocks(const VolumeProblem& problem, int scanlines, int group, int block, const Aggregate& aggregate)
{
    const std::vector<short> memory(problem.lineMemory(block));
    const int groups = (scanlines + group - 1) / group, pairs = (scanlines + 2 * block - 1) / (2 * block);
    const int count = std::min(2 * pairs, groups);
    const auto firstOf = [&](int i) { return std::min(groups * i / count * group, scanlines); };
    parallelFor(count, memory,
                [&](int i, std::vector<short>& lines) { aggregate(Range(firstOf(i), firstOf(i + 1)), lines.data()); });
}

} // namespace

void aggregateVolume(const CostVolume& volume, const Mat& weights, const VolumePenalties& penalties,
                     std::vector<short>& sums, Mat& disparity)
{
    CV_DbgAssert(std::max(penalties.small, penalties.large) <= VolumePenalties::largest);
    const Size size = volume.size;
    disparity.create(size, CV_16U);

    VolumeProblem problem = {
        volume, weights.ptr(), (short)penalties.small, {}, grown(sums, volume.total()), disparity.ptr<ushort>()
    };
    const EdgeSimilarity similarity(penalties.gamma);
    for (int w = 0; w < 256; ++w)
        problem.large[w] = (short)std::max(penalties.small, cvRound(penalties.large * similarity.table[w]));

    runBlocks(problem, size.height, 1, blockRows,
              [&](const Range& rows, short* lines) { dispatched::aggregateRows(problem, rows, lines); });
    runBlocks(problem, size.width, columnGroup, blockColumns(size.width),
              [&](const Range& columns, short* lines) { dispatched::aggregateColumns(problem, columns, lines); });
}

}}} // namespace cv::stereo::hdp
