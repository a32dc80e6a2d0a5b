// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set (see CMakeLists.txt): no include guard.
#include "scanline_aggregation.hpp"
#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "scanline_block.simd.hpp"
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! A stripe of aggregateScanlines(). scratch: stored has a row for each from the first one of its reach to its last own
//! one, one more if their number is odd; ScanlineScratch::blocks * maxRows at least
void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     Mat& disparity, Mat& residual);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/** A sweep over a stripe, upward or downward. Upward, it computes the costs and follows the directions from below and
from the left, and stores the costs and the sum of both directions; downward, it follows those from above and from the
right, and takes the winners.

Two blocks are done side by side, the second one some steps behind the first one, which leaves it what it needs: while
one waits for its minima, the other one goes on. */
class Sweep
{
public:
    typedef ScanlineBlock Block;

    Sweep(const ScanlineProblem& problem, const ScanlineStripe& stripe, bool isUpward, ScanlineScratch& scratch)
        : p_(problem), rows_(stripe.rows), reach_(stripe.reach), steps_(Block::countSteps(problem.size.width)),
          stored_(scratch.stored.data), tables_{ { problem, isUpward, scratch.orders, scratch.windows[0] },
                                                 { problem, isUpward, scratch.orders, scratch.windows[1] } },
          blocks_{ { problem, isUpward, scratch.verticalOfColumns(), scratch.ofBlocks[0] },
                   { problem, isUpward, scratch.verticalOfColumns(), scratch.ofBlocks[1] } },
          windows_(nullptr), upperRow_(-1), enteredTables_(0)
    {
    }

    void upward()
    {
        int y = (reach_.end + 1) / 2 * 2 - groups;
        y = upward(y, rows_.end, FOLLOW);
        y = upward(y, rows_.start, SUM);
        upward(y, reach_.start, STORE_COSTS);
    }

    void downward(Mat& disparity, Mat& residual)
    {
        for (int y = reach_.start; y < rows_.end;)
        {
            const bool takesWinners = y >= rows_.start;
            const int blocks = countBlocks((takesWinners ? rows_.end : rows_.start) - y);
            uchar* stored[ScanlineScratch::blocks];
            for (int i = 0; i < blocks; ++i)
            {
                enter(i, y + i * groups);
                stored[i] = storedOf(y + i * groups);
            }
            Block::Carried h[ScanlineScratch::blocks];
            const Range turns(0, countTurns(blocks));
            takesWinners ? runTurns<false, true>(turns, blocks, stored, h)
                         : runTurns<false, false>(turns, blocks, stored, h);
            for (int i = 0; takesWinners && i < blocks; ++i)
                blocks_[i].finish(y + i * groups, rows_.end, disparity, residual);
            y += blocks * groups;
        }
    }

private:
    static const int groups = Block::groups;
    static const int behind = groups; // steps, of the second block: what it reads is older than a step
    static const int chunk = 32;      // steps whose costs are in the cache

    //! What is done upward
    enum Task
    {
        FOLLOW,     //!< the direction from below
        SUM,        //!< both directions
        STORE_COSTS //!< none
    };

    static int countBlocks(int rows) { return rows > groups ? +ScanlineScratch::blocks : 1; }

    //! Turns in which blocks take their steps side by side
    int countTurns(int blocks) const { return steps_ + (blocks - 1) * behind; }

    //! Blocks from that at row y up to that at row last; returns the row of the next one.
    int upward(int y, int last, Task task)
    {
        while (y >= last)
        {
            const int blocks = countBlocks(y + groups - last);
            uchar* stored[ScanlineScratch::blocks];
            for (int i = 0; i < blocks; ++i)
            {
                enter(i, y - i * groups);
                stored[i] = storedOf(task == FOLLOW ? reach_.start + i * groups : y - i * groups);
            }
            const int end = countTurns(blocks);
            Block::Carried h[ScanlineScratch::blocks];
            for (int t = 0; t < end; t += chunk)
            {
                const Range turns(t, std::min(t + chunk, end));
                for (int i = 0; i < blocks; ++i)
                    blocks_[i].storeCosts(Range(std::max(t - i * behind, 0), std::min(turns.end - i * behind, steps_)),
                                          stored[i]);
                if (task == SUM)
                    runTurns<true, true>(turns, blocks, stored, h);
                else if (task == FOLLOW)
                    runTurns<true, false>(turns, blocks, stored, h);
            }
            y -= blocks * groups;
        }
        return y;
    }

    //! Runs some turns, in each of which a block takes a step; the second block, if there is one, is behind the first.
    template <bool isUpward, bool sums>
    void runTurns(const Range& turns, int blocks, uchar* const* stored, Block::Carried* carried) const
    {
        if (blocks == 1)
            runTurns<isUpward, sums, 1>(turns, stored, carried);
        else
            runTurns<isUpward, sums, 2>(turns, stored, carried);
    }

    template <bool isUpward, bool sums, int blocks>
    void runTurns(const Range& turns, uchar* const* stored, Block::Carried* carried) const
    {
        const Block a = blocks_[0], b = blocks_[1];
        Block::Carried first = carried[0], second = carried[1];
        const int steps = steps_, forward = isUpward ? 1 : -1;
        int t = isUpward ? turns.start : steps - 1 - turns.start; // of the first block; u: of the second one
        for (int turn = turns.start; turn < turns.end; ++turn, t += forward)
        {
            const int u = t - forward * behind;
            if (blocks == 1 || (isUpward ? t < steps : t >= 0))
                a.follow<isUpward, sums>(t, first, stored[0]);
            if (blocks == 2 && (isUpward ? u >= 0 : u < steps))
                b.follow<isUpward, sums>(u, second, stored[1]);
        }
        carried[0] = first;
        carried[1] = second;
    }

    //! Enters the rows of a block from y on, after those of the block before.
    void enter(int block, int y)
    {
        const int upperRow = std::min(y / 2, p_.windows->rows - 1);
        const bool isNew = upperRow != upperRow_, isFirst = !windows_;
        if (isNew)
        {
            const CandidateWindow* const before = windows_;
            windows_ = p_.windows->ptr<CandidateWindow>(upperRow);
            upperRow_ = upperRow;
            enteredTables_ = 1 - enteredTables_; // the block beside this one may need the others
            tables_[enteredTables_].enter(windows_, p_.smoothness->ptr(upperRow), before);
        }
        blocks_[block].enter(y, tables_[enteredTables_], isNew && !isFirst);
    }

    //! The stored costs and sums of the block whose upper row is y
    uchar* storedOf(int y) const
    {
        return stored_ + (y - reach_.start) * (ptrdiff_t)ScanlineScratch::storedBytes(p_.size.width);
    }

    const ScanlineProblem& p_;
    const Range rows_, reach_;
    const int steps_; // of a block
    uchar* const stored_;
    ScanlineWindows tables_[ScanlineScratch::blocks];
    ScanlineBlock blocks_[ScanlineScratch::blocks];
    const CandidateWindow* windows_; // of the row of the upper layer that was entered last
    int upperRow_, enteredTables_;   // that row, and its tables
};

} // namespace

void aggregateStripe(const ScanlineProblem& problem, const ScanlineStripe& stripe, ScanlineScratch& scratch,
                     Mat& disparity, Mat& residual)
{
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep(problem, stripe, true, scratch).upward();
    scratch.prepare(problem.size.width, problem.numDisparities);
    Sweep(problem, stripe, false, scratch).downward(disparity, residual);
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
