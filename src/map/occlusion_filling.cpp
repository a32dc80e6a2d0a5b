// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "occlusion_filling.hpp"

#include "occlusion_filling.simd.hpp"
#include "map/occlusion_filling.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/parallel_for.hpp"
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(fillOccludedRow)

} // namespace

void fillOccluded(Mat& disparity, const Mat& residual, const PairMasks& masks)
{
    parallelForRows(disparity.size(), OcclusionScratch(disparity.cols), [&](int y, OcclusionScratch& scratch) {
        const int first = masks.isEmpty() ? 0 : countBlank(masks.left, y), width = disparity.cols - first;
        const int border = masks.isEmpty() ? 0 : countBlank(masks.right, y);
        if (width > 0)
            dispatched::fillOccludedRow(disparity.ptr<ushort>(y) + first, residual.ptr(y) + first, width,
                                        first - border, scratch);
    });
}

}}} // namespace cv::stereo::hdp
