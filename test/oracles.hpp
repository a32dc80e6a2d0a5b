// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_ORACLES_HPP
#define OPENCV_HDPSTEREO_TEST_ORACLES_HPP

// The stages of the method written down a second time, from the paper's formulas: slow, short and obviously right.
// Nothing here calls the library, except for the strategies' Rule 1 and 2 and the parameters of the prediction model.

#include "test_precomp.hpp"
#include "../src/cost/census_cost.hpp"
#include "../src/paper/color_gradient_cost.hpp"
#include "../src/map/disparity_confidence.hpp"
#include "../src/forest/disparity_forest.hpp"
#include "../src/paper/disparity_prediction.hpp"
#include "../src/scanlines/scanline_aggregation.hpp"
#include "../src/scanlines/range_scanlines.hpp"
#include "../src/scanlines/volume_scanlines.hpp"

namespace opencv_test { namespace oracle {

inline int clamped(int i, int size) { return std::max(0, std::min(i, size - 1)); }

//! Whether a pixel of the right image has no data, but is not before the place where its row begins
inline bool isMissing(const hdp::PairMasks& masks, Point p)
{
    const auto first = [&](const Mat& mask) {
        int x = 0;
        while (x < mask.cols && mask.at<uchar>(p.y, x) < 128)
            ++x;
        return x;
    };
    const int right = first(masks.right);
    const bool isBefore = p.x < right && right - first(masks.left) <= masks.left.cols / 8;
    return masks.right.at<uchar>(p) < 128 && !isBefore;
}

//! Grey levels in 8 bit
inline Mat grey(const Mat& image)
{
    Mat result = image;
    if (image.channels() == 3)
        cv::cvtColor(image, result, COLOR_BGR2GRAY);
    return result;
}

//! Grey levels that are not rounded
inline Mat_<double> exactGrey(const Mat& image)
{
    Mat_<double> result(image.size());
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
        {
            const uchar* pixel = image.ptr(y) + x * image.channels();
            result(y, x) = image.channels() == 1 ? pixel[0] : 0.114 * pixel[0] + 0.587 * pixel[1] + 0.299 * pixel[2];
        }
    return result;
}

//! Section 2.1: the mean of 2 x 2 pixels, truncated (8 bit) or rounded (16 bit); floor(size / 2).
template <typename T> Mat halve(const Mat& image, double rounding)
{
    const int channels = image.channels();
    Mat half(image.rows / 2, image.cols / 2, image.type());
    for (int y = 0; y < half.rows; ++y)
        for (int x = 0; x < half.cols; ++x)
            for (int c = 0; c < channels; ++c)
            {
                double sum = 0;
                for (int dy = 0; dy < 2; ++dy)
                    for (int dx = 0; dx < 2; ++dx)
                        sum += image.ptr<T>(2 * y + dy)[(2 * x + dx) * channels + c];
                half.ptr<T>(y)[x * channels + c] = (T)std::floor(sum / 4 + rounding);
            }
    return half;
}

inline Mat halve(const Mat& image)
{
    return image.depth() == CV_16U ? halve<ushort>(image, 0.5) : halve<uchar>(image, 0);
}

//! The number of bits in use, see hdp::bitsInUse(). left, right: CV_16UC1.
inline int bitsInUse(const Mat& left, const Mat& right)
{
    std::vector<ushort> pixels(left.begin<ushort>(), left.end<ushort>());
    pixels.insert(pixels.end(), right.begin<ushort>(), right.end<ushort>());
    std::sort(pixels.begin(), pixels.end());
    const int brightest = pixels[pixels.size() - 1 - pixels.size() / 1024];
    int bits = 8;
    while (brightest >= 1 << bits)
        ++bits;
    return bits;
}

//! Grey levels in quarters of a level, rounded
inline Mat greyLevels(const Mat& image)
{
    const Mat_<double> exact = exactGrey(image);
    Mat result(image.size(), CV_16U);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            result.at<ushort>(y, x) = (ushort)std::floor(4 * exact(y, x) + 0.5);
    return result;
}

//! Section 3.3: M(p, x), averaged over a window; rows and columns clamped to the images.
class ColorGradientCost
{
public:
    ColorGradientCost(const Mat& left, const Mat& right, const hdp::ColorGradientParams& params)
        : left_(left), right_(right), leftGrey_(exactGrey(left)), rightGrey_(exactGrey(right)), params_(params)
    {
    }

    double operator()(int y, int x, int disparity) const
    {
        const int radius = params_.blockSize / 2;
        double sum = 0;
        for (int dy = -radius; dy <= radius; ++dy)
            for (int dx = -radius; dx <= radius; ++dx)
                sum += ofPixel(clamped(y + dy, left_.rows), clamped(x + dx, left_.cols),
                               clamped(x + dx - disparity, left_.cols));
        return sum / (params_.blockSize * params_.blockSize);
    }

private:
    double ofPixel(int y, int x, int matched) const
    {
        const int channels = left_.channels();
        double color = 0;
        for (int c = 0; c < channels; ++c)
            color += std::abs(left_.ptr(y)[x * channels + c] - right_.ptr(y)[matched * channels + c]);
        color /= channels;
        const double gradients = std::abs(gradient(leftGrey_, y, x) - gradient(rightGrey_, y, matched));
        return params_.colorWeight * std::min(color, (double)params_.colorTruncation) +
               (1. - params_.colorWeight) * std::min(gradients, (double)params_.gradientTruncation);
    }

    //! Central difference; at the borders one-sided and stronger, by a factor that fits the authors' disparity maps.
    static double gradient(const Mat_<double>& levels, int y, int x)
    {
        const double* row = levels[y];
        const int last = levels.cols - 1;
        if (last == 0)
            return 0;
        const double borderGain = 4;
        if (x == 0)
            return borderGain * (row[1] - row[0]);
        if (x == last)
            return borderGain * (row[last] - row[last - 1]);
        return (row[x + 1] - row[x - 1]) / 2.;
    }

    Mat left_, right_;
    Mat_<double> leftGrey_, rightGrey_;
    hdp::ColorGradientParams params_;
};

//! The census cost of images of grey levels, CV_16UC1: the pixels of the window's checkerboard that are darker than its
//! centre by more than the tolerance in one of the images only; rows and columns clamped to the images.
class CensusCost
{
public:
    CensusCost(const Mat& left, const Mat& right, int blockSize, int tolerance = 0)
        : left_(left), right_(right), radius_(blockSize / 2), tolerance_(tolerance)
    {
    }

