// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_SOURCES_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_SOURCES_HPP

#include "frame_memory.hpp"
#include "frame_warp.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of findSources()
struct TemporalSources
{
    enum
    {
        stillness = 5,      // halves of a grey level by which the mean of a cell that stands still changes at most
        minNoise = 3,       // grey levels by which what is the same changes at most if the images have no noise
        noiseFactor = 4,    // how much more that is with noise, in medians of the changes of all cells
        contrastShare = 70, // percent of the contrast around by which what is the same changes at most if that is more
        maxDistance = 3 // from the disparity of one source to that of the other, in pixels of the image: beyond, one of
                        // them must be wrong
    };
};

//! What a cell may take from the last frame
enum TemporalSource
{
    SAME_PLACE = 1, // the image stands still
    MOVED_PLACE = 2 // where the camera's motion leads, the last frame looks the same
};

/** Finds what each cell may take from the last frame: what looks different where the motion leads, by more than noise
and by about the contrast, is something else. Changes and contrasts are means over the squares around a cell.
@param before FrameMemory::grey[0] of the last frame.
@param now That of this frame.
@param warp Where its pixels were; none if the camera stands still: what looks the same is at the same place then.
@param scratch Memory to work in.
@param sources CV_8UC1, receives TemporalSource of each cell. */
CV_EXPORTS void findSources(const Mat& before, const Mat& now, const FrameWarp* warp, VideoScratch& scratch,
                            Mat& sources);

}}} // namespace cv::stereo::hdp

#endif
