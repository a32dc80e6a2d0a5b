// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "upsampling.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

void upsampleDisparity(const Mat& upper, Size size, Mat& disparity)
{
    disparity.create(size, CV_16U);
    parallelFor(size.height, [&](int y) {
        const auto clampRow = [&](int row) { return clamped(row, 0, upper.rows - 1); };
        const ushort* own = upper.ptr<ushort>(clampRow(y / 2));
        const ushort* beside = upper.ptr<ushort>(clampRow(y % 2 ? y / 2 + 1 : y / 2 - 1));
        ushort* row = disparity.ptr<ushort>(y);
        const auto mean = [&](int x, int next) {
            const int d = own[x];
            const auto sameSurface = [&](int other) { return std::abs(other - d) <= subpixelScale ? other : d; };
            return (ushort)((9 * d + 3 * sameSurface(own[next]) + 3 * sameSurface(beside[x]) +
                             sameSurface(beside[next]) + 4) /
                            8);
        };
        const int last = upper.cols - 1;
        HDP_VECTORIZED for (int x = 1; x < last; ++x)
        {
            row[2 * x] = mean(x, x - 1);
            row[2 * x + 1] = mean(x, x + 1);
        }
        row[0] = mean(0, 0);
        if (size.width > 1)
            row[1] = mean(0, std::min(1, last));
        for (int x = std::max(2 * last, 2); x < size.width; ++x) // a last odd column is that pixel's, too
            row[x] = mean(last, x % 2 ? last : x / 2 - 1);
    });
}

}}} // namespace cv::stereo::hdp
