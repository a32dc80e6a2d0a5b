// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MATCHING_COST_HPP
#define OPENCV_HDPSTEREO_MATCHING_COST_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {
namespace hdp {

struct MatchingCostParams
{
    bool census;              // the census cost instead of colour and gradient
    float colorTruncation;    // of the mean difference over the channels
    float gradientTruncation; // of the difference of the horizontal gradients
    float colorWeight;        // of colour against gradient
    int blockSize;            // side of the window the cost is averaged over
};

//! The planes of a pair, as MatchingCost holds them: rows of the right image are mirrored and padded. Without their
//! borders, the window of pixel (x, y) and those of its candidates have their first pixels at
//! left[y * leftStep + x] and right[y * rightStep + width - 1 - x + candidate + blockSize - 1]. A pixel of the left
//! image's census has its planes side by side, at left[y * leftStep + 4 * x].
struct CostPlanes
{
    bool census;
    int width;     // of the image
    int blockSize; // of the window that evaluate() averages over: 1 for the census cost
    int count;     // of colour or census planes
    const uchar *left, *right;
    const short *leftGradient, *rightGradient; // in rows of as many elements as those of left and right
    size_t leftStep, rightStep;                // from a row to the next
    size_t leftPlane, rightPlane;              // from a plane to the next
    float colorTruncation, gradientTruncation; // in the units of sums over the channels and of the gradient planes
    float colorWeight, gradientWeight;         // of these sums
};

/** The matching cost M(p, x) of a layer (section 3.3):
colorWeight * min(mean_c |I_c(p) - I'_c(p - x)|, colorTruncation)
+ (1 - colorWeight) * min(|grad(p) - grad'(p - x)|, gradientTruncation), columns clamped to the image. grad is half the
difference of the grey levels left and right of a pixel; in the first and last column it is 4 times the difference
to the only neighbour.

Or the census cost: the number of pixels, of every second one in the window as on a checkerboard, that are darker than
the centre in one image and not in the other.

The right image is stored mirrored and padded, so that the candidates of a pixel follow one another in memory. The census
is in planes of 8 bits: 3 for a window of 7, 2 for 5, 1 for 3. */
class CV_EXPORTS MatchingCost
{
public:
    //! Takes a pair of one size and the number of candidates a pixel may be asked for. The census cost takes CV_16UC1,
    //! see greyLevels(), the other one CV_8UC1 or CV_8UC3.
    void prepare(const Mat& left, const Mat& right, int numDisparities, const MatchingCostParams& params);

    /** Costs M(p, x) of some pixels.
    @param pixels The pixels, y * width + x each.
    @param count Their number.
    @param first The first of the candidates x.
    @param lanes The number of candidates, 4, 8, 16 or 32; costs of those past the last one mean nothing.
    @param cost Receives M(pixels[i], first + k) at [i * lanes + k]. */
    void evaluate(const int* pixels, int count, int first, int lanes, float* cost) const;

    //! The census cost of one candidate of each pixel, CV_8UC1. disparity: CV_16UC1, a disparity map.
    void censusCosts(const Mat& disparity, Mat& costs) const;

    //! The number of planes of 8 bits that hold the census of a pixel; 0 for the cost of colour and gradient
    int planes() const { return planes_.census ? planes_.count : 0; }
    //! The census of a row of the left image and its grey levels, in 8 bits: 4 bytes a pixel, its planes and greyByte.
    //! There are 16 more pixels to read before and behind the row.
    const uchar* leftPixels(int y) const { return planes_.left + y * planes_.leftStep; }
    //! A row of the right image's census, or of its grey levels for plane = planes(): candidate d of pixel x is at
    //! [width - 1 - x + d]. There are 16 more bytes to read before the row and 48 behind the last candidate.
    const uchar* rightPlane(int plane, int y) const
    {
        return planes_.right + plane * planes_.rightPlane + y * planes_.rightStep;
    }
    //! From a plane of the right image to the next
    size_t planeStride() const { return planes_.rightPlane; }
    enum
    {
        greyByte = 3
    };

private:
    void prepareColorAndGradient(const Mat& image, bool mirrored, int after);
    void prepareCensus(const Mat& image, bool isRight, int after);

    int blockSize_, channels_;
    CostPlanes planes_;
    Mat left_;          // CV_8UC1, planes of the channels below one another, bordered, or CV_8UC4, see leftPixels()
    Mat leftGradient_;  // CV_16SC1, fixed point, bordered by half the window
    Mat right_;         // CV_8UC1, planes of the channels or of the census and the grey levels below one another,
                        // mirrored, with a border for all candidates
    Mat rightGradient_; // as leftGradient_, mirrored, with a border for all candidates
    Mat gradient_, grey_;
};

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