    int operator()(int y, int x, int disparity) const { return count(y, x, disparity, 0, 1); }

    //! Of each pixel of the checkerboard whose number has this remainder when divided by planes
    int count(int y, int x, int disparity, int plane, int planes) const
    {
        const int matched = clamped(x - disparity, left_.cols);
        int count = 0, number = 0;
        for (int dy = -radius_; dy <= radius_; ++dy)
            for (int dx = -radius_; dx <= radius_; ++dx)
                if (std::abs(dx) % 2 != std::abs(dy) % 2 && number++ % planes == plane)
                    count += isDarker(left_, y, x, dy, dx) != isDarker(right_, y, matched, dy, dx);
        return count;
    }

private:
    bool isDarker(const Mat& image, int y, int x, int dy, int dx) const
    {
        const int other = image.at<ushort>(clamped(y + dy, image.rows), clamped(x + dx, image.cols));
        return image.at<ushort>(y, x) - other > tolerance_;
    }

    Mat left_, right_;
    int radius_, tolerance_;
};

//! ELAS's support points by direct search.
class SupportPoints
{
public:
    SupportPoints(const Mat& left, const Mat& right, int numDisparities) : numDisparities_(numDisparities)
    {
        grey_[0] = grey(left);
        grey_[1] = grey(right);
    }

    //! CV_16SC1: the disparity of every 4th pixel or -1
    Mat find() const
    {
        const int rows = grey_[0].rows, cols = grey_[0].cols;
        Mat grid((rows + 3) / 4, (cols + 3) / 4, CV_16SC1, Scalar(-1));
        for (int i = 0; i < grid.rows; ++i)
            for (int j = 0; j < grid.cols; ++j)
            {
                const int d = bestDisparity(0, 4 * j, 4 * i);
                if (d < 0)
                    continue;
                const int back = bestDisparity(1, 4 * j - d, 4 * i);
                if (back >= 0 && std::abs(d - back) <= 2)
                    grid.at<short>(i, j) = (short)d;
            }

        Mat points = grid.clone();
        for (int i = 0; i < grid.rows; ++i)
            for (int j = 0; j < grid.cols; ++j)
                if (grid.at<short>(i, j) >= 0 && countSupporters(grid, i, j) < 4)
                    points.at<short>(i, j) = -1;
        return points;
    }

private:
    static int countSupporters(const Mat& grid, int i, int j)
    {
        int count = 0;
        for (int y = std::max(i - 4, 0); y <= std::min(i + 4, grid.rows - 1); ++y)
            for (int x = std::max(j - 4, 0); x <= std::min(j + 4, grid.cols - 1); ++x)
                if (grid.at<short>(y, x) >= 0 && std::abs(grid.at<short>(y, x) - grid.at<short>(i, j)) <= 4)
                    ++count;
        return count;
    }

    //! Sobel over 3 x 3 pixels along x or y, in 8 bit around 128
    int gradient(int view, int u, int v, bool alongX) const
    {
        int sum = 0;
        for (int i = -1; i <= 1; ++i)
        {
            const int weight = i == 0 ? 2 : 1;
            const Mat& image = grey_[view];
            sum += weight * (alongX ? image.at<uchar>(v + i, u + 1) - image.at<uchar>(v + i, u - 1)
                                    : image.at<uchar>(v + 1, u + i) - image.at<uchar>(v - 1, u + i));
        }
        return saturate_cast<uchar>(cvFloor(sum / 4.) + 128);
    }

    std::vector<int> descriptor(int view, int u, int v) const
    {
        static const int alongX[12][2] = { { 0, -2 }, { -2, -1 }, { 0, -1 }, { 2, -1 }, { -1, 0 }, { 0, 0 },
                                           { 0, 0 },  { 1, 0 },   { -2, 1 }, { 0, 1 },  { 2, 1 },  { 0, 2 } };
        static const int alongY[4][2] = { { 0, -1 }, { -1, 0 }, { 1, 0 }, { 0, 1 } };
        std::vector<int> result;
        for (int i = 0; i < 12; ++i)
            result.push_back(gradient(view, u + alongX[i][0], v + alongX[i][1], true));
        for (int i = 0; i < 4; ++i)
            result.push_back(gradient(view, u + alongY[i][0], v + alongY[i][1], false));
        return result;
    }

    int dissimilarity(int leftU, int rightU, int v) const
    {
        int sum = 0;
        for (int dv = -2; dv <= 2; dv += 4)
            for (int du = -2; du <= 2; du += 4)
            {
                const std::vector<int> a = descriptor(0, leftU + du, v + dv), b = descriptor(1, rightU + du, v + dv);
                for (int i = 0; i < 16; ++i)
                    sum += std::abs(a[i] - b[i]);
            }
        return sum;
    }

    //! The disparity of a point of the left (view 0) or right image, -1 if it is rejected.
    int bestDisparity(int view, int u, int v) const
    {
        const int rows = grey_[0].rows, cols = grey_[0].cols;
        if (u < 5 || u > cols - 6 || v < 5 || v > rows - 6)
            return -1;
        int texture = 0;
        const std::vector<int> own = descriptor(view, u, v);
        for (int i = 0; i < 16; ++i)
            texture += std::abs(own[i] - 128);
        const int largest = std::min(numDisparities_ - 1, view == 0 ? u - 5 : cols - u - 6);
        if (texture < 10 || largest < 10)
            return -1;

        int best = INT_MAX, second = INT_MAX, bestDisparity = -1;
        for (int d = 0; d <= largest; ++d)
        {
            const int e = view == 0 ? dissimilarity(u, u - d, v) : dissimilarity(u + d, u, v);
            if (e < best)
            {
                best = e;
                bestDisparity = d;
            }
            else if (e < second)
                second = e;
        }
        return second < INT_MAX && (float)best < 0.95f * (float)second ? bestDisparity : -1;
    }

