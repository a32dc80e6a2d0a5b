// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_RANGE_SCANLINES_HPP
#define OPENCV_HDPSTEREO_RANGE_SCANLINES_HPP

#include "../base/parallel_for.hpp"
#include "../base/units.hpp"
#include "../cost/census_cost.hpp"
#include "scanline_stripes.hpp"

namespace cv { namespace stereo { namespace hdp {

//! In halves of a bit of the census
struct RangePenalties
{
    static const int largest = 190; // penalty: all costs of a direction are bytes
    static const int mostPrior = 15;

    int small, large;  // for a step of one candidate and for a larger one between neighbours of one colour
    int leastLarge;    // for a larger one at any edge
    double gamma;      // of an edge's similarity exp(-w / gamma), which the large penalty is multiplied by
    int priorDistance; // candidates from what is predicted, for each of which a cost rises by one
    int maxPrior;      // the most that it rises by
};

//! What is aggregated, see aggregateRange()
struct RangeProblem
{
    const CensusCost& below;
    Size size;      // of the layer
    int candidates; // their number
    const Mat &upper, &weights, &intervals;
    uchar small, large[256];    // penalties; large: by the edge's weight
    std::vector<uchar> priors;  // by the distance from the predicted candidate, from -candidates on
    std::vector<uchar> outside; // 255, 0 and 255 again, pixelBytes() each

    static const int longestVector = 32; // bytes
    static const int mostCandidates = 1024;
    //! Fills penalties, priors and outside.
    CV_EXPORTS void prepare(const RangePenalties& penalties);
    int pixelBytes() const { return (int)alignSize(candidates, longestVector); } // of the candidates, at most

    // A byte per candidate: 255 for those before this one, or for it and those behind it, and 0 for the others.
    const uchar* excludedBefore(int candidate) const { return outside.data() + pixelBytes() - candidate; }
    const uchar* excludedFrom(int candidate) const { return outside.data() + 2 * pixelBytes() - candidate; }
};

//! Memory of a thread for its stripe
struct RangeScratch
{
    static const int block = 2; // rows that are followed side by side

    //! Provides the memory for stripes of so many rows.
    CV_EXPORTS void prepare(const RangeProblem& problem, int rows);

    // Bytes of the candidates of pixels, pixel by pixel. One more may be read before and behind those of each.
    //! C of row r of a block
    uchar* costs(int r) { return at((size_t)r * width); }
    //! E from the left or from the right, of a pixel of row r of a block
    uchar* beside(int r) { return at((size_t)block * width + 2 * r); }
    //! The sums of a pixel of row r of a block
    uchar* sums(int r) { return at((size_t)block * (width + 2) + 2 * r); }
    //! E from above, of a row
    uchar* vertical() { return at((size_t)block * (width + 4)); }
    //! E from below, of a row of the stripe
    uchar* below(int row) { return at((size_t)block * (width + 4) + (size_t)width * (1 + row)); }

    std::vector<ushort> whole;      // winners of the rows of a block
    std::vector<short> rise, slope; // what winnerFraction() is given

private:
    uchar* at(size_t pixel) { return alignPtr(bytes.data(), alignment) + alignment + pixel * pixelBytes; }

    static const int alignment = 64;
    int width, pixelBytes;
    std::vector<uchar> bytes;
};

typedef ScratchPool<RangeScratch> RangeBuffers;

/** Semi-global matching over all candidates of a layer, those of the layer below, twice as large: from the left, from
the right, from above and from below. Costs are computed where they are needed, so there is no volume of them. They
compare one plane of the census of three pixels below: the noise of these differs, so they tell as much as all planes of
two. With b_i the number of bits that differ in plane i, modulo the number of planes, candidate h of pixel (x, y), a
disparity of h / 2 pixels, costs

C(p, h) = 2 (b_0((2 x, 2 y), h) + b_1((2 x + 1, 2 y + 1), h) + b_2((2 x + 1, 2 y), h))
          + min(floor(|h - predicted| / priorDistance), maxPrior),

predicted being the candidate next to what the layer above has found; 255 if h is not in the pixel's interval. Pixels
below without data limit the bits, see CostLimits: of the left image each its own, of the right one their sum. If none
of the left image's three has data, nothing is predicted. With E(p, h) of a direction and q the pixel before p,

L(p, h) = C(p, h) + min(E(q, h), E(q, h - 1) + small, E(q, h + 1) + small, large(p, q)),
E(p, h) = L(p, h) - min_k L(p, k),
large(p, q) = max(leastLarge, round(large * exp(-w(p, q) / gamma))),

all sums at most 255; L = C where there is no q. The winner has the lowest sum of E over the directions, at most 255,
the first of them if there are several; its sum and those of both candidates beside it give the sub-pixel part, as of
aggregateVolume().

The image is cut into stripes that do not depend on the number of threads; the directions from above and from below
start anew some rows before each of them. A tile has those of the image that it lies in.
@param frame Where the layer lies in a larger image, if it is that of a tile.
@param candidates Their number, at most RangeProblem::mostCandidates.
@param upper The disparities of the layer above, CV_16UC1, a disparity map.
@param weights w, CV_8UC2, of the layer, see weighEdges().
@param intervals The candidates of the layer's pixels, DisparityInterval, or an empty Mat: all of them.
@param disparity Receives CV_16UC1 of the size of weights, a disparity map. */
CV_EXPORTS void aggregateRange(const CensusCost& below, const ImageFrame& frame, int candidates, const Mat& upper,
                               const Mat& weights, const Mat& intervals, const RangePenalties& penalties,
                               RangeBuffers& buffers, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
