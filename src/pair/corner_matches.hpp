// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CORNER_MATCHES_HPP
#define OPENCV_HDPSTEREO_CORNER_MATCHES_HPP

#include "../base/mask.hpp"

namespace cv { namespace stereo { namespace hdp {

struct CornerMatching
{
    enum
    {
        tensorSide = 7,   // pixels; window of the structure tensor: a smaller one takes noise for corners, a larger one
                          // finds corners beside its middle
        searchSide = 9,   // pixels; window on the coarse layer: a smaller one has more rivals, a larger one has two
                          // surfaces, and its sums have more than 32 bits
        searchRadius = 2, // rows above and below that are searched on the coarse layer: more cost time and give rivals
        trackWidth = 16,  // pixels; window on the finer layers: as many as a vector has
        trackHeight = 13, // pixels; odd, to have a middle row, and about as large as the width: more has two surfaces
        minMatches = 24,  // for a model of rows or light, which not all of them fit
        fractionBits = 5  // a tracked window begins at a multiple of 1 / 32 pixel: weights of 2 x 2 pixels have 16 bits
    };
};

//! A point of the left image and what it matches in the right one, in pixels of a layer
struct CornerMatch
{
    Point left;
    double x, y;     // in the right image
    double variance; // of y
    double residual; // mean square difference of the tracked windows
    bool isValid;
};

//! What is known of all windows of the search in an image, by their first pixels
struct SearchWindows
{
    Mat sums, scales; // 1 / sqrt(variance times the square of the pixels), 0 without texture; both of levels less 512
    Mat tensors;      // memory of the search for corners
};

//! The part of a right image that a window is compared with
struct SearchArea
{
    const ushort* pixels;
    const int* sums;
    const float* scales;
    size_t step, sumStep; // from a row to the next
    int columns;          // at least minColumns
    static const int rows = 2 * CornerMatching::searchRadius + 1, minColumns = 8;
};

//! A window of the left image that is tracked, and its gradients over two pixels
struct TrackedWindow
{
    static const int pixels = CornerMatching::trackWidth * CornerMatching::trackHeight;
    struct Sums
    {
        int l, ll, x, y, xx, xy, yy, lx, ly; // of levels, of their squares, of gradients, of products
    };
    short values[pixels], gradientX[pixels], gradientY[pixels];
    Sums sums;
};

//! Sums over a row of both tracked windows
struct RowSums
{
    int l, r, ll, rr, lr;

    RowSums operator+(const RowSums& other) const
    {
        return { l + other.l, r + other.r, ll + other.ll, rr + other.rr, lr + other.lr };
    }
};

//! Sums over a window of the right image: of levels r, and of products with what a TrackedWindow has
struct RightSums
{
    int r, rr, lr, xr, yr;
};

/** Matches the corners of a coarse layer over all disparities and some rows by normalised cross-correlation.
@param left,right CV_16UC1, values up to 1023, of the same size.
@param masks Of this layer, as disparities are; what is matched has data.
@param spacing Side of the cells of a grid that have a corner each, at least.
@param matches Receives one match per corner, to whole pixels. */
CV_EXPORTS void findCornerMatches(const Mat& left, const Mat& right, const PairMasks& masks, const Range& disparities,
                                  int spacing, SearchWindows& windows, std::vector<CornerMatch>& matches);

//! Makes matches of findCornerMatches(), tracked or not, invalid that a search from the right image back to the left
//! one, over all columns, does not confirm to within a pixel.
CV_EXPORTS void keepMutualMatches(const Mat& left, const Mat& right, SearchWindows& windows,
                                  std::vector<CornerMatch>& matches);

//! Improves matches to a fraction of a pixel by the method of Lucas and Kanade, on windows of equal mean and variance.
//! What is lost becomes invalid.
CV_EXPORTS void trackCornerMatches(const Mat& left, const Mat& right, std::vector<CornerMatch>& matches);

//! The residual of a tracked match over the rows that are about as quiet as the quietest ones: defective pixels are in
//! others.
CV_EXPORTS double quietDifference(const Mat& left, const Mat& right, const CornerMatch& match);

//! Matches of a pair's corners on a coarse layer, and its pyramids down to it
struct CoarseMatches
{
    std::vector<Mat> left, right; // grey, layer by layer; memory that is kept from pair to pair
    SearchWindows windows;        // the same
    int layer = 0;
    std::vector<CornerMatch> matches; // tracked on this layer; empty if it is too small
};

/** The matches that row and light alignment, and the search for the range of disparities, begin with.
@param left,right Pyramids, CV_16UC1, values up to 1023; their layers may end anywhere.
@param masks,disparities Of the images.
@param maxRowOffset Of the images: where few corners have matches in about the same rows, others are searched, too.
@param finer Layers below the usual one, for what has texture there alone; if there are none, corners are nearer. */
CV_EXPORTS void matchCoarsely(const std::vector<Mat>& left, const std::vector<Mat>& right, const PairMasks& masks,
                              const Range& disparities, int maxRowOffset, int finer, CoarseMatches& coarse);

}}} // namespace cv::stereo::hdp

#endif