    Mat grey_[2];
    int numDisparities_;
};

//! P(D_l): the disparities of the support points, 0 left out; uniform without any.
inline std::vector<double> histogram(const Mat& points, int numDisparities)
{
    std::vector<double> result(numDisparities, 0);
    for (int i = 0; i < points.rows; ++i)
        for (int j = 0; j < points.cols; ++j)
            if (points.at<short>(i, j) > 0)
                ++result[points.at<short>(i, j)];
    if (std::count(result.begin(), result.end(), 0.) == numDisparities)
        result.assign(numDisparities, 1);
    return result;
}

//! P(D_l) from the layer above: the pixels there that have half the disparity, and the mean of these numbers.
inline std::vector<double> upperHistogram(const Mat& upper, int numDisparities)
{
    const int upperDisparities = numDisparities / 2 + 1; // rounded up
    std::vector<double> result;
    for (int d = 0; d < numDisparities; ++d)
    {
        int count = 0;
        for (int y = 0; y < upper.rows; ++y)
            for (int x = 0; x < upper.cols; ++x)
                if (std::floor((double)upper.at<ushort>(y, x) / 16 + 0.5) == d / 2)
                    ++count;
        result.push_back(count + (double)upper.rows * upper.cols / upperDisparities);
    }
    return result;
}

//! GMM_l(o), section 2.2
inline double density(const DisparityPredictionModel& model, int layer, double offset)
{
    std::vector<double> means, sigmas, weights;
    model.getLayer(layer, means, sigmas, weights);
    double sum = 0;
    for (size_t k = 0; k < means.size(); ++k)
    {
        const double z = (offset - means[k]) / sigmas[k];
        sum += weights[k] * std::exp(-z * z / 2) / (sigmas[k] * std::sqrt(2 * CV_PI));
    }
    return sum;
}

//! P(D_l | D_{l+1}): rows D_{l+1}, columns D_l, by Bayes' theorem (section 2.2)
inline Mat_<double> posterior(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior,
                              int upperDisparities)
{
    Mat_<double> result(upperDisparities, (int)prior.size());
    for (int i = 0; i < result.rows; ++i)
    {
        double sum = 0;
        for (int j = 0; j < result.cols; ++j)
            sum += result(i, j) = density(model, layer, i - j / 2) * prior[j];
        for (int j = 0; j < result.cols && sum > 0; ++j)
            result(i, j) /= sum;
    }
    return result;
}

//! PixelIntv of a row of P(D_l | D_{l+1}), section 3.1, with a margin of candidates on both sides; empty if nothing is
//! possible.
inline hdp::DisparityInterval pixelInterval(const Mat_<double>& row, double delta, int margin = 0)
{
    const int mode = (int)(std::max_element(row.begin(), row.end()) - row.begin());
    hdp::DisparityInterval interval = { 1, 0 };
    double c = row(mode);
    if (!(c > 0))
        return interval;
    int first = mode, last = mode;
    for (bool grown = true; grown;)
    {
        grown = false;
        if (first > 0 && row(first - 1) / (c + row(first - 1)) > delta)
        {
            c += row(--first);
            grown = true;
        }
        if (last + 1 < row.cols && row(last + 1) / (c + row(last + 1)) > delta)
        {
            c += row(++last);
            grown = true;
        }
    }
    interval.first = (ushort)clamped(first - margin, row.cols);
    interval.last = (ushort)clamped(last + margin, row.cols);
    return interval;
}

//! Of colours, or of grey levels in 1 / 4
inline int edgeWeight(const Mat& image, int p, int q)
{
    if (image.depth() == CV_16U)
    {
        const int difference = std::abs(image.at<ushort>(p / image.cols, p % image.cols) -
                                        image.at<ushort>(q / image.cols, q % image.cols));
        return std::min((int)std::ceil(9 / 8. * difference / 4), 255);
    }
    const int channels = image.channels();
    int weight = 0;
    for (int c = 0; c < channels; ++c)
        weight = std::max(weight, std::abs(image.ptr(p / image.cols)[p % image.cols * channels + c] -
                                           image.ptr(q / image.cols)[q % image.cols * channels + c]));
    return weight;
}

//! CV_8UC2: the weights of the edges to the right and below, 0 at the border
inline Mat edgeWeights(const Mat& image)
{
    Mat weights(image.size(), CV_8UC2, Scalar::all(0));
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
        {
            const int p = y * image.cols + x;
            if (x + 1 < image.cols)
                weights.at<Vec2b>(y, x)[0] = (uchar)edgeWeight(image, p, p + 1);
            if (y + 1 < image.rows)
                weights.at<Vec2b>(y, x)[1] = (uchar)edgeWeight(image, p, p + image.cols);
        }
    return weights;
}

struct Tree
{
    std::vector<int> pixels;
    int first, last, maxWeight;

