// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "candidate_windows.hpp"
#include "sparse_matches.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of predictWindows().
@param filtered The layer above.
@param unfiltered The same before the median.
@param matches The match in each pixel's square, or SparseMatches::noMatch.
@param width Of the rows.
@param numDisparities Of the layer.
@param discontinuity Pixels between disparities of different surfaces.
@param windows Receives a CandidateWindow each. */
void predictRow(const DisparityRow& filtered, const DisparityRow& unfiltered, const ushort* matches, int width,
                int numDisparities, int discontinuity, ushort* windows);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! The first of a number of candidates around a disparity, or around the middle between two.
inline int firstOf(int disparity, int candidates, int numDisparities)
{
    const int outside = CandidateWindow::beyondRange;
    return std::max(std::min(disparity - (candidates / 2 - 1), numDisparities + outside - candidates), -outside);
}

inline int farthest(int from, int min, int max) { return max - from >= from - min ? max : min; }

} // namespace

void predictRow(const DisparityRow& filtered, const DisparityRow& unfiltered, const ushort* matches, int width,
                int numDisparities, int discontinuity, ushort* windows)
{
    const ushort *own = filtered.own, *min = filtered.min, *max = filtered.max;
    const ushort *raw = unfiltered.own, *minRaw = unfiltered.min, *maxRaw = unfiltered.max;
    const int length = CandidateWindow::runLength, all = CandidateWindow::candidates,
              outside = CandidateWindow::beyondRange, distance = discontinuity * subpixelScale;
    const auto isOther = [=](int a, int b) { return (int)(std::abs(a - b) >= distance); }; // surface
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * own[x], match = matches[x];
        int other = farthest(here, 2 * minRaw[x], 2 * maxRaw[x]);
        const int ofFiltered = farthest(here, 2 * min[x], 2 * max[x]);
        other = choose(isOther(ofFiltered, here), ofFiltered, other);
        other = choose((match != SparseMatches::noMatch) & isOther(match, here), match, other);
        other = choose(isOther(2 * raw[x], here), 2 * raw[x], other);
        const int nearest = wholeDisparity(here), nearestOther = wholeDisparity(other);
        const int around = firstOf(nearest, all, numDisparities);
        const int first = firstOf(nearest, length, numDisparities);
        const int beyond = firstOf(nearestOther, length, numDisparities);
        // Two runs would overlap: one window over both
        const int between =
            std::max(std::min((first + beyond + length - all) >> 1, numDisparities + outside - all), -outside);

        const int hasOther = isOther(other, here);
        const int overlaps = hasOther & (std::abs(first - beyond) < length), isApart = hasOther - overlaps;
        const int low = choose(isApart, first, choose(overlaps, between, around));
        windows[4 * x] = (ushort)low;
        windows[4 * x + 1] = (ushort)choose(isApart, beyond, low + length);
        windows[4 * x + 2] = (ushort)choose(overlaps, std::min(here, other), here);
        windows[4 * x + 3] = (ushort)choose(overlaps, std::max(here, other), choose(isApart, other, here));
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
