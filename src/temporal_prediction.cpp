// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "temporal_prediction.hpp"

#include "image_levels.hpp"
#include "image_pyramid.hpp"
#include "temporal_prediction.simd.hpp"
#include "temporal_prediction.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv {
namespace stereo {
namespace hdp {

namespace {

typedef TemporalJoin T;

//! In place of the x of a shift: the block comes from nowhere in the last frame.
const short noShift = SHRT_MIN;

//! What a cell may take from the last frame
enum Source
{
    SAME_PLACE = 1, // the image stands still
    MOVED_PLACE = 2 // the camera's motion leads to a pixel of the last frame
};

//! What a cell takes
enum Choice
{
    MEASURED,
    UNMOVED,
    MOVED
};

//! Of a cell, for the two disparities that the last frame may have for it
enum Evidence
{
    COST_UNMOVED, // what it costs more than the measured one
    COST_MOVED,
    SCALE_UNMOVED, // what the measured one costs, and costOffset
    SCALE_MOVED,
    channels
};

//! From a pixel of this frame to where it was; disparities are those of a map, in pixels.
class Backward
{
public:
    Backward(const CameraMotion& motion, const TemporalLayer& layer)
    {
        const Matx44d inverse = motion.forward.inv();
        const Matx44d fromMap(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, layer.minDisparity, 0, 0, 0, 1);
        const Matx44d ofMap = inverse * fromMap;
        for (int i = 0; i < 4; ++i)
        {
            x_[i] = (float)ofMap(0, i);
            y_[i] = (float)ofMap(1, i);
            w_[i] = (float)ofMap(3, i);
        }
        const DisparityChange change = { (float)inverse(3, 0),      (float)inverse(3, 1),
                                         (float)inverse(3, 2),      (float)inverse(3, 3),
                                         (float)layer.minDisparity, (float)layer.largest / subpixelScale };
        change_ = change;
    }

    Point2f place(int x, int y, float disparity) const
    {
        const float w = w_[0] * x + w_[1] * y + w_[2] * disparity + w_[3];
        const float factor = w > 0.001f ? 1 / w : -1;
        return Point2f((x_[0] * x + x_[1] * y + x_[2] * disparity + x_[3]) * factor,
                       (y_[0] * x + y_[1] * y + y_[2] * disparity + y_[3]) * factor);
    }

