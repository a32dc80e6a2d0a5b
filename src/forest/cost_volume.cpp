// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "cost_volume.hpp"

#include "../base/vectorized.hpp"
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

uchar CostVolume::lowestOf(const Candidates& own) const
{
    const uchar* const first = costs.data() + own.start();
    const int count = own.interval.size();
    uchar lowest = UCHAR_MAX;
    HDP_VECTORIZED for (int k = 0; k < count; ++k) lowest = std::min(lowest, first[k]);
    return lowest;
}

void CostVolume::create(const DisparityForest& forest)
{
    size = forest.links.size();
    numDisparities = 1;
    rows = 0;
    uniform_ = forest.trees[0].interval;
    isUniform = !uniform_.empty();
    for (const DisparityTree& tree : forest.trees)
    {
        rows += (size_t)tree.size * rowsOf(tree.interval);
        if (!tree.interval.empty())
            numDisparities = std::max(numDisparities, tree.interval.last + 1);
        isUniform &= tree.interval.first == uniform_.first && tree.interval.last == uniform_.last;
    }
    usualRows_ = (int)(rows / size.area());
    rows = (size_t)size.area() * usualRows_;
    firsts_.resize(forest.trees.size());
    if (isUniform)
        pixels_.resize(size.area());
    else
        candidates.resize(size.area());
    unsigned first = isUniform ? 0 : (unsigned)rows;
    for (size_t t = 0; t < forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        const int ownRows = rowsOf(tree.interval);
        firsts_[t] = first;
        if (isUniform)
            first += tree.size;
        else if (ownRows > usualRows_)
            first += (unsigned)tree.size * ownRows;
    }
    if (!isUniform)
        rows = first;
    provideCosts();
}

void CostVolume::fill(const TwoLayerCost& cost, const Size& layerSize, const DisparityInterval& interval)
{
    size = layerSize;
    steps = cost.steps();
    numDisparities = interval.last + 1;
    usualRows_ = rowsOf(interval);
    rows = (size_t)size.area() * usualRows_;
    isUniform = true;
    uniform_ = interval;
    provideCosts();
    parallel_for_(Range(0, size.height), [&](const Range& range) {
        std::vector<int> pixels(size.width);
        std::vector<uchar> run(size.width * row);
        for (int y = range.start; y < range.end; ++y)
        {
            const int first = y * size.width;
            std::iota(pixels.begin(), pixels.end(), first);
            for (int r = 0; r < usualRows_; ++r)
            {
                cost.evaluate(pixels.data(), size.width, interval.first + r * row, row, run.data());
                uchar* to = &costs[of(first).start() + r * row];
                for (int x = 0; x < size.width; ++x, to += usualRows_ * row)
                    HDP_VECTORIZED for (int k = 0; k < row; ++k) to[k] = run[x * row + k];
            }
        }
    });
}

void CostVolume::provideCosts()
{
    if (costs.size() < rows * row)
        costs.resize(rows * row);
}

void CostVolume::place(const DisparityForest& forest, size_t tree, const int* pixels)
{
    const int count = forest.trees[tree].size, ownRows = rowsOf(forest.trees[tree].interval);
    if (isUniform)
    {
        std::copy(pixels, pixels + count, &pixels_[firsts_[tree]]);
        return;
    }
    Candidates own = { firsts_[tree], forest.trees[tree].interval };
    if (ownRows <= usualRows_)
        for (int i = 0; i < count; ++i)
        {
            own.firstRow = (unsigned)pixels[i] * usualRows_;
            candidates[pixels[i]] = own;
        }
    else
        for (int i = 0; i < count; ++i, own.firstRow += ownRows)
            candidates[pixels[i]] = own;
}

void excludeCandidates(const Mat& intervals, CostVolume& volume)
{
    parallelFor(volume.size.height, [&](int y) {
        for (int x = 0; x < volume.size.width; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            const CostVolume::Candidates all = volume.of(y * volume.size.width + x);
            uchar* const costs = volume.costs.data() + all.start();
            const int count = all.interval.size(), before = own.first - all.interval.first,
                      after = own.last + 1 - all.interval.first;
            if (before > 0)
                std::fill(costs, costs + std::min(before, count), (uchar)UCHAR_MAX);
            if (after < count)
                std::fill(costs + std::max(after, 0), costs + count, (uchar)UCHAR_MAX);
        }
    });
}

CostPreference::CostPreference(int largest)
{
    CV_DbgAssert(0 <= largest && largest <= farthest * CostVolume::scale);
    for (int fraction = 0; fraction < CostVolume::scale; ++fraction)
        for (int k = 0; k < length; ++k)
            rises_[fraction][k] = (uchar)std::min(std::abs((k - centre) * CostVolume::scale - fraction), largest);
}

void CostPreference::apply(int pixel, float disparity, CostVolume& volume) const
{
    const CostVolume::Candidates own = volume.of(pixel);
    uchar* costs = volume.costs.data() + own.start();
    // In whole numbers from the first candidate on
    const int d = cvRound(CostVolume::scale * volume.steps * disparity) - CostVolume::scale * own.interval.first;
    const int whole = d >> 3, fraction = d & (CostVolume::scale - 1);
    static_assert(+CostVolume::scale == 1 << 3, "whole numbers of candidates");
    for (int r = 0; r < own.rows(); ++r, costs += CostVolume::row)
    {
        // Farther from the row, all of it rises by the largest
        const int first = std::min(std::max(r * CostVolume::row - whole, -centre), +farthest + 1);
        const uchar* const rise = rises_[fraction] + centre + first;
        HDP_VECTORIZED for (int k = 0; k < CostVolume::row; ++k) costs[k] =
            (uchar)(std::min(costs[k], (uchar)(255 - rise[k])) + rise[k]);
    }
}

bool CostPreference::isContradicted(int pixel, float disparity, const CostVolume& volume)
{
    const CostVolume::Candidates own = volume.of(pixel);
    const int count = own.interval.size(), nearest = cvFloor(volume.steps * disparity + 0.5f) - own.interval.first;
    if (count <= 0)
        return false;
    const uchar* const costs = volume.costs.data() + own.start();
    const uchar cost = costs[std::min(std::max(nearest, 0), count - 1)];
    if (cost <= contradiction) // as are most
        return false;
    return cost - volume.lowestOf(own) > contradiction;
}

}}} // namespace cv::stereo::hdp
