// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_planes.hpp"

#include "../base/disparity_units.hpp"
#include "../base/tunable.hpp"
#include "../base/vectorized.hpp"
#include "tree_walk.hpp"
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, minPixels, 400, "pixels", "of a tree that gets a plane: what fewer say is mostly noise");
HDP_TUNABLE(int, samples, 300, "pixels", "of a tree, about: more cost time and find the same plane");
HDP_TUNABLE(int, triples, 60, "planes", "that are tried: four of them are right if minShare lies on the right one");
HDP_TUNABLE(double, minBase, 0.05, "share of the tree", "area that three pixels span: what is narrow tells no slope");
HDP_TUNABLE(double, maxSlope, 0.5, "disparities per pixel", "steeper planes join two surfaces");
HDP_TUNABLE(double, tiltCost, 0.2, "cost per disparity",
            "between the ends of the tree: of two planes, the flatter one");
HDP_TUNABLE(int, fits, 4, "fits", "to the disparities near the plane: then these are the same as before");
HDP_TUNABLE(double, fitDistance, 1.5, "disparities", "from the plane: what is farther off is another surface");
HDP_TUNABLE(double, onDistance, 1, "disparities", "from the plane that disparities on it are off by noise");
HDP_TUNABLE(double, minShare, 0.4, "share of the samples", "on the plane: a tree of several surfaces gets none");
HDP_TUNABLE(double, maxRise, 4.5, "cost", "of the mean over the tree: the costs are against a plane that has more");
HDP_TUNABLE(double, minContrast, 1, "cost", "of the mean candidate above the winner's: flat costs fit any plane");
HDP_TUNABLE(int, maxPixelRise, 64, "cost", "of one pixel: one of another surface counts no more than that");
HDP_TUNABLE(int, maxPenalty, 10, "cost", "of a disparity off the plane: so the scanlines can still leave it");

//! d = coefficients . (1, x, y)
typedef Vec3d Plane;

Vec3d basisOf(int pixel, int width) { return Vec3d(1, pixel % width, pixel / width); }

//! The pixels of a tree that its plane is looked for with
class TreeSamples
{
public:
    TreeSamples(const TreeWalk& walk, const DisparityTree& tree, const Mat& disparity, const CostVolume& volume)
        : minRise_(), interval_(tree.interval), size_(tree.size), begin_(0, volume.size.width, volume.size.height)
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
            minRise_[samples_.size() % phases] += *std::min_element(costs, costs + interval_.size()) - sample.cost;
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
        return sum >= minContrast * candidates * samples_.size();
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
            sum += std::min(costAt(samples_[i], plane.dot(samples_[i].basis)) - samples_[i].cost, +maxPixelRise);
        return sum;
    }

    //! What the plane costs: its rise, and its tilt over the whole tree; or some number that is not below the limit,
    //! if it is not, which some of the samples may tell.
    double score(const Plane& plane, double limit) const
    {
        const Vec3d extent = end_ - begin_;
        const double tilt = tiltCost * (std::abs(plane[1]) * extent[1] + std::abs(plane[2]) * extent[2]);
        int sum = std::accumulate(minRise_, minRise_ + phases, 0);
        double least = 0;
        for (int phase = 0; phase < phases; ++phase)
        {
            sum += riseOf(plane, phase) - minRise_[phase];
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
        if (std::abs(area) < minBase * size_)
            return false;
        plane[1] = (rise * q[2] - secondRise * p[2]) / area;
        plane[2] = (secondRise * p[1] - rise * q[1]) / area;
        plane[0] = a.disparity - plane[1] * a.basis[1] - plane[2] * a.basis[2];
        return std::abs(plane[1]) <= maxSlope && std::abs(plane[2]) <= maxSlope;
    }

    int costAt(const Sample& sample, double disparity) const
    {
        const int first = interval_.first, last = interval_.last;
        return sample.costs[cvRound(clamped(disparity, (double)first, (double)last)) - first];
    }

    static const int phases = 8; // of the samples
    int minRise_[phases];        // the lowest that riseOf() may be
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
            volume.prefer(pixel, disparity, maxPenalty);
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
            hasPlane[t] = of.rise(plane) < maxRise && of.shareOn(plane) >= minShare;
            if (hasPlane[t])
                prefer(plane, walk, tree, volume);
        }
    });
    return (int)std::count(hasPlane.begin(), hasPlane.end(), 1);
}

}}} // namespace cv::stereo::hdp
