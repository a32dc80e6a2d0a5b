// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "cost_volume.hpp"

#include <cstring>

namespace cv {
namespace stereo {
namespace hdp {

void CostVolume::create(Size size_, int numDisparities_)
{
    size = size_;
    numDisparities = numDisparities_;
    pitch = (int)alignSize(numDisparities, pitchFactor);
    costs.create(size.height, size.width * pitch, CV_8U);
    if (pitch == numDisparities)
        return;
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < size.width; ++x)
                std::memset(costs.ptr(y) + x * pitch + numDisparities, 255, pitch - numDisparities);
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
