// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "repeated_surfaces.hpp"

#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, fitRise, 12, "cost", "above the lowest one of the pixel: candidates up to it fit");
HDP_TUNABLE(int, maxStep, 1, "halves of a candidate", "between runs of a surface: more joins the surface behind");
HDP_TUNABLE(int, minPiece, 20, "pixels", "of connected runs: smaller ones are noise");
HDP_TUNABLE(int, maxGap, 16, "pixels", "without runs, that surfaces go on beyond: as the inside of a brick");
HDP_TUNABLE(int, minPixels, 100, "pixels", "of a surface, and of an area: smaller ones are noise");
HDP_TUNABLE(int, sampleStep, 4, "pixels", "between those that tell whether anything repeats");
HDP_TUNABLE(double, minRepeated, 0.05, "share of these pixels", "that repeat: less is found in any pair");
HDP_TUNABLE(int, minContrast, 20, "grey levels", "within a period: what is bare repeats itself by chance");
HDP_TUNABLE(int, maxDifference, 12, "grey levels", "between pixels that repeat each other");
HDP_TUNABLE(int, penalty, 32, "cost", "of candidates of other surfaces: more than the large penalty may save");

//! Successive candidates that fit
struct Run
{
    int first, last;
    int centre;     // of its lowest costs, in halves of a candidate
    int surface;    // its number
    bool isCounted; // as a part of its surface beside areas
};

//! Adds the runs of a pixel's candidates up to fitRise above the lowest cost, with a barrier between two of them.
void addRuns(const CostVolume& volume, int pixel, std::vector<Run>& runs)
{
    const uchar *const costs = &volume.costs[volume.start(pixel)], least = volume.lowestOf(pixel);
    const DisparityInterval own = volume.intervalOf(pixel);
    bool isOpen = false;
    int lowest = 0, from = 0; // of the run
    for (int k = own.first; k <= own.last; ++k)
    {
        if (costs[k] > least + fitRise)
        {
            isOpen &= costs[k] < least + CostVolume::contradiction;
            continue;
        }
        if (!isOpen)
            runs.push_back({ k, k, 2 * k, (int)runs.size(), false });
        if (!isOpen || costs[k] < lowest)
        {
            lowest = costs[k];
            from = k;
        }
        isOpen = true;
        runs.back().last = k;
        if (costs[k] == lowest)
            runs.back().centre = from + k;
    }
}

//! Sets of connected elements, of which the first one stands for all
class Sets
{
public:
    explicit Sets(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0); }
    int find(int element)
    {
        while (parents_[element] != element)
            element = parents_[element] = parents_[parents_[element]];
        return element;
    }
    void join(int a, int b)
    {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parents_;
};

class RepeatedSurfaces
{
public:
    RepeatedSurfaces(const CensusCost& own, CostVolume& volume)
        : own_(own), volume_(volume), width_(volume.size.width), pixels_(volume.size.area())
    {
    }

    //! See preferLargestSurfaces(). Returns the number of pixels in areas.
    int preferLargest()
    {
        if (!looksRepeated())
            return 0;
        joinRuns();
        const std::vector<int> repeated = findRepeated();
        for (int pixel : repeated)
            for (int run = firsts_[pixel]; run < firsts_[pixel + 1]; ++run)
                countSupport(pixel, run);
        for (int pixel : repeated)
            raiseOthers(pixel);
        return (int)repeated.size();
    }

private:
    //! Whether enough of some pixels have several runs, and repeat in the left image: most pairs need no more.
    bool looksRepeated() const
    {
        int samples = 0, repeated = 0;
        std::vector<Run> runs;
        for (int y = sampleStep / 2; y < volume_.size.height; y += sampleStep)
            for (int x = sampleStep / 2; x < width_; x += sampleStep, ++samples)
            {
                const int i = y * width_ + x;
                runs.clear();
                addRuns(volume_, i, runs);
                int periods = 0;
                for (size_t a = 1; a < runs.size() && periods == 0; ++a)
                    periods = periodsAlike(i, runs[a].centre - runs[a - 1].centre);
                repeated += periods > 0;
            }
        return repeated > minRepeated * samples;
    }

