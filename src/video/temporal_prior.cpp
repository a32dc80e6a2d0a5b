// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_prior.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef VideoFollowing V;

// Of disparities that the last frame does not predict. Means vary less than costs, and contradict more clearly.
const int largestPenalty = 6 * CostVolume::scale, largestOfMeans = 3 * CostVolume::scale;

//! What the last frame predicts for the pixels of a row
class RowPrediction
{
public:
    RowPrediction(const TemporalState& s, int y)
        : s_(s), y_(y), change_(s.backward.change()), ofRow_(change_.ofRow(y)),
          sources_(s.sources.ptr(std::min(y / V::cell, s.sources.rows - 1))),
          shifts_(s.shifts.ptr<Vec2s>(y / V::block)), unmoved_(s.last.disparity.ptr<ushort>(y)),
          size_(s.last.disparity.size()), lastCell_(s.sources.cols - 1)
    {
    }

    //! In pixels; false if there is none.
    bool operator()(int x, float& disparity) const
    {
        const float unit = 1.f / subpixelScale, unmoved = unmoved_[x] * unit;
        const int sources = sources_[std::min(x / V::cell, lastCell_)];
        disparity = unmoved;
        if (!(sources & MOVED_PLACE))
            return sources != 0;
        const Point from = shifted(x, y_, shifts_[x / V::block], size_);
        disparity = change_.now(s_.last.disparity.ptr<ushort>(from.y)[from.x] * unit, change_.ofX * x + ofRow_);
        return !(sources & SAME_PLACE) || s_.layer.scale * std::abs(disparity - unmoved) <= TemporalSources::farthest;
    }

private:
    const TemporalState& s_;
    const int y_;
    const DisparityChange change_;
    const float ofRow_;
    const uchar* const sources_;
    const Vec2s* const shifts_;
    const ushort* const unmoved_;
    const Size size_;
    const int lastCell_;
};

} // namespace

bool hasPrior(const TemporalState& s) { return s.age > 1 && !s.motion.isStill; }

void preferLastFrame(const TemporalState& s, int side, bool areMeans, CostVolume& volume)
{
    const Size size = s.last.disparity.size();
    parallel_for_(Range(0, volume.size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const RowPrediction predict(s, std::min(y * side + side / 2, size.height - 1));
            for (int x = 0; x < volume.size.width; ++x)
            {
                const int own = y * volume.size.width + x;
                float disparity;
                if (!predict(std::min(x * side + side / 2, size.width - 1), disparity) ||
                    (areMeans && volume.contradicts(own, disparity / side)))
                    continue;
                volume.prefer(own, disparity / side, areMeans ? largestOfMeans : largestPenalty);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
