// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "point_tracker.hpp"

#include "../base/fits.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxCoarsestWidth, 160, "pixels",
            "of the level that a search begins at: on a larger one it reaches less far, on a smaller one points merge");
HDP_TUNABLE(
    int, halfSide, 4, "pixels of any level",
    "half of the squares that are compared, and between points: smaller have more rivals, larger see two surfaces");
HDP_TUNABLE(int, searchRadius, 8, "pixels of that level",
            "there, of points that are not nearby: more costs time and finds rivals");
// Pixels of the level, of all other searches: 1 is what the level before rounds away, and 1 is for its errors
const int refinementRadius = 2;
HDP_TUNABLE(int, minTexture, 3, "grey levels from a pixel to the next",
            "in both directions, on average over a square: in less, noise is tracked");

//! Whether the square around a pixel, and another pixel on each side, are in the image
bool isInside(const Mat& image, Point at)
{
    return at.x > halfSide && at.y > halfSide && at.x + halfSide < image.cols && at.y + halfSide < image.rows;
}

//! Sum of absolute differences of the squares around two pixels
int difference(const Mat& before, Point from, const Mat& now, Point to)
{
    const int side = 2 * halfSide;
    int sum = 0;
    for (int dy = -halfSide; dy < halfSide; ++dy)
    {
        const uchar* a = before.ptr(from.y + dy) + from.x - halfSide;
        const uchar* b = now.ptr(to.y + dy) + to.x - halfSide;
        for (int k = 0; k < side; ++k)
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

Point onLevel(Point place, int level) { return Point(place.x >> level, place.y >> level); }

//! The pixel of a level with the minimum of the difference, among those up to radius pixels away from a guess
Point search(const std::vector<Mat>& before, const std::vector<Mat>& now, int level, Point place, Point guess,
             int radius)
{
    const Point from = onLevel(place, level);
    Point best = nowhere;
    int minSum = INT_MAX;
    for (int y = guess.y - radius; y <= guess.y + radius; ++y)
        for (int x = guess.x - radius; x <= guess.x + radius; ++x)
        {
            const Point to(x, y);
            const int sum = isInside(now[level], to) ? difference(before[level], from, now[level], to) : INT_MAX;
            if (sum < minSum)
            {
                minSum = sum;
                best = to;
            }
        }
    return best;
}

//! From a match in whole pixels of the finest level
Point2d refine(const Mat& before, Point from, const Mat& now, Point match)
{
    const auto sum = [&](int dx, int dy) {
        const Point to = match + Point(dx, dy);
        return isInside(now, to) ? difference(before, from, now, to) : INT_MAX / 4;
    };
    const double middle = sum(0, 0);
    return Point2d(match.x + parabolaOffset<double>(sum(-1, 0), middle, sum(1, 0)),
                   match.y + parabolaOffset<double>(sum(0, -1), middle, sum(0, 1)));
}

} // namespace

std::vector<Point> bestPixels(Size grid, int cell, int step, double minScore,
                              const std::function<double(const Point&)>& score)
{
    std::vector<Point> best(grid.area(), nowhere);
    parallelFor(grid.area(), [&](int i) {
        const Point first(i % grid.width * cell, i / grid.width * cell);
        double highest = minScore;
        for (int y = 0; y < cell; y += step)
            for (int x = 0; x < cell; x += step)
            {
                const Point pixel = first + Point(x, y);
                const double own = score(pixel);
                if (own <= highest)
                    continue;
                highest = own;
                best[i] = pixel;
            }
    });
    best.erase(std::remove(best.begin(), best.end(), nowhere), best.end());
    return best;
}

int trackingLevels(Size size)
{
    int levels = 1;
    while (size.width >> (levels - 1) > maxCoarsestWidth && size.height >> levels > 0)
        ++levels;
    return levels;
}

void choosePoints(const std::vector<Mat>& before, std::vector<TrackedPoint>& points)
{
    const int top = (int)before.size() - 1, cell = halfSide << top, minSum = 4 * minTexture * halfSide * halfSide;
    const Size grid(before[top].cols / halfSide, before[top].rows / halfSide);
    const auto score = [&](const Point& place) {
        const bool isTracked = isInside(before[top], onLevel(place, top)) && isInside(before[0], place);
        return isTracked ? texture(before[0], place) : 0;
    };
    points.clear();
    for (const Point& place : bestPixels(grid, cell, cell / 2, minSum - 1, score))
        points.push_back({ place, place, 0 });
}

void trackPoints(const std::vector<Mat>& before, const std::vector<Mat>& now, TrackingStart start,
                 std::vector<TrackedPoint>& points)
{
    const bool isNearby = start == FROM_GUESS;
    const int top = (int)before.size() - 1, first = isNearby ? std::min(1, top) : top;
    parallelFor((int)points.size(), [&](int i) {
        TrackedPoint& point = points[i];
        const Point from = point.before;
        const Point2d guess = isNearby ? point.now : point.before;
        Point match(cvFloor(guess.x + 0.5), cvFloor(guess.y + 0.5));
        for (int level = first; level >= 0; --level)
            if (match.x >= 0 && isInside(before[level], onLevel(from, level)))
            {
                const int radius = !isNearby && level == top ? +searchRadius : +refinementRadius;
                match = (1 << level) * search(before, now, level, from, onLevel(match, level), radius);
            }
        point.now = match.x >= 0 ? refine(before[0], from, now[0], match) : point.before;
    });
}

}}} // namespace cv::stereo::hdp
