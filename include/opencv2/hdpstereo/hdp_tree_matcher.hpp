// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_HDP_TREE_MATCHER_HPP
#define OPENCV_HDPSTEREO_HDP_TREE_MATCHER_HPP

// What opencv_calib3d and opencv_imgproc of 4.x have for stereo matching is in opencv_stereo and opencv_geometry since
// 5.0.
#include "opencv2/core/version.hpp"
#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry/2d.hpp"
#include "opencv2/geometry/3d.hpp"
#include "opencv2/stereo.hpp"
#else
#include "opencv2/calib3d.hpp"
#endif
#include "opencv2/hdpstereo/disparity_prediction.hpp"
#include "opencv2/hdpstereo/pair_model.hpp"
#include "opencv2/hdpstereo/tree_strategy.hpp"

namespace cv { namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief Stereo matching over disparity trees with hierarchical disparity prediction @cite Luo2015HDP.

A cv::StereoMatcher: a program that uses cv::StereoSGBM changes the line that creates it, see createLike().

@code{.cpp}
    Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 128);
    matcher->compute(left, right, disparity);
@endcode

**What goes in**: a rectified pair, both images of one size and type: CV_8UC1, CV_8UC3 (BGR), CV_8UC4 (BGR and alpha,
which is ignored), CV_16UC1 (a camera of 10 to 16 bits) or CV_32FC1 (any levels). They may have 1 x 1 to 32767 x 32767
pixels, and fewer columns than there are disparities. What is known of them beforehand goes in, too:
setMasks(), setDisparityRange(), setPriorDisparity().

**What comes out**: the disparity of every pixel of the left image. A pixel (x, y) of the left image shows the same
point as (x - disparity, y) of the right one. The map is CV_16SC1, times 16 (StereoMatcher::DISP_SCALE), or CV_32FC1 in
pixels, see Params::disparityDepth. A pixel without data, or that a filter rejects, gets minDisparity - 1. There is no
border of invalid pixels, as cv::StereoSGBM has it: candidates outside the right image are compared with its nearest
column. getConfidence() tells how reliable each disparity is, getFindings() what the matcher found out about the pair.

**What to set.** The parameters that matter, the most important first:
- minDisparity, numDisparities: the range of disparities in pixels, minDisparity to minDisparity + numDisparities - 1.
  minDisparity has any sign; a negative one adds as many columns on the left of the images, numDisparities at most,
  rounded up for the layers. numDisparities is > 0, and not necessarily a multiple of 16, or 0: both are found in the
  pair, see Findings::numDisparities, and the parameter minDisparity has no meaning. This takes time of its own, see
  BENCHMARK.md, and the range is about twice as large as necessary. Where setDisparityRange() limits all pixels, it is
  that of all of them, within the images' width. Otherwise a pair in which fewer than 10 corners have matches, as in
  images without texture, is an error. The frames of a video keep the range of the first one while it has all
  disparities that are found, and is not twice as large.
- the preset, see HDPTreeMatcher::Preset: what to spend on accuracy.
- Params::useTemporalPrediction: on for videos.
- Params::maxRowOffset, Params::useLightAlignment, Params::noiseThreshold: what is done about pairs that are not quite
  rectified, differently lit or noisy. On in all presets but PRESET_PAPER; turn them off for perfect pairs.
- Params::disparityDepth: the type of the map.

The filters are those of cv::StereoMatcher, and off by default:
- disp12MaxDiff: the maximal valid difference, in pixels, between the disparity of a pixel and the maximal one of those
  that match the same pixel of the right image. <= 0: no check.
- speckleWindowSize, speckleRange: the filter for speckles, see cv::filterSpeckles. The window size is a number of
  pixels, <= 0: no filter. speckleRange is in pixels, >= 0, and 1 at first; more than 2047 counts as 2047. 0 rejects
  nearly all, as disparities have fractions.
- blockSize: the same as Params::blockSize.

Params has everything else. @ref tutorial_hdpstereo_matching explains the algorithm, how to choose a preset, and what
each parameter does.

**Errors** are cv::Exception. A setter throws if a value is out of range, and leaves the matcher as it was. What depends
on several parameters or on the images is checked by compute(), before any work. compute() throws if
- an image is empty or of another type than those above, if they differ in size or type, are wider or higher than
  32767 pixels, or have 2^31 bytes and more, with the columns that a negative minDisparity adds;
- speckleWindowSize is > 0 and the images have more than 238609294 pixels;
- 16 times the disparities, and 16 times (minDisparity - 1), do not fit into CV_16S;
- scanlines, Params::fillOcclusions, Params::useTemporalPrediction or a prior are used with another cost than
  COST_CENSUS;
- Params::predictionModel has too few layers;
- numDisparities is 0, and the pair has too few corners to find the range: found by some work, before matching;
- the images are not those of the PairModel that is set;
- the output array is cv::noArray() or a std::vector, or has a fixed type other than CV_16SC1 and CV_32FC1, or another
  fixed size;
