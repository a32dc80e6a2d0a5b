// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "surface_smoothing.simd.hpp"
#include "map/surface_smoothing.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, mostDifference, 1, "pixels", "on a surface: less leaves its noise, more rounds small steps");

HDP_DISPATCH(smoothRow)

} // namespace

void smoothSurfaces(const Mat& disparity, Mat& smoothed)
{
    const ushort likeness = (ushort)(mostDifference * subpixelScale);
    const int radius = smoothingRadius, width = disparity.cols, lastRow = disparity.rows - 1;
    smoothed.create(disparity.size(), CV_16U);
    parallelFor(disparity.rows, std::vector<ushort>(width + 2 * radius), [&](int y, std::vector<ushort>& padded) {
        const ushort* const own = disparity.ptr<ushort>(y);
        std::fill_n(padded.begin(), radius, own[0]);
        std::copy(own, own + width, padded.begin() + radius);
        std::fill_n(padded.end() - radius, radius, own[width - 1]);
        const ushort* rows[2 * smoothingRadius + 1];
        for (int dy = -radius; dy <= radius; ++dy)
            rows[radius + dy] = disparity.ptr<ushort>(clamped(y + dy, 0, lastRow));
        rows[radius] = &padded[radius];
        dispatched::smoothRow(rows, width, likeness, smoothed.ptr<ushort>(y));
    });
}

}}} // namespace cv::stereo::hdp
