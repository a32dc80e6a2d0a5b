// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "occlusion_filling.hpp"

#include "occlusion_filling.simd.hpp"
#include "map/occlusion_filling.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

HDP_DISPATCH(fillOccludedRow)

void fillOccluded(Mat& disparity, const Mat& residual, const PairMasks& masks)
{
    parallelForRows(disparity.size(), OcclusionScratch(disparity.cols), [&](int y, OcclusionScratch& scratch) {
        const RowStart start = rowStart(masks, y);
        const int width = disparity.cols - start.left;
        if (width > 0)
            dispatched::fillOccludedRow(disparity.ptr<ushort>(y) + start.left, residual.ptr(y) + start.left, width,
                                        start.left - start.right, scratch);
    });
}

}}} // namespace cv::stereo::hdp
