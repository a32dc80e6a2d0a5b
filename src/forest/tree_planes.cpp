// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_planes.hpp"

#include "../base/disparity_units.hpp"
#include "../base/vectorized.hpp"
#include "tree_walk.hpp"
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

const int minPixels = 400;      // of a tree that gets a plane
const int samples = 300;        // of its pixels, about
const int triples = 60;         // planes that are tried
const double leastBase = 0.05;  // area of the parallelogram of three pixels, as a share of the tree's
const double steepest = 0.5;    // slope, in disparities per pixel
const double tiltCost = 0.2;    // per disparity between the ends of the tree: of two planes, the flatter one
const int fits = 4;             // to the disparities near the plane
const double fitDistance = 1.5; // of those
const double onDistance = 1;    // of disparities that lie on the plane
const double leastShare = 0.4;  // of the disparities that lie on it
const double mostRise = 4.5;    // of the mean cost, in units of the volume
const double leastContrast = 1; // by which the mean of the candidates' costs exceeds that of the disparities
const int largestRise = 64;     // of a pixel's, for pixels of other surfaces to count as such

const int largestPenalty = 10; // of a disparity off the plane, in units of the volume

//! d = coefficients . (1, x, y)
typedef Vec3d Plane;

Vec3d basisOf(int pixel, int width) { return Vec3d(1, pixel % width, pixel / width); }

//! The pixels of a tree that its plane is looked for with
class TreeSamples
{
public:
    TreeSamples(const TreeWalk& walk, const DisparityTree& tree, const Mat& disparity, const CostVolume& volume)
        : leastRise_(), interval_(tree.interval), size_(tree.size), begin_(0, volume.size.width, volume.size.height)
    {
        const ushort* const winners = disparity.ptr<ushort>();
        const int step = std::max(tree.size / samples, 1);
        for (int i = 0; i < tree.size; i += step)
        {
            const int pixel = walk.pixels[i];
            const double winner = winners[pixel] / (double)subpixelScale;
            const uchar* const costs = &volume.costs[volume.candidates[pixel].start()];
            Sample sample = { costs, basisOf(pixel, volume.size.width), winner, 0 };
            sample.cost = costAt(sample, winner);
            leastRise_[samples_.size() % phases] += *std::min_element(costs, costs + interval_.size()) - sample.cost;
            samples_.push_back(sample);
            for (int term = 1; term < 3; ++term)
            {
                begin_[term] = std::min(begin_[term], sample.basis[term]);
                end_[term] = std::max(end_[term], sample.basis[term]);
            }
        }
    }

    //! Whether the costs tell anything
    bool haveContrast() const
    {
        const int candidates = interval_.size();
        int64 sum = 0; // of the differences from the winner's cost
        for (const Sample& sample : samples_)
            sum += std::accumulate(sample.costs, sample.costs + candidates, 0) - candidates * sample.cost;
        return sum >= leastContrast * candidates * samples_.size();
    }

    //! The plane of least rise among those through three samples, fitted to the disparities near it
    Plane findPlane() const
    {
        RNG rng(samples_.size());
        Plane best(samples_[0].disparity, 0, 0);
        double least = score(best, DBL_MAX);
        for (int i = 0; i < triples; ++i)
        {
            const Sample &a = any(rng), &b = any(rng), &c = any(rng);
            Plane plane;
            if (!findThrough(a, b, c, plane))
                continue;
            const double scored = score(plane, least);
            if (scored < least)
            {
                least = scored;
                best = plane;
            }
        }
        for (int i = 0; i < fits; ++i)
            best = fitted(best);
        return best;
    }

    //! By how much the plane raises the mean of the costs
    double rise(const Plane& plane) const
    {
        int sum = 0;
        for (int phase = 0; phase < phases; ++phase)
            sum += riseOf(plane, phase);
        return sum / (double)samples_.size();
    }

    double shareOn(const Plane& plane) const
    {
        int count = 0;
        for (const Sample& sample : samples_)
            count += std::abs(plane.dot(sample.basis) - sample.disparity) <= onDistance;
        return count / (double)samples_.size();
    }

private:
    struct Sample
    {
        const uchar* costs; // of the candidates
        Vec3d basis;
        double disparity;
        int cost; // of the disparity
    };

