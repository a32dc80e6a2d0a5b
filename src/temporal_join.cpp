// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "temporal_join.hpp"
#include "temporal_join.simd.hpp"
#include "temporal_join.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include <cstring>

namespace cv {
namespace stereo {
namespace hdp {

namespace {

typedef TemporalJoin T;
typedef VideoFollowing V;

void dispatchUnpack(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts)
{
    CV_CPU_DISPATCH(unpackRow, (disparity, detail, width, finer, counts), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchChange(const DisparityChange& change, int y, int step, int count, int* finer)
{
    CV_CPU_DISPATCH(changeDisparities, (change, y, step, count, finer), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchCompare(const ushort* measured, const ushort* unmoved, const int* moved, int count, uchar* sources,
                     uchar* different)
{
    CV_CPU_DISPATCH(compareDisparities, (measured, unmoved, moved, count, sources, different),
                    CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchSum(const uchar* const* rows, int radius, int width, ushort* columns, ushort* sums)
{
    CV_CPU_DISPATCH(sumSquares, (rows, radius, width, columns, sums), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchAdd(const short* evidence, int sign, int length, short* columns)
{
    CV_CPU_DISPATCH(addEvidence, (evidence, sign, length, columns), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchWindow(const short* columns, int length, short* sums)
{
    CV_CPU_DISPATCH(sumWindow, (columns, length, sums), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchJoin(const ushort* measured, const TemporalRow& row, int width, const JoinRule& rule, ushort* disparity,
                  uchar* detail)
{
    CV_CPU_DISPATCH(joinRow, (measured, row, width, rule, disparity, detail), CV_CPU_DISPATCH_MODES_ALL);
}

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
        dispatchSum(rows, radius, image.cols, columns_.data() + maxRadius, sums_.data());
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

//! What looks different where the motion leads, by more than noise and by about the contrast, is something else.
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

//! The cost of a pixel; half of the bits if the right image does not show its match
int costOf(const CensusCost& cost, const Point& pixel, int disparity)
{
    const int candidate = wholeDisparity(disparity);
    return candidate > pixel.x ? cost.comparisons() / 2 : cost.at(pixel, candidate);
}

//! Memory for a row
struct RowScratch
{
    explicit RowScratch(int width)
        : unmoved(width), moved(width), unmovedCounts(width), movedCounts(width), choices(width), disparity(width),
          detail(width)
    {
    }
    std::vector<int> unmoved, moved; // disparities of the last frame
    std::vector<uchar> unmovedCounts, movedCounts, choices;
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
    dispatchChange(s.backward.change(), y, V::cell, s.sources.cols, finer.data());
}

//! Adds what two pixels of a cell tell, those on its diagonal.
void compareCell(const CensusCost& cost, Point cell, const Mat& measured, const Mat& last, int moved, int sources,
                 int offset, Vec4s& evidence)
{
    for (int i = 0; i < V::cell; ++i)
    {
        const Point pixel(V::cell * cell.x + i, V::cell * cell.y + i);
        const int here = costOf(cost, pixel, measured.at<ushort>(pixel));
        if (sources & SAME_PLACE)
        {
            const int there = costOf(cost, pixel, last.at<ushort>(pixel));
            evidence[COST_UNMOVED] = (short)(evidence[COST_UNMOVED] + there - here);
            evidence[SCALE_UNMOVED] = (short)(evidence[SCALE_UNMOVED] + here + offset);
        }
        if (sources & MOVED_PLACE)
        {
            const int there = costOf(cost, pixel, moved);
            evidence[COST_MOVED] = (short)(evidence[COST_MOVED] + there - here);
            evidence[SCALE_MOVED] = (short)(evidence[SCALE_MOVED] + here + offset);
        }
    }
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
            dispatchCompare(measured.ptr<ushort>(y), s.last.disparity.ptr<ushort>(y), scratch.moved.data(), cells,
                            s.sources.ptr(i), different);
            int count = 0;
            for (int j = 0; j < cells; ++j)
            {
                scratch.unmoved[count] = j;
                count += different[j] != 0;
            }
            Vec4s* evidence = s.evidence.ptr<Vec4s>(i);
            std::fill(evidence, evidence + cells, Vec4s());
            for (int k = 0; k < count; ++k)
            {
                const int j = scratch.unmoved[k];
                compareCell(cost, Point(j, i), measured, s.last.disparity,
                            scratch.moved[j] >> TemporalFrame::detailBits, different[j], offset, evidence[j]);
            }
        }
    });
}

TemporalChoice chooseCell(const short* sums, int sources, bool isStill)
{
    const int unmoved = sums[COST_UNMOVED], moved = sums[COST_MOVED];
    const bool hasUnmoved = (sources & SAME_PLACE) != 0, hasMoved = (sources & MOVED_PLACE) != 0;
    if (isStill)
        return hasUnmoved && 100 * unmoved <= T::keptShare * sums[SCALE_UNMOVED] ? UNMOVED : MEASURED;
    const int least = hasMoved ? std::min(moved, 0) : 0;
    const int scale = std::max(sums[SCALE_UNMOVED], sums[SCALE_MOVED]);
    if (hasUnmoved && 100 * (unmoved - least) <= T::movedShare * scale)
        return UNMOVED;
    return hasMoved && 100 * moved <= T::movedShare * sums[SCALE_MOVED] ? MOVED : MEASURED;
}

//! Chooses by the sums over a window around each cell; beside the image there is no evidence.
void choose(TemporalState& s)
{
    const Size cells = s.evidence.size();
    const int radius = T::window / 2, stripeHeight = 32, stripes = (cells.height + stripeHeight - 1) / stripeHeight;
    s.choices.create(cells, CV_8U);
    parallel_for_(Range(0, stripes), [&](const Range& range) {
        const Range rows(range.start * stripeHeight, std::min(range.end * stripeHeight, cells.height));
        const int length = cells.width * EVIDENCE_CHANNELS;
        std::vector<short> columns(length + (T::window - 1) * EVIDENCE_CHANNELS), sums(length);
        const auto add = [&](int y, int sign) {
            if (y >= 0 && y < cells.height)
                dispatchAdd(s.evidence.ptr<short>(y), sign, length, &columns[radius * EVIDENCE_CHANNELS]);
        };
        for (int y = rows.start - radius; y < rows.start + radius; ++y)
            add(y, 1);
        for (int y = rows.start; y < rows.end; ++y)
        {
            add(y + radius, 1);
            dispatchWindow(columns.data(), length, sums.data());
            const uchar* sources = s.sources.ptr(y);
            uchar* choices = s.choices.ptr(y);
            for (int x = 0; x < cells.width; ++x)
                choices[x] = (uchar)chooseCell(&sums[x * EVIDENCE_CHANNELS], sources[x], s.motion.isStill);
            add(y - radius, -1);
        }
    });
}

//! Whether most of what could be taken from the last frame is not: its pair was a wrong one, or this one is.
bool isContradicted(const TemporalState& s)
{
    int64 sources = 0, contradicted = 0;
    for (int y = 0; y < s.choices.rows; ++y)
        for (int x = 0; x < s.choices.cols; ++x)
        {
            const int hasSource = s.sources.ptr(y)[x] != 0;
            sources += hasSource;
            contradicted += hasSource & (s.choices.ptr(y)[x] == MEASURED);
        }
    return 2 * contradicted > sources;
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
    dispatchUnpack(scratch.disparity.data(), scratch.detail.data(), size.width, scratch.moved.data(),
                   scratch.movedCounts.data());
    dispatchChange(s.backward.change(), y, 1, size.width, scratch.moved.data());
}

void joinRow(const Mat& measured, int y, RowScratch& scratch, TemporalState& s)
{
    const int width = measured.cols, cells = s.choices.cols;
    const uchar* choices = s.choices.ptr(std::min(y / V::cell, s.choices.rows - 1));
    for (int j = 0; j < cells; ++j)
        for (int k = 0; k < V::cell; ++k)
            scratch.choices[j * V::cell + k] = choices[j];
    std::fill(scratch.choices.begin() + cells * V::cell, scratch.choices.end(), choices[cells - 1]);
    dispatchUnpack(s.last.disparity.ptr<ushort>(y), s.last.detail.ptr(y), width, scratch.unmoved.data(),
                   scratch.unmovedCounts.data());
    if (!s.motion.isStill)
        takeMoved(s, y, scratch);
    const TemporalRow row = { scratch.choices.data(), scratch.unmoved.data(), scratch.moved.data(),
                              scratch.unmovedCounts.data(), scratch.movedCounts.data() };
    const int tolerance = std::max(T::tolerance / s.layer.scale, 1) * TemporalFrame::scale;
    const JoinRule rule = { tolerance, T::maxStep * TemporalFrame::scale,
                            s.motion.isStill ? T::maxCount : T::maxUnmovedCount, T::maxMovedCount, T::maxCount };
    dispatchJoin(measured.ptr<ushort>(y), row, width, rule, s.next.disparity.ptr<ushort>(y), s.next.detail.ptr(y));
}

void beginAnew(const Mat& disparity, TemporalState& s)
{
    s.age = 0;
    disparity.copyTo(s.next.disparity);
    s.next.detail.setTo(Scalar(1 << (2 * TemporalFrame::detailBits - 1) | 1)); // no rest, one frame
}

void join(const CensusCost& cost, Mat& disparity, TemporalState& s)
{
    findSources(s);
    compareCosts(cost, disparity, s);
    choose(s);
    if (isContradicted(s))
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

} // namespace hdp
} // namespace stereo
} // namespace cv
