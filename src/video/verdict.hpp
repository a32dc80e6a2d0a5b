// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VERDICT_HPP
#define OPENCV_HDPSTEREO_VERDICT_HPP

namespace cv { namespace stereo { namespace hdp {

//! What a frame has to do with the one before
enum Verdict
{
    FIRST,       //!< nothing: there is none, or it shows another scene
    CONTINUED,   //!< it shows the same scene
    CONTRADICTED //!< it seemed to, but its disparities are others
};

//! What the matching of a frame depends on
struct VideoFindings
{
    Verdict verdict;
    bool isStill;       // the camera has not moved since the frame before
    bool isEstablished; // that frame has agreed with the one before it
};

}}} // namespace cv::stereo::hdp

#endif
