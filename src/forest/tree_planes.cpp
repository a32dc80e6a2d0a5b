// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "tree_planes.hpp"

#include "../base/vectorized.hpp"
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(
    int, samples, 300, "pixels",
    "of a tree that gets a plane, about: more cost time and find the same plane, what fewer say is mostly noise");
HDP_TUNABLE(int, triples, 60, "planes", "that are tried: seven of them are right if half of the samples are");
HDP_TUNABLE(double, tiltCost, 0.2, "cost per disparity",
            "between the ends of the tree: of two planes, the flatter one");
const int fits = 4; // to the disparities near the plane: then these are the same as before
HDP_TUNABLE(double, fitDistance, 1.5, "disparities", "from the plane: what is farther off is another surface");
HDP_TUNABLE(double, minShare, 0.5, "share of the samples",
            "on the plane: where noise decides the disparities, or the tree has several surfaces, there are fewer");
HDP_TUNABLE(double, maxRise, 4.5, "cost", "of the mean over the tree: the costs are against a plane that has more");
HDP_TUNABLE(
    double, minMargin, 0.2, "cost",
    "by which the tree's one disparity is better in the mean: less is chance, as in skies, more leaves walls out");

//! d = coefficients . (1, x, y)
typedef Vec3d Plane;

//! The pixels of a tree that its plane is looked for with, in eight groups of every eighth one
class TreeSamples
{
public:
    TreeSamples(const int* pixels, const DisparityTree& tree, const Mat& disparity, const CostVolume& volume)
        : candidates_(volume.numDisparities), steps_((float)volume.steps)
    {
        const ushort* const winners = disparity.ptr<ushort>();
        const int step = std::max(tree.size / samples, 1);
        count_ = (tree.size + step - 1) / step;
        costs_.resize(count_ * candidates_);
        for (std::vector<float>* values : { &x_, &y_, &disparity_ })
            values->reserve(count_);
        for (int group = 0, sample = 0; group < groups; ++group)
        {
            lowest_[group] = 0;
            firsts_[group] = sample;
            for (int i = group * step; i < tree.size; i += groups * step, ++sample)
            {
                const int pixel = pixels[i];
                const uchar* const costs = &volume.costs[volume.start(pixel)];
                std::copy_n(costs, candidates_, &costs_[sample * candidates_]);
                x_.push_back((float)(pixel % volume.size.width));
                y_.push_back((float)(pixel / volume.size.width));
                disparity_.push_back(winners[pixel] / (float)subpixelScale);
                before_ += costs[candidateAt(disparity_.back())];
                const uchar lowest = volume.lowestOf(pixel);
                lowest_[group] += lowest;
                const DisparityInterval own = volume.intervalOf(pixel);
                haveContrast_ =
                    haveContrast_ || std::count(costs + own.first, costs + own.last + 1, lowest) < own.size();
            }
        }
        firsts_[groups] = count_;
        at_.resize(count_);
        extentX_ = extentOf(x_);
        extentY_ = extentOf(y_);
    }

    //! Whether the costs tell anything
    bool haveContrast() const { return haveContrast_; }

