// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPATCH_HPP
#define OPENCV_HDPSTEREO_DISPATCH_HPP

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

#endif
