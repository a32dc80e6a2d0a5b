// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_WINDOW_PREDICTION_HPP
#define OPENCV_HDPSTEREO_TEST_WINDOW_PREDICTION_HPP

#include "test_precomp.hpp"
#include "../src/scanlines/candidate_windows.hpp"

namespace opencv_test {

//! Disparities of a layer above another one with this number of disparities: patches of slanted surfaces.
inline Mat patchesAbove(RNG& rng, Size size, int numDisparities, int patch)
{
    const int scale = 16, largest = (numDisparities - 1) / 2 * scale;
    Mat upper(size, CV_16UC1);
    for (int y0 = 0; y0 < size.height; y0 += patch)
        for (int x0 = 0; x0 < size.width; x0 += patch)
        {
            const int offset = rng.uniform(0, largest + 1), slope = rng.uniform(-8, 9);
            for (int y = y0; y < std::min(y0 + patch, size.height); ++y)
                for (int x = x0; x < std::min(x0 + patch, size.width); ++x)
                    upper.at<ushort>(y, x) = (ushort)std::min(std::max(offset + slope * (x - x0), 0), largest);
        }
    return upper;
}

//! What is known of a layer
struct Prediction
{
    Mat upper, unfiltered;

    explicit Prediction(const Mat& upper_) : upper(upper_), unfiltered(upper_.clone()) {}

    //! Single pixels that the median removed
    void addThinStructures(RNG& rng, int numDisparities)
    {
        const int scale = 16, largest = (numDisparities - 1) * scale;
        for (int y = 0; y < unfiltered.rows; ++y)
            for (int x = 0; x < unfiltered.cols; ++x)
                if (rng.uniform(0, 30) == 0)
                    unfiltered.at<ushort>(y, x) = (ushort)rng.uniform(0, largest / 2 + 1);
    }
};

namespace oracle {

//! The disparity in 7 x 7 pixels that is farthest from another one; of two as far, the larger one
inline int farthest(const Mat& upper, int y, int x, int own)
{
    int result = own;
    for (int v = std::max(y - 3, 0); v <= std::min(y + 3, upper.rows - 1); ++v)
        for (int u = std::max(x - 3, 0); u <= std::min(x + 3, upper.cols - 1); ++u)
        {
            const int other = upper.at<ushort>(v, u), farther = std::abs(other - own) - std::abs(result - own);
            if (farther > 0 || (farther == 0 && other > result))
                result = other;
        }
    return result;
}

//! The other surface, or the pixel's own
inline int otherSurface(const Prediction& prediction, int y, int x)
{
    const int own = 2 * prediction.upper.at<ushort>(y, x);
    const int sources[] = { 2 * prediction.unfiltered.at<ushort>(y, x), 2 * farthest(prediction.upper, y, x, own / 2),
                            2 * farthest(prediction.unfiltered, y, x, own / 2) };
    for (int other : sources)
        if (std::abs(other - own) >= 5 * 16)
            return other;
    return own;
}

} // namespace oracle

} // namespace opencv_test

#endif
