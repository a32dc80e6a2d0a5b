// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "matching_cost.hpp"

// A loop over lanes: GCC unrolls it before it could see that it is one for vectors.
#if defined(__GNUC__) && !defined(__clang__)
#define HDP_VECTORIZED _Pragma("GCC unroll 1")
#else
#define HDP_VECTORIZED
#endif

namespace cv {
namespace stereo {
namespace hdp {

namespace {

// Columns behind the last candidate that evaluate() may read
const int padding = 8;

// Units of a gradient in one intensity level a pixel: the largest, borderGain * 255, still fits into 16 bit
const int gradientScale = 32;

// How much more than inside the image the one-sided difference counts at the border. It keeps smooth surfaces from
// matching the clamped column; the factor is fitted to the disparity maps of the authors' program.
const int borderGain = 4;

//! Grey levels, 0.299 R + 0.587 G + 0.114 B, in 1 / 65536. Rounded to whole levels they cost accuracy: the gradients of
//! smooth surfaces are below one level.
void greyLevels(const uchar* pixels, int count, int channels, int* grey)
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
            greyLevels(image.ptr(y), width, image.channels(), grey.data());
            for (int x = 1; x < last; ++x)
                d[x] = (short)((g[x + 1] - g[x - 1] + 2048) >> 12);
            const int after = std::min(1, last), before = std::max(last - 1, 0); // of an only column: itself
            d[0] = (short)(((g[after] - g[0]) * borderGain + 1024) >> 11);
            d[last] = (short)(((g[last] - g[before]) * borderGain + 1024) >> 11);
        }
    });
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
            if (mirrored)
                for (int x = 0; x < width; ++x)
                    to[before + x] = from[(width - 1 - x) * step];
            else
                for (int x = 0; x < width; ++x)
                    to[before + x] = from[x * step];
            std::fill(to, to + before, to[before]);
            std::fill(to + before + width, to + before + width + after, to[before + width - 1]);
        }
    });
}

//! A bit for each pixel of the checkerboard around the centre, set if it is darker. grey is bordered by the radius.
void censusTransform(const Mat& grey, int radius, Mat& census)
{
    census.create(grey.rows - 2 * radius, grey.cols - 2 * radius, CV_32S);
    parallel_for_(Range(0, census.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const uchar* centre = grey.ptr(y + radius) + radius;
            unsigned* bits = census.ptr<unsigned>(y);
            const int cols = census.cols;
            std::fill(bits, bits + cols, 0u);
            unsigned bit = 1;
            for (int dy = -radius; dy <= radius; ++dy)
                for (int dx = -radius; dx <= radius; ++dx)
                {
                    if ((dx + dy) % 2 == 0)
                        continue;
                    const uchar* other = grey.ptr(y + radius + dy) + radius + dx;
                    for (int x = 0; x < cols; ++x)
                        bits[x] |= (unsigned)-(int)(other[x] < centre[x]) & bit;
                    bit <<= 1;
                }
        }
    });
}

} // namespace

void MatchingCost::prepare(const Mat& left, const Mat& right, int numDisparities, const MatchingCostParams& params)
{
    census_ = params.census;
    blockSize_ = params.blockSize;
    radius_ = census_ ? 0 : blockSize_ / 2;
    width_ = left.cols;
    channels_ = left.channels();
    // The means over the channels and the window and the gradient's units are left to the weights.
    const float area = (float)(blockSize_ * blockSize_);
    colorTruncation_ = params.colorTruncation * channels_;
    gradientTruncation_ = params.gradientTruncation * gradientScale;
    colorWeight_ = params.colorWeight / (channels_ * area);
    gradientWeight_ = (1 - params.colorWeight) / (gradientScale * area);

    const int behind = radius_ + numDisparities + padding;
    if (census_)
    {
        prepareCensus(left, false, 0);
        prepareCensus(right, true, behind);
    }
    else
    {
        prepareColorAndGradient(left, false, radius_);
        prepareColorAndGradient(right, true, behind);
    }
}

