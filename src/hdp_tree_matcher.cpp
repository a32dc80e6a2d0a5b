// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"

#include "layer_matching.hpp"
#include "base/result_array.hpp"
#include "map/disparity_confidence.hpp"
#include "range_search.hpp"
#include "video/temporal_prior.hpp"

#include <limits>
#include <type_traits>

namespace cv { namespace stereo {

using namespace hdp;

namespace {

const char* const nameInFiles = "StereoMatcher.HDPTree"; // as OpenCV's StereoMatcher.SGBM

// Factor of the errors from a layer to the one below that it is enlarged to: means of pixels have less noise
const double sigmaPerLayer = 1.37;

//! The setter and the getter of a parameter
#define HDP_PARAMETER(T, Name, member)                                                                                 \
    void set##Name(T value) CV_OVERRIDE                                                                                \
    {                                                                                                                  \
        MatcherParameters changed = p_;                                                                                \
        changed.member = value;                                                                                        \
        change(changed);                                                                                               \
    }                                                                                                                  \
    std::decay<T>::type get##Name() const CV_OVERRIDE { return p_.member; }

class HDPTreeMatcherImpl CV_FINAL : public HDPTreeMatcher
{
public:
    explicit HDPTreeMatcherImpl(const MatcherParameters& parameters) : p_(parameters) {}

    void compute(InputArray leftArray, InputArray rightArray, OutputArray disparityArray) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        result_ = Result(); // until this pair is matched
        Mat left = imageOf(leftArray, "left"), right = imageOf(rightArray, "right");
        checkPair(left, right);
        const Size size = left.size();
        const int type = left.type();
        checkInputs(inputs_, size);
        const int depth = depthOfOutput(disparityArray, size, p_.disparityDepth);
        const auto makePlan = [&](const MatcherParameters& parameters) {
            return plan(parameters, size, type, pairModel_, inputs_);
        };
        PairPlan pairPlan = makePlan(p_);
        clock_.restart();

        const struct ImageRelease // which may be the caller's
        {
            CompletePair& pair;
            ~ImageRelease() { pair.left = pair.right = Mat(); }
        } release = { pair_ };
        clock_.run("missing pixels",
                   [&] { completePair(left, right, inputs_.leftMask, inputs_.rightMask, pairModel_, pair_); });
        const bool keepsRange = pairPlan.looksForRange && pairPlan.followsVideo;
        if (pairPlan.looksForRange)
            pairPlan = makePlan(withFoundRange(pairPlan));
        if (!keepsRange)
            rangeSearch_.forgetFrames();
        if (inputs_.hasRanges() || inputs_.hasPrior())
            clock_.run("known disparities", [&] { takeKnown(inputs_, pairPlan, known_); });
        else
            known_ = KnownDisparities();
        if (matchPair(pairPlan) == CONTRADICTED)
        {
            lastFrame_.clear();
            matchPair(pairPlan);
        }

        left = right = pair_.left = pair_.right = Mat(); // a UMat that is the result, too, must not be mapped
        disparityArray.create(size, depth);
        Mat disparity = disparityArray.getMat();
        const Mat& finest = layers_[pairPlan.finest().layer].disparity;
        clock_.run("output", [&] {
            outputDisparity(finest, pairPlan.output, output_, disparity, pair_.masks.left, known_.ranges);
        });
        result_.isMatched = true;
        result_.model = pairPlan.given.isGiven
                            ? pairModel_
                            : toPairModel(pairPlan.pyramids, size, CV_MAT_DEPTH(type), pairPlan.numDisparities, pair_,
                                          pyramids_.levels, result_.findings);
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
    HDP_PARAMETER(const Ptr<TreeStrategy>&, TreeStrategy, treeStrategy)

    void setPairModel(const PairModel& model) CV_OVERRIDE
    {
        checkPairModel(model);
        pairModel_ = model;
    }
    PairModel getPairModel() const CV_OVERRIDE { return result_.isMatched ? result_.model : PairModel(); }
    void setMasks(InputArray leftMask, InputArray rightMask) CV_OVERRIDE
    {
        hdp::setMasks(leftMask, rightMask, inputs_);
    }

    void setDisparityRange(InputArray smallest, InputArray largest) CV_OVERRIDE
    {
        setRange(smallest, largest, inputs_);
    }
    void setPriorDisparity(InputArray disparity, InputArray sigma) CV_OVERRIDE { setPrior(disparity, sigma, inputs_); }

