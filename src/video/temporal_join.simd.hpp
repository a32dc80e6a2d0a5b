// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "../base/units.hpp"
#include "temporal_join.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A row of the frame before as joinRow() takes it.
@param disparity FrameMemory's.
@param detail FrameMemory's.
@param width Number of pixels.
@param finer Receives the disparities in 1 / FrameMemory::scale pixel.
@param counts Receives how many frames each stands for. */
void unpackRow(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts);

/** Disparities of the frame before become those of this one.
@param change The camera's motion.
@param y The row.
@param step From a pixel to the next; the first one is 0.
@param count Number of pixels.
@param finer As of unpackRow(), changed. */
void changeDisparities(const DisparityChange& change, int y, int step, int count, int* finer);

//! Adds a row times sign to columns.
void addEvidence(const short* row, int sign, int length, short* columns);

/** Sums over TemporalJoin::window cells of a row.
@param columns The first of the cells that the first sum is over.
@param length Number of sums, EVIDENCE_CHANNELS per cell.
@param sums Receives the sums. */
void sumWindow(const short* columns, int length, short* sums);

/** Compares the disparities of a row's cells. Two that are about the same count as one, the moved one; so do two that
are far apart.
@param measured Disparities of the pixels of the row.
@param unmoved Those of the frame before at the same places.
@param moved Those where the motion leads, of each cell, as of changeDisparities().
@param count Number of cells.
@param same Distance of disparities that are the same, in units of a map.
@param maxDistance maxSourceDistance, in units of a map.
@param sources What each cell may take.
@param used Receives those of them that count.
@param different Receives which of the sources have another disparity than the measured one. */
void compareDisparities(const ushort* measured, const ushort* unmoved, const int* moved, int count, int same,
                        int maxDistance, const uchar* sources, uchar* used, uchar* different);

/** Finds how much more the disparities of the frame before may cost than the measured ones.
@param measured As of compareDisparities().
@param unmoved As well.
@param unmovedDetail FrameMemory's, of the same pixels.
@param moved As of compareDisparities().
@param movedDetail The same where the motion leads.
@param count Number of cells.
@param rule What they may.
@param shares Receives two numbers per cell: percent of the unmoved one, and of the moved one. */
void shareCells(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail, const int* moved,
                const uchar* movedDetail, int count, const ChoiceShares& rule, uchar* shares);

/** Adds up what the pixels on the diagonals of cells tell, see TemporalEvidence.
@param rows The rows of the cells.
@param moved As of compareDisparities().
@param different As well.
@param cells The cells to compare.
@param count Their number.
@param offset What a scale has beside the measured cost, per pixel.
@param evidence Receives EVIDENCE_CHANNELS numbers per cell; those of other cells stay. */
void compareCells(const ComparedRow* rows, const int* moved, const uchar* different, const int* cells, int count,
                  int offset, short* evidence);

/** Chooses for the cells of a row.
@param sums Sums of the evidence over the window of each.
@param sources What each may take.
@param count Number of cells.
@param shares What its disparities may cost more, of shareCells().
@param isStill Whether the camera is at rest.
@param wrongShare What a disparity costs more that contradicts the frame before, in percent.
@param choices Receives a TemporalChoice of each.
@return How many that have a source contradict it: with wrongShare in place of the others, they would be measured. */
int chooseCells(const short* sums, const uchar* sources, const uchar* shares, int count, bool isStill, int wrongShare,
                uchar* choices);

/** Joins a row of measured disparities with those of the frame before.
@param measured The measured ones.
@param rows What the frame before has.
@param width Number of pixels.
@param rule How to join them.
@param disparity Receives FrameMemory::disparity.
@param detail Receives FrameMemory::detail. */
void joinRow(const ushort* measured, TemporalRow& row, int width, const JoinRule& rule, ushort* disparity,
             uchar* detail);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

inline int countBits(unsigned bits)
{
#ifdef __POPCNT__
    return __builtin_popcount(bits);
#else
    return countCensusBits(bits);
#endif
}

//! The cost of a pixel; half of the bits if the right image does not show its match
template <int planes> inline int costOf(const ComparedRow& row, int x, int disparity)
{
    const int candidate = wholeDisparity(disparity);
    if (candidate > x)
        return row.unseenCost;
    return countBits(censusDifference<planes>(row.left + 4 * x, row.right - x + candidate, row.planeStride));
}