    //! Periods of so many halves of a candidate that are whole pixels, if the pixel repeats beside it by them, or 0
    int periodsAlike(int pixel, int gap) const
    {
        const int unit = 2 * volume_.steps; // halves of a candidate per pixel
        int periods = gap;
        while (periods % unit != 0)
            periods += gap;
        periods /= unit;
        return isAlike(pixel, periods) || isAlike(pixel, -periods) ? periods : 0;
    }

    //! From runs to surfaces. What noise leaves out, or has no texture, does not part them.
    void joinRuns()
    {
        for (int i = 0; i < pixels_; ++i)
        {
            firsts_.push_back((int)runs_.size());
            addRuns(volume_, i, runs_);
        }
        firsts_.push_back((int)runs_.size());
        sizes_.resize(runs_.size());
        Sets joined(runs_.size());
        for (int i = 0; i < pixels_; ++i)
            joinNext(i, 1, joined);
        keepLarge(joined, minPiece);
        for (int i = 0; i < pixels_; ++i)
            if (isRepeated(i))
                joinNext(i, maxGap, joined);
        keepLarge(joined, minPixels);
    }

    //! Joins a pixel's runs with the next ones of the same surface in its row and in its column.
    void joinNext(int pixel, int farthest, Sets& joined) const
    {
        const int x = pixel % width_, y = pixel / width_;
        for (int a = firsts_[pixel]; a < firsts_[pixel + 1]; ++a)
        {
            joinNext(pixel, a, -1, std::min(x, farthest), joined);
            joinNext(pixel, a, 1, std::min(width_ - 1 - x, farthest), joined);
            joinNext(pixel, a, -width_, std::min(y, farthest), joined);
            joinNext(pixel, a, width_, std::min(volume_.size.height - 1 - y, farthest), joined);
        }
    }

    void joinNext(int pixel, int run, int step, int farthest, Sets& joined) const
    {
        for (int k = 0, q = pixel + step; k < farthest; ++k, q += step)
            for (int a = firsts_[q]; a < firsts_[q + 1]; ++a)
                if (areNear(runs_[a], runs_[run]))
                    return joined.join(runs_[a].surface, runs_[run].surface);
    }

    //! Leaves out the runs of small surfaces.
    void keepLarge(Sets& joined, int least)
    {
        std::vector<int> sizes(sizes_.size());
        for (Run& run : runs_)
        {
            run.surface = joined.find(run.surface);
            ++sizes[run.surface];
        }
        int kept = 0;
        for (int i = 0, a = 0; i < pixels_; ++i)
        {
            const int end = firsts_[i + 1];
            firsts_[i] = kept;
            for (; a < end; ++a)
                if (sizes[runs_[a].surface] >= least)
                    runs_[kept++] = runs_[a];
        }
        firsts_[pixels_] = kept;
        runs_.resize(kept);
    }

    static bool areNear(const Run& a, const Run& b) { return std::abs(a.centre - b.centre) <= maxStep; }

    bool isRepeated(int pixel) const { return firsts_[pixel + 1] - firsts_[pixel] > 1; }

    //! Pixels with several surfaces, in areas that are not small. Pixels of one area share a surface; to touch is not
    //! enough, as corners of a grid do.
    std::vector<int> findRepeated() const
    {
        Sets areas(sizes_.size());
        for (int i = 0; i < pixels_; ++i)
            for (int a = firsts_[i] + 1; a < firsts_[i + 1]; ++a)
                areas.join(runs_[a - 1].surface, runs_[a].surface);
        const auto areaOf = [&](int pixel) { return areas.find(runs_[firsts_[pixel]].surface); };
        std::vector<int> areaSizes(sizes_.size()), repeated;
        for (int i = 0; i < pixels_; ++i)
            if (isRepeated(i))
                ++areaSizes[areaOf(i)];
        for (int i = 0; i < pixels_; ++i)
            if (isRepeated(i) && areaSizes[areaOf(i)] >= minPixels)
                repeated.push_back(i);
        return repeated;
    }