    bool empty() const { return last < first; }
};

//! A pixel's neighbours in its tree and the weights of the edges to them
typedef std::vector<std::vector<std::pair<int, int>>> Adjacency;

struct Forest
{
    std::vector<int> treeOf; // pixel -> index into trees
    std::vector<Tree> trees; // those that were joined to others have no pixels
    Adjacency neighbours;
    std::vector<int> joined; // edges 2 * p (to the right of p) and 2 * p + 1 (below p), ascending
};

//! Section 3.2: Kruskal's algorithm with a strategy's Rule 1 and 2 and DT-Rules 1 and 2. pixelIntv: CV_16UC2.
inline Forest buildForest(const Mat& image, const Mat& pixelIntv, const TreeStrategy& strategy, double beta, bool link)
{
    const int width = image.cols, pixels = image.cols * image.rows;
    Forest forest;
    forest.neighbours.resize(pixels);
    for (int p = 0; p < pixels; ++p)
    {
        const Vec2w interval = pixelIntv.at<Vec2w>(p / width, p % width);
        const Tree tree = { std::vector<int>(1, p), interval[0], interval[1], 0 };
        forest.treeOf.push_back(p);
        forest.trees.push_back(tree);
    }

    std::vector<int> edges;
    for (int e = 0; e < 2 * pixels; ++e)
    {
        const int p = e / 2, q = e % 2 == 0 ? p + 1 : p + width;
        if (e % 2 == 0 ? q % width == 0 : q >= pixels)
            continue;
        const Tree &a = forest.trees[p], &b = forest.trees[q];
        const bool disjoint = a.empty() || b.empty() || a.last < b.first || b.last < a.first;
        if (!(disjoint && edgeWeight(image, p, q) > 7)) // DT-Rule 1
            edges.push_back(e);
    }
    strategy.orderEdges(edgeWeights(image), edges); // Rule 1

    for (int pass = 0; pass < (link && strategy.linksTrees() ? 2 : 1); ++pass)
        for (int edge : edges)
        {
            const int p = edge / 2, q = edge % 2 == 0 ? p + 1 : p + width;
            if (forest.treeOf[p] == forest.treeOf[q])
                continue;
            Tree &a = forest.trees[forest.treeOf[p]], &b = forest.trees[forest.treeOf[q]];
            const int weight = edgeWeight(image, p, q);
            const TreeState stateA = { (int)a.pixels.size(), (uchar)a.maxWeight };
            const TreeState stateB = { (int)b.pixels.size(), (uchar)b.maxWeight };
            if (pass == 0 && !strategy.mayJoin(weight, stateA, stateB)) // Rule 2
                continue;
            const int hullFirst = std::min(a.first, b.first), hullLast = std::max(a.last, b.last);
            const int common = std::max(0, std::min(a.last, b.last) - std::max(a.first, b.first) + 1);
            if (a.empty() || b.empty() || common < beta * (hullLast - hullFirst + 1)) // DT-Rule 2
                continue;

            const bool keepB = a.pixels.size() < b.pixels.size(); // equal parts: the one on the left or above
            a.first = strategy.unitesIntervals() ? hullFirst : keepB ? b.first : a.first;
            a.last = strategy.unitesIntervals() ? hullLast : keepB ? b.last : a.last;
            a.maxWeight = std::max(weight, std::max(a.maxWeight, b.maxWeight));
            for (size_t k = 0; k < b.pixels.size(); ++k)
                forest.treeOf[b.pixels[k]] = forest.treeOf[p];
            a.pixels.insert(a.pixels.end(), b.pixels.begin(), b.pixels.end());
            b.pixels.clear();
            forest.neighbours[p].push_back(std::make_pair(q, weight));
            forest.neighbours[q].push_back(std::make_pair(p, weight));
            forest.joined.push_back(edge);
        }
    std::sort(forest.joined.begin(), forest.joined.end());
    return forest;
}

//! Section 3.3: S(p, q) of a pixel p and every pixel q of its tree, along the path between them.
inline std::vector<std::pair<int, double>> similarities(const Adjacency& neighbours, int p, double gamma)
{
    struct Reached
    {
        int pixel, from, distance;
    };
    const Reached start = { p, -1, 0 };
    std::vector<Reached> reached(1, start);
    std::vector<std::pair<int, double>> result;
    for (size_t i = 0; i < reached.size(); ++i)
    {
        const Reached here = reached[i];
        result.push_back(std::make_pair(here.pixel, std::exp(-here.distance / gamma)));
        const std::vector<std::pair<int, int>>& next = neighbours[here.pixel];
        for (size_t k = 0; k < next.size(); ++k)
            if (next[k].first != here.from)
            {
                const Reached there = { next[k].first, here.pixel, here.distance + next[k].second };
                reached.push_back(there);
            }
    }
    return result;
}

//! Section 3.3: C(p, x), x = first .. last, the explicit sum over the pixels of the tree. cost: M, rows pixels,
//! columns disparities.
inline std::vector<double> aggregated(const Adjacency& neighbours, int p, double gamma, const Mat_<double>& cost,
                                      int first, int last)
{
    std::vector<double> sums(std::max(last - first + 1, 0), 0);
    const std::vector<std::pair<int, double>> support = similarities(neighbours, p, gamma);
    for (size_t i = 0; i < support.size(); ++i)
    {
        const double* row = cost[support[i].first] + first;
        for (size_t x = 0; x < sums.size(); ++x)
            sums[x] += support[i].second * row[x];
    }
    return sums;
}

//! aggregateMeans() for a tree, in units of the volume. cost: M, rows pixels, columns disparities. Returns the means of
//! the pixels of the walk (rows) and of so many disparities (columns).
inline Mat_<int> treeMeans(const hdp::TreeWalk& walk, int size, const Mat_<double>& cost, double gamma, int count)
{
    const int unit = 1 << 15, scale = 1 << 10; // of the shares and of the means
    const auto rounded = [&](int product) { return (int)std::floor(product / (double)unit + 0.5); };
    const auto share = [&](float part) { return std::min((int)std::floor(unit * part), unit - 1); };
    std::vector<float> s(size), behind(size, 1.f), all(size);
    for (int i = size - 1; i > 0; --i)
    {
        s[i] = walk.weights[i] > 0 ? (float)std::exp(-walk.weights[i] / gamma) : 1.f;
        behind[walk.parents[i]] += s[i] * behind[i];
    }
    Mat_<int> means(size, count);
    for (int i = 0; i < size; ++i)
        for (int k = 0; k < count; ++k)
            means(i, k) = scale * (int)cost(walk.pixels[i], k);
    for (int i = size - 1; i > 0; --i)
        for (int k = 0, parent = walk.parents[i]; k < count; ++k)
        {
            const int difference = means(i, k) - scale * (int)cost(walk.pixels[parent], k);
            means(parent, k) += rounded(share(s[i] * behind[i] / behind[parent]) * difference);
        }
    all[0] = behind[0];
    for (int i = 1; i < size; ++i)
    {
        const int parent = walk.parents[i];
        all[i] = s[i] * all[parent] + (1 - s[i] * s[i]) * behind[i];
        for (int k = 0; k < count; ++k)
            means(i, k) += rounded(share(s[i] * all[parent] / all[i]) * (means(parent, k) - means(i, k)));
    }
    for (int& mean : means)
        mean = (int)std::floor(mean * hdp::CostVolume::scale / (double)scale + 0.5);
    return means;
}

//! M of all pixels (rows) and disparities (columns)
template <typename Formula> Mat_<double> costTable(const Formula& cost, Size size, int numDisparities)
{
    Mat_<double> table(size.area(), numDisparities);
    for (int p = 0; p < table.rows; ++p)
        for (int d = 0; d < numDisparities; ++d)
            table(p, d) = cost(p / size.width, p % size.width, d);
    return table;
}

//! The lowest of the disparities whose cost is smallest, up to rounding
inline int winner(const std::vector<double>& costs)
{
    const double limit = *std::min_element(costs.begin(), costs.end()) * (1 + 1e-9);
    int x = 0;
    while (costs[x] > limit)
        ++x;
    return x;
}

//! The minimum of the parabola through the costs of a candidate and of the two beside it, in 1/16 pixel from the
//! candidate: the lowest and the highest value that it may have if the costs have a relative error.
inline Range parabolaOffset(const std::vector<double>& costs, int candidate, double relativeError)
{
    if (candidate == 0 || candidate + 1 == (int)costs.size())
        return Range(0, 0);
    const double before = costs[candidate - 1], middle = costs[candidate], after = costs[candidate + 1];
    const double error = relativeError * (before + 2 * middle + after), curvature = before - 2 * middle + after;
    if (curvature <= 2 * error) // flat, or anything
        return error > 0 ? Range(-8, 8) : Range(0, 0);
    // (before - after) / 2 / curvature pixels; neither part is off by more than the error.
    const double offset = 8 * (before - after) / curvature, offsetError = 8 * 2 * error / (curvature - error);
    return Range(cvRound(std::max(offset - offsetError, -8.)), cvRound(std::min(offset + offsetError, 8.)));
}

//! Median of size x size pixels by sorting, borders replicated. image: CV_16UC1.
inline Mat median(const Mat& image, int size)
{
    Mat result(image.size(), CV_16UC1);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
        {
            std::vector<ushort> window;
            for (int dy = -(size / 2); dy <= size / 2; ++dy)
                for (int dx = -(size / 2); dx <= size / 2; ++dx)
                    window.push_back(image.at<ushort>(clamped(y + dy, image.rows), clamped(x + dx, image.cols)));
            std::sort(window.begin(), window.end());
            result.at<ushort>(y, x) = window[window.size() / 2];
        }
    return result;
}

//! The map with what the median removed, see restoreThinStructures().
inline Mat restoreThinStructures(const Mat& unfiltered, const Mat& filtered)
{
    Mat result = filtered.clone();
    for (int y = 0; y < result.rows; ++y)
        for (int x = 0; x < result.cols; ++x)
        {
            const int before = unfiltered.at<ushort>(y, x);
            int same = 0, all = 0;
            for (int v = y - 3; v <= y + 3; ++v)
                for (int u = x - 3; u <= x + 3; ++u)
                    if (v >= 0 && v < result.rows && u >= 0 && u < result.cols)
                    {
                        ++all;
                        same += std::abs(unfiltered.at<ushort>(v, u) - before) <= 16 ? 1 : 0;
                    }
            if (before - filtered.at<ushort>(y, x) >= 5 * 16 && same >= 0.3 * all)
                result.at<ushort>(y, x) = (ushort)before;
        }
    return result;
}

//! The fraction of a winner's disparity, see hdp::winnerFraction(). before, after: what the sums beside it have more
inline double fraction(int before, int after, double blunt, double sharp)
{
    const double slope = std::max(before, after); // of the steeper side of the V; the other one has the opposite
    if (slope <= 0)
        return 0;
    const double u = (before - after) / slope, root = u < 0 ? -std::sqrt(-u) : std::sqrt(u);
    const double share = slope <= blunt ? 0 : slope >= sharp ? 0.65 : 0.65 * (slope - blunt) / (sharp - blunt);
    return (share * root + (1 - share) * u) / 2;
}

//! Semi-global matching of a layer from the left, the right and above, over the candidates of windows alone: see
//! aggregateScanlines(). Disparities are in 1/16 pixel.
class Scanlines
{
public:
    //! left, right: grey levels in quarters; windows and smoothness: a CandidateWindow and a weight in 64ths, one for
    //! every 2 x 2 pixels.
    Scanlines(const Mat& left, const Mat& right, const Mat& weights, int blockSize, int numDisparities, int largest,
              const Mat& windows, const Mat& smoothness, const hdp::ScanlinePenalties& penalties,
              const hdp::PairMasks& masks = hdp::PairMasks())
        : left_(left), right_(right), weights_(weights), census_(left, right, blockSize), size_(left.size()),
          numDisparities_(numDisparities), largest_(largest), windows_(windows), smoothness_(smoothness),
          penalties_(penalties), masks_(masks)
    {
    }

