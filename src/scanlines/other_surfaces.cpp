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
HDP_TUNABLE(int, minStripeHeight, 16, "rows of the upper layer", "for the same reason");

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
    void addBlock(const SurfaceBuffers& buffers, int row, int column)
    {
        for (int map = 0; map < 2; ++map)
        {
            add(2 * buffers.blockMin[map].at<ushort>(row, column));
            add(2 * buffers.blockMax[map].at<ushort>(row, column));
        }
    }
};

SurfaceList listSurfaces(const SurfaceBuffers& buffers, int row, int column)
{
    const int lastRow = buffers.blockMin[0].rows - 1, lastColumn = buffers.blockMin[0].cols - 1;
    SurfaceList list;
    list.addBlock(buffers, row, column);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, lastRow); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, lastColumn); ++x)
            list.addBlock(buffers, y, x);
    return list;
}

//! The match in the square of each pixel of a row of the layer above
void spreadMatches(const Mat& matches, int upperRow, std::vector<ushort>& row)
{
    const int spacing = SparseMatches::spacing / 2;
    const ushort* match = matches.ptr<ushort>(std::min(upperRow / spacing, matches.rows - 1));
    for (int x = 0; x < (int)row.size(); ++x)
        row[x] = match[std::min(x / spacing, matches.cols - 1)];
}

