// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_SOURCES_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_SOURCES_HPP

#include "temporal_prediction.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of findSources()
struct TemporalSources
{
    enum
    {
        stillness = 5,      // halves of a grey level by which a cell that stands still changes at most
        leastNoise = 3,     // grey levels, and
        noiseFactor = 4,    // times the median of all changes: what is the same, and no more than moved as the camera
        contrastShare = 70, // does, changes by no more, or by less than this percentage of the contrast around
        farthest =
            3 // pixels of the image from one source's disparity to the other's: beyond, one of them must be wrong
    };
};

//! What a cell may take from the last frame
enum TemporalSource
{
    SAME_PLACE = 1, // the image stands still
    MOVED_PLACE = 2 // where the camera's motion leads, the last frame looks the same
};

/** Finds what each cell may take from the last frame: what looks different where the motion leads, by more than noise
and by about the contrast, is something else.
@param state What followVideo() found of a frame that is not the first; receives TemporalState::sources, of
TemporalSource. */
CV_EXPORTS void findSources(TemporalState& state);

}}} // namespace cv::stereo::hdp

#endif
