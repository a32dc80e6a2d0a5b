// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CENSUS_COST_HPP
#define OPENCV_HDPSTEREO_CENSUS_COST_HPP

#include "matching_cost.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Where the census of a pixel differs from that of its match: a byte of each plane. right: in the first plane;
//! planeStep: from a plane to the next
template <int planes>
CV_ALWAYS_INLINE unsigned censusDifference(const uchar* left, const uchar* right, size_t planeStep)
{
    unsigned bits = 0;
    for (int plane = 0; plane < planes; ++plane, right += planeStep)
        bits |= (unsigned)(left[plane] ^ *right) << (8 * plane);
    return bits;
}

//! The number of bits set in the lower 24
inline int countCensusBits(unsigned bits)
{
    bits -= (bits >> 1) & 0x555555;
    bits = (bits & 0x333333) + ((bits >> 2) & 0x333333);
    bits = (bits + (bits >> 4)) & 0x0f0f0f;
    return (int)((bits + (bits >> 8) + (bits >> 16)) & 31);
}

/** The census cost: the number of pixels, of every second one in the window as on a checkerboard, that are clearly
darker than the centre in one image and not in the other. The census of a pixel has a bit for each of them, in planes of
8 bits: 3 for a window of 7 x 7 pixels, 2 for 5, 1 for 3. Pixel by pixel these take turns, so each plane sees all of the
window. */
class CV_EXPORTS CensusCost CV_FINAL : public MatchingCost
{
public:
    /** Takes a pair.
    @param left Grey levels, CV_16UC1, see greyLevels().
    @param right Of the same size and type.
    @param numDisparities The number of candidates a pixel may be asked for.
    @param blockSize Side of the window: 3, 5 or 7.
    @param tolerance A pixel is clearly darker by more than this, 0..mostTolerance, in the images' units.
    @param masks What pixels without data may cost is limited, see CostLimits. */
    void prepare(const Mat& left, const Mat& right, int numDisparities, int blockSize, int tolerance = 0,
                 const PairMasks& masks = PairMasks());

    void evaluate(const int* pixels, int count, int first, int lanes, float* cost) const CV_OVERRIDE;

    //! The same in bytes
    void evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const;

    void ofDisparities(const Mat& disparity, Mat& costs) const CV_OVERRIDE;

    //! The size of the images
    Size size() const { return Size(width_, left_.rows); }
    //! The number of planes of 8 bits that hold the census of a pixel
    int planes() const { return planes_; }
    //! The number of comparisons in the census of a pixel
    int comparisons() const { return planes() == 3 ? 24 : planes() == 2 ? 12 : 4; } // windows of 7, 5 and 3
    //! The census of a row of the left image and its grey levels in 8 bits: 4 bytes per pixel, the planes and greyByte.
    //! There are 16 more pixels to read before and behind the row.
    const uchar* leftPixels(int y) const { return firstLeft_ + y * leftStep_; }
    //! A row of the right image's census, or of its grey levels for plane = planes(): candidate d of pixel x is at
    //! [width - 1 - x + d]. There are 16 more bytes to read before the row, of the last column, and 48
    //! behind the last candidate.
    const uchar* rightPlane(int plane, int y) const { return firstRight_ + plane * planeStride_ + y * rightStep_; }
    //! Bytes from a plane of the right image to the next
    size_t planeStride() const { return planeStride_; }
    static const int greyByte = 3;
    static const int mostTolerance = 1023;

private:
    void prepareImage(const Mat& image, int radius, int tolerance, bool isRight, int after);

    int width_ = 0, planes_ = 0;
    Mat left_;  // CV_8UC4, see leftPixels()
    Mat right_; // CV_8UC1, the planes of the census and the grey levels below one another, see rightPlane()
    const uchar *firstLeft_ = nullptr, *firstRight_ = nullptr; // of row 0
    size_t leftStep_ = 0, rightStep_ = 0, planeStride_ = 0;    // from a row or plane to the next
};

/** The matching cost of a layer's pixels at the disparities of the layer below, which has the texture that means of
2 x 2 pixels take away, and twice as many disparities. With C of the layer, C' of the one below, and the four pixels q
that pixel p is the mean of, candidate h, a disparity of h / 2 pixels, costs

cost(p, h) = (C(p, floor(h / 2)) + C(p, ceil(h / 2))) / 8 + 3 / 16 * sum over q of C'(q, h).

Without a layer below, candidates are those of the layer, and cost(p, d) = C(p, d). */
class CV_EXPORTS TwoLayerCost
{
public:
    static const int scale = 8; // of the costs, for their fractions

    //! From the costs of a layer, and of the one below, twice as large, or null. They have to stay where they are.
    TwoLayerCost(const CensusCost& own, const CensusCost* below) : own_(own), below_(below) {}

    //! Candidates per pixel of disparity
    int steps() const { return below_ ? 2 : 1; }
    //! CensusCost::evaluate(), times scale and rounded up. With a layer below, first is even.
    void evaluate(const int* pixels, int count, int first, int lanes, uchar* cost) const;

private:
    const CensusCost& own_;
    const CensusCost* const below_;
};

}}} // namespace cv::stereo::hdp

#endif
