// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_HDP_TREE_MATCHER_HPP
#define OPENCV_HDPSTEREO_HDP_TREE_MATCHER_HPP

// The only code that knows OpenCV's versions: what opencv_calib3d and opencv_imgproc of 4.x have for stereo matching is
// in opencv_stereo and opencv_geometry since 5.0.
#include "opencv2/core/version.hpp"
#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry/2d.hpp"
#include "opencv2/stereo.hpp"
#else
#include "opencv2/calib3d.hpp"
#endif
#include "opencv2/hdpstereo/disparity_prediction.hpp"
#include "opencv2/hdpstereo/tree_strategy.hpp"

namespace cv {
namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief Stereo matching over disparity trees with hierarchical disparity prediction @cite Luo2015HDP.

compute() takes a rectified pair: CV_8UC1 or CV_8UC3 (BGR), both images of one size and type. The result is
what cv::StereoMatcher promises: the disparity of every pixel of the left image as CV_16SC1, times 16
(StereoMatcher::DISP_SCALE), or as CV_32FC1 in pixels, see setDisparityDepth(); a pixel (x, y) of the left image shows
the same point as (x - disparity, y) of the right one. Pixels that a filter rejects get (minDisparity - 1) * 16, or
minDisparity - 1. Unlike cv::StereoSGBM the matcher
leaves no border of invalid pixels: candidates outside of the right image are compared with its nearest
column. Images from 1 x 1 to 32767 x 32767 and any number of disparities are allowed, also more disparities than
columns.

@ref tutorial_hdpstereo_matching explains the algorithm, how to choose a preset, and what each parameter does to speed
and accuracy.

The parameters that cv::StereoMatcher declares mean what they mean there:
- minDisparity: the smallest disparity in pixels, of any sign. A negative one adds as many columns to the images, on the
  left, so that the first columns have their matches.
- numDisparities: number of candidates, > 0, no multiple of 16 needed. The largest disparity is
  minDisparity + numDisparities - 1; minDisparity - 1 and this one must fit into CV_16S, times 16.
- blockSize: the side of the matching cost's square window, odd, 1..31: the paper's cost is averaged over it (1, as in
  the paper, is one pixel), the census cost compares its pixels.
- disp12MaxDiff: largest allowed difference, in pixels, between the disparity of a left pixel and the largest one
  that maps to the same pixel of the right image; other pixels become invalid. <= 0 (default) turns the check off.
- speckleWindowSize, speckleRange: see cv::filterSpeckles; the window size is a number of pixels, and <= 0 (default 0)
  turns the filter off; speckleRange is in pixels, >= 0, and more than 2047 counts as 2047.

The result does not depend on the number of threads nor on the processor's SIMD width. A matcher may be used from one
thread at a time; two matchers never share state. Reused for pairs of the same size it keeps its buffers.

The parameters that the presets differ in:

| parameter | PAPER | TREE | FAST | ULTRAFAST | QUALITY |
|---|---|---|---|---|---|
| blockSize | 1 | 7 | 7 | 7 | 7 |
| treeStrategy | MST | MST | ST | ST | ST |
| numLayers | 3 | 3 | 3 | 3 | 2 |
| maxTopDisparities | 0 | 0 | 64 | 64 | 64 |
| finestLayer | 0 | 0 | 0 | 1 | 0 |
| matchingCost | COLOR_GRADIENT | CENSUS | CENSUS | CENSUS | CENSUS |
| aggregation | TREES | TREES | SCANLINES | SCANLINES | SCANLINES |
| gamma | 25.5 | 20 | 20 | 20 | 20 |
| disparityPrior | SUPPORT_POINTS | UPPER_LAYER | without effect | without effect | without effect |
| delta0, beta | AUTO | 0.02, 0.9 | without effect | without effect | without effect |
| intervalMargin | 0 | 1 | without effect | without effect | without effect |
| useSubpixel | false | true | true | true | true |
| disparityMedianSize | AUTO | 5 | 5 | 5 | 7 |
| disparityMedianPasses | 1 | 1 | 1 | 1 | 2 |
| scanlinePasses | without effect | without effect | 1 | 1 | 2 |
| fillOcclusions | false | true | true | true | true |

MST is createMinimumSpanningTree(), ST is createSegmentTree(). The other parameters are the same in all of them: the
values that their setters call the default.

Setters throw cv::Exception for values out of their range and leave the matcher as it was. What depends on several
parameters or on the images is checked by compute(), before it does any work. compute() throws if
- an image is empty or neither CV_8UC1 nor CV_8UC3, if they differ in size or type, are wider or higher than 32767
  pixels, or have 2^31 bytes and more, with the columns that a negative minDisparity adds;
- speckleWindowSize is > 0 and the images have more than 238609294 pixels;
- minDisparity and numDisparities give disparities that CV_16S cannot hold;
- blockSize is not 3, 5 or 7 with COST_CENSUS;
- the cost is not COST_CENSUS with AGGREGATION_SCANLINES or fillOcclusions;
- the prediction model has too few layers, see setPredictionModel();
- the output array has a fixed type other than CV_16SC1 and CV_32FC1;
- a TreeStrategy throws, or does not leave a permutation of the edges. This one alone is found while it works: the
  matcher is as usable as before then, and the output array is unchanged.

cv::Algorithm::save() and write() store all parameters, the strategy by its name with what its write() adds, and the
prediction model. read() takes PRESET_PAPER's value for a parameter that the file does not have; it throws cv::Exception
for anything else that is missing, of a wrong type or out of range, and leaves the matcher as it was. A file that names
a strategy of yours can be read by a matcher that has one of this name set, which it keeps.
 */
class CV_EXPORTS_W HDPTreeMatcher : public cv::StereoMatcher
{
public:
    //! Sets of parameters for create(). A preset only sets values that have setters of their own.
    enum Preset
    {
        PRESET_PAPER = 0,     //!< the system that made the paper's tables, HDP+MST; see also setTreeStrategy()
        PRESET_FAST = 1,      //!< the default: a tree on the top layer, scanlines below; more accurate than
                              //!< cv::StereoSGBM and several times faster
        PRESET_ULTRAFAST = 2, //!< PRESET_FAST that stops at half the resolution
        PRESET_QUALITY = 3,   //!< slower and better than PRESET_FAST
        PRESET_TREE = 4 //!< trees on every layer as in the paper, with the census cost, the layer above as prior and
                        //!< a sub-pixel winner
    };

