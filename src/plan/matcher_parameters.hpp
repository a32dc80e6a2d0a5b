// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MATCHER_PARAMETERS_HPP
#define OPENCV_HDPSTEREO_MATCHER_PARAMETERS_HPP

#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"

namespace cv { namespace stereo { namespace hdp {

//! All that a matcher is set to: HDPTreeMatcher::Params, and what cv::StereoMatcher has beside blockSize
struct MatcherParameters : HDPTreeMatcher::Params
{
    explicit MatcherParameters(int preset = HDPTreeMatcher::PRESET_PAPER) : Params(preset) {}

    int minDisparity = 0;
    int numDisparities = 64; // 0: both are found in the pair
    int speckleWindowSize = 0;
    int speckleRange = 1; // disparities have fractions, so none but those of one are in 0
    int disp12MaxDiff = -1;
};

//! The same with a range of disparities
inline MatcherParameters withRange(MatcherParameters parameters, int minDisparity, int numDisparities)
{
    parameters.minDisparity = minDisparity;
    parameters.numDisparities = numDisparities;
    return parameters;
}

//! Throws if a value is not valid by itself. What depends on several parameters or on the images is checked by
//! plan().
void checkParameters(const MatcherParameters& parameters);

//! All parameters by name
void writeParameters(const MatcherParameters& parameters, FileStorage& fs);

//! What writeParameters() has written; a parameter that is missing gets the value of PRESET_PAPER. Throws if a value is
//! not valid. ownStrategy: the strategy of the caller, for files that name it.
MatcherParameters readParameters(const FileNode& fn, const Ptr<TreeStrategy>& ownStrategy);

}}} // namespace cv::stereo::hdp

#endif