- a mask or a prior has not the size of the images, or the maps of setDisparityRange() are larger;
- a TreeStrategy throws, or does not leave a permutation of the edges. Only this is found while matching; the matcher
  stays usable, and the output array is unchanged.

The result depends neither on the number of threads nor on the instruction set. A matcher may be used by one thread at a
time; two matchers never share state. Its buffers are kept for the next pair. clear() forgets the frames of a video.

**Levels.** Parameters in intensity levels are for 8 bits. Of CV_16UC1, the upper 8 of the bits in use stand for them.
These are as few, 8 to 16, as are enough for all but one in 1024 pixels of the pair; what is brighter, such as
highlights and defective pixels, is white. So images of 8 bits times 2^k give the same map as without the
factor, unless they are dark: darker ones gain contrast; or have black borders that are not all 0, see setMasks().
With COST_CENSUS, a pair of low contrast, as by haze, a black level of the sensor or its exposure, is stretched by up
to 4, with all of its bits. Its darkest and brightest channels are then a sixth of their contrast away from black and
white; one pixel in 1024 is left out at each end, and so is what is black or white. After that, a dark pair is
brightened by a factor of 2 or 4, if not more than one pixel in 128 becomes white, and by less and less up to one in
16. Findings are about levels that are stretched, and not brightened.
CV_32FC1 is scaled to CV_16UC1, by one scale for both images: the darkest pixel that counts is black and the brightest
white, one in 1024 being left out at each end. Pixels that are not finite have no data, as if masked; a number that
stands for no data, such as -9999, has to be masked, see setMasks(). Findings are then about these levels.

**Files.** cv::Algorithm::save() and write() store all parameters, the prediction model, and the name of the tree
strategy with what its write() adds. read() takes the value of PRESET_PAPER for a parameter that the file does not have.
It throws if anything else is missing, of a wrong type or out of range, and leaves the matcher as it was. A file that
names a custom strategy can be read if a strategy of this name is set; it is kept. Files of version 1.0 can be read.
 */
class CV_EXPORTS_W HDPTreeMatcher : public cv::StereoMatcher
{
public:
    //! What to spend on accuracy: values of Params
    enum Preset
    {
        PRESET_PAPER = 0,     //!< the system behind the paper's tables, HDP+MST; see also Params::treeStrategy
        PRESET_FAST = 1,      //!< the default: scanlines, on the top layer over means of trees
        PRESET_ULTRAFAST = 2, //!< PRESET_FAST at half the resolution
        PRESET_QUALITY = 3,   //!< slower and more accurate than PRESET_FAST
        PRESET_TREE = 4       //!< PRESET_FAST with a finer top layer, from 61 disparities on
    };

    //! Cost aggregation, see Params::aggregation and Params::topAggregation
    enum Aggregation
    {
        AGGREGATION_TREES = 0,         //!< the paper's: sums over disparity trees
        AGGREGATION_SCANLINES = 1,     //!< semi-global matching over predicted candidates, or all on coarse layers
        AGGREGATION_TREE_SCANLINES = 2 //!< semi-global matching over the means of the costs in disparity trees, on
                                       //!< the top layer
    };

    //! Matching cost, see Params::matchingCost
    enum MatchingCost
    {
        COST_COLOR_GRADIENT = 0, //!< the paper's truncated difference of colours and gradients
        COST_CENSUS = 1          //!< number of pixels of a window that are darker than its centre in one image only
    };

    //! Source of the distribution P(D_l) of a layer's disparities, see Params::disparityPrior
    enum DisparityPrior
    {
        PRIOR_SUPPORT_POINTS = 0, //!< the paper's: sparse matches of the layer that pass a left-right check
        PRIOR_UPPER_LAYER = 1     //!< the disparities of the layer above
    };

    //! Why a pixel has its disparity, see getReasons()
    enum Reason
    {
        REASON_MATCHED = 0,  //!< the right image shows it
        REASON_OCCLUDED = 1, //!< something nearer hides it in the right image, or a mask does; it has what is beside
        REASON_OUTSIDE = 2,  //!< it is beyond an end of the right image, or of its row without masks; likewise
        REASON_MASKED = 3,   //!< it is masked, or its range has nothing in common with the matcher's
        REASON_UNSTABLE = 4, //!< rejected by the left-right check, see setDisp12MaxDiff()
        REASON_SPECKLE = 5,  //!< rejected by the filter for speckles, see setSpeckleWindowSize()
        REASON_RANGE = 6     //!< its range, see setDisparityRange(), is more than a pixel away from what was found
    };

    //! Value of Params::delta0, Params::beta and Params::disparityMedianSize: the matcher chooses
    enum
    {
        AUTO = -1
    };

