// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "candidate_windows.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A row of findOtherSurfaces(), of so many pixels of the layer above, with and without the median
void findOthersOfRow(const DisparityRow& filtered, const DisparityRow& unfiltered, int width, ushort* others);

//! A row of predictWindows(): of so many pixels of the layer above. windows: receives a CandidateWindow each.
void predictRow(const ushort* upper, const ushort* others, int width, int numDisparities, ushort* windows);

//! A row of restrictWindows()
void restrictRow(const ushort* intervals, int width, int numDisparities, ushort* windows);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

inline int farthest(int from, int min, int max) { return max - from >= from - min ? max : min; }

} // namespace

void findOthersOfRow(const DisparityRow& filtered, const DisparityRow& unfiltered, int width, ushort* others)
{
    const ushort *own = filtered.own, *min = filtered.min, *max = filtered.max;
    const ushort *raw = unfiltered.own, *minRaw = unfiltered.min, *maxRaw = unfiltered.max;
    const int distance = otherSurfaceDistance * subpixelScale;
    const auto isOther = [=](int a, int b) { return (int)(std::abs(a - b) >= distance); }; // surface
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * own[x];
        int other = farthest(here, 2 * minRaw[x], 2 * maxRaw[x]);
        const int ofFiltered = farthest(here, 2 * min[x], 2 * max[x]);
        other = choose(isOther(ofFiltered, here), ofFiltered, other);
        other = choose(isOther(2 * raw[x], here), 2 * raw[x], other);
        others[x] = (ushort)choose(isOther(other, here), other, here);
    }
}

void predictRow(const ushort* upper, const ushort* others, int width, int numDisparities, ushort* windows)
{
    const int length = CandidateWindow::runLength, all = CandidateWindow::candidates;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * upper[x], other = others[x];
        const int nearest = wholeDisparity(here), nearestOther = wholeDisparity(other);
        const int around = firstCandidate(nearest, all, numDisparities);
        const int first = firstCandidate(nearest, length, numDisparities);
        const int beyond = firstCandidate(nearestOther, length, numDisparities);
        const int between =
            firstCandidate(((first + beyond + length) >> 1) - 1, all, numDisparities); // if runs overlap

        const int hasOther = (int)(other != here);
        const int overlaps = hasOther & (std::abs(first - beyond) < length), isApart = hasOther - overlaps;
        const int low = choose(isApart, first, choose(overlaps, between, around));
        windows[4 * x] = (ushort)low;
        windows[4 * x + 1] = (ushort)choose(isApart, beyond, low + length);
        windows[4 * x + 2] = (ushort)choose(overlaps, std::min(here, other), here);
        windows[4 * x + 3] = (ushort)choose(overlaps, std::max(here, other), choose(isApart, other, here));
    }
}

void restrictRow(const ushort* intervals, int width, int numDisparities, ushort* windows)
{
    const int length = CandidateWindow::runLength, all = CandidateWindow::candidates;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int first = intervals[2 * x], last = intervals[2 * x + 1];
        ushort* const window = windows + 4 * x;
        const int run = (short)window[0], otherRun = (short)window[1], predicted = window[2], other = window[3];
        const int usesFirst = (int)(run <= last) & (int)(run + length > first),
                  usesOther = (int)(otherRun <= last) & (int)(otherRun + length > first);
        const int usesBoth = usesFirst & usesOther, usesAny = usesFirst | usesOther;

        const int surface = choose(usesOther, other, predicted);
        const int centre = std::min(std::max(wholeDisparity(surface), first), last);
        const int begin = firstCandidate(centre, all, numDisparities);
        const int moved = choose(usesAny, surface, centre * subpixelScale);
        window[0] = (ushort)choose(usesBoth, run, begin);
        window[1] = (ushort)choose(usesBoth, otherRun, begin + length);
        window[2] = (ushort)choose(usesBoth, predicted, moved);
        window[3] = (ushort)choose(usesBoth, other, moved);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
