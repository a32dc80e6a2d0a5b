// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_confidence.hpp"
#include "disparity_confidence.simd.hpp"
#include "map/disparity_confidence.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "../base/tunable.hpp"
#include "left_right_check.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef DisparityConfidence Constants;

HDP_TUNABLE(int, visibleMaxDiff, 1, "pixels",
            "in the left-right check: 0 fails by rounding, more passes what the right image does not show");
HDP_TUNABLE(int, maxUpper, 8, "pixels",
            "that a difference from the layer above counts as: few pixels do not decide for a window");
HDP_TUNABLE(int, maxMedian, 4, "pixels", "the same of differences from the map before the median");
HDP_TUNABLE(int, costUnits, 512, "units",
            "per cost of 1 that other costs than the census are rounded to: sums are of whole numbers");
HDP_TUNABLE(int, stripeColumns, 64, "pixels", "of the distances in columns, for a thread: fewer share cache lines");
HDP_TUNABLE(int, stripeRows, 128, "rows",
            "of the rest, for a thread: fewer compute the rows between stripes more often");

int countStripes(int size, int stripe) { return (size + stripe - 1) / stripe; }

HDP_DISPATCH(distanceFromAbove)
HDP_DISPATCH(distanceFromBelow)
HDP_DISPATCH(squaredDistanceRow)
HDP_DISPATCH(censusCostRow)
HDP_DISPATCH(slideWindow)
HDP_DISPATCH(differenceCells)
HDP_DISPATCH(agreementRow)
HDP_DISPATCH(confidenceRow)

//! Distances to the nearest pixel at a step in the same column, at most farFromSteps, CV_8UC1.
void distancesInColumns(const Mat& disparity, Mat& distance)
{
    const int last = disparity.rows - 1;
    const Mat none(1, disparity.cols, CV_8U, Scalar(Constants::farFromSteps));
    distance.create(disparity.size(), CV_8U);
    parallel_for_(Range(0, countStripes(disparity.cols, stripeColumns)), [&](const Range& stripes) {
        const Range columns(stripes.start * stripeColumns, std::min(stripes.end * stripeColumns, disparity.cols));
        for (int y = 0; y <= last; ++y)
            dispatched::distanceFromAbove(disparity.ptr<ushort>(std::max(y - 1, 0)), disparity.ptr<ushort>(y),
                                          disparity.ptr<ushort>(std::min(y + 1, last)), disparity.cols, columns,
                                          y > 0 ? distance.ptr(y - 1) : none.ptr(), distance.ptr(y));
        for (int y = last - 1; y >= 0; --y)
            dispatched::distanceFromBelow(distance.ptr(y + 1), columns, distance.ptr(y));
    });
}

/** Sums of the differences between two maps over windows of cells of 2 x 2 pixels, CV_32SC1, one per cell.
@param map A disparity map.
@param other Another one of its size, or that of the layer above.
@param isUpper Whether it is that.
@param max What larger differences count as, in pixels.
@param window Side of the windows, in cells.
@param sums Receives the sums. */
void sumDifferences(const Mat& map, const Mat& other, bool isUpper, int max, int window, Mat& sums)
{
    const Size size((map.cols + 1) / 2, (map.rows + 1) / 2);
    Mat cells(size, CV_16U);
    parallel_for_(Range(0, size.height), [&](const Range& range) {
        for (int y = range.start; y < range.end; ++y)
        {
            const ushort *rows[2], *others[2];
            for (int i = 0; i < 2; ++i)
            {
                const int row = std::min(2 * y + i, map.rows - 1);
                rows[i] = map.ptr<ushort>(row);
                others[i] = other.ptr<ushort>(isUpper ? std::min(y, other.rows - 1) : row);
            }
            dispatched::differenceCells(rows, others, isUpper ? 2 : 1, map.cols, other.cols, max * subpixelScale,
                                        cells.ptr<ushort>(y));
        }
    });
    sums.create(size, CV_32S);
    parallel_for_(Range(0, countStripes(size.height, stripeRows)), [&](const Range& stripes) {
        const Range rows(stripes.start * stripeRows, std::min(stripes.end * stripeRows, size.height));
        Mat part = sums.rowRange(rows); // the filter finds the rows beside those of the cells
        boxFilter(cells.rowRange(rows), part, CV_32S, Size(window, window), Point(-1, -1), false, BORDER_REPLICATE);
    });
}

//! Twice the census costs of a row's disparities, and twice the means of those of their alternatives
class CensusAlternatives
{
public:
    typedef short Cost; // sums over a window are below 32768

    CensusAlternatives(const CensusCost& cost, const Mat& disparity, int numDisparities)
        : cost_(cost), disparity_(disparity), numDisparities_(numDisparities), scratch_(disparity.cols)
    {
    }

    void evaluate(int y, Cost* own, Cost* others)
    {
        const int planes = cost_.planes();
        const uchar* right[3];
        for (int plane = 0; plane < 3; ++plane)
            right[plane] = cost_.rightPlane(std::min(plane, planes - 1), y);
        dispatched::censusCostRow(cost_.leftPixels(y), right, planes, disparity_.ptr<ushort>(y), numDisparities_,
                                  disparity_.cols, scratch_, own, others);
    }

private:
    const CensusCost& cost_;
    const Mat& disparity_;
    int numDisparities_;
    CensusScratch scratch_;
};

