// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_join.hpp"
#include "temporal_join.simd.hpp"
#include "video/temporal_join.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"

#include <cstring>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef TemporalJoin T;
typedef VideoFollowing V;

HDP_DISPATCH(unpackRow)
HDP_DISPATCH(changeDisparities)
HDP_DISPATCH(compareDisparities)
HDP_DISPATCH(compareCells)
HDP_DISPATCH(chooseCells)
HDP_DISPATCH(addEvidence)
HDP_DISPATCH(sumWindow)
HDP_DISPATCH(joinRow)

//! Memory for a row
struct RowScratch
{
    explicit RowScratch(int width)
        : unmoved(width), moved(width), unmovedCounts(width), movedCounts(width), choices(width),
          agrees(width + 2 * T::fringe), disparity(width), detail(width)
    {
    }
    std::vector<int> unmoved, moved; // disparities of the last frame
    std::vector<uchar> unmovedCounts, movedCounts, choices, agrees;
    std::vector<ushort> disparity;
    std::vector<uchar> detail;
};

//! The disparities that the motion takes to the first pixels of a row's cells
void takeMovedCells(const TemporalState& s, int y, std::vector<int>& finer)
{
    const Vec2s* shifts = s.shifts.ptr<Vec2s>(y / V::block);
    const Size size = s.last.disparity.size();
    for (int j = 0; j < s.sources.cols; ++j)
    {
        const Point at = shifted(j * V::cell, y, shifts[j * V::cell / V::block], size);
        finer[j] = s.last.disparity.ptr<ushort>(at.y)[at.x] << TemporalFrame::detailBits;
    }
    dispatched::changeDisparities(s.backward.change(), y, V::cell, s.sources.cols, finer.data());
}

void correctDrift(const Mat& measured, TemporalState& s)
{
    const float unit = 1.f / subpixelScale;
    std::vector<float> predicted, now;
    std::vector<int> moved(s.sources.cols);
    for (int i = 0; i < s.sources.rows; i += T::driftStep)
    {
        takeMovedCells(s, i * V::cell, moved);
        for (int j = 0; j < s.sources.cols; j += T::driftStep)
            if (s.sources.ptr(i)[j] & MOVED_PLACE)
            {
                predicted.push_back(moved[j] / (float)TemporalFrame::scale);
                now.push_back(measured.ptr<ushort>(i * V::cell)[j * V::cell] * unit);
            }
    }
    correctChange(predicted, now, s.backward.change());
}

//! Compares costs in each cell whose first pixel has another disparity in the last frame.
void compareCosts(const CensusCost& cost, const Mat& measured, TemporalState& s)
{
    const int cells = s.sources.cols, offset = T::costOffset * cost.comparisons() / 24;
    s.evidence.create(s.sources.size(), CV_16SC(EVIDENCE_CHANNELS));
    parallel_for_(Range(0, s.sources.rows), [&](const Range& rows) {
        RowScratch scratch(cells);
        uchar* const different = scratch.choices.data();
        for (int i = rows.start; i < rows.end; ++i)
        {
            const int y = i * V::cell;
            if (!s.motion.isStill)
                takeMovedCells(s, y, scratch.moved);
            dispatched::compareDisparities(
                measured.ptr<ushort>(y), s.last.disparity.ptr<ushort>(y), scratch.moved.data(), cells,
                TemporalSources::farthest * subpixelScale / s.layer.scale, s.sources.ptr(i), different);
            int count = 0;
            for (int j = 0; j < cells; ++j)
            {
                scratch.unmoved[count] = j;
                count += different[j] != 0;
            }
            short* const evidence = s.evidence.ptr<short>(i);
            std::fill(evidence, evidence + cells * EVIDENCE_CHANNELS, (short)0);
            ComparedRow compared[V::cell];
            for (int k = 0; k < V::cell; ++k)
            {
                const ComparedRow row = { cost.leftPixels(y + k),
                                          cost.rightPlane(0, y + k) + measured.cols - 1,
                                          cost.planeStride(),
                                          cost.planes(),
                                          cost.comparisons() / 2,
                                          measured.ptr<ushort>(y + k),
                                          s.last.disparity.ptr<ushort>(y + k) };
                compared[k] = row;
            }
            dispatched::compareCells(compared, scratch.moved.data(), different, scratch.unmoved.data(), count, offset,
                                     evidence);
        }
    });
}

