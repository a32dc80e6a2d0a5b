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
    int numDisparities = 64;
    int speckleWindowSize = 0;
    int speckleRange = 0;
    int disp12MaxDiff = -1;
};

//! Throws if a value is not valid by itself. What depends on several parameters or on the images is checked by
//! resolve().
void checkParameters(const MatcherParameters& parameters);

//! All parameters by name
void writeParameters(const MatcherParameters& parameters, FileStorage& fs);

//! What writeParameters() has written; a parameter that is missing gets the value of PRESET_PAPER. Throws if a value is
//! not valid. ownStrategy: the strategy of the caller, for files that name it.
MatcherParameters readParameters(const FileNode& fn, const Ptr<TreeStrategy>& ownStrategy);

/** Number of pyramid layers for so many disparities, in images of any size: numLayers or more, until the top layer has
maxTopDisparities or less or there are mostLayers. A layer that would leave it less than 16 is left out, but for the
first two. See HDPTreeMatcher::Params::maxTopDisparities. */
CV_EXPORTS int chooseLayers(int numDisparities, int numLayers, int maxTopDisparities, int mostLayers);

//! What the parameters amount to for a pair
struct PairSettings
{
    int layers = 0, finestLayer = 0;
    int windowSide = 0; // of the matching cost
    int extension = 0; // columns added on the left, for pixels there to have their matches, if disparities are negative
    Ptr<DisparityPredictionModel> model;
    double delta0 = 0, beta = 0;
    int medianSize = 0;
    bool subpixel = false; // whether the disparities of a layer have a fraction
};

//! Throws if parameters do not go with one another or with the images. left: the left image.
PairSettings resolve(const MatcherParameters& parameters, const Mat& left);

}}} // namespace cv::stereo::hdp

#endif
