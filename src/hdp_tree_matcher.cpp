// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"

#include "map/disparity_confidence.hpp"
#include "map/disparity_output.hpp"
#include "base/disparity_units.hpp"
#include "pair/image_pyramid.hpp"
#include "layer_matching.hpp"
#include "plan/matcher_parameters.hpp"
#include "pair/pair_alignment.hpp"
#include "pair/pair_pyramids.hpp"
#include "base/stage_clock.hpp"

namespace cv { namespace stereo {

using namespace hdp;

namespace {

const char* const nameInFiles = "StereoMatcher.HDPTree"; // as OpenCV's StereoMatcher.SGBM

//! The setter and the getter of a parameter
#define HDP_PARAMETER(type, Name, member)                                                                              \
    void set##Name(type value) CV_OVERRIDE                                                                             \
    {                                                                                                                  \
        MatcherParameters changed = p_;                                                                                \
        changed.member = value;                                                                                        \
        change(changed);                                                                                               \
    }                                                                                                                  \
    type get##Name() const CV_OVERRIDE { return p_.member; }

class HDPTreeMatcherImpl CV_FINAL : public HDPTreeMatcher
{
public:
    explicit HDPTreeMatcherImpl(const MatcherParameters& parameters) : p_(parameters) {}

    void compute(InputArray leftArray, InputArray rightArray, OutputArray disparityArray) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        result_ = Result(); // until this pair is matched
        const Mat left = leftArray.getMat(), right = rightArray.getMat();
        checkPair(left, right);
        const int depth = outputDepth(disparityArray);
        const PairSettings settings = resolve(p_, left);
        clock_.restart();

        if (!matchPair(left, right, settings))
        {
            temporal_.clear();
            matchPair(left, right, settings);
        }

        disparityArray.create(left.size(), depth);
        Mat disparity = disparityArray.getMat();
        clock_.run("output", [&] {
            const Mat& finest = layers_[settings.finestLayer].disparity;
            result_.isFiltered = outputDisparity(finest, p_, settings, output_, disparity);
        });
        result_.shift = 0.5 * settings.extension + p_.minDisparity;
        result_.brightness = 1 << pyramids_.brightening;
        result_.size = left.size();
        result_.settings = settings;
        result_.numDisparities = p_.numDisparities;
    }

    // cv::StereoMatcher
    HDP_PARAMETER(int, MinDisparity, minDisparity)
    HDP_PARAMETER(int, NumDisparities, numDisparities)
    HDP_PARAMETER(int, BlockSize, blockSize)
    HDP_PARAMETER(int, SpeckleWindowSize, speckleWindowSize)
    HDP_PARAMETER(int, SpeckleRange, speckleRange)
    HDP_PARAMETER(int, Disp12MaxDiff, disp12MaxDiff)

    // HDPTreeMatcher
    void setParams(const Params& params) CV_OVERRIDE
    {
        MatcherParameters changed = p_;
        static_cast<Params&>(changed) = params;
        change(changed);
    }
    Params getParams() const CV_OVERRIDE { return p_; }
    HDP_PARAMETER(int, DisparityDepth, disparityDepth)
    HDP_PARAMETER(bool, UseTemporalPrediction, useTemporalPrediction)
    HDP_PARAMETER(int, MaxRowOffset, maxRowOffset)
    HDP_PARAMETER(bool, UseLightAlignment, useLightAlignment)
    HDP_PARAMETER(double, NoiseThreshold, noiseThreshold)
    Ptr<TreeStrategy> getTreeStrategy() const CV_OVERRIDE { return p_.treeStrategy; }
    void setTreeStrategy(const Ptr<TreeStrategy>& strategy) CV_OVERRIDE
    {
        MatcherParameters changed = p_;
        changed.treeStrategy = strategy;
        change(changed);
    }

    Findings getFindings() const CV_OVERRIDE
    {
        const Result r = isMatched() ? result_ : Result();
        const RowModel rows = r.alignment.rows.about(r.shift);
        const LightModel light = r.alignment.light.scaled(1 / r.brightness);
        Findings findings;
        findings.rows.assign(rows.coefficients.val, rows.coefficients.val + RowModel::terms);
        findings.areRowsMoved = r.alignment.hasRows;
        findings.light.assign(light.coefficients.val, light.coefficients.val + LightModel::terms);
        findings.isLightChanged = r.alignment.hasLight;
        findings.noise = r.alignment.noise.deviation / r.brightness;
        findings.searchRatios.assign(r.settings.layers, 0);
        for (int layer = r.settings.finestLayer; layer < r.settings.layers; ++layer)
            findings.searchRatios[layer] = layers_[layer].searchRatio;
        if (isMatched())
        {
            findings.stages = clock_.stages;
            findings.stageTimes = clock_.milliseconds;
        }
        return findings;
    }

