// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#include "frame_warp.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A step of findWarp(): from the disparities of a row of blocks to where they were.
@param motion The motion.
@param size That of the layer.
@param isFirst Whether there was no step before.
@param row The blocks.
@return Whether none is moving any more: each has arrived or left the image. */
bool stepBack(const BackwardMotion& motion, const Size& size, bool isFirst, const BlockRow& row);

/** What the disparities at these places are now.
@param change The camera's motion.
@param before Those of the last frame, as in a map.
@param row The blocks, whose disparities change. */
void changeBlocks(const DisparityChange& change, const ushort* before, const BlockRow& row);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

bool stepBack(const BackwardMotion& motion, const Size& size, bool isFirst, const BlockRow& row)
{
    const BackwardMotion m = motion;
    const float endX = (float)size.width, endY = (float)size.height;
    const BlockRow r = row; // as stores may alias it
    const float* disparity = r.disparity;
    int *atX = r.atX, *atY = r.atY, *lastStep = r.lastStep, *state = r.state;
    const int mayArrive = !isFirst; // that step took what the last frame has at a block's own place
    int moving = 0;
    HDP_VECTORIZED for (int j = 0; j < r.count; ++j)
    {
        const Point2f place = m.place(r.centre(j), r.y, disparity[j]);
        // Beyond the image there is nothing to convert.
        const float x = std::min(std::max(place.x, -1.f), endX), y = std::min(std::max(place.y, -1.f), endY);
        const int isMoving = state[j] == BlockRow::MOVING;
        const int isInside = (x >= 0) & (y >= 0) & (x <= endX - 1) & (y <= endY - 1);
        const int nextX = (int)(x + 0.5f), nextY = (int)(y + 0.5f);
        const int step = std::abs(nextX - atX[j]) + std::abs(nextY - atY[j]);
        const int takes = isMoving & isInside;
        atX[j] = choose(takes, nextX, atX[j]);
        atY[j] = choose(takes, nextY, atY[j]);
        lastStep[j] = choose(takes, step, lastStep[j]);
        const int leaves = isMoving & (isInside ^ 1), arrives = takes & (step == 0) & mayArrive;
        state[j] += leaves * (BlockRow::OUTSIDE - BlockRow::MOVING) + arrives * (BlockRow::ARRIVED - BlockRow::MOVING);
        moving += state[j] == BlockRow::MOVING;
    }
    return moving == 0;
}

void changeBlocks(const DisparityChange& change, const ushort* before, const BlockRow& row)
{
    const DisparityChange c = change;
    const float unit = 1.f / subpixelScale, ofRow = c.ofRow(row.y);
    float* const disparity = row.disparity;
    HDP_VECTORIZED for (int j = 0; j < row.count; ++j) disparity[j] =
        c.now(before[j] * unit, c.ofX * row.centre(j) + ofRow);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