    //! What smooths the costs of a layer that has a prediction
    enum Aggregation
    {
        AGGREGATION_TREES = 0,    //!< the disparity trees of the paper
        AGGREGATION_SCANLINES = 1 //!< paths along rows and down columns, over 16 predicted candidates a pixel
    };

    //! Matching costs
    enum MatchingCost
    {
        COST_COLOR_GRADIENT = 0, //!< truncated colour and gradient difference, the paper's; see setColorTruncation()
        COST_CENSUS = 1          //!< number of pixels in the window that are darker than its centre in one image only
    };

    //! Where the distribution P(D_l) of a layer's disparities comes from
    enum DisparityPrior
    {
        PRIOR_SUPPORT_POINTS = 0, //!< sparse, left-right checked matches in the layer, the paper's
        PRIOR_UPPER_LAYER = 1     //!< the disparities of the layer above, which are there already
    };

    //! Value of delta0, beta and the disparity median that leaves the choice to the matcher
    enum
    {
        AUTO = -1
    };

    /** @brief Rule 1 and Rule 2 of the spanning trees (section 3.2).

    The paper's systems are HDP+MST, HDP+ST and HDP+RT with prediction, MST, ST and RT without it, and M+MST, M+ST
    and M+RT without prediction and with the median prefilter.
    @param strategy Not empty. The matcher keeps the pointer and only reads through it. createMinimumSpanningTree() in
    PRESET_PAPER and PRESET_TREE, createSegmentTree() in the others.
     */
    CV_WRAP virtual void setTreeStrategy(const Ptr<TreeStrategy>& strategy) = 0;
    /** @copybrief setTreeStrategy @sa setTreeStrategy */
    CV_WRAP virtual Ptr<TreeStrategy> getTreeStrategy() const = 0;

    /** @brief Whether to match coarse to fine with predicted intervals (true, default), or the plain tree algorithm:
    the image itself, over the full range (false).
    @param usePrediction Without it, numLayers, finestLayer, the aggregation and all of the prediction have no effect.
    */
    CV_WRAP virtual void setUsePrediction(bool usePrediction) = 0;
    /** @copybrief setUsePrediction @sa setUsePrediction */
    CV_WRAP virtual bool getUsePrediction() const = 0;

