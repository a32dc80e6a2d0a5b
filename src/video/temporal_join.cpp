// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "temporal_join.hpp"
#include "temporal_join.simd.hpp"
#include "video/temporal_join.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include "../base/window_sums.hpp"

#include <cmath>
#include <cstring>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

// Which disparity a cell takes
HDP_TUNABLE(int, window, 7, "cells",
            "side of the square that costs are compared over: a smaller one decides by noise, a larger one has two "
            "surfaces");
HDP_TUNABLE(int, costOffset, 6, "bits of 24",
            "that a measured disparity's cost gets before shares of it are taken: without it, noise decides low ones");
HDP_TUNABLE(int, stillShare, 26, "percent of that sum",
            "that a disparity may cost more if the camera stands still: more keeps errors, less flickers");
HDP_TUNABLE(int, nearShare, 60, "percent of that sum",
            "the same if the camera moved: the costs of warped disparities are higher, however right they are");
HDP_TUNABLE(
    int, nearDistance, 2, "pixels of the image",
    "from the measured disparity, up to which it is so, and both agree: what is farther away is right or wrong");
HDP_TUNABLE(int, apartShare, 10, "percent of that sum, per frame that has agreed with it",
            "of one that is farther away: more keeps what has gone or is covered, less keeps less of what was right");
HDP_TUNABLE(int, wrongShare, 33, "percent of that sum", "beyond it, a cell contradicts the last frame: less is noise");
HDP_TUNABLE(int, contradictedShare, 30, "percent of the cells with a source",
            "that may contradict: if more do, one of the pairs was a wrong one, if fewer, something moved");
HDP_TUNABLE(int, driftStep, 12, "cells", "between those that correct the predicted disparities: nearer ones cost time");

// How it is joined with the measured one
HDP_TUNABLE(int, maxStep, 1, "pixels", "towards the measured one, before its share is taken: it may be an outlier");

const int cell = FrameMemory::cell;

HDP_DISPATCH(changeDisparities)
HDP_DISPATCH(compareDisparities)
HDP_DISPATCH(compareCells)
HDP_DISPATCH(chooseCells)
HDP_DISPATCH(joinRow)

//! What the last frame has for this one
struct LastFrame
{
    const FrameMemory& memory;
    const FramePrediction& prediction;
    DisparityChange change; // of the camera's motion

    bool isStill() const { return prediction.motion.isStill; }
    Size cells() const { return prediction.sources.size(); }
};

//! What the motion takes to the pixels of a row, as it is in the last frame
void takeMoved(const LastFrame& frame, int y, TemporalRow& row)
{
    const FrameMemory& memory = frame.memory;
    ushort* const disparity = row.disparity.data();
    uchar* const detail = row.detail.data();
    frame.prediction.warp.forEachBlock(y, [&](int x, const Point& from, int count) {
        std::memcpy(disparity + x, memory.disparity.ptr<ushort>(from.y) + from.x, count * sizeof(ushort));
        std::memcpy(detail + x, memory.detail.ptr(from.y) + from.x, count);
    });
}

//! The same, and the disparities of the first pixels of the row's cells, now
void takeMovedCells(const LastFrame& frame, int y, TemporalRow& row)
{
    takeMoved(frame, y, row);
    const int cells = frame.cells().width;
    const ushort* const disparity = row.disparity.data();
    int* const moved = row.moved.data();
    HDP_VECTORIZED for (int j = 0; j < cells; ++j) moved[j] = disparity[j * cell] << FrameMemory::detailBits;
    dispatched::changeDisparities(frame.change, y, cell, cells, moved);
}

//! How the motion changes disparities, corrected by those of this frame, measured (CV_16UC1)
DisparityChange measuredChange(const LastFrame& frame, const Mat& measured)
{
    const float unit = 1.f / subpixelScale;
    std::vector<float> predicted, now;
    TemporalRow row(measured.cols);
    for (int i = 0; i < frame.cells().height; i += driftStep)
    {
        takeMovedCells(frame, i * cell, row);
        for (int j = 0; j < frame.cells().width; j += driftStep)
            if (frame.prediction.sources.ptr(i)[j] & MOVED_PLACE)
            {
                predicted.push_back(row.moved[j] / (float)FrameMemory::scale);
                now.push_back(measured.ptr<ushort>(i * cell)[j * cell] * unit);
            }
    }
    return correctedChange(frame.change, predicted, now);
}

