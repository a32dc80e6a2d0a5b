// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VOLUME_SCANLINES_HPP
#define OPENCV_HDPSTEREO_VOLUME_SCANLINES_HPP

#include "cost_volume.hpp"
#include "disparity_units.hpp"

namespace cv {
namespace stereo {
namespace hdp {

//! Penalties in units of the volume, at most largest
struct VolumePenalties
{
    int small, large; // for a step of one disparity and for a larger one between neighbours of one colour
    double gamma;     // of an edge's similarity exp(-w / gamma), which the large penalty is multiplied by
    enum
    {
        largest = 100 * CostVolume::scale
    };
};

struct VolumeScanlineBuffers
{
    Mat sums;  // CV_16SC1, those of the directions so far, in the order of the volume
    Mat lines; // L of the pixels before, a row per block of scanlines
};

//! What is aggregated, see aggregateVolume(), and where to
struct VolumeProblem
{
    const uchar* costs; // candidate d of pixel p = y * width + x at [p * pitch + d]
    const uchar* weights;
    Size size;
    int numDisparities, pitch;
    short small, large[256]; // penalties; large: by the edge's weight
    short* sums;             // of the directions, in the order of the costs
    ushort* disparity;

    enum
    {
        maxScanlines = 16,               // that are followed side by side
        margin = CostVolume::pitchFactor // before and behind the candidates of a pixel, for the first and the last one
                                         // to have neighbours
    };
    //! Memory for scanlines that are followed side by side: two pixels of each, and the sums of one
    int lineMemory(int scanlines) const { return 2 * scanlines * (pitch + 2 * margin) + pitch; }
};

/** Semi-global matching over all candidates, from the left, from the right, from above and from below. With L(p, d) of
a direction and q the pixel before p,
L(p, d) = C(p, d) + min(L(q, d), L(q, d - 1) + small, L(q, d + 1) + small, m + large(p, q)) - m, m = min_k L(q, k),
large(p, q) = max(small, round(large * exp(-w(p, q) / gamma))).
The winner has the lowest sum of the directions, the lowest disparity if there are several; the tip of the V through its
sum and those of both candidates beside it gives the sub-pixel part.
@param volume The costs C.
@param weights w, CV_8UC2, see weighEdges().
@param penalties The penalties.
@param buffers Memory to work in.
@param disparity Receives CV_16UC1, a disparity map. */
CV_EXPORTS void aggregateVolume(const CostVolume& volume, const Mat& weights, const VolumePenalties& penalties,
                                VolumeScanlineBuffers& buffers, Mat& disparity);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
