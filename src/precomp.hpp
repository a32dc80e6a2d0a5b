// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PRECOMP_HPP
#define OPENCV_HDPSTEREO_PRECOMP_HPP

#include "opencv2/hdpstereo.hpp"
#include "opencv2/core/utils/trace.hpp"
#include "opencv2/imgproc.hpp"

#include "base/tunable.hpp"

//! Defines dispatched::function(), which calls the function of a *.simd.hpp for the instruction set of this machine.
//! After the include of STAGE.simd_declarations.hpp, which names the instruction sets.
#define HDP_DISPATCH(function)                                                                                         \
    namespace dispatched {                                                                                             \
    template <typename... Args>                                                                                        \
    CV_ALWAYS_INLINE auto function(Args&&... args) -> decltype(cpu_baseline::function(args...))                        \
    {                                                                                                                  \
        CV_CPU_DISPATCH(function, (args...), CV_CPU_DISPATCH_MODES_ALL);                                               \
    }                                                                                                                  \
    }

namespace cv { namespace stereo { namespace hdp {

//! f(i, scratch) for each i of 0 .. count - 1, by all threads; each has a copy of the scratch. parts: how many of these
//! are done by themselves, about
template <typename Scratch, typename F>
void parallelFor(int count, const Scratch& scratch, const F& f, double parts = -1)
{
    const auto part = [&](const Range& range) {
        Scratch own = scratch;
        for (int i = range.start; i < range.end; ++i)
            f(i, own);
    };
    parallel_for_(Range(0, count), part, parts);
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

//! Enlarges a vector to at least so many elements, and returns them: memory to work in, which is never made smaller.
template <typename T> T* grown(std::vector<T>& elements, size_t count)
{
    if (elements.size() < count)
        elements.resize(count);
    return elements.data();
}

}}} // namespace cv::stereo::hdp

#endif
