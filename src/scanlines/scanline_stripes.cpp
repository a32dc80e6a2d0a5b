// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "scanline_stripes.hpp"

namespace cv { namespace stereo { namespace hdp {

HDP_TUNABLE(int, warmUpRows, 16, "rows",
            "beside a stripe, which the vertical directions begin with: fewer show its border, more cost time");

std::vector<ScanlineStripe> stripesOf(const ImageFrame& frame, int height, int rows)
{
    const int whole = frame.whole.height, first = frame.origin.y;
    const int count = whole < rows / 2 ? 1 : 2 * std::max(1, cvRound(whole / (2. * rows)));
    const auto border = [&](int64 index) {
        return index < count ? (int)(whole * index / count / 2 * 2) - first : whole - first;
    };
    std::vector<ScanlineStripe> stripes;
    for (int i = 0; i < count; ++i)
    {
        const Range own(std::max(border(i), 0), std::min(border(i + 1), height));
        const Range reach(std::max(own.start - warmUpRows, 0), std::min(own.end + warmUpRows, height));
        if (own.start < own.end)
            stripes.push_back({ own, reach });
    }
    return stripes;
}

}}} // namespace cv::stereo::hdp
