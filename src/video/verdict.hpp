// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VERDICT_HPP
#define OPENCV_HDPSTEREO_VERDICT_HPP

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
    bool hasPrior; // the last frame predicts disparities, see hasPrior()
};

}}} // namespace cv::stereo::hdp

#endif
