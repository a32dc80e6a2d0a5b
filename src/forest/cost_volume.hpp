// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_COST_VOLUME_HPP
#define OPENCV_HDPSTEREO_COST_VOLUME_HPP

#include "../cost/census_cost.hpp"
#include "disparity_forest.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Costs of the candidates of all pixels, those of TreeIntv of a pixel's tree
struct CV_EXPORTS CostVolume
{
    static const int scale = TwoLayerCost::scale; // of the costs, for their fractions
    static const int chunk = 16;                  // costs that are stored together
    static const int contradiction = 3 * scale;   // see isContradicted()

    struct Candidates // of a pixel
    {
        unsigned firstChunk; // its number in costs
        DisparityInterval interval;

        int chunks() const { return chunksOf(interval); }
        size_t start() const { return (size_t)firstChunk * chunk; }
    };
    static int chunksOf(const DisparityInterval& interval)
    {
        return interval.empty() ? 0 : (interval.size() + chunk - 1) / chunk;
    }

    Size size;
    int numDisparities = 0;             // the largest candidate + 1
    int steps = 1;                      // candidates per pixel of disparity
    bool isUniform = false;             // whether all pixels have the same candidates
    std::vector<Candidates> candidates; // of pixel y * width + x, unless they are the same, see of()
    Mat intervals;                      // of these, from excludeCandidates(); empty: all
    size_t chunks = 0;                  // of costs
    std::vector<uchar> costs;           // that of disparity interval.first + k at [start() + k]; it only ever grows

    //! Those of pixel y * width + x
    Candidates of(int pixel) const
    {
        if (!isUniform)
            return candidates[pixel];
        return { (unsigned)pixel * usualChunks_, uniform_ };
    }

    //! The lowest cost of these; UCHAR_MAX if there are none
    uchar lowestOf(const Candidates& own) const;

    //! Provides the memory for the trees of a forest.
    void create(const DisparityForest& forest);
    //! Tells where a tree's pixels are, and with that their candidates. tree: its number; pixels: as many as it has.
    void place(const DisparityForest& forest, size_t tree, const int* pixels);
    //! Pixels y * width + x of a tree, as place() got them, if all have the same candidates
    const int* pixelsOf(size_t tree) const { return &pixels_[starts_[tree]]; }
    //! Takes the costs as they are, of so many candidates from 0 on for all pixels.
    void fill(const TwoLayerCost& cost, const Size& size, int numDisparities);

private:
    void allocateCosts();

    DisparityInterval uniform_; // the candidates of all pixels
    // Pixels of usual trees have so many chunks each, in the order of the pixels, and the others more, behind them, in
    // the order of the trees, where scanlines wait for them: all are usual if that takes at most twice the memory.
    int usualChunks_ = 0;
    std::vector<int> pixels_;      // in the order of the trees, if all have the same candidates
    std::vector<unsigned> starts_; // by tree: its first one of pixels_; or, if these are not used, its first chunk
};

//! Excludes the candidates that pixels do not have, by the largest cost. intervals: DisparityInterval, of the layer.
CV_EXPORTS void excludeCandidates(const Mat& intervals, CostVolume& volume);

//! Raises the costs of other disparities of pixel y * width + x than a preferred one, in pixels: by a unit of cost,
//! CostVolume::scale, per candidate of distance beyond the first, up to a limit in units of the volume.
CV_EXPORTS void preferDisparity(int pixel, float disparity, int limit, CostVolume& volume);

//! Whether the cost of a disparity, in pixels, exceeds the lowest one of the pixel by more than
//! CostVolume::contradiction. A disparity beyond the candidates counts as the nearest of them.
CV_EXPORTS bool isContradicted(int pixel, float disparity, const CostVolume& volume);

}}} // namespace cv::stereo::hdp

#endif
