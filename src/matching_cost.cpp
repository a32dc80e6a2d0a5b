// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_units.hpp"
#include "image_pyramid.hpp"
#include "matching_cost.hpp"
#include "matching_cost.simd.hpp"
#include "matching_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// Columns behind the last candidate that evaluate() may read
const int padding = 32;

// Bytes before and behind a row of the census that may be read; they mean nothing.
const int censusMargin = 16;

// Columns of a census row are computed in groups of this many.
const int censusColumns = 32;

// Units of a gradient in one intensity level a pixel: the largest, borderGain * 255, still fits into 16 bit
const int gradientScale = 32;

// How much more than inside the image the one-sided difference counts at the border. It keeps smooth surfaces from
// matching the clamped column; the factor is fitted to the disparity maps of the authors' program.
const int borderGain = 4;

//! Grey levels, 0.299 R + 0.587 G + 0.114 B, in 1 / 65536. Rounded to whole levels they cost accuracy: the gradients of
//! smooth surfaces are below one level.
void gradientLevels(const uchar* pixels, int count, int channels, int* grey)
{
    if (channels == 1)
        for (int x = 0; x < count; ++x)
            grey[x] = pixels[x] * 65536;
    else
        for (int x = 0; x < count; ++x, pixels += 3)
            grey[x] = 7471 * pixels[0] + 38470 * pixels[1] + 19595 * pixels[2];
}

//! Half the central difference of the grey levels along each row, in 1 / gradientScale levels; at the ends borderGain
//! times the one-sided difference.
void horizontalGradient(const Mat& image, Mat& gradient)
{
    const int width = image.cols, last = width - 1;
    gradient.create(image.size(), CV_16S);
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        std::vector<int> grey(width + 1);
        for (int y = rows.start; y < rows.end; ++y)
        {
            const int* g = grey.data();
            short* d = gradient.ptr<short>(y);
            gradientLevels(image.ptr(y), width, image.channels(), grey.data());
            for (int x = 1; x < last; ++x)
                d[x] = (short)((g[x + 1] - g[x - 1] + 2048) >> 12);
            const int after = std::min(1, last), before = std::max(last - 1, 0); // of an only column: itself
            d[0] = (short)(((g[after] - g[0]) * borderGain + 1024) >> 11);
            d[last] = (short)(((g[last] - g[before]) * borderGain + 1024) >> 11);
        }
    });
}

template <typename T> void copyColumns(const T* from, int step, int width, T* to)
{
    if (step == 1)
        std::copy(from, from + width, to);
    else if (step == -1)
    {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) to[x] = from[-x];
    }
    else
        for (int x = 0; x < width; ++x, from += step)
            to[x] = *from;
}

//! Copies a channel into rows of bordered with `before` and `after` more columns and `radius` more rows around it,
//! all from the nearest pixel; mirrored on request.
template <typename T>
void copyBordered(const Mat& image, int channel, int radius, int before, int after, bool mirrored, Mat bordered)
{
    const int step = image.channels(), width = image.cols;
    parallel_for_(Range(0, bordered.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const T* from = image.ptr<T>(std::min(std::max(y - radius, 0), image.rows - 1)) + channel;
            T* to = bordered.ptr<T>(y);
            copyColumns(mirrored ? from + (width - 1) * step : from, mirrored ? -step : step, width, to + before);
            std::fill(to, to + before, to[before]);
            std::fill(to + before + width, to + before + width + after, to[before + width - 1]);
        }
    });
}

