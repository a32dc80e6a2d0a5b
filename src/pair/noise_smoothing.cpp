// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "noise_smoothing.hpp"

#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, sideWeight, 27, "1/256", "of a pixel's neighbour: more loses texture, less keeps noise");

//! A row, from it and those beside it; columns: memory for as many and one more at both ends
void smoothRow(const ushort* own, const ushort* above, const ushort* below, int width, int* columns, ushort* smoothed)
{
    const int side = sideWeight, middle = 256 - 2 * side;
    int* const column = columns + 1;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) column[x] = middle * own[x] + side * (above[x] + below[x]);
    column[-1] = column[0];
    column[width] = column[width - 1];
    HDP_VECTORIZED for (int x = 0; x < width; ++x) smoothed[x] =
        (ushort)((middle * column[x] + side * (column[x - 1] + column[x + 1]) + (1 << 15)) >> 16);
}

} // namespace

void smoothNoise(const Mat& image, Mat& smoothed)
{
    const int width = image.cols, last = image.rows - 1;
    smoothed.create(image.size(), CV_16U);
    parallelFor(image.rows, std::vector<int>(width + 2), [&](int y, std::vector<int>& columns) {
        smoothRow(image.ptr<ushort>(y), image.ptr<ushort>(std::max(y - 1, 0)), image.ptr<ushort>(std::min(y + 1, last)),
                  width, columns.data(), smoothed.ptr<ushort>(y));
    });
}

}}} // namespace cv::stereo::hdp
