// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "corner_matches.hpp"
#include "corner_matches.simd.hpp"
#include "pair/corner_matches.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/fits.hpp"
#include "image_pyramid.hpp"
#include "point_tracker.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

// Corners
HDP_TUNABLE(int, minSpacing, 10, "pixels of the image",
            "side of a cell of the usual layer: nearer windows see the same");
HDP_TUNABLE(int, maxCorners, 500, "corners", "one per cell of a grid: more cost time, fewer miss what is small");
HDP_TUNABLE(int, cornerStep, 2, "pixels", "from one that is looked at to the next: neighbours are about as good");
HDP_TUNABLE(int, maxCoarseArea, 45000, "pixels", "of the coarse layer: more cost time, fewer have too few corners");

// Search on the coarse layer
HDP_TUNABLE(double, minCorrelation, 0.8, "correlation", "of a match: less lets wrong ones in, more loses noisy images");
HDP_TUNABLE(double, rivalCorrelation, 0.1, "share of the best one's distance from 1",
            "by which a rival has to be farther from it: more loses repeated texture, less lets wrong ones in");
HDP_TUNABLE(double, rivalDistance, 0.01, "correlation", "beside that share: near 1, noise decides");
HDP_TUNABLE(int, rivalReach, 2, "pixels", "around the best match, in which there are no rivals: its own peak is there");
HDP_TUNABLE(double, moreMatches, 2, "times those of other rows",
            "that rows far away have to have: less believes a pattern that repeats itself");
HDP_TUNABLE(double, minContrast, 6, "levels of 1023", "standard deviation of a left window: in less, noise is matched");

// Tracking on a layer
HDP_TUNABLE(int, iterations, 3, "steps", "of Lucas and Kanade: more cost time, fewer do not arrive");
HDP_TUNABLE(double, maxMove, 2, "pixels", "of a match: one that goes farther has lost its corner");
HDP_TUNABLE(double, maxResidual, 0.5, "share of the left variance",
            "mean square difference: more lets wrong matches in, less loses noisy images");

HDP_TUNABLE(double, quietRow, 4, "times that of the quietest rows",
            "mean square difference of rows that tell the noise: less leaves out noise, more takes defects for it");

HDP_DISPATCH(structureTensors)
HDP_DISPATCH(windowSums)
HDP_DISPATCH(correlate)
HDP_DISPATCH(cutWindow)
HDP_DISPATCH(trackingSums)
HDP_DISPATCH(sumRows)

//! 255 where the windows around a pixel, and the pixels beside them that gradients need, have data, else 0: CV_8UC1,
//! empty for an empty mask
Mat windowsWithData(const Mat& mask)
{
    if (mask.empty())
        return Mat();
    Mat has = pixelsWithData(mask);
    const int width = CornerMatching::trackWidth + 3, height = CornerMatching::trackHeight + 2; // odd, both
    erode(has, has, Mat::ones(height, width, CV_8U), Point(-1, -1), 1, BORDER_REPLICATE);
    return has;
}

//! The best corner of every cell, by the smaller eigenvalue of the structure tensor. has: see windowsWithData()
void findCorners(const Mat& image, const Mat& has, int spacing, SearchWindows& windows,
                 std::vector<CornerMatch>& matches)
{
    const int margin = CornerMatching::searchSide / 2 + CornerMatching::searchRadius;
    const Rect inside(margin, margin, image.cols - 2 * margin, image.rows - 2 * margin);
    const int usual = std::max(cvCeil(std::sqrt((double)inside.area() / maxCorners)), spacing);
    const int cell = std::min(usual, std::min(inside.width, inside.height)); // a strip has one row of cells
    const Size grid(inside.width / cell, inside.height / cell);
    const int radius = CornerMatching::tensorSide / 2, width = inside.width;
    windows.tensors.create(inside.height, 3 * width, CV_32S);
    parallelFor(grid.height * cell, std::vector<int>(3 * image.cols), [&](int y, std::vector<int>& columns) {
        if (y % cell % cornerStep == 0)
            dispatched::structureTensors(image.ptr<ushort>(inside.y + y - radius) + inside.x - radius, image.step1(),
                                         width, columns.data(), windows.tensors.ptr<int>(y));
    });
    const auto score = [&](const Point& pixel) {
        if (!has.empty() && !has.at<uchar>(inside.tl() + pixel))
            return -1.;
        const int* const tensor = windows.tensors.ptr<int>(pixel.y) + pixel.x;
        const double xx = tensor[0], xy = tensor[width], yy = tensor[2 * width];
        const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
        return mean - std::sqrt(half * half + xy * xy);
    };
    matches.clear();
    for (const Point& corner : bestPixels(grid, cell, cornerStep, -1, score))
    {
        matches.push_back(CornerMatch());
        matches.back().left = inside.tl() + corner;
    }
}