    /** @brief How to match. A preset is a value of this.

    @code{.cpp}
        HDPTreeMatcher::Params params(HDPTreeMatcher::PRESET_QUALITY);
        params.finestLayer = 1;
        matcher->setParams(params);
    @endcode

    Values are checked by HDPTreeMatcher::setParams(). "All" and "others" are presets; sections are those of
    @cite Luo2015HDP. Intervals are used where trees are below the top layer: in PRESET_PAPER, and with
    HDPTreeMatcher::AGGREGATION_TREES in others.
     */
    struct CV_EXPORTS_W_SIMPLE Params
    {
        /** @brief The values of a preset.
        @param preset One of HDPTreeMatcher::Preset.
        @throws cv::Exception if there is no such preset.
         */
        CV_WRAP Params(int preset = HDPTreeMatcher::PRESET_FAST);

        //! @name Output and video
        //! @{

        /** @brief Type of the map that compute() returns: CV_16S, 16 times the disparity, or CV_32F, in pixels.

        The type of an output array of fixed type, such as cv::Mat_<float>, takes precedence. All: CV_16S. */
        CV_PROP_RW int disparityDepth;

        /** @brief Whether pairs are the frames of a video, and each is joined with the one before.

        The left images give the motion of the camera, if there is any. It takes the last map to this frame. Where the
        measured disparities agree with that, both are averaged; where they do not, the better match is taken. Maps have
        less noise and flicker less, and things that appear, move or vanish are followed. A pair that contradicts the
        last one is matched again, on its own.

        The result depends on the pairs before. A video begins with the first pair, after clear(), read() or a pair
        without temporal prediction, with another size, minDisparity, numDisparities or finestLayer, and where the left
        image shows another scene. A matcher is for one video; it keeps about 12 bytes per pixel more. Needs
        HDPTreeMatcher::COST_CENSUS. All: false. */
        CV_PROP_RW bool useTemporalPrediction;

        //! @}
        //! @name Alignment of the pair
        //! @{

        /** @brief Maximal difference of the rows of both images that is corrected before they are matched, in pixels.

        Rectified images have the same point in the same row. Temperature, a knock or a poor calibration change that,
        and half a row already costs accuracy. compute() matches some hundred corners, and moves the rows of the right
        image if these say that rows are off by more than 0.12 pixels (root of the mean square). >= 0, at the worst
        corner of the image; larger differences are not believed. 0: off. PAPER: 0, others: 64. */
        CV_PROP_RW int maxRowOffset;

        /** @brief Whether the right image gets the light of the left one before they are matched.

        Cameras differ in exposure, gamma and vignetting. If a model of these explains how the levels around matched
        corners differ, the right image is changed by it. Other lamps and reflections are not explained; such pairs are
        matched as they are. For HDPTreeMatcher::COST_CENSUS only. PAPER: false, others: true. */
        CV_PROP_RW bool useLightAlignment;

        /** @brief Noise above which both images are smoothed before they are matched, see Findings::noise.

        The noisier a pair is, the more it is smoothed; without noise, smoothing would cost details. The blocks of
        strong JPEG compression are smoothed, too. Standard deviation of the grey levels where matching ends, 255 being
        white, whatever the size of the images; of a pair that is dark or of low contrast, as it is matched. Finite,
        >= 0; 0: nothing is smoothed. PAPER: 0, others: 2. */
        CV_PROP_RW double noiseThreshold;

        //! @}
        //! @name Pyramid
        //! @{

        /** @brief Whether candidates are predicted from layer to layer, from coarse to fine (section 3).

        false: the plain tree algorithm over the full range, on the image itself. Layers, aggregation and all parameters
        of intervals are then without effect. All: true. */
        CV_PROP_RW bool usePrediction;

        /** @brief Number of pyramid layers, including the image (section 2.1, L + 1).

        Each has half the width, the height and the disparities of the one below. Layers without a pixel are left out.
        1..16. QUALITY and TREE: 2, others: 3. */
        CV_PROP_RW int numLayers;

        /** @brief Maximal number of disparities of the top layer, which searches all of them.

        Layers are added until the top one has no more, but with intervals no more layers than predictionModel is for;
        a third or later layer is not added if it would have fewer than 16 disparities. >= 0; 0: there are numLayers
        layers. PAPER: 0, TREE: 90, QUALITY: 55, others: 45. */
        CV_PROP_RW int maxTopDisparities;

        /** @brief Layer at which matching ends; its map is enlarged to the size of the image.

        0 (the image itself) to 15; the top layer if there are fewer. ULTRAFAST: 1, others: 0. */
        CV_PROP_RW int finestLayer;

        //! @}
        //! @name Matching cost
        //! @{

        /** @brief Matching cost (section 3.3), one of HDPTreeMatcher::MatchingCost.

        The census compares the pixels of a window with its centre, in grey. It hardly depends on the exposure of the
        images. PAPER: COST_COLOR_GRADIENT, others: COST_CENSUS. */
        CV_PROP_RW int matchingCost;

