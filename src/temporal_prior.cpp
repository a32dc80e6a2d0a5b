// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "temporal_prior.hpp"

namespace cv {
namespace stereo {
namespace hdp {

namespace {

typedef VideoFollowing V;

// Of disparities that the last frame does not predict. Means vary less than costs, and contradict more clearly.
const int largestPenalty = 6 * CostVolume::scale, largestOfMeans = 3 * CostVolume::scale;

//! In pixels; false if the last frame predicts none.
bool predictDisparity(const TemporalState& s, const Point& pixel, float& disparity)
{
    const float unit = 1.f / subpixelScale;
    const int sources =
        s.sources.ptr(std::min(pixel.y / V::cell, s.sources.rows - 1))[std::min(pixel.x / V::cell, s.sources.cols - 1)];
    const float unmoved = s.last.disparity.ptr<ushort>(pixel.y)[pixel.x] * unit;
    disparity = unmoved;
    if (!(sources & MOVED_PLACE))
        return sources != 0;
    const Vec2s& shift = s.shifts.ptr<Vec2s>(pixel.y / V::block)[pixel.x / V::block];
    const Point from = shifted(pixel.x, pixel.y, shift, s.last.disparity.size());
    const DisparityChange& change = s.backward.change();
    const float place = change.ofX * pixel.x + change.ofRow(pixel.y);
    disparity = change.now(s.last.disparity.ptr<ushort>(from.y)[from.x] * unit, place);
    return !(sources & SAME_PLACE) || s.layer.scale * std::abs(disparity - unmoved) <= TemporalSources::farthest;
}

} // namespace

bool hasPrior(const TemporalState& s) { return s.age > 1 && !s.motion.isStill; }

void preferLastFrame(const TemporalState& s, int side, bool areMeans, CostVolume& volume)
{
    const Size size = s.last.disparity.size();
    parallel_for_(Range(0, volume.size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < volume.size.width; ++x)
            {
                const Point pixel(std::min(x * side + side / 2, size.width - 1),
                                  std::min(y * side + side / 2, size.height - 1));
                const int own = y * volume.size.width + x;
                float disparity;
                if (predictDisparity(s, pixel, disparity) && !(areMeans && volume.contradicts(own, disparity / side)))
                    volume.prefer(own, disparity / side, areMeans ? largestOfMeans : largestPenalty);
            }
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
