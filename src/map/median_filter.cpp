// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "median_filter.simd.hpp"
#include "map/median_filter.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

HDP_DISPATCH(medianRow)

void medianDisparity(const Mat& disparity, int size, Mat& filtered)
{
    filtered.create(disparity.size(), CV_16U);
    parallel_for_(Range(0, disparity.rows), [&](const Range& range) {
        const int radius = size / 2, width = disparity.cols;
        Mat buffer(size, width + 2 * radius, CV_16S);
        std::vector<short*> sorted(size);
        std::vector<const ushort*> rows(size);
        for (int i = 0; i < size; ++i)
            sorted[i] = buffer.ptr<short>(i) + radius;
        for (int y = range.start; y < range.end; ++y)
        {
            for (int i = 0; i < size; ++i)
                rows[i] = disparity.ptr<ushort>(clamped(y + i - radius, 0, disparity.rows - 1));
            dispatched::medianRow(rows.data(), size, width, sorted.data(), filtered.ptr<ushort>(y));
        }
    });
}

}}} // namespace cv::stereo::hdp