//! What a cell takes, of its sums over the window. isStill: 0 or 1
inline int choiceOf(const short* sums, int sources, int isStill, int shareOfUnmoved, int shareOfMoved)
{
    const int unmovedShare = shareOfUnmoved & ChoiceShares::PERCENT, movedShare = shareOfMoved & ChoiceShares::PERCENT;
    const int unmovedKept = shareOfUnmoved & ChoiceShares::KEEPS, movedKept = shareOfMoved & ChoiceShares::KEEPS;
    const int unmoved = sums[COST_UNMOVED], moved = sums[COST_MOVED];
    const int scaleUnmoved = sums[SCALE_UNMOVED], scaleMoved = sums[SCALE_MOVED];
    const int hasUnmoved = sources & 1, hasMoved = (sources >> 1) & (isStill ^ 1);
    const int best = std::min(moved, 0) & -hasMoved;
    const int scale = choose(isStill, scaleUnmoved, std::max(scaleUnmoved, scaleMoved));
    const int takesUnmoved = hasUnmoved & (100 * (unmoved - best) <= unmovedShare * scale);
    const int takesMoved = hasMoved & (100 * moved <= movedShare * scaleMoved);
    static_assert(ChoiceShares::KEEPS == KEPT << 5, "One bit becomes the other.");
    return choose(takesUnmoved, UNMOVED | unmovedKept >> 5, takesMoved * (MOVED | movedKept >> 5));
}

template <int planes>
void compareCellsOf(const ComparedRow* rows, const int* moved, const uchar* different, const int* cells, int count,
                    int offset, short* evidence)
{
    for (int k = 0; k < count; ++k)
    {
        const int j = cells[k], sources = different[j], movedHere = moved[j] >> FrameMemory::detailBits;
        int unmovedCost = 0, movedCost = 0, scale = 0;
        for (int i = 0; i < FrameMemory::cell; ++i)
        {
            const int x = FrameMemory::cell * j + i, here = costOf<planes>(rows[i], x, rows[i].measured[x]);
            scale += here + offset;
            if (sources & SAME_PLACE)
                unmovedCost += costOf<planes>(rows[i], x, rows[i].unmoved[x]) - here;
            if (sources & MOVED_PLACE)
                movedCost += costOf<planes>(rows[i], x, movedHere) - here;
        }
        short* const ofCell = evidence + j * EVIDENCE_CHANNELS;
        ofCell[COST_UNMOVED] = (short)unmovedCost;
        ofCell[COST_MOVED] = (short)movedCost;
        ofCell[SCALE_UNMOVED] = (short)(sources & SAME_PLACE ? scale : 0);
        ofCell[SCALE_MOVED] = (short)(sources & MOVED_PLACE ? scale : 0);
    }
}

} // namespace

void unpackRow(const ushort* disparity, const uchar* detail, int width, int* finer, uchar* counts)
{
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        finer[x] = FrameMemory::finer(disparity[x], detail[x]);
        counts[x] = (uchar)(detail[x] & FrameMemory::countMask);
    }
}

void changeDisparities(const DisparityChange& change, int y, int step, int count, int* finer)
{
    const DisparityChange c = change;
    const float rowFactor = c.ofRow(y), columnFactor = c.ofX * step, unit = 1.f / FrameMemory::scale;
    HDP_VECTORIZED for (int i = 0; i < count; ++i) finer[i] =
        (int)(c.now(finer[i] * unit, i * columnFactor + rowFactor) * FrameMemory::scale);
}

void addEvidence(const short* row, int sign, int length, short* columns)
{
    HDP_VECTORIZED for (int i = 0; i < length; ++i) columns[i] = (short)(columns[i] + sign * row[i]);
}

void sumWindow(const short* columns, int length, short* sums)
{
    const int c = EVIDENCE_CHANNELS;
    static_assert(TemporalJoin::window == 7, "There are as many terms.");
    HDP_VECTORIZED for (int i = 0; i < length; ++i) sums[i] =
        (short)(columns[i] + columns[i + c] + columns[i + 2 * c] + columns[i + 3 * c] + columns[i + 4 * c] +
                columns[i + 5 * c] + columns[i + 6 * c]);
}

void compareDisparities(const ushort* measured, const ushort* unmoved, const int* moved, int count, int same,
                        int maxDistance, const uchar* sources, uchar* used, uchar* different)
{
    HDP_VECTORIZED for (int j = 0; j < count; ++j)
    {
        const int here = measured[j * FrameMemory::cell], there = unmoved[j * FrameMemory::cell];
        const int where = moved[j] >> FrameMemory::detailBits, distance = std::abs(there - where);
        const int hasMoved = sources[j] & MOVED_PLACE, isOther = (distance > same) & (distance <= maxDistance);
        const int hasUnmoved = sources[j] & choose(hasMoved == 0, SAME_PLACE, isOther);
        used[j] = (uchar)(hasUnmoved | hasMoved);
        different[j] =
            (uchar)((hasUnmoved & -(std::abs(there - here) > same)) | (hasMoved & -(std::abs(where - here) > same)));
    }
}

void compareCells(const ComparedRow* rows, const int* moved, const uchar* different, const int* cells, int count,
                  int offset, short* evidence)
{
    const auto compare = rows[0].planes == 3   ? &compareCellsOf<3>
                         : rows[0].planes == 2 ? &compareCellsOf<2>
                                               : &compareCellsOf<1>;
    compare(rows, moved, different, cells, count, offset, evidence);
}

