// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "surface_smoothing.simd.hpp"
#include "map/surface_smoothing.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, leastNoise, 0.5, "grey levels", "less is below the rounding of the levels");
HDP_TUNABLE(int, mostWeight, 64, "noise^-2",
            "of a pixel beside another: more helps surfaces with little texture, less keeps details");

const int rounds = 2, firstDistances[rounds] = { 1, 3 }; // pixels

// Around the buffers: the largest distance
const int frame = firstDistances[rounds - 1] << (SmoothingPairs::count - 1);

// Rows of a thread whose precisions share the sums of windows
const int stripe = 64;

HDP_DISPATCH(squareSlopes)
HDP_DISPATCH(precisionRow)
HDP_DISPATCH(smoothRow)

//! The part of a buffer inside of its frame
Mat insideOf(Mat& buffer, Size size)
{
    const Size framed(size.width + 2 * frame, size.height + 2 * frame);
    if (buffer.size() != framed)
        buffer = Mat::zeros(framed, CV_16U);
    return buffer(Rect(Point(frame, frame), size));
}

void findPrecisions(const Mat& levels, double noise, const Mat& disparity, Mat& precisions)
{
    const int width = levels.cols, height = levels.rows, radius = precisionSide / 2;
    // The difference of the pixels beside one is twice the slope.
    const double change = 2. * greyScale * noise / SlopeScale::perNoise; // that is counted as one
    const SlopeScale scale = { saturate_cast<ushort>(cvFloor(SlopeScale::most * change)),
                               saturate_cast<ushort>(cvFloor(256 / change)) };
    parallel_for_(Range(0, (height + stripe - 1) / stripe), [&](const Range& range) {
        std::vector<ushort> squares(precisionSide * width), sums(width + precisionSide);
        for (int y = range.start * stripe - radius; y < std::min(range.end * stripe, height) + radius; ++y)
        {
            ushort* const row = &squares[(y + precisionSide) % precisionSide * width];
            dispatched::squareSlopes(levels.ptr<ushort>(clamped(y, 0, height - 1)), width, scale, row);
            const int middle = y - radius;
            if (middle >= range.start * stripe)
                dispatched::precisionRow(squares.data(), width, sums.data(), disparity.ptr<ushort>(middle),
                                         precisions.ptr<ushort>(middle));
        }
    });
}

//! In the rows, or in the columns
SmoothingPairs pairsAt(int distance, ptrdiff_t step, int mostDifference)
{
    SmoothingPairs pairs;
    pairs.step = step * distance;
    for (ushort& limit : pairs.limits)
    {
        limit = (ushort)std::max(cvRound((double)mostWeight / (distance * distance)), 1);
        distance *= 2;
    }
    pairs.like = (ushort)mostDifference;
    return pairs;
}

} // namespace

void smoothSurfaces(const Mat& levels, double noise, int mostDifference, const Mat& disparity,
                    SmoothingBuffers& buffers, Mat& smoothed)
{
    const Size size = disparity.size();
    Mat precisions = insideOf(buffers.precisions, size);
    Mat rough = insideOf(buffers.maps[0], size), smoother = insideOf(buffers.maps[1], size);
    findPrecisions(levels, std::max(noise, +leastNoise), disparity, precisions);
    disparity.copyTo(rough);
    smoothed.create(size, CV_16U);
    const auto pass = [&](const SmoothingPairs& pairs, const Mat& from, Mat& to) {
        parallelFor(size.height, [&](int y) {
            dispatched::smoothRow(from.ptr<ushort>(y), precisions.ptr<ushort>(y), size.width, pairs, to.ptr<ushort>(y));
        });
    };
    for (int round = 0; round < rounds; ++round)
    {
        pass(pairsAt(firstDistances[round], 1, mostDifference), rough, smoother);
        pass(pairsAt(firstDistances[round], rough.step1(), mostDifference), smoother,
             round == rounds - 1 ? smoothed : rough);
    }
}

}}} // namespace cv::stereo::hdp
