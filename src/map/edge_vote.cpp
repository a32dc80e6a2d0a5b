// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "edge_vote.simd.hpp"
#include "map/edge_vote.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, likeness, 36, "grey levels",
            "from which on votes count nothing: less is noise, more is another surface");
HDP_TUNABLE(int, minStep, 2, "pixels", "of disparities at the border of two surfaces: less is the slope of one");

// Rows whose colours are split at once
const int voteBlock = 64;

HDP_DISPATCH(voteRow)

} // namespace

void voteAtEdges(const Mat& image, const Mat& disparity, Mat& voted)
{
    const int width = disparity.cols, lastRow = disparity.rows - 1;
    if (width < VoteRows::columns)
        return disparity.copyTo(voted);
    voted.create(disparity.size(), CV_16U);
    const int count = (disparity.rows + voteBlock - 1) / voteBlock, border = VoteRows::rowStep * (VoteRows::rows / 2);
    parallel_for_(Range(0, count), [&](const Range& range) {
        std::vector<ushort> near(width + 2), far(width + 2);
        std::vector<Mat> channels;
        VoteRows rows;
        rows.width = width;
        rows.channels = image.channels();
        rows.likeness = (ushort)likeness;
        rows.minStep = (ushort)(minStep * subpixelScale);
        rows.reach = (ushort)subpixelScale;
        for (int y = range.start * voteBlock; y < std::min(range.end * voteBlock, disparity.rows); ++y)
        {
            const int first = std::max(y / voteBlock * voteBlock - border, 0);
            if (y % voteBlock == 0)
                split(image.rowRange(first, std::min(y + voteBlock + border, disparity.rows)), channels);
            for (int r = 0; r < VoteRows::rows; ++r)
            {
                const int row = clamped(y + VoteRows::rowStep * r - border, 0, lastRow);
                for (int c = 0; c < rows.channels; ++c)
                    rows.colour[c][r] = channels[c].ptr(row - first);
            }
            for (int dy = -VoteRows::barWidth; dy <= VoteRows::barWidth; ++dy)
                rows.disparities[VoteRows::barWidth + dy] = disparity.ptr<ushort>(clamped(y + dy, 0, lastRow));
            dispatched::voteRow(rows, near.data(), far.data(), voted.ptr<ushort>(y));
        }
    });
}

}}} // namespace cv::stereo::hdp
