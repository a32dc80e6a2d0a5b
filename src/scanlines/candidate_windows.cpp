// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "candidate_windows.hpp"
#include "candidate_windows.simd.hpp"
#include "scanlines/candidate_windows.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "other_surfaces.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(predictRow)

//! upper and lower: the intervals of two rows, of so many columns, that the windows' pixels stand for
void restrictRow(const DisparityInterval* upper, const DisparityInterval* lower, int columns, int numDisparities,
                 int width, CandidateWindow* windows)
{
    const int length = CandidateWindow::runLength;
    for (int x = 0; x < width; ++x)
    {
        CandidateWindow& window = windows[x];
        const int left = std::min(2 * x, columns - 1), right = std::min(2 * x + 1, columns - 1);
        const int first =
            std::min(std::min(upper[left].first, upper[right].first), std::min(lower[left].first, lower[right].first));
        const int last =
            std::max(std::max(upper[left].last, upper[right].last), std::max(lower[left].last, lower[right].last));
        const auto isUsed = [&](int run) { return window.first[run] <= last && window.first[run] + length > first; };
        const bool used[] = { isUsed(0), isUsed(1) };
        if (used[0] && used[1])
            continue;
        const int run = used[1] ? 1 : 0;
        const int centre = std::min(std::max(wholeDisparity(window.predicted[run]), first), last);
        const int begin = firstCandidate(centre, CandidateWindow::candidates, numDisparities);
        window.first[0] = (short)begin;
        window.first[1] = (short)(begin + length);
        window.predicted[0] = window.predicted[1] =
            (ushort)(used[run] ? window.predicted[run] : centre * subpixelScale);
    }
}

} // namespace

void predictWindows(const Mat& upper, const Mat& others, int numDisparities, Mat& windows)
{
    windows.create(upper.size(), CV_16UC4);
    parallel_for_(Range(0, upper.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            dispatched::predictRow(upper.ptr<ushort>(y), others.ptr<ushort>(y), upper.cols, numDisparities,
                                   windows.ptr<ushort>(y));
    });
}

void restrictWindows(const Mat& intervals, int numDisparities, Mat& windows)
{
    parallel_for_(Range(0, windows.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            restrictRow(intervals.ptr<DisparityInterval>(std::min(2 * y, intervals.rows - 1)),
                        intervals.ptr<DisparityInterval>(std::min(2 * y + 1, intervals.rows - 1)), intervals.cols,
                        numDisparities, windows.cols, windows.ptr<CandidateWindow>(y));
    });
}

void halveDisparity(const Mat& disparity, Mat& upper)
{
    upper.create(disparity.rows / 2, disparity.cols / 2, CV_16U);
    const int maxDistance = otherSurfaceDistance * subpixelScale;
    parallel_for_(Range(0, upper.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* above = disparity.ptr<ushort>(2 * y);
            const ushort* below = disparity.ptr<ushort>(2 * y + 1);
            ushort* middle = upper.ptr<ushort>(y);
            for (int x = 0; x < upper.cols; ++x)
            {
                const int a = above[2 * x], b = above[2 * x + 1], c = below[2 * x], d = below[2 * x + 1];
                const int p = std::max(std::min(a, b), std::min(c, d)), q = std::min(std::max(a, b), std::max(c, d));
                middle[x] = (ushort)(std::abs(p - q) < maxDistance ? (p + q) / 4 : std::min(p, q) / 2);
            }
        }
    });
}

}}} // namespace cv::stereo::hdp
