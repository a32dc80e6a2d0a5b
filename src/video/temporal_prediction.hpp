// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP

#include "temporal_sources.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of predictFrame()
struct VideoFollowing
{
    enum
    {
        cutShare = 60, // percent of its contrast by which a coarse image changes at a cut
        cutNoise = 4   // grey levels; a coarse image that changes by no more on average is no cut
    };
};

//! What the last frame tells of this one before it is matched
struct FramePrediction
{
    Verdict verdict = FIRST; // or CONTINUED
    FrameKey key;            // of this frame
    CameraMotion motion;     // from the last frame, in pixels of the layer; none for a first frame
    std::vector<Mat> grey;   // of this frame, see FrameMemory

    // Only if the frame continues
    BackwardMotion backward; // the same motion
    FrameWarp warp;          // the same for all pixels; unknown if the camera stands still
    Mat sources;             // CV_8UC1, of TemporalSource per cell, see findSources()

    //! Whether there is a last frame from another place
    bool isMoving() const { return verdict == CONTINUED && !motion.isStill; }
};

/** Finds how the camera moved since the last frame, where everything was then, and what may be taken from there. A frame
is the first one if nothing is remembered, at another size, with disparities of another key, and if it shows another
scene.
@param left The left image of the finest layer that is matched, see greyLevels().
@param key What this layer's disparities will stand for.
@param last What the last frame left.
@param scratch Memory to work in.
@param prediction Receives all that is known. */
CV_EXPORTS void predictFrame(const Mat& left, const FrameKey& key, const FrameMemory& last, VideoScratch& scratch,
                             FramePrediction& prediction);

}}} // namespace cv::stereo::hdp

#endif