//! The same of any cost, in 1 / costUnits
class CostAlternatives
{
public:
    typedef int Cost;

    CostAlternatives(const MatchingCost& cost, const Mat& disparity, int numDisparities)
        : cost_(cost), disparity_(disparity), numDisparities_(numDisparities), pixels_(disparity.cols),
          costs_((size_t)disparity.cols * lanes)
    {
    }

    void evaluate(int y, Cost* own, Cost* others)
    {
        const int width = disparity_.cols;
        const ushort* disparity = disparity_.ptr<ushort>(y);
        for (int x = 0; x < width; ++x)
            pixels_[x] = y * width + x;
        for (int start = 0, end; start < width; start = end) // pixels of one winner
        {
            const int winner = wholeDisparity(disparity[start]), first = std::max(winner - Constants::alternative, 0);
            for (end = start + 1; end < width && wholeDisparity(disparity[end]) == winner;)
                ++end;
            cost_.evaluate(&pixels_[start], end - start, first, lanes, costs_.data());
            const Alternatives<int> alternatives(winner, numDisparities_ - 1);
            for (int x = start; x < end; ++x)
            {
                const float* costs = &costs_[(size_t)(x - start) * lanes];
                own[x] = 2 * units(costs[winner - first]);
                others[x] = units(costs[alternatives.before - first]) + units(costs[alternatives.after - first]);
            }
        }
    }

private:
    enum
    {
        lanes = 8
    };

    static int units(float cost) { return cvRound(cost * costUnits); }

    const MatchingCost& cost_;
    const Mat& disparity_;
    int numDisparities_;
    std::vector<int> pixels_;
    std::vector<float> costs_;
};

template <typename Costs, typename CostOfLayer>
void computeConfidence(const ConfidenceMaps& maps, int numDisparities, const CostOfLayer& cost, Mat& confidence)
{
    typedef typename Costs::Cost Cost;
    const Mat& disparity = maps.disparity;
    const int width = disparity.cols, window = Constants::window, radius = window / 2, far = Constants::farFromSteps;
    Mat distance, visible, fromUpper, byMedian;
    distancesInColumns(disparity, distance);
    sumDifferences(disparity, maps.unfiltered, false, maxMedian, Constants::medianWindow, byMedian);
    if (maps.upper.empty())
        fromUpper = Mat::zeros(byMedian.size(), CV_32S);
    else
        sumDifferences(disparity, maps.upper, true, maxUpper, Constants::upperWindow, fromUpper);
    findStable(disparity, visibleMaxDiff, visible);
    for (int y = 0; y < visible.rows && !cost.limits().isEmpty(); ++y)
        cost.limits().hideUnmatched(y, disparity.ptr<ushort>(y), visible.ptr(y));
    confidence.create(disparity.size(), CV_8U);
    parallel_for_(Range(0, countStripes(disparity.rows, stripeRows)), [&](const Range& stripes) {
        Costs costs(cost, disparity, numDisparities);
        // Rows of the costs of disparities and of their alternatives: what enters a window, what is in it, and its sums
        Mat_<Cost> entering(2, width), kept(2 * window, width, Cost(0)), sums(2, width + 2 * radius, Cost(0));
        std::vector<Cost> groups(2 * (width + window));
        std::vector<short> padded(width + 2 * far + vectorMargin), squares(width);
        std::vector<float> factors(width + vectorMargin), agreement(width + 1);
        const Range rows(stripes.start * stripeRows, std::min(stripes.end * stripeRows, disparity.rows));
        for (int y = rows.start - radius, slot = 0; y < rows.end + radius; ++y, slot = (slot + 1) % window)
        {
            costs.evaluate(std::min(std::max(y, 0), disparity.rows - 1), entering[0], entering[1]);
            for (int i = 0; i < 2; ++i)
            {
                Cost* row = sums[i] + radius;
                dispatched::slideWindow(entering[i], width, kept[2 * slot + i], row);
                std::fill(row - radius, row, row[0]);
                std::fill(row + width, row + width + radius, row[width - 1]);
            }
            const int centre = y - radius;
            if (centre < rows.start)
                continue; // the first window is not complete
            dispatched::squaredDistanceRow(distance.ptr(centre), width, &padded[far], squares.data());
            dispatched::agreementRow(fromUpper.ptr<int>(centre / 2), byMedian.ptr<int>(centre / 2), width,
                                     agreement.data());
            dispatched::confidenceRow(sums[0], sums[1], squares.data(), visible.ptr(centre), agreement.data(), width,
                                      groups.data(), factors.data(), confidence.ptr(centre));
        }
    });
}

} // namespace

void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const CensusCost& cost, Mat& confidence)
{
    computeConfidence<CensusAlternatives>(maps, numDisparities, cost, confidence);
}

void disparityConfidence(const ConfidenceMaps& maps, int numDisparities, const MatchingCost& cost, Mat& confidence)
{
    computeConfidence<CostAlternatives>(maps, numDisparities, cost, confidence);
}

}}} // namespace cv::stereo::hdp
