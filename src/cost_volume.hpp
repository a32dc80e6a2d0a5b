// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_COST_VOLUME_HPP
#define OPENCV_HDPSTEREO_COST_VOLUME_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {
namespace hdp {

//! Costs of all candidates of all pixels: that of candidate d of pixel (x, y) is at costs.ptr(y)[x * pitch + d].
struct CV_EXPORTS CostVolume
{
    enum
    {
        scale = 8,       // of the costs, for their fractions
        pitchFactor = 16 // of which pitch is a multiple
    };
    Size size;
    int numDisparities = 0;
    int pitch = 0; // from a pixel to the next
    Mat costs;     // CV_8UC1, continuous; 255 behind the last candidate

    //! Provides the memory. The costs of the candidates are not set.
    void create(Size size, int numDisparities);
};

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
