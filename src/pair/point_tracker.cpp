// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "point_tracker.hpp"

#include "../base/parabola.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef PointTracking T;

const int halfSide = T::side / 2;

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

//! The pixel with the minimum of the difference, among those up to radius pixels away from a guess
Point search(const Mat& before, Point from, const Mat& now, Point guess, int radius)
{
    Point best = nowhere;
    int minSum = INT_MAX;
    for (int y = guess.y - radius; y <= guess.y + radius; ++y)
        for (int x = guess.x - radius; x <= guess.x + radius; ++x)
        {
            const Point to(x, y);
            const int sum = isInside(now, to) ? difference(before, from, now, to) : INT_MAX;
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

//! The texture of pixels of the finest level that can be tracked from the coarsest one on, of others none
struct Texture
{
    explicit Texture(const std::vector<Mat>& pyramid) : image(pyramid) {}
    void enterRow(int row) { y = row; }
    double operator()(int x) const
    {
        const int top = (int)image.size() - 1;
        const bool isTracked = isInside(image[top], Point(x >> top, y >> top)) && isInside(image[0], Point(x, y));
        return isTracked ? texture(image[0], Point(x, y)) : 0;
    }
    const std::vector<Mat>& image;
    int y = 0;
};

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
    const int top = (int)before.size() - 1, cell = T::spacing << top, minTexture = T::minTexture * T::side * T::side;
    const Size grid(before[top].cols / T::spacing, before[top].rows / T::spacing);
    std::vector<Point> places;
    bestOfCells(grid, cell, cell / 2, minTexture - 1, Texture(before), places);
    points.clear();
    for (const Point& place : places)
        if (place != nowhere)
        {
            TrackedPoint point;
            point.before = point.now = place;
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

void trackNearby(const std::vector<Mat>& before, const std::vector<Mat>& now, std::vector<TrackedPoint>& points)
{
    const int coarse = std::min(1, (int)before.size() - 1);
    parallel_for_(Range(0, (int)points.size()), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
        {
            TrackedPoint& point = points[i];
            const Point from = point.before, half(from.x >> coarse, from.y >> coarse);
            Point match(cvFloor(point.now.x + 0.5), cvFloor(point.now.y + 0.5));
            point.now = point.before;
            if (match == nowhere)
                continue;
            if (isInside(before[coarse], half))
                match = (1 << coarse) * search(before[coarse], half, now[coarse],
                                               Point(match.x >> coarse, match.y >> coarse), T::refinementRadius);
            match = search(before[0], from, now[0], match, T::refinementRadius);
            if (match != nowhere)
                point.now = refine(before[0], from, now[0], match);
        }
    });
}

}}} // namespace cv::stereo::hdp
