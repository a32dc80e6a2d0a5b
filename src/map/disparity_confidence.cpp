// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_confidence.hpp"

#include "../base/units.hpp"
#include "../base/window_sums.hpp"
#include "left_right_check.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxStep, 24, "1 / subpixelScale pixel",
            "between neighbours of one surface: less takes slopes for steps, more leaves steps out");
HDP_TUNABLE(int, farFromSteps, 64, "pixels", "from the nearest step: wrong patches are smaller");
HDP_TUNABLE(int, patchWindow, 21, "pixels of costs, cells of P",
            "side of the squares of means: a smaller one misses the middle of wrong patches, a larger one sees beyond");
HDP_TUNABLE(int, alternative, 2, "pixels",
            "from the winner to its alternatives: nearer ones cost the same by slopes, others may be other matches");
HDP_TUNABLE(float, hiddenShare, 0.5f, "share",
            "of the confidence that a pixel keeps which fails the left-right check: some of them are right");
HDP_TUNABLE(int, medianWindow, 7, "cells",
            "side of the squares that M is a mean of; smaller than those of costs: the median changes single pixels");
HDP_TUNABLE(int, maxDifference, 8, "pixels",
            "that one from the layer above or from before the median counts as: few pixels do not decide for a window");
HDP_TUNABLE(float, halvingDifference, 0.25f, "pixels", "a mean difference by which the confidence is halved");

// Pixels
const int stripeColumns = 64; // of a task: narrower ones would write to the same lines of the cache
const int distanceBlock = 32; // of a row, whose distances are found at once

//! Distances to the nearest pixel at a step in the same column, at most farFromSteps, CV_8UC1
Mat distancesInColumns(const Mat& disparity)
{
    Mat bordered, distances(disparity.size(), CV_8U);
    copyMakeBorder(disparity, bordered, 1, 1, 1, 1, BORDER_REPLICATE);
    const ushort ofSurface = (ushort)maxStep;
    const uchar far = (uchar)farFromSteps;
    parallel_for_(Range(0, (disparity.cols + stripeColumns - 1) / stripeColumns), [&](const Range& stripes) {
        const int begin = stripes.start * stripeColumns, end = std::min(stripes.end * stripeColumns, disparity.cols);
        const std::vector<uchar> farRow(disparity.cols, far);
        for (int y = 0; y < disparity.rows; ++y)
        {
            const ushort *const upper = bordered.ptr<ushort>(y), *const own = bordered.ptr<ushort>(y + 1),
                                *const lower = bordered.ptr<ushort>(y + 2);
            const uchar* const above = y > 0 ? distances.ptr(y - 1) : farRow.data();
            uchar* const row = distances.ptr(y);
            HDP_VECTORIZED for (int x = begin; x < end; ++x)
            {
                const ushort d = own[x + 1], inRow = std::max(difference(d, own[x]), difference(d, own[x + 2])),
                             inColumn = std::max(difference(d, upper[x + 1]), difference(d, lower[x + 1]));
                const ushort farther = std::min((ushort)(above[x] + 1), (ushort)far);
                row[x] = (uchar)(std::max(inRow, inColumn) > ofSurface ? 0 : farther);
            }
        }
        for (int y = disparity.rows - 2; y >= 0; --y)
        {
            const uchar* const below = distances.ptr(y + 1);
            uchar* const row = distances.ptr(y);
            HDP_VECTORIZED for (int x = begin; x < end; ++x) row[x] = std::min(row[x], (uchar)(below[x] + 1));
        }
    });
    return distances;
}

//! Squared distances of a row to the nearest pixel at a step, at most those of farFromSteps, from those in columns.
//! padded: memory of farFromSteps elements before the row and distanceBlock + farFromSteps behind it; squares: of
//! distanceBlock behind it.
void squareDistances(const uchar* inColumns, int width, short* padded, short* squares)
{
    const int far = farFromSteps;
    std::fill_n(padded - far, far, (short)(far * far));
    std::fill_n(padded + width, far + distanceBlock, (short)(far * far));
    HDP_VECTORIZED for (int x = 0; x < width; ++x) padded[x] = (short)(inColumns[x] * inColumns[x]);
    for (int start = 0; start < width; start += distanceBlock)
    {
        const short* const own = padded + start;
        short* const nearest = squares + start;
        std::copy_n(own, +distanceBlock, nearest);
        for (int dx = 1; dx < far; ++dx)
        {
            short max = 0;
            for (int k = 0; k < distanceBlock; ++k)
                max = std::max(max, nearest[k]);
            const short square = (short)(dx * dx);
            if (square >= max) // columns as far as these are not nearer
                break;
            HDP_VECTORIZED for (int k = 0; k < distanceBlock; ++k) nearest[k] =
                std::min(nearest[k], (short)(std::min(own[k - dx], own[k + dx]) + square));
        }
    }
}

