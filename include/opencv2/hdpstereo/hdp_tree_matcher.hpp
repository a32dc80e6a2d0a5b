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

compute() takes a rectified pair, both images of one size and type: CV_8UC1, CV_8UC3 (BGR), CV_8UC4 (BGR and alpha,
which is ignored) or CV_16UC1 (see below). The result is what cv::StereoMatcher promises: the disparity of every pixel
of the left image as CV_16SC1, times 16 (StereoMatcher::DISP_SCALE), or as CV_32FC1 in pixels, see setDisparityDepth();
a pixel (x, y) of the left image shows the same point as (x - disparity, y) of the right one. Pixels that a filter
rejects get (minDisparity - 1) * 16, or minDisparity - 1. Unlike cv::StereoSGBM, the matcher leaves no border of invalid
pixels: candidates outside the right image are compared with its nearest column. Images may have 1 x 1 to 32767 x 32767
pixels, and fewer columns than there are disparities.

@ref tutorial_hdpstereo_matching explains the algorithm, how to choose a preset, and what each parameter does.

The parameters of cv::StereoMatcher mean what they mean there:
- minDisparity: the smallest disparity in pixels, of any sign. A negative one adds that many columns, or numDisparities
  if that is less, on the left of the images, where the first columns have their matches.
- numDisparities: the number of candidates, > 0, not necessarily a multiple of 16. The largest disparity is
  minDisparity + numDisparities - 1; 16 times this one and 16 times (minDisparity - 1) must fit into CV_16S.
- blockSize: the side of the matching cost's square window. All values are accepted, and as with cv::StereoSGBM an even
  one counts as the next larger one, and <= 0 as 5. COST_CENSUS takes the nearest of 3, 5 and 7: 3 is a tenth faster
  than 7 with PRESET_FAST, and less accurate. COST_COLOR_GRADIENT is averaged over the window, 1 (a pixel, as in the
  paper) to 31; larger values count as 31. Its time grows with the area of the window.
- disp12MaxDiff: the largest valid difference, in pixels, between the disparity of a pixel and the largest disparity of
  those that match the same pixel of the right image. <= 0 (default) turns the check off.
- speckleWindowSize, speckleRange: see cv::filterSpeckles. The window size is a number of pixels; <= 0 (default 0) turns
  the filter off. speckleRange is in pixels, >= 0; more than 2047 counts as 2047.

CV_16UC1 is for cameras of 10 to 16 bits. All parameters in intensity levels are for 8 bits, so the upper 8 of the bits
in use stand for them. These are the fewest, 8 to 16, that are enough for all pixels of both images but one in 1024;
what is brighter, such as highlights and defective pixels, is white. The census sees the upper 10 of them; edge weights,
COST_COLOR_GRADIENT and the grey difference of scanlines see 8. So images of 8 bits times 2^k give the same map as
without the factor, if more than one pixel in 1024 has a level of 128 or more. Darker ones gain contrast: if the largest
value of a 12-bit camera is 300, 9 bits are in use, and 300 becomes level 150. Each pair has its own number of bits.

With COST_CENSUS, a dark pair of any type is brightened: its levels are doubled once or twice, if all pixels of both
images but one in 128 stay below white, so that what counts in levels (edges, noise and its threshold) is more as if the
pair were well exposed. getNoiseLevel() and getLightAlignment() are about the levels of the images.

The result depends neither on the number of threads nor on the instruction set. A matcher may be used by one thread at a
time; two matchers never share state. Its buffers are kept for the next pair.

Where the presets differ:

| parameter | PAPER | TREE | FAST | ULTRAFAST | QUALITY |
|---|---|---|---|---|---|
| blockSize | 1 | 7 | 7 | 7 | 7 |
| maxRowOffset | 0 | 64 | 64 | 64 | 64 |
| useLightAlignment | false | true | true | true | true |
| noiseThreshold | 0 | 3 | 3 | 3 | 3 |
| treeStrategy | MST | MST | ST | ST | ST |
| numLayers | 3 | 2 | 3 | 3 | 2 |
| maxTopDisparities | 0 | 64 | 32 | 32 | 48 |
| finestLayer | 0 | 0 | 0 | 1 | 0 |
| matchingCost | COLOR_GRADIENT | CENSUS | CENSUS | CENSUS | CENSUS |
| aggregation | TREES | TREE_SCANLINES | SCANLINES | SCANLINES | SCANLINES |
| topAggregation | without effect | without effect | TREE_SCANLINES | TREE_SCANLINES | TREE_SCANLINES |
| gamma | 25.5 | 20 | 20 | 20 | 20 |
| disparityPrior | SUPPORT_POINTS | UPPER_LAYER | without effect | without effect | without effect |
| delta0, beta | AUTO | 0.02, 0.9 | without effect | without effect | without effect |
| intervalMargin | 0 | 2 | without effect | without effect | without effect |
| useSubpixel | false | true | true | true | true |
| disparityMedianSize | AUTO | 5 | 5 | 5 | 7 |
| disparityMedianPasses | 1 | 1 | 1 | 1 | 2 |
| scanlinePasses | without effect | without effect | 1 | 1 | 2 |
| fillOcclusions | false | true | true | true | true |