    Findings getFindings() const CV_OVERRIDE
    {
        const Result none = Result();
        const Result& r = result_.isMatched ? result_ : none;
        // The model is about the centre of the right image that is matched, which has columns added and is shifted.
        const RowModel rows = r.findings.rows.about(0.5 * r.model.addedColumns + r.model.minDisparity);
        Findings findings = Findings();
        findings.rows.assign(rows.coefficients.val, rows.coefficients.val + RowModel::terms);
        findings.areRowsMoved = r.findings.hasRows;
        findings.light = r.model.light;
        findings.isLightChanged = r.findings.hasLight;
        if (!r.isMatched)
            return findings;
        findings.minDisparity = r.plan.output.minDisparity;
        findings.numDisparities = r.plan.numDisparities;
        findings.rowError = r.model.rowError;
        findings.noise = r.noiseOfLayer(r.plan.finest().layer);
        findings.searchRatios.assign(r.plan.top().layer + 1, 0);
        for (const LayerPlan& layer : r.plan.layers)
            findings.searchRatios[layer.layer] = layers_[layer.layer].searchRatio;
        findings.stages = clock_.stages;
        findings.stageTimes = clock_.milliseconds;
        return findings;
    }

    void getForest(OutputArray treesArray, OutputArray intervalsArray) const CV_OVERRIDE
    {
        Mat trees, intervals;
        if (result_.isMatched)
            drawForest(shared_.forest, trees, intervals);
        copyLayer(trees, shared_.forestLayer, treesArray);
        copyLayer(intervals, shared_.forestLayer, intervalsArray);
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
        if (!hasResult(confidenceArray, CV_8UC1, "confidence"))
            return;
        enlargeToImage(confidenceOfLayer(), INTER_LINEAR_EXACT, confidenceArray);
        if (!known_.ranges.isEmpty())
            confidenceArray.setTo(Scalar(0), moves() > 1);
        if (!output_.rejected.empty())
            confidenceArray.setTo(Scalar(0), output_.rejected.back().pixels);
    }

    void getDisparitySigma(OutputArray sigmaArray) const CV_OVERRIDE
    {
        if (!hasResult(sigmaArray, CV_32FC1, "sigma"))
            return;
        const LayerPlan& plan = result_.plan.finest();
        Mat mismatch, ofLayer;
        if (plan.cost.isCensus)
            levelMismatch(layers_[plan.layer].disparity, scratch_[plan.layer].census, mismatch);
        const float rounding = result_.plan.output.isWhole ? 0.34f : 0.f; // of 68 % of what is rounded to whole pixels
        disparitySigma(confidenceOfLayer(), mismatch, result_.model.rowError, result_.noiseOfLayer(0), rounding,
                       ofLayer);
        double scale = 1;
        for (int layer = 0; layer < plan.layer; ++layer)
            scale *= sigmaPerLayer;
        enlargeToImage(ofLayer * scale, INTER_NEAREST, sigmaArray); // means of floats differ between machines
        if (!known_.ranges.isEmpty())
            add(sigmaArray, moves(), sigmaArray);
        if (!output_.rejected.empty())
            sigmaArray.setTo(Scalar(std::numeric_limits<float>::infinity()), output_.rejected.back().pixels);
    }

    void getReasons(OutputArray reasonsArray) const CV_OVERRIDE
    {
        if (!hasResult(reasonsArray, CV_8UC1, "reasons"))
            return;
        const PairPlan& pairPlan = result_.plan;
        const LayerPlan& layer = pairPlan.finest();
        Mat ofLayer;
        findReasons(layers_[layer.layer].disparity, pairPlan.output, pairPlan.size.width,
                    scratch_[layer.layer].cost(layer.cost).limits(), ofLayer);
        enlargeToImage(ofLayer, INTER_NEAREST, reasonsArray);
        if (!known_.ranges.isEmpty())
            reasonsArray.setTo(Scalar(REASON_RANGE), moves() > 1);
        // From the last filter to the first: what rejected a pixel first is the reason.
        for (auto rejected = output_.rejected.rbegin(); rejected != output_.rejected.rend(); ++rejected)
            reasonsArray.setTo(Scalar(rejected->reason), rejected->pixels);
    }

    // cv::Algorithm
    void clear() CV_OVERRIDE
    {
        lastFrame_.clear();
        rangeSearch_.forgetFrames();
    }