    const DisparityChange& change() const { return change_; }

private:
    float x_[4], y_[4], w_[4];
    DisparityChange change_;
};

void dispatchUnpack(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts)
{
    CV_CPU_DISPATCH(unpackRow, (disparity, detail, width, finer, counts), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchChange(const DisparityChange& change, int x, int y, int step, int count, int* finer)
{
    CV_CPU_DISPATCH(changeDisparities, (change, x, y, step, count, finer), CV_CPU_DISPATCH_MODES_ALL);
}

void dispatchJoin(const ushort* measured, const int* before, const uchar* counts, int width, const JoinRule& rule,
                  ushort* disparity, uchar* detail)
{
    CV_CPU_DISPATCH(joinRun, (measured, before, counts, width, rule, disparity, detail), CV_CPU_DISPATCH_MODES_ALL);
}

void buildGrey(const Mat& left, TemporalState& s)
{
    std::vector<Mat>& pyramid = s.next.grey;
    halveImage(left, s.halved);
    pyramid.resize(trackingLevels(s.halved.cols));
    s.halved.convertTo(pyramid[0], CV_8U, 1. / greyScale);
    for (size_t level = 1; level < pyramid.size(); ++level)
        halveImage(pyramid[level - 1], pyramid[level]);
}

void beginAnew(const Mat& disparity, TemporalState& s)
{
    disparity.copyTo(s.next.disparity);
    s.next.detail.create(disparity.size(), CV_8U);
    s.next.detail.setTo(Scalar(1 << (2 * TemporalFrame::detailBits - 1) | 1)); // no rest, one frame
    std::swap(s.last, s.next);
}

//! From the last frame to this one
void findMotion(TemporalState& s)
{
    const std::vector<Mat>&before = s.last.grey, &now = s.next.grey;
    trackPoints(before, now, s.points);
    for (TrackedPoint& point : s.points)
    {
        const int x = T::cell * (int)point.before.x, y = T::cell * (int)point.before.y;
        const double disparity = s.last.disparity.at<ushort>(y, x) / (double)subpixelScale + s.layer.minDisparity;
        point.disparity = disparity / T::cell;
    }
    const int corrections = 2;
    CameraMotion motion = fitMotion(s.points, now[0].size());
    for (int i = 0; i < corrections; ++i)
    {
        trackPointsAgain(before, now, motion, s.points);
        motion = fitMotion(s.points, now[0].size());
    }
    s.motion = scaled(motion, T::cell);
}

//! Where blocks were depends on their disparities, and these on where they were: from what the last frame had at the
//! same place, some steps lead to both.
void findShifts(const Backward& backward, TemporalState& s)
{
    const Size size = s.last.disparity.size();
    const int steps = 4, maxLastStep = 2;
    s.shifts.create((size.height + T::block - 1) / T::block, (size.width + T::block - 1) / T::block, CV_16SC2);
    parallel_for_(Range(0, s.shifts.rows), [&](const Range& rows) {
        for (int i = rows.start; i < rows.end; ++i)
        {
            const int y = std::min(i * T::block + T::block / 2, size.height - 1);
            const DisparityChange change = backward.change();
            const float unit = 1.f / subpixelScale, ofRow = change.ofRow(y);
            Vec2s* const shifts = s.shifts.ptr<Vec2s>(i);
            for (int j = 0; j < s.shifts.cols; ++j)
            {
                const int x = std::min(j * T::block + T::block / 2, size.width - 1);
                Point at(x, y);
                float disparity = s.last.disparity.ptr<ushort>(y)[x] * unit;
                int lastStep = 0;
                bool isInside = true;
                for (int step = 0; step < steps; ++step)
                {
                    const Point2f place = backward.place(x, y, disparity);
                    isInside = place.x >= 0 && place.y >= 0 && place.x <= size.width - 1 && place.y <= size.height - 1;
                    if (!isInside)
                        break;
                    const Point next((int)(place.x + 0.5f), (int)(place.y + 0.5f));
                    lastStep = std::abs(next.x - at.x) + std::abs(next.y - at.y);
                    at = next;
                    if (lastStep == 0 && step > 0)
                        break;
                    disparity = change.now(s.last.disparity.ptr<ushort>(at.y)[at.x] * unit, change.ofX * x + ofRow);
                }
                shifts[j] = isInside && lastStep <= maxLastStep ? Vec2s((short)(at.x - x), (short)(at.y - y))
                                                                : Vec2s(noShift, 0);
            }
        }
    });
}

//! The pixel that a shift leads to
Point shifted(int x, int y, const Vec2s& shift, Size size)
{
    return Point(std::min(std::max(x + shift[0], 0), size.width - 1),
                 std::min(std::max(y + shift[1], 0), size.height - 1));
}

//! Whether this frame shows another scene: on the coarsest level, about as much changed as there is contrast.
bool isCut(const TemporalState& s)
{
    const int level = (int)s.next.grey.size() - 1, side = T::cell << level;
    const Mat &before = s.last.grey[level], &now = s.next.grey[level];
    const int mean = cvRound(cv::mean(now)[0]);
    int64 known = 0, change = 0, contrast = 0;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
        {
            Point at(x, y);
            if (!s.motion.isStill)
            {
                const int px = x * side + side / 2, py = y * side + side / 2;
                const Vec2s& shift = s.shifts.ptr<Vec2s>(py / T::block)[px / T::block];
                if (shift[0] == noShift)
                    continue;
                at = shifted(px, py, shift, s.last.disparity.size()) / side;
                at = Point(std::min(at.x, before.cols - 1), std::min(at.y, before.rows - 1));
            }
            ++known;
            change += std::abs(now.ptr(y)[x] - before.ptr(at.y)[at.x]);
            contrast += std::abs(now.ptr(y)[x] - mean);
        }
    const int noise = 4; // levels
    return 4 * known < (int64)now.total() || (change > noise * known && 100 * change > T::cutShare * contrast);
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

//! With a camera at rest, what changes by more than noise and by about the contrast is something else.
void findUnchanged(TemporalState& s)
{
    const Mat &before = s.last.grey[0], &now = s.next.grey[0];
    absdiff(now, before, s.change[0]);
    blur(s.change[0], s.change[1], Size(3, 3));
    blur(now, s.smooth[0], Size(5, 5));
    absdiff(now, s.smooth[0], s.contrast[0]);
    blur(s.contrast[0], s.contrast[1], Size(5, 5));
    const int noise = T::stillness + T::noiseFactor * medianLevel(s.change[0]);
    s.sources.create(now.size(), CV_8U);
    for (int y = 0; y < now.rows; ++y)
    {
        const uchar *change = s.change[1].ptr(y), *contrast = s.contrast[1].ptr(y);
        uchar* sources = s.sources.ptr(y);
        for (int x = 0; x < now.cols; ++x)
        {
            const bool isSame = change[x] <= noise || 100 * change[x] <= T::contrastShare * contrast[x];
            sources[x] = isSame ? SAME_PLACE : 0;
        }
    }
}

void findSources(TemporalState& s)
{
    const Mat &before = s.last.grey[0], &now = s.next.grey[0];
    blur(before, s.smooth[0], Size(3, 3));
    blur(now, s.smooth[1], Size(3, 3));
    absdiff(s.smooth[0], s.smooth[1], s.change[0]);
    s.sources.create(now.size(), CV_8U);
    for (int y = 0; y < now.rows; ++y)
    {
        const uchar* change = s.change[0].ptr(y);
        const Vec2s* shifts = s.shifts.ptr<Vec2s>(y * T::cell / T::block);
        uchar* sources = s.sources.ptr(y);
        for (int x = 0; x < now.cols; ++x)
            sources[x] = (uchar)((change[x] < T::stillness ? SAME_PLACE : 0) |
                                 (shifts[x * T::cell / T::block][0] != noShift ? MOVED_PLACE : 0));
    }
}

int censusDifference(const CensusCost& cost, const uchar* left, const uchar* right)
{
    unsigned bits = 0;
    for (int plane = 0; plane < cost.planes(); ++plane, right += cost.planeStride())
        bits |= (unsigned)(left[plane] ^ *right) << (8 * plane);
    return countCensusBits(bits);
}

//! Memory for a row
struct RowScratch
{
    explicit RowScratch(int width) : before(width), counts(width) {}
    std::vector<int> before; // disparities of the last frame
    std::vector<uchar> counts;
};

//! The disparities that the motion takes to the first pixels of a row's cells
void takeMovedCells(const Backward& backward, const TemporalState& s, int y, std::vector<int>& before)
{
    const Vec2s* shifts = s.shifts.ptr<Vec2s>(y / T::block);
    const Size size = s.last.disparity.size();
    for (int j = 0; j < s.sources.cols; ++j)
    {
        const Point at = shifted(j * T::cell, y, shifts[j * T::cell / T::block], size);
        before[j] = s.last.disparity.ptr<ushort>(at.y)[at.x] << TemporalFrame::detailBits;
    }
    dispatchChange(backward.change(), 0, y, T::cell, s.sources.cols, before.data());
}

//! Compares costs at a pixel of each cell.
void compareCosts(const CensusCost& cost, const Backward& backward, const Mat& measured, TemporalState& s)
{
    const Size size = measured.size();
    const bool isStill = s.motion.isStill;
    const int offset = T::costOffset * cost.comparisons() / 24;
    s.evidence.create(s.sources.size(), CV_16SC(channels));
    parallel_for_(Range(0, s.sources.rows), [&](const Range& rows) {
        RowScratch scratch(s.sources.cols);
        for (int i = rows.start; i < rows.end; ++i)
        {
            const int y = i * T::cell;
            const uchar *left = cost.leftPixels(y), *right = cost.rightPlane(0, y) + size.width - 1;
            const ushort *here = measured.ptr<ushort>(y), *there = s.last.disparity.ptr<ushort>(y);
            uchar* sources = s.sources.ptr(i);
            Vec4s* evidence = s.evidence.ptr<Vec4s>(i);
            if (!isStill)
                takeMovedCells(backward, s, y, scratch.before);
            for (int j = 0; j < s.sources.cols; ++j)
            {
                const int x = j * T::cell, moved = scratch.before[j] >> TemporalFrame::detailBits;
                const int before[] = { there[x], sources[j] & MOVED_PLACE ? moved : here[x] };
                if ((sources[j] & MOVED_PLACE) && std::abs(before[0] - before[1]) <= T::sameDisparity * subpixelScale)
                    sources[j] = MOVED_PLACE; // the better of two that are about the same
                evidence[j] = Vec4s();
                int costHere = -1;
                for (int k = 0; k < 2; ++k)
                {
                    if (std::abs(before[k] - here[x]) <= T::sameDisparity * subpixelScale)
                        continue;
                    if (costHere < 0)
                        costHere = censusDifference(cost, left + 4 * x, right - x + wholeDisparity(here[x]));
                    const int costBefore = censusDifference(cost, left + 4 * x, right - x + wholeDisparity(before[k]));
                    evidence[j][COST_UNMOVED + k] = (short)(costBefore - costHere);
                    evidence[j][SCALE_UNMOVED + k] = (short)(costHere + offset);
                }
            }
        }
    });
}

Choice chooseCell(const int* sums, int sources, bool isStill)
{
    const int unmoved = sums[COST_UNMOVED], moved = sums[COST_MOVED];
    const bool hasUnmoved = (sources & SAME_PLACE) != 0, hasMoved = (sources & MOVED_PLACE) != 0;
    if (isStill)
        return hasUnmoved && 100 * unmoved <= T::stillShare * sums[SCALE_UNMOVED] ? UNMOVED : MEASURED;
    const int least = hasMoved ? std::min(moved, 0) : 0;
    const int scale = std::max(sums[SCALE_UNMOVED], sums[SCALE_MOVED]);
    if (hasUnmoved && 100 * (unmoved - least) <= T::unmovedShare * scale)
        return UNMOVED;
    return hasMoved && 100 * moved <= T::movedShare * sums[SCALE_MOVED] ? MOVED : MEASURED;
}

//! Chooses by the sums over a window around each cell.
void choose(TemporalState& s)
{
    const Size cells = s.evidence.size();
    const int radius = T::window / 2, stripeHeight = 32;
    s.choices.create(cells, CV_8U);
    parallel_for_(Range(0, (cells.height + stripeHeight - 1) / stripeHeight), [&](const Range& stripes) {
        const Range rows(stripes.start * stripeHeight, std::min(stripes.end * stripeHeight, cells.height));
        const int before = radius * channels, length = cells.width * channels;
        std::vector<short> columns(length + 2 * before); // sums of the rows in the window; none beside the image
        const auto add = [&](int y, int sign) {
            if (y < 0 || y >= cells.height)
                return;
            const short* row = s.evidence.ptr<short>(y);
            for (int i = 0; i < length; ++i)
                columns[before + i] = (short)(columns[before + i] + sign * row[i]);
        };
        for (int y = rows.start - radius; y < rows.start + radius; ++y)
            add(y, 1);
        for (int y = rows.start; y < rows.end; ++y)
        {
            add(y + radius, 1);
            const uchar* sources = s.sources.ptr(y);
            uchar* choices = s.choices.ptr(y);
            int sums[channels] = { 0 };
            for (int i = 0; i < 2 * before; ++i)
                sums[i % channels] += columns[i];
            for (int x = 0; x < cells.width; ++x)
            {
                const short *first = &columns[x * channels], *last = first + 2 * before;
                for (int c = 0; c < channels; ++c)
                    sums[c] += last[c];
                choices[x] = (uchar)chooseCell(sums, sources[x], s.motion.isStill);
                for (int c = 0; c < channels; ++c)
                    sums[c] -= first[c];
            }
            add(y - radius, -1);
        }
    });
}

JoinRule ruleOf(int choice, const TemporalState& s)
{
    const bool isStill = s.motion.isStill, isMoved = choice == MOVED;
    const int tolerance = std::max(T::tolerance / s.layer.scale, 1) * TemporalFrame::scale;
    const int maxWeight = isStill ? T::maxCount : isMoved ? T::maxMovedCount : T::maxUnmovedCount;
    const JoinRule rule = { tolerance, T::maxStep * TemporalFrame::scale, maxWeight, T::maxCount };
    return rule;
}

//! The pixels of a run come from where the motion leads.
void takeMoved(const Backward& backward, const TemporalState& s, int y, const Range& run, RowScratch& scratch)
{
    const Vec2s* shifts = s.shifts.ptr<Vec2s>(y / T::block);
    const Size size = s.last.disparity.size();
    for (int first = run.start, end; first < run.end; first = end)
    {
        end = std::min((first / T::block + 1) * T::block, run.end);
        const Vec2s& shift = shifts[first / T::block];
        const int fromY = shifted(first, y, shift, size).y;
        const ushort* disparity = s.last.disparity.ptr<ushort>(fromY);
        const uchar* detail = s.last.detail.ptr(fromY);
        if (first + shift[0] >= 0 && end + shift[0] <= size.width)
            cpu_baseline::unpackRow(disparity + first + shift[0], detail + first + shift[0], end - first,
                                    &scratch.before[first], &scratch.counts[first]);
        else
            for (int x = first; x < end; ++x)
            {
                const int fromX = shifted(x, y, shift, size).x;
                cpu_baseline::unpackRow(disparity + fromX, detail + fromX, 1, &scratch.before[x], &scratch.counts[x]);
            }
    }
    dispatchChange(backward.change(), run.start, y, 1, run.size(), &scratch.before[run.start]);
}

void joinRow(const Mat& measured, const Backward& backward, int y, RowScratch& scratch, TemporalState& s)
{
    const int width = measured.cols, cells = s.choices.cols;
    const uchar* choices = s.choices.ptr(std::min(y / T::cell, s.choices.rows - 1));
    dispatchUnpack(s.last.disparity.ptr<ushort>(y), s.last.detail.ptr(y), width, scratch.before.data(),
                   scratch.counts.data());
    for (int first = 0, next; first < cells; first = next)
    {
        const int choice = choices[first];
        for (next = first + 1; next < cells && choices[next] == choice;)
            ++next;
        const Range run(first * T::cell, next < cells ? next * T::cell : width);
        if (choice == MEASURED)
            std::fill(scratch.counts.begin() + run.start, scratch.counts.begin() + run.end, (uchar)0);
        else if (choice == MOVED)
            takeMoved(backward, s, y, run, scratch);
        dispatchJoin(measured.ptr<ushort>(y) + run.start, &scratch.before[run.start], &scratch.counts[run.start],
                     run.size(), ruleOf(choice, s), s.next.disparity.ptr<ushort>(y) + run.start,
                     s.next.detail.ptr(y) + run.start);
    }
}

} // namespace

void joinLastFrame(const Mat& left, const CensusCost& cost, const TemporalLayer& layer, TemporalState& s,
                   Mat& disparity)
{
    const Size size = disparity.size();
    if (std::min(size.width, size.height) < T::cell)
        return s.clear();
    const bool isFirst = s.last.disparity.size() != size || !(s.layer == layer);
    s.layer = layer;
    buildGrey(left, s);
    if (isFirst)
        return beginAnew(disparity, s);

    findMotion(s);
    const Backward backward(s.motion, layer);
    if (!s.motion.isStill)
        findShifts(backward, s);
    if (isCut(s))
        return beginAnew(disparity, s);
    if (s.motion.isStill)
        findUnchanged(s);
    else
        findSources(s);
    compareCosts(cost, backward, disparity, s);
    choose(s);
    s.next.disparity.create(size, CV_16U);
    s.next.detail.create(size, CV_8U);
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        RowScratch scratch(size.width);
        for (int y = rows.start; y < rows.end; ++y)
            joinRow(disparity, backward, y, scratch, s);
    });
    s.next.disparity.copyTo(disparity);
    std::swap(s.last, s.next);
}

} // namespace hdp
} // namespace stereo
} // namespace cv
