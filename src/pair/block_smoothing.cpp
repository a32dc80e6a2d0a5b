// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "block_smoothing.hpp"

#include "image_levels.hpp"
#include "../base/tunable.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const int side = BlockGrid::side;

HDP_TUNABLE(int, rowsThatTell, 32, "rows", "that are looked at: more cost time and find the same blocks");
HDP_TUNABLE(double, flatChange, 0.5, "grey levels", "maximum from pixel to pixel beside a step: more is texture");
HDP_TUNABLE(int, maxStep, 20, "grey levels", "larger ones are edges of the scene, however strong the compression is");
HDP_TUNABLE(double, minRatio, 5, "mean of the steps inside blocks",
            "of the mean step between them: less finds blocks by chance, more overlooks weak ones");
HDP_TUNABLE(int, minSteps, 64, "steps", "between blocks, for a mean: fewer find blocks by chance");
HDP_TUNABLE(int, smoothedSteps, 4, "mean steps between blocks",
            "that are taken away: larger ones are edges of the scene");

//! Adds what a row's pixels tell of the steps before them, by columns.
void addSteps(const ushort* row, int width, ushort* steps, ushort* counts)
{
    const ushort maxChange = (ushort)(flatChange * greyScale), max = (ushort)(maxStep * greyScale);
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
        row[x - 1 - i] = (ushort)std::min(std::max(row[x - 1 - i] + part, 0), whiteLevel);
        row[x + i] = (ushort)std::min(std::max(row[x + i] - part, 0), whiteLevel);
    }
}

void smoothSteps(const BlockGrid& grid, Mat& grey)
{
    const double limit = 2 * smoothedSteps * grid.step; // of twice a step
    parallel_for_(Range(0, grey.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = grid.begin < side / 2 ? grid.begin + side : grid.begin; x + side / 2 <= grey.cols; x += side)
                smoothStep(grey.ptr<ushort>(y), x, limit);
    });
}

} // namespace

BlockGrid findBlocks(const Mat& grey)
{
    const int rows = std::min<int>(grey.rows, rowsThatTell);
    std::vector<ushort> steps(grey.cols), counts(grey.cols);
    for (int i = 0; i < rows; ++i)
        addSteps(grey.ptr<ushort>((2 * i + 1) * grey.rows / (2 * rows)), grey.cols, steps.data(), counts.data());

    int sums[side] = {}, numbers[side] = {}, sum = 0, number = 0;
    for (int x = 0; x < grey.cols; ++x)
    {
        sums[x % side] += steps[x];
        numbers[x % side] += counts[x];
        sum += steps[x];
        number += counts[x];
    }
    BlockGrid grid;
    for (int i = 0; i < side; ++i)
    {
        const double step = sums[i] / (double)std::max(numbers[i], 1),
                     others = (sum - sums[i]) / (double)std::max(number - numbers[i], 1);
        if (numbers[i] >= minSteps && step >= minRatio * others)
        {
            grid.begin = i;
            grid.step = step;
        }
    }
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
