// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PAIR_PLAN_HPP
#define OPENCV_HDPSTEREO_PAIR_PLAN_HPP

#include "../map/disparity_output.hpp"
#include "../paper/color_gradient_cost.hpp"
#include "../scanlines/range_scanlines.hpp"
#include "../scanlines/scanline_aggregation.hpp"
#include "../scanlines/volume_scanlines.hpp"
#include "../video/frame_memory.hpp"
#include "matcher_parameters.hpp"
#include "pair_inputs.hpp"
#include "pair_model.hpp"

namespace cv { namespace stereo { namespace hdp {

// All that is decided for a pair. What says how to match is asked here and nowhere else; the stages carry out. A member
// that a layer has no use for keeps its first value.

//! How the winners of a layer are found
enum LayerMethod
{
    TREE_SUMS,       //!< by sums over disparity trees (the paper, section 3.3)
    TREE_SCANLINES,  //!< by scanlines over the means of the costs in disparity trees
    COST_SCANLINES,  //!< by scanlines over the costs of all candidates
    RANGE_SCANLINES, //!< by scanlines over the costs of all candidates, and what the layer above says
    WINDOW_SCANLINES //!< by scanlines over windows of candidates around the disparities of the layer above
};

//! Where P(D_l) comes from, which predicts the candidates of trees (section 3.1)
enum PriorSource
{
    FULL_RANGE,     //!< nothing is predicted: all disparities are candidates
    SUPPORT_POINTS, //!< sparse matches
    UPPER_LAYER     //!< the disparities of the layer above
};

//! The matching cost of a layer
struct CostPlan
{
    bool isCensus = false;
    int windowSide = 0; // pixels
    int tolerance = 0;  // of the census, in grey levels as they are matched, see CensusCost::prepare()
    ColorGradientParams colorGradient = ColorGradientParams();
};

//! The forest of a layer, and what its trees' costs are used for
struct TreePlan
{
    PriorSource prior = FULL_RANGE;
    int upperDisparities = 0;   // candidates of the layer above
    double delta = 0;           // delta_l, section 3.1
    int margin = 0;             // candidates added to an interval on both sides
    double beta = 0;            // of DT-Rule 2; only trees whose intervals differ ask for it
    bool linksTrees = false;    // whether what Rule 2 leaves apart is joined
    double gamma = 0;           // grey levels, of the sums or means
    double refinementGamma = 0; // of the non-local refinement; 0: none
};

//! What is done on a layer
struct LayerPlan
{
    int layer = 0; // 0 is the image
    bool isTop = false, isFinest = false;
    ImageFrame frame;       // of its images, in its pixels
    int numDisparities = 0; // candidates; those of the layer below if the plan sees it
    int maxDisparity = 0;   // of a map of the layer
    bool hasFractions = false;
    CostPlan cost;
    bool seesBelow = false;    // whether candidates are those of the layer below, see TwoLayerCost and aggregateRange()
    bool smoothsGuide = false; // a median before the edges are weighed
    LayerMethod method = TREE_SUMS;
    TreePlan trees;
    VolumePenalties volumePenalties = { 0, 0, 0 };
    RangePenalties rangePenalties = { 0, 0, 0, 0, 1, 0 };
    std::vector<ScanlinePenalties> passes; // of scanlines over windows, and how these are weighed
    SmoothnessPlan smoothness = { 1, SmoothnessWeight::one, SmoothnessWeight::one };
    bool checksLastFrame = false;  // whether the pair's own costs may refuse the last frame
    bool prefersLastFrame = false; // whether what the last frame predicts has lower costs
    bool fillsOcclusions = false;
    int medianSize = 0; // of the median over the winners; 0: none
    bool restoresThinStructures = false;
    bool votesAtEdges = false;
    int surfaceDifference = 0; // most of the disparities of a surface, which are smoothed; 0: they are not
    double noise = 0;          // of the images, in levels of 255, if surfaces are smoothed
};

//! What is done for a pair
struct PairPlan
{
    Size size;              // of the images
    int numDisparities = 0; // of the images, given or found
    PyramidPlan pyramids;
    AlignmentPlan alignment;
    GivenPair given;               // what is not looked for in the pair, but known
    bool looksForRange = false;    // of disparities, which is not known: what depends on it is for a single disparity
    bool hasRanges = false;        // whether pixels have candidates of their own
    bool hasPrior = false;         // whether winners are joined with what is known beforehand
    bool followsVideo = false;     // and the finest layer is joined with the last frame
    std::vector<LayerPlan> layers; // that are matched, the top one first
    Ptr<TreeStrategy> treeStrategy;
    Ptr<DisparityPredictionModel> predictionModel; // of the layers with predicted intervals; none if no layer has them
    OutputPlan output;

    const LayerPlan& top() const { return layers.front(); }
    const LayerPlan& finest() const { return layers.back(); }
};

/** What is done for a pair, as far as it depends on nothing but this: parameters and a model of which each value is
valid by itself, size and type of the images as checkPair() accepts them, and inputs as checkInputs() does. If
numDisparities is 0, the range is that of the model, or of the inputs.
@throws cv::Exception if the parameters do not go with one another or with the images. */
CV_EXPORTS PairPlan plan(const MatcherParameters& parameters, Size size, int type, const PairModel& model = PairModel(),
                         const PairInputs& inputs = PairInputs());

//! What is done now that the pair has been seen. findings: of alignPair(); video: FIRST without one
CV_EXPORTS PairPlan adapt(const PairPlan& plan, const PairFindings& findings, const VideoFindings& video);

/** Number of pyramid layers for so many disparities, in images of any size: numLayers; more, up to maxLayers, while the
top layer has more than maxTopDisparities; fewer, but for the first two, where it would have less than 16. See
HDPTreeMatcher::Params::maxTopDisparities. */
CV_EXPORTS int chooseLayers(int numDisparities, int numLayers, int maxTopDisparities, int maxLayers);

}}} // namespace cv::stereo::hdp

#endif