    //! CV_16UC1. In an even number of stripes of about 128 rows; the paths from above and from below begin 16 rows
    //! before their stripe. residual receives the winners' own costs, CV_8UC1.
    Mat match(Mat& residual) const
    {
        Mat disparity(size_, CV_16UC1);
        residual.create(size_, CV_8U);
        const int stripes = size_.height < 64 ? 1 : 2 * std::max(1, cvRound(size_.height / 256.));
        for (int i = 0; i < stripes; ++i)
        {
            const int first = firstRow(i, stripes), end = i + 1 < stripes ? firstRow(i + 1, stripes) : size_.height;
            std::vector<std::vector<Costs>> below(size_.height + 1, std::vector<Costs>(size_.width));
            for (int y = std::min(end + 16, size_.height) - 1; y >= first; --y)
                for (int x = 0; x < size_.width; ++x)
                    below[y][x] = follow(Point(x, y), Point(x, y + 1), below[y + 1][x]);
            std::vector<Costs> above(size_.width);
            for (int y = std::max(first - 16, 0); y < end; ++y)
            {
                std::vector<Costs> left(size_.width), right(size_.width);
                for (int x = 0; x < size_.width; ++x)
                {
                    above[x] = follow(Point(x, y), Point(x, y - 1), above[x]);
                    left[x] = follow(Point(x, y), Point(x - 1, y), x > 0 ? left[x - 1] : Costs());
                }
                for (int x = size_.width - 1; x >= 0; --x)
                    right[x] = follow(Point(x, y), Point(x + 1, y), x + 1 < size_.width ? right[x + 1] : Costs());
                for (int x = 0; y >= first && x < size_.width; ++x)
                    disparity.at<ushort>(y, x) =
                        winner(Point(x, y), { left[x], right[x], above[x], below[y][x] }, residual.at<uchar>(y, x));
            }
        }
        return disparity;
    }

private:
    typedef std::vector<int> Costs; // L(p, d) of the candidates; of no pixel: empty

    int firstRow(int stripe, int stripes) const { return size_.height * stripe / stripes / 2 * 2; }

