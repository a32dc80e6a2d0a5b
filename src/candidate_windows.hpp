// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CANDIDATE_WINDOWS_HPP
#define OPENCV_HDPSTEREO_CANDIDATE_WINDOWS_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {
namespace hdp {

/** The candidates of the pixels below a pixel of the upper layer: two runs of successive disparities. Where the
disparities around the pixel agree, one run follows the other. At a discontinuity the first one is around the pixel's own
disparity and the other around that of the surface beyond. */
struct CandidateWindow
{
    enum
    {
        runs = 2,
        runLength = 8,
        candidates = runs * runLength
    };
    short first[runs];      // the first disparity of each run
    ushort predicted[runs]; // what the run is there for, in 1 / subpixelScale pixel of the layer

    bool isContiguous() const { return first[1] == first[0] + runLength; }
};

/** Predicts the candidates of a layer.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param numDisparities Of the layer. Candidates from there on mean nothing; there are some only if it is less than
CandidateWindow::candidates.
@param smallest Memory to work in.
@param largest Memory to work in.
@param windows Receives a CandidateWindow per pixel of upper, CV_16UC4. */
CV_EXPORTS void predictWindows(const Mat& upper, int numDisparities, Mat& smallest, Mat& largest, Mat& windows);

//! Disparities of a layer as the layer above would have them: half the mean of the middle two of 2 x 2 pixels. For a
//! second pass over a layer, around the disparities of the first. disparity and upper: CV_16UC1, disparity maps.
CV_EXPORTS void halveDisparity(const Mat& disparity, Mat& upper);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
