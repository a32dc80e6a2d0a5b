// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_COLOR_GRADIENT_COST_HPP
#define OPENCV_HDPSTEREO_COLOR_GRADIENT_COST_HPP

#include "../cost/matching_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

struct ColorGradientParams
{
    float colorTruncation;    // of the mean difference over the channels
    float gradientTruncation; // of the difference of the horizontal gradients
    float colorWeight;        // of colour against gradient
    int blockSize;            // side of the window the cost is averaged over
};

//! The planes of an image with its borders
struct ColorGradientImage
{
    const uchar* color;
    const short* gradient; // in rows of as many elements as those of color
    size_t step, plane;    // from a row to the next, and from a plane of color to the next
};

//! The planes of a pair, as ColorGradientCost holds them. The window of pixel (x, y) and those of its candidates have
//! their first pixels at y * left.step + x and y * right.step + width - 1 - x + candidate + blockSize - 1.
struct ColorGradientPlanes
{
    int width;     // of the image
    int blockSize; // of the window
    int count;     // of colour planes, 1 or 3
    ColorGradientImage left, right;
    float colorTruncation, gradientTruncation; // in the units of sums over the channels and of the gradient planes
    float colorWeight, gradientWeight;         // of these sums
};

/** The cost of colour and gradient of section 3.3:

colorWeight * min(mean_c |I_c(p) - I'_c(p - x)|, colorTruncation)
+ (1 - colorWeight) * min(|grad(p) - grad'(p - x)|, gradientTruncation),

its mean over a window, columns clamped to the image. grad is half the difference of the grey levels left and right of a
pixel; in the first and last column it is 4 times the difference to the only neighbour. Constants, and what the
paper leaves open, are as in the authors' program, but for the 4. */
class CV_EXPORTS ColorGradientCost CV_FINAL : public MatchingCost
{
public:
    //! Takes a pair of CV_8UC1 or CV_8UC3, of which a pixel may be asked for so many candidates. masks: see CostLimits
    void prepare(const Mat& left, const Mat& right, int numDisparities, const ColorGradientParams& params,
                 const PairMasks& masks = PairMasks());

    void evaluate(const int* pixels, int count, int first, int lanes, float* cost) const CV_OVERRIDE;

private:
    ColorGradientImage prepareImage(const Mat& image, bool mirrored, int after, Mat& color, Mat& gradient);

    ColorGradientPlanes planes_;
    float bit_;                        // what stands for a bit of the census in CostLimits
    Mat left_, right_;                 // CV_8UC1, planes of the channels below one another
    Mat leftGradient_, rightGradient_; // CV_16SC1, fixed point
    Mat gradient_;
};

}}} // namespace cv::stereo::hdp

#endif
