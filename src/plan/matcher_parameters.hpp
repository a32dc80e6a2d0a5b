// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MATCHER_PARAMETERS_HPP
#define OPENCV_HDPSTEREO_MATCHER_PARAMETERS_HPP

#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The parameters of HDPTreeMatcher, with the values of PRESET_PAPER; the header of HDPTreeMatcher explains them. Their
//! names in files and in messages, and what values are valid, are in matcher_parameters.cpp.
struct MatcherParameters
{
    int minDisparity = 0;
    int numDisparities = 64;
    int blockSize = 1;
    int speckleWindowSize = 0;
    int speckleRange = 0;
    int disp12MaxDiff = -1;
    int maxRowOffset = 0;
    bool useLightAlignment = false;
    double noiseThreshold = 0;

    Ptr<TreeStrategy> treeStrategy = createMinimumSpanningTree();
    Ptr<DisparityPredictionModel> predictionModel; // empty: the published one
    bool usePrediction = true;
    bool useMedianPrefilter = false;
    int numLayers = 3;         // as in the authors' program; "L = 3" in the paper would be four layers
    int maxTopDisparities = 0; // no limit
    double delta0 = HDPTreeMatcher::AUTO;
    double beta = HDPTreeMatcher::AUTO;
    double gamma = 25.5; // this and the next three are from the authors' program, the paper has no values
    double colorTruncation = 10;
    double gradientTruncation = 2;
    double colorWeight = 0.11;
    int disparityMedianSize = HDPTreeMatcher::AUTO;
    int disparityMedianPasses = 1;
    int matchingCost = HDPTreeMatcher::COST_COLOR_GRADIENT;
    int disparityPrior = HDPTreeMatcher::PRIOR_SUPPORT_POINTS;
    int intervalMargin = 0;
    bool useSubpixel = false;
    int aggregation = HDPTreeMatcher::AGGREGATION_TREES;
    int topAggregation = HDPTreeMatcher::AGGREGATION_TREES;
    int P1 = 16;
    int P2 = 65;
    int finestLayer = 0;
    int scanlinePasses = 1;
    bool fillOcclusions = false;
    int disparityDepth = CV_16S;
    bool useNonLocalRefinement = false;
    bool useTemporalPrediction = false;
};

//! The parameters of a preset; throws if there is none.
CV_EXPORTS MatcherParameters presetParameters(int preset);

//! Sets a parameter to a value that is valid by itself, or throws and leaves it as it was. What depends on several
//! parameters or on the images is checked by resolve(). T: int, double or bool.
template <typename T> void setParameter(MatcherParameters& parameters, T MatcherParameters::*parameter, const T& value);

//! Throws if the strategy is empty.
void setTreeStrategy(MatcherParameters& parameters, const Ptr<TreeStrategy>& strategy);

//! All parameters by name
void writeParameters(const MatcherParameters& parameters, FileStorage& fs);

//! What writeParameters() has written; a parameter that is missing gets the value of PRESET_PAPER. Throws if a value is
//! not valid. ownStrategy: the strategy of the caller, for files that name it.
MatcherParameters readParameters(const FileNode& fn, const Ptr<TreeStrategy>& ownStrategy);

}}} // namespace cv::stereo::hdp

#endif
