// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "point_grid.hpp"

#include "../base/vectorized.hpp"

#include <cmath>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, colorScale, 30, "grey levels", "that weigh as much as a unit of distance: less sees fewer points");

const int neighbours = 8; // that a pixel finds: more are farther away

} // namespace

PointGrid::PointGrid(const std::vector<PriorPoint>& points, const Mat& guide, int reach, double unit)
    : guide_(guide), reach_(reach), size_((guide.cols + reach - 1) / reach, (guide.rows + reach - 1) / reach),
      begins_(size_.area() + 1), points_(points.size()), colors_(points.size())
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

//! Places and colours of what is gathered, in the order of the image
void PointGrid::describe(Surroundings& seen) const
{
    std::vector<int>& index = seen.index;
    const auto isBefore = [this](int a, int b) {
        const Point p = points_[a].place, q = points_[b].place;
        return p.y != q.y ? p.y < q.y : p.x < q.x;
    };
    std::sort(index.begin(), index.end(), isBefore);
    for (std::vector<short>* values :
         { &seen.x, &seen.y, &seen.channels[0], &seen.channels[1], &seen.channels[2], &seen.squared, &seen.color })
        values->resize(index.size());
    for (size_t i = 0; i < index.size(); ++i)
    {
        seen.x[i] = (short)points_[index[i]].place.x;
        seen.y[i] = (short)points_[index[i]].place.y;
        for (int c = 0; c < 3; ++c)
            seen.channels[c][i] = colors_[index[i]][c];
    }
}

void PointGrid::find(Point place, Surroundings& seen) const
{
    const Vec3b color = colorAt(place);
    const int count = (int)seen.index.size();
    const short x = (short)place.x, y = (short)place.y, blue = color[0], green = color[1], red = color[2];
    const short *const xs = seen.x.data(), *const ys = seen.y.data(), *const blues = seen.channels[0].data(),
                       *const greens = seen.channels[1].data(), *const reds = seen.channels[2].data();
    short *const squared = seen.squared.data(), *const colors = seen.color.data();
    HDP_VECTORIZED for (int i = 0; i < count; ++i)
    {
        const short dx = (short)(xs[i] - x), dy = (short)(ys[i] - y);
        squared[i] = (short)(dx * dx + dy * dy);
        const int ofBlue = std::abs(blues[i] - blue), ofGreen = std::abs(greens[i] - green);
        const int ofRed = std::abs(reds[i] - red), ofTwo = ofBlue > ofGreen ? ofBlue : ofGreen;
        colors[i] = (short)(ofTwo > ofRed ? ofTwo : ofRed);
    }
    // Weights, and in bits that floats do not have, which of them; the heaviest first, of equal ones the first
    double keys[neighbours] = {};
    const unsigned lastKey = (1u << 29) - 1;
    for (int i = 0; i < count; ++i)
    {
        if (squared[i] > reach_ * reach_)
            continue;
        // A float, as the last bits of std::exp() differ between machines.
        const float weight = (float)(distanceWeights_[squared[i]] * colorWeights_[colors[i]]);
        Cv64suf key;
        key.f = weight;
        key.u |= lastKey - i;
        for (double& other : keys) // without a branch, which no processor could predict
        {
            const double larger = std::max(other, key.f);
            key.f = std::min(other, key.f);
            other = larger;
        }
    }
    seen.found.clear();
    for (int k = 0; k < neighbours && keys[k] > 0; ++k)
    {
        Cv64suf key;
        key.f = keys[k];
        const int i = (int)(lastKey - (unsigned)(key.u & lastKey));
        key.u &= ~(uint64)lastKey;
        seen.found.push_back({ seen.index[i], (float)key.f, distances_[squared[i]] });
    }
}

}}} // namespace cv::stereo::hdp