ChoiceRule choiceRule(const LastFrame& frame)
{
    const int unit = frame.prediction.key.scale; // of a disparity in pixels of the image
    ChoiceRule rule;
    rule.same = subpixelScale; // a pixel: costs of these differ by noise
    rule.maxDistance = maxSourceDistance * subpixelScale / unit;
    rule.near = frame.isStill() ? INT_MAX : std::max(nearDistance * subpixelScale / unit, 1);
    rule.nearShare = frame.isStill() ? stillShare | ChoiceRule::KEEPS : +nearShare;
    // No pair has agreed with a disparity of one frame: nothing that contradicts is taken.
    rule.firstShare = frame.isStill() ? rule.nearShare : std::min(+nearShare, +wrongShare);
    rule.apartShare = frame.isStill() ? 0 : +apartShare;
    return rule;
}

//! Compares costs in each cell whose first pixel has another disparity in the last frame.
void compareCosts(const CensusCost& cost, const Mat& measured, const LastFrame& frame, VideoScratch& scratch)
{
    const Size cells = frame.cells();
    const int offset = costOffset * cost.comparisons() / 24;
    const ChoiceRule rule = choiceRule(frame);
    scratch.sources.create(cells, CV_8U);
    scratch.shares.create(cells, CV_8UC2);
    scratch.evidence.create(cells, CV_16SC(EVIDENCE_CHANNELS));
    parallelFor(cells.height, TemporalRow(measured.cols), [&](int i, TemporalRow& row) {
        const int y = i * cell;
        if (!frame.isStill())
            takeMovedCells(frame, y, row);
        dispatched::compareDisparities(measured.ptr<ushort>(y), frame.memory.disparity.ptr<ushort>(y),
                                       frame.memory.detail.ptr(y), row, cells.width, rule,
                                       frame.prediction.sources.ptr(i), scratch.sources.ptr(i), row.different.data(),
                                       scratch.shares.ptr(i));
        int count = 0; // of those that are different
        for (int j = 0; j < cells.width; ++j)
        {
            row.compared[count] = j;
            count += row.different[j] != 0;
        }
        ComparedRow ofCells[cell];
        for (int k = 0; k < cell; ++k)
            ofCells[k] = { cost.leftPixels(y + k),
                           cost.rightPlane(0, y + k) + measured.cols - 1,
                           cost.planeStride(),
                           cost.planes(),
                           cost.comparisons() / 2,
                           measured.ptr<ushort>(y + k),
                           frame.memory.disparity.ptr<ushort>(y + k) };
        scratch.evidence.row(i).setTo(Scalar::all(0));
        dispatched::compareCells(ofCells, row, count, offset, scratch.evidence.ptr<short>(i));
    });
}

/** Chooses by the sums over a window around each cell; beside the image there is no evidence.
@return Whether much of what could be taken from the last frame is not: its pair was a wrong one, or this one is. */
bool chooseSources(const LastFrame& frame, VideoScratch& scratch)
{
    const Size cells = frame.cells();
    const int wrong = frame.isStill() ? +stillShare : +wrongShare;
    std::vector<int> contradicted(cells.height);
    scratch.choices.create(cells, CV_8U);
    sumOverWindows(scratch.evidence, window, CV_16S, scratch.evidenceSums, BORDER_CONSTANT);
    parallelForRows(cells, [&](int y) {
        contradicted[y] =
            dispatched::chooseCells(scratch.evidenceSums.ptr<short>(y), scratch.sources.ptr(y), scratch.shares.ptr(y),
                                    cells.width, frame.isStill(), wrong, scratch.choices.ptr(y));
    });
    const int64 all = countNonZero(scratch.sources);
    return 100 * std::accumulate(contradicted.begin(), contradicted.end(), (int64)0) > contradictedShare * all;
}

