// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "block_smoothing.hpp"

#include "image_levels.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const int side = BlockGrid::side;

HDP_TUNABLE(int, linesThatTell, 32, "rows or columns", "that are looked at: more cost time and find the same blocks");
HDP_TUNABLE(double, flatChange, 0.5, "levels of the camera",
            "maximum from pixel to pixel beside a step: more is texture");
HDP_TUNABLE(int, maxStep, 20, "levels of the camera",
            "larger ones are edges of the scene, however strong the compression is");
HDP_TUNABLE(double, minRatio, 4.5, "mean of the steps inside blocks",
            "of that between them, up to which there are none: smoothing weak ones costs more than it saves");
HDP_TUNABLE(double, sureRatio, 6, "mean of the steps inside blocks", "of that from which they are surely blocks");
HDP_TUNABLE(int, minSteps, 64, "steps", "between blocks, for a mean: fewer find blocks by chance");
HDP_TUNABLE(int, smoothedSteps, 4, "mean steps between blocks",
            "that are taken away: larger ones are edges of the scene");

//! Adds what the pixels of a row or column tell of the steps before them. unit: level of the camera
void addSteps(const ushort* row, int width, double unit, ushort* steps, ushort* counts)
{
    const ushort maxChange = saturate_cast<ushort>(flatChange * unit), max = saturate_cast<ushort>(maxStep * unit);
    HDP_VECTORIZED for (int x = 3; x < width - 2; ++x)
    {
        const ushort step = difference(row[x - 1], row[x]);
        const ushort before = std::max(difference(row[x - 3], row[x - 2]), difference(row[x - 2], row[x - 1])),
                     after = std::max(difference(row[x], row[x + 1]), difference(row[x + 1], row[x + 2]));
        const int isFlat = (before <= maxChange) & (after <= maxChange) & (step <= max);
        steps[x] = (ushort)(steps[x] + (isFlat ? step : 0));
        counts[x] = (ushort)(counts[x] + isFlat);
    }
}

//! Takes the step before a column away.
void smoothStep(ushort* row, int x, double limit)
{
    const int twice = 3 * (row[x] - row[x - 1]) - (row[x + 1] - row[x - 2]); // the step
    if (std::abs(twice) >= limit)
        return;
    for (int i = 0; i < side / 2; ++i)
    {
        const int part = (twice * (side - 1 - 2 * i) + 2 * side) >> 5;
        row[x - 1 - i] = (ushort)clamped(row[x - 1 - i] + part, 0, whiteLevel);
        row[x + i] = (ushort)clamped(row[x + i] - part, 0, whiteLevel);
    }
}

void smoothSteps(const BlockGrid& grid, Mat& grey)
{
    const double limit = 2 * smoothedSteps * grid.step; // of twice a step
    parallelForRows(grey.size(), [&](int y) {
        for (int x = grid.begin < side / 2 ? grid.begin + side : grid.begin; x + side / 2 <= grey.cols; x += side)
            smoothStep(grey.ptr<ushort>(y), x, limit);
    });
}

//! The one in eight of the steps between columns, or rows, that are larger than the others, and the ratio of their mean
//! to that of these. The lines that tell begin in all places of a block, where slanted contours have no common steps.
BlockGrid findSteps(const Mat& grey, double unit, bool isDown, double& ratio)
{
    const double leastStep = 1. / 64; // of the others, if they are as good as none
    const int all = isDown ? grey.cols : grey.rows, length = isDown ? grey.rows : grey.cols;
    const int count = std::min<int>(all, linesThatTell);
    std::vector<ushort> steps(length), counts(length);
    for (int i = 0; i < count; ++i)
    {
        const int line = std::min((2 * i + 1) * all / (2 * count) / side * side + i % side, all - 1);
        const Mat pixels = isDown ? Mat(grey.col(line).t()) : grey.row(line);
        addSteps(pixels.ptr<ushort>(), length, unit, steps.data(), counts.data());
    }

    int sums[side] = {}, numbers[side] = {}, sum = 0, number = 0;
    for (int x = 0; x < length; ++x)
    {
        sums[x % side] += steps[x];
        numbers[x % side] += counts[x];
        sum += steps[x];
        number += counts[x];
    }
    BlockGrid found;
    ratio = 0;
    for (int i = 0; i < side; ++i)
    {
        const double mean = sums[i] / (double)std::max(numbers[i], 1),
                     others = (sum - sums[i]) / (double)std::max(number - numbers[i], 1),
                     own = mean / std::max(others, leastStep);
        if (numbers[i] < minSteps || own <= ratio)
            continue;
        found.begin = i;
        found.step = mean;
        ratio = own;
    }
    return found;
}

} // namespace

BlockGrid findBlocks(const Mat& grey, double gain)
{
    double across, down;
    BlockGrid grid = findSteps(grey, greyScale * gain, false, across);
    findSteps(grey, greyScale * gain, true, down);
    grid.step *= clamped((std::min(across, down) - minRatio) / (sureRatio - minRatio), 0., 1.);
    return grid;
}

void smoothBlocks(Mat& left, Mat& right, const BlockGrid& ofLeft, const BlockGrid& ofRight)
{
    if (ofLeft.step == 0 || ofRight.step == 0)
        return;
    smoothSteps(ofLeft, left);
    smoothSteps(ofRight, right);
}

}}} // namespace cv::stereo::hdp
