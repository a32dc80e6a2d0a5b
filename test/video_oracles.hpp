// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_VIDEO_ORACLES_HPP
#define OPENCV_HDPSTEREO_TEST_VIDEO_ORACLES_HPP

// The stages of videos written down a second time, pixel by pixel. Of the library, only the formulas of a motion are
// called, which have tests of their own: BackwardMotion, DisparityChange and correctedChange().

#include "oracles.hpp"
#include "../src/video/temporal_join.hpp"

namespace opencv_test { namespace oracle {

//! What a disparity of the last frame, in pixels, is now at this pixel
inline float changed(const hdp::DisparityChange& change, float before, int x, int y)
{
    return change.now(before, (float)x, (float)y);
}

//! How far a block's pixels have to go to be where they were, see hdp::findWarp(); false if that is not known.
inline bool blockShift(const hdp::BackwardMotion& motion, const Mat& disparity, Point block, Point& shift)
{
    const Point centre(std::min(4 * block.x + 2, disparity.cols - 1), std::min(4 * block.y + 2, disparity.rows - 1));
    Point at = centre;
    float now = disparity.at<ushort>(at) / 16.f;
    int lastStep = 0;
    for (int step = 0; step < 4; ++step)
    {
        const Point2f place = motion.placeBefore(centre.x, centre.y, now);
        if (!(place.x >= 0 && place.y >= 0 && place.x <= disparity.cols - 1 && place.y <= disparity.rows - 1))
            return false;
        const Point next((int)std::floor(place.x + 0.5f), (int)std::floor(place.y + 0.5f));
        lastStep = std::abs(next.x - at.x) + std::abs(next.y - at.y);
        if (step > 0 && lastStep == 0)
            break;
        at = next;
        now = changed(motion.change, disparity.at<ushort>(at) / 16.f, centre.x, centre.y);
    }
    shift = at - centre;
    return lastStep <= 2;
}

//! Where a pixel was, or the nearest pixel of the image
inline Point movedFrom(const hdp::FrameWarp& warp, int x, int y)
{
    const Vec2s shift = warp.shifts.at<Vec2s>(y / 4, x / 4);
    return Point(clamped(x + shift[0], warp.size.width), clamped(y + shift[1], warp.size.height));
}

inline bool isKnown(const hdp::FrameWarp& warp, int x, int y)
{
    return warp.shifts.at<Vec2s>(y / 4, x / 4)[0] != SHRT_MIN;
}

//! Sum over the square around a cell, whose rows and columns are clamped to the image
inline int squareSum(const Mat& image, int x, int y, int radius)
{
    int sum = 0;
    for (int v = y - radius; v <= y + radius; ++v)
        for (int u = x - radius; u <= x + radius; ++u)
            sum += image.at<uchar>(clamped(v, image.rows), clamped(u, image.cols));
    return sum;
}

//! The last frame's cells where the warp leads, or at the same place if it is unknown: in pixels, which are half cells
inline Mat warpedGrey(const Mat& before, const hdp::FrameWarp& warp)
{
    Mat warped(before.size(), CV_8U);
    for (int y = 0; y < before.rows; ++y)
        for (int x = 0; x < before.cols; ++x)
        {
            const Point from = isKnown(warp, 2 * x, 2 * y) ? movedFrom(warp, 2 * x, 2 * y) : Point(2 * x, 2 * y);
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                sum += before.at<uchar>(std::min((from.y + k / 2) / 2, before.rows - 1),
                                        std::min((from.x + k % 2) / 2, before.cols - 1));
            warped.at<uchar>(y, x) = (uchar)std::floor(sum / 4 + 0.5);
        }
    return warped;
}

//! See hdp::findSources().
inline Mat findSources(const Mat& before, const Mat& now, const hdp::FrameWarp* warp)
{
    const Mat there = warp ? warpedGrey(before, *warp) : before;
    Mat change(now.size(), CV_8U), contrast(now.size(), CV_8U), sources(now.size(), CV_8U), unmovedChange;
    absdiff(now, before, unmovedChange);
    std::vector<int> changes;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            changes.push_back(std::abs(now.at<uchar>(y, x) - there.at<uchar>(y, x)));
            change.at<uchar>(y, x) = (uchar)changes.back();
            contrast.at<uchar>(y, x) = (uchar)(std::abs(25 * now.at<uchar>(y, x) - squareSum(now, x, y, 2)) / 25);
        }
    std::sort(changes.begin(), changes.end());
    const int noise = 3 + 4 * changes[(changes.size() - 1) / 2];
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            const int ofCell = squareSum(change, x, y, 1), around = squareSum(contrast, x, y, 2);
            const bool looksTheSame = ofCell <= 9 * noise || 25 * 100 * ofCell <= 9 * 70 * around;
            const double meanChange = (squareSum(now, x, y, 1) - squareSum(before, x, y, 1)) / 9.;
            const bool isMoved = warp && looksTheSame && isKnown(*warp, 2 * x, 2 * y);
            const bool isNearer = squareSum(unmovedChange, x, y, 1) <= ofCell;
            const bool isSame = warp ? std::abs(meanChange) <= 2.5 && isNearer : looksTheSame;
            sources.at<uchar>(y, x) = (uchar)((isSame ? hdp::SAME_PLACE : 0) + (isMoved ? hdp::MOVED_PLACE : 0));
        }
    return sources;
}

