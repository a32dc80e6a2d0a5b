// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "other_surfaces.hpp"
#include "candidate_windows.hpp"
#include "other_surfaces.simd.hpp"
#include "scanlines/other_surfaces.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "../base/tunable.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, neighborhood, 3, "pixels of the upper layer",
            "in which the usual surface beyond a discontinuity is: in more there is often a third one");
HDP_TUNABLE(int, margin, 16, "bits over the window",
            "by which another surface is better: more misses surfaces, less takes noise for them");
HDP_TUNABLE(int, maxStripes, 16, "stripes", "for as many threads: more filter the rows between them twice");
HDP_TUNABLE(int, minStripeHeight, 4, "rows of blocks", "for the same reason");

const int distance = OtherSurface::distance * subpixelScale, side = OtherSurface::block, window = OtherSurface::window;

HDP_DISPATCH(findUsualSurfaces)
HDP_DISPATCH(findBlockExtremes)
HDP_DISPATCH(lowestRunCosts)

bool areApart(int a, int b) { return std::abs(a - b) >= distance; }

//! Surfaces apart from each other, in 1 / subpixelScale pixel of the layer
struct SurfaceList
{
    int count = 0, surfaces[OtherSurface::listed];

    void add(int surface)
    {
        for (int i = 0; i < count; ++i)
            if (!areApart(surface, surfaces[i])) // mostly the first one
                return;
        if (count < OtherSurface::listed)
            surfaces[count++] = surface;
    }
};

SurfaceList listSurfaces(const Mat& blocks, int row, int column)
{
    SurfaceList list;
    const auto addBlock = [&](const Vec4w& extremes) {
        for (int i = 0; i < 4; ++i)
            list.add(2 * extremes[i]);
    };
    addBlock(blocks.ptr<Vec4w>(row)[column]);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, blocks.rows - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, blocks.cols - 1); ++x)
            addBlock(blocks.ptr<Vec4w>(y)[x]);
    return list;
}

//! The match in the square of each pixel of a row of the layer above; row: its squares
void spreadMatches(const ushort* matches, int squares, std::vector<ushort>& row)
{
    const int spacing = SparseMatches::spacing / 2, width = (int)row.size();
    for (int x = 0; x < width; x += spacing)
        std::fill(row.begin() + x, row.begin() + std::min(x + spacing, width),
                  matches[std::min(x / spacing, squares - 1)]);
}

//! The costs of surfaces in the window of a group of 2 x 2 pixels of the layer above
class WindowCosts
{
public:
    //! y, x: of the group's first pixel
    WindowCosts(const CensusCost& cost, int numDisparities, int y, int x)
        : planes_(cost.data()), numDisparities_(numDisparities)
    {
        const int row = std::min(2 * y, cost.size().height - window);
        const int column = std::min(2 * x, cost.size().width - window);
        left_ = cost.leftPixels(row) + 4 * column;
        right_ = cost.rightPlane(0, row) + cost.size().width - 1 - column;
    }
    //! Of two surfaces
    void evaluate(int first, int second, int* costs) const
    {
        dispatched::lowestRunCosts(left_, right_ + firstOfRun(first), right_ + firstOfRun(second), planes_, costs);
    }

private:
    int firstOfRun(int surface) const
    {
        return firstCandidate(wholeDisparity(surface), CandidateWindow::runLength, numDisparities_);
    }

    const CensusPlanes& planes_;
    const int numDisparities_;
    const uchar *left_, *right_;
};

//! The listed surfaces that may be in place of a pixel's usual one, a bit for each
unsigned rivalsOf(int here, int usual, const SurfaceList& list)
{
    unsigned rivals = 0;
    for (int i = 0; usual != here && i < list.count; ++i)
        rivals |= (unsigned)(areApart(list.surfaces[i], here) && areApart(list.surfaces[i], usual)) << i;
    return rivals;
}

//! findOtherSurfaces() for some rows of the layer above
class SurfaceRows
{
public:
    SurfaceRows(const WindowPrediction& prediction, const CensusCost* cost, int numDisparities, SurfaceBuffers& buffers,
                Mat& others)
        : prediction_(prediction), maps_{ prediction.upper, prediction.unfiltered }, cost_(cost),
          numDisparities_(numDisparities), buffers_(buffers), others_(others), width_(prediction.upper.cols),
          height_(prediction.upper.rows),
          comparesCosts_(cost && std::min(cost->size().width, cost->size().height) >= window)
    {
    }

    void findExtremes(const Range& blockRows)
    {
        for (int i = blockRows.start; i < blockRows.end; ++i)
            for (int map = 0; map < 2; ++map)
            {
                const int rows = std::min(side, maps_[map].rows - i * side);
                dispatched::findBlockExtremes(maps_[map].ptr<ushort>(i * side), maps_[map].step1(), rows, width_,
                                              buffers_.blocks.ptr<ushort>(i) + 2 * map);
            }
    }

    void find(const Range& blockRows)
    {
        const Range rows(blockRows.start * side, std::min(blockRows.end * side, height_));
        for (int map = 0; map < 2; ++map)
        {
            Mat minima = buffers_.min[map].rowRange(rows), maxima = buffers_.max[map].rowRange(rows);
            erode(maps_[map].rowRange(rows), minima, kernel_); // a stripe sees its neighbours' rows
            dilate(maps_[map].rowRange(rows), maxima, kernel_);
        }
        std::vector<ushort> matches(width_);
        std::vector<int> blocks; // with several surfaces around
        for (int i = blockRows.start; i < blockRows.end; ++i)
        {
            for (int y = i * side; y < std::min((i + 1) * side, height_); ++y)
            {
                const Mat& sparse = prediction_.matches;
                const int squareRow = std::min(y / (SparseMatches::spacing / 2), sparse.rows - 1);
                spreadMatches(sparse.ptr<ushort>(squareRow), sparse.cols, matches);
                dispatched::findUsualSurfaces(rowOf(0, y), rowOf(1, y), matches.data(), width_, others_.ptr<ushort>(y));
            }
            if (comparesCosts_)
                findSteps(i, blocks);
            for (int block : blocks)
                chooseInBlock(i, block);
        }
    }

private:
    DisparityRow rowOf(int map, int y) const
    {
        return { maps_[map].ptr<ushort>(y), buffers_.min[map].ptr<ushort>(y), buffers_.max[map].ptr<ushort>(y) };
    }

