// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "map_filters.hpp"

#include "surface_smoothing.simd.hpp"
#include "map/surface_smoothing.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

const double leastNoise = 0.5; // grey levels: less is below their rounding
HDP_TUNABLE(int, mostWeight, 64, "noise^-2",
            "of a pixel beside another: more helps surfaces with little texture, less keeps details");

// Distances of the nearest and of the farthest pairs of both rounds
constexpr int first[] = { 1, 3 };
constexpr int timesFarther = 1 << (SmoothingPairs::count - 1);
constexpr int last[] = { timesFarther * first[0], timesFarther* first[1] };
constexpr int frame = last[1];

// Rows that are smoothed at once, in memory that stays in the caches: fewer compute those between stripes more often
const int stripe = 128;

HDP_DISPATCH(squareSlopes)
HDP_DISPATCH(precisionRow)
HDP_DISPATCH(smoothRow)

//! A stripe of a map, and what its rows depend on: memory of a thread
class SmoothingStripe
{
public:
    SmoothingStripe(const Mat& levels, const SlopeScale& scale, int mostDifference, const Mat& disparity)
        : levels_(levels), disparity_(disparity), scale_(scale), mostDifference_(mostDifference),
          squares_(precisionSide * disparity.cols), sums_(disparity.cols + precisionSide)
    {
        const int rows = std::min(disparity.rows, stripe + 2 * (last[0] + last[1]));
        for (Mat& mat : framed_)
            mat = Mat(rows + 2 * frame, disparity.cols + 2 * frame, CV_16U, Scalar(0));
    }

    void smooth(const Range& rows, Mat& smoothed)
    {
        const Range second = grown(rows, last[1]), seen = grown(second, last[0]);
        const Rect inside(frame, frame, disparity_.cols, seen.size());
        framed_[0].rowRange(frame + seen.size(), framed_[0].rows).setTo(Scalar(0)); // of the stripe before
        precisions_ = framed_[0](inside);
        Mat rough = framed_[1](inside), smoother = framed_[2](inside);
        findPrecisions(seen);
        disparity_.rowRange(seen).copyTo(rough);
        const Range own = rows - seen.start, ofSecond = second - seen.start;
        pass(first[0], 1, Range(0, seen.size()), rough, smoother);
        pass(first[0], (ptrdiff_t)rough.step1(), ofSecond, smoother, rough);
        pass(first[1], 1, ofSecond, rough, smoother);
        pass(first[1], (ptrdiff_t)rough.step1(), own, smoother, rough);
        rough.rowRange(own).copyTo(smoothed.rowRange(rows));
    }

private:
    Range grown(const Range& rows, int by) const
    {
        return Range(std::max(rows.start - by, 0), std::min(rows.end + by, disparity_.rows));
    }

    void findPrecisions(const Range& rows)
    {
        const int width = disparity_.cols, radius = precisionSide / 2;
        for (int y = rows.start - radius; y < rows.end + radius; ++y)
        {
            ushort* const row = &squares_[(y + precisionSide) % precisionSide * width];
            dispatched::squareSlopes(levels_.ptr<ushort>(clamped(y, 0, levels_.rows - 1)), width, scale_, row);
            const int middle = y - radius;
            if (middle >= rows.start)
                dispatched::precisionRow(squares_.data(), width, sums_.data(), disparity_.ptr<ushort>(middle),
                                         precisions_.ptr<ushort>(middle - rows.start));
        }
    }

    void pass(int distance, ptrdiff_t step, const Range& rows, const Mat& from, Mat& to) const
    {
        SmoothingPairs pairs;
        pairs.step = step * distance;
        pairs.like = (ushort)mostDifference_;
        for (ushort& limit : pairs.limits)
        {
            limit = (ushort)std::max(cvRound((double)mostWeight / (distance * distance)), 1);
            distance *= 2;
        }
        for (int y = rows.start; y < rows.end; ++y)
            dispatched::smoothRow(from.ptr<ushort>(y), precisions_.ptr<ushort>(y), from.cols, pairs, to.ptr<ushort>(y));
    }

    const Mat &levels_, &disparity_;
    SlopeScale scale_;
    int mostDifference_;
    std::vector<ushort> squares_, sums_;
    Mat framed_[3];  // precisions and two maps, in a frame of zeros: what is beyond the map has no weight
    Mat precisions_; // without it
};

} // namespace

void smoothSurfaces(const Mat& levels, double noise, int mostDifference, const Mat& disparity, Mat& smoothed)
{
    const int rows = disparity.rows;
    // The difference of the pixels beside one is twice the slope: so much of it is counted as one.
    const double change = 2. * greyScale * std::max(noise, +leastNoise) / SlopeScale::perNoise;
    const SlopeScale scale = { saturate_cast<ushort>(cvFloor(SlopeScale::most * change)),
                               saturate_cast<ushort>(cvFloor(256 / change)) };
    smoothed.create(disparity.size(), CV_16U);
    parallel_for_(Range(0, (rows + stripe - 1) / stripe), [&](const Range& range) {
        SmoothingStripe own(levels, scale, mostDifference, disparity);
        for (int i = range.start; i < range.end; ++i)
            own.smooth(Range(i * stripe, std::min((i + 1) * stripe, rows)), smoothed);
    });
}

}}} // namespace cv::stereo::hdp
