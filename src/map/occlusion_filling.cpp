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

//! The number of columns, from the left border on, that are black
int countBlank(const ushort* grey, int width)
{
    const int black = maxBlack * greyScale;
    return (int)(std::find_if(grey, grey + width, [=](ushort level) { return level > black; }) - grey);
}

//! The number of columns, from the left border on, without data
int countMasked(const uchar* mask, int width) { return (int)(std::find_if(mask, mask + width, hasData) - mask); }

} // namespace

void fillOccluded(Mat& disparity, const Mat& residual, const Mat& right, const Mat& rightMask)
{
    parallelFor(disparity.rows, OcclusionScratch(disparity.cols), [&](int y, OcclusionScratch& scratch) {
        const int blank = !rightMask.empty() ? countMasked(rightMask.ptr(y), rightMask.cols)
                          : right.empty()    ? 0
                                             : countBlank(right.ptr<ushort>(y), right.cols);
        dispatched::fillOccludedRow(disparity.ptr<ushort>(y), residual.ptr(y), disparity.cols, blank, scratch);
    });
}

}}} // namespace cv::stereo::hdp
