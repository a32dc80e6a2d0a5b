// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_reasons.hpp"

#include "left_right_check.hpp"
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

void findReasons(const Mat& disparity, const OutputPlan& plan, int width, const CostLimits& limits, Mat& reasons)
{
    Mat stable;
    findStable(limits.dropMissing(disparity), stable);
    const int scale = 1 << plan.finestLayer, half = subpixelScale / 2;
    reasons.create(disparity.size(), CV_8U);
    parallelFor(reasons.rows, [&](int y) {
        for (int x = 0; x < reasons.cols; ++x)
        {
            // The column of the right image, in 1 / subpixelScale pixel
            const int64 column = ((int64)x * scale - plan.extension - plan.minDisparity) * subpixelScale -
                                 (int64)disparity.at<ushort>(y, x) * scale;
            const bool isInside = column > -half && column <= (width - 1) * (int64)subpixelScale + half;
            const bool isStable = stable.at<uchar>(y, x) != 0;
            reasons.at<uchar>(y, x) = (uchar)(!isInside  ? HDPTreeMatcher::REASON_OUTSIDE
                                              : isStable ? HDPTreeMatcher::REASON_MATCHED
                                                         : HDPTreeMatcher::REASON_OCCLUDED);
        }
    });
}

}}} // namespace cv::stereo::hdp