//! Sums and scales of all search windows of an image
void measureWindows(const Mat& image, SearchWindows& windows)
{
    const int reach = CornerMatching::searchSide - 1, width = image.cols - reach, height = image.rows - reach;
    windows.sums.create(height, width, CV_32S);
    windows.scales.create(height, width, CV_32F);
    parallelFor(height, std::vector<int>(2 * image.cols), [&](int y, std::vector<int>& columns) {
        dispatched::windowSums(image.ptr<ushort>(y), image.step1(), width, columns.data(), windows.sums.ptr<int>(y),
                               windows.scales.ptr<float>(y));
    });
}

//! Whether all candidates are clearly worse than the best one, but for those beside it
bool isUnique(const std::vector<float>& values, int columns, int best)
{
    const double rival = 1 - (1 - values[best]) * (1 + rivalCorrelation) - rivalDistance;
    const auto isBeside = [&](int a, int b) { return std::abs(a - b) <= rivalReach; };
    for (int i = 0; i < (int)values.size(); ++i)
        if (values[i] > rival && !(isBeside(i % columns, best % columns) && isBeside(i / columns, best / columns)))
            return false;
    return true;
}

/** The windows that a corner's is compared with: those of the disparities, and of the rows around its own, moved by
rowOffset. Empty if these rows are beyond the image.
@param first The first pixel of the corner's window, as windows are told by theirs.
@param windows How many the right image has. */
Rect searchedWindows(const Point& first, const Range& disparities, int rowOffset, const Size& windows)
{
    const int minColumns = SearchArea::minColumns;
    const int endDisparity = std::max(disparities.end, disparities.start + minColumns);
    const int x = clamped(first.x + 1 - endDisparity, 0, windows.width - minColumns);
    const int end = std::min(first.x + 1 - disparities.start, windows.width);
    const Rect searched(x, first.y + rowOffset - CornerMatching::searchRadius, end - x, SearchArea::rows);
    return (searched & Rect(Point(), windows)) == searched ? searched : Rect();
}

/** Correlates the window of a corner with those of the right image.
@param correlations Receives them by rows, then by columns, of which there are at least SearchArea::minColumns; -1 in
those that are not searched.
@return The columns; 0 if the corner's window is bare. */
int correlateWindow(const Mat& left, const Mat& right, const SearchWindows& windows, const Point& first,
                    const Rect& searched, std::vector<float>& correlations)
{
    const int side = CornerMatching::searchSide, pixels = side * side;
    const ushort* const window = left.ptr<ushort>(first.y) + first.x;
    int memory[2 * CornerMatching::searchSide], sum;
    float scale;
    dispatched::windowSums(window, left.step1(), 1, memory, &sum, &scale);
    if (scale == 0 || scale * minContrast * pixels > 1)
        return 0;
    const int columns = std::max(searched.width, +SearchArea::minColumns), count = searched.height * columns;
    const SearchArea area = { right.ptr<ushort>(searched.y) + searched.x,
                              windows.sums.ptr<int>(searched.y) + searched.x,
                              windows.scales.ptr<float>(searched.y) + searched.x,
                              right.step1(),
                              windows.sums.step1(),
                              columns };
    correlations.resize(count);
    dispatched::correlate(window, left.step1(), sum, scale, area, correlations.data());
    for (int row = columns; row <= count; row += columns)
        std::fill(correlations.begin() + row - (columns - searched.width), correlations.begin() + row, -1.f);
    return columns;
}

