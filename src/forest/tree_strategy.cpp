// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_strategy.hpp"

#include "forest_edges.hpp"

#include <cmath>

namespace cv { namespace stereo {
namespace hdp {

namespace {

double checkedK(double k)
{
    if (!(k >= 0 && std::isfinite(k)))
        CV_Error(Error::StsOutOfRange, "k must be finite and >= 0");
    return k;
}

int checkedSeed(int seed)
{
    if (seed < 0)
        CV_Error(Error::StsOutOfRange, "seed must be >= 0");
    return seed;
}

//! A parameter of a strategy's node in a file.
FileNode parameter(const FileNode& fn, const char* key, bool isInteger)
{
    const FileNode node = fn[key];
    if (!node.isInt() && (isInteger || !node.isReal()))
        CV_Error(Error::StsParseError, format("%s must be %s", key, isInteger ? "an integer" : "a number"));
    return node;
}

} // namespace

SegmentTree::SegmentTree(double k) : k_(checkedK(k)) {}

void SegmentTree::write(FileStorage& fs) const { fs << "k" << k_; }

void SegmentTree::read(const FileNode& fn) { k_ = checkedK((double)parameter(fn, "k", false)); }

RandomTree::RandomTree(int seed) : seed_(checkedSeed(seed)) {}

void RandomTree::orderEdges(const Mat&, std::vector<int>& edges) const
{
    RNG rng((uint64)seed_ + 1); // the state 0 of cv::RNG stands for another one
    for (int i = (int)edges.size() - 1; i > 0; --i)
        std::swap(edges[i], edges[rng.uniform(0, i + 1)]);
}

void RandomTree::write(FileStorage& fs) const { fs << "seed" << seed_; }

void RandomTree::read(const FileNode& fn) { seed_ = checkedSeed((int)parameter(fn, "seed", true)); }

Ptr<TreeStrategy> createTreeStrategy(const String& name)
{
    const Ptr<TreeStrategy> strategies[] = { createMinimumSpanningTree(), createSegmentTree(), createRandomTree() };
    for (const Ptr<TreeStrategy>& strategy : strategies)
        if (strategy->getDefaultName() == name)
            return strategy;
    return Ptr<TreeStrategy>();
}

} // namespace hdp

void TreeStrategy::orderEdges(const Mat& weights, std::vector<int>& edges) const
{
    std::vector<int> sorted;
    hdp::sortByWeight(weights, edges, sorted);
}

Ptr<TreeStrategy> createMinimumSpanningTree() { return makePtr<hdp::MinimumSpanningTree>(); }

Ptr<TreeStrategy> createSegmentTree(double k) { return makePtr<hdp::SegmentTree>(k); }

Ptr<TreeStrategy> createRandomTree(int seed) { return makePtr<hdp::RandomTree>(seed); }

}} // namespace cv::stereo
