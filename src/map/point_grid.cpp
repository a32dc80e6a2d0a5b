// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "point_grid.hpp"
#include "point_grid.simd.hpp"
#include "map/point_grid.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include <cmath>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, colorScale, 30, "grey levels", "that weigh as much as a unit of distance: less sees fewer points");

const int neighbours = 8; // that a pixel finds: more are farther away

HDP_DISPATCH(weighPoints)

} // namespace

PointGrid::PointGrid(const std::vector<PriorPoint>& points, const Mat& guide, int reach, double unit)
    : guide_(guide), reach_(reach), unit_((float)unit),
      size_((guide.cols + reach - 1) / reach, (guide.rows + reach - 1) / reach), begins_(size_.area() + 1),
      points_(points.size()), colors_(points.size())
{
    for (const PriorPoint& point : points)
        ++begins_[cellOf(point.place) + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<int> ends = begins_;
    for (const PriorPoint& point : points)
    {
        const int i = ends[cellOf(point.place)]++;
        points_[i] = point;
        colors_[i] = colorAt(point.place);
    }
    for (int i = 0; i <= reach * reach; ++i)
    {
        distances_.push_back(std::sqrt((double)i));
        distanceWeights_.push_back(std::exp(-distances_[i] / unit));
    }
    for (int i = 0; i <= UCHAR_MAX; ++i)
        colorWeights_.push_back(std::exp(-i / colorScale));
}

//! Of a pixel of the guide, as three channels
Vec3b PointGrid::colorAt(Point place) const
{
    const uchar* const pixel = guide_.ptr(place.y) + (ptrdiff_t)place.x * guide_.channels();
    return guide_.channels() == 1 ? Vec3b::all(*pixel) : Vec3b(pixel);
}

//! Places and colours of what is gathered
void PointGrid::describe(Surroundings& seen) const
{
    const std::vector<int>& index = seen.index;
    const size_t size = alignSize(index.size(), Surroundings::block);
    for (std::vector<short>* values :
         { &seen.x, &seen.y, &seen.channels[0], &seen.channels[1], &seen.channels[2], &seen.squared, &seen.color })
        values->resize(size);
    seen.keys.resize(size);
    seen.placeBits = 0;
    while (index.size() >> seen.placeBits > 0)
        ++seen.placeBits;
    for (size_t i = 0; i < index.size(); ++i)
    {
        seen.x[i] = (short)points_[index[i]].place.x;
        seen.y[i] = (short)points_[index[i]].place.y;
        for (int c = 0; c < 3; ++c)
            seen.channels[c][i] = colors_[index[i]][c];
    }
}

void PointGrid::weigh(Point place, Surroundings& seen) const
{
    // Less than 32 is told apart: the weights of what is lighter are next to nothing.
    const float scale = (float)(1 << (26 - seen.placeBits)), largest = 31.5f * scale;
    dispatched::weighPoints(place, colorAt(place), scale / unit_, scale / (float)colorScale, largest, reach_, seen);
}

void PointGrid::find(Surroundings& seen) const
{
    double lowest[neighbours]; // in order
    std::fill_n(lowest, +neighbours, (double)Surroundings::beyondReach);
    // Without branches, which no processor could predict
    size_t within = 0;
    for (const int key : seen.keys)
    {
        seen.keys[within] = key;
        within += key != Surroundings::beyondReach;
    }
    for (size_t i = 0; i < within; ++i)
    {
        double key = seen.keys[i];
        for (double& other : lowest)
        {
            const double larger = std::max(other, key);
            other = std::min(other, key);
            key = larger;
        }
    }
    seen.found.clear();
    for (int k = 0; k < neighbours && lowest[k] < Surroundings::beyondReach; ++k)
    {
        const int i = seen.placeOf((int)lowest[k]);
        // A float, as the last bits of std::exp() differ between machines
        const float weight = (float)(distanceWeights_[seen.squared[i]] * colorWeights_[seen.color[i]]);
        seen.found.push_back({ seen.index[i], weight, distanceTo(i, seen) });
    }
}

}}} // namespace cv::stereo::hdp
