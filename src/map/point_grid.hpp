// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_POINT_GRID_HPP
#define OPENCV_HDPSTEREO_POINT_GRID_HPP

#include "prior_join.hpp"

#include "../base/parallel_for.hpp"

namespace cv { namespace stereo { namespace hdp {

//! A point near a pixel
struct Neighbour
{
    int index;
    float weight;
    double distance;
};

//! The points that the pixels of a cell may see, and those that one of them has found
struct Surroundings
{
    std::vector<int> index;
    std::vector<short> x, y, channels[3];
    // Of one of the pixels: its distance, the difference from its colour, and a key, the logarithm of 1 / weight and
    // behind it the place in these vectors: so the lowest key is that of the heaviest point, the first one of several
    std::vector<short> squared, color;
    std::vector<int> keys;
    int lowestKey, placeBits;               // these: of a key
    static const int beyondReach = INT_MAX; // the key of other points
    static const int block = 32;            // points that are weighed at once: there is memory for whole blocks

    int placeOf(int key) const { return key & ((1 << placeBits) - 1); }

    std::vector<Neighbour> found;
};

//! Points of a prior in cells of an image: pixels see those of their own cell and of the eight around it.
class PointGrid
{
public:
    /** @param points At most one per pixel, row by row.
    @param guide CV_8UC1 or CV_8UC3: what has the colour of a point weighs more.
    @param reach How far a pixel sees, and the side of a cell: up to 64 pixels.
    @param unit The distance, in pixels, by which the weight of a point falls to 1 / e. */
    PointGrid(const std::vector<PriorPoint>& points, const Mat& guide, int reach, double unit);

    //! Cell by cell, and in a cell in their order
    const std::vector<PriorPoint>& points() const { return points_; }
    //! In cells
    Size size() const { return size_; }
    int reach() const { return reach_; }
    //! Row by row
    int cellOf(Point place) const { return place.y / reach_ * size_.width + place.x / reach_; }
    //! Those of a cell
    Range pointsOf(int cell) const { return Range(begins_[cell], begins_[cell + 1]); }

    //! f(cell, Surroundings) for the pixels of each cell, by all threads
    template <typename F> void forEachCell(const F& f) const
    {
        const Rect image(Point(), guide_.size());
        parallelFor(size_.height, Surroundings(), [&](int y, Surroundings& seen) {
            for (int x = 0; x < size_.width; ++x)
                f(Rect(x * reach_, y * reach_, reach_, reach_) & image, seen);
        });
    }

    //! Takes the points that pixels of a cell may see, of those that are wanted, isWanted(index).
    template <typename F> void gather(const Rect& cell, const F& isWanted, Surroundings& seen) const
    {
        const int x = cell.x / reach_, y = cell.y / reach_;
        seen.index.clear();
        for (int row = std::max(y - 1, 0); row <= std::min(y + 1, size_.height - 1); ++row)
        {
            const int* const cells = &begins_[row * size_.width];
            for (int i = cells[std::max(x - 1, 0)]; i < cells[std::min(x + 1, size_.width - 1) + 1]; ++i)
                if (isWanted(i))
                    seen.index.push_back(i);
        }
        describe(seen);
    }

    //! Weighs what was gathered for a pixel of the cell.
    void weigh(Point place, Surroundings& seen) const;
    //! Finds the heaviest points, eight at most, the heaviest first. After weigh().
    void find(Surroundings& seen) const;
    //! That of a point in `seen` from the pixel
    double distanceTo(int i, const Surroundings& seen) const { return distances_[seen.squared[i]]; }
    bool isWithinReach(int i, const Surroundings& seen) const { return seen.squared[i] <= reach_ * reach_; }

private:
    Vec3b colorAt(Point place) const;
    void describe(Surroundings& seen) const;

    const Mat& guide_;
    const int reach_;
    const float unit_;
    const Size size_;
    std::vector<int> begins_; // of the points of each cell
    std::vector<PriorPoint> points_;
    std::vector<Vec3b> colors_;
    std::vector<double> distances_, distanceWeights_, colorWeights_; // by squared distances, by differences
};

}}} // namespace cv::stereo::hdp

#endif
