// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "systems.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

// Of the sanitizers' allocator, in a build with AddressSanitizer or LeakSanitizer
#if defined(__GNUC__)
extern "C" size_t __sanitizer_get_current_allocated_bytes() __attribute__((weak));
#endif

namespace opencv_test { namespace {

//! Bytes that are allocated and not freed; throws SkipTestException if the C library does not tell.
size_t allocatedBytes()
{
#if defined(__GNUC__)
    if (__sanitizer_get_current_allocated_bytes)
        return __sanitizer_get_current_allocated_bytes();
#endif
#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
#endif
#endif
    throw SkipTestException("the C library does not tell how much memory is allocated");
}

//! Calls of compute(): HDPSTEREO_ENDURANCE in the environment, or some
int countCalls()
{
    const char* const calls = std::getenv("HDPSTEREO_ENDURANCE");
    return calls ? std::max(std::atoi(calls), 200) : 200;
}

//! Random parameters that go together, for a matcher that had others before
void configureAnew(HDPTreeMatcher& matcher, RNG& rng)
{
    const std::vector<System> systems = allSystems();
    matcher.setParams(paramsOf(systems[rng.uniform(0, (int)systems.size())]));
    matcher.setMinDisparity(rng.uniform(-20, 20));
    matcher.setNumDisparities(rng.uniform(1, 65));
    matcher.setDisp12MaxDiff(rng.uniform(-1, 3));
    matcher.setSpeckleWindowSize(rng.uniform(0, 2) * 30);
    matcher.setSpeckleRange(1);
    change(matcher, [&](Params& p) { p.useNonLocalRefinement = rng.uniform(0, 6) == 0; });
    matcher.setDisparityDepth(rng.uniform(0, 2) ? CV_32F : CV_16S);
}

/** Calls of one matcher on images of changing sizes, with changing parameters, and of matchers that come and go: what is
allocated grows until everything has had its largest size, and no more. */
TEST(HDPStereo_Endurance, memory_does_not_grow)
{
    const int calls = countCalls(), threads = cv::getNumThreads();
    const Size largest(160, 120);
    RNG rng(81);
    const Mat lefts[] = { patchyImage(rng, largest, CV_8UC1), patchyImage(rng, largest, CV_8UC3) };
    const Mat rights[] = { patchyImage(rng, largest, CV_8UC1), patchyImage(rng, largest, CV_8UC3) };
    const auto compute = [&](HDPTreeMatcher& matcher, Size size) {
        const int y = rng.uniform(0, largest.height - size.height + 1);
        const int x = rng.uniform(0, largest.width - size.width + 1);
        const Rect part(Point(x, y), size);
        const int type = rng.uniform(0, 2);
        Mat disparity, confidence;
        matcher.compute(lefts[type](part), rights[type](part), disparity);
        if (rng.uniform(0, 4) == 0)
            matcher.getConfidence(confidence);
        ASSERT_EQ(size, disparity.size());
    };

    cv::setNumThreads(2);
    const Ptr<HDPTreeMatcher> reused = HDPTreeMatcher::create();
    size_t before = 0, after = 0;
    for (int call = 0; call < calls; ++call)
    {
        const int height = rng.uniform(1, largest.height + 1), width = rng.uniform(1, largest.width + 1);
        const Size size(width, height);
        configureAnew(*reused, rng);
        compute(*reused, call < calls / 2 && call % 2 ? largest : size);
        if (call % 10 == 0)
        {
            const Ptr<HDPTreeMatcher> another = HDPTreeMatcher::create();
            configureAnew(*another, rng);
            compute(*another, size);
        }
        if (call == calls / 2)
            before = allocatedBytes();
    }
    after = allocatedBytes();
    cv::setNumThreads(threads);
    // Which thread's memory has to grow for a large tree is left to chance.
    const size_t chance = 2 << 20;
    EXPECT_LE(after, before + chance) << calls << " calls, from " << before << " bytes";
    std::cout << calls << " calls: " << before << " bytes allocated after half of them, " << after << " after all"
              << std::endl;
}

}} // namespace opencv_test
