// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "camera_motion.hpp"

#include "../base/robust_fit.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef MotionTracking T;

const int halfSide = T::side / 2;
const Point nowhere(-1, -1);

// Of a motion: the rows of X, Y and W, but for the 1 that is the last of W
const int terms = 11;
typedef Matx<double, terms, 1> Terms;
typedef Matx<double, terms, terms> NormalMatrix;

//! Whether the square around a pixel, and another pixel on each side, are in the image
bool isInside(const Mat& image, Point at)
{
    return at.x > halfSide && at.y > halfSide && at.x + halfSide < image.cols && at.y + halfSide < image.rows;
}

//! Sum of absolute differences of the squares around two pixels
int difference(const Mat& before, Point from, const Mat& now, Point to)
{
    int sum = 0;
    for (int dy = -halfSide; dy < halfSide; ++dy)
    {
        const uchar* a = before.ptr(from.y + dy) + from.x - halfSide;
        const uchar* b = now.ptr(to.y + dy) + to.x - halfSide;
        for (int k = 0; k < T::side; ++k)
            sum += std::abs(a[k] - b[k]);
    }
    return sum;
}

//! Sum of absolute differences from a pixel to the next, in the direction that has less
int texture(const Mat& image, Point at)
{
    int sumX = 0, sumY = 0;
    for (int y = at.y - halfSide; y < at.y + halfSide; ++y)
    {
        const uchar *row = image.ptr(y), *above = image.ptr(y - 1);
        for (int x = at.x - halfSide; x < at.x + halfSide; ++x)
        {
            sumX += std::abs(row[x] - row[x - 1]);
            sumY += std::abs(row[x] - above[x]);
        }
    }
    return std::min(sumX, sumY);
}

//! The pixel with the least difference, among those at most radius pixels away from a guess
Point search(const Mat& before, Point from, const Mat& now, Point guess, int radius)
{
    Point best = nowhere;
    int least = INT_MAX;
    for (int y = guess.y - radius; y <= guess.y + radius; ++y)
        for (int x = guess.x - radius; x <= guess.x + radius; ++x)
        {
            const Point to(x, y);
            const int sum = isInside(now, to) ? difference(before, from, now, to) : INT_MAX;
            if (sum < least)
            {
                least = sum;
                best = to;
            }
        }
    return best;
}

//! Where a parabola through three successive sums has its minimum
double parabolaOffset(int before, int middle, int after)
{
    const int curvature = before - 2 * middle + after;
    return curvature > 0 ? std::max(-0.5, std::min(0.5, 0.5 * (before - after) / curvature)) : 0;
}

//! From a match in whole pixels of the finest level
Point2d refine(const Mat& before, Point from, const Mat& now, Point match)
{
    const auto sum = [&](int dx, int dy) {
        const Point to = match + Point(dx, dy);
        return isInside(now, to) ? difference(before, from, now, to) : INT_MAX / 4;
    };
    const int middle = sum(0, 0);
    return Point2d(match.x + parabolaOffset(sum(-1, 0), middle, sum(1, 0)),
                   match.y + parabolaOffset(sum(0, -1), middle, sum(0, 1)));
}

//! Of four places in a square of the grid on the coarsest level, the one with the most texture on the finest
Point choosePlace(const std::vector<Mat>& before, Point corner)
{
    const int top = (int)before.size() - 1;
    Point chosen = nowhere;
    int most = T::minTexture * T::side * T::side - 1;
    for (int k = 0; k < 4; ++k)
    {
        const Point place = corner + Point(k % 2, k / 2) * (T::spacing / 2);
        const Point fine(place.x << top, place.y << top);
        if (!isInside(before[top], place) || !isInside(before[0], fine))
            continue;
        const int there = texture(before[0], fine);
        if (there > most)
        {
            most = there;
            chosen = place;
        }
    }
    return chosen;
}

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