MST is createMinimumSpanningTree(), ST createSegmentTree(). All other parameters have the value that their setter calls
the default.

A setter throws cv::Exception if a value is out of range, and leaves the matcher as it was. What depends on several
parameters or on the images is checked by compute(), before any work. compute() throws if
- an image is empty or of another type than CV_8UC1, CV_8UC3, CV_8UC4 and CV_16UC1, if they differ in size or type, are
  wider or higher than 32767 pixels, or have 2^31 bytes and more, with the columns that a negative minDisparity adds;
- speckleWindowSize is > 0 and the images have more than 238609294 pixels;
- minDisparity and numDisparities give disparities that CV_16S cannot hold;
- the cost is not COST_CENSUS with AGGREGATION_SCANLINES, AGGREGATION_TREE_SCANLINES or fillOcclusions;
- the prediction model has too few layers, see setPredictionModel();
- the output array has a fixed type other than CV_16SC1 and CV_32FC1;
- a TreeStrategy throws, or does not leave a permutation of the edges. Only this is found while matching; the matcher
  stays usable, and the output array is unchanged.

cv::Algorithm::save() and write() store all parameters, the prediction model, and the name of the tree strategy with
what its write() adds. read() takes the value of PRESET_PAPER for a parameter that the file does not have. It throws
cv::Exception if anything else is missing, of a wrong type or out of range, and leaves the matcher as it was. A file
that names a custom strategy can be read if a strategy of this name is set; it is kept.
 */
class CV_EXPORTS_W HDPTreeMatcher : public cv::StereoMatcher
{
public:
    //! Sets of parameters for create(). A preset only sets what has a setter.
    enum Preset
    {
        PRESET_PAPER = 0,     //!< the system behind the paper's tables, HDP+MST; see also setTreeStrategy()
        PRESET_FAST = 1,      //!< the default: scanlines, on the top layer over means of trees
        PRESET_ULTRAFAST = 2, //!< PRESET_FAST at half the resolution
        PRESET_QUALITY = 3,   //!< slower and more accurate than PRESET_FAST
        PRESET_TREE = 4       //!< trees on every layer, as in the paper, and scanlines over the means in them
    };

    //! Cost aggregation, see setAggregation() and setTopAggregation()
    enum Aggregation
    {
        AGGREGATION_TREES = 0,         //!< the paper's: sums over disparity trees
        AGGREGATION_SCANLINES = 1,     //!< semi-global matching over 16 predicted candidates per pixel
        AGGREGATION_TREE_SCANLINES = 2 //!< semi-global matching over the means of the costs in disparity trees
    };

    //! Matching cost, see setMatchingCost()
    enum MatchingCost
    {
        COST_COLOR_GRADIENT = 0, //!< the paper's truncated difference of colours and gradients
        COST_CENSUS = 1          //!< number of pixels of a window that are darker than its centre in one image only
    };

    //! Source of the distribution P(D_l) of a layer's disparities, see setDisparityPrior()
    enum DisparityPrior
    {
        PRIOR_SUPPORT_POINTS = 0, //!< the paper's: sparse matches of the layer that pass a left-right check
        PRIOR_UPPER_LAYER = 1     //!< the disparities of the layer above
    };

    //! Value of delta0, beta and disparityMedianSize: the matcher chooses
    enum
    {
        AUTO = -1
    };

    /** @brief Rule 1 and Rule 2 of the spanning trees (section 3.2).

    The paper's systems are HDP+MST, HDP+ST and HDP+RT with prediction, MST, ST and RT without it, and M+MST, M+ST and
    M+RT without it and with the median prefilter.
    @param strategy Not empty; the matcher keeps the pointer. createMinimumSpanningTree() in PRESET_PAPER and
    PRESET_TREE, createSegmentTree() in the others.
     */
    CV_WRAP virtual void setTreeStrategy(const Ptr<TreeStrategy>& strategy) = 0;
    /** @copybrief setTreeStrategy @sa setTreeStrategy */
    CV_WRAP virtual Ptr<TreeStrategy> getTreeStrategy() const = 0;