    const hdp::CandidateWindow& window(Point p) const
    {
        return windows_.ptr<hdp::CandidateWindow>(clamped(p.y / 2, windows_.rows))[clamped(p.x / 2, windows_.cols)];
    }

    double weight(Point p) const
    {
        return smoothness_.at<uchar>(clamped(p.y / 2, smoothness_.rows), clamped(p.x / 2, smoothness_.cols)) / 64.;
    }

    //! With the weight of the pixel
    int weighed(int penalty, Point p) const { return std::min((int)std::floor(weight(p) * penalty + 0.5), 100); }

    std::vector<int> candidates(Point p) const
    {
        std::vector<int> result;
        for (int run = 0; run < 2; ++run)
            for (int i = 0; i < 8; ++i)
                if (window(p).first[run] + i <= numDisparities_) // one beyond the range
                    result.push_back(window(p).first[run] + i);
        return result;
    }

    int pixelCost(Point p, int d) const
    {
        const hdp::CandidateWindow& w = window(p);
        const int run = d >= w.first[0] && d < w.first[0] + 8 ? 0 : 1;
        const int difference =
            left_.at<ushort>(p) / 4 - right_.at<ushort>(p.y, clamped(p.x - d, size_.width)) / 4; // of whole levels
        return limited(p, d, census_(p.y, p.x, d) + std::min(std::abs(difference), 23) / 4) +
               (int)std::floor(weight(p) * penalties_.prior * std::abs(d - w.predicted[run] / 16.) / 2) +
               (run == 1 && w.first[1] > w.first[0] + 8 ? penalties_.nearer : 0);
    }

    int limited(Point p, int d, int cost) const
    {
        if (masks_.isEmpty())
            return cost;
        const bool isLimited = isMissing(masks_, Point(clamped(p.x - d, size_.width), p.y));
        return masks_.left.at<uchar>(p) < 128 ? 0 : isLimited ? std::min(cost, +hdp::CostLimits::ordinary) : cost;
    }

    //! L(p, d), from that of the pixel before
    Costs follow(Point p, Point q, const Costs& before) const
    {
        const std::vector<int> own = candidates(p);
        Costs result;
        for (size_t i = 0; i < own.size(); ++i)
            result.push_back(pixelCost(p, own[i]));
        if (before.empty())
            return result;
        const std::vector<int> theirs = candidates(q);
        const int m = *std::min_element(before.begin(), before.end());
        const int small = weighed(penalties_.small, p), large = largePenalty(p, q);
        const auto costBefore = [&](int d) {
            const size_t i = (size_t)(std::find(theirs.begin(), theirs.end(), d) - theirs.begin());
            return i < theirs.size() ? before[i] : m + large;
        };
        for (size_t i = 0; i < own.size(); ++i)
        {
            int best = std::min(m + large, costBefore(own[i]));
            if (i > 0)
                best = std::min(best, costBefore(own[i - 1]) + small);
            if (i + 1 < own.size())
                best = std::min(best, costBefore(own[i + 1]) + small);
            result[i] += best - m;
        }
        return result;
    }

    //! Less where the colours differ by more than noise, above all where a window has two runs
    int largePenalty(Point p, Point q) const
    {
        const Point first(std::min(p.x, q.x), std::min(p.y, q.y));
        const int weight = weights_.at<Vec2b>(first)[p.x == q.x];
        const Point own = p.x == q.x ? q : first;
        const hdp::CandidateWindow& w = window(own);
        const int small = weighed(penalties_.small, own), large = weighed(penalties_.large, own);
        const int slope = w.first[1] == w.first[0] + 8 ? penalties_.edgeSlope : penalties_.borderSlope;
        const double fall = std::floor(slope * std::max(weight - penalties_.edgeNoise, 0) / 2.);
        return std::max(std::min(small, large), large - (int)fall);
    }

    ushort winner(Point p, const std::vector<Costs>& directions, uchar& residual) const
    {
        const std::vector<int> d = candidates(p);
        std::vector<int> sums(d.size(), 0);
        for (const Costs& costs : directions)
            for (size_t i = 0; i < costs.size(); ++i)
                sums[i] += costs[i] - *std::min_element(costs.begin(), costs.end());
        for (int& sum : sums)
            sum = std::min(sum, 255);
        const size_t i = (size_t)(std::min_element(sums.begin(), sums.end()) - sums.begin());
        residual = (uchar)pixelCost(p, d[i]);
        double offset = 0;
        if (i > 0 && i + 1 < d.size() && d[i - 1] == d[i] - 1 && d[i + 1] == d[i] + 1)
            offset = fraction(sums[i - 1] - sums[i], sums[i + 1] - sums[i], 52, 88);
        return (ushort)std::min(std::max(16 * d[i] + cvRound(16 * offset), 0), largest_);
    }

