// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_STAGE_CLOCK_HPP
#define OPENCV_HDPSTEREO_STAGE_CLOCK_HPP

#include "opencv2/core.hpp"

#include <algorithm>

namespace cv { namespace stereo { namespace hdp {

//! Adds up the wall time of each stage.
class StageClock
{
public:
    void restart()
    {
        stages.clear();
        milliseconds.clear();
    }

    //! Runs a stage and adds its time to that of its name.
    template <typename Stage> void run(const char* name, Stage stage)
    {
        const int64 start = getTickCount();
        stage();
        const double time = (double)(getTickCount() - start) * 1000 / getTickFrequency();
        const size_t i = (size_t)(std::find(stages.begin(), stages.end(), name) - stages.begin());
        if (i == stages.size())
        {
            stages.push_back(name);
            milliseconds.push_back(0);
        }
        milliseconds[i] += time;
    }

    std::vector<String> stages; // in the order in which they first ran
    std::vector<double> milliseconds;
};

}}} // namespace cv::stereo::hdp

#endif