    /** @brief Whether candidates are predicted from layer to layer.
    @param usePrediction true (default): coarse to fine, over predicted candidates. false: the plain tree algorithm over
    the full range, on the image itself; layers, aggregation and all parameters of the prediction have no effect.
    */
    CV_WRAP virtual void setUsePrediction(bool usePrediction) = 0;
    /** @copybrief setUsePrediction @sa setUsePrediction */
    CV_WRAP virtual bool getUsePrediction() const = 0;

    /** @brief Whether there is a median prefilter, as in the paper's M+ systems (section 4.1).
    @param useMedianPrefilter true: edge weights come from a 3 x 3 median of the image; false (default): from the image
    itself. The matching cost always uses the image itself. */
    CV_WRAP virtual void setUseMedianPrefilter(bool useMedianPrefilter) = 0;
    /** @copybrief setUseMedianPrefilter @sa setUseMedianPrefilter */
    CV_WRAP virtual bool getUseMedianPrefilter() const = 0;

    /** @brief Number of pyramid layers, including the image (section 2.1, L + 1).

    Each layer has half the width, the height and the disparities of the one below.
    @param numLayers 1..16; 2 in PRESET_QUALITY and PRESET_TREE, 3 in the others. setMaxTopDisparities() may change it, and layers
    without a pixel are left out. With 3 instead of 2, images of less than a megapixel take less time and lose some fine
    structures. Without effect if prediction is off. */
    CV_WRAP virtual void setNumLayers(int numLayers) = 0;
    /** @copybrief setNumLayers @sa setNumLayers */
    CV_WRAP virtual int getNumLayers() const = 0;

    /** @brief Largest number of disparities of the top layer, which searches all of them.
    @param maxTopDisparities 0 (PRESET_PAPER): no limit, there are numLayers layers. Otherwise (64 in PRESET_TREE, 48 in
    PRESET_QUALITY, 32 in the others) layers are added until the top one has at most this many disparities, but with
    trees below it no more than the prediction model is for. Of those beyond the second, one that would leave the top
    layer fewer than 16 is not used. Without effect if prediction is off. */
    CV_WRAP virtual void setMaxTopDisparities(int maxTopDisparities) = 0;
    /** @copybrief setMaxTopDisparities @sa setMaxTopDisparities */
    CV_WRAP virtual int getMaxTopDisparities() const = 0;

    /** @brief Model behind the predicted intervals (section 2.2).
    @param model A model of at least one layer less than the pyramid, or compute() throws; the matcher keeps the
    pointer. Empty (default): the published model, DisparityPredictionModel::PUBLISHED_LARGE (for up to 4 layers) if the
    image is at least 1000 pixels wide, otherwise PUBLISHED_SMALL (for up to 3). Without effect with
    HDPTreeMatcher::AGGREGATION_SCANLINES.
     */
    CV_WRAP virtual void setPredictionModel(const Ptr<DisparityPredictionModel>& model) = 0;
    /** @copybrief setPredictionModel @sa setPredictionModel */
    CV_WRAP virtual Ptr<DisparityPredictionModel> getPredictionModel() const = 0;

    /** @brief Threshold \f$\delta_0\f$ that ends the growth of a predicted interval (section 3.1).

    A candidate of probability P joins an interval of total probability c while \f$P / (c + P) > \delta_l\f$, where
    \f$\delta_l = 2^l \delta_0\f$ in layer l.
    @param delta0 In [0, 1): the smaller, the wider the intervals. 0.02 in PRESET_TREE, HDPTreeMatcher::AUTO in the
    others: 0.064 if the image is at least 1000 pixels wide, otherwise 0.004, as in the authors' program; the paper's
    text has them the other way round. */
    CV_WRAP virtual void setDelta0(double delta0) = 0;
    /** @copybrief setDelta0 @sa setDelta0 */
    CV_WRAP virtual double getDelta0() const = 0;

    /** @brief Threshold \f$\beta\f$ of DT-Rule 2 (section 3.2).

    Two trees are joined if their intervals overlap by at least this share of the hull of both.
    @param beta In [0, 1]: the larger, the more and the smaller the trees. 0.9 in PRESET_TREE, HDPTreeMatcher::AUTO in
    the others: 0.6 if the image is at least 1000 pixels wide, otherwise 0.95, as in the authors' program; the paper's
    text has them the other way round. */
    CV_WRAP virtual void setBeta(double beta) = 0;
    /** @copybrief setBeta @sa setBeta */
    CV_WRAP virtual double getBeta() const = 0;