    //! By how much the plane raises the costs of every eighth sample, in sum
    int riseOf(const Plane& plane, int phase) const
    {
        int sum = 0;
        for (size_t i = phase; i < samples_.size(); i += phases)
            sum += std::min(costAt(samples_[i], plane.dot(samples_[i].basis)) - samples_[i].cost, +largestRise);
        return sum;
    }

    //! What the plane costs: its rise, and its tilt over the whole tree; or some number that is not below the limit,
    //! if it is not, which some of the samples may tell.
    double score(const Plane& plane, double limit) const
    {
        const Vec3d extent = end_ - begin_;
        const double tilt = tiltCost * (std::abs(plane[1]) * extent[1] + std::abs(plane[2]) * extent[2]);
        int sum = std::accumulate(leastRise_, leastRise_ + phases, 0);
        double least = 0;
        for (int phase = 0; phase < phases; ++phase)
        {
            sum += riseOf(plane, phase) - leastRise_[phase];
            least = sum / (double)samples_.size() + tilt;
            if (least >= limit)
                break;
        }
        return least;
    }

    //! The least squares of the disparities near a plane
    Plane fitted(const Plane& plane) const
    {
        Matx33d squares = Matx33d::eye() * 1e-6; // for pixels of one line
        Vec3d sum = squares * plane;
        for (const Sample& sample : samples_)
            if (std::abs(plane.dot(sample.basis) - sample.disparity) <= fitDistance)
            {
                squares += sample.basis * sample.basis.t();
                sum += sample.basis * sample.disparity;
            }
        return squares.solve(sum, DECOMP_CHOLESKY);
    }

    const Sample& any(RNG& rng) const { return samples_[rng.uniform(0, (int)samples_.size())]; }

    bool findThrough(const Sample& a, const Sample& b, const Sample& c, Plane& plane) const
    {
        const Vec3d p = b.basis - a.basis, q = c.basis - a.basis;
        const double area = p[1] * q[2] - q[1] * p[2], rise = b.disparity - a.disparity,
                     secondRise = c.disparity - a.disparity;
        if (std::abs(area) < leastBase * size_)
            return false;
        plane[1] = (rise * q[2] - secondRise * p[2]) / area;
        plane[2] = (secondRise * p[1] - rise * q[1]) / area;
        plane[0] = a.disparity - plane[1] * a.basis[1] - plane[2] * a.basis[2];
        return std::abs(plane[1]) <= steepest && std::abs(plane[2]) <= steepest;
    }

    int costAt(const Sample& sample, double disparity) const
    {
        const int first = interval_.first, last = interval_.last;
        return sample.costs[cvRound(clamped(disparity, (double)first, (double)last)) - first];
    }

    static const int phases = 8; // of the samples
    int leastRise_[phases];      // the lowest that riseOf() may be
    const DisparityInterval interval_;
    const int size_;    // of the tree
    Vec3d begin_, end_; // of its columns and rows
    std::vector<Sample> samples_;
};

void prefer(const Plane& plane, const TreeWalk& walk, const DisparityTree& tree, CostVolume& volume)
{
    for (int i = 0; i < tree.size; ++i)
    {
        const int pixel = walk.pixels[i];
        const double disparity = plane.dot(basisOf(pixel, volume.size.width));
        if (!volume.contradicts(pixel, disparity))
            volume.prefer(pixel, disparity, largestPenalty);
    }
}

} // namespace

int preferTreePlanes(const DisparityForest& forest, const Mat& disparity, CostVolume& volume)
{
    std::vector<const DisparityTree*> trees;
    for (const DisparityTree& tree : forest.trees)
        if (tree.size >= minPixels && !tree.interval.empty())
            trees.push_back(&tree);
    std::vector<uchar> hasPlane(trees.size());
    parallel_for_(Range(0, (int)trees.size()), [&](const Range& range) {
        TreeWalk walk;
        for (int t = range.start; t < range.end; ++t)
        {
            const DisparityTree& tree = *trees[t];
            walkTree(forest, tree, walk);
            const TreeSamples of(walk, tree, disparity, volume);
            if (!of.haveContrast())
                continue;
            const Plane plane = of.findPlane();
            hasPlane[t] = of.rise(plane) < mostRise && of.shareOn(plane) >= leastShare;
            if (hasPlane[t])
                prefer(plane, walk, tree, volume);
        }
    });
    return (int)std::count(hasPlane.begin(), hasPlane.end(), 1);
}

}}} // namespace cv::stereo::hdp
