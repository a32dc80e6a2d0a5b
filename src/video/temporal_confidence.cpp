// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_confidence.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

void trustStable(const FrameMemory& frame, Mat& confidence)
{
    if (frame.detail.size() != confidence.size()) // of a layer that is smaller than a cell nothing is left
        return;
    double most;
    const Mat counts = frame.detail & Scalar(FrameMemory::countMask);
    minMaxLoc(counts, nullptr, &most);
    float factors[FrameMemory::countMask + 1];
    for (int count = 0; count <= FrameMemory::countMask; ++count)
        factors[count] = std::sqrt((float)(count + 1) / (float)(most + 1));
    parallelFor(confidence.rows, [&](int y) {
        const uchar* const ofRow = counts.ptr(y);
        uchar* const row = confidence.ptr(y);
        for (int x = 0; x < confidence.cols; ++x)
            row[x] = (uchar)((float)row[x] * factors[ofRow[x]] + 0.5f);
    });
}

}}} // namespace cv::stereo::hdp
