// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "camera_motion.hpp"

#include "../base/fits.hpp"

#include <cmath>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, inertia, 1e-5, "weight of a point, for each of them",
            "that the camera is at rest: decides what the points leave open, more pulls motions to 0");
HDP_TUNABLE(double, disparityUnits, 6, "per half width of the image",
            "units of disparity: usual ones are as large, and so are all numbers in the equations");

// A first guess
HDP_TUNABLE(int, guesses, 60, "samples of points", "of which the best is taken: more cost time, fewer are all wrong");
HDP_TUNABLE(double, goodGuess, 0.7, "share of the points", "that agree with a guess which is good enough");

// Reweighted least squares
HDP_TUNABLE(double, minTolerance, 0.25, "pixels", "of the last round, at least: tracked points are as exact");
HDP_TUNABLE(double, toleranceFall, 0.6, "factor from a round to the next",
            "less loses points before the motion is near them, more costs rounds");

// The median error at rest has to be larger than that of a motion.
HDP_TUNABLE(double, motionFactor, 1.25, "errors of the motion",
            "less takes things that move by themselves for the camera, more overlooks slow cameras");

// Corrected disparities
HDP_TUNABLE(double, measuredDeviation, 0.15, "pixels",
            "of a measured disparity: more lets outliers pull, less takes noise for them");
HDP_TUNABLE(double, factorDeviation, 0.02, "difference from 1", "expected of the factor: motions are estimates");

// What a motion has: the rows of X, Y and W, but for the 1 that is the last of W
const int terms = 11;
const int guessPoints = terms / 2 + 2; // of a sample: fewer leave terms open, more are less often all right
typedef Matx<double, terms, 1> Terms;
typedef Matx<double, terms, terms> NormalMatrix;

Matx44d matrixOf(const Terms& t)
{
    return Matx44d(t(0), t(1), t(2), t(3), t(4), t(5), t(6), t(7), 0, 0, 1, 0, t(8), t(9), t(10), 1);
}

//! Adds the equations of a point: X = x' W and Y = y' W. Of the matrix it is the lower half, which Cholesky's method
//! reads.
void addEquations(const TrackedPoint& point, double weight, NormalMatrix& a, Terms& b)
{
    const int used = 7; // of the terms, by each equation
    static const int indices[2][used] = { { 0, 1, 2, 3, 8, 9, 10 }, { 4, 5, 6, 7, 8, 9, 10 } };
    const double p[] = { point.before.x, point.before.y, point.disparity, 1 };
    const double values[] = { point.now.x, point.now.y };
    for (int r = 0; r < 2; ++r)
    {
        const double row[used] = { p[0], p[1], p[2], p[3], -values[r] * p[0], -values[r] * p[1], -values[r] * p[2] };
        for (int i = 0; i < used; ++i)
        {
            const double weighted = weight * row[i];
            b(indices[r][i]) += weighted * values[r];
            for (int j = 0; j <= i; ++j)
                a(indices[r][i], indices[r][j]) += weighted * row[j];
        }
    }
}

Vec4d moved(const Matx44d& forward, const TrackedPoint& point)
{
    return forward * Vec4d(point.before.x, point.before.y, point.disparity, 1);
}

//! x and y become scale times as large and get an offset.
Matx44d enlarging(double scale, double offsetX, double offsetY, double disparityScale)
{
    return Matx44d(scale, 0, 0, offsetX, 0, scale, 0, offsetY, 0, 0, disparityScale, 0, 0, 0, 0, 1);
}

double squaredError(const Matx44d& forward, const TrackedPoint& point)
{
    const Vec4d p = moved(forward, point);
    if (p[3] <= 0)
        return DBL_MAX;
    const double dx = p[0] / p[3] - point.now.x, dy = p[1] / p[3] - point.now.y;
    return dx * dx + dy * dy;
}

//! The motion that fits best to these points, each of its weight, and to a camera at rest
Terms solve(const std::vector<TrackedPoint>& points, const std::vector<double>& weights)
{
    const double rest = inertia * points.size();
    NormalMatrix a = rest * NormalMatrix::eye();
    Terms b = Terms::zeros();
    a(0, 0) = a(5, 5) = b(0) = b(5) = (double)points.size(); // cameras keep their focal length
    for (size_t i = 0; i < points.size(); ++i)
        addEquations(points[i], weights[i], a, b);
    return a.solve(b, DECOMP_CHOLESKY);
}

//! What each point weighs if this is the motion; half of it at a distance of scale
void weigh(const Matx44d& forward, const std::vector<TrackedPoint>& points, double scale, std::vector<double>& weights)
{
    weights.resize(points.size());
    for (size_t i = 0; i < points.size(); ++i)
        weights[i] = 1 / (1 + squaredError(forward, points[i]) / (scale * scale));
}

