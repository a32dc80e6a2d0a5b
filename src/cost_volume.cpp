// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "cost_volume.hpp"

#include "vectorized.hpp"
#include <cstring>

namespace cv {
namespace stereo {
namespace hdp {

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

void CostVolume::prefer(int pixel, double disparity, int largest)
{
    const Candidates& own = candidates[pixel];
    const int count = own.interval.size(), d = cvRound(scale * disparity) - scale * own.interval.first;
    if (count <= 0)
        return;
    uchar* const raised = &costs[own.start()];
    const int nearest = std::min(std::max((d + scale / 2) / scale, 0), count - 1);
    uchar least = raised[nearest];
    HDP_VECTORIZED for (int k = 0; k < count; ++k) least = std::min(least, raised[k]);
    if (raised[nearest] - least > mostContradiction)
        return;
    HDP_VECTORIZED for (int k = 0; k < count; ++k) raised[k] =
        (uchar)std::min(raised[k] + std::min(std::abs(scale * k - d), largest), 255);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
