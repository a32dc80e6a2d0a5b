// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CANDIDATE_WINDOWS_HPP
#define OPENCV_HDPSTEREO_CANDIDATE_WINDOWS_HPP

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Pixels of the layer between disparities of different surfaces: what is nearer is in one window of candidates
const int otherSurfaceDistance = 5;

//! A row of disparities of the layer above, and the minimum and maximum around each
struct DisparityRow
{
    const ushort *own, *min, *max;
};

/** Finds the surface that a pixel of the layer above may belong to beside its own, at least otherSurfaceDistance away
from it: the first one there is of
- the pixel's own disparity before the median,
- the farthest one of the disparities in 7 x 7 pixels,
- the farthest one of those before the median.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param unfiltered The same before the median, which removes thin structures.
@param others Receives CV_16UC1 of the size of the layer above, in 1 / subpixelScale pixel of the layer: the other
surface, or the pixel's own disparity if there is none. */
CV_EXPORTS void findOtherSurfaces(const Mat& upper, const Mat& unfiltered, Mat& others);

/** The candidates of the pixels below a pixel of the upper layer: two runs of successive disparities. The first one is
around the pixel's own disparity. The other one is around that of another surface the pixel may belong to, or follows
the first one if there is none. */
struct CandidateWindow
{
    static const int runs = 2;
    static const int runLength = 8; // candidates; half a vector of bytes
    static const int candidates = runs * runLength;
    // Candidates beyond each end of the range, as neighbours of the last one for its fraction
    static const int beyondRange = 1;

    short first[runs];      // the first disparity of each run
    ushort predicted[runs]; // what the run is there for, in 1 / subpixelScale pixel of the layer
};

//! The first of a number of candidates around a disparity, or around the middle between two
CV_ALWAYS_INLINE int firstCandidate(int disparity, int candidates, int numDisparities)
{
    const int outside = CandidateWindow::beyondRange;
    return std::max(std::min(disparity - (candidates / 2 - 1), numDisparities + outside - candidates), -outside);
}

/** Predicts the candidates of a layer.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param others From findOtherSurfaces().
@param numDisparities Of the layer. Candidates are in -beyondRange .. numDisparities - 1 + beyondRange; others mean
nothing, and there are some only if this range has less than CandidateWindow::candidates.
@param windows Receives a CandidateWindow per pixel of upper, CV_16UC4. */
CV_EXPORTS void predictWindows(const Mat& upper, const Mat& others, int numDisparities, Mat& windows);

/** Drops a run from a window if none of its candidates is in the pixel's interval; the other run's surface gets all
candidates then. If neither run has one, the window moves into the interval.
@param intervals A DisparityInterval per window, the hull of those of its pixels.
@param windows From predictWindows(), changed. */
CV_EXPORTS void restrictWindows(const Mat& intervals, int numDisparities, Mat& windows);

//! Disparities of a layer as the layer above would have them: half the mean of the middle two of 2 x 2 pixels, or half
//! the smaller one if they are otherSurfaceDistance apart: no surface is between them. For a second pass over a layer,
//! around the disparities of the first. disparity and upper: CV_16UC1, disparity maps.
CV_EXPORTS void halveDisparity(const Mat& disparity, Mat& upper);

}}} // namespace cv::stereo::hdp

#endif
