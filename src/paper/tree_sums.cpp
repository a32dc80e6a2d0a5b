// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_sums.hpp"
#include "tree_sums.simd.hpp"
#include "paper/tree_sums.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "../base/fits.hpp"
#include "../forest/tree_tasks.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(aggregateRun)

//! Winner-takes-all over the matching cost
class Matching CV_FINAL : public AggregationProblem
{
public:
    Matching(const MatchingCost& cost, bool subpixel) : cost_(cost), subpixel_(subpixel) {}

    Range candidates(const TreeWalk&, const DisparityTree& tree) const CV_OVERRIDE { return candidatesOf(tree); }

    void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const CV_OVERRIDE
    {
        cost_.evaluate(pixels, count, first, lanes, costs);
    }

    void setDisparities(const int* pixels, const RunWinner* winners, int count, ushort* disparity) const CV_OVERRIDE
    {
        for (int i = 0; i < count; ++i)
            disparity[pixels[i]] = (ushort)(winners[i].candidate * subpixelScale + offset(winners[i]));
    }

private:
    int offset(const RunWinner& winner) const
    {
        const bool hasParabola = winner.before >= 0 && winner.after >= 0;
        return subpixel_ && hasParabola
                   ? cvRound(subpixelScale * parabolaOffset(winner.before, winner.lowest, winner.after))
                   : 0;
    }

    const MatchingCost& cost_;
    const bool subpixel_;
};

//! Winners over the sums
struct WinnerAggregation
{
    const DisparityForest& forest;
    const AggregationProblem& problem;
    const EdgeSimilarity similarity;
    ushort* disparity;

    void process(const DisparityTree& tree, SumScratch& own, SumBuffers& buffers) const
    {
        const TreeWalk& walk = own.walk; // groups use other members of it
        walkTree(forest, tree, own.walk);
        const Range candidates = problem.candidates(walk, tree);
        if (candidates.empty())
            return;
        const CandidateGroups groups(candidates, tree.size);
        own.winners.resize(maxGroups);
        groups.forEach(buffers, own, [&](int g, SumScratch& scratch) {
            RunWinner* const winners = grown(own.winners[g], tree.size);
            forEachRun(groups.of[g], tree.size, [&](const Range& run, int lanes) {
                float* const costs = grown(scratch.costs, (size_t)tree.size * lanes);
                problem.evaluate(walk.pixels.data(), tree.size, run.start, lanes, costs);
                const bool joins = run.start > groups.of[g].start;
                dispatched::aggregateRun(walk, tree.size, similarity.table, run, lanes, joins, costs, winners);
            });
        });
        std::vector<RunWinner>& winners = own.winners[0];
        const auto finish = [&](const Range& range) {
            for (int i = range.start; i < range.end; ++i)
                for (int g = 1; g < groups.count; ++g)
                    cpu_baseline::joinWinner(winners[i], own.winners[g][i], groups.of[g].start);
            problem.setDisparities(&walk.pixels[range.start], &winners[range.start], range.size(), disparity);
        };
        const Range all(0, tree.size);
        groups.count > 1 ? parallel_for_(all, finish) : finish(all);
    }
};

} // namespace

void takeWinners(const DisparityForest& forest, const AggregationProblem& problem, double gamma, SumBuffers& buffers,
                 Mat& disparity)
{
    const WinnerAggregation aggregation = { forest, problem, EdgeSimilarity(gamma), disparity.ptr<ushort>() };
    aggregateTrees(aggregation, buffers);
}

void aggregateForest(const DisparityForest& forest, const MatchingCost& cost, double gamma, bool subpixel,
                     SumBuffers& buffers, Mat& disparity)
{
    disparity.create(forest.links.size(), CV_16U);
    disparity.setTo(Scalar::all(0)); // where there is no candidate
    takeWinners(forest, Matching(cost, subpixel), gamma, buffers, disparity);
}

}}} // namespace cv::stereo::hdp
