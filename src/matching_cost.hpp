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

/** The matching cost M(p, x) of a layer (section 3.3):
colorWeight * min(mean_c |I_c(p) - I'_c(p - x)|, colorTruncation)
+ (1 - colorWeight) * min(|grad(p) - grad'(p - x)|, gradientTruncation), columns clamped to the image. grad is half the
difference of the grey levels left and right of a pixel; in the first and last column it is 4 times the difference
to the only neighbour.

Or the census cost: the number of pixels, of every second one in the window as on a checkerboard, that are darker than
the centre in one image and not in the other.

The right image is stored mirrored and padded, so that the candidates of a pixel follow one another in memory. */
class CV_EXPORTS MatchingCost
{
public:
    //! Takes a pair of one size, CV_8UC1 or CV_8UC3, and the number of candidates a pixel may be asked for.
    void prepare(const Mat& left, const Mat& right, int numDisparities, const MatchingCostParams& params);

    //! M(p, x) for x = first .. first + lanes - 1, lanes being 4 or 8; candidates past the last one are padding.
    template <int lanes> void evaluate(int y, int x, int first, float* cost) const;

private:
    void prepareColorAndGradient(const Mat& image, bool mirrored, int after);
    void prepareCensus(const Mat& image, bool mirrored, int after);
    template <int lanes> void colorAndGradient(int y, int x, int first, float* cost) const;
    template <int lanes> void census(int y, int x, int first, float* cost) const;

    bool census_;
    int blockSize_, radius_;
    int width_, channels_; // of the image
    float colorTruncation_, gradientTruncation_, colorWeight_,
        gradientWeight_;            // in the units of sums and of the planes
    size_t leftPlane_, rightPlane_; // from a channel to the next
    Mat left_;                      // CV_8UC1 planes of the channels below one another, bordered by radius_
    Mat leftGradient_;              // CV_16SC1, fixed point, bordered by radius_
    Mat right_;                     // as left_, mirrored, with a border for all candidates
    Mat rightGradient_;             // as leftGradient_, mirrored, with a border for all candidates
    Mat leftCensus_, rightCensus_;  // CV_32SC1, a bit a compared pixel; the right one mirrored, with a border as above
    Mat gradient_, grey_, bits_;
};

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
