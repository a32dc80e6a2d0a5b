// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_COST_VOLUME_HPP
#define OPENCV_HDPSTEREO_COST_VOLUME_HPP

#include "../cost/census_cost.hpp"
#include "../base/units.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The costs of all pixels, which have the same candidates
struct CV_EXPORTS CostVolume
{
    static const int scale = TwoLayerCost::scale; // of the costs, for their fractions
    static const int chunk = 16;                  // costs that are stored together
    static const int contradiction = 3 * scale;   // see isContradicted()

    Size size;
    int numDisparities = 0;   // candidates 0 .. numDisparities - 1
    int steps = 1;            // candidates per pixel of disparity
    Mat intervals;            // DisparityInterval of each pixel, from excludeCandidates(); empty: all
    std::vector<uchar> costs; // that of pixel y * width + x and candidate d at [start(pixel) + d]; it only ever grows
    // Of aggregateMeans() alone: pixels y * width + x, tree by tree, and where those of each tree begin
    std::vector<int> treePixels, treeStarts;

    //! Costs in memory: of a pixel, in whole chunks, and of all
    int stride() const { return (numDisparities + chunk - 1) / chunk * chunk; }
    size_t total() const { return (size_t)size.area() * stride(); }
    size_t start(int pixel) const { return (size_t)pixel * stride(); }

    //! The candidates that a pixel has
    DisparityInterval intervalOf(int pixel) const
    {
        if (intervals.empty())
            return { 0, (ushort)(numDisparities - 1) };
        return intervals.ptr<DisparityInterval>()[pixel];
    }

    //! The lowest cost of a pixel
    uchar lowestOf(int pixel) const;

    //! Provides the memory.
    void create(const Size& size, int numDisparities, int steps);
    //! Takes the costs as they are.
    void fill(const TwoLayerCost& cost, const Size& size, int numDisparities);
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
