// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_confidence.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#include "../base/window_sums.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

// Pixels; side of the square whose levels are compared: a smaller one has noise, a larger one edges; from 13 on sums
// of 32 bits do not hold them
const int window = 9;

const int unit = subpixelScale;

// Pixels. Rows of matched corners are off as disparities are. Sigma rises with the root of this error: that has most
// sets between 50 and 80 %. Beyond the limits there were few pairs to tell it.
const double minRowError = 0.03, usualRowError = 0.12, maxRowError = 0.25;

// Grey levels. Sigma rises with the root of the noise between these, beyond which the same holds.
const double minNoise = 1, maxNoise = 2;

// Errors in pixels by which 50 to 80 % are not larger, at the usual row error and little noise, of FAST, QUALITY and
// TREE on pairs of Middlebury, ETH3D, SceneFlow and KITTI, each set as much as the others; made to fall with the
// confidence and to rise with the mismatch, and smooth.
const int confidences = 9, mismatches = 7;
const float confidenceOf[confidences] = { 2, 10, 20, 30, 44, 64, 88, 116, 150 };
const float mismatchOf[mismatches] = { 0.15f, 0.3f, 0.45f, 0.65f, 0.9f, 1.4f, 2.5f };
const float unknownMismatch = 0.65f; // that of most pixels
const float sigmas[confidences][mismatches] = {
    { 0.97f, 1.14f, 1.23f, 1.23f, 1.32f, 2.38f, 3.34f }, // confidence 2
    { 0.55f, 0.72f, 0.97f, 0.97f, 1.06f, 1.41f, 1.58f }, // confidence 10
    { 0.38f, 0.43f, 0.54f, 0.59f, 0.67f, 0.77f, 0.78f }, // confidence 20
    { 0.33f, 0.34f, 0.40f, 0.46f, 0.51f, 0.56f, 0.57f }, // confidence 30
    { 0.29f, 0.30f, 0.33f, 0.39f, 0.42f, 0.45f, 0.46f }, // confidence 44
    { 0.25f, 0.28f, 0.29f, 0.33f, 0.35f, 0.38f, 0.39f }, // confidence 64
    { 0.22f, 0.25f, 0.26f, 0.27f, 0.29f, 0.31f, 0.32f }, // confidence 88
    { 0.20f, 0.22f, 0.25f, 0.26f, 0.27f, 0.28f, 0.29f }, // confidence 116
    { 0.19f, 0.20f, 0.21f, 0.24f, 0.26f, 0.28f, 0.28f }, // confidence 150
};

//! Where a value is between ascending ones: the first of two, and the share of the second
struct Place
{
    int first;
    float share;
};

Place placeOf(float value, const float* ascending, int count)
{
    const int first = (int)(std::upper_bound(ascending + 1, ascending + count - 1, value) - ascending) - 1;
    const float share = (value - ascending[first]) / (ascending[first + 1] - ascending[first]);
    return { first, std::min(std::max(share, 0.f), 1.f) };
}

} // namespace

void levelMismatch(const Mat& disparity, const CensusCost& cost, Mat& mismatch)
{
    const Size size = disparity.size();
    Mat differences(size, CV_32S), squares(size, CV_32S), gradients(size, CV_32S);
    const int width = size.width;
    parallelForRows(size, [&](int y) {
        const uchar* const left = cost.leftPixels(y) + CensusCost::greyByte;
        const uchar* const right = cost.rightPlane(cost.planes(), y) + width - 1;
        const ushort* const row = disparity.ptr<ushort>(y);
        int* const difference = differences.ptr<int>(y); // times unit
        for (int x = 0; x < width; ++x)
        {
            const int whole = row[x] / unit, fraction = row[x] % unit;
            const uchar* const matched = right - x + whole;
            difference[x] = unit * left[4 * x] - (unit - fraction) * matched[0] - fraction * matched[1];
            squares.ptr<int>(y)[x] = difference[x] * difference[x];
            const int beside = left[4 * std::min(x + 1, width - 1)] - left[4 * std::max(x - 1, 0)];
            gradients.ptr<int>(y)[x] = beside * beside;
        }
    });
    for (Mat* values : { &differences, &squares, &gradients })
        sumOverWindows(values->clone(), window, CV_32S, *values);
    mismatch.create(size, CV_32F);
    parallelForRows(size, [&](int y) {
        const int count = window * window;
        for (int x = 0; x < size.width; ++x)
        {
            const int64 sum = differences.at<int>(y, x), squared = squares.at<int>(y, x);
            const double deviation = std::sqrt((double)(count * squared - sum * sum)) / (unit * count);
            const double gradient = 0.5 * std::sqrt((double)gradients.at<int>(y, x) / count);
            mismatch.at<float>(y, x) = (float)(deviation / (gradient + 0.5));
        }
    });
}

void disparitySigma(const Mat& confidence, const Mat& mismatch, double rowError, double noise, float rounding,
                    Mat& sigma)
{
    const double error = rowError > 0 ? clamped(rowError, +minRowError, +maxRowError) : usualRowError;
    // Roots alone, which are the same on all machines
    const float ofPair = (float)(std::sqrt(error / usualRowError) * std::sqrt(clamped(noise, +minNoise, +maxNoise)));
    Place places[256];
    for (int i = 0; i < 256; ++i)
        places[i] = placeOf((float)i, confidenceOf, confidences);
    sigma.create(confidence.size(), CV_32F);
    parallelForRows(sigma.size(), [&](int y) {
        for (int x = 0; x < sigma.cols; ++x)
        {
            const Place& row = places[confidence.at<uchar>(y, x)];
            const Place column =
                placeOf(mismatch.empty() ? unknownMismatch : mismatch.at<float>(y, x), mismatchOf, mismatches);
            const float* const upper = sigmas[row.first] + column.first;
            const float* const lower = sigmas[row.first + 1] + column.first;
            const float above = upper[0] + column.share * (upper[1] - upper[0]),
                        below = lower[0] + column.share * (lower[1] - lower[0]);
            const float value = ofPair * (above + row.share * (below - above));
            sigma.at<float>(y, x) = rounding > 0 ? std::sqrt(value * value + rounding * rounding) : value;
        }
    });
}

}}} // namespace cv::stereo::hdp
