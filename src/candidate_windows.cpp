// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "candidate_windows.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// The surface beyond a discontinuity is looked for in the pixels of the upper layer up to this far away.
const int neighborhood = 3;

// Disparities, in pixels of the layer, that lie this far apart belong to different surfaces.
const int discontinuity = 5;

typedef CandidateWindow Window;

CandidateWindow predictWindow(int own, int smallest, int largest, int scale, int numDisparities)
{
    const auto clampFirst = [&](int first, int candidates) {
        return (short)std::max(0, std::min(first, numDisparities - candidates));
    };
    const auto firstAround = [&](int disparity, int candidates) {
        return clampFirst((disparity + scale / 2) / scale - (candidates / 2 - 1), candidates);
    };
    const auto contiguous = [&](short first, int predicted0, int predicted1) {
        const Window window = { { first, (short)(first + Window::runLength) },
                                { (ushort)predicted0, (ushort)predicted1 } };
        return window;
    };

    const int other = largest - own >= own - smallest ? largest : smallest;
    if (std::abs(other - own) < discontinuity * scale)
        return contiguous(firstAround(own, Window::candidates), own, own);

    const short first = firstAround(own, Window::runLength), beyond = firstAround(other, Window::runLength);
    if (std::abs(first - beyond) < Window::runLength) // runs do not overlap
        return contiguous(clampFirst((first + beyond + Window::runLength - Window::candidates) / 2, Window::candidates),
                          std::min(own, other), std::max(own, other));
    const Window window = { { first, beyond }, { (ushort)own, (ushort)other } };
    return window;
}

} // namespace

void predictWindows(const Mat& upper, int scale, int numDisparities, Mat& smallest, Mat& largest, Mat& windows)
{
    const int stripes = std::max(1, std::min(16, upper.rows / 16));
    smallest.create(upper.size(), CV_16U);
    largest.create(upper.size(), CV_16U);
    windows.create(upper.size(), CV_16UC4);
    const Mat kernel = Mat::ones(2 * neighborhood + 1, 2 * neighborhood + 1, CV_8U);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
        {
            const Range rows(upper.rows * i / stripes, upper.rows * (i + 1) / stripes);
            Mat minima = smallest.rowRange(rows), maxima = largest.rowRange(rows);
            erode(upper.rowRange(rows), minima, kernel); // a stripe sees its neighbours' rows
            dilate(upper.rowRange(rows), maxima, kernel);
            for (int y = rows.start; y < rows.end; ++y)
            {
                const ushort* own = upper.ptr<ushort>(y);
                const ushort* least = smallest.ptr<ushort>(y);
                const ushort* most = largest.ptr<ushort>(y);
                Window* window = windows.ptr<Window>(y);
                for (int x = 0; x < upper.cols; ++x)
                    window[x] = predictWindow(2 * own[x], 2 * least[x], 2 * most[x], scale, numDisparities);
            }
        }
    });
}

void halveDisparity(const Mat& disparity, Mat& upper)
{
    upper.create(disparity.rows / 2, disparity.cols / 2, CV_16U);
    parallel_for_(Range(0, upper.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* above = disparity.ptr<ushort>(2 * y);
            const ushort* below = disparity.ptr<ushort>(2 * y + 1);
            ushort* middle = upper.ptr<ushort>(y);
            for (int x = 0; x < upper.cols; ++x)
            {
                const int a = above[2 * x], b = above[2 * x + 1], c = below[2 * x], d = below[2 * x + 1];
                const int least = std::min(std::min(a, b), std::min(c, d));
                const int most = std::max(std::max(a, b), std::max(c, d));
                middle[x] = (ushort)((a + b + c + d - least - most) / 4);
            }
        }
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