double squaredError(const Matx44d& forward, const TrackedPoint& point)
{
    const Vec4d p = forward * Vec4d(point.before.x, point.before.y, point.disparity, 1);
    if (p[3] <= 0)
        return DBL_MAX;
    const double dx = p[0] / p[3] - point.now.x, dy = p[1] / p[3] - point.now.y;
    return dx * dx + dy * dy;
}

double medianSquaredError(const Matx44d& forward, const std::vector<TrackedPoint>& points)
{
    std::vector<double> errors;
    for (const TrackedPoint& point : points)
        errors.push_back(squaredError(forward, point));
    return medianOf(errors);
}

} // namespace

int trackingLevels(int width)
{
    int levels = 1;
    while (width >> (levels - 1) > T::coarsestWidth)
        ++levels;
    return levels;
}

void choosePoints(const std::vector<Mat>& before, std::vector<TrackedPoint>& points)
{
    const int top = (int)before.size() - 1;
    const Size grid(before[top].cols / T::spacing, before[top].rows / T::spacing);
    std::vector<Point> places(grid.area());
    parallel_for_(Range(0, grid.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < grid.width; ++x)
                places[y * grid.width + x] = choosePlace(before, Point(x, y) * T::spacing);
    });
    points.clear();
    for (const Point& place : places)
        if (place != nowhere)
        {
            TrackedPoint point;
            point.before = point.now = place * (1 << top);
            point.disparity = 0;
            points.push_back(point);
        }
}

void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now, std::vector<TrackedPoint>& points)
{
    const int top = (int)before.size() - 1;
    parallel_for_(Range(0, (int)points.size()), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
        {
            const Point from = points[i].before, coarse(from.x >> top, from.y >> top);
            Point match = search(before[top], coarse, now[top], coarse, T::searchRadius);
            for (int level = top - 1; level >= 0 && match != nowhere; --level)
                match = search(before[level], Point(from.x >> level, from.y >> level), now[level], 2 * match,
                               T::refinementRadius);
            points[i].now = match != nowhere ? refine(before[0], from, now[0], match) : points[i].before;
        }
    });
}

void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now, const CameraMotion& motion,
                 std::vector<TrackedPoint>& points)
{
    const int coarse = std::min(1, (int)before.size() - 1);
    parallel_for_(Range(0, (int)points.size()), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
        {
            TrackedPoint& point = points[i];
            point.now = point.before;
            const Vec4d p = motion.forward * Vec4d(point.before.x, point.before.y, point.disparity, 1);
            if (!(p[0] >= 0 && p[1] >= 0 && p[0] < p[3] * now[0].cols && p[1] < p[3] * now[0].rows))
                continue;
            const Point from = point.before, half(from.x >> coarse, from.y >> coarse);
            Point match(cvFloor(p[0] / p[3] + 0.5), cvFloor(p[1] / p[3] + 0.5));
            if (isInside(before[coarse], half))
                match = (1 << coarse) * search(before[coarse], half, now[coarse],
                                               Point(match.x >> coarse, match.y >> coarse), T::refinementRadius);
            match = search(before[0], from, now[0], match, T::refinementRadius);
            if (match != nowhere)
                point.now = refine(before[0], from, now[0], match);
        }
    });
}

