// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_OTHER_SURFACES_HPP
#define OPENCV_HDPSTEREO_OTHER_SURFACES_HPP

#include "../cost/census_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is known of a layer before it is matched
struct WindowPrediction
{
    const Mat& upper;      // the disparities of the layer above, CV_16UC1, a disparity map
    const Mat& unfiltered; // the same before the median, which removes thin structures
    const Mat& matches;    // of the layer itself, see findSparseMatches()
};

//! Of findOtherSurfaces()
struct OtherSurface
{
    enum
    {
        distance = 5, // pixels between disparities of different surfaces: what is nearer is in one window of candidates
        block = 4,    // pixels of the layer above, side of the blocks whose surfaces are listed
        listed = 8,   // surfaces at most around a block
        window = 4    // pixels of the layer, side of the window that costs are summed over
    };
};

//! Memory of findOtherSurfaces()
struct SurfaceBuffers
{
    Mat min[2], max[2]; // disparities around each pixel, filtered or not
    Mat blocks;         // CV_16UC4: minimum and maximum disparity of each block, then those before the median
};

//! A row of disparities of the layer above, and the minimum and maximum around each
struct DisparityRow
{
    const ushort *own, *min, *max;
};

/** Finds the surface that a pixel of the layer above may belong to beside its own, of those at least
OtherSurface::distance away from it. The usual one is the first one there is of
- the pixel's own disparity before the median,
- the match in its square,
- the farthest one of the disparities in 7 x 7 pixels,
- the farthest one of those before the median.

If there is one, others are the surfaces listed around the pixel's block of 4 x 4 pixels: of this block, then of its
neighbours in the order of an image, the minimum and maximum disparity, then those before the median, as far as each is
a surface apart from those before in the list, up to OtherSurface::listed of them.

Another one takes the place of the usual one if it is apart from this, too, and if the layer's census is clearly for it:
if its cost is less by more than a bit per pixel. The usual one costs what the first listed surface does that it is not
apart from, if there is one. The cost of a surface is the lowest one of the eight candidates around it, summed over the
4 x 4 pixels of the layer that the pixel's group of 2 x 2 stands for, or the nearest ones in the image, at most 255. The
first one of the lowest cost wins. Without a cost, and on layers smaller than the window, all are the usual ones.
@param prediction What to find them in.
@param cost The layer's census cost, or none.
@param numDisparities Of the layer.
@param buffers Memory to work in.
@param others Receives CV_16UC1 of the size of the layer above, in 1 / subpixelScale pixel of the layer: the other
surface, or the pixel's own disparity if there is none. */
CV_EXPORTS void findOtherSurfaces(const WindowPrediction& prediction, const CensusCost* cost, int numDisparities,
                                  SurfaceBuffers& buffers, Mat& others);

}}} // namespace cv::stereo::hdp

#endif