    //! The plane of least rise among those through three samples, fitted to the disparities near it
    Plane findPlane() const
    {
        RNG rng(count_);
        Plane best(disparity_[0], 0, 0);
        double least = score(best, DBL_MAX);
        for (int i = 0; i < triples; ++i)
        {
            const int a = rng.uniform(0, count_), b = rng.uniform(0, count_), c = rng.uniform(0, count_);
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
        int sum = -before_;
        for (int group = 0; group < groups; ++group)
            sum += costsOf(plane, group);
        return sum / (double)count_;
    }

    double shareOn(const Plane& plane) const
    {
        int count = 0;
        for (int i = 0; i < count_; ++i)
            count += isOn(plane, i);
        return count / (double)count_;
    }

private:
    static double extentOf(const std::vector<float>& values)
    {
        const auto ends = std::minmax_element(values.begin(), values.end());
        return *ends.second - *ends.first;
    }

    Vec3d basis(int sample) const { return Vec3d(1, x_[sample], y_[sample]); }

    bool isOn(const Plane& plane, int sample) const
    {
        return std::abs(plane.dot(basis(sample)) - disparity_[sample]) <= fitDistance;
    }

    //! The candidate next to a disparity
    int candidateAt(float disparity) const
    {
        const float last = (float)(candidates_ - 1);
        return (int)(std::min(std::max(steps_ * disparity, 0.f), last) + 0.5f);
    }

    //! The costs of a group on the plane, in sum
    int costsOf(const Plane& plane, int group) const
    {
        const int begin = firsts_[group], count = firsts_[group + 1] - begin, stride = candidates_;
        const float offset = (float)plane[0], slopeX = (float)plane[1], slopeY = (float)plane[2];
        const float *const x = x_.data() + begin, *const y = y_.data() + begin;
        int* const at = at_.data();
        HDP_VECTORIZED for (int i = 0; i < count; ++i) at[i] = candidateAt(offset + slopeX * x[i] + slopeY * y[i]);
        const uchar* costs = costs_.data() + begin * stride;
        int sum = 0;
        for (int i = 0; i < count; ++i, costs += stride)
            sum += costs[at[i]];
        return sum;
    }

    //! What the plane costs: its rise, and its tilt over the whole tree; or some number that is not below the limit,
    //! if it is not, which some of the samples may tell.
    double score(const Plane& plane, double limit) const
    {
        const double tilt = tiltCost * (std::abs(plane[1]) * extentX_ + std::abs(plane[2]) * extentY_);
        int sum = std::accumulate(lowest_, lowest_ + groups, -before_);
        double least = 0;
        for (int group = 0; group < groups; ++group)
        {
            sum += costsOf(plane, group) - lowest_[group];
            least = sum / (double)count_ + tilt;
            if (least >= limit)
                break;
        }
        return least;
    }

    //! The least squares of the disparities near a plane
    Plane fitted(const Plane& plane) const
    {
        Matx33d squares;
        Vec3d sum;
        for (int i = 0; i < count_; ++i)
            if (isOn(plane, i))
            {
                squares += basis(i) * basis(i).t();
                sum += disparity_[i] * basis(i);
            }
        const Matx33d few = Matx33d::eye() * 1e-6; // for pixels of one line
        return (few + squares).solve(few * plane + sum, DECOMP_CHOLESKY);
    }

    //! The plane through three samples; false if they lie on a line
    bool findThrough(int a, int b, int c, Plane& plane) const
    {
        const Vec3d p = basis(b) - basis(a), q = basis(c) - basis(a);
        const double determinant = p[1] * q[2] - q[1] * p[2];
        const double toB = disparity_[b] - disparity_[a], toC = disparity_[c] - disparity_[a];
        if (determinant == 0)
            return false;
        plane[1] = (toB * q[2] - toC * p[2]) / determinant;
        plane[2] = (toC * p[1] - toB * q[1]) / determinant;
        plane[0] = disparity_[a] - plane[1] * x_[a] - plane[2] * y_[a];
        return true;
    }

    static const int groups = 8;
    const int candidates_;
    const float steps_; // candidates per pixel of disparity
    double extentX_, extentY_;
    int count_;
    int firsts_[groups + 1]; // samples of the groups
    int lowest_[groups];     // the lowest that costsOf() may be
    int before_ = 0;         // the costs of all without a plane, in sum
    bool haveContrast_ = false;
    std::vector<uchar> costs_; // of the candidates of each sample
    std::vector<float> x_, y_, disparity_;
    mutable std::vector<int> at_; // memory of costsOf()
};

//! The one disparity whose costs are lowest in sum over a tree; false if others are about as good, or it is next to an
//! end of the range, as a better one may be beyond. At most a bit counts of a pixel's costs: those at the tree's border
//! see what stands before it, and prefer that by more.
bool findFlatPlane(const int* pixels, const DisparityTree& tree, const CostVolume& volume, Plane& plane)
{
    const int candidates = volume.numDisparities, reach = cvRound(fitDistance * volume.steps);
    std::vector<int> sums(candidates);
    int* const sum = sums.data();
    for (int i = 0; i < tree.size; ++i)
    {
        const uchar* const costs = &volume.costs[volume.start(pixels[i])];
        const int most = volume.lowestOf(pixels[i]) + CostVolume::scale;
        HDP_VECTORIZED for (int k = 0; k < candidates; ++k) sum[k] += std::min<int>(costs[k], most);
    }
    const auto least = std::min_element(sums.begin(), sums.end());
    const int at = (int)(least - sums.begin());
    plane = Plane((double)at / volume.steps, 0, 0);
    if (at <= reach || at + reach >= candidates - 1)
        return false;
    const int rival =
        std::min(*std::min_element(sums.begin(), least - reach), *std::min_element(least + reach + 1, sums.end()));
    return rival - *least >= minMargin * tree.size;
}

//! Gives the pixels of a tree the disparities of its plane, but for those whose costs contradict it. Those that have
//! its candidates keep their own fractions.
void applyPlane(const Plane& plane, const int* pixels, const DisparityTree& tree, const CostVolume& volume,
                Mat& disparity)
{
    const int width = volume.size.width;
    const float last = (volume.numDisparities - 1) / (float)volume.steps;
    const auto candidateOf = [&](float value) { return cvFloor(volume.steps * value + 0.5f); };
    for (int i = 0; i < tree.size; ++i)
    {
        const int pixel = pixels[i], x = pixel % width, y = pixel / width;
        const float value = clamped((float)(plane[0] + plane[1] * x + plane[2] * y), 0.f, last);
        ushort& own = disparity.ptr<ushort>()[pixel];
        if (candidateOf(value) != candidateOf(own / (float)subpixelScale) && !isContradicted(pixel, value, volume))
            own = (ushort)cvRound(value * subpixelScale);
    }
}

} // namespace

int takeTreePlanes(const DisparityForest& forest, const CostVolume& volume, Mat& disparity)
{
    std::vector<uchar> hasPlane(forest.trees.size());
    parallelFor((int)forest.trees.size(), [&](int t) {
        const DisparityTree& tree = forest.trees[t];
        if (tree.size < samples)
            return;
        const int* const pixels = &volume.treePixels[volume.treeStarts[t]];
        const TreeSamples of(pixels, tree, disparity, volume);
        if (!of.haveContrast())
            return;
        Plane plane = of.findPlane();
        if (of.shareOn(plane) >= minShare)
            hasPlane[t] = of.rise(plane) < maxRise;
        else // noise may decide the disparities of the pixels, and not the sums of their costs
            hasPlane[t] = findFlatPlane(pixels, tree, volume, plane) && of.rise(plane) < CostVolume::scale;
        if (hasPlane[t])
            applyPlane(plane, pixels, tree, volume, disparity);
    });
    return (int)std::count(hasPlane.begin(), hasPlane.end(), 1);
}

}}} // namespace cv::stereo::hdp
