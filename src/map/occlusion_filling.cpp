// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "occlusion_filling.hpp"

#include "occlusion_filling.simd.hpp"
#include "map/occlusion_filling.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"
#include "../base/mask.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxBlack, 2, "grey levels", "of blank columns, as JPEG leaves them: more takes dark scenes for blank");

HDP_DISPATCH(fillOccludedRow)

//! The number of columns of a row, from the left border on, before the first one that shows something
template <typename T, typename Shows> int countBlank(const Mat& image, int y, const Shows& shows)
{
    const T* const row = image.ptr<T>(y);
    return (int)(std::find_if(row, row + image.cols, shows) - row);
}

} // namespace

void fillOccluded(Mat& disparity, const Mat& residual, const Mat& right, const Mat& rightMask)
{
    const auto isBright = [](ushort level) { return level > maxBlack * greyScale; };
    parallelForRows(disparity.size(), OcclusionScratch(disparity.cols), [&](int y, OcclusionScratch& scratch) {
        const int blank = !rightMask.empty() ? countBlank<uchar>(rightMask, y, hasData)
                          : !right.empty()   ? countBlank<ushort>(right, y, isBright)
                                             : 0;
        dispatched::fillOccludedRow(disparity.ptr<ushort>(y), residual.ptr(y), disparity.cols, blank, scratch);
    });
}

}}} // namespace cv::stereo::hdp
