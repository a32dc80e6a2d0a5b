// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP

#include "camera_motion.hpp"
#include "../base/disparity_units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of followVideo()
struct VideoFollowing
{
    enum
    {
        cell = 2,      // side of the pixels of TemporalFrame::grey's finest level, in pixels of the layer
        block = 4,     // side of the squares that move together
        cutShare = 60, // percent of its contrast by which a coarse image changes at a cut
        cutNoise = 4   // grey levels; what changes less is no cut
    };
};

//! What a frame leaves to the next
struct TemporalFrame
{
    Mat disparity;         // CV_16UC1, a disparity map; empty: there is no such frame
    Mat detail;            // CV_8UC1: four more bits of each disparity, and the number of frames it stands for
    std::vector<Mat> grey; // CV_8UC1: the pyramid of the left image from cells on

    enum
    {
        detailBits = 4,
        countMask = (1 << detailBits) - 1,
        scale = subpixelScale << detailBits // of disparities with all their bits: means over frames need them
    };
    static CV_ALWAYS_INLINE int finer(int disparity, int detail)
    {
        return (disparity << detailBits) + (detail >> detailBits) - (1 << (detailBits - 1)); // they were rounded
    }
};

//! What the disparities of a map stand for
struct TemporalLayer
{
    int scale;           // pixels of the image in a side of a pixel
    double minDisparity; // that a map counts from, in pixels of the layer
    int largest;         // of a map, in its units
    int brightening;     // of the pair, see PairPyramids

    bool operator==(const TemporalLayer& other) const
    {
        return scale == other.scale && minDisparity == other.minDisparity && largest == other.largest &&
               brightening == other.brightening;
    }
};

//! What is known of a video, and memory that is kept from pair to pair
struct TemporalState
{
    TemporalFrame last, next;
    TemporalLayer layer = TemporalLayer(); // of the last frame
    int age = 0;                           // frames before the next one, since it began anew

    CameraMotion motion; // to the last frame that followVideo() saw, in pixels of the layer
    BackwardMotion backward;
    Mat shifts; // CV_16SC2, per block: from a pixel to where it was in the last frame; see noShift

    std::vector<TrackedPoint> points;
    Mat halved;
    Mat sources;                                     // CV_8UC1, see findSources()
    Mat warped, change, contrast, evidence, choices; // of findSources() and joinLastFrame(), per cell

    //! In place of the x of a shift: the block was not in the last frame.
    enum
    {
        noShift = SHRT_MIN
    };

    //! Forgets the last frame.
    void clear()
    {
        last.disparity.release();
        motion = CameraMotion();
        age = 0;
    }
};

//! The pixel that a shift leads to
inline Point shifted(int x, int y, const Vec2s& shift, Size size)
{
    return Point(std::min(std::max(x + shift[0], 0), size.width - 1),
                 std::min(std::max(y + shift[1], 0), size.height - 1));
}

//! A row of blocks that findShifts() follows to where they were
struct BlockRow
{
    enum State
    {
        MOVING,
        ARRIVED,
        OUTSIDE // of the last frame
    };
    int y, width, count;               // of the blocks' centres, of the layer, number of blocks
    float* disparity;                  // of the centres now, if they were at (atX, atY)
    int *atX, *atY, *lastStep, *state; // lastStep: sum of both coordinates' changes

    CV_ALWAYS_INLINE int centre(int j) const
    {
        return std::min(j * VideoFollowing::block + VideoFollowing::block / 2, width - 1);
    }
};

/** Finds how the cameras moved since the last frame, and where everything was then. The first frame, one of another
size or with other disparities, and one that shows another scene begin anew.
@param left The left image of the finest layer that is matched, see greyLevels().
@param layer What its disparities stand for.
@param state What is known of the video; TemporalState::age is 0 if it begins anew. */
CV_EXPORTS void followVideo(const Mat& left, const TemporalLayer& layer, TemporalState& state);

}}} // namespace cv::stereo::hdp

#endif
