// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SURFACE_SMOOTHING_HPP
#define OPENCV_HDPSTEREO_SURFACE_SMOOTHING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// What the rows of smoothSurfaces() are computed with

const int precisionSide = 7; // pixels, of the window that a precision is a sum of

//! How slopes are counted, in 1 / perNoise of the noise
struct SlopeScale
{
    enum
    {
        perNoise = 8,
        most = 36 // the sum of as many squares as there are in a window is below 2^16
    };

    ushort mostChange, factor; // of grey levels: the most that counts; of a slope over that change, in 1 / 256
};

//! The pairs of a pass
struct SmoothingPairs
{
    enum
    {
        count = 3
    };

    ptrdiff_t step;       // in memory, from the pixel to those of the first pair; each other pair is twice as far
    ushort limits[count]; // of their weights
    ushort like;          // the most that disparities of a surface differ
};

}}} // namespace cv::stereo::hdp

#endif
