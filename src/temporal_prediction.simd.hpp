// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "disparity_units.hpp"
#include "temporal_prediction.hpp"
#include "vectorized.hpp"

namespace cv {
namespace stereo {
namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of a frame as joinRun() takes it.
@param disparity Of TemporalFrame.
@param detail Of TemporalFrame.
@param width Of the row.
@param finer Receives the disparities in 1 / TemporalFrame::scale pixel.
@param counts Receives how many frames each stands for. */
void unpackRow(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts);

/** Disparities of the frame before become those of this one.
@param change The camera's motion.
@param x The first pixel.
@param y Its row.
@param step From a pixel to the next.
@param count Number of pixels.
@param finer As of unpackRow(), changed. */
void changeDisparities(const DisparityChange& change, int x, int y, int step, int count, int* finer);

/** Joins measured disparities with those of the frame before.
@param measured The measured ones.
@param before The others, as of unpackRow().
@param counts How many frames these stand for.
@param width Number of pixels.
@param rule How to join them.
@param disparity Receives TemporalFrame::disparity.
@param detail Receives TemporalFrame::detail. */
void joinRun(const ushort* measured, const int* before, const uchar* counts, int width, const JoinRule& rule,
             ushort* disparity, uchar* detail);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

void unpackRow(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        finer[x] = TemporalFrame::finer(disparity[x], detail[x]);
        counts[x] = (uchar)(detail[x] & TemporalFrame::countMask);
    }
}

void changeDisparities(const DisparityChange& change, int x, int y, int step, int count, int* finer)
{
    const DisparityChange c = change;
    const float rowFactor = c.ofRow(y), unit = 1.f / TemporalFrame::scale;
    HDP_VECTORIZED for (int i = 0; i < count; ++i) finer[i] =
        (int)(c.now(finer[i] * unit, (x + i * step) * c.ofX + rowFactor) * TemporalFrame::scale);
}

void joinRun(const ushort* measured, const int* before, const uchar* counts, int width, const JoinRule& rule,
             ushort* disparity, uchar* detail)
{
    const int tolerance = rule.tolerance, maxStep = rule.maxStep, maxWeight = rule.maxWeight, maxCount = rule.maxCount;
    const int half = 1 << (TemporalFrame::detailBits - 1);
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int here = measured[x] << TemporalFrame::detailBits, there = before[x], count = counts[x];
        const int difference = here - there;
        const int low = difference > -maxStep ? difference : -maxStep;
        const int limited = low < maxStep ? low : maxStep;
        const int weight = count < maxWeight ? count : maxWeight;
        // 2^16 / (weight + 1)
        int share = weight == 1 ? 32768 : 21845;
        share = weight == 3 ? 16384 : share;
        share = weight == 4 ? 13107 : share;
        const int moved = there + ((limited * share + 32768) >> 16);
        const int agrees = (difference <= tolerance) & (difference >= -tolerance);
        const int more = count < maxCount ? count + 1 : maxCount, fewer = count > 1 ? count - 1 : 0;
        const int kept = agrees ? moved : there, keptCount = agrees ? more : fewer;
        const int joined = count == 0 ? here : kept, joinedCount = count == 0 ? 1 : keptCount;
        const int rounded = joined + half;
        disparity[x] = (ushort)(rounded >> TemporalFrame::detailBits);
        detail[x] = (uchar)((rounded & TemporalFrame::countMask) << TemporalFrame::detailBits | joinedCount);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
} // namespace hdp
} // namespace stereo
} // namespace cv