    /** @brief \f$\gamma\f$ of the similarity \f$\exp(-W(p, q) / \gamma)\f$ of two pixels (section 3.3).

    W is the sum of the edge weights between them in their tree.
    @param gamma In intensity levels, finite, > 0: the larger, the farther costs reach. 25.5 in PRESET_PAPER, as in the
    authors' program; 20 in the others. */
    CV_WRAP virtual void setGamma(double gamma) = 0;
    /** @copybrief setGamma @sa setGamma */
    CV_WRAP virtual double getGamma() const = 0;

    /** @brief Truncation of the colour difference in the paper's matching cost (section 3.3).

    \f[ M = \alpha \min(\overline{|I_c - I'_c|}, \tau_c) + (1 - \alpha) \min(|\nabla_x - \nabla'_x|, \tau_g) \f]
    The colour difference is a mean over the channels; gradients are those of grey levels. The three default values are
    those of the authors' program.
    @param colorTruncation \f$\tau_c\f$ in intensity levels, finite, >= 0; 10 by default. Used by
    HDPTreeMatcher::COST_COLOR_GRADIENT only, as gradientTruncation and colorWeight. */
    CV_WRAP virtual void setColorTruncation(double colorTruncation) = 0;
    /** @copybrief setColorTruncation @sa setColorTruncation */
    CV_WRAP virtual double getColorTruncation() const = 0;

    /** @brief Truncation \f$\tau_g\f$ of the difference of gradients, see setColorTruncation().
    @param gradientTruncation In intensity levels per pixel, finite, >= 0; 2 by default. */
    CV_WRAP virtual void setGradientTruncation(double gradientTruncation) = 0;
    /** @copybrief setGradientTruncation @sa setGradientTruncation */
    CV_WRAP virtual double getGradientTruncation() const = 0;

    /** @brief Weight \f$\alpha\f$ of the colour difference against the gradient, see setColorTruncation().
    @param colorWeight In [0, 1]; 0.11 by default. */
    CV_WRAP virtual void setColorWeight(double colorWeight) = 0;
    /** @copybrief setColorWeight @sa setColorWeight */
    CV_WRAP virtual double getColorWeight() const = 0;

    /** @brief Side of the median filter over each layer's disparities.

    With HDPTreeMatcher::AGGREGATION_SCANLINES the finest layer keeps thin structures in front of their surroundings
    that are more than noise.
    @param size In pixels of the layer: 0 (none), 3, 5 or 7. 7 in PRESET_QUALITY, HDPTreeMatcher::AUTO in PRESET_PAPER,
    5 in the others. AUTO is 7 with prediction and 5 without, as in the authors' program; the paper has no such filter.
    */
    CV_WRAP virtual void setDisparityMedianSize(int size) = 0;
    /** @copybrief setDisparityMedianSize @sa setDisparityMedianSize */
    CV_WRAP virtual int getDisparityMedianSize() const = 0;

    /** @brief Number of passes of the median filter over each layer's disparities.
    @param passes 1..8; 2 in PRESET_QUALITY, 1 in the others. */
    CV_WRAP virtual void setDisparityMedianPasses(int passes) = 0;
    /** @copybrief setDisparityMedianPasses @sa setDisparityMedianPasses */
    CV_WRAP virtual int getDisparityMedianPasses() const = 0;

    /** @brief Matching cost M(p, x) (section 3.3).

    The census cost compares every second pixel of a window of 3, 5 or 7 pixels (see blockSize), as on a checkerboard,
    with its centre, in grey: which of them are darker, by more than about half the deviation of the pair's noise. It
    hardly depends on the exposure of the images, but AGGREGATION_SCANLINES adds a small, truncated difference of the
    grey levels to it, which does.
    @param matchingCost HDPTreeMatcher::COST_COLOR_GRADIENT, in PRESET_PAPER, or HDPTreeMatcher::COST_CENSUS, in the
    others. */
    CV_WRAP virtual void setMatchingCost(int matchingCost) = 0;
    /** @copybrief setMatchingCost @sa setMatchingCost */
    CV_WRAP virtual int getMatchingCost() const = 0;

    /** @brief Source of P(D_l) (section 3.1).
    @param disparityPrior HDPTreeMatcher::PRIOR_SUPPORT_POINTS (default): the support points of @cite Geiger2010ELAS ,
    which take time and miss the disparities of textureless surfaces. HDPTreeMatcher::PRIOR_UPPER_LAYER (PRESET_TREE)
    costs nothing. Without effect with HDPTreeMatcher::AGGREGATION_SCANLINES. */
    CV_WRAP virtual void setDisparityPrior(int disparityPrior) = 0;
    /** @copybrief setDisparityPrior @sa setDisparityPrior */
    CV_WRAP virtual int getDisparityPrior() const = 0;

