// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"

#ifdef __SANITIZE_THREAD__

#include "opencv2/core/parallel/parallel_backend.hpp"

#include <thread>

namespace {

/** cv::parallel_for_() by std::thread, for ThreadSanitizer: it does not see how OpenCV's own threads wait for one another,
as OpenCV is not built with it, and would take every loop for a race. */
class ThreadsSeen : public cv::parallel::ParallelForAPI
{
public:
    void parallel_for(int tasks, FN_parallel_for_body_cb_t body, void* data) CV_OVERRIDE
    {
        // Each thread has tasks of its own, however fast the others are: what they share is always seen.
        const int count = std::min(threads_, tasks);
        const auto work = [=](int first) {
            for (int task = first; task < tasks; task += count)
                body(task, task + 1, data);
        };
        std::vector<std::thread> threads;
        for (int i = 1; i < count; ++i)
            threads.push_back(std::thread(work, i));
        work(0);
        for (std::thread& thread : threads)
            thread.join();
    }
    int getThreadNum() const CV_OVERRIDE { return 0; }
    int getNumThreads() const CV_OVERRIDE { return threads_; }
    int setNumThreads(int count) CV_OVERRIDE
    {
        const int before = threads_;
        threads_ = count > 0 ? std::min(count, 8) : defaultThreads;
        return before;
    }
    const char* getName() const CV_OVERRIDE { return "std::thread"; }

private:
    enum
    {
        defaultThreads = 4
    };
    int threads_ = defaultThreads;
};

} // namespace

CV_TEST_MAIN("cv", cv::parallel::setParallelForBackend(std::make_shared<ThreadsSeen>()))

#else

CV_TEST_MAIN("cv")

#endif