void MatchingCost::prepareColorAndGradient(const Mat& image, bool mirrored, int after)
{
    const int rows = image.rows + 2 * radius_;
    Mat& color = mirrored ? right_ : left_;
    Mat& gradient = mirrored ? rightGradient_ : leftGradient_;
    horizontalGradient(image, gradient_);
    color.create(channels_ * rows, width_ + radius_ + after, CV_8U);
    gradient.create(rows, color.cols, CV_16S);
    for (int c = 0; c < channels_; ++c)
        copyBordered<uchar>(image, c, radius_, radius_, after, mirrored, color.rowRange(c * rows, (c + 1) * rows));
    copyBordered<short>(gradient_, 0, radius_, radius_, after, mirrored, gradient);
    (mirrored ? rightPlane_ : leftPlane_) = color.step * rows;
}

void MatchingCost::prepareCensus(const Mat& image, bool mirrored, int after)
{
    const int radius = blockSize_ / 2;
    Mat grey = image;
    if (channels_ == 3)
        cvtColor(image, grey, COLOR_BGR2GRAY);
    copyMakeBorder(grey, grey_, radius, radius, radius, radius, BORDER_REPLICATE | BORDER_ISOLATED);
    censusTransform(grey_, radius, bits_);
    Mat& census = mirrored ? rightCensus_ : leftCensus_;
    census.create(image.rows, width_ + after, CV_32S);
    copyBordered<int>(bits_, 0, 0, 0, after, mirrored, census);
}

template <int lanes> void MatchingCost::evaluate(int y, int x, int first, float* cost) const
{
    if (census_)
        census<lanes>(y, x, first, cost);
    else
        colorAndGradient<lanes>(y, x, first, cost);
}

template <int lanes> void MatchingCost::census(int y, int x, int first, float* cost) const
{
    const unsigned pixel = leftCensus_.ptr<unsigned>(y)[x];
    const unsigned* candidates = rightCensus_.ptr<unsigned>(y) + width_ - 1 - x + first;
    HDP_VECTORIZED for (int k = 0; k < lanes; ++k)
    {
        // The number of bits set, in steps that exist on vectors.
        unsigned bits = pixel ^ candidates[k];
        bits -= (bits >> 1) & 0x55555555;
        bits = (bits & 0x33333333) + ((bits >> 2) & 0x33333333);
        bits = (bits + (bits >> 4)) & 0x0f0f0f0f;
        bits += bits >> 8;
        cost[k] = (float)(int)((bits + (bits >> 16)) & 63);
    }
}

template <int lanes> void MatchingCost::colorAndGradient(int y, int x, int first, float* cost) const
{
    const int mirroredX = width_ - 1 - x + 2 * radius_ + first;
    float sum[lanes] = { 0 };
    for (int dy = 0; dy < blockSize_; ++dy)
    {
        const uchar* pixels = left_.ptr(y + dy) + x;
        const uchar* candidates = right_.ptr(y + dy) + mirroredX;
        const short* slope = leftGradient_.ptr<short>(y + dy) + x;
        const short* slopes = rightGradient_.ptr<short>(y + dy) + mirroredX;
        for (int dx = 0; dx < blockSize_; ++dx, ++pixels, --candidates, ++slope, --slopes)
        {
            short color[lanes] = { 0 };
            for (int c = 0; c < channels_; ++c)
            {
                const short pixel = pixels[c * leftPlane_];
                const uchar* candidate = candidates + c * rightPlane_;
                HDP_VECTORIZED for (int k = 0; k < lanes; ++k)
                {
                    const short difference = (short)(pixel - candidate[k]);
                    color[k] = (short)(color[k] + std::max<short>(difference, (short)-difference));
                }
            }
            HDP_VECTORIZED for (int k = 0; k < lanes; ++k) sum[k] +=
                colorWeight_ * std::min((float)color[k], colorTruncation_) +
                gradientWeight_ * std::min((float)std::abs(*slope - slopes[k]), gradientTruncation_);
        }
    }
    std::copy(sum, sum + lanes, cost);
}

template CV_EXPORTS void MatchingCost::evaluate<4>(int y, int x, int first, float* cost) const;
template CV_EXPORTS void MatchingCost::evaluate<8>(int y, int x, int first, float* cost) const;

} // namespace hdp
} // namespace stereo
} // namespace cv