        /** @brief Side of the cost's square window in pixels, as cv::StereoMatcher::setBlockSize().

        An even one counts as the next larger one, and <= 0 as 5. COST_CENSUS takes the nearest of 3, 5 and 7; 3 is
        faster and less accurate. COST_COLOR_GRADIENT is averaged over the window, 1 (a pixel, as in the paper) to 31;
        larger values count as 31. PAPER: 1, others: 7. */
        CV_PROP_RW int blockSize;

        /** @brief Truncation \f$\tau_c\f$ of the colour difference in COST_COLOR_GRADIENT (section 3.3).

        \f[ M = \alpha \min(\overline{|I_c - I'_c|}, \tau_c) + (1 - \alpha) \min(|\nabla_x - \nabla'_x|, \tau_g) \f]
        The colour difference is a mean over the channels; gradients are those of grey levels. In intensity levels,
        finite, >= 0. All: 10, as in the authors' program. */
        CV_PROP_RW double colorTruncation;

        /** @brief Truncation \f$\tau_g\f$ of the difference of gradients, see colorTruncation.

        In intensity levels per pixel, finite, >= 0. All: 2, as in the authors' program. */
        CV_PROP_RW double gradientTruncation;

        /** @brief Weight \f$\alpha\f$ of the colour difference against the gradient, see colorTruncation.

        In [0, 1]. All: 0.11, as in the authors' program. */
        CV_PROP_RW double colorWeight;

        //! @}
        //! @name Aggregation over trees
        //! @{

        /** @brief Cost aggregation of the layers below the top one, one of HDPTreeMatcher::Aggregation.

        AGGREGATION_TREES is that of section 3. AGGREGATION_SCANLINES runs scanlines @cite Hirschmuller2008SGM over 16
        candidates per pixel around the disparity of the layer above, or over all of them on layers between the top and
        the finest one that have few; it needs COST_CENSUS. AGGREGATION_TREE_SCANLINES, which files of earlier versions
        have, is AGGREGATION_SCANLINES with this as topAggregation, whatever that is. PAPER: AGGREGATION_TREES, others:
        AGGREGATION_SCANLINES. */
        CV_PROP_RW int aggregation;

        /** @brief Cost aggregation of the top layer, one of HDPTreeMatcher::Aggregation.

        All disparities are candidates there. AGGREGATION_TREE_SCANLINES runs scanlines over weighted means of the costs
        in each pixel's tree: trees carry faint texture to where there is none, scanlines follow slanted surfaces. With
        AGGREGATION_SCANLINES costs are taken as they are, without trees. Without effect unless aggregation is
        AGGREGATION_SCANLINES. PAPER: AGGREGATION_TREES, others: AGGREGATION_TREE_SCANLINES. */
        CV_PROP_RW int topAggregation;

        /** @brief Rule 1 and Rule 2 of the spanning trees (section 3.2); not empty.

        The paper's systems are HDP+MST, HDP+ST and HDP+RT with usePrediction, MST, ST and RT without it, and M+MST,
        M+ST and M+RT without it and with useMedianPrefilter. PAPER: createMinimumSpanningTree(), others:
        createSegmentTree(). */
        CV_PROP_RW Ptr<TreeStrategy> treeStrategy;

        /** @brief \f$\gamma\f$ of the similarity \f$\exp(-W(p, q) / \gamma)\f$ of two pixels (section 3.3).

        W is the sum of the edge weights between them in their tree. In intensity levels, finite, > 0; the larger, the
        farther costs reach. PAPER: 25.5, as in the authors' program, others: 20. */
        CV_PROP_RW double gamma;

        /** @brief Whether edge weights come from a 3 x 3 median of the image, as in the M+ systems (section 4.1).

        The matching cost always uses the image itself. All: false. */
        CV_PROP_RW bool useMedianPrefilter;

        //! @}
        //! @name Predicted intervals of trees
        //! @{

        /** @brief Model behind the predicted intervals (section 2.2), of at least one layer less than the pyramid.

        Empty: the published model, DisparityPredictionModel::PUBLISHED_LARGE (for up to 4 layers) if the image is at
        least 1000 pixels wide, otherwise PUBLISHED_SMALL (for up to 3). All: empty. */
        CV_PROP_RW Ptr<DisparityPredictionModel> predictionModel;

        /** @brief Source of P(D_l) (section 3.1), one of HDPTreeMatcher::DisparityPrior.

        The support points of @cite Geiger2010ELAS take time and miss the disparities of textureless surfaces; the upper
        layer costs nothing, and is what counts with setDisparityRange(). TREE: PRIOR_UPPER_LAYER, others:
        PRIOR_SUPPORT_POINTS. */
        CV_PROP_RW int disparityPrior;

        /** @brief Threshold \f$\delta_0\f$ that ends the growth of a predicted interval (section 3.1).

        A candidate of probability P joins an interval of total probability c while \f$P / (c + P) > \delta_l\f$, where
        \f$\delta_l = 2^l \delta_0\f$ in layer l. In [0, 1); the smaller, the wider the intervals. HDPTreeMatcher::AUTO:
        0.064 if the image is at least 1000 pixels wide, otherwise 0.004, as in the authors' program; the paper's text
        has them the other way round. TREE: 0.02, others: AUTO. */
        CV_PROP_RW double delta0;