//! The costs of surfaces in the window of a pixel of the layer above
class WindowCosts
{
public:
    WindowCosts(const CensusCost& cost, int numDisparities, int y, int x)
        : planes_(cost.data()), numDisparities_(numDisparities)
    {
        const int row = std::min(std::max(2 * y - 1, 0), cost.size().height - window);
        const int column = std::min(std::max(2 * x - 1, 0), cost.size().width - window);
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

//! The other surface of a pixel; others: those that may be in place of the usual one
int chooseSurface(const WindowCosts& costs, int usual, const SurfaceList& others)
{
    int chosen = usual, pair[2];
    costs.evaluate(usual, others.surfaces[0], pair);
    int lowest = pair[0] - margin;
    const auto compare = [&](int surface, int cost) {
        chosen = cost < lowest ? surface : chosen;
        lowest = std::min(lowest, cost);
    };
    compare(others.surfaces[0], pair[1]);
    for (int i = 1; i < others.count; i += 2)
    {
        const int second = std::min(i + 1, others.count - 1);
        costs.evaluate(others.surfaces[i], others.surfaces[second], pair);
        compare(others.surfaces[i], pair[0]);
        compare(others.surfaces[second], pair[1]);
    }
    return chosen;
}

//! findOtherSurfaces() for some rows of the layer above
class SurfaceRows
{
public:
    SurfaceRows(const WindowPrediction& prediction, const CensusCost& cost, int numDisparities, SurfaceBuffers& buffers,
                Mat& others)
        : prediction_(prediction), maps_{ prediction.upper, prediction.unfiltered }, cost_(cost),
          numDisparities_(numDisparities), buffers_(buffers), others_(others), width_(prediction.upper.cols),
          hasWindows_(std::min(cost.size().width, cost.size().height) >= window)
    {
    }

    void findExtremes(const Range& blockRows)
    {
        for (int i = blockRows.start; i < blockRows.end; ++i)
            for (int map = 0; map < 2; ++map)
            {
                const int rows = std::min(side, maps_[map].rows - i * side);
                dispatched::findBlockExtremes(maps_[map].ptr<ushort>(i * side), maps_[map].step1(), rows, width_,
                                              buffers_.blockMin[map].ptr<ushort>(i),
                                              buffers_.blockMax[map].ptr<ushort>(i));
            }
    }

    void find(const Range& rows)
    {
        const Mat kernel = Mat::ones(2 * neighborhood + 1, 2 * neighborhood + 1, CV_8U);
        for (int map = 0; map < 2; ++map)
        {
            Mat minima = buffers_.min[map].rowRange(rows), maxima = buffers_.max[map].rowRange(rows);
            erode(maps_[map].rowRange(rows), minima, kernel); // a stripe sees its neighbours' rows
            dilate(maps_[map].rowRange(rows), maxima, kernel);
        }
        std::vector<ushort> matches(width_);
        std::vector<int> blocks; // with several surfaces around
        std::vector<SurfaceList> lists;
        for (int y = rows.start; y < rows.end; ++y)
        {
            spreadMatches(prediction_.matches, y, matches);
            dispatched::findUsualSurfaces(rowOf(0, y), rowOf(1, y), matches.data(), width_, others_.ptr<ushort>(y));
            if (!hasWindows_)
                continue;
            if (y == rows.start || y % side == 0)
            {
                findSteps(y / side, blocks);
                lists.clear();
                for (int block : blocks)
                    lists.push_back(listSurfaces(buffers_, y / side, block));
            }
            for (size_t i = 0; i < blocks.size(); ++i)
                chooseInBlock(y, blocks[i] * side, lists[i]);
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
        const Range around(std::max(row - 1, 0), std::min(row + 2, buffers_.blockMin[0].rows));
        const int count = buffers_.blockMin[0].cols;
        std::vector<ushort> lowest(count + 2, USHRT_MAX), highest(count + 2, 0); // with a block more at both ends
        for (int map = 0; map < 2; ++map)
            for (int y = around.start; y < around.end; ++y)
            {
                const ushort* min = buffers_.blockMin[map].ptr<ushort>(y);
                const ushort* max = buffers_.blockMax[map].ptr<ushort>(y);
                for (int i = 0; i < count; ++i)
                {
                    lowest[i + 1] = std::min(lowest[i + 1], min[i]);
                    highest[i + 1] = std::max(highest[i + 1], max[i]);
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

    //! A row of a block from column x on
    void chooseInBlock(int y, int x, const SurfaceList& listed)
    {
        const ushort* own = prediction_.upper.ptr<ushort>(y);
        ushort* others = others_.ptr<ushort>(y);
        for (const int end = std::min(x + side, width_); x < end; ++x)
        {
            const int here = 2 * own[x], usual = others[x];
            if (usual == here)
                continue;
            SurfaceList list;
            for (int i = 0; i < listed.count; ++i)
                if (areApart(listed.surfaces[i], here) && areApart(listed.surfaces[i], usual))
                    list.surfaces[list.count++] = listed.surfaces[i];
            if (list.count > 0)
                others[x] = (ushort)chooseSurface(WindowCosts(cost_, numDisparities_, y, x), usual, list);
        }
    }

    const WindowPrediction& prediction_;
    const Mat maps_[2];
    const CensusCost& cost_;
    const int numDisparities_;
    SurfaceBuffers& buffers_;
    Mat& others_;
    const int width_;
    const bool hasWindows_;
};

} // namespace

void findOtherSurfaces(const WindowPrediction& prediction, const CensusCost& cost, int numDisparities,
                       SurfaceBuffers& buffers, Mat& others)
{
    const Size size = prediction.upper.size(), blocks((size.width + side - 1) / side, (size.height + side - 1) / side);
    for (int map = 0; map < 2; ++map)
    {
        buffers.min[map].create(size, CV_16U);
        buffers.max[map].create(size, CV_16U);
        buffers.blockMin[map].create(blocks, CV_16U);
        buffers.blockMax[map].create(blocks, CV_16U);
    }
    others.create(size, CV_16U);
    SurfaceRows all(prediction, cost, numDisparities, buffers, others);
    parallel_for_(Range(0, blocks.height), [&](const Range& blockRows) { all.findExtremes(blockRows); });
    const int stripes = std::max(1, std::min<int>(maxStripes, size.height / minStripeHeight));
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
            all.find(Range(size.height * i / stripes, size.height * (i + 1) / stripes));
    });
}

}}} // namespace cv::stereo::hdp
