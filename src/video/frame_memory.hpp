// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FRAME_MEMORY_HPP
#define OPENCV_HDPSTEREO_FRAME_MEMORY_HPP

#include "../pair/image_levels.hpp"
#include "camera_motion.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What a frame is to the one before
enum Verdict
{
    FIRST,       // a video begins: no last frame is known, or it shows another scene
    CONTINUED,   // it shows the scene of the last frame
    CONTRADICTED // its disparities contradict those of the last frame: one of the two pairs was a wrong one
};

//! What of a video the matching of a frame depends on
struct VideoFindings
{
    Verdict verdict;
    bool predictsDisparities; // see the function of this name
};

//! What the disparities of a map stand for; only maps of the same key are compared.
struct FrameKey
{
    Size size;           // of the image
    int scale;           // pixels of the image in a side of a pixel
    double minDisparity; // that the map counts from, in pixels of its layer
    int maxDisparity;    // that the map may have, in its units

    bool operator==(const FrameKey& other) const
    {
        return size == other.size && scale == other.scale && minDisparity == other.minDisparity &&
               maxDisparity == other.maxDisparity;
    }
};

//! What a frame leaves to the next one
struct FrameMemory
{
    int frames = 0; // from the one that the video began with up to this one; 0: there is none
    FrameKey key = FrameKey();
    LevelScale levels;     // of grey
    CameraMotion motion;   // to this frame, in pixels of the layer
    Mat disparity;         // CV_16UC1, a disparity map
    Mat detail;            // CV_8UC1: four more bits of each disparity, GUESS, and the number of frames it stands for
    std::vector<Mat> grey; // CV_8UC1: the pyramid of the left image, from cells on

    bool isEmpty() const { return frames == 0; }
    void clear() { frames = 0; } // keeps the memory

    static const int cell = 2; // side of the pixels of grey's finest level, in pixels of the layer
    static const int detailBits = 4;
    static const int countMask = 7; // and the largest number of frames: more flickers less, but follows changes later
    static const int GUESS = 8;     // in detail: of a pixel whose match no right image has shown
    static const int scale = subpixelScale << detailBits; // of disparities with all their bits, for means over frames

    //! detail of a disparity in 1 / scale pixel, rounded for the map by adding half a unit of that
    static CV_ALWAYS_INLINE int detailOf(int rounded, int count)
    {
        return (rounded & ((1 << detailBits) - 1)) << detailBits | count;
    }
    //! Whether the right image does not show the match of column x
    static CV_ALWAYS_INLINE int isUnseen(int disparity, int x) { return wholeDisparity(disparity) > x; }
    //! A disparity in 1 / scale pixel; joinRow() rounds it for the map, so it may be half a unit of that below it.
    static CV_ALWAYS_INLINE int finer(int disparity, int detail)
    {
        return (disparity << detailBits) + (detail >> detailBits) - (1 << (detailBits - 1));
    }
};

//! Memory to work in, kept from frame to frame
struct VideoScratch
{
    std::vector<TrackedPoint> points;
    Mat halved;               // of predictFrame(): the left image
    std::vector<Mat> exposed; // the same: its pyramid, by the last frame's exposure
    // Of findSources(), per cell, and over windows around it
    Mat warped, change, unmovedChange, contrast, difference;
    Mat changes, unmovedChanges, contrasts, differences;
    Mat sources, shares, evidence, evidenceSums, choices; // of joinLastFrame(), per cell
};

}}} // namespace cv::stereo::hdp

#endif
