// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/vectorized.hpp"
#include "map_filters.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "../base/sixteen_words.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A row of voteAtEdges(). near, far: memory of width + 2 elements
void voteRow(const VoteRows& rows, ushort* near, ushort* far, ushort* voted);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** Whether a pixel of the nearer surface is in a bar: across it the farther surface begins within barWidth pixels both
ways, along it the nearer one goes on for as many at least one way. Beyond the image it goes on. */
inline bool isInBar(const VoteRows& rows, int x, ushort middle)
{
    const int reach = VoteRows::barWidth;
    const ushort* const own = rows.disparity(0);
    bool left = true, right = true, up = true, down = true;
    for (int u = std::max(x - reach, 0); u < x; ++u)
        left &= own[u] > middle;
    for (int u = x + 1; u <= std::min(x + reach, rows.width - 1); ++u)
        right &= own[u] > middle;
    for (int distance : { +VoteRows::rowStep, 2 * VoteRows::rowStep, reach })
    {
        up &= rows.disparity(-distance)[x] > middle;
        down &= rows.disparity(distance)[x] > middle;
    }
    return (!left && !right && (up || down)) || (!up && !down && (left || right));
}

//! How far 16 pixels of row r of the window, from column start on, are from a colour: the largest difference of any
//! channel
template <int channels>
CV_ALWAYS_INLINE SixteenWords differenceOf(const VoteRows& rows, int r, int start, const SixteenWords* colour)
{
    SixteenWords largest = SixteenWords::load(rows.colour[0][r] + start).difference(colour[0]);
    for (int c = 1; c < channels; ++c)
        largest = largest.max(SixteenWords::load(rows.colour[c][r] + start).difference(colour[c]));
    return largest;
}

//! The disparity of a pixel at a step from nearest to farthest
template <int channels> inline ushort voteAt(const VoteRows& rows, int x, ushort nearest, ushort farthest)
{
    const int start = std::min(std::max(x - VoteRows::columnsBefore, 0), rows.width - VoteRows::columns);
    const int middle = (nearest + farthest) / 2;
    const SixteenWords nearFirst = SixteenWords::repeat(middle + 1), farLast = SixteenWords::repeat(middle),
                       nearLast = SixteenWords::repeat(std::min(nearest + rows.reach, (int)USHRT_MAX)),
                       farFirst = SixteenWords::repeat(std::max(farthest - rows.reach, 0));
    const SixteenWords likeness = SixteenWords::repeat(rows.likeness);
    SixteenWords colour[channels], majority = SixteenWords::repeat(0);
    for (int c = 0; c < channels; ++c)
        colour[c] = SixteenWords::repeat(rows.colour[c][VoteRows::rows / 2][x]);
    HDP_UNROLLED for (int r = 0; r < VoteRows::rows; ++r)
    {
        const SixteenWords change = differenceOf<channels>(rows, r, start, colour).min(likeness);
        const SixteenWords votes = likeness - change;
        const SixteenWords disparity =
            SixteenWords::load(rows.disparity(VoteRows::rowStep * (r - VoteRows::rows / 2)) + start);
        majority = majority + votes.whereEqual(disparity, disparity.max(nearFirst).min(nearLast)) -
                   votes.whereEqual(disparity, disparity.max(farFirst).min(farLast));
    }
    const int nearVotes = majority.sum(); // less those for the other one
    const ushort own = rows.disparity(0)[x];
    if (own <= middle)
        return nearVotes > 0 ? nearest : own;
    return nearVotes < 0 && !isInBar(rows, x, (ushort)middle) ? farthest : own;
}

CV_ALWAYS_INLINE ushort largestOfThree(const ushort* v) { return std::max(std::max(v[0], v[2]), v[1]); }
CV_ALWAYS_INLINE ushort smallestOfThree(const ushort* v) { return std::min(std::min(v[0], v[2]), v[1]); }

template <int channels> void voteRow(const VoteRows& rows, ushort* near, ushort* far, ushort* voted)
{
    const int width = rows.width;
    const ushort *const above = rows.disparity(-1), *const own = rows.disparity(0), *const below = rows.disparity(1);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        near[x + 1] = std::max(std::max(above[x], below[x]), own[x]);
        far[x + 1] = std::min(std::min(above[x], below[x]), own[x]);
    }
    near[0] = near[1];
    far[0] = far[1];
    near[width + 1] = near[width];
    far[width + 1] = far[width];
    const ushort minStep = rows.minStep;
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
                voted[x] = voteAt<channels>(rows, x, nearest, farthest);
        }
    }
}

} // namespace

void voteRow(const VoteRows& rows, ushort* near, ushort* far, ushort* voted)
{
    if (rows.channels == 1)
        voteRow<1>(rows, near, far, voted);
    else
        voteRow<3>(rows, near, far, voted);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
