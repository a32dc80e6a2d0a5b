// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "frame_warp.hpp"
#include "frame_warp.simd.hpp"
#include "video/frame_warp.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxSteps, 4, "steps", "of the search for a block: more cost time, fewer do not come to rest");
HDP_TUNABLE(int, maxLastStep, 2, "pixels",
            "both coordinates of the last step of a block that was found: more has not come to rest, less loses many");

HDP_DISPATCH(stepBack)
HDP_DISPATCH(changeBlocks)

} // namespace

void findWarp(const BackwardMotion& motion, const Mat& disparity, FrameWarp& warp)
{
    typedef FrameWarp T;
    const Size size = disparity.size();
    const int count = (size.width + T::block - 1) / T::block;
    warp.size = size;
    warp.shifts.create((size.height + T::block - 1) / T::block, count, CV_16SC2);
    parallel_for_(Range(0, warp.shifts.rows), [&](const Range& rows) {
        std::vector<float> now(count);
        std::vector<ushort> before(count);
        std::vector<int> atX(count), atY(count), lastStep(count), state(count);
        for (int i = rows.start; i < rows.end; ++i)
        {
            const int y = std::min(i * T::block + T::block / 2, size.height - 1);
            const BlockRow row = { y,          size.width, count,           now.data(),
                                   atX.data(), atY.data(), lastStep.data(), state.data() };
            for (int j = 0; j < count; ++j)
            {
                atX[j] = row.centre(j);
                atY[j] = y;
                now[j] = disparity.ptr<ushort>(y)[atX[j]] / (float)subpixelScale;
                state[j] = BlockRow::MOVING;
            }
            for (int step = 0; step < maxSteps && !dispatched::stepBack(motion, size, step == 0, row); ++step)
            {
                for (int j = 0; j < count; ++j)
                    before[j] = disparity.ptr<ushort>(atY[j])[atX[j]];
                dispatched::changeBlocks(motion.change(), before.data(), row);
            }
            Vec2s* const shifts = warp.shifts.ptr<Vec2s>(i);
            for (int j = 0; j < count; ++j)
            {
                const bool isFound = state[j] != BlockRow::OUTSIDE && lastStep[j] <= maxLastStep;
                shifts[j] =
                    isFound ? Vec2s((short)(atX[j] - row.centre(j)), (short)(atY[j] - y)) : Vec2s((short)T::unknown, 0);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