void dispatchLeftCensus(const short* grey, ptrdiff_t step, int radius, int cols, uchar* planes, uchar* pixels)
{
    CV_CPU_DISPATCH(leftCensusRow, (grey, step, radius, cols, planes, pixels), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchRightCensus(const short* grey, ptrdiff_t step, int radius, int cols, uchar* row, size_t planeSize)
{
    CV_CPU_DISPATCH(rightCensusRow, (grey, step, radius, cols, row, planeSize), CV_CPU_DISPATCH_MODES_ALL);
}

} // namespace

void MatchingCost::prepare(const Mat& left, const Mat& right, int numDisparities, const MatchingCostParams& params)
{
    blockSize_ = params.blockSize;
    channels_ = left.channels();
    planes_.census = params.census;
    planes_.width = left.cols;
    planes_.blockSize = params.census ? 1 : blockSize_;
    planes_.count = params.census ? (blockSize_ * blockSize_ / 2 + 7) / 8 : channels_;
    // The means over the channels and the window and the gradient's units are left to the weights.
    const float area = (float)(blockSize_ * blockSize_);
    planes_.colorTruncation = params.colorTruncation * channels_;
    planes_.gradientTruncation = params.gradientTruncation * gradientScale;
    planes_.colorWeight = params.colorWeight / (channels_ * area);
    planes_.gradientWeight = (1 - params.colorWeight) / (gradientScale * area);

    if (params.census)
    {
        prepareCensus(left, false, 0);
        prepareCensus(right, true, numDisparities + padding);
    }
    else
    {
        prepareColorAndGradient(left, false, 0);
        prepareColorAndGradient(right, true, numDisparities + padding);
        planes_.leftGradient = leftGradient_.ptr<short>();
        planes_.rightGradient = rightGradient_.ptr<short>();
    }
    planes_.left = left_.ptr() + (params.census ? 4 * censusMargin : 0);
    planes_.right = right_.ptr() + (params.census ? censusMargin : 0);
    planes_.leftStep = left_.step;
    planes_.rightStep = right_.step;
    const size_t rows = left.rows + (params.census ? 0 : 2 * (blockSize_ / 2));
    planes_.leftPlane = params.census ? 1 : left_.step * rows;
    planes_.rightPlane = right_.step * rows;
}

void MatchingCost::prepareColorAndGradient(const Mat& image, bool mirrored, int after)
{
    const int radius = blockSize_ / 2, rows = image.rows + 2 * radius;
    Mat& color = mirrored ? right_ : left_;
    Mat& gradient = mirrored ? rightGradient_ : leftGradient_;
    horizontalGradient(image, gradient_);
    color.create(channels_ * rows, image.cols + 2 * radius + after, CV_8U);
    gradient.create(rows, color.cols, CV_16S);
    for (int c = 0; c < channels_; ++c)
        copyBordered<uchar>(image, c, radius, radius, radius + after, mirrored,
                            color.rowRange(c * rows, (c + 1) * rows));
    copyBordered<short>(gradient_, 0, radius, radius, radius + after, mirrored, gradient);
}

void MatchingCost::prepareCensus(const Mat& image, bool isRight, int after)
{
    const int radius = blockSize_ / 2, width = image.cols, planes = planes_.count, rows = image.rows;
    const int cols = (int)alignSize(width, censusColumns); // what is computed past the width is overwritten or not read
    grey_.create(rows + 2 * radius, cols + 2 * radius, CV_16S); // all levels are below 32768
    copyBordered<short>(image, 0, radius, radius, radius + cols - width, isRight, grey_);
    if (isRight)
        right_.create((planes + 1) * rows, censusMargin + std::max(width + after, cols) + censusMargin, CV_8U);
    else
        left_.create(rows, censusMargin + cols + censusMargin, CV_8UC4);
    const ptrdiff_t step = (ptrdiff_t)grey_.step1();
    parallel_for_(Range(0, rows), [&](const Range& range) {
        std::vector<uchar> leftPlanes(isRight ? 0 : 3 * cols);
        for (int y = range.start; y < range.end; ++y)
        {
            const short* grey = grey_.ptr<short>(y + radius) + radius;
            if (!isRight)
            {
                dispatchLeftCensus(grey, step, radius, cols, leftPlanes.data(), left_.ptr(y) + 4 * censusMargin);
                continue;
            }
            dispatchRightCensus(grey, step, radius, cols, right_.ptr(y) + censusMargin, right_.step * rows);
            for (int plane = 0; plane <= planes; ++plane)
            {
                uchar* row = right_.ptr(plane * rows + y) + censusMargin;
                std::fill(row + width, right_.ptr(plane * rows + y) + right_.cols, row[width - 1]);
            }
        }
    });
}

void MatchingCost::evaluate(const int* pixels, int count, int first, int lanes, float* cost) const
{
    CV_CPU_DISPATCH(evaluateCost, (planes_, pixels, count, first, lanes, cost), CV_CPU_DISPATCH_MODES_ALL);
}

void MatchingCost::censusCosts(const Mat& disparity, Mat& costs) const
{
    costs.create(disparity.size(), CV_8U);
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* candidate = disparity.ptr<ushort>(y);
            uchar* cost = costs.ptr(y);
            const uchar *left[3], *right[3];
            for (int plane = 0; plane < 3; ++plane)
            {
                left[plane] = leftPixels(y) + plane;
                right[plane] = rightPlane(std::min(plane, planes() - 1), y) + planes_.width - 1;
            }
            const unsigned mask = 0xffffff >> (8 * (3 - planes()));
            for (int x = 0; x < disparity.cols; ++x)
            {
                const int at = wholeDisparity(candidate[x]) - x;
                unsigned bits = (unsigned)(left[0][4 * x] ^ right[0][at]) |
                                (unsigned)(left[1][4 * x] ^ right[1][at]) << 8 |
                                (unsigned)(left[2][4 * x] ^ right[2][at]) << 16;
                bits &= mask;
                bits -= (bits >> 1) & 0x555555;
                bits = (bits & 0x333333) + ((bits >> 2) & 0x333333);
                bits = (bits + (bits >> 4)) & 0x0f0f0f;
                cost[x] = (uchar)(bits + (bits >> 8) + (bits >> 16));
            }
        }
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