    /** @brief Whether edge weights come from a 3 x 3 median of the image (true, the paper's M+ systems, section 4.1) or
    from the image itself (false, default).
    @param useMedianPrefilter The matching cost uses the image itself in both cases. */
    CV_WRAP virtual void setUseMedianPrefilter(bool useMedianPrefilter) = 0;
    /** @copybrief setUseMedianPrefilter @sa setUseMedianPrefilter */
    CV_WRAP virtual bool getUseMedianPrefilter() const = 0;

    /** @brief Number of pyramid layers (section 2.1), the image itself included; the paper's L + 1. Each has half the
    width, the height and the disparities of the one below.
    @param numLayers 1..16; setMaxTopDisparities() may change it. Layers that would have no pixel are left out. 2 in
    PRESET_QUALITY, 3 in the others: takes less time on images of less than a megapixel, and loses some fine structures
    there. Without effect if prediction is off. */
    CV_WRAP virtual void setNumLayers(int numLayers) = 0;
    /** @copybrief setNumLayers @sa setNumLayers */
    CV_WRAP virtual int getNumLayers() const = 0;

    /** @brief Fits the number of layers to the number of disparities: the top layer searches all of its own.
    @param maxTopDisparities 0: no limit, there are numLayers layers. Else layers are added until the top one has so many
    disparities or less, and beyond the second one a layer that would leave it less than 16 is left out. 0 in PRESET_PAPER
    and PRESET_TREE, 64 in the others. Without effect if prediction is off. */
    CV_WRAP virtual void setMaxTopDisparities(int maxTopDisparities) = 0;
    /** @copybrief setMaxTopDisparities @sa setMaxTopDisparities */
    CV_WRAP virtual int getMaxTopDisparities() const = 0;

    /** @brief The model behind the predicted intervals (section 2.2).
    @param model A model of at least numLayers - 1 layers, or an empty pointer (default) for the published one:
    DisparityPredictionModel::PUBLISHED_LARGE for images at least 1000 pixels wide, PUBLISHED_SMALL below. The matcher
    keeps the pointer. compute() throws if the model has fewer layers: the large one is enough for 4, the small one for
    3 layers. Without effect with HDPTreeMatcher::AGGREGATION_SCANLINES.
     */
    CV_WRAP virtual void setPredictionModel(const Ptr<DisparityPredictionModel>& model) = 0;
    /** @copybrief setPredictionModel @sa setPredictionModel */
    CV_WRAP virtual Ptr<DisparityPredictionModel> getPredictionModel() const = 0;

    /** @brief \f$\delta_0\f$ of the criterion that ends the growth of a predicted interval (section 3.1): with the sum
    c of the probabilities of the interval's candidates, one more joins it while \f$P / (c + P) > \delta_l\f$; layer l
    uses \f$\delta_l = 2^l \delta_0\f$.
    @param delta0 In [0, 1): the smaller, the wider the intervals. HDPTreeMatcher::AUTO: 0.064 for images at least 1000
    pixels wide, 0.004 below, the values that made the paper's tables. 0.02 in PRESET_TREE, AUTO in the others. */
    CV_WRAP virtual void setDelta0(double delta0) = 0;
    /** @copybrief setDelta0 @sa setDelta0 */
    CV_WRAP virtual double getDelta0() const = 0;

    /** @brief \f$\beta\f$ of DT-Rule 2 (section 3.2): two trees are joined if their intervals overlap by at least this
    share of the hull of both.
    @param beta In [0, 1]: the larger, the more and the smaller trees. HDPTreeMatcher::AUTO: 0.6 for images at least
    1000 pixels wide, 0.95 below. 0.9 in PRESET_TREE, AUTO in the others. */
    CV_WRAP virtual void setBeta(double beta) = 0;
    /** @copybrief setBeta @sa setBeta */
    CV_WRAP virtual double getBeta() const = 0;

    /** @brief \f$\gamma\f$ of the similarity \f$\exp(-W(p, q) / \gamma)\f$ of two pixels at distance W in their tree
    (section 3.3), the sum of the weights of the edges between them.
    @param gamma In intensity levels, finite, > 0: the larger, the farther costs are summed. 25.5 in PRESET_PAPER, 20 in
    the others. */
    CV_WRAP virtual void setGamma(double gamma) = 0;
    /** @copybrief setGamma @sa setGamma */
    CV_WRAP virtual double getGamma() const = 0;

