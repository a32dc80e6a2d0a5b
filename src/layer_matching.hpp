// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_LAYER_MATCHING_HPP
#define OPENCV_HDPSTEREO_LAYER_MATCHING_HPP

#include "scanlines/candidate_windows.hpp"
#include "cost/census_cost.hpp"
#include "paper/color_gradient_cost.hpp"
#include "forest/disparity_forest.hpp"
#include "forest/forest_aggregation.hpp"
#include "plan/matcher_parameters.hpp"
#include "pair/pair_alignment.hpp"
#include "pair/pair_pyramids.hpp"
#include "scanlines/scanline_aggregation.hpp"
#include "base/stage_clock.hpp"
#include "paper/support_points.hpp"
#include "video/temporal_join.hpp"
#include "scanlines/volume_scanlines.hpp"

namespace cv { namespace stereo { namespace hdp {

//! A layer's result, and memory that is kept for the next pair
struct MatchedLayer
{
    Mat disparity;             // CV_16UC1, a disparity map
    Mat unfiltered;            // the same before the median
    double searchRatio;        // R_l of the paper's Table 1
    std::vector<double> prior; // P(D_l) up to a factor; empty if the layer was not predicted from one

    bool isCensus = false; // which of the two costs is prepared
    CensusCost census;
    ColorGradientCost colorGradient;
    const MatchingCost& cost() const { return isCensus ? static_cast<const MatchingCost&>(census) : colorGradient; }

    Mat guide, pixelIntv, weights;
    WindowBuffers windowBuffers;
    Mat matches, windows;
    Mat winner, residual, filtered, lastPass, lastUnfiltered, stable;
};

//! What the disparities of a layer depend on
struct LayerInput
{
    int layer;
    const LayerImages& images;
    const MatchedLayer* upper; // the layer above; none at the top layer
    const MatcherParameters& parameters;
    const PairSettings& settings;
    const PairAlignment& alignment;
    const FrameMemory& lastFrame;      // of the video
    const FramePrediction* prediction; // of this frame; none if videos are not predicted

    bool isTop() const { return !upper; }
    bool isFinest() const { return layer == settings.finestLayer; }
};

//! What the layers of a pair make one after the other in the same memory
struct LayerBuffers
{
    DisparityForest forest;
    int forestLayer = -1; // the layer that the forest is of; -1: none was built
    void forgetForest()
    {
        forest = DisparityForest();
        forestLayer = -1;
    }

    SupportPointBuffers supportPoints;
    Mat points;
    std::vector<DisparityInterval> intervals;
    ForestBuffers forestBuffers;
    AggregationBuffers aggregation;
    ScanlineBuffers scanlines;
    CostVolume volume;
    VolumeScanlineBuffers volumeScanlines;
    VideoScratch video;
    FrameMemory frame; // what the finest layer leaves to the next frame of a video
};

//! Section 3: from the disparities of the layer above to those of this layer. Returns what the frame is to the last one of
//! a video, as joinLastFrame() does.
Verdict matchLayer(const LayerInput& input, LayerBuffers& buffers, StageClock& clock, MatchedLayer& matched);

}}} // namespace cv::stereo::hdp

#endif