        /** @brief Threshold \f$\beta\f$ of DT-Rule 2 (section 3.2).

        Two trees are joined if their intervals overlap by at least this share of the hull of both. In [0, 1]; the
        larger, the more and the smaller the trees. HDPTreeMatcher::AUTO: 0.6 if the image is at least 1000 pixels wide,
        otherwise 0.95, as in the authors' program; the paper's text has them the other way round. TREE: 0.9, others:
        AUTO. */
        CV_PROP_RW double beta;

        /** @brief Number of candidates added on both sides of each predicted interval.

        0..64. TREE: 2, because the fraction of a winner needs neighbours, others: 0. */
        CV_PROP_RW int intervalMargin;

        //! @}
        //! @name Scanlines
        //! @{

        /** @brief Penalty for a step of one disparity between neighbours on a scanline.

        In bits of the census, which is not the unit of cv::StereoSGBM, 0..100. All: 16. Below the top layer, where only
        disparities around those of the layer above are candidates, both penalties are multiplied by 0.4 to 1.8 (0.75 to
        1.25 on layers that only predict): more where the layer above matches badly, less where it has many steps. */
        CV_PROP_RW int P1;

        /** @brief Penalty for a larger step between neighbours of one colour on a scanline.

        Other neighbours have a lower one, not less than P1, as surfaces end where the image has an edge. In bits of the
        census, 0..100. All: 65. */
        CV_PROP_RW int P2;

        /** @brief Number of passes of scanlines over the finest layer; coarser ones have one.

        The first pass searches around the disparities of the layer above, each other one around those of the pass
        before. 1..4. QUALITY: 2, others: 1. */
        CV_PROP_RW int scanlinePasses;

        //! @}
        //! @name Filters of disparities
        //! @{

        /** @brief Whether disparities have fractions, in 1/16 pixel.

        false: whole disparities; scanlines round the final map only. PAPER: false, others: true. */
        CV_PROP_RW bool useSubpixel;

        /** @brief Side of the median filter over each layer's disparities, in pixels of the layer.

        0 (none), 3, 5, 7, or HDPTreeMatcher::AUTO: 7 with prediction and 5 without, as in the authors' program; the
        paper has no such filter. 0 leaves out the other filters of the finest layer, too. PAPER: AUTO, QUALITY: 7,
        others: 5. */
        CV_PROP_RW int disparityMedianSize;

        /** @brief Whether occluded pixels are filled, in each layer.

        They get the disparity of the farther surface beside them; at the left border they continue the surface. Needs
        COST_CENSUS. PAPER: false, others: true. */
        CV_PROP_RW bool fillOcclusions;

        /** @brief Whether disparities are refined over trees @cite Yang2012MST , in each layer, before the median.

        Each pixel gets a weighted median of the stable disparities of its tree. For AGGREGATION_TREES only. All: false.
        */
        CV_PROP_RW bool useNonLocalRefinement;

        //! @}

        /** @brief Reads what write(), or that of a matcher, has stored.

        A field that is missing gets the value of PRESET_PAPER.
        @throws cv::Exception if a value is not valid; the fields are unchanged.
         */
        void read(const FileNode& fn);

        //! Stores all fields by name.
        void write(FileStorage& fs) const;
    };

    /** @brief What the last compute() found out about the pair.

    Before the first compute() and after one that threw an exception, nothing is found: vectors are empty, but for those
    of the models, which are as for a perfect pair.
     */
    struct CV_EXPORTS_W_SIMPLE Findings
    {
        /** @brief How the rows of the right image lay against those of the left one: \f$m_0, \ldots, m_4\f$.

        A point of the right image that is u pixels right of its centre and v below it was
        \f$m_0 + m_1 u + m_2 v + m_3 u v + m_4 v^2\f$ pixels below its row, as small rotations of a camera and another
        focal length make it. @ref tutorial_hdpstereo_matching tells how to correct a calibration by them. Zeros if too
        few corners were matched, rowError being 0 then, or if a row is off by more than Params::maxRowOffset. */
        CV_PROP std::vector<double> rows;

        //! Whether the rows of the right image were moved before matching.
        CV_PROP bool areRowsMoved;

        /** @brief Standard deviation of matched corners from their rows, in pixels, beside what a model of rows tells.

        Corners are matched along and across rows; across, it is known where they belong. About 0.1 in pairs that are
        sharp and well calibrated, 0.2 in KITTI. HDPTreeMatcher::getDisparitySigma() rises with it. 0 if too few corners
        were matched, or if the parameters of the alignment are all 0. */
        CV_PROP double rowError;

