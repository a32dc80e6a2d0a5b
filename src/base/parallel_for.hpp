// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PARALLEL_FOR_HPP
#define OPENCV_HDPSTEREO_PARALLEL_FOR_HPP

#include "opencv2/core/utility.hpp"

#include <mutex>

namespace cv { namespace stereo { namespace hdp {

//! Memory that threads work in, kept for the next loop, as new memory may take longer than the work: as many pieces as
//! threads that have worked at once.
template <typename Scratch> class ScratchPool
{
public:
    explicit ScratchPool(const Scratch& first = Scratch()) : first_(first) {}

    Scratch take()
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (idle_.empty())
            return first_;
        Scratch taken = std::move(idle_.back());
        idle_.pop_back();
        return taken;
    }

    void giveBack(Scratch&& taken)
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        idle_.push_back(std::move(taken));
    }

private:
    const Scratch first_;
    std::mutex mutex_;
    std::vector<Scratch> idle_;
};

//! f(i, scratch) for each i of 0 .. count - 1, by all threads; each has its own scratch, which others had before.
//! parts: how many of these are done by themselves, about
template <typename Scratch, typename F>
void parallelFor(int count, ScratchPool<Scratch>& pool, const F& f, double parts = -1)
{
    const auto part = [&](const Range& range) {
        Scratch own = pool.take();
        for (int i = range.start; i < range.end; ++i)
            f(i, own);
        pool.giveBack(std::move(own));
    };
    parallel_for_(Range(0, count), part, parts);
}

//! The same with copies of a scratch
template <typename Scratch, typename F>
void parallelFor(int count, const Scratch& scratch, const F& f, double parts = -1)
{
    ScratchPool<Scratch> pool(scratch);
    parallelFor(count, pool, f, parts);
}

//! f(i) for each i of 0 .. count - 1, by all threads
template <typename F> void parallelFor(int count, const F& f)
{
    parallelFor(count, 0, [&](int i, int) { f(i); });
}

//! f(y, scratch) for each row of an image, by all threads; each has a copy of the scratch. What takes some microseconds
//! is not worth waking a thread, and an even number of parts gives also two threads as much to do.
template <typename Scratch, typename F> void parallelForRows(const Size& size, const Scratch& scratch, const F& f)
{
    const double pixels = 1 << 14; // of a part, at least about
    parallelFor(size.height, scratch, f, std::max(2 * cvRound(size.area() / (2 * pixels)), 1));
}

//! f(y) for each row of an image, by all threads
template <typename F> void parallelForRows(const Size& size, const F& f)
{
    parallelForRows(size, 0, [&](int y, int) { f(y); });
}

}}} // namespace cv::stereo::hdp

#endif