    /** @brief Number of candidates added on both sides of each predicted interval.
    @param margin 0..64; 2 in PRESET_TREE, because a sub-pixel winner needs neighbours, and 0 in the others. Without
    effect with HDPTreeMatcher::AGGREGATION_SCANLINES. */
    CV_WRAP virtual void setIntervalMargin(int margin) = 0;
    /** @copybrief setIntervalMargin @sa setIntervalMargin */
    CV_WRAP virtual int getIntervalMargin() const = 0;

    /** @brief Whether disparities have fractions, in 1/16 pixel.
    @param useSubpixel true: the winner moves to the minimum of a parabola (trees) or of a V of two lines of opposite
    slope (scanlines) through its cost and those of the candidates beside it; sharp minima of scanlines then move away
    from whole disparities, which the V prefers. false (PRESET_PAPER): whole disparities; scanlines round the final map
    only. */
    CV_WRAP virtual void setUseSubpixel(bool useSubpixel) = 0;
    /** @copybrief setUseSubpixel @sa setUseSubpixel */
    CV_WRAP virtual bool getUseSubpixel() const = 0;

    /** @brief Cost aggregation of the layers below the top one; for that one see setTopAggregation().
    @param aggregation HDPTreeMatcher::AGGREGATION_TREES (PRESET_PAPER): section 3.

    HDPTreeMatcher::AGGREGATION_TREE_SCANLINES (PRESET_TREE): the costs become weighted means over each pixel's
    disparity tree, of its few candidates, with a fifth of \f$\gamma\f$. Over these, semi-global matching
    @cite Hirschmuller2008SGM from the left, from the right, from above and from below: trees carry faint texture to
    where there is none, scanlines follow slanted surfaces. P1 is half as large here; P2 is 1.3 times as large, at most
    100, and multiplied by the similarity of the two neighbours, see setGamma(), with 0.7 \f$\gamma\f$, but never
    becomes less than P1. It takes 3 bytes per candidate, and 16 candidates or more per pixel. On the top layer, if the
    disparities of a large tree lie on a plane, others cost up to 1.25 bits more unless the pixel's costs contradict, and
    the scanlines run once more: bare surfaces end where their colour ends. Segment trees are such trees; a minimum
    spanning tree of the whole image is not.

    HDPTreeMatcher::AGGREGATION_SCANLINES (the others): semi-global matching of the costs themselves, from the left,
    from the right, from above and, but for the first pass at full size, from below, over 16 candidates per pixel around
    the disparity of the layer above and, if there may be one, that of another surface. It has no use for the prediction
    model, delta0, beta, the margin and the prior.

    Both need HDPTreeMatcher::COST_CENSUS. */
    CV_WRAP virtual void setAggregation(int aggregation) = 0;
    /** @copybrief setAggregation @sa setAggregation */
    CV_WRAP virtual int getAggregation() const = 0;

    /** @brief Cost aggregation of the top layer, with HDPTreeMatcher::AGGREGATION_SCANLINES below it.
    @param aggregation HDPTreeMatcher::AGGREGATION_TREES, or HDPTreeMatcher::AGGREGATION_TREE_SCANLINES (PRESET_FAST,
    ULTRAFAST, QUALITY): surfaces without texture get better disparities. See setAggregation(). Here all disparities are
    candidates. Without effect with another aggregation below, and without prediction. */
    CV_WRAP virtual void setTopAggregation(int aggregation) = 0;
    /** @copybrief setTopAggregation @sa setTopAggregation */
    CV_WRAP virtual int getTopAggregation() const = 0;

    /** @brief Penalty for a step of one disparity between neighbours on a scanline.
    @param P1 In bits of the census, and not in the unit of cv::StereoSGBM, 0..100; 16 by default. Without
    effect with HDPTreeMatcher::AGGREGATION_TREES. */
    CV_WRAP virtual void setP1(int P1) = 0;
    /** @copybrief setP1 @sa setP1 */
    CV_WRAP virtual int getP1() const = 0;