void joinRow(const LastFrame& frame, const uchar* choices, const Mat& measured, int y, TemporalRow& row,
             FrameMemory& next)
{
    const int width = measured.cols, cells = frame.cells().width;
    static_assert(cell == 2, "There are as many pixels.");
    uchar* const ofPixels = row.choices.data();
    HDP_VECTORIZED for (int j = 0; j < cells; ++j) ofPixels[2 * j] = ofPixels[2 * j + 1] = choices[j];
    std::fill(row.choices.begin() + cells * cell, row.choices.end(), choices[cells - 1]);
    if (!frame.isStill())
    {
        // An odd last row or column has the cell beside it, which may be in another block.
        const FrameWarp& warp = frame.prediction.warp;
        for (int x = y < frame.cells().height * cell ? cells * cell : 0; x < width; ++x)
            if ((ofPixels[x] & PLACES) == MOVED && !warp.isKnown(x, y))
                ofPixels[x] = MEASURED;
        takeMoved(frame, y, row);
        int* const moved = row.moved.data();
        HDP_VECTORIZED for (int x = 0; x < width; ++x) moved[x] = FrameMemory::finer(row.disparity[x], row.detail[x]);
        dispatched::changeDisparities(frame.change, y, 1, width, moved);
    }
    const int maxDistance = std::max(nearDistance / frame.prediction.key.scale, 1) * FrameMemory::scale;
    // The motion is an estimate: what it moves counts for one frame.
    const JoinRule rule = { maxDistance, maxStep * FrameMemory::scale, frame.isStill() ? +maxJoinWeight : 1 };
    dispatched::joinRow(measured.ptr<ushort>(y), frame.memory.disparity.ptr<ushort>(y), frame.memory.detail.ptr(y), row,
                        width, rule, next.disparity.ptr<ushort>(y), next.detail.ptr(y));
}

//! Returns whether the pair does not contradict the last frame.
bool join(const CensusCost& cost, const FrameMemory& last, const FramePrediction& prediction, VideoScratch& scratch,
          FrameMemory& next, Mat& disparity)
{
    LastFrame frame = { last, prediction, prediction.backward.change };
    if (!frame.isStill())
        frame.change = measuredChange(frame, disparity);
    compareCosts(cost, disparity, frame, scratch);
    if (chooseSources(frame, scratch))
        return false;
    next.disparity.create(disparity.size(), CV_16U);
    next.detail.create(disparity.size(), CV_8U);
    parallelForRows(disparity.size(), TemporalRow(disparity.cols), [&](int y, TemporalRow& row) {
        joinRow(frame, scratch.choices.ptr(std::min(y / cell, scratch.choices.rows - 1)), disparity, y, row, next);
    });
    next.disparity.copyTo(disparity);
    return true;
}

} // namespace

Verdict joinLastFrame(const CensusCost& cost, const FrameMemory& last, const FramePrediction& prediction,
                      VideoScratch& scratch, FrameMemory& next, Mat& disparity)
{
    next.clear();
    if (std::min(disparity.cols, disparity.rows) < cell)
        return FIRST;
    if (prediction.verdict == FIRST)
    {
        disparity.copyTo(next.disparity);
        next.detail.create(disparity.size(), CV_8U);
        parallelForRows(disparity.size(), [&](int y) {
            const int noRest = 1 << (FrameMemory::detailBits - 1);
            for (int x = 0; x < disparity.cols; ++x)
            {
                const int isGuess = FrameMemory::isUnseen(disparity.ptr<ushort>(y)[x], x);
                next.detail.ptr(y)[x] = (uchar)FrameMemory::detailOf(noRest, 1 | FrameMemory::GUESS * isGuess);
            }
        });
    }
    else if (!join(cost, last, prediction, scratch, next, disparity))
        return CONTRADICTED;
    next.frames = prediction.verdict == FIRST ? 1 : last.frames + 1;
    next.key = prediction.key;
    next.levels = prediction.levels;
    next.motion = prediction.motion;
    next.grey.resize(prediction.grey.size());
    for (size_t level = 0; level < next.grey.size(); ++level)
        prediction.grey[level].copyTo(next.grey[level]);
    return prediction.verdict;
}

void trustStable(const FrameMemory& frame, Mat& confidence)
{
    if (frame.detail.size() != confidence.size()) // of a layer that is smaller than a cell nothing is left
        return;
    double most;
    const Mat counts = frame.detail & Scalar(FrameMemory::countMask);
    minMaxLoc(counts, nullptr, &most);
    float factors[FrameMemory::countMask + 1];
    for (int count = 0; count <= FrameMemory::countMask; ++count)
        factors[count] = std::sqrt((float)(count + 1) / (float)(most + 1));
    parallelForRows(confidence.size(), [&](int y) {
        const uchar* const ofRow = counts.ptr(y);
        uchar* const row = confidence.ptr(y);
        for (int x = 0; x < confidence.cols; ++x)
            row[x] = (uchar)((float)row[x] * factors[ofRow[x]] + 0.5f);
    });
}

}}} // namespace cv::stereo::hdp
