// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_sources.hpp"
#include "temporal_sources.simd.hpp"
#include "video/temporal_sources.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef TemporalSources T;
typedef VideoFollowing V;

HDP_DISPATCH(sumSquares)

//! The median of CV_8UC1
int medianLevel(const Mat& image)
{
    int counts[256] = { 0 };
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            ++counts[image.ptr(y)[x]];
    int level = 0;
    for (int64 sum = counts[0]; 2 * sum < (int64)image.total(); sum += counts[level])
        ++level;
    return level;
}

//! Rows of an image around one, the nearest ones where there are none
void rowsAround(const Mat& image, int y, int radius, const uchar** rows)
{
    for (int dy = -radius; dy <= radius; ++dy)
        *rows++ = image.ptr(std::min(std::max(y + dy, 0), image.rows - 1));
}

//! Sums over the squares around the pixels of a row
class SquareSums
{
public:
    explicit SquareSums(int width) : columns_(width + 2 * maxRadius), sums_(width) {}

    const ushort* operator()(const Mat& image, int y, int radius)
    {
        const uchar* rows[2 * maxRadius + 1];
        rowsAround(image, y, radius, rows);
        dispatched::sumSquares(rows, radius, image.cols, columns_.data() + maxRadius, sums_.data());
        return sums_.data();
    }

private:
    enum
    {
        maxRadius = 2
    };
    std::vector<ushort> columns_, sums_;
};

//! How far each pixel is from the mean around it
void findContrast(const Mat& image, Mat& contrast)
{
    contrast.create(image.size(), CV_8U);
    parallel_for_(Range(0, image.rows), [&](const Range& range) {
        SquareSums sumsOf(image.cols);
        for (int y = range.start; y < range.end; ++y)
        {
            const uchar* levels = image.ptr(y);
            const ushort* sums = sumsOf(image, y, 2);
            uchar* contrasts = contrast.ptr(y);
            for (int x = 0; x < image.cols; ++x)
                contrasts[x] = (uchar)(std::abs(25 * levels[x] - sums[x]) / 25);
        }
    });
}

//! The last frame as this one would show it if nothing moved but the camera: half a cell is the mean of two.
void warpLastFrame(TemporalState& s)
{
    const Mat& before = s.last.grey[0];
    const Point last(2 * before.cols - 2, 2 * before.rows - 2); // in half cells
    const int side = V::block / V::cell;                        // of the squares that move together, in cells
    static_assert(V::cell == 2, "Shifts are in half cells.");
    s.warped.create(before.size(), CV_8U);
    parallel_for_(Range(0, before.rows), [&](const Range& range) {
        for (int y = range.start; y < range.end; ++y)
        {
            const Vec2s* shifts = s.shifts.ptr<Vec2s>(y * V::cell / V::block);
            uchar* warped = s.warped.ptr(y);
            for (int begin = 0; begin < before.cols; begin += side)
            {
                const Vec2s& shift = shifts[begin / side];
                const int end = std::min(begin + side, before.cols), fromX = 2 * begin + shift[0];
                const int fromY = std::min(std::max(2 * y + shift[1], 0), last.y);
                const uchar *above = before.ptr(fromY / 2), *below = before.ptr((fromY + 1) / 2);
                const bool isInside = fromX >= 0 && fromX + 2 * (end - begin - 1) <= last.x;
                for (int x = begin; x < end; ++x)
                {
                    const int from = fromX + 2 * (x - begin);
                    const int at = isInside ? from : std::min(std::max(from, 0), last.x);
                    const int left = at >> 1, right = (at + 1) >> 1;
                    warped[x] = (uchar)((above[left] + above[right] + below[left] + below[right] + 2) >> 2);
                }
            }
        }
    });
}

} // namespace

void findSources(TemporalState& s)
{
    const Mat &before = s.last.grey[0], &now = s.next.grey[0];
    const bool isStill = s.motion.isStill;
    if (!isStill)
        warpLastFrame(s);
    absdiff(now, isStill ? before : s.warped, s.change);
    findContrast(now, s.contrast);
    const int noise = T::leastNoise + T::noiseFactor * medianLevel(s.change);
    s.sources.create(now.size(), CV_8U);
    parallel_for_(Range(0, now.rows), [&](const Range& range) {
        SquareSums changesOf(now.cols), contrastsOf(now.cols), sumsBefore(now.cols), sumsNow(now.cols);
        for (int y = range.start; y < range.end; ++y)
        {
            const ushort *changes = changesOf(s.change, y, 1), *contrasts = contrastsOf(s.contrast, y, 2);
            uchar* sources = s.sources.ptr(y);
            for (int x = 0; x < now.cols; ++x)
                sources[x] = changes[x] <= 9 * noise || 100 * 25 * changes[x] <= T::contrastShare * 9 * contrasts[x];
            if (isStill)
                continue; // 1 is SAME_PLACE
            const ushort *there = sumsBefore(before, y, 1), *here = sumsNow(now, y, 1);
            const Vec2s* shifts = s.shifts.ptr<Vec2s>(y * V::cell / V::block);
            for (int x = 0; x < now.cols; ++x)
            {
                const bool isSame = std::abs(here[x] - there[x]) <= 9 * T::stillness / 2;
                const bool isMoved = sources[x] && shifts[x * V::cell / V::block][0] != TemporalState::noShift;
                sources[x] = (uchar)((isSame ? SAME_PLACE : 0) | (isMoved ? MOVED_PLACE : 0));
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