/** Matches a corner by the highest correlation of its window, see searchedWindows(). There is no match if the window is
bare, if the correlation is low, if another place is nearly as good, or if nothing is searched.
@param correlations Memory for those of a corner. */
void findMatch(const Mat& left, const Mat& right, const SearchWindows& windows, const Range& disparities, int rowOffset,
               std::vector<float>& correlations, CornerMatch& match)
{
    match.isValid = false;
    const Point centre(CornerMatching::searchSide / 2, CornerMatching::searchSide / 2), first = match.left - centre;
    const Rect searched = searchedWindows(first, disparities, rowOffset, windows.sums.size());
    if (searched.empty())
        return;
    const int columns = correlateWindow(left, right, windows, first, searched, correlations);
    if (columns == 0)
        return;
    const int best = (int)(std::max_element(correlations.begin(), correlations.end()) - correlations.begin());
    if (correlations[best] < minCorrelation || !isUnique(correlations, columns, best))
        return;
    match.x = searched.x + best % columns + centre.x;
    match.y = searched.y + best / columns + centre.y;
    match.isValid = true;
}

const int fractionBits = CornerMatching::fractionBits, fractions = 1 << fractionBits;
const Point windowCentre(CornerMatching::trackWidth / 2, CornerMatching::trackHeight / 2);

//! The mean of (L - gain * R)^2 over n pixels, both without their means: 2 (variance - covariance), as the gain makes
//! their variances equal. Rounding may make it less than 0. Variance and covariance are n^2 times theirs.
double meanSquareDifference(double variance, double gain, double covariance, int n)
{
    return std::max(2 * (variance - gain * covariance) / ((double)n * n), 0.);
}

//! The same of rows; negative if one of both has no contrast
double meanSquareDifference(const RowSums& sums, int n)
{
    const double l = sums.l, r = sums.r, variance = (double)sums.ll * n - l * l, ofRight = (double)sums.rr * n - r * r;
    if (variance <= 0 || ofRight <= 0)
        return -1;
    return meanSquareDifference(variance, std::sqrt(variance / ofRight), (double)sums.lr * n - l * r, n);
}

//! The method of Lucas and Kanade: moves a window of the right image until it fits the left one, both of equal mean and
//! variance. Invalid if bare, lost, beyond the image, or unlike
void track(const Mat& left, const Mat& right, CornerMatch& match)
{
    match.isValid = false;
    const int width = CornerMatching::trackWidth, height = CornerMatching::trackHeight, n = TrackedWindow::pixels;
    const Point first = match.left - windowCentre;
    const Rect inside(1, 1, left.cols - 2, left.rows - 2); // has gradients
    if (!inside.contains(first) || !inside.contains(first + Point(width - 1, height - 1)))
        return;
    TrackedWindow window;
    dispatched::cutWindow(left.ptr<ushort>(first.y) + first.x, left.step1(), window);
    const TrackedWindow::Sums& sums = window.sums;
    const double sum = sums.l, sumX = sums.x, sumY = sums.y;
    const double productX = sums.lx - sumX * sum / n, productY = sums.ly - sumY * sum / n;
    const double variance = (double)sums.ll * n - sum * sum; // times n * n
    if (variance < minContrast * minContrast * n * n)
        return;
    // Gradients are over two pixels.
    const double xx = 0.25 * sums.xx, xy = 0.25 * sums.xy, yy = 0.25 * sums.yy;
    const double determinant = xx * yy - xy * xy;
    if (determinant <= 0)
        return;

    Point2d place(first.x + match.x - match.left.x, first.y + match.y - match.left.y);
    const Point2d start = place;
    double residual = 0;
    for (int iteration = 0;; ++iteration)
    {
        const int x = cvRound(place.x * fractions), y = cvRound(place.y * fractions);
        const Point whole(x >> fractionBits, y >> fractionBits);
        if (whole.x < 0 || whole.y < 0 || whole.x + width >= right.cols || whole.y + height >= right.rows)
            return;
        const RightSums other = dispatched::trackingSums(right.ptr<ushort>(whole.y) + whole.x, right.step1(),
                                                         x & (fractions - 1), y & (fractions - 1), window);
        const double rightVariance = (double)other.rr * n - (double)other.r * other.r;
        if (rightVariance <= 0)
            return;
        const double gain = std::sqrt(variance / rightVariance);
        residual = meanSquareDifference(variance, gain, (double)other.lr * n - sum * other.r, n);
        if (iteration == iterations)
            break;
        // Sums of the gradient times (gain * R - L), both without their means
        const double ex = 0.5 * (gain * (other.xr - sumX * other.r / n) - productX);
        const double ey = 0.5 * (gain * (other.yr - sumY * other.r / n) - productY);
        place.x = (double)x / fractions - (yy * ex - xy * ey) / determinant;
        place.y = (double)y / fractions - (xx * ey - xy * ex) / determinant;
        if (std::max(std::abs(place.x - start.x), std::abs(place.y - start.y)) > maxMove)
            return;
    }
    if (residual * n * n > maxResidual * variance)
        return;
    match.x = match.left.x + place.x - first.x;
    match.y = match.left.y + place.y - first.y;
    match.variance = residual * xx / determinant;
    match.residual = residual;
    match.isValid = true;
}