    //! A run of a pixel with several ones, and what is beside it
    void countSupport(int pixel, int run)
    {
        const int gaps[] = { run > firsts_[pixel] ? runs_[run].centre - runs_[run - 1].centre : 0,
                             run + 1 < firsts_[pixel + 1] ? runs_[run + 1].centre - runs_[run].centre : 0 };
        for (int gap : gaps)
        {
            const int periods = gap > 0 ? periodsAlike(pixel, gap) : 0;
            if (periods == 0)
                continue;
            const int period = gap / (2 * volume_.steps);
            ++sizes_[runs_[run].surface];
            countBeside(pixel, run, 1, period, periods);
            countBeside(pixel, run, -1, period, periods);
            return;
        }
    }

    //! The last period before the pattern ends, where a pixel has no other surface. Not what is behind the pattern: it
    //! does not repeat it.
    void countBeside(int pixel, int run, int step, int period, int periods)
    {
        const int row = pixel / width_;
        int end = pixel + step;
        for (int k = 0; k < period && end >= 0 && end / width_ == row; ++k, end += step)
            if (isRepeated(end))
                return;
        for (int q = pixel + step; q != end; q += step)
        {
            const int own = firsts_[q];
            if (own == firsts_[q + 1] || runs_[own].surface != runs_[run].surface || runs_[own].isCounted ||
                !isAlike(q, -step * periods))
                continue;
            runs_[own].isCounted = true;
            ++sizes_[runs_[run].surface];
        }
    }

    //! Whether a pixel and those above and below are like those at a distance in the row, and others in between are not
    bool isAlike(int pixel, int distance) const
    {
        const int x = pixel % width_, y = pixel / width_;
        if (x + distance < 0 || x + distance >= width_)
            return false;
        int darkest = UCHAR_MAX, brightest = 0;
        for (int k = std::min(distance, 0); k <= std::max(distance, 0); ++k)
        {
            const int level = own_.leftPixels(y)[4 * (x + k) + CensusCost::greyByte];
            darkest = std::min(darkest, level);
            brightest = std::max(brightest, level);
        }
        bool alike = brightest - darkest >= minContrast;
        for (int row = std::max(y - 1, 0); row <= std::min(y + 1, volume_.size.height - 1); ++row)
        {
            const uchar* const grey = own_.leftPixels(row) + CensusCost::greyByte;
            alike &= std::abs(grey[4 * x] - grey[4 * (x + distance)]) <= maxDifference;
        }
        return alike;
    }

    //! The costs of candidates of other surfaces than the largest one
    void raiseOthers(int pixel)
    {
        int best = firsts_[pixel];
        for (int a = best + 1; a < firsts_[pixel + 1]; ++a)
            if (sizes_[runs_[a].surface] > sizes_[runs_[best].surface])
                best = a;
        uchar* const costs = &volume_.costs[volume_.start(pixel)];
        for (int k = 0; k < volume_.numDisparities; ++k)
            if (k < runs_[best].first - 1 || k > runs_[best].last + 1)
                costs[k] = saturate_cast<uchar>(costs[k] + penalty);
    }

    const CensusCost& own_;
    CostVolume& volume_;
    const int width_, pixels_;
    std::vector<Run> runs_;
    std::vector<int> firsts_; // by pixel: of runs
    std::vector<int> sizes_;  // of surfaces, in areas and beside them
};

} // namespace

int preferLargestSurfaces(const CensusCost& own, CostVolume& volume)
{
    return RepeatedSurfaces(own, volume).preferLargest();
}

}}} // namespace cv::stereo::hdp