//! RANSAC: of no motion, and of those that random samples of a few points have, takes the one that most points agree
//! with. Returns the weights of all points for it.
std::vector<double> weightsOfBestGuess(const std::vector<TrackedPoint>& points, double scale)
{
    RNG rng(points.size()); // the same points give the same motion
    std::vector<double> best, weights;
    const std::vector<double> equal(guessPoints, 1.);
    std::vector<TrackedPoint> sample(guessPoints);
    double bestAgreement = -1;
    for (int i = 0; i < guesses && bestAgreement < goodGuess * points.size(); ++i)
    {
        for (TrackedPoint& point : sample)
            point = points[rng.uniform(0, (int)points.size())];
        weigh(i == 0 ? Matx44d::eye() : matrixOf(solve(sample, equal)), points, scale, weights);
        const double agreement = std::accumulate(weights.begin(), weights.end(), 0.);
        if (agreement > bestAgreement)
        {
            bestAgreement = agreement;
            swap(best, weights);
        }
    }
    return best;
}

double medianSquaredError(const Matx44d& forward, const std::vector<TrackedPoint>& points)
{
    return medianOf(points, [&](const TrackedPoint& point) { return squaredError(forward, point); });
}

} // namespace

void movePoints(const CameraMotion& motion, Size size, std::vector<TrackedPoint>& points)
{
    for (TrackedPoint& point : points)
    {
        const Vec4d p = moved(motion.forward, point);
        const bool isInside = p[0] >= 0 && p[1] >= 0 && p[0] < p[3] * size.width && p[1] < p[3] * size.height;
        point.now = isInside ? Point2d(p[0] / p[3], p[1] / p[3]) : Point2d(nowhere);
    }
}

CameraMotion fitMotion(const std::vector<TrackedPoint>& points, Size size, double tolerance)
{
    CameraMotion motion;
    if ((int)points.size() < CameraMotion::minPoints)
        return motion;
    // Numbers of about the same size in all equations
    const double unit = size.width / 2., disparityUnit = unit / disparityUnits;
    const Point2d centre(size.width / 2., size.height / 2.);
    std::vector<TrackedPoint> normed(points);
    for (TrackedPoint& point : normed)
    {
        point.before = (point.before - centre) * (1 / unit);
        point.now = (point.now - centre) * (1 / unit);
        point.disparity /= disparityUnit;
    }

    std::vector<double> weights = weightsOfBestGuess(normed, tolerance / unit);
    Matx44d forward = Matx44d::eye();
    for (; tolerance > minTolerance; tolerance *= toleranceFall)
    {
        forward = matrixOf(solve(normed, weights));
        weigh(forward, normed, tolerance / unit, weights);
    }

    // Things that move by themselves may look as if the camera did, but most points tell whether it is at rest.
    const double error = std::sqrt(medianSquaredError(forward, normed)) * unit;
    const double errorAtRest = std::sqrt(medianSquaredError(Matx44d::eye(), normed)) * unit;
    motion.error = errorAtRest;
    if (!(errorAtRest > motionFactor * error)) // also if one of them is NaN
        return motion;
    motion.error = error;
    const Matx44d toNormed = enlarging(1 / unit, -centre.x / unit, -centre.y / unit, 1 / disparityUnit);
    motion.forward = enlarging(unit, centre.x, centre.y, disparityUnit) * forward * toNormed;
    motion.isStill = false;
    return motion;
}

CameraMotion scaled(const CameraMotion& motion, double scale)
{
    // The centre of the first pixel is 0: that of a larger one is (scale - 1) / 2 beside it.
    const double shift = (scale - 1) / 2, back = 1 / scale;
    CameraMotion result = motion;
    result.error *= scale;
    if (!motion.isStill)
        result.forward = enlarging(scale, shift, shift, scale) * motion.forward *
                         enlarging(back, -shift * back, -shift * back, back);
    return result;
}

DisparityChange correctedChange(const DisparityChange& change, const std::vector<float>& predicted,
                                const std::vector<float>& measured)
{
    const FitPrior<2> none = { Vec2d(), Vec2d(1, factorDeviation) }; // cameras shake by a pixel
    std::vector<FitSample<2>> samples(predicted.size());
    for (size_t i = 0; i < samples.size(); ++i)
        samples[i] = { Vec2d(1, predicted[i] + change.minDisparity), measured[i] - predicted[i], measuredDeviation };
    if (samples.empty())
        return change;
    const Vec2d fit = fitRobustly(samples, none, Vec2d()).coefficients;
    const float factor = (float)(1 + fit[1]);
    DisparityChange corrected = change;
    corrected.offset = (float)fit[0];
    corrected.ofX *= factor;
    corrected.ofY *= factor;
    corrected.constant *= factor;
    return corrected;
}

BackwardMotion::BackwardMotion(const CameraMotion& motion, double minDisparity, double maxDisparity)
{
    const Matx44d inverse = motion.forward.inv();
    const Matx44d ofMap = inverse * Matx44d(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, minDisparity, 0, 0, 0, 1);
    for (int i = 0; i < 4; ++i)
    {
        x[i] = (float)ofMap(0, i);
        y[i] = (float)ofMap(1, i);
        w[i] = (float)ofMap(3, i);
    }
    change = { (float)inverse(3, 0), (float)inverse(3, 1), (float)inverse(3, 2), (float)inverse(3, 3), 0.f,
               (float)minDisparity,  (float)maxDisparity };
}

}}} // namespace cv::stereo::hdp
