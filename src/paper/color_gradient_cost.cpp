// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "color_gradient_cost.hpp"
#include "color_gradient_cost.simd.hpp"
#include "paper/color_gradient_cost.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(evaluateColorGradientCost)

// Units of a gradient in one intensity level a pixel: the largest, borderGain * 255, still fits into 16 bit
const int gradientScale = 32;

// How much more than inside the image the difference counts at the border, where it is one-sided. It keeps smooth
// surfaces from matching the clamped column. The paper does not say what happens there. The authors' program does not
// halve this difference, which would be 2; 4 fits its disparity maps better.
const int borderGain = 4;

// Bits of the census that the largest cost counts as, for what pixels without data may cost: with more these draw
// surfaces
const float bitsOfMost = 9;

//! Half the central difference of the grey levels along each row, in 1 / gradientScale levels; at the ends borderGain
//! times the one-sided difference.
void horizontalGradient(const Mat& image, Mat& gradient)
{
    const int last = image.cols - 1;
    gradient.create(image.size(), CV_16S);
    // Grey levels in 1 / 65536: rounded to whole ones they cost accuracy, as smooth surfaces have gradients below one.
    parallelForRows(image.size(), std::vector<int>(image.cols), [&](int y, std::vector<int>& g) {
        const uchar* pixels = image.ptr(y);
        const int channels = image.channels();
        short* d = gradient.ptr<short>(y);
        for (int x = 0; x <= last; ++x)
            g[x] = channels == 1 ? pixels[x] * 65536 : greyOf(pixels + 3 * x);
        for (int x = 1; x < last; ++x)
            d[x] = (short)((g[x + 1] - g[x - 1] + 2048) >> 12);
        const int after = std::min(1, last), before = std::max(last - 1, 0); // of an only column: itself
        d[0] = (short)(((g[after] - g[0]) * borderGain + 1024) >> 11);
        d[last] = (short)(((g[last] - g[before]) * borderGain + 1024) >> 11);
    });
}

} // namespace

void ColorGradientCost::prepare(const Mat& left, const Mat& right, int numDisparities,
                                const ColorGradientParams& params, const PairMasks& masks)
{
    limits_.prepare(masks, numDisparities);
    const float most =
        params.colorWeight * params.colorTruncation + (1 - params.colorWeight) * params.gradientTruncation;
    bit_ = most / bitsOfMost;
    const int channels = left.channels();
    planes_.width = left.cols;
    planes_.blockSize = params.blockSize;
    planes_.count = channels;
    // The means over the channels and the window and the gradient's units are left to the weights.
    const float area = (float)(params.blockSize * params.blockSize);
    planes_.colorTruncation = params.colorTruncation * channels;
    planes_.gradientTruncation = params.gradientTruncation * gradientScale;
    planes_.colorWeight = params.colorWeight / (channels * area);
    planes_.gradientWeight = (1 - params.colorWeight) / (gradientScale * area);
    planes_.left = prepareImage(left, false, 0, left_, leftGradient_);
    planes_.right = prepareImage(right, true, numDisparities + costPadding, right_, rightGradient_);
}

ColorGradientImage ColorGradientCost::prepareImage(const Mat& image, bool mirrored, int after, Mat& color,
                                                   Mat& gradient)
{
    const int radius = planes_.blockSize / 2, rows = image.rows + 2 * radius;
    horizontalGradient(image, gradient_);
    color.create(planes_.count * rows, image.cols + 2 * radius + after, CV_8U);
    gradient.create(rows, color.cols, CV_16S);
    parallelFor(planes_.count + 1, [&](int c) {
        const bool isColor = c < planes_.count;
        Mat plane, bordered = isColor ? color.rowRange(c * rows, (c + 1) * rows) : gradient;
        if (isColor)
            extractChannel(image, plane, c);
        else
            plane = gradient_;
        if (mirrored)
            flip(plane, plane, 1);
        copyMakeBorder(plane, bordered, radius, radius, radius, radius + after, BORDER_REPLICATE);
    });
    return { color.ptr(), gradient.ptr<short>(), color.step, color.step * rows };
}

void ColorGradientCost::evaluate(const int* pixels, int count, int first, int lanes, float* cost) const
{
    dispatched::evaluateColorGradientCost(planes_, pixels, count, first, lanes, cost);
    limits_.apply(pixels, count, first, lanes, bit_, 1, cost);
}

}}} // namespace cv::stereo::hdp
