// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP

#include "frame_memory.hpp"
#include "frame_warp.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Pixels of the image, from the disparity of one source to that of the other: beyond, one of them must be wrong
const int maxSourceDistance = 3;

//! What a cell may take from the last frame
enum TemporalSource
{
    SAME_PLACE = 1, // the image stands still
    MOVED_PLACE = 2 // where the camera's motion leads, the last frame looks the same
};

//! What the last frame tells of this one before it is matched
struct FramePrediction
{
    Verdict verdict = FIRST;   // or CONTINUED
    FrameKey key = FrameKey(); // of this frame
    LevelScale levels;         // the same
    CameraMotion motion;       // from the last frame, in pixels of the layer; none for a first frame
    std::vector<Mat> grey;     // of this frame, see FrameMemory

    // Only if the frame continues
    BackwardMotion backward; // the same motion
    FrameWarp warp;          // the same for all pixels; unknown if the camera stands still
    Mat sources;             // CV_8UC1, of TemporalSource per cell, see findSources()

    //! Whether there is a last frame from another place
    bool isMoving() const { return verdict == CONTINUED && !motion.isStill; }
};

/** Finds how the camera moved since the last frame, where everything was then, and what may be taken from there. A
frame is the first one if nothing is remembered, if its size or key is another one, or if it shows another scene.
@param left The left image of the finest layer that is matched, see greyLevels().
@param levels What its levels stand for.
@param key What this layer's disparities will stand for. */
CV_EXPORTS void predictFrame(const Mat& left, const LevelScale& levels, const FrameKey& key, const FrameMemory& last,
                             VideoScratch& scratch, FramePrediction& prediction);

/** Finds what each cell may take from the last frame, a TemporalSource (CV_8UC1). It may be taken from where the motion
leads unless the cell differs from that by more than noise and by more than a share of the contrast: differences are
means over 3 x 3 cells, contrasts over 5 x 5. The same place, if the camera moved, has to have about the same mean
level, and to differ no more than where the motion leads.
@param before,now FrameMemory::grey[0] of the last frame and of this one.
@param warp Where its pixels were; none if the camera stands still: what looks the same is at the same place then. */
CV_EXPORTS void findSources(const Mat& before, const Mat& now, const FrameWarp* warp, VideoScratch& scratch,
                            Mat& sources);

}}} // namespace cv::stereo::hdp

#endif