    /** @brief Penalty for a larger step between neighbours on a scanline.
    @param P2 In bits of the census, and not in the unit of cv::StereoSGBM, 0..100; 65 by default. It is for neighbours
    of one grey level; others cost 1.5 less for each level between them, 2.5 less on the finest layer unless the pair is
    noisy, see setNoiseThreshold(), as surfaces end where the image has an edge, but not less than P1. Without effect
    with HDPTreeMatcher::AGGREGATION_TREES. */
    CV_WRAP virtual void setP2(int P2) = 0;
    /** @copybrief setP2 @sa setP2 */
    CV_WRAP virtual int getP2() const = 0;

    /** @brief Number of passes of the scanlines over each layer.

    The first pass searches around the disparities of the layer above, each other one around those of the pass before.
    @param passes 1..4; 2 in PRESET_QUALITY, 1 in the others. Used by HDPTreeMatcher::AGGREGATION_SCANLINES only. */
    CV_WRAP virtual void setScanlinePasses(int passes) = 0;
    /** @copybrief setScanlinePasses @sa setScanlinePasses */
    CV_WRAP virtual int getScanlinePasses() const = 0;

    /** @brief Whether occluded pixels are filled, in each layer.

    Of the pixels that match one column of the right image, the one with the lowest cost is visible; those of another
    disparity are occluded. They get the disparity of the farther surface beside them. What is left of a surface that
    begins at the left border of the right image is not visible there either: it continues the surface, half as steep.
    @param fillOcclusions true needs HDPTreeMatcher::COST_CENSUS. false (PRESET_PAPER): occluded pixels stay as they
    matched. true in the others. */
    CV_WRAP virtual void setFillOcclusions(bool fillOcclusions) = 0;
    /** @copybrief setFillOcclusions @sa setFillOcclusions */
    CV_WRAP virtual bool getFillOcclusions() const = 0;

    /** @brief Layer at which matching ends; its map is enlarged to the size of the image.
    @param layer 0 (the image itself) to 15; the top layer if there are fewer layers. 1 in PRESET_ULTRAFAST, 0 in the
    others. Without effect if prediction is off. */
    CV_WRAP virtual void setFinestLayer(int layer) = 0;
    /** @copybrief setFinestLayer @sa setFinestLayer */
    CV_WRAP virtual int getFinestLayer() const = 0;

    /** @brief Whether disparities are refined over trees @cite Yang2012MST , in each layer, before the median.

    A disparity is stable if the largest one that matches its column of the right image is at most one pixel larger.
    Every pixel gets the disparity x with the smallest \f$\sum_q S(p, q) |x - D(q)|\f$ over the stable pixels q of its
    tree, a weighted median. S is the similarity of setGamma(), with a quarter of \f$\gamma\f$. Without stable pixels in
    its tree, a pixel keeps its disparity.
    @param useNonLocalRefinement false by default. Without effect with HDPTreeMatcher::AGGREGATION_SCANLINES. */
    CV_WRAP virtual void setUseNonLocalRefinement(bool useNonLocalRefinement) = 0;
    /** @copybrief setUseNonLocalRefinement @sa setUseNonLocalRefinement */
    CV_WRAP virtual bool getUseNonLocalRefinement() const = 0;

    /** @brief Whether the disparities of a pair are joined with those of the pair before, for videos.

    The left images give the motion of the camera, if there is any. It takes the last map to this frame: where a pixel
    was before, and the disparity it then has now. If the camera moves, other disparities than this one cost up to
    6 bits more on the top layer, as P(D_t | D_(t-1)), where the left image looks the same. With scanlines and two
    layers and more below, this layer then does without trees; means over trees rise by up to 3 bits, unless they
    contradict. Each pixel of the finest layer keeps the disparity that is predicted so, or the one of the last
    frame at the same place if the image stands still there, unless the measured one matches clearly better. If
    both agree, the result moves towards the measured one by 1/2 to 1/5 of the difference, and if they do not for
    some frames, the measured one is taken. If the camera moves, the census of fine layers does without its
    tolerance of noise, which costs faint texture. Maps have less noise and flicker less, surfaces with little
    texture are more often right, and things that appear, move or vanish are followed.

    The result depends on the pairs before, from the first one on: the first compute(), one for images of another size
    or with another minDisparity, numDisparities or finestLayer, and one whose left image shows another scene or whose
    disparities contradict much of the last ones begin anew, and so does the compute() after clear(), read() or one
    without temporal prediction. A pair that contradicts the last one is matched twice. One matcher is for one video. It
    keeps about 11 bytes per pixel more. See the tutorial for figures.
    @param useTemporalPrediction false by default: compute() depends on nothing but its arguments. true needs
    HDPTreeMatcher::COST_CENSUS. */
    CV_WRAP virtual void setUseTemporalPrediction(bool useTemporalPrediction) = 0;
    /** @copybrief setUseTemporalPrediction @sa setUseTemporalPrediction */
    CV_WRAP virtual bool getUseTemporalPrediction() const = 0;