    Mat left_, right_, weights_;
    CensusCost census_;
    Size size_;
    int numDisparities_, largest_;
    Mat windows_, smoothness_;
    const hdp::ScanlinePenalties penalties_;
    const hdp::PairMasks masks_;
};

//! L(p, d) of a direction in a volume of costs, see aggregateVolume(): from the pixel that is step away. costs: C, rows
//! pixels, columns disparities; weights: of the edges.
inline Mat_<int> scanlineCosts(const Mat_<uchar>& costs, const Mat& weights, const hdp::VolumePenalties& penalties,
                               Point step)
{
    const Size size = weights.size();
    Mat_<int> all(costs.size());
    for (int i = 0; i < size.area(); ++i)
    {
        const int p = step.x + step.y < 0 ? i : size.area() - 1 - i; // after the pixel before
        const Point here(p % size.width, p / size.width), before = here + step;
        for (int d = 0; d < costs.cols; ++d)
            all(p, d) = costs(p, d);
        if (!Rect(Point(), size).contains(before))
            continue;
        const int* of = all[before.y * size.width + before.x];
        const int least = *std::min_element(of, of + costs.cols);
        const Point edge(std::min(here.x, before.x), std::min(here.y, before.y));
        const int w = weights.at<Vec2b>(edge)[step.x == 0];
        const int large = std::max(penalties.small, cvRound(penalties.large * std::exp(-w / penalties.gamma)));
        for (int d = 0; d < costs.cols; ++d)
        {
            int best = std::min(least + large, of[d]);
            for (int other : { d - 1, d + 1 })
                if (0 <= other && other < costs.cols)
                    best = std::min(best, of[other] + penalties.small);
            all(p, d) += best - least;
        }
    }
    return all;
}

//! What is added to the k-th of count candidates for the tip of its sum and of those beside it. unit: of costs, per bit
inline double tipOffset(const int* sum, int count, int k, int unit)
{
    if (count <= 2)
        return 0;
    // At an end the next slope goes on behind it, or one that leaves the tip there.
    const int after = k + 1 < count ? sum[k + 1] - sum[k] : 0, before = k > 0 ? sum[k - 1] - sum[k] : 0;
    const int beyondFirst = std::max(after, sum[2] - sum[1]);
    const int beyondLast = std::max(before, sum[count - 3] - sum[count - 2]);
    const int left = k > 0 ? before : beyondFirst, right = k + 1 < count ? after : beyondLast;
    return fraction(left, right, 8 * 4 * unit, 14 * 4 * unit);
}

//! aggregateVolume(), CV_16UC1. own: CV_16UC2, those of the candidates that winners' ends are taken of, if not of all
inline Mat volumeDisparity(const Mat_<uchar>& costs, const Mat& weights, const hdp::VolumePenalties& penalties,
                           const Mat& own = Mat())
{
    Mat_<int> sums(costs.size(), 0);
    for (const Point& step : { Point(-1, 0), Point(1, 0), Point(0, -1), Point(0, 1) })
        sums += scanlineCosts(costs, weights, penalties, step);
    Mat disparity(weights.size(), CV_16UC1);
    for (int p = 0; p < sums.rows; ++p)
    {
        const int* sum = sums[p];
        const int winner = (int)(std::min_element(sum, sum + sums.cols) - sum); // the first one
        Range ends(0, sums.cols);
        if (!own.empty())
        {
            const Vec2w ofPixel = own.ptr<Vec2w>()[p];
            const Range common = ends & Range(ofPixel[0], ofPixel[1] + 1);
            ends = common.start <= winner && winner < common.end ? common : ends;
        }
        const double offset = tipOffset(sum + ends.start, ends.size(), winner - ends.start, 8);
        disparity.ptr<ushort>()[p] = (ushort)(16 * winner + cvRound(16 * offset));
    }
    return disparity;
}

//! What aggregateRange() has of a layer, by direct computation
struct RangeLayer
{
    Mat left, right; // of the layer below
    int blockSize, candidates;
    Mat upper, weights, intervals;
    hdp::PairMasks masks; // of the layer below

    //! stripes: rows, and those that the vertical directions are followed over
    Mat disparity(const hdp::RangePenalties& penalties, const std::vector<hdp::ScanlineStripe>& stripes) const
    {
        const Mat_<int> all = costs(penalties);
        Mat_<int> sums = excess(all, weights, penalties, Point(-1, 0)) + excess(all, weights, penalties, Point(1, 0));
        const int width = weights.cols;
        for (const hdp::ScanlineStripe& stripe : stripes)
            for (const Point& step : { Point(0, -1), Point(0, 1) })
            {
                const Range reach = stripe.reach, rows = stripe.rows;
                const Mat_<int> costsOfReach = all.rowRange(reach.start * width, reach.end * width);
                const Mat_<int> found = excess(costsOfReach, weights.rowRange(reach), penalties, step);
                sums.rowRange(rows.start * width, rows.end * width) +=
                    found.rowRange((rows.start - reach.start) * width, (rows.end - reach.start) * width);
            }
        return winners(cv::min(sums, 255));
    }

private:
    //! C(p, h): rows pixels, columns candidates
    Mat_<int> costs(const hdp::RangePenalties& penalties) const
    {
        const CensusCost census(left, right, blockSize);
        Mat_<int> all(weights.size().area(), candidates, 255);
        const int planes = blockSize / 2;
        const Point parts[] = { Point(0, 0), Point(1, 1), Point(1, 0) };
        const auto ofBelow = [&](int y, int x, int h) {
            int bits = 0, most = INT_MAX;
            for (int i = 0; i < 3; ++i)
            {
                const Point q = Point(2 * x, 2 * y) + parts[i];
                if (hasData(q))
                    bits += census.count(q.y, q.x, h, i % planes, planes);
                if (!masks.isEmpty() && isMissing(masks, Point(clamped(q.x - h, right.cols), q.y)))
                    most = hdp::CostLimits::ordinary;
            }
            return std::min(bits, most);
        };
        for (int y = 0; y < weights.rows; ++y)
            for (int x = 0; x < weights.cols; ++x)
            {
                const double above = upper.at<ushort>(clamped(y / 2, upper.rows), clamped(x / 2, upper.cols)) / 16.;
                const int predicted = std::min(cvFloor(4 * above + 0.5), candidates);
                const bool isPredicted = std::any_of(
                    parts, parts + 3, [&](const Point& part) { return hasData(Point(2 * x, 2 * y) + part); });
                const int maxPrior = isPredicted ? penalties.maxPrior : 0;
                const Vec2w own = intervals.empty() ? Vec2w(0, (ushort)(candidates - 1)) : intervals.at<Vec2w>(y, x);
                for (int h = own[0]; h <= own[1]; ++h)
                    all(y * weights.cols + x, h) =
                        2 * ofBelow(y, x, h) + std::min(std::abs(h - predicted) / penalties.priorDistance, maxPrior);
            }
        return all;
    }

    //! Of a pixel of the left image below
    bool hasData(const Point& q) const { return masks.isEmpty() || masks.left.at<uchar>(q) >= 128; }

    //! E of a direction, from the pixel that is step away
    static Mat_<int> excess(const Mat_<int>& costs, const Mat& weights, const hdp::RangePenalties& penalties,
                            Point step)
    {
        const Size size = weights.size();
        Mat_<int> all = costs.clone();
        for (int i = 0; i < size.area(); ++i)
        {
            const int p = step.x + step.y < 0 ? i : size.area() - 1 - i; // after the pixel before
            const Point here(p % size.width, p / size.width), before = here + step;
            if (Rect(Point(), size).contains(before))
            {
                const int* of = all[before.y * size.width + before.x];
                const Point edge(std::min(here.x, before.x), std::min(here.y, before.y));
                const int w = weights.at<Vec2b>(edge)[step.x == 0];
                const int large =
                    std::max(penalties.leastLarge, cvRound(penalties.large * std::exp(-w / penalties.gamma)));
                for (int h = 0; h < costs.cols; ++h)
                {
                    int best = std::min(of[h], large);
                    for (int other : { h - 1, h + 1 })
                        if (0 <= other && other < costs.cols)
                            best = std::min(best, of[other] + penalties.small);
                    all(p, h) = std::min(costs(p, h) + best, 255);
                }
            }
            all.row(p) -= *std::min_element(all[p], all[p] + all.cols);
        }
        return all;
    }

