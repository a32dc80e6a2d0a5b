// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_confidence.hpp"

#include "disparity_refinement.hpp"
#include "disparity_units.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// Rows of the confidence that are computed at a time; half a window more on both sides goes into them.
const int stripeRows = 128;

//! Distances to the nearest pixel at a step, CV_32FC1.
void distanceToSteps(const Mat& disparity, Mat& distance)
{
    Mat smooth(disparity.size(), CV_8U, Scalar(255));
    const auto isStep = [&](int a, int b) { return 2 * std::abs(a - b) > 3 * subpixelScale; };
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* row = disparity.ptr<ushort>(y);
            const ushort* above = disparity.ptr<ushort>(std::max(y - 1, 0));
            const ushort* below = disparity.ptr<ushort>(std::min(y + 1, disparity.rows - 1));
            uchar* to = smooth.ptr(y);
            for (int x = 0; x < disparity.cols; ++x)
                if (isStep(row[x], above[x]) || isStep(row[x], below[x]))
                    to[x] = 0;
            for (int x = 1; x < disparity.cols; ++x)
                if (isStep(row[x], row[x - 1]))
                    to[x - 1] = to[x] = 0;
        }
    });
    distanceTransform(smooth, distance, DIST_L2, DIST_MASK_PRECISE);
}

//! The costs of a row's disparities and the means of those of their alternatives.
void evaluateRow(const MatchingCost& cost, const ushort* disparity, int numDisparities, int firstPixel, int width,
                 std::vector<int>& pixels, std::vector<float>& costs, float* own, float* others)
{
    const int lanes = 8, alternative = DisparityConfidence::alternative;
    for (int x = 0; x < width; ++x)
        pixels[x] = firstPixel + x;
    const auto candidate = [&](int x) { return wholeDisparity(disparity[x]); };
    for (int start = 0, end; start < width; start = end) // pixels of one disparity
    {
        const int winner = candidate(start);
        for (end = start + 1; end < width && candidate(end) == winner;)
            ++end;
        const int first = std::max(winner - alternative, 0), lane = winner - first;
        cost.evaluate(&pixels[start], end - start, first, lanes, costs.data());
        const bool hasBefore = lane == alternative, hasAfter = winner + alternative < numDisparities;
        for (int x = start; x < end; ++x)
        {
            const float* at = &costs[(x - start) * lanes + lane];
            own[x] = at[0];
            others[x] = !hasBefore && !hasAfter ? at[0]
                        : !hasBefore            ? at[alternative]
                        : !hasAfter             ? at[-alternative]
                                                : (at[-alternative] + at[alternative]) / 2;
        }
    }
}

//! U of some rows, CV_32FC1. The memory is kept from stripe to stripe.
struct StripeUniqueness
{
    std::vector<int> pixels;
    std::vector<float> costs;
    Mat own, others;

    void compute(const MatchingCost& cost, const Mat& disparity, int numDisparities, const Range& rows, Mat& uniqueness)
    {
        const int width = disparity.cols, window = DisparityConfidence::window, radius = window / 2;
        pixels.resize(width);
        costs.resize((size_t)width * 8);
        own.create(rows.size() + 2 * radius, width, CV_32F);
        others.create(own.size(), CV_32F);
        for (int i = 0; i < own.rows; ++i)
        {
            const int y = std::min(std::max(rows.start - radius + i, 0), disparity.rows - 1);
            evaluateRow(cost, disparity.ptr<ushort>(y), numDisparities, y * width, width, pixels, costs,
                        own.ptr<float>(i), others.ptr<float>(i));
        }
        boxFilter(own, own, CV_32F, Size(window, window), Point(-1, -1), true, BORDER_REPLICATE);
        boxFilter(others, others, CV_32F, Size(window, window), Point(-1, -1), true, BORDER_REPLICATE);
        uniqueness.create(rows.size(), width, CV_32F);
        for (int i = 0; i < rows.size(); ++i)
        {
            const float* c = own.ptr<float>(i + radius);
            const float* a = others.ptr<float>(i + radius);
            float* u = uniqueness.ptr<float>(i);
            for (int x = 0; x < width; ++x)
                u[x] = a[x] > c[x] ? (a[x] - c[x]) / (a[x] + c[x]) : 0.f;
        }
    }
};

} // namespace

void disparityConfidence(const Mat& disparity, int numDisparities, const MatchingCost& cost, Mat& confidence)
{
    Mat distance, stable;
    distanceToSteps(disparity, distance);
    findStable(disparity, DisparityConfidence::visibleMaxDiff, stable);
    confidence.create(disparity.size(), CV_8U);
    const int stripes = (disparity.rows + stripeRows - 1) / stripeRows;
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        StripeUniqueness stripe;
        Mat uniqueness;
        for (int i = range.start; i < range.end; ++i)
        {
            const Range rows(i * stripeRows, std::min((i + 1) * stripeRows, disparity.rows));
            stripe.compute(cost, disparity, numDisparities, rows, uniqueness);
            for (int y = rows.start; y < rows.end; ++y)
            {
                const float* u = uniqueness.ptr<float>(y - rows.start);
                const float* far = distance.ptr<float>(y);
                const uchar* visible = stable.ptr(y);
                uchar* to = confidence.ptr(y);
                for (int x = 0; x < disparity.cols; ++x)
                {
                    const float limit = DisparityConfidence::farFromSteps, s = std::min(far[x], limit) / limit;
                    const int divisor = visible[x] ? 1 : (int)DisparityConfidence::hiddenDivisor;
                    to[x] = saturate_cast<uchar>(255 * std::sqrt(s * u[x]) / (float)divisor);
                }
            }
        }
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
