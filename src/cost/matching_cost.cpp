// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "matching_cost.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

template <typename T> void copyColumns(const T* from, int step, int width, T* to)
{
    if (step == 1)
        std::copy(from, from + width, to);
    else if (step == -1)
    {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) to[x] = from[-x];
    }
    else
        for (int x = 0; x < width; ++x, from += step)
            to[x] = *from;
}

template <typename T>
void copyRows(const Mat& image, int channel, int first, int before, int after, bool mirrored, Mat& bordered)
{
    const int step = image.channels(), width = image.cols;
    parallelFor(bordered.rows, [&](int y) {
        const T* from = image.ptr<T>(std::min(std::max(first + y, 0), image.rows - 1)) + channel;
        T* to = bordered.ptr<T>(y);
        copyColumns(mirrored ? from + (width - 1) * step : from, mirrored ? -step : step, width, to + before);
        std::fill(to, to + before, to[before]);
        std::fill(to + before + width, to + before + width + after, to[before + width - 1]);
    });
}

} // namespace

MatchingCost::~MatchingCost() {}

void MatchingCost::ofDisparities(const Mat& disparity, Mat& costs) const
{
    costs.create(disparity.size(), CV_32S);
    parallelFor(disparity.rows, [&](int y) {
        float cost[4];
        for (int x = 0; x < disparity.cols; ++x)
        {
            const int pixel = y * disparity.cols + x;
            evaluate(&pixel, 1, wholeDisparity(disparity.ptr<ushort>(y)[x]), 4, cost);
            costs.ptr<int>(y)[x] = cvRound(512 * cost[0]);
        }
    });
}

void copyBordered(const Mat& image, int channel, int first, int before, int after, bool mirrored, Mat bordered)
{
    if (image.elemSize1() == 1)
        copyRows<uchar>(image, channel, first, before, after, mirrored, bordered);
    else
        copyRows<ushort>(image, channel, first, before, after, mirrored, bordered);
}

}}} // namespace cv::stereo::hdp
