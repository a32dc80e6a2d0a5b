// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "other_surfaces.hpp"
#include "other_surfaces.simd.hpp"
#include "scanlines/other_surfaces.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, neighborhood, 3, "pixels of the upper layer",
            "in which the surface beyond a discontinuity is: in more there is often a third one");
HDP_TUNABLE(int, maxStripes, 16, "stripes", "for as many threads: more filter the rows between them twice");
HDP_TUNABLE(int, minStripeHeight, 16, "rows", "for the same reason");

HDP_DISPATCH(findOthersOfRow)

} // namespace

void findOtherSurfaces(const Mat& upper, const Mat& unfiltered, SurfaceBuffers& buffers, Mat& others)
{
    const Mat maps[] = { upper, unfiltered };
    const Size size = upper.size();
    // Not Mat::ones(): the first thread with an expression sets them up, in OpenCV, which ThreadSanitizer does not see.
    const Mat kernel(2 * neighborhood + 1, 2 * neighborhood + 1, CV_8U, Scalar(1));
    for (int map = 0; map < 2; ++map)
    {
        buffers.min[map].create(size, CV_16U);
        buffers.max[map].create(size, CV_16U);
    }
    others.create(size, CV_16U);
    const int stripes = std::max(1, std::min<int>(maxStripes, size.height / minStripeHeight));
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        const Range rows(size.height * range.start / stripes, size.height * range.end / stripes);
        for (int map = 0; map < 2; ++map)
        {
            Mat minima = buffers.min[map].rowRange(rows), maxima = buffers.max[map].rowRange(rows);
            erode(maps[map].rowRange(rows), minima, kernel); // a stripe sees its neighbours' rows
            dilate(maps[map].rowRange(rows), maxima, kernel);
        }
        const auto rowOf = [&](int map, int y) -> DisparityRow {
            return { maps[map].ptr<ushort>(y), buffers.min[map].ptr<ushort>(y), buffers.max[map].ptr<ushort>(y) };
        };
        for (int y = rows.start; y < rows.end; ++y)
            dispatched::findOthersOfRow(rowOf(0, y), rowOf(1, y), size.width, others.ptr<ushort>(y));
    });
}

}}} // namespace cv::stereo::hdp
