// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "matching_cost.hpp"

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

void CostLimits::prepare(const PairMasks& masks, int numDisparities)
{
    const Mat &left = masks.left, &right = masks.right;
    if (left.empty())
    {
        *this = CostLimits();
        return;
    }
    width_ = left.cols;
    copyMakeBorder(pixelsWithData(left), left_, 0, 0, margin, margin, BORDER_REPLICATE);
    Mat limits = max(pixelsWithData(right), +ordinary), mirrored; // none where there is data
    firstColumns_.resize(right.rows);
    for (int y = 0; y < right.rows; ++y)
    {
        firstColumns_[y] = rowStart(masks, y).right;
        limits.row(y).colRange(0, firstColumns_[y]).setTo(Scalar(none));
    }
    flip(limits, mirrored, 1);
    copyMakeBorder(mirrored, right_, 0, 0, margin, numDisparities + costPadding + margin, BORDER_REPLICATE);
}

template <typename Cost>
void CostLimits::apply(const int* pixels, int count, int first, int lanes, Cost unit, int steps, Cost* cost) const
{
    if (isEmpty())
        return;
    const int shift = steps - 1; // divides by the steps
    for (int i = 0; i < count; ++i, cost += lanes)
    {
        const int y = pixels[i] / width_, x = pixels[i] - y * width_;
        const uchar* const limit = right(y) + width_ - 1 - x;
        if (left(y)[x] == 0)
            std::fill(cost, cost + lanes, (Cost)0);
        else
            for (int k = 0; k < lanes; ++k)
            {
                const int candidate = first + k;
                const uchar both = std::min(limit[candidate >> shift], limit[(candidate + shift) >> shift]);
                cost[k] = both == none ? cost[k] : std::min(cost[k], (Cost)(unit * both));
            }
    }
}

template void CostLimits::apply(const int*, int, int, int, float, int, float*) const;
template void CostLimits::apply(const int*, int, int, int, uchar, int, uchar*) const;

void CostLimits::apply(int y, const ushort* disparity, uchar* cost) const
{
    if (isEmpty())
        return;
    const uchar *own = left(y), *limit = right(y) + width_ - 1;
    for (int x = 0; x < width_; ++x)
        cost[x] = std::min(cost[x], std::min(own[x], limit[wholeDisparity(disparity[x]) - x]));
}

Mat CostLimits::dropMissing(const Mat& disparity) const
{
    if (isEmpty())
        return disparity;
    Mat dropped = disparity.clone();
    dropped.setTo(Scalar(USHRT_MAX), left_.colRange(margin, margin + width_) == 0);
    return dropped;
}

void CostLimits::hideUnmatched(int y, const ushort* disparity, uchar* visible) const
{
    if (isEmpty())
        return;
    const uchar* const limit = right(y) + width_ - 1;
    const int first = firstColumn(y);
    for (int x = 0; x < width_; ++x)
    {
        const int whole = wholeDisparity(disparity[x]);
        visible[x] = x - whole >= first && limit[whole - x] == none ? visible[x] : 0;
    }
}

void MatchingCost::ofDisparities(const Mat& disparity, Mat& costs) const
{
    costs.create(disparity.size(), CV_32S);
    parallelForRows(disparity.size(), [&](int y) {
        float cost[4];
        for (int x = 0; x < disparity.cols; ++x)
        {
            const int pixel = y * disparity.cols + x;
            evaluate(&pixel, 1, wholeDisparity(disparity.ptr<ushort>(y)[x]), 4, cost);
            costs.ptr<int>(y)[x] = cvRound(512 * cost[0]);
        }
    });
}

}}} // namespace cv::stereo::hdp
