// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_alignment.hpp"

#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, sideWeight, 27, "1/256", "of a pixel's neighbour: more loses texture, less keeps noise");

} // namespace

void smoothNoise(const Mat& image, Mat& smoothed)
{
    const int width = image.cols, side = sideWeight, middle = 256 - 2 * side;
    smoothed.create(image.size(), CV_16U);
    parallelForRows(image.size(), std::vector<int>(width + 2),
                    [=, &image, &smoothed](int y, std::vector<int>& columns) {
        const ushort *const own = image.ptr<ushort>(y), *const above = image.ptr<ushort>(std::max(y - 1, 0)),
                            *const below = image.ptr<ushort>(std::min(y + 1, image.rows - 1));
        int* const column = &columns[1]; // and one more at both ends
        ushort* const row = smoothed.ptr<ushort>(y);
        HDP_VECTORIZED for (int x = 0; x < width; ++x) column[x] = middle * own[x] + side * (above[x] + below[x]);
        column[-1] = column[0];
        column[width] = column[width - 1];
        HDP_VECTORIZED for (int x = 0; x < width; ++x) row[x] =
            (ushort)((middle * column[x] + side * (column[x - 1] + column[x + 1]) + (1 << 15)) >> 16);
    });
}

}}} // namespace cv::stereo::hdp
