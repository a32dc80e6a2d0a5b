// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "candidate_windows.hpp"
#include "disparity_units.hpp"
#include "vectorized.hpp"

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of predictWindows().
@param own Disparities of the upper layer.
@param least The smallest ones around each.
@param most The largest ones around each.
@param width Of the rows.
@param numDisparities Of the layer.
@param windows Receives a CandidateWindow each. */
void predictRow(const ushort* own, const ushort* least, const ushort* most, int width, int numDisparities,
                ushort* windows);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

// Disparities, in pixels of the layer, that lie this far apart belong to different surfaces.
const int discontinuity = 5;

//! The first of a number of candidates around a disparity, or around the middle between two.
inline int firstOf(int disparity, int candidates, int numDisparities)
{
    return std::max(std::min(disparity - (candidates / 2 - 1), numDisparities - candidates), 0);
}

//! condition ? a : b, condition being 0 or 1, without a branch
inline int select(int condition, int a, int b) { return b ^ ((a ^ b) & -condition); }

} // namespace

void predictRow(const ushort* own, const ushort* least, const ushort* most, int width, int numDisparities,
                ushort* windows)
{
    const int length = CandidateWindow::runLength, all = CandidateWindow::candidates;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int here = 2 * own[x], smallest = 2 * least[x], largest = 2 * most[x];
        const int other = largest - here >= here - smallest ? largest : smallest;
        const int nearest = wholeDisparity(here), nearestOther = wholeDisparity(other);
        const int around = firstOf(nearest, all, numDisparities);
        const int first = firstOf(nearest, length, numDisparities);
        const int beyond = firstOf(nearestOther, length, numDisparities);
        // Two runs would overlap: one window over both
        const int between = std::max(std::min((first + beyond + length - all) >> 1, numDisparities - all), 0);

        const int hasOther = std::abs(other - here) >= discontinuity * subpixelScale;
        const int overlaps = hasOther & (std::abs(first - beyond) < length), isApart = hasOther - overlaps;
        const int low = select(isApart, first, select(overlaps, between, around));
        windows[4 * x] = (ushort)low;
        windows[4 * x + 1] = (ushort)select(isApart, beyond, low + length);
        windows[4 * x + 2] = (ushort)select(overlaps, std::min(here, other), here);
        windows[4 * x + 3] = (ushort)select(overlaps, std::max(here, other), select(isApart, other, here));
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
