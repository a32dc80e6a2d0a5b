// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "row_alignment.hpp"

#include "image_levels.hpp"
#include "../base/fits.hpp"
#include "../base/vectorized.hpp"

#include <cfloat>
#include <cmath>
#include <limits>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, trackedArea, 600000, "pixels", "of the finest layer that is looked at: finer ones tell no more");
HDP_TUNABLE(double, ownDeviation, 0.02, "pixels of the layer", "of a match's row, beside what its window says of it");
HDP_TUNABLE(
    double, slopeDeviation, 2e-3, "rows per pixel",
    "cameras are turned by a tenth of a degree; yaw changes a slope from border to border by as much, lenses and "
    "pitch by half of it");

// What moves rows by less costs more by interpolation than it gains.
HDP_TUNABLE(double, minMove, 0.12, "pixels", "root of the mean square of a model that is applied");

typedef RowModel::Coefficients Coefficients;

typedef FitSample<RowModel::terms> RowMove; // of a match, in pixels of the image
typedef RobustFit<RowModel::terms> RowFit;

//! Places are in pixels of a layer.
Point2d fromCentre(double x, double y, int layer, Size size)
{
    const double scale = 1 << layer;
    return Point2d((x + 0.5) * scale - 0.5 * size.width, (y + 0.5) * scale - 0.5 * size.height);
}

std::vector<RowMove> toMoves(const std::vector<CornerMatch>& matches, int layer, Size size)
{
    const double scale = 1 << layer;
    std::vector<RowMove> moves;
    for (const CornerMatch& match : matches)
        if (match.isValid)
            moves.push_back({ RowModel::basis(fromCentre(match.x, match.left.y, layer, size)),
                              (match.y - match.left.y) * scale,
                              std::sqrt(match.variance + ownDeviation * ownDeviation) * scale });
    return moves;
}

RowFit fitRows(const std::vector<RowMove>& moves, Size size)
{
    const double keystone = slopeDeviation / size.width;
    FitPrior<RowModel::terms> prior;
    prior.deviations = Coefficients(size.height, slopeDeviation, slopeDeviation, keystone, keystone / 2);
    const double offset = medianOf(moves, [](const RowMove& move) { return move.value; });
    return fitRobustly(moves, prior, Coefficients(offset));
}

//! Standard deviation of the noise of a layer. White noise is assumed; half of it is left between pixels of the right
//! window, where interpolation averages it.
double noiseOf(const Mat& left, const Mat& right, const std::vector<CornerMatch>& matches)
{
    std::vector<double> differences;
    for (const CornerMatch& match : matches)
        if (match.isValid)
            differences.push_back(quietDifference(left, right, match));
    const size_t tenth = differences.size() / 10;
    std::nth_element(differences.begin(), differences.begin() + tenth, differences.end());
    return std::sqrt(differences[tenth] / 1.5);
}

//! Means over the image
struct MeanSquares
{
    double move, deviation; // of the model
};

MeanSquares meanSquares(const RowFit& fit, Size size)
{
    const int side = 8;
    MeanSquares means = { 0, 0 };
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
        {
            const Point2d place(((j + 0.5) / side - 0.5) * size.width, ((i + 0.5) / side - 0.5) * size.height);
            const Coefficients basis = RowModel::basis(place);
            const double value = fit.coefficients.dot(basis);
            means.move += value * value / (side * side);
            means.deviation += basis.dot(fit.covariance * basis) / (side * side);
        }
    return means;
}

double maxMoveAtCorners(const RowModel& model, Size size)
{
    double max = 0;
    for (int i = 0; i < 4; ++i)
        max = std::max(max, std::abs(model.at(Point2d((i % 2 - 0.5) * size.width, (i / 2 - 0.5) * size.height))));
    return max;
}

//! The matches of a layer where they are to be tracked in the next finer one: rows are those of the model.
void enterFinerLayer(const RowModel& model, int layer, Size size, std::vector<CornerMatch>& matches)
{
    for (CornerMatch& match : matches)
    {
        const double move = model.at(fromCentre(match.x, match.left.y, layer, size)) / (1 << (layer - 1));
        match.left *= 2;
        match.x *= 2;
        match.y = match.left.y + move;
    }
}

const int fractionBits = 6, fractions = 1 << fractionBits; // of a row

int64 wholeOf(double value) { return (int64)std::floor(value + 0.5); }

//! Weights of four rows, in 1/1024, at a place between the second and the third (Catmull and Rom)
void cubicWeights(double t, int weights[4])
{
    weights[0] = cvRound(512 * (-t + 2 * t * t - t * t * t));
    weights[2] = cvRound(512 * (t + 4 * t * t - 3 * t * t * t));
    weights[3] = cvRound(512 * (t * t * t - t * t));
    weights[1] = 1024 - weights[0] - weights[2] - weights[3];
}