    void getForest(OutputArray treesArray, OutputArray intervalsArray) const CV_OVERRIDE
    {
        const DisparityForest& forest = buffers_.forest;
        const Size size = isMatched() ? forest.links.size() : Size();
        Mat trees(size, CV_32S), intervals(size, CV_16UC2);
        TreeWalk walk;
        for (size_t t = 0; isMatched() && t < forest.trees.size(); ++t)
        {
            const DisparityTree& tree = forest.trees[t];
            walkTree(forest, tree, walk);
            for (int i = 0; i < tree.size; ++i)
            {
                trees.ptr<int>()[walk.pixels[i]] = (int)t;
                intervals.ptr<DisparityInterval>()[walk.pixels[i]] = tree.interval;
            }
        }
        copyLayer(trees, buffers_.forestLayer, treesArray);
        copyLayer(intervals, buffers_.forestLayer, intervalsArray);
    }

    void getLayerPrior(int layer, std::vector<double>& prior) const CV_OVERRIDE
    {
        prior = hasLayer(layer) ? layers_[layer].prior : std::vector<double>();
    }

    void getLayerDisparity(int layer, OutputArray disparityArray) const CV_OVERRIDE
    {
        Mat disparity;
        if (hasLayer(layer))
            layers_[layer].disparity.convertTo(disparity, CV_32F, 1. / subpixelScale);
        copyLayer(disparity, layer, disparityArray);
    }

    void getConfidence(OutputArray confidenceArray) const CV_OVERRIDE
    {
        if (!isMatched())
            return confidenceArray.release();
        confidenceArray.create(result_.size, CV_8U);
        Mat confidence = confidenceArray.getMat();
        const PairSettings& settings = result_.settings;
        const MatchedLayer& finest = layers_[settings.finestLayer];
        const bool hasUpper = hasLayer(settings.finestLayer + 1);
        const ConfidenceMaps maps = { finest.disparity, finest.unfiltered,
                                      hasUpper ? layers_[settings.finestLayer + 1].disparity : Mat() };
        Mat ofLayer, extended;
        const int disparities = layerDisparities(result_.numDisparities, settings.finestLayer, settings.subpixel);
        if (finest.isCensus)
            disparityConfidence(maps, disparities, finest.census, ofLayer);
        else
            disparityConfidence(maps, disparities, finest.colorGradient, ofLayer);
        if (settings.finestLayer > 0)
            resize(ofLayer, extended, result_.size + Size(settings.extension, 0), 0, 0, INTER_LINEAR_EXACT);
        else
            extended = ofLayer;
        extended.colRange(settings.extension, extended.cols).copyTo(confidence);
        if (result_.isFiltered)
            confidence.setTo(Scalar(0), output_.rejected);
    }

    // cv::Algorithm
    void clear() CV_OVERRIDE { temporal_.clear(); }

    //! The key that save() gives the matcher: XML has no dots in it.
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_HDPTreeMatcher"; }

    void write(FileStorage& fs) const CV_OVERRIDE
    {
        fs << "name" << nameInFiles;
        writeParameters(p_, fs);
    }

    void read(const FileNode& fn) CV_OVERRIDE
    {
        const String name = fn.isMap() && fn["name"].isString() ? (String)fn["name"] : String();
        if (name != nameInFiles && name != getDefaultName()) // which is that of version 1.0
            CV_Error(Error::StsParseError, String("name must be ") + nameInFiles);
        p_ = readParameters(fn, p_.treeStrategy);
        temporal_.clear();
    }

private:
    //! The last pair
    struct Result
    {
        Size size; // of the image; empty: no pair is matched
        PairSettings settings;
        int numDisparities = 0;
        PairAlignment alignment;
        double brightness = 1;   // of the levels that were matched, relative to those of the images
        double shift = 0;        // of the centre of the right image
        bool isFiltered = false; // OutputBuffers::rejected has a meaning
    };

    //! To values that are valid, or not at all
    void change(const MatcherParameters& parameters)
    {
        checkParameters(parameters);
        p_ = parameters;
    }

    bool isMatched() const { return !result_.size.empty(); }

    //! Whether the last compute() matched this layer
    bool hasLayer(int layer) const
    {
        if (layer < 0)
            CV_Error(Error::StsOutOfRange, format("layer must be >= 0, not %d", layer));
        return isMatched() && layer >= result_.settings.finestLayer && layer < result_.settings.layers;
    }