    //! The key of the matcher in a file of save(): not nameInFiles, as keys of FileStorage may not have dots in XML.
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
        clear();
    }

private:
    //! What is known of the last pair
    struct Result
    {
        bool isMatched = false;
        PairPlan plan;
        PairFindings findings;
        PairModel model;

        //! In levels that may be stretched, but not brightened
        double noiseOfLayer(int layer) const { return LayerNoise{ model.noise, model.noiseLayer }.ofLayer(layer); }
    };

    //! To values that are valid, or not at all
    void change(const MatcherParameters& parameters)
    {
        checkParameters(parameters);
        p_ = parameters;
    }

    //! Whether there is a result for an array, which is emptied if there is none
    bool hasResult(OutputArray array, int type, const char* name) const
    {
        if (result_.isMatched)
            requireMat(array, result_.plan.size, type, name);
        else if (array.fixedSize())
            CV_Error(Error::StsBadArg, format("%s must not have a fixed size, as there is none of a pair yet", name));
        else
            array.release();
        return result_.isMatched;
    }

    //! Whether the last compute() matched this layer
    bool hasLayer(int layer) const
    {
        if (layer < 0)
            CV_Error(Error::StsOutOfRange, format("layer must be >= 0, not %d", layer));
        return result_.isMatched && layer >= result_.plan.finest().layer && layer <= result_.plan.top().layer;
    }

    //! The parameters with the range that is found in the pair
    MatcherParameters withFoundRange(const PairPlan& pairPlan)
    {
        Range found;
        clock_.run("disparity range", [&] {
            found = rangeSearch_.find(pair_.left, pair_.right, pair_.masks, pairPlan.alignment.maxRowOffset,
                                      pairPlan.followsVideo);
        });
        return withRange(p_, found.start, found.size());
    }

    //! From the images to the disparities of the finest layer. CONTRADICTED: the pair was matched as the next frame of
    //! a video, and is none.
    Verdict matchPair(const PairPlan& pairPlan)
    {
        const int finest = pairPlan.finest().layer;
        const GivenPair& given = pairPlan.given;
        if (!pairPlan.followsVideo)
            lastFrame_ = FrameMemory();
        std::vector<LayerImages> images;
        clock_.run("image pyramid", [&] {
            buildPairPyramids(pair_.left, pair_.right, pair_.masks, pairPlan.pyramids, pyramids_, images,
                              given.isGiven ? &given.levels : nullptr);
        });
        if (given.isGiven || pairPlan.alignment.looksForAnything())
            clock_.run("alignment",
                       [&] { alignPair(pairPlan.alignment, alignmentBuffers_, images, result_.findings, given); });
        VideoFindings video = { FIRST, false };
        if (pairPlan.followsVideo)
            clock_.run("temporal prediction", [&] { video = compareWithLastFrame(images[finest].left, pairPlan); });

        PairPlan adapted = adapt(pairPlan, result_.findings, video);
        layers_.resize(pairPlan.top().layer + 1);
        scratch_.resize(layers_.size());
        clock_.run("matching cost", [&] {
            for (const LayerPlan& layer : adapted.layers)
                prepareCost(layer, images[layer.layer], scratch_[layer.layer]);
        });
        const LayerResult* upper = nullptr;
        Verdict verdict = FIRST;
        for (const LayerPlan& layer : adapted.layers)
        {
            const CensusCost* below = layer.seesBelow ? &scratch_[layer.layer - 1].census : nullptr;
            const LayerInput input = { adapted, layer,  images[layer.layer], upper,
                                       below,   known_, lastFrame_,          prediction_ };
            verdict = matchLayer(input, scratch_[layer.layer], shared_, clock_, layers_[layer.layer]);
            if (verdict == CONTRADICTED)
                return CONTRADICTED;
            upper = &layers_[layer.layer];
        }
        if (pairPlan.followsVideo)
            std::swap(lastFrame_, shared_.frame);
        adapted.treeStrategy = Ptr<TreeStrategy>(); // the caller's, whose life ends when the parameters are others
        adapted.predictionModel = Ptr<DisparityPredictionModel>();
        result_.plan = adapted;
        return verdict;
    }

