// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SCANLINE_AGGREGATION_HPP
#define OPENCV_HDPSTEREO_SCANLINE_AGGREGATION_HPP

#include "candidate_windows.hpp"
#include "../base/parallel_for.hpp"
#include "../cost/census_cost.hpp"
#include "scanline_stripes.hpp"
#include "smoothness_weights.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Penalties in units of the census cost
struct ScanlinePenalties
{
    int small, large; // for a step of one disparity and for a larger one between neighbours of one colour, 0..max
    int edgeSlope;    // halves of a bit by which large falls per grey level of an edge's weight, 0..64
    int borderSlope;  // the same where a window has two runs: surfaces end there
    int prior;        // for 2 pixels between a candidate and what its run was predicted for, 1..4: costs have 8 bits
    int nearer;       // for candidates of another surface that is nearer, 0..4
    int edgeNoise;    // grey levels that an edge's weight may have by noise, 0..255
    static const int max = 100; // bits; costs with it have 8 bits
};

//! What is aggregated, see aggregateScanlines()
struct ScanlineProblem
{
    const CensusCost* cost;
    const Mat* weights; // of the edges
    Size size;
    int numDisparities;
    int maxDisparity; // of a map
    const Mat *windows, *smoothness;
    ScanlinePenalties penalties;
    float blunt, sharp; // of sums of the directions, see winnerFraction()

    //! Candidates of a window that are inside the range or beside its ends
    int validCandidates() const
    {
        return std::min(+CandidateWindow::candidates, numDisparities + 2 * CandidateWindow::beyondRange);
    }
};

/** Memory of a sweep over one stripe. A block is the rows that are in one vector, at most maxRows. */
struct ScanlineScratch
{
    static const int blocks = 2; // that are done side by side
    static const int maxRows = 2;
    static const int margin = 2 * maxRows; // of all that is stored by column, on both sides
    static const int alignment = 64;       // of directions: vectors that are in two lines of the cache take longer

    //! Of a row of windows
    struct Windows
    {
        // By column of the layer above: the first candidate of each run, and how far it is from what was predicted;
        // whether there is one run, and so there is for the other rows of the block in the same step; small penalties
        std::vector<short> first[CandidateWindow::runs], distance[CandidateWindow::runs];
        std::vector<uchar> isContiguous, small;
        std::vector<uchar> priors, intoSide, intoNext; // CandidateWindow::candidates per such column
        // By column of the layer: the first candidates, and what penalties of edges depend on
        std::vector<short> firstOfColumn[CandidateWindow::runs];
        std::vector<uchar> slopes, large, least;

        void prepare(size_t pairs);
    };

    //! Of a block
    struct Block
    {
        std::vector<uchar> edges;                // large penalties, two per pixel
        std::vector<uchar> winners, winnerCosts; // their lanes and costs
        std::vector<uchar> winnerSums[3];        // of the lane before, of theirs, and of the one behind

        void prepare(size_t pairs);
    };

    //! Bytes of a row of stored
    static size_t storedBytes(int width)
    {
        return (((size_t)width + 1) / 2 + maxRows - 1) * 2 * 2 * CandidateWindow::candidates;
    }
    //! Provides the memory for a layer of this width and number of disparities, and clears what a sweep starts from.
    CV_EXPORTS void prepare(int width, int numDisparities);
    //! H of a row, from column 0 on
    uchar* verticalOfColumns()
    {
        return alignPtr(vertical.data(), (int)alignment) + margin * CandidateWindow::candidates;
    }

    Mat stored;                  // by the first sweep for the other one: costs and sums of the columns of all steps
    std::vector<uchar> vertical; // CandidateWindow::candidates per column
    Windows windows[blocks];
    Block ofBlocks[blocks];
    // Which lanes have the candidates of a run that begins i disparities after one of these, in the middle and i on:
    // 255 for those that it does not have
    std::vector<uchar> orders[CandidateWindow::runs];
};

typedef ScratchPool<ScanlineScratch> ScanlineBuffers;

/** Aggregation of the census cost along scanlines, over the candidates of windows alone: semi-global matching from the
left and from below, in a sweep upward, and from the right and from above, in one downward. The cost of candidate d is

C(p, d) = census cost + floor(min(|I(p) - I'(p - d)|, 23) / 4) + floor(s(p) * prior * |d - predicted| / 2) + nearer,

the first two together no more than CostLimits allows, I being whole grey levels, s(p) the weight of smoothness in the
window of p, and predicted the disparity that the candidate's run was predicted for; nearer is 0 but for candidates of a
second run beyond the first one.

With L(p, d) of a direction and q the pixel before p,
L(p, d) = C(p, d) + min(L(q, d), L(q, d - 1) + small(p), L(q, d + 1) + small(p), m + large(p, q)) - m,
m = min_k L(q, k), small(p) = s(p) * small,
large(p, q) = max(min(small(r), s(r) * large), s(r) * large - floor(slope * max(w(p, q) - edgeNoise, 0) / 2)),
r being q, or p in the direction from the right, and slope borderSlope if its window has two runs, and else edgeSlope.
Penalties with their weight are rounded, and at most ScanlinePenalties::max. Candidates that q does not have count
m + large(p, q). d - 1 and d + 1 stand for the candidates before and after d in the window of p: those that p does not
have are left out, and the last one of its first run and the first one of the second count as neighbours even if they
are further apart. The winner has the lowest sum of the directions, each less its own minimum, at most 255, the first of
them if there are several; its sum and those of the candidates beside it, if p has disparities d - 1 and d + 1, give the
sub-pixel part, see winnerFraction().

The image is cut into stripes that do not depend on the number of threads; the directions from above and from below
start anew some rows before each of them. A tile has those of the image that it lies in.
@param weights w, CV_8UC2, of the layer, see weighEdges().
@param frame Where they lie in a larger image, if they are a tile of one; from an even row on.
@param maxDisparity That of a map of the layer. The winner may be beyond the ends of the range; its disparity is not.
@param windows From predictWindows().
@param smoothness s, from weighSmoothness().
@param disparity Receives CV_16UC1, a disparity map.
@param residual Receives the winners' own C(p, d), CV_8UC1. */
CV_EXPORTS void aggregateScanlines(const CensusCost& cost, const Mat& weights, const ImageFrame& frame,
                                   int numDisparities, int maxDisparity, const Mat& windows, const Mat& smoothness,
                                   const ScanlinePenalties& penalties, ScanlineBuffers& buffers, Mat& disparity,
                                   Mat& residual);

}}} // namespace cv::stereo::hdp

#endif
