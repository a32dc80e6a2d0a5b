// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "temporal_join.hpp"
#include "../base/vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** Disparities of the frame before, in 1 / FrameMemory::scale pixel, become those of this one.
@param step From a pixel of row y to the next; the first one is 0. */
void changeDisparities(const DisparityChange& change, int y, int step, int count, int* finer);

/** Compares the disparities of the first pixels of a row's cells. Two of the frame before that are about the same count
as one, the moved one; so do two that are far apart.
@param measured,unmoved,unmovedDetail Of the pixels of the row; the last two are FrameMemory's.
@param row Where the motion leads; moved: of each cell.
@param sources What each cell may take.
@param used Receives those of them that count.
@param different Receives which of these have another disparity than the measured one.
@param shares Receives how much more they may cost: percent of the unmoved one and of the moved one. */
void compareDisparities(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail,
                        const TemporalRow& row, int count, const ChoiceRule& rule, const uchar* sources, uchar* used,
                        uchar* different, uchar* shares);

/** Adds up what the pixels on the diagonals of cells tell, see TemporalEvidence.
@param row What moves there, and so many cells to compare: the others tell nothing.
@param offset What a scale has beside the measured cost, per pixel.
@param evidence Receives EVIDENCE_CHANNELS numbers per cell; those of other cells stay. */
void compareCells(const ComparedRow* rows, const TemporalRow& row, int count, int offset, short* evidence);

/** Chooses for the cells of a row.
@param sums Sums of the evidence over the window of each.
@param sources,shares Those of compareDisparities() that are used.
@param isStill Whether the camera is at rest.
@param wrongShare What a disparity costs more that contradicts the frame before, in percent.
@param choices Receives a TemporalChoice of each.
@return How many that have a source contradict it: with wrongShare in place of the others, they would be measured. */
int chooseCells(const short* sums, const uchar* sources, const uchar* shares, int count, bool isStill, int wrongShare,
                uchar* choices);

/** Joins a row of measured disparities with those of the frame before.
@param unmoved,unmovedDetail FrameMemory's of the frame before, of the same pixels.
@param row The choices, and where the motion leads.
@param disparity,detail Receive FrameMemory's of this frame. */
void joinRow(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail, TemporalRow& row, int width,
             const JoinRule& rule, ushort* disparity, uchar* detail);

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
    if (FrameMemory::isUnseen(disparity, x))
        return row.unseenCost;
    return countBits(
        censusDifference<planes>(row.left + 4 * x, row.right - x + wholeDisparity(disparity), row.planeStride));
}

//! What a disparity at a distance from the measured one may cost more, and whether it is KEPT then
CV_ALWAYS_INLINE int shareOf(const ChoiceRule& rule, int distance, int detail)
{
    const int agreed = std::max((detail & FrameMemory::countMask) - 1, 0); // joinRow() limits it
    const int ofNear = choose(agreed > 0, rule.nearShare, rule.firstShare);
    return choose(distance <= rule.near, ofNear, rule.apartShare * agreed | ChoiceRule::KEEPS);
}

//! What a cell takes, of its sums over the window. isStill: 0 or 1
inline int choiceOf(const short* sums, int sources, int isStill, int shareOfUnmoved, int shareOfMoved)
{
    const int unmovedShare = shareOfUnmoved & ChoiceRule::PERCENT, movedShare = shareOfMoved & ChoiceRule::PERCENT;
    const int unmovedKept = shareOfUnmoved & ChoiceRule::KEEPS, movedKept = shareOfMoved & ChoiceRule::KEEPS;
    const int unmoved = sums[COST_UNMOVED], moved = sums[COST_MOVED];
    const int hasUnmoved = sources & 1, hasMoved = (sources >> 1) & (isStill ^ 1);
    const int prefersUnmoved = hasUnmoved & ((hasMoved ^ 1) | (unmoved <= moved));
    const int takesUnmoved = prefersUnmoved & (100 * unmoved <= unmovedShare * sums[SCALE_UNMOVED]);
    const int takesMoved = hasMoved & (100 * moved <= movedShare * sums[SCALE_MOVED]);
    static_assert(ChoiceRule::KEEPS == KEPT << 5, "One bit becomes the other.");
    return choose(takesUnmoved, UNMOVED | unmovedKept >> 5, takesMoved * (MOVED | movedKept >> 5));
}

