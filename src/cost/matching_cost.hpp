// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MATCHING_COST_HPP
#define OPENCV_HDPSTEREO_MATCHING_COST_HPP

#include "../base/mask.hpp"

namespace cv { namespace stereo { namespace hdp {

/** What pixels without data may cost. One of the left image costs nothing, whatever its candidate is: it prefers none.
A candidate in the right image that has no data costs no more than an ordinary pixel: it is neither preferred to a
match nor avoided as a bad one would be. Before its row begins, see rowStart(), it has no limit, as columns beside the
image have none: it looks like the first one with data. */
class CV_EXPORTS CostLimits
{
public:
    static const int none = 255;
    // Bits of the census: more drives surfaces out of what is masked, less draws them into it
    static const int ordinary = 8;

    /** Takes the masks of a layer.
    @param masks Empty: there are no limits.
    @param numDisparities The number of candidates a pixel may be asked for. */
    void prepare(const PairMasks& masks, int numDisparities);

    bool isEmpty() const { return left_.empty(); }

    //! The column in which a row of the right image begins, see rowStart()
    int firstColumn(int y) const { return firstColumns_.empty() ? 0 : firstColumns_[y]; }

    //! A row of the left image: 0 where a pixel has no data, else none. There are 32 more bytes to read before and
    //! behind it.
    const uchar* left(int y) const { return left_.ptr(y) + margin; }
    //! A row of the right image, from right to left, as CensusCost::rightPlane(): ordinary where there is no data, but
    //! before it begins; else none. Candidate d of pixel x is at [width - 1 - x + d].
    const uchar* right(int y) const { return right_.ptr(y) + margin; }

    //! Limits what MatchingCost::evaluate() has found, in floats or bytes. unit: the cost of a bit; steps: candidates
    //! per pixel of disparity, 1 or 2. What is between two pixels has data if both have.
    template <typename Cost>
    void apply(const int* pixels, int count, int first, int lanes, Cost unit, int steps, Cost* cost) const;
    //! Limits the costs of a row of disparities.
    void apply(int y, const ushort* disparity, uchar* cost) const;
    //! A disparity map of the left image, USHRT_MAX where there is no data
    Mat dropMissing(const Mat& disparity) const;
    //! Sets visible to 0 for the pixels of a row whose matches have no data; leaves the others as they are.
    void hideUnmatched(int y, const ushort* disparity, uchar* visible) const;

private:
    static const int margin = 32;
    int width_ = 0;
    Mat left_, right_;
    std::vector<int> firstColumns_; // by row
};

//! The matching cost M(p, x) of a layer (section 3.3): how unlike are pixel p of the left and p - x of the right image.
class CV_EXPORTS MatchingCost
{
public:
    virtual ~MatchingCost() {}

    /** Costs M(p, x) of some pixels.
    @param pixels The pixels, y * width + x each.
    @param count Their number.
    @param first The first of the candidates x.
    @param lanes The number of candidates, 4, 8, 16, 32 or 64; costs of those past the last one, at most costPadding,
    mean nothing.
    @param cost Receives M(pixels[i], first + k) at [i * lanes + k]. */
    virtual void evaluate(const int* pixels, int count, int first, int lanes, float* cost) const = 0;

    //! The cost of one candidate of each pixel, CV_32SC1, in 1/512; that of the census is CV_8UC1, in bits. disparity:
    //! CV_16UC1, a disparity map.
    virtual void ofDisparities(const Mat& disparity, Mat& costs) const;

    //! What pixels without data cost at most
    const CostLimits& limits() const { return limits_; }

protected:
    CostLimits limits_;
};

// All costs hold the rows of the right image mirrored and padded, so that the candidates of a pixel follow one another
// in memory.

//! Columns behind the last candidate that evaluate() may read
const int costPadding = 32;

//! y of pixel y * width + x; rowsPerPixel: 1. / width. Exact: the error of the product is far less than half a pixel.
CV_ALWAYS_INLINE int rowOf(int pixel, double rowsPerPixel) { return (int)((pixel + 0.5) * rowsPerPixel); }

}}} // namespace cv::stereo::hdp

#endif