CameraMotion fitMotion(const std::vector<TrackedPoint>& points, Size size, double tolerance)
{
    CameraMotion motion;
    if ((int)points.size() < T::minPoints)
        return motion;
    // Numbers of about the same size in all equations
    const double unit = size.width / 2., disparityUnit = unit / 6;
    const Point2d centre(size.width / 2., size.height / 2.);
    std::vector<TrackedPoint> normed(points);
    for (TrackedPoint& point : normed)
    {
        point.before = (point.before - centre) * (1 / unit);
        point.now = (point.now - centre) * (1 / unit);
        point.disparity /= disparityUnit;
    }

    Terms none = Terms::zeros();
    none(0) = none(5) = 1;
    const double inertia = 1e-5 * points.size(); // decides what the points leave open
    const double leastTolerance = 0.25;          // in pixels
    std::vector<double> weights(points.size(), 1.);
    Matx44d forward = Matx44d::eye();
    for (int rounds = T::fittingRounds; rounds > 0; rounds -= tolerance == leastTolerance)
    {
        NormalMatrix a = inertia * NormalMatrix::eye();
        Terms b = inertia * none;
        for (size_t i = 0; i < normed.size(); ++i)
            addEquations(normed[i], weights[i], a, b);
        forward = matrixOf(a.solve(b, DECOMP_CHOLESKY));
        const double scale = tolerance / unit;
        for (size_t i = 0; i < normed.size(); ++i)
            weights[i] = 1 / (1 + squaredError(forward, normed[i]) / (scale * scale));
        tolerance = std::max(tolerance * 0.6, leastTolerance);
    }

    // Things that move by themselves may look as if the camera did, but most points tell whether it is at rest.
    const double moved = std::sqrt(medianSquaredError(forward, normed)) * unit;
    const double still = std::sqrt(medianSquaredError(Matx44d::eye(), normed)) * unit;
    motion.error = still;
    if (!(still > 1.25 * moved + 0.05))
        return motion;
    motion.error = moved;
    const Matx44d toNormed(1 / unit, 0, 0, -centre.x / unit, 0, 1 / unit, 0, -centre.y / unit, 0, 0, 1 / disparityUnit,
                           0, 0, 0, 0, 1);
    const Matx44d toPixels(unit, 0, 0, centre.x, 0, unit, 0, centre.y, 0, 0, disparityUnit, 0, 0, 0, 0, 1);
    motion.forward = toPixels * forward * toNormed;
    motion.isStill = false;
    return motion;
}

CameraMotion scaled(const CameraMotion& motion, double scale)
{
    // The centre of the first pixel is 0: that of a larger one is (scale - 1) / 2 beside it.
    const double shift = (scale - 1) / 2;
    const Matx44d up(scale, 0, 0, shift, 0, scale, 0, shift, 0, 0, scale, 0, 0, 0, 0, 1);
    const double back = 1 / scale;
    const Matx44d down(back, 0, 0, -shift * back, 0, back, 0, -shift * back, 0, 0, back, 0, 0, 0, 0, 1);
    CameraMotion result = motion;
    result.error *= scale;
    if (!motion.isStill)
        result.forward = up * motion.forward * down;
    return result;
}

void correctChange(const std::vector<float>& predicted, const std::vector<float>& measured, DisparityChange& change)
{
    const double deviation = 0.15;                        // of a measured disparity
    const FitPrior<2> none = { Vec2d(), Vec2d(1, 0.02) }; // of the offset, and of the factor's difference from 1
    std::vector<FitSample<2>> samples(predicted.size());
    for (size_t i = 0; i < samples.size(); ++i)
    {
        const FitSample<2> sample = { Vec2d(1, predicted[i] + change.minDisparity), measured[i] - predicted[i],
                                      deviation };
        samples[i] = sample;
    }
    if (samples.empty())
        return;
    const Vec2d fit = fitRobustly(samples, none, Vec2d()).coefficients;
    const float factor = (float)(1 + fit[1]);
    change.offset = (float)fit[0];
    change.ofX *= factor;
    change.ofY *= factor;
    change.constant *= factor;
}

BackwardMotion::BackwardMotion(const CameraMotion& motion, double minDisparity, double largest)
{
    const Matx44d inverse = motion.forward.inv();
    const Matx44d ofMap = inverse * Matx44d(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, minDisparity, 0, 0, 0, 1);
    for (int i = 0; i < 4; ++i)
    {
        x_[i] = (float)ofMap(0, i);
        y_[i] = (float)ofMap(1, i);
        w_[i] = (float)ofMap(3, i);
    }
    const DisparityChange change = {
        (float)inverse(3, 0), (float)inverse(3, 1), (float)inverse(3, 2), (float)inverse(3, 3), 0.f,
        (float)minDisparity,  (float)largest
    };
    change_ = change;
}

}}} // namespace cv::stereo::hdp