        /** @brief How the light of the right image differed from that of the left one: \f$m_0, \ldots, m_9\f$.

        With levels from 0, the pair's black, to 1, white, a level r of the right image at (x, y) is \f$r (m_0 + m_1 x +
        m_2 y + m_3 x^2 + m_4 x y + m_5 y^2 + m_6 (x^2 + y^2)^2) + m_7 + m_8 r^2 + m_9 r^3\f$ in the left one. x and y
        are from the centre, in units of width and height, of the image as it is matched, see PairModel: that of column
        u is x = (u + 1/2 + minDisparity + PairModel::addedColumns) / (width + PairModel::addedColumns) - 1/2. 1 and
        zeros if too few corners were matched or Params::useLightAlignment is false. */
        CV_PROP std::vector<double> light;

        //! Whether the light of the right image was changed before matching.
        CV_PROP bool isLightChanged;

        /** @brief Noise: the standard deviation of what differs between matched corners, in grey levels of 0 to 255.

        It is that of the layer at which matching ends, see Params::finestLayer, and what Params::noiseThreshold is
        compared with. Texture that is finer than pixels counts as noise, too; single defective pixels do not. 0 if too
        few corners were matched, or if the parameters of the alignment are all 0. */
        CV_PROP double noise;

        /** @brief First disparity of the range that was searched, in pixels.

        That of the parameter minDisparity, or what was found, see numDisparities. */
        CV_PROP int minDisparity;

        /** @brief Number of disparities of the range that was searched.

        That of the parameter, if it is > 0. If it is 0, both this and minDisparity are those of the PairModel that is
        set, or of setDisparityRange(), or found in the pair; what has no data or is rejected has this minDisparity - 1.
        */
        CV_PROP int numDisparities;

        /** @brief Share of the disparity range that each layer searched, the image first: \f$R_l\f$ of the paper's
        Table 1, in [0, 1]. 0 for one finer than Params::finestLayer. */
        CV_PROP std::vector<double> searchRatios;

        //! Names of the stages of compute(), in the order in which they first ran.
        CV_PROP std::vector<String> stages;

        //! Wall time of each stage in milliseconds, summed over the layers.
        CV_PROP std::vector<double> stageTimes;
    };

    /** @brief Sets how to match.
    @param params Copied, but for the tree strategy and the model, which are kept by pointer.
    @throws cv::Exception if a value is out of range; the matcher is unchanged.
     */
    CV_WRAP virtual void setParams(const HDPTreeMatcher::Params& params) = 0;

    //! Returns how to match.
    CV_WRAP virtual HDPTreeMatcher::Params getParams() const = 0;

    /** @brief Sets Params::disparityDepth.
    @param depth CV_16S or CV_32F. */
    CV_WRAP virtual void setDisparityDepth(int depth) = 0;
    /** @brief Returns Params::disparityDepth. */
    CV_WRAP virtual int getDisparityDepth() const = 0;

    /** @brief Sets Params::useTemporalPrediction.
    @param useTemporalPrediction Whether the next pairs are the frames of a video. */
    CV_WRAP virtual void setUseTemporalPrediction(bool useTemporalPrediction) = 0;
    /** @brief Returns Params::useTemporalPrediction. */
    CV_WRAP virtual bool getUseTemporalPrediction() const = 0;

    /** @brief Sets Params::maxRowOffset.
    @param maxRowOffset In pixels, >= 0; 0: off. */
    CV_WRAP virtual void setMaxRowOffset(int maxRowOffset) = 0;
    /** @brief Returns Params::maxRowOffset. */
    CV_WRAP virtual int getMaxRowOffset() const = 0;

    /** @brief Sets Params::useLightAlignment.
    @param useLightAlignment Whether the right image gets the light of the left one. */
    CV_WRAP virtual void setUseLightAlignment(bool useLightAlignment) = 0;
    /** @brief Returns Params::useLightAlignment. */
    CV_WRAP virtual bool getUseLightAlignment() const = 0;

    /** @brief Sets Params::noiseThreshold.
    @param noiseThreshold In grey levels, finite, >= 0; 0: off. */
    CV_WRAP virtual void setNoiseThreshold(double noiseThreshold) = 0;
    /** @brief Returns Params::noiseThreshold. */
    CV_WRAP virtual double getNoiseThreshold() const = 0;

    /** @brief Sets Params::treeStrategy.
    @param strategy Not empty; the matcher keeps the pointer. */
    CV_WRAP virtual void setTreeStrategy(const Ptr<TreeStrategy>& strategy) = 0;
    /** @brief Returns Params::treeStrategy. */
    CV_WRAP virtual Ptr<TreeStrategy> getTreeStrategy() const = 0;

