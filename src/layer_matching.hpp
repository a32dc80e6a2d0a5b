// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_LAYER_MATCHING_HPP
#define OPENCV_HDPSTEREO_LAYER_MATCHING_HPP

#include "base/stage_clock.hpp"
#include "forest/tree_means.hpp"
#include "paper/support_points.hpp"
#include "paper/tree_sums.hpp"
#include "plan/pair_plan.hpp"
#include "video/temporal_join.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is known of a matched layer
struct LayerResult
{
    Mat disparity;             // CV_16UC1, a disparity map
    Mat winners;               // the same before the median
    Mat residual;              // their matching costs, where the layer below or occlusions need them, before these were
                               // filled; UCHAR_MAX without data
    double searchRatio = 0;    // R_l of the paper's Table 1
    std::vector<double> prior; // P(D_l) up to a factor; empty if the layer was not predicted from one
};

//! What the disparities of a layer depend on
struct LayerInput
{
    const PairPlan& pair;
    const LayerPlan& plan;
    const LayerImages& images;
    const LayerResult* upper;          // the layer above; none at the top layer
    const CensusCost* below;           // that of the layer below, if the plan sees it
    const KnownDisparities& known;     // beforehand, if the plan has ranges or a prior
    const FrameMemory& lastFrame;      // of a video
    const FramePrediction& prediction; // of this frame, if it is one of a video
};

//! Memory of one layer, kept for the next pair
struct LayerScratch
{
    CensusCost census;
    ColorGradientCost colorGradient;
    Mat guide, edgeWeights;              // what edges are weighed on; their weights, if there is no forest
    Mat pixelIntv;                       // PixelIntv, section 3.1
    Mat others, windows;                 // what the windows of scanlines are predicted from; the windows
    Mat smoothness;                      // weights of the penalties in these windows
    Mat filtered, halved, halvedWinners; // what a pass of scanlines leaves to the next one
    Mat masked;                          // disparities without those of pixels without data, of a pair with masks
    Mat passResidual;                    // what a pass of scanlines over windows leaves of costs, and of priors
    Mat stable, refined;                 // pixels that pass the left-right check, and their refined disparities

    const MatchingCost& cost(const CostPlan& plan) const
    {
        return plan.isCensus ? static_cast<const MatchingCost&>(census) : colorGradient;
    }
};

//! Memory that the layers of a pair use one after the other, and the forest that was built last
struct SharedScratch
{
    DisparityForest forest;
    int forestLayer = -1; // the layer that the forest is of; -1: none was built for this pair
    SupportPointBuffers supportPointBuffers;
    Mat supportPoints;
    std::vector<DisparityInterval> intervals;
    ForestBuffers forestBuffers;
    SumBuffers sums;
    MeanBuffers means;
    ScanlineBuffers scanlines;
    CostVolume volume;
    std::vector<short> volumeSums;
    RangeBuffers rangeScanlines;
    VideoScratch video;
    Mat predicted;     // disparities of the top layer, by the last frame
    FrameMemory frame; // what the finest layer leaves to the next frame of a video
};

//! The matching cost of a layer, which matchLayer() needs of it and of the layer below
void prepareCost(const LayerPlan& plan, const LayerImages& images, LayerScratch& own);

//! Section 3: from the disparities of the layer above to those of this layer. Returns what the frame is to the last one
//! of a video: CONTRADICTED if the top layer's costs or the finest layer's disparities say so, and there is no result
//! then; else as joinLastFrame() does, FIRST on the layers above.
Verdict matchLayer(const LayerInput& input, LayerScratch& own, SharedScratch& shared, StageClock& clock,
                   LayerResult& result);

}}} // namespace cv::stereo::hdp

#endif