//! Whether the coarsest images show two scenes, if nothing moved; see hdp::predictFrame().
inline bool isCut(const Mat& before, const Mat& now)
{
    const int mean = cvRound(cv::mean(now)[0]);
    int change = 0, contrast = 0;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            change += std::abs(now.at<uchar>(y, x) - before.at<uchar>(y, x));
            contrast += std::abs(now.at<uchar>(y, x) - mean);
        }
    return 100 * change > 60 * contrast;
}

//! See hdp::joinLastFrame(); for frames that continue and images of at least a cell.
class TemporalJoin
{
public:
    Mat disparity; // receives FrameMemory::disparity,
    Mat detail;    // and FrameMemory::detail

    //! Returns whether the pair contradicts the last frame.
    bool operator()(const CensusCost& cost, int comparisons, const hdp::FrameMemory& last,
                    const hdp::FramePrediction& prediction, const Mat& measured)
    {
        last_ = &last;
        prediction_ = &prediction;
        measured_ = measured;
        isStill_ = prediction.motion.isStill;
        change_ = isStill_ ? hdp::DisparityChange() : measuredChange();
        compare(cost, comparisons);
        if (choose())
            return true;
        disparity.create(measured.size(), CV_16U);
        detail.create(measured.size(), CV_8U);
        for (int y = 0; y < measured.rows; ++y)
            for (int x = 0; x < measured.cols; ++x)
                join(x, y);
        return false;
    }

private:
    //! What cells tell, or squares of them
    struct Evidence
    {
        int unmoved, moved;           // what the last frame's disparities cost more than the measured one
        int scaleUnmoved, scaleMoved; // what that one costs, if there is another
    };

    //! A disparity of the last frame, in 1 / 256 pixel; motion: as the camera's motion changes it
    int changedBy(const hdp::DisparityChange& motion, int finer, int x, int y) const
    {
        return (int)(changed(motion, finer / 256.f, x, y) * 256);
    }

    //! The disparity that moves to the first pixel of a cell
    int movedToCell(const hdp::DisparityChange& motion, Point cell) const
    {
        const Point from = movedFrom(prediction_->warp, 2 * cell.x, 2 * cell.y);
        return changedBy(motion, 16 * last_->disparity.at<ushort>(from), 2 * cell.x, 2 * cell.y);
    }

    hdp::DisparityChange measuredChange() const
    {
        const hdp::DisparityChange& change = prediction_->backward.change;
        std::vector<float> predicted, now;
        for (int i = 0; i < prediction_->sources.rows; i += 12)
            for (int j = 0; j < prediction_->sources.cols; j += 12)
                if (prediction_->sources.at<uchar>(i, j) & hdp::MOVED_PLACE)
                {
                    predicted.push_back(movedToCell(change, Point(j, i)) / 256.f);
                    now.push_back(measured_.at<ushort>(2 * i, 2 * j) / 16.f);
                }
        return hdp::correctedChange(change, predicted, now);
    }