    /** @brief Largest difference of the rows of both images that is made good before they are matched.

    Rectified images have the same point in the same row. Temperature, a knock or a poor calibration change that, and
    half a row already costs accuracy. compute() matches some hundred corners in both directions, see
    getRowAlignment(), and moves the rows of the right image if these matches are certain that rows are off by more than
    0.12 pixels (root of the mean square). Other pairs are matched as they are. It takes a few percent of the time of
    PRESET_FAST, and twice as much more if rows are moved.
    @param maxRowOffset In pixels, >= 0, at the worst corner of the image; larger differences are not believed. 0
    (PRESET_PAPER): off. 64 in the others. The search reaches 1/110 of the square root of the image's area: 10 pixels in
    one of 1.4 megapixels, with any slopes that small rotations of a camera make. */
    CV_WRAP virtual void setMaxRowOffset(int maxRowOffset) = 0;
    /** @copybrief setMaxRowOffset @sa setMaxRowOffset */
    CV_WRAP virtual int getMaxRowOffset() const = 0;

    /** @brief Whether the right image gets the light of the left one before they are matched.

    Cameras differ in exposure, gamma and vignetting, some pairs on purpose. compute() compares the mean levels around
    some hundred matched corners. If a model of gain, offset, curve and vignetting explains what differs, by a level of
    255 and more, the grey levels of the right image are changed by it. Other lamps, or reflections, are not explained by
    it; such pairs are matched as they are.
    @param useLightAlignment false (PRESET_PAPER), true in the others. Without effect with
    HDPTreeMatcher::COST_COLOR_GRADIENT. */
    CV_WRAP virtual void setUseLightAlignment(bool useLightAlignment) = 0;
    /** @copybrief setUseLightAlignment @sa setUseLightAlignment */
    CV_WRAP virtual bool getUseLightAlignment() const = 0;

    /** @brief Noise from which both images are smoothed before they are matched, see getNoiseLevel().

    A Gaussian of 3 x 3 pixels takes noise from the matching cost, and a median of as many from the edge weights, in each
    layer. Without noise both would cost details. The blocks of strong JPEG compression, where both images show them, are
    smoothed whatever the noise is.
    @param noiseThreshold Standard deviation of the grey levels, 255 being white, finite, >= 0; of a dark pair, when it is
    brightened. 0 (PRESET_PAPER): never smoothed, nor are blocks. 3 in the others. */
    CV_WRAP virtual void setNoiseThreshold(double noiseThreshold) = 0;
    /** @copybrief setNoiseThreshold @sa setNoiseThreshold */
    CV_WRAP virtual double getNoiseThreshold() const = 0;

    /** @brief Type of the map that compute() returns.
    @param depth CV_16S (default): 16 times the disparity. CV_32F: in pixels, with minDisparity - 1 where a filter
    rejects a pixel. The type of an output array of fixed type, such as cv::Mat_<float>, takes precedence. */
    CV_WRAP virtual void setDisparityDepth(int depth) = 0;
    /** @copybrief setDisparityDepth @sa setDisparityDepth */
    CV_WRAP virtual int getDisparityDepth() const = 0;

    /** @brief Returns how reliable each disparity of the last compute() is.

    It is computed by this call; compute() does not take longer. The confidence is
    \f$255 v \sqrt{P M \sqrt{S U}}\f$. S grows with the distance to the nearest step of the disparities, to 1 at 64
    pixels. U is how much the costs A two disparities before and after stand out from the cost C of the disparity:
    \f$U = \max(0, \bar A - \bar C) / (\bar A + \bar C)\f$, means over 21 x 21 pixels. P is 1 / (1 + 4 p), p being the
    mean difference from the layer above over 62 x 62 pixels, and M is 1 / (1 + 4 m), m being the mean change by the
    median over 14 x 14 pixels. v is 1, or 1/2 if a nearer pixel hides this one from the right image or its match is
    outside that image. Distances and disparities are in pixels of the finest layer. The confidence is no probability;
    it serves to sort or weight pixels, or to reject those below a threshold.
    @param confidence Receives CV_8UC1 of the left image's size: from 0 to 255, larger is more reliable; 0 where a
    filter rejected the pixel. Empty before the first compute() and after one that threw an exception.
     */
    CV_WRAP virtual void getConfidence(OutputArray confidence) const = 0;