    /** @brief Truncation of the colour difference in the matching cost
    \f$M = \alpha \min(\overline{|I_c - I'_c|}, \tau_c) + (1 - \alpha) \min(|\nabla_x - \nabla'_x|, \tau_g)\f$ (section
    3.3), whose colour difference is the mean over the channels, and whose gradients are those of grey levels.
    @param colorTruncation \f$\tau_c\f$ in intensity levels, finite, >= 0; 10 by default. Without effect with
    HDPTreeMatcher::COST_CENSUS, as gradientTruncation and colorWeight. */
    CV_WRAP virtual void setColorTruncation(double colorTruncation) = 0;
    /** @copybrief setColorTruncation @sa setColorTruncation */
    CV_WRAP virtual double getColorTruncation() const = 0;

    /** @brief Truncation \f$\tau_g\f$ of the difference of the horizontal gradients, see setColorTruncation().
    @param gradientTruncation In intensity levels a pixel, finite, >= 0; 2 by default. */
    CV_WRAP virtual void setGradientTruncation(double gradientTruncation) = 0;
    /** @copybrief setGradientTruncation @sa setGradientTruncation */
    CV_WRAP virtual double getGradientTruncation() const = 0;

    /** @brief Weight \f$\alpha\f$ of the colour difference against the gradient, see setColorTruncation().
    @param colorWeight In [0, 1]; 0.11 by default. */
    CV_WRAP virtual void setColorWeight(double colorWeight) = 0;
    /** @copybrief setColorWeight @sa setColorWeight */
    CV_WRAP virtual double getColorWeight() const = 0;

    /** @brief Side of the median filter over each layer's disparities.
    @param size In pixels of the layer: 0 (none), 3, 5, 7, or HDPTreeMatcher::AUTO: 7 with prediction, 5 without, as in
    the paper's tables. AUTO in PRESET_PAPER, 7 in PRESET_QUALITY, 5 in the others. */
    CV_WRAP virtual void setDisparityMedianSize(int size) = 0;
    /** @copybrief setDisparityMedianSize @sa setDisparityMedianSize */
    CV_WRAP virtual int getDisparityMedianSize() const = 0;

    /** @brief How often the median filter runs over each layer's disparities.
    @param passes 1..8; 2 in PRESET_QUALITY, 1 in the others. */
    CV_WRAP virtual void setDisparityMedianPasses(int passes) = 0;
    /** @copybrief setDisparityMedianPasses @sa setDisparityMedianPasses */
    CV_WRAP virtual int getDisparityMedianPasses() const = 0;

    /** @brief The matching cost M(p, x) (section 3.3).

    The census cost compares every second pixel of the window, as on a checkerboard, with its centre, in grey; blockSize
    must be 3, 5 or 7 then. It does not depend on the exposure of the images, but AGGREGATION_SCANLINES adds a small,
    truncated difference of the grey levels to it, which does.
    @param matchingCost HDPTreeMatcher::COST_COLOR_GRADIENT, in PRESET_PAPER, or HDPTreeMatcher::COST_CENSUS, in the
    others. */
    CV_WRAP virtual void setMatchingCost(int matchingCost) = 0;
    /** @copybrief setMatchingCost @sa setMatchingCost */
    CV_WRAP virtual int getMatchingCost() const = 0;

    /** @brief Where P(D_l) comes from (section 3.1).
    @param disparityPrior HDPTreeMatcher::PRIOR_SUPPORT_POINTS (default), which are those of @cite Geiger2010ELAS and
    leave out disparities of textureless surfaces, or HDPTreeMatcher::PRIOR_UPPER_LAYER, in PRESET_TREE, which costs
    nothing. Without effect with HDPTreeMatcher::AGGREGATION_SCANLINES. */
    CV_WRAP virtual void setDisparityPrior(int disparityPrior) = 0;
    /** @copybrief setDisparityPrior @sa setDisparityPrior */
    CV_WRAP virtual int getDisparityPrior() const = 0;

    /** @brief Candidates added on both sides of each predicted interval. A sub-pixel winner needs neighbours, so 1 pays
    with setUseSubpixel().
    @param margin In pixels of the layer, 0..64; 1 in PRESET_TREE, 0 in the others. */
    CV_WRAP virtual void setIntervalMargin(int margin) = 0;
    /** @copybrief setIntervalMargin @sa setIntervalMargin */
    CV_WRAP virtual int getIntervalMargin() const = 0;

    /** @brief Whether the disparities of each layer have a fraction, in 1/16 pixel.
    @param useSubpixel true: the winner is moved to the minimum of the parabola (trees) or of the V of two lines of one
    slope (scanlines) through its aggregated cost and those of the candidates beside it; false, in PRESET_PAPER: the map
    has whole disparities. Scanlines keep the fraction until the map is written. */
    CV_WRAP virtual void setUseSubpixel(bool useSubpixel) = 0;
    /** @copybrief setUseSubpixel @sa setUseSubpixel */
    CV_WRAP virtual bool getUseSubpixel() const = 0;