    //! Which sources of the cells count, and what their pixels on the diagonal tell
    void compare(const CensusCost& cost, int comparisons)
    {
        const Size cells = prediction_->sources.size();
        const int maxDistance = 3 * 16 / prediction_->key.scale, offset = 6 * comparisons / 24;
        sources_ = prediction_->sources.clone();
        evidence_.assign(cells.area(), Evidence());
        for (int i = 0; i < cells.height; ++i)
            for (int j = 0; j < cells.width; ++j)
            {
                uchar& sources = sources_.at<uchar>(i, j);
                const int here = measured_.at<ushort>(2 * i, 2 * j), there = last_->disparity.at<ushort>(2 * i, 2 * j);
                const int where = isStill_ ? 0 : movedToCell(change_, Point(j, i)) >> 4;
                const int distance = std::abs(there - where);
                if ((sources & hdp::MOVED_PLACE) && (distance <= 16 || distance > maxDistance))
                    sources = hdp::MOVED_PLACE;
                const bool hasUnmoved = (sources & hdp::SAME_PLACE) && std::abs(there - here) > 16;
                const bool hasMoved = (sources & hdp::MOVED_PLACE) && std::abs(where - here) > 16;
                Evidence& e = evidence_[i * cells.width + j];
                for (int k = 0; k < 2; ++k)
                {
                    const Point p(2 * j + k, 2 * i + k);
                    const int own = costOf(cost, comparisons, p, measured_.at<ushort>(p));
                    if (hasUnmoved)
                        e.unmoved += costOf(cost, comparisons, p, last_->disparity.at<ushort>(p)) - own;
                    if (hasMoved)
                        e.moved += costOf(cost, comparisons, p, where) - own;
                    e.scaleUnmoved += hasUnmoved ? own + offset : 0;
                    e.scaleMoved += hasMoved ? own + offset : 0;
                }
            }
    }

    //! Half of the comparisons differ where the right image does not show the match.
    static int costOf(const CensusCost& cost, int comparisons, Point p, int disparity)
    {
        const int candidate = (disparity + 8) / 16;
        return candidate > p.x ? comparisons / 2 : cost(p.y, p.x, candidate);
    }

    Evidence around(Point cell) const
    {
        Evidence sum = Evidence();
        for (int y = std::max(cell.y - 3, 0); y <= std::min(cell.y + 3, sources_.rows - 1); ++y)
            for (int x = std::max(cell.x - 3, 0); x <= std::min(cell.x + 3, sources_.cols - 1); ++x)
            {
                const Evidence& e = evidence_[y * sources_.cols + x];
                sum.unmoved += e.unmoved;
                sum.moved += e.moved;
                sum.scaleUnmoved += e.scaleUnmoved;
                sum.scaleMoved += e.scaleMoved;
            }
        return sum;
    }

    //! One of the last frame may cost more than the measured one by a share of its costs, in percent. One at the same
    //! place must not cost more than where the motion leads.
    int choiceOf(Point cell, int unmovedShare, int movedShare) const
    {
        const Evidence e = around(cell);
        const int sources = sources_.at<uchar>(cell);
        const bool hasMoved = !isStill_ && (sources & hdp::MOVED_PLACE);
        // In a share, 128 says that what disagrees is taken, too.
        const int kept = hdp::KEPT;
        if ((sources & hdp::SAME_PLACE) && !(hasMoved && e.unmoved > e.moved) &&
            100 * e.unmoved <= unmovedShare % 128 * e.scaleUnmoved)
            return hdp::UNMOVED + (unmovedShare >= 128 ? kept : 0);
        if (hasMoved && 100 * e.moved <= movedShare % 128 * e.scaleMoved)
            return hdp::MOVED + (movedShare >= 128 ? kept : 0);
        return hdp::MEASURED;
    }

    //! What a disparity of the last frame may cost more: if the camera stands still, if the disparity is within two
    //! pixels of the image from the measured one, and if not, by the frames that have agreed with it
    int shareOf(Point cell, int taken, int count) const
    {
        const int distance = std::abs(taken - measured_.at<ushort>(2 * cell));
        const bool isNear = distance <= std::max(32 / prediction_->key.scale, 1);
        return isStill_ ? 128 + 26 : !isNear ? 128 + 10 * std::max(count - 1, 0) : count > 1 ? 60 : 33;
    }

    //! How many frames a disparity of the last frame counts for
    int countOf(Point from) const { return last_->detail.at<uchar>(from) % 8; }

    //! Whether no right image has shown its match
    bool isGuess(Point from) const { return last_->detail.at<uchar>(from) / 8 % 2 == 1; }

    bool isUnseen(int x, int y) const { return (measured_.at<ushort>(y, x) + 8) / 16 > x; }

