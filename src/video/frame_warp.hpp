// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FRAME_WARP_HPP
#define OPENCV_HDPSTEREO_FRAME_WARP_HPP

#include "camera_motion.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Where the pixels of this frame were in the last one: square blocks of them moved together.
struct FrameWarp
{
    static const int block = 4; // pixels; side of a block: larger ones have two surfaces, smaller ones cost time
    static const int unknown = SHRT_MIN; // in place of the x of a shift: the block was not in the last frame
    Size size;                           // of both frames
    Mat shifts;                          // CV_16SC2, per block: from a pixel to where it was

    //! The shifts of the blocks that a row of pixels is in
    const Vec2s* ofRow(int y) const { return shifts.ptr<Vec2s>(y / block); }
    bool isKnown(int x, int y) const { return ofRow(y)[x / block][0] != unknown; }

    //! Where a pixel was, or the nearest pixel of the image
    Point operator()(int x, int y) const
    {
        const Vec2s& s = ofRow(y)[x / block];
        return Point(std::min(std::max(x + s[0], 0), size.width - 1), std::min(std::max(y + s[1], 0), size.height - 1));
    }

    //! Calls take(x, from, count) for all pixels of a row: count pixels from x on were side by side, the first of them
    //! at from. count is a constant: that of a block, or 1 where the block reaches beyond the image.
    template <typename Take> CV_ALWAYS_INLINE void forEachBlock(int y, const Take& take) const
    {
        const int width = size.width, lastY = size.height - 1;
        const Vec2s* const row = ofRow(y);
        for (int x = 0; x < width; x += block)
        {
            const Vec2s s = row[x / block];
            const int fromX = x + s[0], fromY = std::min(std::max(y + s[1], 0), lastY);
            if (fromX >= 0 && std::max(x, fromX) + block <= width)
                take(x, Point(fromX, fromY), +block);
            else
                for (int i = x; i < std::min(x + block, width); ++i)
                    take(i, (*this)(i, y), 1);
        }
    }
};

/** Follows blocks back. Where one was depends on its disparity, and that on where it was: from the disparity that the
last frame has at the same place, some steps lead to both. Known are those whose centre stays in the image and comes to
rest. disparity: the map of the last frame */
CV_EXPORTS void findWarp(const BackwardMotion& motion, const Mat& disparity, FrameWarp& warp);

}}} // namespace cv::stereo::hdp

#endif