//! Sums of the differences between two maps over windows of cells of 2 x 2 pixels, CV_32SC1, one per cell. isUpper:
//! whether the other one is that of the layer above; side: of the windows, in cells
Mat sumDifferences(const Mat& map, const Mat& other, bool isUpper, int side)
{
    Mat cells((map.rows + 1) / 2, (map.cols + 1) / 2, CV_16U);
    const int width = map.cols, lastUpper = other.cols - 1;
    const ushort limit = (ushort)(maxDifference * subpixelScale);
    parallel_for_(Range(0, cells.rows), [&](const Range& rows) {
        std::vector<ushort> doubled(2 * cells.cols), sums(2 * cells.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            for (int x = 0; x < cells.cols && isUpper; ++x)
                doubled[2 * x] = doubled[2 * x + 1] =
                    (ushort)(2 * other.ptr<ushort>(std::min(y, other.rows - 1))[std::min(x, lastUpper)]);
            std::fill(sums.begin(), sums.end(), (ushort)0);
            for (int row = 2 * y; row < 2 * y + 2; ++row)
            {
                const int inside = std::min(row, map.rows - 1);
                const ushort* const own = map.ptr<ushort>(inside);
                const ushort* const there = isUpper ? doubled.data() : other.ptr<ushort>(inside);
                HDP_VECTORIZED for (int x = 0; x < width; ++x) sums[x] =
                    (ushort)(sums[x] + std::min(difference(own[x], there[x]), limit));
            }
            sums.back() = sums[width - 1]; // of an odd width, once more
            for (int x = 0; x < cells.cols; ++x)
                cells.ptr<ushort>(y)[x] = (ushort)(sums[2 * x] + sums[2 * x + 1]);
        }
    });
    Mat sums;
    sumOverWindows(cells, side, CV_32S, sums);
    return sums;
}

/** Sums of costs over windows, CV_32SC1. own: of the disparities. others: of both their alternatives, the candidates
some pixels before and after; if one of them is none, of the other one twice; of the disparity itself, if both are. */
void compareAlternatives(const Mat& disparity, int numDisparities, const MatchingCost& cost, Mat& own, Mat& others)
{
    Mat before(disparity.size(), CV_16U), after(disparity.size(), CV_16U), costs[2];
    const ushort step = (ushort)(alternative * subpixelScale), last = (ushort)((numDisparities - 1) * subpixelScale);
    parallelForRows(disparity.size(), [&](int y) {
        const ushort* const row = disparity.ptr<ushort>(y);
        ushort *const low = before.ptr<ushort>(y), *const high = after.ptr<ushort>(y);
        HDP_VECTORIZED for (int x = 0; x < disparity.cols; ++x)
        {
            const int winner = wholeDisparity(row[x]) * subpixelScale;
            const int larger = winner + step <= last ? winner + step : winner;
            const int smaller = winner >= step ? winner - step : larger;
            low[x] = (ushort)smaller;
            high[x] = (ushort)(larger > winner ? larger : smaller);
        }
    });
    cost.ofDisparities(disparity, costs[0]);
    sumOverWindows(costs[0], patchWindow, CV_32S, own);
    cost.ofDisparities(before, costs[0]);
    cost.ofDisparities(after, costs[1]);
    sumOverWindows(costs[0] + costs[1], patchWindow, CV_32S, others);
}

} // namespace

void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const MatchingCost& cost, Mat& confidence)
{
    const Mat& disparity = maps.disparity;
    const CostLimits& limits = cost.limits();
    const Mat inColumns = distancesInColumns(disparity);
    Mat own, others, visible; // which the left-right check does not hide, and whose matches have data
    findStable(limits.dropMissing(disparity), visible);
    for (int y = 0; y < visible.rows && !limits.isEmpty(); ++y)
        limits.hideUnmatched(y, disparity.ptr<ushort>(y), visible.ptr(y));
    compareAlternatives(disparity, numDisparities, cost, own, others);
    const Mat byMedian = sumDifferences(disparity, maps.unfiltered, false, medianWindow);
    const Mat fromUpper = maps.upper.empty() ? Mat(Mat::zeros(byMedian.size(), CV_32S))
                                             : sumDifferences(disparity, maps.upper, true, patchWindow);
    // Sums of differences by which the confidence is halved
    const float halving = halvingDifference * 4 * subpixelScale, upper = halving * (float)(patchWindow * patchWindow),
                median = halving * (float)(medianWindow * medianWindow);
    const int far = farFromSteps, width = disparity.cols;
    const float hidden = hiddenShare;
    confidence.create(disparity.size(), CV_8U);
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        std::vector<short> padded(width + 2 * far + distanceBlock), squares(width + distanceBlock);
        std::vector<float> agreement(2 * byMedian.cols);
        for (int y = rows.start; y < rows.end; ++y)
        {
            const int *const p = fromUpper.ptr<int>(y / 2), *const m = byMedian.ptr<int>(y / 2);
            for (int x = 0; x < byMedian.cols; ++x)
                agreement[2 * x] = agreement[2 * x + 1] =
                    upper * median / ((upper + (float)p[x]) * (median + (float)m[x]));
            const int *const c = own.ptr<int>(y), *const a = others.ptr<int>(y);
            squareDistances(inColumns.ptr(y), width, &padded[far], squares.data());
            const short* const distances =
                squares.data(); // squared; local, as are the next ones, as stores may alias all
            const float* const agrees = agreement.data();
            const uchar* const isVisible = visible.ptr(y);
            uchar* const row = confidence.ptr(y);
            HDP_VECTORIZED for (int x = 0; x < width; ++x)
            {
                const int more = a[x] - 2 * c[x], all = a[x] + 2 * c[x];
                const float fromStep = std::sqrt((float)distances[x]) / (float)far,
                            unique = (more > 0 ? (float)more : 0.f) / (all > 0 ? (float)all : 1.f);
                const float factor = std::sqrt(std::sqrt(fromStep * unique) * agrees[x]);
                row[x] = (uchar)(int)(255 * (isVisible[x] ? 1.f : hidden) * factor + 0.5f);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
