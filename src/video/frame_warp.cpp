// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "frame_warp.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxSteps, 4, "steps", "of the search for a block: more cost time, fewer do not come to rest");
HDP_TUNABLE(int, maxLastStep, 2, "pixels",
            "both coordinates of the last step of a block that was found: more has not come to rest, less loses many");

const int block = FrameWarp::block, outside = INT_MAX; // outside: the last step of a block that has left the image

//! A row of blocks that are followed to where they were
struct BlockRow
{
    BlockRow(int width, int count) : centres(count), atX(count), atY(count), lastStep(count), before(count)
    {
        for (int j = 0; j < count; ++j)
            centres[j] = std::min(j * block + block / 2, width - 1);
    }
    int y = 0; // of the blocks' centres
    std::vector<int> centres, atX, atY;
    std::vector<int> lastStep;  // the sum of both coordinates' changes
    std::vector<ushort> before; // what the last frame has at (atX, atY)
};

//! From what the last frame has at the places of blocks to their next places. isFirst: the places are those of now, and
//! so are the disparities. Returns whether a block is still moving.
bool stepBack(const BackwardMotion& motion, const Size& size, bool isFirst, BlockRow& row)
{
    const BackwardMotion m = motion; // as are all locals, as stores may alias what is referred to
    const DisparityChange change = motion.change;
    const float endX = (float)size.width, endY = (float)size.height, unit = 1.f / subpixelScale;
    const int count = (int)row.centres.size(), rowY = row.y, *const centres = row.centres.data();
    const ushort* const before = row.before.data();
    int *const atX = row.atX.data(), *const atY = row.atY.data(), *const lastStep = row.lastStep.data();
    int moving = 0;
    HDP_VECTORIZED for (int j = 0; j < count; ++j)
    {
        const float old = before[j] * unit, disparity = isFirst ? old : change.now(old, (float)centres[j], (float)rowY);
        const Point2f place = m.placeBefore(centres[j], rowY, disparity);
        // Beyond the image there is nothing to convert.
        const float x = std::min(std::max(place.x, -1.f), endX), y = std::min(std::max(place.y, -1.f), endY);
        const int isInside = (x >= 0) & (y >= 0) & (x <= endX - 1) & (y <= endY - 1);
        const int nextX = (int)(x + 0.5f), nextY = (int)(y + 0.5f);
        const int step = std::abs(nextX - atX[j]) + std::abs(nextY - atY[j]);
        const int takes = isInside & (lastStep[j] != outside);
        atX[j] = choose(takes, nextX, atX[j]);
        atY[j] = choose(takes, nextY, atY[j]);
        lastStep[j] = choose(takes, step, outside);
        moving += takes & ((step != 0) | isFirst);
    }
    return moving > 0;
}

} // namespace

void findWarp(const BackwardMotion& motion, const Mat& disparity, FrameWarp& warp)
{
    const Size size = disparity.size();
    const int count = (size.width + block - 1) / block;
    warp.size = size;
    warp.shifts.create((size.height + block - 1) / block, count, CV_16SC2);
    parallelFor(warp.shifts.rows, BlockRow(size.width, count), [&](int i, BlockRow& row) {
        row.y = std::min(i * block + block / 2, size.height - 1);
        row.atX = row.centres;
        row.atY.assign(count, row.y);
        row.lastStep.assign(count, 0);
        bool isMoving = true;
        for (int step = 0; step < maxSteps && isMoving; ++step)
        {
            for (int j = 0; j < count; ++j)
                row.before[j] = disparity.ptr<ushort>(row.atY[j])[row.atX[j]];
            isMoving = stepBack(motion, size, step == 0, row);
        }
        Vec2s* const shifts = warp.shifts.ptr<Vec2s>(i);
        for (int j = 0; j < count; ++j)
        {
            const Vec2s shift((short)(row.atX[j] - row.centres[j]), (short)(row.atY[j] - row.y));
            shifts[j] = row.lastStep[j] <= maxLastStep ? shift : Vec2s((short)FrameWarp::unknown, 0);
        }
    });
}

}}} // namespace cv::stereo::hdp