    //! Returns whether more than 30 percent of the cells that have a source contradict it.
    bool choose()
    {
        choices_.create(sources_.size(), CV_8U);
        int all = 0, contradicting = 0;
        for (int y = 0; y < sources_.rows; ++y)
            for (int x = 0; x < sources_.cols; ++x)
            {
                const bool hasSource = sources_.at<uchar>(y, x) != 0;
                all += hasSource;
                contradicting += hasSource && choiceOf(Point(x, y), isStill_ ? 26 : 33, 33) == hdp::MEASURED;
                const Point cell(x, y);
                const int unmoved = last_->disparity.at<ushort>(2 * cell);
                const int moved = isStill_ ? 0 : movedToCell(change_, cell) >> 4;
                const int unmovedCount = countOf(2 * cell);
                const int movedCount = isStill_ ? 0 : countOf(movedFrom(prediction_->warp, 2 * x, 2 * y));
                choices_.at<uchar>(y, x) =
                    (uchar)choiceOf(cell, shareOf(cell, unmoved, unmovedCount), shareOf(cell, moved, movedCount));
            }
        return 100 * contradicting > 30 * all;
    }

    int choiceAt(int x, int y) const
    {
        const int choice = choices_.at<uchar>(std::min(y / 2, choices_.rows - 1), std::min(x / 2, choices_.cols - 1));
        return choice % 4 == hdp::MOVED && !isKnown(prediction_->warp, x, y) ? +hdp::MEASURED : choice;
    }

    //! What the last frame has at a place: the disparity in 1 / 256 pixel, and how many frames that stands for
    void take(Point from, int& finer, int& count) const
    {
        finer = 16 * last_->disparity.at<ushort>(from) + last_->detail.at<uchar>(from) / 16 - 8;
        count = countOf(from);
    }

    //! The same where the motion leads
    void takeMoved(int x, int y, int& finer, int& count) const
    {
        take(movedFrom(prediction_->warp, x, y), finer, count);
        finer = changedBy(change_, finer, x, y);
    }

    int tolerance() const { return 256 * std::max(2 / prediction_->key.scale, 1); }

    bool agreesMoved(int x, int y) const
    {
        if (x < 0 || x >= measured_.cols || choiceAt(x, y) % 4 != hdp::MOVED)
            return false;
        int finer, count;
        takeMoved(x, y, finer, count);
        return std::abs(16 * measured_.at<ushort>(y, x) - finer) <= tolerance();
    }

    void join(int x, int y)
    {
        int choice = choiceAt(x, y) % 4;
        if (choice == hdp::MOVED && !agreesMoved(x, y))
            for (int u = x - 2; u <= x + 2; ++u) // the fringe of a surface
                choice = agreesMoved(u, y) ? hdp::MEASURED : choice;
        const int here = 16 * measured_.at<ushort>(y, x);
        int there = 0, count = 0;
        bool wasGuess = false;
        if (choice == hdp::UNMOVED)
        {
            take(Point(x, y), there, count);
            wasGuess = isGuess(Point(x, y));
        }
        else if (choice == hdp::MOVED)
        {
            takeMoved(x, y, there, count);
            wasGuess = isGuess(movedFrom(prediction_->warp, x, y));
            if (wasGuess && !isUnseen(x, y)) // comes into sight
                count = 0;
        }
        const int guess = isUnseen(x, y) ? 8 : 0, guessAgain = wasGuess ? guess : 0;
        if (count == 0)
            return set(x, y, here, 1 + guess);
        if (std::abs(here - there) > tolerance())
            return choiceAt(x, y) >= hdp::KEPT ? set(x, y, there, count - 1 + guessAgain) : set(x, y, here, 1 + guess);
        const int weight = std::min(count, isStill_ ? 4 : 1);
        const double step = std::max(std::min(here - there, 256), -256) / (weight + 1.);
        set(x, y, there + (int)std::floor(step + 0.5), std::min(count + 1, 7) + guessAgain);
    }

    void set(int x, int y, int finer, int count)
    {
        disparity.at<ushort>(y, x) = (ushort)((finer + 8) / 16);
        detail.at<uchar>(y, x) = (uchar)((finer + 8) % 16 * 16 + count);
    }

    const hdp::FrameMemory* last_;
    const hdp::FramePrediction* prediction_;
    Mat measured_, sources_, choices_;
    hdp::DisparityChange change_;
    std::vector<Evidence> evidence_; // of each cell
    bool isStill_;
};

}} // namespace opencv_test::oracle

#endif
