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
    uniform_ = forest.trees[0].interval;
    isUniform = !uniform_.empty();
    size_t rowsOfTrees = 0;
    int most = 0;
    for (const DisparityTree& tree : forest.trees)
    {
        most = std::max(most, rowsOf(tree.interval));
        rowsOfTrees += (size_t)tree.size * rowsOf(tree.interval);
        if (!tree.interval.empty())
            numDisparities = std::max(numDisparities, tree.interval.last + 1);
        isUniform &= tree.interval.first == uniform_.first && tree.interval.last == uniform_.last;
    }
    const int mean = (int)(rowsOfTrees / size.area());
    usualRows_ = most <= 2 * mean ? most : mean;
    rows = (size_t)size.area() * usualRows_;
    firsts_.clear();
    size_t first = isUniform ? 0 : rows;
    for (const DisparityTree& tree : forest.trees)
    {
        firsts_.push_back((unsigned)first);
        if (isUniform)
            first += tree.size;
        else if (rowsOf(tree.interval) > usualRows_)
            first += (size_t)tree.size * rowsOf(tree.interval);
    }
    if (isUniform)
        pixels_.resize(size.area());
    else
    {
        candidates.resize(size.area());
        rows = first;
    }
    grown(costs, rows * row);
}

void CostVolume::place(const DisparityForest& forest, size_t tree, const int* pixels)
{
    const DisparityInterval interval = forest.trees[tree].interval;
    const int count = forest.trees[tree].size;
    if (isUniform)
    {
        std::copy_n(pixels, count, &pixels_[firsts_[tree]]);
        return;
    }
    const unsigned ownRows = rowsOf(interval), usual = usualRows_;
    for (int i = 0; i < count; ++i)
        candidates[pixels[i]] = { ownRows <= usual ? pixels[i] * usual : firsts_[tree] + i * ownRows, interval };
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
    grown(costs, rows * row);
    parallelForRows(size, [&](int y) {
        std::vector<int> pixels(size.width);
        std::vector<uchar> run(size.width * row);
        std::iota(pixels.begin(), pixels.end(), y * size.width);
        for (int r = 0; r < usualRows_; ++r)
        {
            cost.evaluate(pixels.data(), size.width, interval.first + r * row, row, run.data());
            for (int x = 0; x < size.width; ++x)
                std::copy_n(&run[x * row], +row, &costs[of(pixels[x]).start() + r * row]);
        }
    });
}

void excludeCandidates(const Mat& intervals, CostVolume& volume)
{
    parallelForRows(volume.size, [&](int y) {
        for (int x = 0; x < volume.size.width; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            const CostVolume::Candidates all = volume.of(y * volume.size.width + x);
            uchar* costs = volume.costs.data() + all.start();
            int before = own.first - all.interval.first, end = own.last + 1 - all.interval.first;
            for (int r = 0; r < all.rows(); ++r, before -= CostVolume::row, end -= CostVolume::row)
            {
                const uchar first = (uchar)clamped(before, 0, +CostVolume::row),
                            behind = (uchar)clamped(end, 0, +CostVolume::row);
                HDP_VECTORIZED for (uchar k = 0; k < CostVolume::row; ++k) costs[k] |=
                    (uchar)(k < first || k >= behind ? UCHAR_MAX : 0);
                costs += CostVolume::row;
            }
        }
    });
}

void preferDisparity(int pixel, float disparity, int limit, CostVolume& volume)
{
    CV_DbgAssert(0 <= limit && limit <= UCHAR_MAX);
    const CostVolume::Candidates own = volume.of(pixel);
    uchar* costs = volume.costs.data() + own.start();
    // In whole numbers from the first candidate on
    const int d = cvRound(CostVolume::scale * volume.steps * disparity) - CostVolume::scale * own.interval.first;
    for (int r = 0; r < own.rows(); ++r, costs += CostVolume::row)
    {
        // Of 16 bits, as vectors hold more of them; far from the row, all of it rises by the limit.
        const short most = (short)limit,
                    first = (short)clamped(r * CostVolume::row * CostVolume::scale - d, -4096, 4096);
        HDP_VECTORIZED for (short k = 0; k < CostVolume::row; ++k)
        {
            const short distance = (short)(first + k * CostVolume::scale);
            const short rise = std::min(std::max(distance, (short)-distance), most);
            costs[k] = (uchar)std::min((short)(costs[k] + rise), (short)UCHAR_MAX);
        }
    }
}

bool isContradicted(int pixel, float disparity, const CostVolume& volume)
{
    const CostVolume::Candidates own = volume.of(pixel);
    const int count = own.interval.size(), nearest = cvFloor(volume.steps * disparity + 0.5f) - own.interval.first;
    if (count <= 0)
        return false;
    const uchar cost = volume.costs[own.start() + clamped(nearest, 0, count - 1)];
    const int most = CostVolume::contradiction;
    return cost > most && cost - volume.lowestOf(own) > most; // most are not
}

}}} // namespace cv::stereo::hdp