    //! From the images to the disparities of the finest layer. Returns false if the pair was matched as the next one of a
    //! video, but contradicts most of what the last one predicts.
    bool matchPair(const Mat& left, const Mat& right, const PairSettings& settings)
    {
        std::vector<LayerImages> images;
        clock_.run("image pyramid", [&] {
            const PyramidSettings pyramid = { p_.minDisparity,       settings.extension,
                                              settings.layers,       p_.matchingCost == COST_CENSUS,
                                              p_.noiseThreshold > 0, lastBrightening() };
            buildPairPyramids(left, right, pyramid, pyramids_, images);
        });

        if (p_.maxRowOffset > 0 || p_.useLightAlignment || p_.noiseThreshold > 0)
            clock_.run("alignment", [&] {
                const AlignmentSearch search = { p_.numDisparities, p_.maxRowOffset, p_.useLightAlignment,
                                                 p_.noiseThreshold, settings.finestLayer };
                alignPair(search, alignmentBuffers_, images, result_.alignment);
            });

        if (p_.useTemporalPrediction)
            clock_.run("temporal prediction", [&] { follow(images[settings.finestLayer].left, settings.finestLayer); });
        else
            temporal_ = TemporalState();
        const int age = temporal_.age;
        if (age == 0 && pyramids_.isDimmed)
            return false; // not the next frame after all

        layers_.resize(settings.layers);
        for (int layer = settings.layers - 1; layer >= settings.finestLayer; --layer)
        {
            const MatchedLayer* const upper = layer + 1 < settings.layers ? &layers_[layer + 1] : nullptr;
            TemporalState* const temporal = p_.useTemporalPrediction ? &temporal_ : nullptr;
            const LayerInput input = { layer, images[layer], upper, p_, settings, result_.alignment, temporal };
            matchLayer(input, buffers_, clock_, layers_[layer]);
        }
        return temporal_.age == age;
    }

    int lastBrightening() const
    {
        return p_.useTemporalPrediction && !temporal_.last.disparity.empty() ? temporal_.layer.brightening
                                                                             : noBrightening;
    }

    //! What a frame has to do with the one before
    void follow(const Mat& left, int finestLayer)
    {
        const int scale = 1 << finestLayer;
        const TemporalLayer layer = { scale, p_.minDisparity / (double)scale,
                                      largestDisparity(p_.numDisparities, finestLayer), pyramids_.brightening };
        followVideo(left, layer, temporal_);
        if (temporal_.age > 0)
            findSources(temporal_);
    }

    //! Without the columns that are added to the images
    void copyLayer(const Mat& ofLayer, int layer, OutputArray array) const
    {
        if (!array.needed())
            return;
        if (ofLayer.empty())
            return array.release();
        ofLayer.colRange(result_.settings.extension >> layer, ofLayer.cols).copyTo(array);
    }

    //! Of the disparities: what the caller's array has, if its type is fixed
    int outputDepth(OutputArray disparity) const
    {
        const int type = disparity.fixedType() ? disparity.type() : p_.disparityDepth;
        if (type != CV_16SC1 && type != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "disparity must be CV_16SC1 or CV_32FC1 if its type is fixed");
        return type;
    }

    MatcherParameters p_;
    Result result_;
    StageClock clock_;

    // Buffers that are kept between calls
    PairPyramids pyramids_;
    AlignmentBuffers alignmentBuffers_;
    std::vector<MatchedLayer> layers_;
    LayerBuffers buffers_;
    OutputBuffers output_;
    TemporalState temporal_;
};

} // namespace

Ptr<HDPTreeMatcher> HDPTreeMatcher::create(int minDisparity, int numDisparities, int preset)
{
    MatcherParameters parameters(preset);
    parameters.minDisparity = minDisparity;
    parameters.numDisparities = numDisparities;
    checkParameters(parameters);
    return makePtr<HDPTreeMatcherImpl>(parameters);
}

Ptr<HDPTreeMatcher> HDPTreeMatcher::createLike(const Ptr<StereoSGBM>& sgbm, int preset)
{
    if (!sgbm)
        CV_Error(Error::StsNullPtr, "sgbm must not be empty");
    const Ptr<HDPTreeMatcher> matcher = create(sgbm->getMinDisparity(), sgbm->getNumDisparities(), preset);
    matcher->setDisp12MaxDiff(sgbm->getDisp12MaxDiff());
    matcher->setSpeckleWindowSize(sgbm->getSpeckleWindowSize());
    matcher->setSpeckleRange(std::max(sgbm->getSpeckleRange(), 0));
    return matcher;
}

}} // namespace cv::stereo
