// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PRECOMP_HPP
#define OPENCV_HDPSTEREO_PRECOMP_HPP

#include "opencv2/hdpstereo.hpp"
#include "opencv2/core/utils/trace.hpp"
#include "opencv2/imgproc.hpp"

#include "base/parallel_for.hpp"
#include "base/tunable.hpp"

//! Defines dispatched::function(), which calls the function of a *.simd.hpp for the instruction set of this machine.
//! After the include of STAGE.simd_declarations.hpp, which names the instruction sets.
#define HDP_DISPATCH(function)                                                                                         \
    namespace { namespace dispatched {                                                                                 \
    template <typename... Args>                                                                                        \
    CV_ALWAYS_INLINE auto function(Args&&... args) -> decltype(cpu_baseline::function(args...))                        \
    {                                                                                                                  \
        CV_CPU_DISPATCH(function, (args...), CV_CPU_DISPATCH_MODES_ALL);                                               \
    }                                                                                                                  \
    }}

namespace cv { namespace stereo { namespace hdp {

//! Enlarges a vector to at least so many elements, and returns them: memory to work in, which is never made smaller.
template <typename T> T* grown(std::vector<T>& elements, size_t count)
{
    if (elements.size() < count)
        elements.resize(count);
    return elements.data();
}

}}} // namespace cv::stereo::hdp

#endif
