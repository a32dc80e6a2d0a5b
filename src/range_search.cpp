// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "range_search.hpp"

#include "base/vectorized.hpp"
#include "pair/image_levels.hpp"
#include "pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

// Corners
HDP_TUNABLE(int, neighbourReach, 24, "pixels of the layer", "in which a corner is to have neighbours");
HDP_TUNABLE(int, minNeighbours, 3, "corners", "of the same surface: fewer believe a pattern that repeats itself");
HDP_TUNABLE(double, neighbourStep, 0.5, "pixels of the layer", "by which these differ: more lets wrong corners in");
HDP_TUNABLE(int, minSupport, 10, "corners", "fewer are no evidence of a range");
HDP_TUNABLE(int, mostFiner, 2, "layers", "below the usual one that are searched for more corners: each takes longer");

// All pixels
HDP_TUNABLE(double, reach, 1.5, "share of the corners' range",
            "that is searched before it and behind it: more costs time and errors");
HDP_TUNABLE(double, leastReach, 0.1, "share of the image's width",
            "the same at least: a near thing before a wall has few corners; more costs time and errors");
HDP_TUNABLE(double, endShare, 0.05, "share of what is searched",
            "at its ends: what is found there goes on beyond; more leads to a second search more often");
HDP_TUNABLE(double, minConfidence, 15, "confidence",
            "of disparities that count: less believes errors, more misses what is near and small");
HDP_TUNABLE(double, leftOut, 0.0005, "share of the disparities", "at each end that may be wrong");

// The range
HDP_TUNABLE(double, farMargin, 0.125, "share of the range", "before its first disparity: more costs time");
HDP_TUNABLE(double, nearMargin, 0.35, "share of the range", "behind its last one: near things are small and missed");
HDP_TUNABLE(double, leastMargin, 4, "pixels of the image", "at both ends, at least");
HDP_TUNABLE(double, keptExcess, 2, "times the range", "that the range of a video may be larger than that of a frame");

const int mostDisparity = SHRT_MAX / StereoMatcher::DISP_SCALE - 2;

//! From first to last, cut to disparities that an image of this width can have and CV_16S can hold
Range limited(double first, double last, int width)
{
    const int limit = std::min(width - 1, mostDisparity);
    const int start = clamped(cvFloor(first), -limit, limit);
    return Range(start, clamped(cvCeil(last), start, limit) + 1);
}

} // namespace

Range supportedDisparities(const std::vector<CornerMatch>& matches, int& support)
{
    double first = 0, last = 0;
    support = 0;
    for (const CornerMatch& match : matches)
    {
        if (!match.isValid)
            continue;
        const double disparity = match.left.x - match.x;
        int neighbours = 0;
        for (const CornerMatch& other : matches)
        {
            const Point offset = other.left - match.left;
            const int square = offset.dot(offset);
            neighbours += other.isValid && square != 0 && square <= neighbourReach * neighbourReach &&
                          std::abs(other.left.x - other.x - disparity) <= neighbourStep;
        }
        if (neighbours < minNeighbours)
            continue;
        first = support == 0 ? disparity : std::min(first, disparity);
        last = support == 0 ? disparity : std::max(last, disparity);
        ++support;
    }
    return support == 0 ? Range() : Range(cvFloor(first), cvCeil(last) + 1);
}

//! Matches corners, on finer layers if too few have neighbours that agree; returns how many do. range: receives the
//! disparities of these, in pixels of coarse_.layer
int RangeSearch::findCornerRange(const Mat& left, const Mat& right, const PairMasks& masks, int maxRowOffset,
                                 Range& range)
{
    LevelScale scale(bitsInUse(left, right)); // what has no data has levels of what has some
    findEnds(left, right, masks, scale);
    greyLevels(left, scale, leftLevels_);
    greyLevels(right, scale, rightLevels_);
    const int width = left.cols;
    int support = 0;
    for (int finer = 0; finer <= mostFiner && support < minSupport; ++finer)
    {
        matchCoarsely({ leftLevels_ }, { rightLevels_ }, masks, Range(-width, width), maxRowOffset, finer, coarse_);
        if (!coarse_.matches.empty())
            keepMutualMatches(coarse_.left[coarse_.layer], coarse_.right[coarse_.layer], coarse_.windows,
                              coarse_.matches);
        range = supportedDisparities(coarse_.matches, support);
    }
    return support;
}