    Mat winners(const Mat_<int>& sums) const
    {
        Mat disparity(weights.size(), CV_16UC1);
        for (int p = 0; p < sums.rows; ++p)
        {
            const Point pixel(p % weights.cols, p / weights.cols);
            const int k = (int)(std::min_element(sums[p], sums[p] + candidates) - sums[p]);
            Range ends(0, candidates);
            if (!intervals.empty())
            {
                const Range own(intervals.at<Vec2w>(pixel)[0], intervals.at<Vec2w>(pixel)[1] + 1);
                ends = own.start <= k && k < own.end ? own : ends;
            }
            const double offset = tipOffset(sums[p] + ends.start, ends.size(), k - ends.start, 2);
            disparity.at<ushort>(pixel) = (ushort)((16 * k + cvRound(16 * offset)) / 2);
        }
        return disparity;
    }
};

//! The disparities of a layer from those above: bilinear over the four pixels above that are nearest, those outside of
//! the image being the nearest inside. Where one of them is off by more than a pixel, the nearest one stands for it.
inline Mat upsampled(const Mat& upper, Size size)
{
    Mat result(size, CV_16UC1);
    const auto at = [&](int y, int x) {
        return (double)upper.at<ushort>(clamped(y, upper.rows), clamped(x, upper.cols));
    };
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const double own = at(y / 2, x / 2);
            double sum = 0;
            for (int dy = 0; dy <= 1; ++dy)
                for (int dx = 0; dx <= 1; ++dx)
                {
                    // The centre of a pixel is a quarter from that of the pixel above, towards the next one.
                    const double other = at(y % 2 ? y / 2 + dy : y / 2 - dy, x % 2 ? x / 2 + dx : x / 2 - dx);
                    const double weight = (dy ? 0.25 : 0.75) * (dx ? 0.25 : 0.75);
                    sum += weight * (std::abs(other - own) <= 16 ? other : own);
                }
            result.at<ushort>(y, x) = (ushort)std::floor(2 * sum + 0.5);
        }
    return result;
}

//! The mean difference of two maps, in pixels, over the window of 2 x 2 cells around that of a pixel; scale: how many
//! pixels of the first map are one of the other.
inline double meanDifference(const Mat& map, const Mat& other, int scale, int window, int y, int x)
{
    double sum = 0;
    for (int row = y / 2 - window / 2; row <= y / 2 + window / 2; ++row)
        for (int column = x / 2 - window / 2; column <= x / 2 + window / 2; ++column)
            for (int i = 0; i < 4; ++i)
            {
                const int v = clamped(2 * clamped(row, (map.rows + 1) / 2) + i / 2, map.rows);
                const int u = clamped(2 * clamped(column, (map.cols + 1) / 2) + i % 2, map.cols);
                const int there = other.at<ushort>(clamped(v / scale, other.rows), clamped(u / scale, other.cols));
                sum += std::min(std::abs(map.at<ushort>(v, u) - scale * there) / 16., 8.);
            }
    return sum / (4 * window * window);
}

//! How far the disparity of a pixel is to be trusted: 255 v sqrt(sqrt(S U) P M), not rounded, see disparityConfidence().
template <typename Formula>
double confidence(const hdp::ConfidenceMaps& maps, int numDisparities, const Formula& cost, int y, int x)
{
    const Mat& disparity = maps.disparity;
    const auto at = [&](int row, int column) {
        return disparity.at<ushort>(clamped(row, disparity.rows), clamped(column, disparity.cols)) / 16.;
    };
    const auto isStep = [&](int row, int column) {
        for (const Point& to : { Point(1, 0), Point(-1, 0), Point(0, 1), Point(0, -1) })
            if (std::abs(at(row + to.y, column + to.x) - at(row, column)) > 1.5)
                return true;
        return false;
    };
    const int farFromSteps = 64, radius = 10;
    double distance = farFromSteps;
    for (int row = std::max(y - farFromSteps, 0); row < std::min(y + farFromSteps, disparity.rows); ++row)
        for (int column = std::max(x - farFromSteps, 0); column < std::min(x + farFromSteps, disparity.cols); ++column)
            if (std::hypot(row - y, column - x) < distance && isStep(row, column))
                distance = std::hypot(row - y, column - x);

    double own = 0, others = 0; // C and A, times the area of the window
    for (int v = y - radius; v <= y + radius; ++v)
        for (int u = x - radius; u <= x + radius; ++u)
        {
            const int row = clamped(v, disparity.rows), column = clamped(u, disparity.cols);
            const int winner = (int)std::floor(at(row, column) + 0.5);
            std::vector<double> alternatives;
            for (int other : { winner - 2, winner + 2 })
                if (other >= 0 && other < numDisparities)
                    alternatives.push_back(cost(row, column, other));
            const double c = cost(row, column, winner);
            own += c;
            others += alternatives.empty() ? c : cv::mean(alternatives)[0];
        }
    const double unique = others > own ? (others - own) / (others + own) : 0;

    const auto columnInRight = [&](int column) { return column - cvRound(at(y, column)); };
    bool isVisible = columnInRight(x) >= 0;
    for (int column = 0; column < disparity.cols; ++column)
        if (columnInRight(column) == columnInRight(x) && at(y, column) - at(y, x) > 1)
            isVisible = false;
    const double p = maps.upper.empty() ? 0 : meanDifference(disparity, maps.upper, 2, 21, y, x),
                 m = meanDifference(disparity, maps.unfiltered, 1, 7, y, x);
    const double agreement = 1 / ((1 + 4 * p) * (1 + 4 * m));
    return 255 * (isVisible ? 1 : 0.5) * std::sqrt(std::sqrt(distance / farFromSteps * unique) * agreement);
}

}} // namespace opencv_test::oracle

#endif