//! Finds the match of each corner. mask, windows: of the right image; rowOffset: see findMatch()
void matchCorners(const Mat& left, const Mat& right, const Mat& mask, const Range& disparities, int rowOffset,
                  const SearchWindows& windows, std::vector<CornerMatch>& matches)
{
    const Mat rightHas = windowsWithData(mask);
    parallelFor((int)matches.size(), std::vector<float>(), [&](int i, std::vector<float>& correlations) {
        CornerMatch& match = matches[i];
        findMatch(left, right, windows, disparities, rowOffset, correlations, match);
        if (match.isValid && !rightHas.empty())
            match.isValid = rightHas.ptr((int)match.y)[(int)match.x] != 0;
    });
}

//! Finds and tracks matches where rows may be off by more than findCornerMatches() sees: if there are too few for a
//! model, rows farther away are tried, below and above by turns. Their matches take the place of these if they are far
//! more.
void findMatchesOfRows(const Mat& left, const Mat& right, const PairMasks& masks, const Range& disparities, int spacing,
                       int maxRowOffset, SearchWindows& windows, std::vector<CornerMatch>& matches)
{
    const auto isValid = [](const CornerMatch& match) { return match.isValid; };
    const auto count = [&](const std::vector<CornerMatch>& all) {
        return std::count_if(all.begin(), all.end(), isValid);
    };
    findCornerMatches(left, right, masks, disparities, spacing, windows, matches);
    trackCornerMatches(left, right, matches);
    if (count(matches) >= moreMatches * CornerMatching::minMatches) // fewer may be by chance
        return;
    const int step = SearchArea::rows, farthest = std::min(maxRowOffset, left.rows / 8) + CornerMatching::searchRadius;
    std::vector<CornerMatch> others = matches; // of the same corners
    for (int offset = step; offset <= farthest; offset = offset > 0 ? -offset : step - offset)
    {
        matchCorners(left, right, masks.right, disparities, offset, windows, others);
        trackCornerMatches(left, right, others);
        if (count(others) >= std::max<double>(CornerMatching::minMatches, moreMatches * count(matches)))
            matches.swap(others);
    }
}

} // namespace

void findCornerMatches(const Mat& left, const Mat& right, const PairMasks& masks, const Range& disparities, int spacing,
                       SearchWindows& windows, std::vector<CornerMatch>& matches)
{
    findCorners(left, windowsWithData(masks.left), spacing, windows, matches);
    measureWindows(right, windows);
    matchCorners(left, right, masks.right, disparities, 0, windows, matches);
}