/** Chooses by the sums over a window around each cell; beside the image there is no evidence.
@return Whether much of what could be taken from the last frame is not: its pair was a wrong one, or this one is. */
bool choose(TemporalState& s)
{
    const Size cells = s.evidence.size();
    const int radius = T::window / 2, stripeHeight = 32, stripes = (cells.height + stripeHeight - 1) / stripeHeight;
    const bool isStill = s.motion.isStill;
    std::vector<int> sourceCounts(cells.height), contradicted(cells.height);
    s.choices.create(cells, CV_8U);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        const Range rows(range.start * stripeHeight, std::min(range.end * stripeHeight, cells.height));
        const int length = cells.width * EVIDENCE_CHANNELS;
        std::vector<short> columns(length + (T::window - 1) * EVIDENCE_CHANNELS), sums(length);
        const auto add = [&](int y, int sign) {
            if (y >= 0 && y < cells.height)
                dispatched::addEvidence(s.evidence.ptr<short>(y), sign, length, &columns[radius * EVIDENCE_CHANNELS]);
        };
        for (int y = rows.start - radius; y < rows.start + radius; ++y)
            add(y, 1);
        for (int y = rows.start; y < rows.end; ++y)
        {
            add(y + radius, 1);
            dispatched::sumWindow(columns.data(), length, sums.data());
            const uchar* sources = s.sources.ptr(y);
            sourceCounts[y] = (int)(cells.width - std::count(sources, sources + cells.width, 0));
            contradicted[y] = dispatched::chooseCells(sums.data(), sources, cells.width, isStill,
                                                      s.age == 1 ? T::wrongShare : T::movedShare, s.choices.ptr(y));
            add(y - radius, -1);
        }
    });
    const int64 all = std::accumulate(sourceCounts.begin(), sourceCounts.end(), (int64)0);
    return 100 * std::accumulate(contradicted.begin(), contradicted.end(), (int64)0) > T::contradictedShare * all;
}

//! The pixels of a row come from where the motion leads.
void takeMoved(const TemporalState& s, int y, RowScratch& scratch)
{
    const Vec2s* shifts = s.shifts.ptr<Vec2s>(y / V::block);
    const Size size = s.last.disparity.size();
    for (int x = 0; x < size.width; x += V::block)
    {
        const Vec2s& shift = shifts[x / V::block];
        const int fromX = x + shift[0], fromY = shifted(x, y, shift, size).y, end = std::min(x + V::block, size.width);
        const ushort* disparity = s.last.disparity.ptr<ushort>(fromY);
        const uchar* detail = s.last.detail.ptr(fromY);
        if (fromX >= 0 && fromX + V::block <= size.width && x + V::block <= size.width)
        {
            std::memcpy(&scratch.disparity[x], disparity + fromX, V::block * sizeof(ushort));
            std::memcpy(&scratch.detail[x], detail + fromX, V::block);
            continue;
        }
        for (int i = x; i < end; ++i)
        {
            const int from = shifted(i, y, shift, size).x;
            scratch.disparity[i] = disparity[from];
            scratch.detail[i] = detail[from];
        }
    }
    dispatched::unpackRow(scratch.disparity.data(), scratch.detail.data(), size.width, scratch.moved.data(),
                          scratch.movedCounts.data());
    dispatched::changeDisparities(s.backward.change(), y, 1, size.width, scratch.moved.data());
}

void joinRow(const Mat& measured, int y, RowScratch& scratch, TemporalState& s)
{
    const int width = measured.cols, cells = s.choices.cols;
    const uchar* choices = s.choices.ptr(std::min(y / V::cell, s.choices.rows - 1));
    for (int j = 0; j < cells; ++j)
        for (int k = 0; k < V::cell; ++k)
            scratch.choices[j * V::cell + k] = choices[j];
    std::fill(scratch.choices.begin() + cells * V::cell, scratch.choices.end(), choices[cells - 1]);
    dispatched::unpackRow(s.last.disparity.ptr<ushort>(y), s.last.detail.ptr(y), width, scratch.unmoved.data(),
                          scratch.unmovedCounts.data());
    if (!s.motion.isStill)
        takeMoved(s, y, scratch);
    const TemporalRow row = {
        scratch.agrees.data() + T::fringe, scratch.choices.data(),    scratch.unmoved.data(), scratch.moved.data(),
        scratch.unmovedCounts.data(),      scratch.movedCounts.data()
    };
    const int tolerance = std::max(T::tolerance / s.layer.scale, 1) * TemporalFrame::scale;
    const JoinRule rule = { tolerance, T::maxStep * TemporalFrame::scale,
                            s.motion.isStill ? T::maxCount : T::maxUnmovedCount, T::maxMovedCount, T::maxCount };
    dispatched::joinRow(measured.ptr<ushort>(y), row, width, rule, s.next.disparity.ptr<ushort>(y),
                        s.next.detail.ptr(y));
}

void beginAnew(const Mat& disparity, TemporalState& s)
{
    s.age = 0;
    disparity.copyTo(s.next.disparity);
    s.next.detail.setTo(Scalar(1 << (2 * TemporalFrame::detailBits - 1) | 1)); // no rest, one frame
}

void join(const CensusCost& cost, Mat& disparity, TemporalState& s)
{
    if (!s.motion.isStill)
        correctDrift(disparity, s);
    compareCosts(cost, disparity, s);
    if (choose(s))
        return beginAnew(disparity, s);
    parallel_for_(Range(0, disparity.rows), [&](const Range& rows) {
        RowScratch scratch(disparity.cols);
        for (int y = rows.start; y < rows.end; ++y)
            joinRow(disparity, y, scratch, s);
    });
    s.next.disparity.copyTo(disparity);
}

} // namespace

void joinLastFrame(const CensusCost& cost, TemporalState& s, Mat& disparity)
{
    const Size size = disparity.size();
    if (std::min(size.width, size.height) < V::cell)
        return;
    s.next.disparity.create(size, CV_16U);
    s.next.detail.create(size, CV_8U);
    if (s.age == 0)
        beginAnew(disparity, s);
    else
        join(cost, disparity, s);
    std::swap(s.last, s.next);
}

}}} // namespace cv::stereo::hdp
