// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_RANGE_SEARCH_HPP
#define OPENCV_HDPSTEREO_RANGE_SEARCH_HPP

#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"

#include "pair/corner_matches.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The range of the disparities, in pixels of their layer, of those corners that agree with some of their neighbours.
//! support: receives how many there are; with none the range is empty.
CV_EXPORTS Range supportedDisparities(const std::vector<CornerMatch>& matches, int& support);

/** The range of disparities of pairs whose caller does not know it, of any sign. Corners are matched over the whole
width of a coarse layer, in both directions; if they are too few, those of finer ones. What they span is enlarged by as
much and more, and all pixels of the layer below are matched over that, once more where disparities are found at its
ends: bare surfaces and near things have no corners. The disparities that stand the left-right check there and are
confident, with a margin, are the range. */
class CV_EXPORTS RangeSearch
{
public:
    /** Finds the range of a pair.
    @param left Without NaN, as completePair() leaves it.
    @param right Of the same size and type.
    @param masks Theirs.
    @param maxRowOffset By which rows may be off, see matchCoarsely().
    @param isFrame Whether it is a frame of a video: it keeps the range of the frame before if that has all that is
    found and is not much larger, or if nothing is found.
    @return First disparity, and the one behind the last.
    @throws cv::Exception if the images have too few points in common. */
    Range find(const Mat& left, const Mat& right, const PairMasks& masks, int maxRowOffset, bool isFrame);

    //! The next frame is the first one of a video.
    void forgetFrames() { last_ = Range(); }

private:
    int findCornerRange(const Mat& left, const Mat& right, const PairMasks& masks, int maxRowOffset, Range& range);
    bool matchPixels(const PairMasks& masks, const Range& disparities, const Range& counting, Range& found);
    bool searchAround(const PairMasks& masks, const Range& corners, Range& found);

    Range last_; // of the frame before; empty: there is none
    Size lastSize_;

    // Memory that is kept between calls
    Ptr<HDPTreeMatcher> matcher_;
    CoarseMatches coarse_;
    Mat leftLevels_, rightLevels_, left_, right_, disparity_, confidence_;
    std::vector<float> disparities_;
};

}}} // namespace cv::stereo::hdp

#endif
