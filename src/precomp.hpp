// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PRECOMP_HPP
#define OPENCV_HDPSTEREO_PRECOMP_HPP

#include "opencv2/hdpstereo.hpp"
#include "opencv2/core/utils/trace.hpp"
#include "opencv2/imgproc.hpp"

#include "base/dispatch.hpp"
#include "base/tunable.hpp"

namespace cv { namespace stereo { namespace hdp {

//! f(i) for each i of 0 .. count - 1, by all threads
template <typename F> void parallelFor(int count, const F& f)
{
    parallel_for_(Range(0, count), [&](const Range& range) {
        for (int i = range.start; i < range.end; ++i)
            f(i);
    });
}

//! f(i, scratch) for each i of 0 .. count - 1, by all threads; each has a copy of the scratch.
template <typename Scratch, typename F> void parallelFor(int count, const Scratch& scratch, const F& f)
{
    parallel_for_(Range(0, count), [&](const Range& range) {
        Scratch own = scratch;
        for (int i = range.start; i < range.end; ++i)
            f(i, own);
    });
}

//! At least so many elements of a vector that only ever grows
template <typename T> T* grown(std::vector<T>& elements, size_t count)
{
    if (elements.size() < count)
        elements.resize(count);
    return elements.data();
}

}}} // namespace cv::stereo::hdp

#endif
