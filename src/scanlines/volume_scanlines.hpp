// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_VOLUME_SCANLINES_HPP
#define OPENCV_HDPSTEREO_VOLUME_SCANLINES_HPP

#include "../forest/cost_volume.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Penalties in units of the volume, at most largest
struct VolumePenalties
{
    int small, large; // for a step of one disparity and for a larger one between neighbours of one colour
    double gamma;     // of an edge's similarity exp(-w / gamma), which the large penalty is multiplied by
    static const int largest = 100 * CostVolume::scale;
};

//! What is aggregated, see aggregateVolume(), and where to
struct VolumeProblem
{
    const CostVolume& volume;
    const uchar* weights;
    short small, large[256]; // penalties; large: by the edge's weight
    short* sums;             // of the directions, in the order of the costs
    ushort* disparity;

    static const int maxScanlines = 64; // that are followed side by side
    // before and behind the candidates of a pixel, for the first and the last one to have neighbours
    static const int margin = CostVolume::chunk;
    //! Memory for a pixel, by disparity
    int lineLength() const { return margin + volume.stride() + margin; }
    //! Memory for scanlines that are followed side by side: two pixels of each, the sums of one, and a
    //! line for the padding
    int lineMemory(int scanlines) const { return (2 * scanlines + 2) * lineLength(); }
};

/** Semi-global matching over the candidates of a volume, from the left, from the right, from above and from below.
With L(p, d) of a direction and q the pixel before p,
L(p, d) = C(p, d) + min(L(q, d), L(q, d - 1) + small, L(q, d + 1) + small, m + large(p, q)) - m, m = min_k L(q, k),
large(p, q) = max(small, round(large * exp(-w(p, q) / gamma))),
where disparities that are no candidates are left out. L = C where there is no q.
The winner has the lowest sum of the directions, the lowest disparity if there are several; its sum and those of both
candidates beside it give the sub-pixel part, see winnerFraction(), whose limits are costs of 8 and 14 in each
direction. Of the first candidate and of the last one, the fraction may lie towards the others: the sum beyond it is
that of the slope between those next to it, or that which leaves the fraction at 0. First and last are those of
volume.intervals, if it has some and the winner lies in that of its pixel.
@param volume The costs C.
@param weights w, CV_8UC2, see weighEdges().
@param sums Memory to work in: those of the directions so far, in the order of the volume; it only ever grows.
@param disparity Receives CV_16UC1, a disparity map. */
CV_EXPORTS void aggregateVolume(const CostVolume& volume, const Mat& weights, const VolumePenalties& penalties,
                                std::vector<short>& sums, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
