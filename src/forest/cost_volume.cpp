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
    intervals = Mat();
    numDisparities = 1;
    uniform_ = forest.trees[0].interval;
    isUniform = !uniform_.empty();
    size_t chunksOfTrees = 0;
    int most = 0;
    for (const DisparityTree& tree : forest.trees)
    {
        most = std::max(most, chunksOf(tree.interval));
        chunksOfTrees += (size_t)tree.size * chunksOf(tree.interval);
        if (!tree.interval.empty())
            numDisparities = std::max(numDisparities, tree.interval.last + 1);
        isUniform &= tree.interval.first == uniform_.first && tree.interval.last == uniform_.last;
    }
    const int mean = (int)(chunksOfTrees / size.area());
    usualChunks_ = most <= 2 * mean ? most : mean;
    chunks = (size_t)size.area() * usualChunks_;
    if (isUniform)
        pixels_.resize(size.area());
    else
        candidates.resize(size.area());
    starts_.clear();
    unsigned pixels = 0;
    for (const DisparityTree& tree : forest.trees)
    {
        starts_.push_back(isUniform ? pixels : (unsigned)chunks);
        pixels += tree.size;
        if (chunksOf(tree.interval) > usualChunks_)
            chunks += (size_t)tree.size * chunksOf(tree.interval);
    }
    allocateCosts();
}

void CostVolume::allocateCosts()
{
    if (chunks > UINT_MAX) // Candidates::firstChunk has 32 bits
        CV_Error(Error::StsOutOfRange, "numDisparities is too large for images of this size: more than 2^36 costs");
    grown(costs, chunks * chunk);
}

void CostVolume::place(const DisparityForest& forest, size_t tree, const int* pixels)
{
    const DisparityInterval interval = forest.trees[tree].interval;
    const int count = forest.trees[tree].size;
    if (isUniform)
    {
        std::copy_n(pixels, count, &pixels_[starts_[tree]]);
        return;
    }
    const unsigned own = chunksOf(interval), usual = usualChunks_;
    for (int i = 0; i < count; ++i)
        candidates[pixels[i]] = { own <= usual ? pixels[i] * usual : starts_[tree] + i * own, interval };
}

void CostVolume::fill(const TwoLayerCost& cost, const Size& layerSize, int candidatesOfAll)
{
    struct Row
    {
        std::vector<int> pixels;
        std::vector<uchar> costs; // of a chunk of each pixel
    };
    size = layerSize;
    intervals = Mat();
    steps = cost.steps();
    numDisparities = candidatesOfAll;
    isUniform = true;
    uniform_ = { 0, (ushort)(numDisparities - 1) };
    usualChunks_ = chunksOf(uniform_);
    chunks = (size_t)size.area() * usualChunks_;
    allocateCosts();
    const Row memory = { std::vector<int>(size.width), std::vector<uchar>(size.width * chunk) };
    parallelForRows(size, memory, [&](int y, Row& row) {
        std::iota(row.pixels.begin(), row.pixels.end(), y * size.width);
        for (int c = 0; c < usualChunks_; ++c)
        {
            cost.evaluate(row.pixels.data(), size.width, c * chunk, chunk, row.costs.data());
            for (int x = 0; x < size.width; ++x)
                std::copy_n(&row.costs[x * chunk], +chunk, &costs[of(row.pixels[x]).start() + c * chunk]);
        }
    });
}

void excludeCandidates(const Mat& intervals, CostVolume& volume)
{
    volume.intervals = intervals;
    parallelForRows(volume.size, [&](int y) {
        for (int x = 0; x < volume.size.width; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            const CostVolume::Candidates all = volume.of(y * volume.size.width + x);
            uchar* const costs = volume.costs.data() + all.start();
            const int count = all.chunks() * CostVolume::chunk;
            const int first = clamped(own.first - all.interval.first, 0, count),
                      behind = clamped(own.last + 1 - all.interval.first, 0, count);
            std::fill(costs, costs + first, (uchar)UCHAR_MAX);
            std::fill(costs + behind, costs + count, (uchar)UCHAR_MAX);
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
    for (int c = 0; c < own.chunks(); ++c, costs += CostVolume::chunk)
    {
        // Of 16 bits, as vectors hold more of them; far from the chunk, all of it rises by the limit.
        const short most = (short)limit,
                    first = (short)clamped(c * CostVolume::chunk * CostVolume::scale - d, -4096, 4096);
        HDP_VECTORIZED for (short k = 0; k < CostVolume::chunk; ++k)
        {
            const short distance = (short)(first + k * CostVolume::scale);
            const short beyond = (short)(std::max(distance, (short)-distance) - CostVolume::scale);
            const short rise = std::min(std::max(beyond, (short)0), most);
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
    return cost > most && cost - volume.lowestOf(own) > most; // the first one fails for most pixels
}

}}} // namespace cv::stereo::hdp
