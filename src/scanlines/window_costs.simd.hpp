// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "scanline_aggregation.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

// Grey levels, four of which count as a bit: larger differences are other light or another surface
const int maxContrast = 23;

//! C(p, d) of aggregateScanlines() for the pixels of a block of rows, as a Sweep enters them
class WindowCosts
{
public:
    static const int hasLimits = 4; // a layout of the costs: the number of planes, and this if they are limited

    WindowCosts(const CensusCost& cost, int width)
        : cost_(cost), planeStride_(cost.planeStride()), lastColumn_(width - 1)
    {
    }

    //! The row of a group
    void enterRow(int group, int row)
    {
        left_[group] = cost_.leftPixels(row);
        right_[group] = cost_.rightPlane(0, row) + lastColumn_;
        if (cost_.limits().isEmpty())
            return;
        leftLimits_[group] = cost_.limits().left(row);
        rightLimits_[group] = cost_.limits().right(row) + lastColumn_;
    }

    //! Those of the candidates at both columns of a step, and ScanlinePenalties::max
    template <int layout> CV_ALWAYS_INLINE void of(const ScanlineWindows& windows, int step, ByteLanes (&cost)[2]) const
    {
        const int planes = layout & (hasLimits - 1);
        const uchar* left[groups];
        OneRun low;
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = left_[r] + 4 * x;
            low.first[r] = right_[r] - x + windows.first(0, step - r);
        }
        if (windows.isContiguous(step))
        {
            cost[0] = costs<planes, 0>(left, low);
            cost[1] = costs<planes, 1>(left, low);
        }
        else
        {
            TwoRuns both;
            for (int r = 0; r < groups; ++r)
            {
                both.low[r] = low.first[r];
                both.high[r] = right_[r] - 2 * (ptrdiff_t)(step - r) + windows.first(1, step - r);
            }
            cost[0] = costs<planes, 0>(left, both);
            cost[1] = costs<planes, 1>(left, both);
        }
        if (layout & hasLimits)
            limit(windows, step, cost);
        const ByteLanes prior = ByteLanes::load(windows.prior(step));
        cost[0] = prior + cost[0];
        cost[1] = prior + cost[1];
    }

private:
    static const int groups = ByteLanes::groups;

    //! Where the candidates of the groups begin, and those at an offset from there
    struct OneRun
    {
        const uchar* first[groups];
        CV_ALWAYS_INLINE ByteLanes at(ptrdiff_t offset) const { return ByteLanes::load(first, offset); }
    };
    struct TwoRuns
    {
        const uchar *low[groups], *high[groups];
        CV_ALWAYS_INLINE ByteLanes at(ptrdiff_t offset) const { return ByteLanes::loadHalves(low, high, offset); }
    };

    //! Limits the costs at both columns of a step, see CostLimits.
    CV_ALWAYS_INLINE void limit(const ScanlineWindows& windows, int step, ByteLanes (&cost)[2]) const
    {
        const uchar *left[groups], *low[groups], *high[groups];
        for (int r = 0; r < groups; ++r)
        {
            const ptrdiff_t x = 2 * (ptrdiff_t)(step - r);
            left[r] = leftLimits_[r] + x;
            low[r] = rightLimits_[r] - x + windows.first(0, step - r);
            high[r] = rightLimits_[r] - x + windows.first(1, step - r);
        }
        cost[0] = cost[0].min(ByteLanes::repeatByte<0>(left)).min(ByteLanes::loadHalves(low, high, 0));
        cost[1] = cost[1].min(ByteLanes::repeatByte<1>(left)).min(ByteLanes::loadHalves(low, high, -1));
    }

    //! At one column, but for the prior; right: a OneRun or TwoRuns
    template <int planes, int column, class Runs>
    CV_ALWAYS_INLINE ByteLanes costs(const uchar* const (&left)[groups], const Runs& right) const
    {
        const int at = 4 * column;
        const ptrdiff_t plane = (ptrdiff_t)planeStride_;
        const ByteLanes grey = ByteLanes::repeatByte<at + CensusCost::greyByte>(left);
        const ByteLanes difference = grey.difference(right.at(planes * plane - column));
        const ByteLanes contrast = difference.min(ByteLanes::repeat(maxContrast)).shiftedRight<2>();
        const ByteLanes first = ByteLanes::repeatByte<at>(left) ^ right.at(-column);
        if (planes == 1)
            return contrast + first.countBits();
        const ByteLanes second = ByteLanes::repeatByte<at + 1>(left) ^ right.at(plane - column);
        if (planes == 2)
            return contrast + first.countBits() + second.countBits();
        const ByteLanes third = ByteLanes::repeatByte<at + 2>(left) ^ right.at(2 * plane - column);
        return contrast + ByteLanes::countBits(first, second, third);
    }

    const CensusCost& cost_;
    const size_t planeStride_; // from a plane of the cost to the next
    const int lastColumn_;
    const uchar *left_[groups], *right_[groups], *leftLimits_[groups], *rightLimits_[groups];
};

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