//! The columns of a row that come from the same place between the rows of the other image
template <typename T> void mixColumns(const Mat& right, int row, const int weights[4], Range columns, T* aligned)
{
    const T* rows[4];
    for (int i = 0; i < 4; ++i)
        rows[i] = right.ptr<T>(clamped(row - 1 + i, 0, right.rows - 1));
    const T *const a = rows[0], *const b = rows[1], *const c = rows[2], *const d = rows[3];
    const int wa = weights[0], wb = weights[1], wc = weights[2], wd = weights[3];
    const int largest = std::numeric_limits<T>::max(), end = columns.end * right.channels();
    HDP_VECTORIZED for (int x = columns.start * right.channels(); x < end; ++x)
    {
        const int sum = (wa * a[x] + wb * b[x] + wc * c[x] + wd * d[x] + 512) >> 10;
        aligned[x] = (T)(sum < 0 ? 0 : sum > largest ? largest : sum);
    }
}

//! A row of the model is a straight line: columns come in runs from the same place, in a tile those of the whole image.
template <typename T>
void alignRow(const Mat& right, const RowModel& model, const ImageFrame& frame, int y, const int weights[][4],
              T* aligned)
{
    const int placeBits = 24;
    const int64 one = (int64)1 << placeBits; // a place, which is a fraction of a row
    const int row = y + frame.origin.y, width = frame.whole.width;
    const double first = row + model.at(fromCentre(0, row, 0, frame.whole));
    const double last = row + model.at(fromCentre(width, row, 0, frame.whole));
    const int64 step = wholeOf((last - first) / width * fractions * one);
    const int64 start =
        wholeOf(first * fractions * one) + one / 2 + frame.origin.x * step - frame.origin.y * fractions * one;
    for (int begin = 0, end; begin < right.cols; begin = end)
    {
        const int64 position = start + begin * step, within = position & (one - 1);
        const int64 run = step > 0 ? (one - within + step - 1) / step : step < 0 ? within / -step + 1 : right.cols;
        end = (int)std::min<int64>(begin + run, right.cols);
        const int place = (int)(position >> placeBits);
        mixColumns(right, place >> fractionBits, weights[place & (fractions - 1)], Range(begin, end), aligned);
    }
}

} // namespace

double LayerNoise::ofLayer(int other) const
{
    return std::ldexp(deviation, layer - other); // white noise halves from a layer to the next
}

void estimateRows(const CoarseMatches& coarse, int finestLayer, int maxOffset, RowFindings& findings)
{
    findings = RowFindings();
    const Size size = coarse.left[0].size();
    while (finestLayer < coarse.layer && coarse.left[finestLayer].total() > (size_t)trackedArea)
        ++finestLayer;

    // Noise and other light may leave more to be seen on a coarse layer than on the image: the most certain fit counts.
    std::vector<CornerMatch> matches = coarse.matches, measured; // those of the last layer that tells
    RowModel best;
    MeanSquares ofBest = { 0, DBL_MAX };
    for (int layer = coarse.layer;; --layer)
    {
        const std::vector<RowMove> moves = toMoves(matches, layer, size);
        if ((int)moves.size() < CornerMatching::minMatches)
            break;
        const RowFit fit = fitRows(moves, size);
        const MeanSquares ofFit = meanSquares(fit, size);
        const RowModel fitted(fit.coefficients);
        const auto distance = [&](const RowMove& move) { return move.distanceFrom(fit.coefficients); };
        const double deviation = deviationOfMedian * medianOf(moves, distance), own = ownDeviation * (1 << layer);
        findings.rowError = std::sqrt(deviation * deviation + own * own); // not by std::hypot(), either
        findings.noise.layer = layer;
        measured = matches;
        if (ofFit.deviation < ofBest.deviation)
        {
            ofBest = ofFit;
            best = fitted;
        }
        if (layer <= finestLayer)
            break;
        enterFinerLayer(fitted, layer, size, matches);
        trackCornerMatches(coarse.left[layer - 1], coarse.right[layer - 1], matches);
    }
    const int layer = findings.noise.layer;
    if (!measured.empty())
        findings.noise.deviation = noiseOf(coarse.left[layer], coarse.right[layer], measured) / greyScale;
    if (ofBest.deviation == DBL_MAX || maxMoveAtCorners(best, size) > maxOffset)
        return;
    findings.rows = best;
    findings.hasRows = ofBest.move > minMove * minMove;
}

void alignRows(const Mat& right, const RowModel& model, const ImageFrame& frame, Mat& aligned)
{
    int weights[fractions][4];
    for (int i = 0; i < fractions; ++i)
        cubicWeights((double)i / fractions, weights[i]);
    aligned.create(right.size(), right.type());
    parallelForRows(right.size(), [&](int y) {
        if (right.depth() == CV_8U)
            alignRow(right, model, frame, y, weights, aligned.ptr(y));
        else
            alignRow(right, model, frame, y, weights, aligned.ptr<ushort>(y));
    });
}

}}} // namespace cv::stereo::hdp
