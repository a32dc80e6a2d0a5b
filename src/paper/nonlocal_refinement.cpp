// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "nonlocal_refinement.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

/** The cost of candidate x is |x - d(p)| at a stable pixel p of disparity d(p), and 0 at others. Its sum over a tree is
convex in x, with the minimum at the median of the tree's stable disparities, weighted by their similarity to the pixel:
so only candidates between the smallest and the largest of them can win. */
class WeightedMedian CV_FINAL : public AggregationProblem
{
public:
    WeightedMedian(const Mat& disparity, const Mat& stable, bool subpixel)
        : disparity_(disparity.ptr<ushort>()), stable_(stable.ptr()), subpixel_(subpixel)
    {
    }

    //! Those between the smallest and the largest stable disparity, and one more on both sides; none without a stable
    //! pixel.
    Range candidates(const TreeWalk& walk, const DisparityTree& tree) const CV_OVERRIDE
    {
        int smallest = INT_MAX, largest = -1;
        for (int i = 0; i < tree.size; ++i)
            if (stable_[walk.pixels[i]])
            {
                const int d = disparity_[walk.pixels[i]];
                smallest = std::min(smallest, d);
                largest = std::max(largest, d);
            }
        if (largest < 0)
            return Range(0, 0);
        return Range(smallest / subpixelScale - 1, (largest + subpixelScale - 1) / subpixelScale + 2);
    }

    void evaluate(const int* pixels, int count, int first, int lanes, float* costs) const CV_OVERRIDE
    {
        const float unit = 1.f / subpixelScale;
        for (int i = 0; i < count; ++i, costs += lanes)
        {
            const float weight = stable_[pixels[i]] ? 1.f : 0.f, difference = first - disparity_[pixels[i]] * unit;
            for (int k = 0; k < lanes; ++k)
                costs[k] = weight * std::abs(difference + k);
        }
    }

    void setDisparities(const int* pixels, const RunWinner* winners, int count, ushort* disparity) const CV_OVERRIDE
    {
        for (int i = 0; i < count; ++i)
            disparity[pixels[i]] = (ushort)refined(pixels[i], winners[i]);
    }

private:
    int refined(int pixel, const RunWinner& winner) const
    {
        const int own = disparity_[pixel];
        const bool hasCost = winner.lowest != 0 || winner.last != 0;
        // The first and the last candidate are above their neighbours but for costs so close to 0 that few bits are
        // left.
        const bool isInside = winner.before >= 0 && winner.after >= 0;
        if (!hasCost || !isInside || (stable_[pixel] && wholeDisparity(own) == winner.candidate))
            return own;
        const float steeper = std::max(winner.before, winner.after) - winner.lowest; // of the slopes on both sides
        const bool hasTip = subpixel_ && steeper > 0;
        const float difference = winner.before - winner.after;
        return winner.candidate * subpixelScale + (hasTip ? cvRound(difference / steeper * (subpixelScale / 2)) : 0);
    }

    const ushort* disparity_;
    const uchar* stable_;
    const bool subpixel_;
};

} // namespace

void refineNonLocal(const DisparityForest& forest, const Mat& disparity, const Mat& stable, double gamma, bool subpixel,
                    SumBuffers& buffers, Mat& refined)
{
    disparity.copyTo(refined);
    takeWinners(forest, WeightedMedian(disparity, stable, subpixel), gamma, buffers, refined);
}

}}} // namespace cv::stereo::hdp