    /** @brief Tells which pixels have no data: the robot's own body, what rectification leaves black, clouds.

    They get minDisparity - 1, the confidence 0, and have no influence: their levels may be any, and neither the other
    disparities nor the findings change. What only one of the images shows continues the surface beside it. The masks
    stay until others are set. They are no parameters: files do not have them.

    Without masks, black borders of images of whole numbers, as rectification leaves them, are no data either: what is
    black along a quarter of a side or more, if it ends at once, along a smooth line, and is more than a hundredth and
    less than half of an image. Black is up to 2 of 8 bits, and 0 of 16. Masks of which no pixel is 0 let it be matched.
    @param leftMask CV_8UC1 of the images' size, 0 where the left image has no data; copied. Empty: it has everywhere.
    @param rightMask The same of the right image.
    @throws cv::Exception if a mask is of another type; both are unchanged.
     */
    CV_WRAP virtual void setMasks(InputArray leftMask, InputArray rightMask) = 0;

    /** @brief Tells which disparities each pixel of the left image may have: a coarse product, the depth of a room.

    No others occur in the map. A pixel for which there are none between minDisparity and the last one, or no multiple
    of 1 / 16 in its range, or no whole one without Params::useSubpixel, gets minDisparity - 1. Coarse layers search
    the ranges alone, fine ones around them; what is found outside of a range moves to its end. The maps stay until
    others are set. They are no parameters: files do not have them.
    @param smallest CV_16SC1 or CV_32FC1, in pixels, of the images' size or coarser: each pixel then has the range of
    the nearest one. Below 2048, as disparities of CV_16S are. NaN limits nothing. Copied. Both empty: there are no
    ranges.
    @param largest Of the same size and type; nowhere less than smallest or than -2048. If only one of the two is
    empty, it limits nothing.
    @throws cv::Exception if the maps are not that; both are unchanged.
     */
    CV_WRAP virtual void setDisparityRange(InputArray smallest, InputArray largest) = 0;

    /** @brief Tells disparities that are about known: of a lidar, of structure from motion, of the last survey.

    They are believed as far as the images do not contradict them. A point that disagrees with the images counts only if
    neighbouring points support it, and if the matching costs do not clearly contradict it or them. Where most of the
    points around disagree with the images, none of them counts. Needs HDPTreeMatcher::COST_CENSUS. The prior stays
    until another one is set. It is no parameter: files do not have it.
    @param disparity CV_32FC1 in pixels, of the images' size, NaN where nothing is known: nearly everywhere, perhaps.
    Copied. Empty: there is no prior.
    @param sigma Standard deviation of the disparities in pixels, finite, >= 0: a number, or CV_32FC1 of the same size.
    @throws cv::Exception if the arguments are not that; the prior is unchanged.
     */
    CV_WRAP virtual void setPriorDisparity(InputArray disparity, InputArray sigma) = 0;

    /** @brief Returns how reliable each disparity of the last compute() is.

    It is computed by this call; compute() does not take longer. It grows with the distance to the nearest step of the
    disparities and with how much the costs beside the winner stand out from its own. It falls with what the median
    changed, with the difference from the layer above, and where a pixel is not visible in the right image. In a video
    it falls where fewer frames have had the disparity than elsewhere.

    It is no probability: it serves to sort or weight pixels, or to reject those below a threshold. 160 is a high
    value, 200 is hardly ever reached, and the median of a map is usually between 50 and 100. As a threshold, 20
    leaves out about half of the pixels that are wrong by more than one, and a tenth of the right ones; 60 three
    quarters or more of the wrong ones, and a quarter to a half of the right ones. On KITTI, where errors of one pixel
    are common, these are a sixth (ULTRAFAST) to two fifths, and half to three quarters. BENCHMARK.md has the shares.
    How wrong a disparity is, in pixels, getDisparitySigma() tells.
    @param confidence Receives CV_8UC1 of the left image's size: from 0 to 255, larger is more reliable; 0 where a
    pixel has no data, a filter rejected it or its reason is REASON_RANGE. Empty before the first compute() and after
    one that threw an exception.
     */
    CV_WRAP virtual void getConfidence(OutputArray confidence) const = 0;

    /** @brief Returns the standard deviation of each disparity's error in the last compute().

    50 to 80 % of the errors of a map are not larger, depending on the scenes: it is calibrated on pairs of known truth,
    some of which is not more exact itself. It comes from getConfidence(), from how much matched levels differ for the
    texture there is, from Findings::rowError, and from Findings::noise. A disparity that was moved into the range of
    its pixel, see setDisparityRange(), has as much more as it was moved by.
    Of the disparities that are wrong by more than 3 pixels, 40 to 90 % have one above 1, which does not say by how much
    they are wrong. It is computed by this call.
    @param sigma Receives CV_32FC1 of the left image's size, in pixels; infinite where a pixel has no data or a filter
    rejected it. Empty before the first compute() and after one that threw an exception.
     */
    CV_WRAP virtual void getDisparitySigma(OutputArray sigma) const = 0;