    /** @brief What aggregates the costs of the layers below the top one, which always has a tree:
    HDPTreeMatcher::AGGREGATION_TREES (section 3) or HDPTreeMatcher::AGGREGATION_SCANLINES, semi-global matching
    @cite Hirschmuller2008SGM from the left, from the right and from above.
    @param aggregation TREES in PRESET_PAPER and PRESET_TREE, SCANLINES in the others; these need
    HDPTreeMatcher::COST_CENSUS. Scanlines search 16 candidates around the disparities of the layer above, so the
    prediction model, delta0, beta, the margin and the prior have no effect with them. */
    CV_WRAP virtual void setAggregation(int aggregation) = 0;
    /** @copybrief setAggregation @sa setAggregation */
    CV_WRAP virtual int getAggregation() const = 0;

    /** @brief The penalty for a step of one disparity between neighbours on a scanline, as P1 of
    cv::StereoSGBM.
    @param P1 In bits of the census, 0..100; 12 by default. Used by HDPTreeMatcher::AGGREGATION_SCANLINES only. */
    CV_WRAP virtual void setP1(int P1) = 0;
    /** @copybrief setP1 @sa setP1 */
    CV_WRAP virtual int getP1() const = 0;

    /** @brief The penalty for a larger step between neighbours on a scanline, as P2 of cv::StereoSGBM.
    @param P2 In bits of the census, 0..100; 50 by default. Used by HDPTreeMatcher::AGGREGATION_SCANLINES only. */
    CV_WRAP virtual void setP2(int P2) = 0;
    /** @copybrief setP2 @sa setP2 */
    CV_WRAP virtual int getP2() const = 0;

    /** @brief How often a layer is aggregated along scanlines. Each pass but the first searches around the disparities
    of the one before instead of those of the layer above.
    @param passes 1..4; 2 in PRESET_QUALITY, 1 in the others. Used by HDPTreeMatcher::AGGREGATION_SCANLINES only. */
    CV_WRAP virtual void setScanlinePasses(int passes) = 0;
    /** @copybrief setScanlinePasses @sa setScanlinePasses */
    CV_WRAP virtual int getScanlinePasses() const = 0;

    /** @brief Whether pixels that the right image does not show take, in each layer, the disparity of the farther of
    the pixels beside them, or keep what they matched best. Of the pixels that map to one column of the right image the
    one with the lowest cost is shown; those of another disparity are not, nor the rest of a surface that begins at the
    left border of the right image.
    @param fillOcclusions Needs HDPTreeMatcher::COST_CENSUS; false in PRESET_PAPER, true in the others. */
    CV_WRAP virtual void setFillOcclusions(bool fillOcclusions) = 0;
    /** @copybrief setFillOcclusions @sa setFillOcclusions */
    CV_WRAP virtual bool getFillOcclusions() const = 0;

    /** @brief The layer the search ends at. The map of a coarser layer is enlarged to the image's size.
    @param layer 0, the image itself, to 15; more than there are layers: the top one. 1 in PRESET_ULTRAFAST, 0 in the
    others. Without effect if prediction is off. */
    CV_WRAP virtual void setFinestLayer(int layer) = 0;
    /** @copybrief setFinestLayer @sa setFinestLayer */
    CV_WRAP virtual int getFinestLayer() const = 0;

    /** @brief Whether each layer's winners are refined over trees @cite Yang2012MST , before the median.

    A disparity is stable if the largest one that maps to its column of the right image is larger by one pixel at most.
    Every pixel takes the disparity x with the smallest \f$\sum_q S(p, q) |x - D(q)|\f$, the sum over the stable pixels
    of its tree: a weighted median. S is as in setGamma(), but with a quarter of \f$\gamma\f$. A pixel of a tree without
    stable ones keeps its disparity.
    @param useNonLocalRefinement false by default. Without effect with HDPTreeMatcher::AGGREGATION_SCANLINES. */
    CV_WRAP virtual void setUseNonLocalRefinement(bool useNonLocalRefinement) = 0;
    /** @copybrief setUseNonLocalRefinement @sa setUseNonLocalRefinement */
    CV_WRAP virtual bool getUseNonLocalRefinement() const = 0;