template <int planes>
void compareCellsOf(const ComparedRow* rows, const TemporalRow& row, int count, int offset, short* evidence)
{
    for (int k = 0; k < count; ++k)
    {
        const int j = row.compared[k], sources = row.different[j], movedHere = row.moved[j] >> FrameMemory::detailBits;
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

void changeDisparities(const DisparityChange& change, int y, int step, int count, int* finer)
{
    const DisparityChange c = change;
    const float unit = 1.f / FrameMemory::scale, stepX = (float)step;
    HDP_VECTORIZED for (int i = 0; i < count; ++i) finer[i] =
        (int)(c.now(finer[i] * unit, i * stepX, (float)y) * FrameMemory::scale);
}

void compareDisparities(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail,
                        const TemporalRow& row, int count, const ChoiceRule& rule, const uchar* sources, uchar* used,
                        uchar* different, uchar* shares)
{
    const ChoiceRule r = rule; // as stores may alias it
    const int* const moved = row.moved.data();
    const uchar* const movedDetail = row.detail.data();
    HDP_VECTORIZED for (int j = 0; j < count; ++j)
    {
        const int first = j * FrameMemory::cell;
        const int here = measured[first], there = unmoved[first], where = moved[j] >> FrameMemory::detailBits;
        const int hasMoved = sources[j] & MOVED_PLACE, distance = std::abs(there - where);
        const int isOther = (distance > r.same) & (distance <= r.maxDistance);
        const int hasUnmoved = sources[j] & choose(hasMoved == 0, SAME_PLACE, isOther);
        const int ofUnmoved = std::abs(there - here), ofMoved = std::abs(where - here);
        used[j] = (uchar)(hasUnmoved | hasMoved);
        different[j] = (uchar)((hasUnmoved & -(ofUnmoved > r.same)) | (hasMoved & -(ofMoved > r.same)));
        shares[2 * j] = (uchar)shareOf(r, ofUnmoved, unmovedDetail[first]);
        shares[2 * j + 1] = (uchar)shareOf(r, ofMoved, movedDetail[first]);
    }
}

void compareCells(const ComparedRow* rows, const TemporalRow& row, int count, int offset, short* evidence)
{
    const auto compare = rows[0].planes == 3   ? &compareCellsOf<3>
                         : rows[0].planes == 2 ? &compareCellsOf<2>
                                               : &compareCellsOf<1>;
    compare(rows, row, count, offset, evidence);
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

void joinRow(const ushort* measured, const ushort* unmoved, const uchar* unmovedDetail, TemporalRow& row, int width,
             const JoinRule& rule, ushort* disparity, uchar* detail)
{
    const int tolerance = rule.tolerance, maxStep = rule.maxStep;
    const int maxWeight = rule.maxWeight, maxCount = FrameMemory::countMask;
    const int half = 1 << (FrameMemory::detailBits - 1);
    const int* const moved = row.moved.data();
    const uchar *const movedDetail = row.detail.data(), *const choices = row.choices.data();
    uchar* const agreesMoved = row.agrees.data() + joinFringe;
    static_assert(joinFringe == 2, "There are as many terms on each side.");
    static_assert(maxJoinWeight == 4, "There are as many shares.");
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
        const int there = choose(isMoved, moved[x], FrameMemory::finer(unmoved[x], unmovedDetail[x]));
        const int from = choose(isMoved, movedDetail[x], unmovedDetail[x]);
        const int wasGuess = (from & FrameMemory::GUESS) != 0, isUnseen = FrameMemory::isUnseen(measured[x], x);
        // What comes into sight is measured.
        const int isTaken = (choice != MEASURED) & ((isMoved & wasGuess & (isUnseen ^ 1)) ^ 1);
        const int count = from & FrameMemory::countMask & -isTaken;
        const int difference = here - there;
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
        const int isGuess = isUnseen & (isNew | wasGuess);
        detail[x] = (uchar)FrameMemory::detailOf(rounded, joinedCount | isGuess * FrameMemory::GUESS);
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