//! Matches all pixels, one layer below that of the corners. disparities: that are searched; counting: those of them
//! that may be found. Returns whether any are; found then receives their range. All are in pixels of the image.
bool RangeSearch::matchPixels(const PairMasks& masks, const Range& disparities, const Range& counting, Range& found)
{
    const int layer = std::max(coarse_.layer - 1, 0), scale = 1 << layer;
    const int columns = coarse_.left[layer].cols;
    const Range searched = limited((double)disparities.start / scale, (double)disparities.end / scale, columns);
    if (!matcher_)
    {
        matcher_ = HDPTreeMatcher::create(0, 16, HDPTreeMatcher::PRESET_FAST);
        matcher_->setDisparityDepth(CV_32F);
        matcher_->setDisp12MaxDiff(1);
    }
    matcher_->setMinDisparity(searched.start);
    matcher_->setNumDisparities(searched.size());
    matcher_->setMasks(dataOfLayer(masks.left, layer), dataOfLayer(masks.right, layer));
    coarse_.left[layer].convertTo(left_, CV_16U, 64); // from 10 bits to 16
    coarse_.right[layer].convertTo(right_, CV_16U, 64);
    matcher_->compute(left_, right_, disparity_);
    matcher_->getConfidence(confidence_);
    disparities_.clear();
    for (int y = 0; y < disparity_.rows; ++y)
        for (int x = 0; x < columns; ++x)
        {
            const float disparity = disparity_.at<float>(y, x);
            if (disparity >= searched.start && disparity * scale >= counting.start &&
                disparity * scale < counting.end && confidence_.at<uchar>(y, x) >= minConfidence)
                disparities_.push_back(disparity);
        }
    if (disparities_.empty())
        return false;
    const size_t lastIndex = disparities_.size() - 1, skipped = (size_t)(leftOut * lastIndex);
    std::sort(disparities_.begin(), disparities_.end());
    found.start = cvFloor(disparities_[skipped] * scale);
    found.end = cvCeil(disparities_[lastIndex - skipped] * scale) + 1;
    return true;
}

//! Matches all pixels over a range around that of the corners. If disparities are found near its ends, surfaces may go
//! on beyond: pixels are matched once more, around what was found. What is near the ends of that is taken for errors.
//! found: in pixels of the image
bool RangeSearch::searchAround(const PairMasks& masks, const Range& corners, Range& found)
{
    const double least = leastReach * coarse_.left[0].cols;
    const auto around = [least](const Range& range) {
        const double beside = std::max(reach * range.size(), least);
        return Range(cvFloor(range.start - beside), cvCeil(range.end + beside));
    };
    const auto withoutEnds = [](const Range& range) {
        const double ofEnd = endShare * range.size();
        return Range(cvFloor(range.start + ofEnd), cvCeil(range.end - ofEnd));
    };
    const int unit = 1 << coarse_.layer;
    const Range first = around(Range(corners.start * unit, corners.end * unit)), inside = withoutEnds(first);
    if (!matchPixels(masks, first, first, found))
        return false;
    const Range second = around(found);
    Range more;
    if ((found.start <= inside.start || found.end >= inside.end) &&
        matchPixels(masks, second, withoutEnds(second), more))
        found = Range(std::min(found.start, more.start), std::max(found.end, more.end));
    return true;
}

Range RangeSearch::find(const Mat& left, const Mat& right, const PairMasks& masks, int maxRowOffset, bool isFrame)
{
    const Range last = isFrame && left.size() == lastSize_ ? last_ : Range();
    Range corners, found;
    const int support = findCornerRange(left, right, masks, maxRowOffset, corners);
    const bool isFound = support >= minSupport && searchAround(masks, corners, found);
    if (!isFound && last.empty())
        CV_Error(Error::StsBadArg, "numDisparities must be > 0 for this pair: too few corners match to find its range");
    Range range = last;
    if (isFound)
    {
        const double size = found.size(), least = leastMargin;
        const bool isNearZero = found.start > 0 && found.start <= size; // what is far may have no texture
        const double first = found.start - std::max(farMargin * size, least);
        range = limited(isNearZero ? std::min(first, 0.) : first, found.end - 1 + std::max(nearMargin * size, least),
                        left.cols);
        const bool coversFound = last.start <= found.start && last.end >= found.end;
        if (!last.empty() && coversFound && last.size() <= keptExcess * range.size())
            range = last;
    }
    if (isFrame)
    {
        last_ = range;
        lastSize_ = left.size();
    }
    return range;
}

}}} // namespace cv::stereo::hdp