void shareCells(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail, const int* moved,
                const uchar* movedDetail, int count, const ChoiceShares& rule, uchar* shares)
{
    const int first = rule.first, near = rule.near, apart = rule.apart, keeps = ChoiceShares::KEEPS;
    const int maxCount = rule.maxCount, maxDistance = rule.distance;
    HDP_VECTORIZED for (int j = 0; j < count; ++j)
    {
        const int here = measured[j * FrameMemory::cell], there = unmoved[j * FrameMemory::cell];
        const int where = moved[j] >> FrameMemory::detailBits;
        const int unmovedCount = std::min(unmovedDetail[j * FrameMemory::cell] & FrameMemory::countMask, maxCount);
        const int movedCount = std::min(movedDetail[j * FrameMemory::cell] & FrameMemory::countMask, maxCount);
        const int unmovedAgreed = std::max(unmovedCount - 1, 0), movedAgreed = std::max(movedCount - 1, 0);
        shares[2 * j] = (uchar)choose(std::abs(there - here) <= maxDistance, choose(unmovedAgreed > 0, near, first),
                                      apart * unmovedAgreed | keeps);
        shares[2 * j + 1] = (uchar)choose(std::abs(where - here) <= maxDistance, choose(movedAgreed > 0, near, first),
                                          apart * movedAgreed | keeps);
    }
}

int chooseCells(const short* sums, const uchar* sources, const uchar* shares, int count, bool isStill, int wrongShare,
                uchar* choices)
{
    const int still = isStill;
    int contradicting = 0;
    static_assert(MEASURED == 0 && SAME_PLACE == 1 && MOVED_PLACE == 2, "choiceOf() relies on it.");
    HDP_VECTORIZED for (int j = 0; j < count; ++j)
    {
        const short* const ofCell = sums + j * EVIDENCE_CHANNELS;
        contradicting += (sources[j] != 0) & (choiceOf(ofCell, sources[j], still, wrongShare, wrongShare) == MEASURED);
        choices[j] = (uchar)choiceOf(ofCell, sources[j], still, shares[2 * j], shares[2 * j + 1]);
    }
    return contradicting;
}

void joinRow(const ushort* measured, TemporalRow& row, int width, const JoinRule& rule, ushort* disparity,
             uchar* detail)
{
    const int tolerance = rule.tolerance, maxStep = rule.maxStep;
    const int maxWeight = rule.maxWeight, maxCount = rule.maxCount;
    const int half = 1 << (FrameMemory::detailBits - 1);
    const int *unmoved = row.unmoved.data(), *moved = row.moved.data();
    const uchar *unmovedCounts = row.unmovedCounts.data(), *movedCounts = row.movedCounts.data();
    const uchar* choices = row.choices.data();
    uchar* const agreesMoved = row.agrees.data() + TemporalJoin::fringe;
    static_assert(TemporalJoin::fringe == 2, "There are as many terms on each side.");
    static_assert(TemporalJoin::maxWeight == 4, "There are as many shares.");
    HDP_VECTORIZED for (int x = 0; x < width; ++x)
    {
        const int distance = std::abs((measured[x] << FrameMemory::detailBits) - moved[x]);
        agreesMoved[x] = (uchar)(((choices[x] & PLACES) == MOVED) & (distance <= tolerance));
    }
    HDP_VECTORIZED for (int x = 0; x < width; ++x) // without branches, so that it can be
    {
        const int isBeside = agreesMoved[x - 2] | agreesMoved[x - 1] | agreesMoved[x + 1] | agreesMoved[x + 2];
        const int place = choices[x] & PLACES, isFringe = (place == MOVED) & isBeside & (agreesMoved[x] ^ 1);
        const int here = measured[x] << FrameMemory::detailBits, choice = choose(isFringe, MEASURED, place),
                  isMoved = choice == MOVED;
        const int there = choose(isMoved, moved[x], unmoved[x]), difference = here - there;
        const int count = choose(isMoved, movedCounts[x], unmovedCounts[x]) & -(choice != MEASURED);
        const int limited = std::max(std::min(difference, maxStep), -maxStep);
        const int weight = std::min(count, maxWeight);
        // 2^16 / (weight + 1)
        const int share = choose(weight > 2, choose(weight > 3, 13107, 16384), choose(weight > 1, 21845, 32768));
        const int approached = there + ((limited * share + 32768) >> 16);
        const int agrees = std::abs(difference) <= tolerance;
        const int isNew = (count == 0) | ((agrees ^ 1) & ((choices[x] & KEPT) == 0));
        const int joined = choose(isNew, here, choose(agrees, approached, there));
        const int joinedCount = choose(isNew, 1, choose(agrees, std::min(count + 1, maxCount), count - 1));
        const int rounded = joined + half;
        disparity[x] = (ushort)(rounded >> FrameMemory::detailBits);
        detail[x] = (uchar)((rounded & FrameMemory::countMask) << FrameMemory::detailBits | joinedCount);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