    /** @brief Returns the share of the disparity range that the last compute() searched, \f$R_l\f$ of the paper's Table
    1.
    @param ratios Receives a number in [0, 1] per layer, that of the image first, 0 for one finer than finestLayer;
    empty before the first compute() and after one that threw an exception.
     */
    CV_WRAP virtual void getSearchRatios(CV_OUT std::vector<double>& ratios) const = 0;

    /** @brief Returns the disparity forest of the last compute() (section 3.2), at the finest layer that has one.

    With scanlines this is the top layer, whose trees search the full range. Either may be cv::noArray().
    @param trees Receives the number of each pixel's tree, from 0: CV_32SC1 of the layer's size. Empty before the first
    compute(), after one that threw an exception, and if temporal prediction took the place of trees.
    @param intervals Receives the first and the last candidate of each pixel's tree, TreeIntv, counted from the smallest
    disparity: CV_16UC2 of the same size.
     */
    CV_WRAP virtual void getForest(OutputArray trees, OutputArray intervals) const = 0;

    /** @brief Returns the \f$P(D_l)\f$ that predicted a layer's intervals in the last compute() (section 3.1).
    @param layer l >= 0, 0 being the image.
    @param prior Receives a number >= 0 per candidate of the layer, the smallest disparity first, up to a factor. Empty
    if nothing was predicted there, as in the top layer and with scanlines.
     */
    CV_WRAP virtual void getLayerPrior(int layer, CV_OUT std::vector<double>& prior) const = 0;

    /** @brief Returns the disparities \f$D_l\f$ of a layer in the last compute(), as the layer below uses them.

    This is after the median, and before disp12MaxDiff and the speckle filter reject pixels.
    @param layer l >= 0, 0 being the image.
    @param disparity Receives CV_32FC1 of the layer's size, in pixels of the layer, counted from the smallest disparity.
    Empty if there is no such layer, for layers finer than finestLayer, before the first compute() and after one that
    threw an exception.
     */
    CV_WRAP virtual void getLayerDisparity(int layer, OutputArray disparity) const = 0;

    /** @brief Returns how the rows of the right image lay against those of the left one in the last compute().

    A point of the right image that is u pixels right of its centre and v below it was
    \f$m_0 + m_1 u + m_2 v + m_3 u v + m_4 v^2\f$ pixels below its row. These are the differences that small rotations
    of a camera and another focal length make. @ref tutorial_hdpstereo_matching tells how to correct a calibration by
    them.
    @param model Receives \f$m_0, \ldots, m_4\f$, whether rows were moved or not; zeros if too few matches were found,
    if setMaxRowOffset() turned the search off, before the first compute() and after one that threw an exception.
    @return Whether the rows were moved before matching.
     */
    CV_WRAP virtual bool getRowAlignment(CV_OUT std::vector<double>& model) const = 0;

    /** @brief Returns how the light of the right image differed from that of the left one in the last compute().

    With levels from 0 to 1, a level r of the right image at (x, y), from its centre in units of its width and height,
    is \f$r (m_0 + m_1 x + m_2 y + m_3 x^2 + m_4 x y + m_5 y^2 + m_6 (x^2 + y^2)^2) + m_7 + m_8 r^2 + m_9 r^3\f$ in the
    left one. The width is that of the image with the columns that a negative minDisparity adds.
    @param model Receives \f$m_0, \ldots, m_9\f$, whether the light was changed or not; 1 and zeros if too few matches
    were found, if it was not looked for, before the first compute() and after one that threw an exception.
    @return Whether the right image was changed before matching.
     */
    CV_WRAP virtual bool getLightAlignment(CV_OUT std::vector<double>& model) const = 0;

    /** @brief Returns the noise of the last compute()'s pair: what differs between matched corners.
    @return Standard deviation of the grey levels, 255 being white, of the finest layer that matches are followed to. This
    is the image itself if it has at most 600000 pixels and finestLayer is 0; each layer above has less. 0 if
    too few matches were found or nothing asked for them (maxRowOffset 0, no light alignment, and a noise threshold of
    0), before the first compute() and after one that threw an exception. Texture that is finer than pixels counts as
    noise, too.
     */
    CV_WRAP virtual double getNoiseLevel() const = 0;

    /** @brief Returns the wall time of each stage in the last compute(), summed over the layers.
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
    @throws cv::Exception if numDisparities or preset is out of range.
     */
    CV_WRAP static Ptr<HDPTreeMatcher> create(int minDisparity = 0, int numDisparities = 64,
                                              int preset = HDPTreeMatcher::PRESET_FAST);
};

//! @}

} // namespace stereo
} // namespace cv

#endif