    /** @brief The type of the disparities that compute() makes. An output array of fixed type, as cv::Mat_<float> is,
    decides by itself.
    @param depth CV_16S (default), times 16, or CV_32F, in pixels, with minDisparity - 1 where a filter rejects a
    pixel. */
    CV_WRAP virtual void setDisparityDepth(int depth) = 0;
    /** @copybrief setDisparityDepth @sa setDisparityDepth */
    CV_WRAP virtual int getDisparityDepth() const = 0;

    /** @brief How far each disparity of the last compute() is to be trusted. It is made when asked for, and costs
    compute() nothing.

    The confidence is \f$255 v \sqrt{S U}\f$. S grows with the distance to the nearest step of the disparities, to 1 at
    64 pixels. U is how much the matching cost stands out from the costs C two disparities before and after:
    \f$U = \max(0, \bar C - \bar M) / (\bar C + \bar M)\f$, means over 21 x 21 pixels. v is 1, but 1/2 if a nearer
    pixel hides this one from the right image or its match is outside of that image. Distances are in pixels of the
    finest layer that was matched. It is not a probability: it is there to sort or to weight pixels by, or to leave out
    those below a threshold.
    @param confidence Receives CV_8UC1 of the left image's size: from 0 to 255, larger is more reliable; 0 where a
    filter rejected the pixel. Empty before the first compute() and after one that threw an exception.
     */
    CV_WRAP virtual void getConfidence(OutputArray confidence) const = 0;

    /** @brief Share of the disparity range that the last compute() searched, \f$R_l\f$ of the paper's Table 1.
    @param ratios Receives a number in [0, 1] per layer, that of the image first, 0 for one finer than finestLayer;
    empty before the first compute() and after one that threw an exception.
     */
    CV_WRAP virtual void getSearchRatios(CV_OUT std::vector<double>& ratios) const = 0;

    /** @brief The disparity prediction forest of the last compute() (section 3.2), at the finest layer that has one.
    With scanlines that is the top layer, whose trees search the full range. cv::noArray() leaves either out.
    @param trees Receives the number of each pixel's tree, from 0: CV_32SC1 of the layer's size. Empty before the first
    compute() and after one that threw an exception.
    @param intervals Receives the first and the last candidate that the pixel's tree searched, TreeIntv, in pixels of
    the layer above the smallest disparity: CV_16UC2 of the same size.
     */
    CV_WRAP virtual void getForest(OutputArray trees, OutputArray intervals) const = 0;

    /** @brief \f$P(D_l)\f$ that the intervals of a layer were predicted with in the last compute() (section 3.1).
    @param layer l >= 0, 0 being the image.
    @param prior Receives a number >= 0 per candidate of the layer, the smallest disparity first, up to a factor. Empty if
    nothing was predicted there, as in the top layer and with scanlines.
     */
    CV_WRAP virtual void getLayerPrior(int layer, CV_OUT std::vector<double>& prior) const = 0;

    /** @brief The disparities \f$D_l\f$ of a layer in the last compute(), as the layer below sees them: after the median,
    before what disp12MaxDiff and the speckle filter reject.
    @param layer l >= 0, 0 being the image.
    @param disparity Receives CV_32FC1 of the layer's size, in pixels of the layer above the smallest disparity. Empty if
    there is no such layer, for layers finer than finestLayer, before the first compute() and after one that threw an
    exception.
     */
    CV_WRAP virtual void getLayerDisparity(int layer, OutputArray disparity) const = 0;

    /** @brief Wall time of each stage in the last compute(), the layers together.
    @param stages Receives the names of the stages in the order in which they first ran; empty before the first
    compute() and after one that threw an exception.
    @param milliseconds Receives a time per stage.
     */
    CV_WRAP virtual void getStageTimes(CV_OUT std::vector<String>& stages,
                                       CV_OUT std::vector<double>& milliseconds) const = 0;

    /** @brief Creates a matcher.
    @param minDisparity Smallest disparity in pixels, of any sign.
    @param numDisparities Number of candidates, > 0.
    @param preset One of HDPTreeMatcher::PRESET_FAST, PRESET_ULTRAFAST, PRESET_QUALITY, PRESET_TREE and PRESET_PAPER.
    @throws cv::Exception if numDisparities or preset is not so.
     */
    CV_WRAP static Ptr<HDPTreeMatcher> create(int minDisparity = 0, int numDisparities = 64,
                                              int preset = HDPTreeMatcher::PRESET_FAST);
};

//! @}

} // namespace stereo
} // namespace cv

#endif
