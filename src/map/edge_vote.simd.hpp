// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "edge_vote_rows.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of voteAtEdges().
@param rows What is around it.
@param rule How the pixels vote.
@param near Memory of width + 2 elements.
@param far The same.
@param voted Receives the row. */
void voteRow(const VoteRows& rows, const VoteRule& rule, ushort* near, ushort* far, ushort* voted);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The disparities of two surfaces: (middle, nearest] and [farthest, middle]
struct TwoSurfaces
{
    ushort nearest, middle, farthest;
};

//! The vote of a pixel for one of the surfaces, added to its votes
CV_ALWAYS_INLINE void addVote(ushort change, ushort d, ushort likeness, ushort nearness, const TwoSurfaces& surfaces,
                              ushort& near, ushort& far)
{
    const ushort vote = (ushort)((ushort)(std::max(likeness, change) - change) * nearness);
    const ushort isNear = (ushort) - (ushort)((d > surfaces.middle) & (d <= surfaces.nearest));
    const ushort isFar = (ushort) - (ushort)((d >= surfaces.farthest) & (d <= surfaces.middle));
    near = (ushort)(near + (vote & isNear));
    far = (ushort)(far + (vote & isFar));
}

/** Whether a pixel of the nearer surface is in a bar: across it the farther surface begins within barWidth pixels both
ways, along it the nearer one goes on for as many at least one way. Beyond the image it goes on. */
inline bool isInBar(const VoteRows& rows, int x, ushort middle)
{
    const int reach = VoteRows::barWidth, own = VoteRows::rows / 2;
    bool left = true, right = true, up = rows.farAbove[x] > middle, down = rows.farBelow[x] > middle;
    for (int u = std::max(x - reach, 0); u < x; ++u)
        left &= rows.disparity[own][u] > middle;
    for (int u = x + 1; u <= std::min(x + reach, rows.width - 1); ++u)
        right &= rows.disparity[own][u] > middle;
    for (int r = 0; r < own; ++r)
    {
        up &= rows.disparity[r][x] > middle;
        down &= rows.disparity[own + 1 + r][x] > middle;
    }
    return (!left && !right && (up || down)) || (!up && !down && (left || right));
}

//! The largest absolute difference over the channels of pixels u and x, of row number r and the one in the middle
template <int channels> CV_ALWAYS_INLINE ushort differenceOf(const VoteRows& rows, int r, int u, const uchar* colour)
{
    uchar largest = difference(rows.colour[0][r][u], colour[0]);
    for (int c = 1; c < channels; ++c)
        largest = std::max(largest, difference(rows.colour[c][r][u], colour[c]));
    return largest;
}

//! The disparity of a pixel at a step from nearest to farthest
template <int channels>
inline ushort voteAt(const VoteRows& rows, const VoteRule& rule, int x, ushort nearest, ushort farthest)
{
    const int start = std::min(std::max(x - VoteRows::columnsBefore, 0), rows.width - VoteRows::columns);
    const ushort* const columnNearness = rule.columnNearness + start - x;
    const ushort own = rows.disparity[VoteRows::rows / 2][x];
    uchar colour[channels];
    for (int c = 0; c < channels; ++c)
        colour[c] = rows.colour[c][VoteRows::rows / 2][x];
    const TwoSurfaces surfaces = { (ushort)std::min(nearest + rule.reach, (int)USHRT_MAX),
                                   (ushort)((nearest + farthest) / 2), (ushort)std::max(farthest - rule.reach, 0) };
    const ushort likeness = rule.likeness;
    ushort near[VoteRows::columns], far[VoteRows::columns];
    HDP_VECTORIZED for (int k = 0; k < VoteRows::columns; ++k)
    {
        near[k] = far[k] = 0;
        HDP_UNROLLED for (int r = 0; r < VoteRows::rows; ++r)
            addVote(differenceOf<channels>(rows, r, start + k, colour), rows.disparity[r][start + k], likeness,
                    std::min(columnNearness[k], rule.rowNearness[r]), surfaces, near[k], far[k]);
    }
    int nearVotes = 0, farVotes = 0;
    for (int k = 0; k < VoteRows::columns; ++k)
    {
        nearVotes += near[k];
        farVotes += far[k];
    }
    if (own <= surfaces.middle)
        return nearVotes > farVotes ? nearest : own;
    return farVotes > nearVotes && !isInBar(rows, x, surfaces.middle) ? farthest : own;
}

CV_ALWAYS_INLINE ushort largestOfThree(const ushort* v) { return std::max(std::max(v[0], v[2]), v[1]); }
CV_ALWAYS_INLINE ushort smallestOfThree(const ushort* v) { return std::min(std::min(v[0], v[2]), v[1]); }

template <int channels>
void voteRow(const VoteRows& rows, const VoteRule& rule, ushort* near, ushort* far, ushort* voted)
{
    const int width = rows.width;
    const ushort *const above = rows.above, *const own = rows.disparity[VoteRows::rows / 2], *const below = rows.below;
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        near[x + 1] = std::max(std::max(above[x], below[x]), own[x]);
        far[x + 1] = std::min(std::min(above[x], below[x]), own[x]);
    }
    near[0] = near[1];
    far[0] = far[1];
    near[width + 1] = near[width];
    far[width + 1] = far[width];
    const ushort minStep = rule.minStep;
    for (int begin = 0; begin < width; begin += VoteRows::columns)
    {
        const int end = std::min(begin + VoteRows::columns, width);
        ushort hasStep = 0;
        HDP_VECTORIZED for (int x = begin; x < end; ++x)
        {
            const ushort nearest = largestOfThree(near + x);
            const ushort farthest = smallestOfThree(far + x);
            voted[x] = own[x];
            hasStep |= (ushort)((ushort)(nearest - farthest) > minStep);
        }
        for (int x = begin; x < end && hasStep; ++x)
        {
            const ushort nearest = largestOfThree(near + x);
            const ushort farthest = smallestOfThree(far + x);
            if (nearest - farthest > minStep)
                voted[x] = voteAt<channels>(rows, rule, x, nearest, farthest);
        }
    }
}

} // namespace

void voteRow(const VoteRows& rows, const VoteRule& rule, ushort* near, ushort* far, ushort* voted)
{
    if (rows.channels == 1)
        voteRow<1>(rows, rule, near, far, voted);
    else
        voteRow<3>(rows, rule, near, far, voted);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
