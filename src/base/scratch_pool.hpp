// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SCRATCH_POOL_HPP
#define OPENCV_HDPSTEREO_SCRATCH_POOL_HPP

#include <memory>
#include <mutex>
#include <vector>

namespace cv { namespace stereo { namespace hdp {

//! Memory that threads work in, kept from call to call
template <typename Scratch> using ScratchPool = std::vector<std::unique_ptr<Scratch>>;

//! Lends a thread some of it.
template <typename Scratch> class ScratchLoan
{
public:
    //! mutex: that of all threads which share the pool
    ScratchLoan(ScratchPool<Scratch>& pool, std::mutex& mutex) : pool_(pool), mutex_(mutex)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        if (pool_.empty())
            scratch_.reset(new Scratch);
        else
        {
            scratch_ = std::move(pool_.back());
            pool_.pop_back();
        }
    }
    ~ScratchLoan()
    {
        std::lock_guard<std::mutex> lock(mutex_);
        pool_.push_back(std::move(scratch_));
    }
    Scratch& operator*() const { return *scratch_; }

private:
    ScratchPool<Scratch>& pool_;
    std::mutex& mutex_;
    std::unique_ptr<Scratch> scratch_;
};

}}} // namespace cv::stereo::hdp

#endif
