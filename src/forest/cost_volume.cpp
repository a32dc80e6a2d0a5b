// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "cost_volume.hpp"

#include "../base/vectorized.hpp"
#include <cstring>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

void CostVolume::create(const DisparityForest& forest)
{
    size = forest.links.size();
    candidates.resize(forest.links.total());
    numDisparities = 1;
    rows = 0;
    for (const DisparityTree& tree : forest.trees)
    {
        rows += (size_t)tree.size * rowsOf(tree.interval);
        if (!tree.interval.empty())
            numDisparities = std::max(numDisparities, tree.interval.last + 1);
    }
    usualRows_ = (int)(rows / candidates.size());
    rows = candidates.size() * usualRows_;
    firstRows_.resize(forest.trees.size());
    for (size_t t = 0; t < forest.trees.size(); ++t)
    {
        const DisparityTree& tree = forest.trees[t];
        firstRows_[t] = (unsigned)rows;
        if (rowsOf(tree.interval) > usualRows_)
            rows += (size_t)tree.size * rowsOf(tree.interval);
    }
    provideCosts();
}

void CostVolume::fill(const CensusCost& cost, const Size& layerSize, const DisparityInterval& interval)
{
    static_assert(+CensusCost::scaledLanes == +row, "A row of costs is computed at once.");
    size = layerSize;
    numDisparities = interval.last + 1;
    usualRows_ = rowsOf(interval);
    rows = (size_t)size.area() * usualRows_;
    candidates.resize(size.area());
    provideCosts();
    parallel_for_(Range(0, size.height), [&](const Range& range) {
        std::vector<int> pixels(size.width);
        std::vector<uchar> run(size.width * row);
        for (int y = range.start; y < range.end; ++y)
        {
            const int first = y * size.width;
            std::iota(pixels.begin(), pixels.end(), first);
            for (int pixel : pixels)
            {
                const Candidates own = { (unsigned)pixel * usualRows_, interval };
                candidates[pixel] = own;
            }
            for (int r = 0; r < usualRows_; ++r)
            {
                cost.evaluateScaled(pixels.data(), size.width, interval.first + r * row, scale, run.data());
                uchar* to = &costs[candidates[first].start() + r * row];
                for (int x = 0; x < size.width; ++x, to += usualRows_ * row)
                    std::memcpy(to, &run[x * row], row);
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
    Candidates own = { firstRows_[tree], forest.trees[tree].interval };
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

bool CostVolume::contradicts(int pixel, double disparity) const
{
    const Candidates& own = candidates[pixel];
    const int count = own.interval.size(), nearest = (int)std::floor(disparity + 0.5) - own.interval.first;
    if (count <= 0)
        return false;
    const uchar* const all = &costs[own.start()];
    const uchar cost = all[clamped(nearest, 0, count - 1)];
    uchar least = cost;
    HDP_VECTORIZED for (int k = 0; k < count; ++k) least = std::min(least, all[k]);
    return cost - least > mostContradiction;
}

void CostVolume::prefer(int pixel, double disparity, int largest)
{
    const Candidates& own = candidates[pixel];
    const int d = cvRound(scale * disparity) - scale * own.interval.first;
    const short most = (short)largest; // 16 bits, for more of them in a vector
    uchar* raised = &costs[own.start()];
    for (int r = 0; r < own.rows(); ++r, raised += row)
    {
        // Farther from the row, all of it rises by the largest
        const short from = (short)clamped(d - r * row * scale, -largest, row * scale + largest);
        HDP_VECTORIZED for (short k = 0; k < row; ++k)
        {
            const short distance = (short)(k * scale - from), opposite = (short)-distance;
            const short rise = clamped(distance, opposite, most);
            raised[k] = (uchar)std::min((short)(raised[k] + rise), (short)255);
        }
    }
}

}}} // namespace cv::stereo::hdp
