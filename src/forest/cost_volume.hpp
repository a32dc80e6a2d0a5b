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
    enum
    {
        scale = 8,                    // of the costs, for their fractions
        row = 16,                     // costs that are stored together
        mostContradiction = 3 * scale // see contradicts()
    };
    struct Candidates // of a pixel
    {
        unsigned firstRow; // of costs
        DisparityInterval interval;

        int rows() const { return rowsOf(interval); }
        size_t start() const { return (size_t)firstRow * row; }
    };
    static int rowsOf(const DisparityInterval& interval)
    {
        return interval.empty() ? 0 : (interval.size() + row - 1) / row;
    }

    Size size;
    int numDisparities = 0;             // all candidates are less
    std::vector<Candidates> candidates; // of pixel y * width + x
    size_t rows = 0;                    // of costs
    std::vector<uchar> costs;           // that of disparity interval.first + k at [start() + k]; it only ever grows

    //! Provides the memory for the trees of a forest.
    void create(const DisparityForest& forest);
    //! Takes the costs as they are, of the same candidates for all pixels.
    void fill(const CensusCost& cost, const Size& size, const DisparityInterval& interval);
    //! Sets the candidates of a tree's pixels; tree: its number, pixels: as many as it has.
    void place(const DisparityForest& forest, size_t tree, const int* pixels);
    //! Whether the cost of a disparity exceeds the lowest one of the pixel by more than mostContradiction. One beyond
    //! the candidates counts as the nearest of them.
    bool contradicts(int pixel, double disparity) const;
    /** Raises the costs of a pixel's other disparities: by a unit of cost per pixel of distance, up to a limit.
    @param pixel y * width + x
    @param disparity In pixels.
    @param largest The most that a cost rises by, in units of the volume. */
    void prefer(int pixel, double disparity, int largest);

private:
    void provideCosts(); // for the rows

    // Pixels of usual trees have so many rows each, in the order of the pixels, and the others more, behind them, in
    // the order of the trees.
    int usualRows_ = 0;
    std::vector<unsigned> firstRows_; // of the others, by tree
};

}}} // namespace cv::stereo::hdp

#endif