void keepMutualMatches(const Mat& left, const Mat& right, SearchWindows& windows, std::vector<CornerMatch>& matches)
{
    std::vector<double> offsets; // of rows
    for (const CornerMatch& match : matches)
        if (match.isValid)
            offsets.push_back(match.y - match.left.y);
    const int rowOffset = offsets.empty() ? 0 : cvRound(medianOf(offsets));
    measureWindows(left, windows);
    const int margin = CornerMatching::searchSide / 2;
    const Rect inside(margin, margin, right.cols - 2 * margin, right.rows - 2 * margin);
    const Range all(-left.cols, left.cols);
    parallelFor((int)matches.size(), std::vector<float>(), [&](int i, std::vector<float>& correlations) {
        CornerMatch& match = matches[i];
        CornerMatch back;
        if (!match.isValid)
            return;
        back.left = Point(cvRound(match.x), cvRound(match.y));
        match.isValid = inside.contains(back.left);
        if (!match.isValid)
            return;
        findMatch(right, left, windows, all, -rowOffset, correlations, back);
        match.isValid = back.isValid && std::abs(back.x - match.left.x) <= 1 && std::abs(back.y - match.left.y) <= 1;
    });
}

double quietDifference(const Mat& left, const Mat& right, const CornerMatch& match)
{
    const int count = CornerMatching::trackHeight, width = CornerMatching::trackWidth;
    const Point first = match.left - windowCentre;
    // Where it was tracked to, but for the rounding of its place
    const int x = clamped(cvRound((match.x - windowCentre.x) * fractions), 0, (right.cols - width) * fractions - 1);
    const int y = clamped(cvRound((match.y - windowCentre.y) * fractions), 0, (right.rows - count) * fractions - 1);
    TrackedWindow window;
    RowSums rows[CornerMatching::trackHeight], quiet = {};
    dispatched::cutWindow(left.ptr<ushort>(first.y) + first.x, left.step1(), window);
    dispatched::sumRows(right.ptr<ushort>(y >> fractionBits) + (x >> fractionBits), right.step1(), x & (fractions - 1),
                        y & (fractions - 1), window, rows);
    double differences[CornerMatching::trackHeight], sorted[CornerMatching::trackHeight];
    for (int i = 0; i < count; ++i)
        differences[i] = meanSquareDifference(rows[i], width);
    double* const end = std::remove_copy_if(differences, differences + count, sorted, [](double d) { return d < 0; });
    double* const sixth = sorted + (end - sorted) / 6; // some are by chance
    std::nth_element(sorted, sixth, end);
    const double most = end > sorted ? quietRow * *sixth : -1;
    int pixels = 0;
    for (int i = 0; i < count; ++i)
        if (differences[i] >= 0 && differences[i] <= most)
        {
            quiet = quiet + rows[i];
            pixels += width;
        }
    const double difference = meanSquareDifference(quiet, pixels);
    return difference < 0 ? match.residual : std::min(difference, match.residual);
}

void trackCornerMatches(const Mat& left, const Mat& right, std::vector<CornerMatch>& matches)
{
    parallelFor((int)matches.size(), [&](int i) {
        if (matches[i].isValid)
            track(left, right, matches[i]);
    });
}

void matchCoarsely(const std::vector<Mat>& left, const std::vector<Mat>& right, const PairMasks& masks,
                   const Range& disparities, int maxRowOffset, int finer, CoarseMatches& coarse)
{
    const Size size = left[0].size();
    int usualLayer = 0;
    while ((size.width >> usualLayer) * (size.height >> usualLayer) > maxCoarseArea)
        ++usualLayer;
    const int layer = std::max(usualLayer - finer, 0);
    coarse.layer = layer;
    coarse.matches.clear();
    buildPyramid(left, layer + 1, coarse.left);
    buildPyramid(right, layer + 1, coarse.right);
    const Mat &coarseLeft = coarse.left[layer], &coarseRight = coarse.right[layer];
    if (std::min(coarseLeft.rows, coarseLeft.cols) < 2 * (CornerMatching::searchSide + CornerMatching::searchRadius))
        return;
    const Range ofLayer(disparities.start >> layer, layerDisparities(disparities.end, layer, true));
    const PairMasks coarseMasks = { dataOfLayer(masks.left, layer), dataOfLayer(masks.right, layer) };
    const int halvings = std::max(usualLayer, finer); // small images have no finer layers: corners are nearer instead
    findMatchesOfRows(coarseLeft, coarseRight, coarseMasks, ofLayer, std::max(minSpacing >> halvings, 1),
                      maxRowOffset >> layer, coarse.windows, coarse.matches);
}

}}} // namespace cv::stereo::hdp