    //! The blocks of a row around which disparities differ by those of two surfaces
    void findSteps(int row, std::vector<int>& blocks) const
    {
        const Range around(std::max(row - 1, 0), std::min(row + 2, buffers_.blocks.rows));
        const int count = buffers_.blocks.cols;
        std::vector<ushort> lowest(count + 2, USHRT_MAX), highest(count + 2, 0); // with a block more at both ends
        for (int y = around.start; y < around.end; ++y)
        {
            const Vec4w* extremes = buffers_.blocks.ptr<Vec4w>(y);
            for (int i = 0; i < count; ++i)
            {
                lowest[i + 1] = std::min(lowest[i + 1], std::min(extremes[i][0], extremes[i][2]));
                highest[i + 1] = std::max(highest[i + 1], std::max(extremes[i][1], extremes[i][3]));
            }
        }
        blocks.clear();
        for (int i = 0; i < count; ++i)
        {
            const int low = std::min(std::min(lowest[i], lowest[i + 1]), lowest[i + 2]);
            const int high = std::max(std::max(highest[i], highest[i + 1]), highest[i + 2]);
            if (areApart(2 * low, 2 * high))
                blocks.push_back(i);
        }
    }

    void chooseInBlock(int row, int column)
    {
        const SurfaceList list = listSurfaces(buffers_.blocks, row, column);
        for (int y = row * side; y < std::min((row + 1) * side, height_); y += 2)
            for (int x = column * side; x < std::min((column + 1) * side, width_); x += 2)
                chooseInGroup(y, x, list);
    }

    //! In 2 x 2 pixels
    void chooseInGroup(int y, int x, const SurfaceList& list)
    {
        unsigned rivals[4], all = 0;
        const int count = 2 * std::min(height_ - y, 2), columns = std::min(width_ - x, 2); // of pixels
        for (int i = 0; i < count; ++i)
            all |= rivals[i] =
                i % 2 < columns ? rivalsOf(here(y + i / 2, x + i % 2), other(y + i / 2, x + i % 2), list) : 0;
        if (!all)
            return;
        const WindowCosts ofSurfaces(*cost_, numDisparities_, y, x);
        int costs[OtherSurface::listed];
        for (int i = 0; i < list.count; i += 2)
            ofSurfaces.evaluate(list.surfaces[i], list.surfaces[std::min(i + 1, list.count - 1)], costs + i);
        for (int i = 0; i < count; ++i)
            if (rivals[i])
                choose(other(y + i / 2, x + i % 2), rivals[i], list, costs, ofSurfaces);
    }

    //! The best rival in place of the usual surface, if it is clearly better
    static void choose(ushort& usual, unsigned rivals, const SurfaceList& list, const int* costs,
                       const WindowCosts& ofSurfaces)
    {
        int best = -1, same = -1; // the listed surface that the usual one is
        for (int i = list.count - 1; i >= 0; --i)
            if (!(rivals >> i & 1))
                same = areApart(list.surfaces[i], usual) ? same : i;
            else if (best < 0 || costs[i] <= costs[best])
                best = i;
        int pair[2] = { same < 0 ? 0 : costs[same], 0 };
        if (same < 0)
            ofSurfaces.evaluate(usual, usual, pair);
        if (costs[best] < pair[0] - margin)
            usual = (ushort)list.surfaces[best];
    }

    int here(int y, int x) const { return 2 * prediction_.upper.ptr<ushort>(y)[x]; }
    ushort& other(int y, int x) const { return others_.ptr<ushort>(y)[x]; }

    const WindowPrediction& prediction_;
    const Mat maps_[2];
    // Not Mat::ones(): the first thread with an expression sets them up, in OpenCV, which ThreadSanitizer does not see.
    const Mat kernel_ = Mat(2 * neighborhood + 1, 2 * neighborhood + 1, CV_8U, Scalar(1));
    const CensusCost* const cost_;
    const int numDisparities_;
    SurfaceBuffers& buffers_;
    Mat& others_;
    const int width_, height_;
    const bool comparesCosts_;
};

} // namespace

void findOtherSurfaces(const WindowPrediction& prediction, const CensusCost* cost, int numDisparities,
                       SurfaceBuffers& buffers, Mat& others)
{
    const Size size = prediction.upper.size(), blocks((size.width + side - 1) / side, (size.height + side - 1) / side);
    for (int map = 0; map < 2; ++map)
    {
        buffers.min[map].create(size, CV_16U);
        buffers.max[map].create(size, CV_16U);
    }
    buffers.blocks.create(blocks, CV_16UC4);
    others.create(size, CV_16U);
    SurfaceRows all(prediction, cost, numDisparities, buffers, others);
    if (cost)
        parallel_for_(Range(0, blocks.height), [&](const Range& blockRows) { all.findExtremes(blockRows); });
    const int stripes = std::max(1, std::min<int>(maxStripes, blocks.height / minStripeHeight));
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
            all.find(Range(blocks.height * i / stripes, blocks.height * (i + 1) / stripes));
    });
}

}}} // namespace cv::stereo::hdp
