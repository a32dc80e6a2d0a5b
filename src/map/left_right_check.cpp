// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "left_right_check.hpp"

#include "left_right_check.simd.hpp"
#include "map/left_right_check.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(visibilityRow)

/** Compares each disparity with the maximum of those that map to the same column of the right image.
@param disparity CV_16SC1 or CV_16UC1 (T), in 1 / subpixelScale pixel.
@param maxDiff Maximum difference, in pixels, of a visible pixel.
@param invalid Disparity of pixels that map to no column, or a value that none has.
@param visit Called with each row and the Visibility of its pixels, rows side by side. */
template <typename T, typename Visit>
void checkLeftRight(const Mat& disparity, int maxDiff, int invalid, const Visit& visit)
{
    const int maxDifference = (int)std::min<int64>((int64)maxDiff * subpixelScale, INT_MAX);
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        std::vector<int> columns(disparity.cols), nearest(disparity.cols + 1);
        std::vector<uchar> visibility(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            dispatched::visibilityRow(disparity.ptr<T>(y), disparity.cols, invalid, maxDifference, columns.data(),
                                      nearest.data(), visibility.data());
            visit(y, visibility.data());
        }
    });
}

} // namespace

void rejectOccluded(Mat& disparity, int maxDiff, short invalid)
{
    const auto reject = [&](int y, const uchar* visibility) {
        short* row = disparity.ptr<short>(y);
        for (int x = 0; x < disparity.cols; ++x)
            if (visibility[x] == OCCLUDED)
                row[x] = invalid;
    };
    checkLeftRight<short>(disparity, maxDiff, invalid, reject);
}

void findStable(const Mat& disparity, Mat& stable)
{
    stable.create(disparity.size(), CV_8U);
    const auto mark = [&](int y, const uchar* visibility) {
        uchar* row = stable.ptr(y);
        const int width = stable.cols; // for vectors: bytes that are written could otherwise be those of the number
        HDP_VECTORIZED for (int x = 0; x < width; ++x) row[x] = visibility[x] == VISIBLE ? 255 : 0;
    };
    const int maxDiff = 1;
    checkLeftRight<ushort>(disparity, maxDiff, USHRT_MAX, mark);
}

}}} // namespace cv::stereo::hdp
