// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_WINNER_FRACTION_HPP
#define OPENCV_HDPSTEREO_WINNER_FRACTION_HPP

#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#include <cmath>

namespace cv { namespace stereo { namespace hdp {

/** The fraction of the winner of scanlines, in pixels, from its sum and those beside it.

With u = rise / slope, the tip of two lines of opposite slope through the three sums is at u / 2. That is too near to
whole disparities where the minimum is sharp; there it is (0.65 sign(u) sqrt(|u|) + 0.35 u) / 2, which was fitted to
slanted planes, see hdp_subpixel. Where it is blunt, the fraction is mostly noise, and the tip is better. Between both
the share of the root is linear.
@param rise The sum before the winner's, less the one after it; 0 for no fraction.
@param slope The larger one of both, less the winner's, at least 1.
@param blunt,sharp Up to which slope, and from which one on. */
CV_ALWAYS_INLINE float winnerFraction(float rise, float slope, float blunt, float sharp)
{
    const float rootShare = 0.65f;
    const float u = rise / slope;
    const float share = rootShare * clamped((slope - blunt) / (sharp - blunt), 0.f, 1.f);
    const float root = std::copysign(std::sqrt(std::abs(u)), u);
    return 0.5f * (u + share * (root - u));
}

//! In units of a disparity map, rounded to the nearest as cvRound() does, but in vectors, too
CV_ALWAYS_INLINE int subpixelUnits(float fraction)
{
    const float wholes = 12582912; // 1.5 * 2^23: sums with it are whole numbers
    return (int)((subpixelScale * fraction + wholes) - wholes);
}

//! The winners of sums of four directions, and what winnerFraction() is given of each, for many of them together
struct Winners
{
    ushort* whole;
    short *rise, *slope;

    //! Sets number i, a candidate of 0 .. lastOfAll, from the sums of all; of the pixel's own interval alone, if it
    //! has one and the winner lies in it: costs beyond are not those of candidates. Beyond the first and the last
    //! candidate: the slope beside them, or that which leaves the tip at the end. Less than three have no fraction.
    template <typename Sum>
    CV_ALWAYS_INLINE void set(int i, const Sum* ofAll, int candidate, int lastOfAll, const DisparityInterval* own) const
    {
        const bool isInside = own && own->first <= candidate && candidate <= own->last;
        const int first = isInside ? own->first : 0, k = candidate - first,
                  last = (isInside ? std::min((int)own->last, lastOfAll) : lastOfAll) - first;
        const Sum* const sums = ofAll + first;
        whole[i] = (ushort)candidate;
        rise[i] = 0;
        slope[i] = 1;
        if (last < 2)
            return;
        const int sum = sums[k];
        const int before = k > 0 ? sums[k - 1] : sum + std::max(sums[2] - sums[1], sums[1] - sum);
        const int after =
            k < last ? sums[k + 1] : sum + std::max(sums[last - 2] - sums[last - 1], sums[last - 1] - sum);
        rise[i] = (short)(before - after);
        slope[i] = (short)std::max(std::max(before, after) - sum, 1);
    }

    //! Disparities of a map. bit: what a bit of the census costs in one direction; halving: 1 if there are two
    //! candidates per pixel of disparity, else 0
    CV_ALWAYS_INLINE void takeDisparities(int count, int bit, int halving, ushort* disparity) const
    {
        // Bits per direction, as bluntSlope and sharpSlope are of scanlines over windows
        const float unit = 4.f * bit, blunt = 8 * unit, sharp = 14 * unit;
        const ushort* const candidates = whole;
        const short *const rises = rise, *const slopes = slope;
        HDP_VECTORIZED for (int i = 0; i < count; ++i)
        {
            const float fraction = winnerFraction((float)rises[i], (float)slopes[i], blunt, sharp);
            disparity[i] = (ushort)((candidates[i] * subpixelScale + subpixelUnits(fraction)) >> halving);
        }
    }
};

}}} // namespace cv::stereo::hdp

#endif
