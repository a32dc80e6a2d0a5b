// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_forest.hpp"

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

class MinimumSpanningTree CV_FINAL : public TreeStrategy
{
public:
    bool ordersByWeight() const CV_OVERRIDE { return true; }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_MinimumSpanningTree"; }
};

//! As in the authors' program, which has the first pass of the segment tree alone, with k = 1200 and without uniting
//! intervals, and a second pass, see linksTrees(), only without prediction. The paper just cites the segment tree.
class SegmentTree CV_FINAL : public TreeStrategy
{
public:
    explicit SegmentTree(double k) : k_(checkedK(k)) {}

    bool ordersByWeight() const CV_OVERRIDE { return true; }
    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        return weight <= a.maxWeight + k_ / a.size && weight <= b.maxWeight + k_ / b.size;
    }
    bool unitesIntervals() const CV_OVERRIDE { return false; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_SegmentTree"; }
    void write(FileStorage& fs) const CV_OVERRIDE { fs << "k" << k_; }
    void read(const FileNode& fn) CV_OVERRIDE { k_ = checkedK((double)parameter(fn, "k", false)); }

private:
    double k_;
};

//! The authors' program shuffles by std::random_shuffle, whose order depends on the machine.
class RandomTree CV_FINAL : public TreeStrategy
{
public:
    explicit RandomTree(int seed) : seed_(checkedSeed(seed)) {}

    void orderEdges(const Mat&, std::vector<int>& edges) const CV_OVERRIDE
    {
        RNG rng((uint64)seed_ + 1); // RNG(0) is RNG(0xffffffff): seeds begin with 1
        for (int i = (int)edges.size() - 1; i > 0; --i)
            std::swap(edges[i], edges[rng.uniform(0, i + 1)]);
    }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_RandomTree"; }
    void write(FileStorage& fs) const CV_OVERRIDE { fs << "seed" << seed_; }
    void read(const FileNode& fn) CV_OVERRIDE { seed_ = checkedSeed((int)parameter(fn, "seed", true)); }

private:
    int seed_;
};

} // namespace

Ptr<TreeStrategy> createTreeStrategy(const String& name)
{
    const Ptr<TreeStrategy> strategies[] = { createMinimumSpanningTree(), createSegmentTree(), createRandomTree() };
    for (const Ptr<TreeStrategy>& strategy : strategies)
        if (strategy->getDefaultName() == name)
            return strategy;
    return Ptr<TreeStrategy>();
}

} // namespace hdp

void TreeStrategy::orderEdges(const Mat& weights, std::vector<int>& edges) const { hdp::sortByWeight(weights, edges); }

Ptr<TreeStrategy> createMinimumSpanningTree() { return makePtr<hdp::MinimumSpanningTree>(); }

Ptr<TreeStrategy> createSegmentTree(double k) { return makePtr<hdp::SegmentTree>(k); }

Ptr<TreeStrategy> createRandomTree(int seed) { return makePtr<hdp::RandomTree>(seed); }

}} // namespace cv::stereo