    //! Compares the left image of the finest layer with the last frame, see predictFrame(), into prediction_
    VideoFindings compareWithLastFrame(const Mat& left, const PairPlan& pairPlan)
    {
        const int finest = pairPlan.finest().layer, scale = 1 << finest;
        const FrameKey key = { pairPlan.size, scale, pairPlan.pyramids.minDisparity / (double)scale,
                               largestDisparity(pairPlan.numDisparities, finest) };
        predictFrame(left, pyramids_.levels.scale, key, lastFrame_, shared_.video, prediction_);
        return { prediction_.verdict, predictsDisparities(lastFrame_, prediction_) };
    }

    Mat confidenceOfLayer() const
    {
        const LayerPlan& plan = result_.plan.finest();
        const LayerResult& finest = layers_[plan.layer];
        const ConfidenceMaps maps = { finest.disparity, finest.winners,
                                      plan.isTop ? Mat() : layers_[plan.layer + 1].disparity };
        Mat confidence;
        disparityConfidence(maps, plan.numDisparities, scratch_[plan.layer].cost(plan.cost), confidence);
        if (result_.plan.followsVideo)
            trustStable(lastFrame_, confidence);
        return confidence;
    }

    //! A map of the finest layer in the size of the image, without added columns. Throws if the array has another type.
    void enlargeToImage(const Mat& ofLayer, int interpolation, OutputArray array) const
    {
        const int extension = result_.plan.output.extension, scale = 1 << result_.plan.finest().layer;
        const Size size = result_.plan.size, whole = ofLayer.size() * scale, extended = size + Size(extension, 0);
        Mat enlarged = ofLayer;
        if (scale > 1) // an odd row or column continues the one before it, as in the disparity map
        {
            resize(ofLayer, enlarged, whole, 0, 0, interpolation);
            copyMakeBorder(enlarged, enlarged, 0, extended.height - whole.height, 0, extended.width - whole.width,
                           BORDER_REPLICATE);
        }
        array.create(size, ofLayer.type());
        enlarged.colRange(extension, enlarged.cols).copyTo(array);
    }

    Mat moves() const
    {
        const PairPlan& plan = result_.plan;
        return movedIntoRanges(layers_[plan.finest().layer].disparity, plan.output, plan.size, known_.ranges);
    }

    //! Without the columns that are added to the images
    void copyLayer(const Mat& ofLayer, int layer, OutputArray array) const
    {
        if (!array.needed())
            return;
        if (ofLayer.empty())
            return array.release();
        ofLayer.colRange(result_.plan.output.extension >> layer, ofLayer.cols).copyTo(array);
    }

    MatcherParameters p_;
    PairModel pairModel_; // of the next pairs, if it is known
    PairInputs inputs_;
    Result result_;
    StageClock clock_;

    // Memory that is kept between calls
    RangeSearch rangeSearch_;
    CompletePair pair_;
    KnownDisparities known_;
    PairPyramids pyramids_;
    AlignmentBuffers alignmentBuffers_;
    std::vector<LayerResult> layers_; // by layer, as are the next ones
    std::vector<LayerScratch> scratch_;
    SharedScratch shared_;
    OutputBuffers output_;
    FrameMemory lastFrame_; // of a video
    FramePrediction prediction_;
};

} // namespace

Ptr<HDPTreeMatcher> HDPTreeMatcher::create(int minDisparity, int numDisparities, int preset)
{
    const MatcherParameters parameters = withRange(MatcherParameters(preset), minDisparity, numDisparities);
    checkParameters(parameters);
    return makePtr<HDPTreeMatcherImpl>(parameters);
}

Ptr<HDPTreeMatcher> HDPTreeMatcher::createLike(const Ptr<StereoSGBM>& sgbm, int preset)
{
    if (!sgbm)
        CV_Error(Error::StsNullPtr, "sgbm must not be empty");
    if (sgbm->getNumDisparities() <= 0)
        CV_Error(Error::StsOutOfRange, format("numDisparities must be > 0, not %d", sgbm->getNumDisparities()));
    const Ptr<HDPTreeMatcher> matcher = create(sgbm->getMinDisparity(), sgbm->getNumDisparities(), preset);
    matcher->setDisp12MaxDiff(sgbm->getDisp12MaxDiff());
    matcher->setSpeckleWindowSize(sgbm->getSpeckleWindowSize());
    matcher->setSpeckleRange(std::max(sgbm->getSpeckleRange(), 0));
    return matcher;
}

}} // namespace cv::stereo