    /** @brief Returns why each pixel has its disparity in the last compute().

    REASON_OCCLUDED is what the left-right check finds in the map, within a pixel of the layer at which matching ends,
    whether a filter rejects it or not, and what matches masked pixels; half a pixel may be rounded otherwise than by
    disp12MaxDiff. REASON_OUTSIDE has nothing in the right image to be compared with, so disp12MaxDiff does not reject
    it, but for single pixels at the border. It is computed by this call.
    @param reasons Receives CV_8UC1 of the left image's size: values of HDPTreeMatcher::Reason, or empty as the sigma.
     */
    CV_WRAP virtual void getReasons(OutputArray reasons) const = 0;

    /** @brief Sets what is known of the next pairs: nothing is estimated from them then.

    What the model says is done, whatever Params::maxRowOffset and Params::useLightAlignment are; Params::noiseThreshold
    is compared with its noise. HDPTreeMatcher::Findings are then those of the model, which are about its whole images.
    The disparity range is taken from it if numDisparities is 0. save() does not store it, and clear() does not forget
    it.
    @param model That of an earlier pair, or of a tile of it. An empty one: pairs are estimated again.
    @throws cv::Exception if a value is not valid; the matcher is unchanged.
     */
    CV_WRAP virtual void setPairModel(const PairModel& model) = 0;

    //! Returns what the last pair was matched with: estimated, or as it was set. Empty before the first compute() and
    //! after one that threw an exception.
    CV_WRAP virtual PairModel getPairModel() const = 0;

    //! Returns what the last compute() found out about the pair.
    CV_WRAP virtual HDPTreeMatcher::Findings getFindings() const = 0;

    /** @brief Returns the disparity forest of the last compute() (section 3.2), at the finest layer that has one.

    With PRESET_PAPER that is the finest layer of all, with others the top layer, whose trees search the full range.
    Either may be cv::noArray().
    @param trees Receives the number of each pixel's tree, from 0: CV_32SC1 of the layer's size. Empty before the first
    compute(), after one that threw an exception, and without trees, see Params::topAggregation.
    @param intervals Receives the first and the last candidate of each pixel's tree, TreeIntv, counted from
    minDisparity: CV_16UC2 of the same size, in pixels of the layer; in halves of them on a top layer of scanlines that
    is not the finest one.
     */
    CV_WRAP virtual void getForest(OutputArray trees, OutputArray intervals) const = 0;

    /** @brief Returns the \f$P(D_l)\f$ that predicted a layer's intervals in the last compute() (section 3.1).
    @param layer l >= 0, 0 being the image.
    @param prior Receives a number >= 0 per candidate of the layer, from its first disparity on, up to a factor. Empty
    if nothing was predicted there, as in the top layer, and in layers of scanlines.
     */
    CV_WRAP virtual void getLayerPrior(int layer, CV_OUT std::vector<double>& prior) const = 0;

    /** @brief Returns the disparities \f$D_l\f$ of a layer in the last compute(), as the layer below uses them.

    This is after the median, and before disp12MaxDiff and the speckle filter reject pixels.
    @param layer l >= 0, 0 being the image.
    @param disparity Receives CV_32FC1 of the layer's size, in pixels of the layer, counted from minDisparity. Empty if
    there is no such layer, for layers finer than Params::finestLayer, before the first compute() and after one that
    threw an exception.
     */
    CV_WRAP virtual void getLayerDisparity(int layer, OutputArray disparity) const = 0;

    /** @brief Creates a matcher.
    @param minDisparity First disparity in pixels, of any sign.
    @param numDisparities Number of candidates, >= 0; 0: both are found in each pair.
    @param preset One of HDPTreeMatcher::PRESET_FAST, PRESET_ULTRAFAST, PRESET_QUALITY, PRESET_TREE and PRESET_PAPER.
    Not the blockSize, which is the third argument of cv::StereoSGBM::create().
    @throws cv::Exception if numDisparities or preset is out of range.
     */
    CV_WRAP static Ptr<HDPTreeMatcher> create(int minDisparity = 0, int numDisparities = 64,
                                              int preset = HDPTreeMatcher::PRESET_FAST);

    /** @brief Creates a matcher that takes the place of a cv::StereoSGBM.

    minDisparity, numDisparities, disp12MaxDiff, speckleWindowSize and speckleRange are taken over as they are now; a
    negative speckleRange becomes 0. A disp12MaxDiff of 0 or less checks nothing here, where cv::StereoSGBM
    takes it for 1. What else a cv::StereoSGBM has is of its own algorithm, and is not taken over: blockSize, as a block
    is no window of a census; P1 and P2, which are in units of another cost (see Params::P1); mode; preFilterCap; and
    uniquenessRatio, as nothing here compares the best with the second best cost. getConfidence() serves to reject what
    is not reliable.
    @param sgbm Not empty. It is read, and not kept.
    @param preset See create().
    @throws cv::Exception if numDisparities or preset is out of range.
     */
    CV_WRAP static Ptr<HDPTreeMatcher> createLike(const Ptr<StereoSGBM>& sgbm,
                                                  int preset = HDPTreeMatcher::PRESET_FAST);
};

//! @}

}} // namespace cv::stereo

#endif
