// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"

#include "candidate_windows.hpp"
#include "disparity_confidence.hpp"
#include "disparity_forest.hpp"
#include "disparity_prediction.hpp"
#include "disparity_refinement.hpp"
#include "forest_aggregation.hpp"
#include "image_pyramid.hpp"
#include "matching_cost.hpp"
#include "nonlocal_refinement.hpp"
#include "scanline_aggregation.hpp"
#include "support_points.hpp"
#include "tree_strategy.hpp"

#include <cmath>

namespace cv {
namespace stereo {

using namespace hdp;

namespace {

const int largeImageWidth = 1000;

// Two edges a pixel are numbered by int, and what is counted by pixels of a side or by bytes of the image fits into one,
// too, in OpenCV's filters as well. cv::filterSpeckles has 16-bit coordinates.
const int maxSide = SHRT_MAX;
const int speckleBytes = 9; // a pixel, of the memory of cv::filterSpeckles, which counts them by int

const int maxBlockSize = 31;
const int maxMedianSize = 31;
const int maxLayers = 16;
const int leastTopDisparities = CandidateWindow::candidates; // of a third layer
const int mostTopDisparities = 64;
const int secondPassMedian = 5;

// Of the non-local refinement: a stable disparity's largest difference in the left-right check, and gamma, relative to
// that of the cost; with the same gamma the refinement blurs slanted surfaces.
const int stableMaxDiff = 1;
const double refinementGamma = 0.25;

//! A value in a range, or an exception that names the argument and the range.
template <typename T> T checked(T value, bool isValid, const char* name, const char* expected)
{
    if (!isValid)
    {
        std::ostringstream message;
        message << name << " must be " << expected << ", not " << value;
        CV_Error(Error::StsOutOfRange, message.str());
    }
    return value;
}

//! What a preset sets and a file holds. Setters only take values that are valid by themselves; what depends on several
//! of them or on the images is checked in compute().
struct Parameters
{
    int minDisparity = 0;
    int numDisparities = 64;
    int blockSize = 1;
    int speckleWindowSize = 0;
    int speckleRange = 0;
    int disp12MaxDiff = -1;

    Ptr<TreeStrategy> treeStrategy = createMinimumSpanningTree();
    Ptr<DisparityPredictionModel> predictionModel;
    bool usePrediction = true;
    bool useMedianPrefilter = false;
    int numLayers = 3;
    double delta0 = HDPTreeMatcher::AUTO;
    double beta = HDPTreeMatcher::AUTO;
    double gamma = 25.5;
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
    int smallPenalty = 12;
    int largePenalty = 50;
    int finestLayer = 0;
    int scanlinePasses = 1;
    bool fillOcclusions = false;
    int disparityDepth = CV_16S;
    bool useNonLocalRefinement = false;

    void setMinDisparity(int value) { minDisparity = value; }
    void setNumDisparities(int value) { numDisparities = checked(value, value > 0, "numDisparities", "> 0"); }
    void setBlockSize(int value)
    {
        blockSize = checked(value, value >= 1 && value <= maxBlockSize && value % 2 == 1, "blockSize", "odd, in 1..31");
    }
    void setSpeckleWindowSize(int value)
    {
        speckleWindowSize = checked(value, value >= 0, "speckleWindowSize", ">= 0");
    }
    void setSpeckleRange(int value)
    {
        speckleRange = checked(value, value >= 0 && value <= SHRT_MAX / cv::StereoMatcher::DISP_SCALE, "speckleRange",
                               "in 0..2047");
    }
    void setDisp12MaxDiff(int value) { disp12MaxDiff = value; }
    void setTreeStrategy(const Ptr<TreeStrategy>& value)
    {
        if (!value)
            CV_Error(Error::StsNullPtr, "treeStrategy must not be empty");
        treeStrategy = value;
    }
    void setNumLayers(int value)
    {
        const bool isValid = value == HDPTreeMatcher::AUTO || value == HDPTreeMatcher::FEWEST_LAYERS ||
                             (value >= 1 && value <= maxLayers);
        numLayers = checked(value, isValid, "numLayers", "in 1..16, AUTO or FEWEST_LAYERS");
    }
    void setDelta0(double value)
    {
        delta0 =
            checked(value, value == HDPTreeMatcher::AUTO || (value >= 0 && value < 1), "delta0", "in [0, 1) or AUTO");
    }
    void setBeta(double value)
    {
        beta = checked(value, value == HDPTreeMatcher::AUTO || (value >= 0 && value <= 1), "beta", "in [0, 1] or AUTO");
    }
    void setGamma(double value)
    {
        gamma = checked(value, std::isfinite(value) && value > 0, "gamma", "finite and > 0");
    }
    void setColorTruncation(double value)
    {
        colorTruncation = checked(value, std::isfinite(value) && value >= 0, "colorTruncation", "finite and >= 0");
    }
    void setGradientTruncation(double value)
    {
        gradientTruncation =
            checked(value, std::isfinite(value) && value >= 0, "gradientTruncation", "finite and >= 0");
    }
    void setColorWeight(double value)
    {
        colorWeight = checked(value, value >= 0 && value <= 1, "colorWeight", "in [0, 1]");
    }
    void setDisparityMedianSize(int value)
    {
        const bool isValid =
            value == HDPTreeMatcher::AUTO || value == 0 || (value >= 3 && value <= maxMedianSize && value % 2 == 1);
        disparityMedianSize = checked(value, isValid, "disparityMedianSize", "0, odd in 3..31, or AUTO");
    }
    void setDisparityMedianPasses(int value)
    {
        disparityMedianPasses = checked(value, value >= 1 && value <= 8, "disparityMedianPasses", "in 1..8");
    }
    void setMatchingCost(int value)
    {
        const bool isValid = value == HDPTreeMatcher::COST_COLOR_GRADIENT || value == HDPTreeMatcher::COST_CENSUS;
        matchingCost = checked(value, isValid, "matchingCost", "COST_COLOR_GRADIENT or COST_CENSUS");
    }
    void setDisparityPrior(int value)
    {
        const bool isValid =
            value == HDPTreeMatcher::PRIOR_SUPPORT_POINTS || value == HDPTreeMatcher::PRIOR_UPPER_LAYER;
        disparityPrior = checked(value, isValid, "disparityPrior", "PRIOR_SUPPORT_POINTS or PRIOR_UPPER_LAYER");
    }
    void setIntervalMargin(int value)
    {
        intervalMargin = checked(value, value >= 0 && value <= 64, "intervalMargin", "in 0..64");
    }
    void setAggregation(int value)
    {
        const bool isValid =
            value == HDPTreeMatcher::AGGREGATION_TREES || value == HDPTreeMatcher::AGGREGATION_SCANLINES;
        aggregation = checked(value, isValid, "aggregation", "AGGREGATION_TREES or AGGREGATION_SCANLINES");
    }
    void setSmallPenalty(int value) { smallPenalty = checkedPenalty(value, "smallPenalty"); }
    void setLargePenalty(int value) { largePenalty = checkedPenalty(value, "largePenalty"); }
    void setFinestLayer(int value)
    {
        finestLayer = checked(value, value >= 0 && value < maxLayers, "finestLayer", "in 0..15");
    }

    void setScanlinePasses(int value)
    {
        scanlinePasses = checked(value, value >= 1 && value <= 4, "scanlinePasses", "in 1..4");
    }

    void setDisparityDepth(int value)
    {
        disparityDepth = checked(value, value == CV_16S || value == CV_32F, "disparityDepth", "CV_16S or CV_32F");
    }

    static int checkedPenalty(int value, const char* name)
    {
        return checked(value, value >= 0 && value <= ScanlinePenalties::largest, name, "in 0..100");
    }
};

//! Reads a number if the file has it; throws if it is something else.
template <typename T, typename Setter> void readNumber(const FileNode& fn, const char* key, Setter set)
{
    const FileNode node = fn[key];
    if (node.empty())
        return;
    if (!node.isInt() && (std::is_integral<T>::value || !node.isReal()))
        CV_Error(Error::StsParseError, format("%s must be a number", key));
    set((T)node);
}

//! Adds up the wall time of each stage.
class StageClock
{
public:
    void restart()
    {
        stages.clear();
        milliseconds.clear();
    }

    //! Runs a stage and adds its time to that of its name.
    template <typename Stage> void run(const char* name, Stage stage)
    {
        const int64 start = getTickCount();
        stage();
        const double time = (double)(getTickCount() - start) * 1000 / getTickFrequency();
        const size_t i = (size_t)(std::find(stages.begin(), stages.end(), name) - stages.begin());
        if (i == stages.size())
        {
            stages.push_back(name);
            milliseconds.push_back(0);
        }
        milliseconds[i] += time;
    }

    std::vector<String> stages;
    std::vector<double> milliseconds;
};

class HDPTreeMatcherImpl CV_FINAL : public HDPTreeMatcher
{
public:
    explicit HDPTreeMatcherImpl(const Parameters& parameters) : p_(parameters) {}

    void compute(InputArray leftArray, InputArray rightArray, OutputArray disparityArray) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        matched_ = MatchedLayer(); // until this pair is
        const Mat left = leftArray.getMat(), right = rightArray.getMat();
        checkImages(left, right);
        const int depth = outputDepth(disparityArray);
        const LayerSettings settings = resolve(left);
        clock_.restart();
        forest_.trees.clear(); // what getForest() and getLayerPrior() give is of this pair, or nothing
        prior_.clear();
        searchRatios_.assign(settings.layers, 0);

        buffers_.resize(settings.layers + 1);
        std::vector<LayerImages> images;
        clock_.run("image pyramid", [&] { buildPyramids(left, right, settings, images); });
        for (int layer = settings.layers - 1; layer >= settings.finestLayer; --layer)
            matchLayer(layer, images[layer], settings);

        disparityArray.create(left.size(), depth);
        Mat disparity = disparityArray.getMat();
        clock_.run("output", [&] { finish(images, settings, disparity); });
        matched_.size = left.size();
        matched_.extension = settings.extension;
        matched_.isFiltered = isFiltered();
        matched_.layer = settings.finestLayer;
        matched_.scale = settings.scale;
        matched_.disparities = layerDisparities(p_.numDisparities, settings.finestLayer);
    }

    // cv::StereoMatcher
    int getMinDisparity() const CV_OVERRIDE { return p_.minDisparity; }
    void setMinDisparity(int value) CV_OVERRIDE { p_.setMinDisparity(value); }
    int getNumDisparities() const CV_OVERRIDE { return p_.numDisparities; }
    void setNumDisparities(int value) CV_OVERRIDE { p_.setNumDisparities(value); }
    int getBlockSize() const CV_OVERRIDE { return p_.blockSize; }
    void setBlockSize(int value) CV_OVERRIDE { p_.setBlockSize(value); }
    int getSpeckleWindowSize() const CV_OVERRIDE { return p_.speckleWindowSize; }
    void setSpeckleWindowSize(int value) CV_OVERRIDE { p_.setSpeckleWindowSize(value); }
    int getSpeckleRange() const CV_OVERRIDE { return p_.speckleRange; }
    void setSpeckleRange(int value) CV_OVERRIDE { p_.setSpeckleRange(value); }
    int getDisp12MaxDiff() const CV_OVERRIDE { return p_.disp12MaxDiff; }
    void setDisp12MaxDiff(int value) CV_OVERRIDE { p_.setDisp12MaxDiff(value); }

    // HDPTreeMatcher
    Ptr<TreeStrategy> getTreeStrategy() const CV_OVERRIDE { return p_.treeStrategy; }
    void setTreeStrategy(const Ptr<TreeStrategy>& value) CV_OVERRIDE { p_.setTreeStrategy(value); }
    Ptr<DisparityPredictionModel> getPredictionModel() const CV_OVERRIDE { return p_.predictionModel; }
    void setPredictionModel(const Ptr<DisparityPredictionModel>& value) CV_OVERRIDE { p_.predictionModel = value; }
    bool getUsePrediction() const CV_OVERRIDE { return p_.usePrediction; }
    void setUsePrediction(bool value) CV_OVERRIDE { p_.usePrediction = value; }
    bool getUseMedianPrefilter() const CV_OVERRIDE { return p_.useMedianPrefilter; }
    void setUseMedianPrefilter(bool value) CV_OVERRIDE { p_.useMedianPrefilter = value; }
    int getNumLayers() const CV_OVERRIDE { return p_.numLayers; }
    void setNumLayers(int value) CV_OVERRIDE { p_.setNumLayers(value); }
    double getDelta0() const CV_OVERRIDE { return p_.delta0; }
    void setDelta0(double value) CV_OVERRIDE { p_.setDelta0(value); }
    double getBeta() const CV_OVERRIDE { return p_.beta; }
    void setBeta(double value) CV_OVERRIDE { p_.setBeta(value); }
    double getGamma() const CV_OVERRIDE { return p_.gamma; }
    void setGamma(double value) CV_OVERRIDE { p_.setGamma(value); }
    double getColorTruncation() const CV_OVERRIDE { return p_.colorTruncation; }
    void setColorTruncation(double value) CV_OVERRIDE { p_.setColorTruncation(value); }
    double getGradientTruncation() const CV_OVERRIDE { return p_.gradientTruncation; }
    void setGradientTruncation(double value) CV_OVERRIDE { p_.setGradientTruncation(value); }
    double getColorWeight() const CV_OVERRIDE { return p_.colorWeight; }
    void setColorWeight(double value) CV_OVERRIDE { p_.setColorWeight(value); }
    int getDisparityMedianSize() const CV_OVERRIDE { return p_.disparityMedianSize; }
    void setDisparityMedianSize(int value) CV_OVERRIDE { p_.setDisparityMedianSize(value); }
    int getDisparityMedianPasses() const CV_OVERRIDE { return p_.disparityMedianPasses; }
    void setDisparityMedianPasses(int value) CV_OVERRIDE { p_.setDisparityMedianPasses(value); }
    int getMatchingCost() const CV_OVERRIDE { return p_.matchingCost; }
    void setMatchingCost(int value) CV_OVERRIDE { p_.setMatchingCost(value); }
    int getDisparityPrior() const CV_OVERRIDE { return p_.disparityPrior; }
    void setDisparityPrior(int value) CV_OVERRIDE { p_.setDisparityPrior(value); }
    int getIntervalMargin() const CV_OVERRIDE { return p_.intervalMargin; }
    void setIntervalMargin(int value) CV_OVERRIDE { p_.setIntervalMargin(value); }
    bool getUseSubpixel() const CV_OVERRIDE { return p_.useSubpixel; }
    void setUseSubpixel(bool value) CV_OVERRIDE { p_.useSubpixel = value; }
    int getAggregation() const CV_OVERRIDE { return p_.aggregation; }
    void setAggregation(int value) CV_OVERRIDE { p_.setAggregation(value); }
    int getSmallPenalty() const CV_OVERRIDE { return p_.smallPenalty; }
    void setSmallPenalty(int value) CV_OVERRIDE { p_.setSmallPenalty(value); }
    int getLargePenalty() const CV_OVERRIDE { return p_.largePenalty; }
    void setLargePenalty(int value) CV_OVERRIDE { p_.setLargePenalty(value); }
    int getFinestLayer() const CV_OVERRIDE { return p_.finestLayer; }
    void setFinestLayer(int value) CV_OVERRIDE { p_.setFinestLayer(value); }
    int getScanlinePasses() const CV_OVERRIDE { return p_.scanlinePasses; }
    void setScanlinePasses(int value) CV_OVERRIDE { p_.setScanlinePasses(value); }
    int getDisparityDepth() const CV_OVERRIDE { return p_.disparityDepth; }
    void setDisparityDepth(int value) CV_OVERRIDE { p_.setDisparityDepth(value); }
    bool getFillOcclusions() const CV_OVERRIDE { return p_.fillOcclusions; }
    void setFillOcclusions(bool value) CV_OVERRIDE { p_.fillOcclusions = value; }
    bool getUseNonLocalRefinement() const CV_OVERRIDE { return p_.useNonLocalRefinement; }
    void setUseNonLocalRefinement(bool value) CV_OVERRIDE { p_.useNonLocalRefinement = value; }

    void getSearchRatios(std::vector<double>& ratios) const CV_OVERRIDE { ratios = searchRatios_; }

    void getForest(OutputArray treesArray, OutputArray intervalsArray) const CV_OVERRIDE
    {
        const Size size = forest_.trees.empty() ? Size() : forest_.links.size();
        Mat trees(size, CV_32S), intervals(size, CV_16UC2);
        TreeWalk walk;
        for (size_t t = 0; t < forest_.trees.size(); ++t)
        {
            const DisparityTree& tree = forest_.trees[t];
            walkTree(forest_, tree, walk);
            for (int i = 0; i < tree.size; ++i)
            {
                trees.ptr<int>()[walk.pixels[i]] = (int)t;
                intervals.ptr<DisparityInterval>()[walk.pixels[i]] = tree.interval;
            }
        }
        const Range columns(size.empty() ? 0 : forestExtension_, size.width);
        trees.colRange(columns).copyTo(treesArray);
        intervals.colRange(columns).copyTo(intervalsArray);
    }

    void getLayerPrior(std::vector<double>& prior) const CV_OVERRIDE { prior = prior_; }

    void getConfidence(OutputArray confidenceArray) const CV_OVERRIDE
    {
        if (matched_.size.empty())
            return confidenceArray.release();
        confidenceArray.create(matched_.size, CV_8U);
        Mat confidence = confidenceArray.getMat();
        const LayerBuffers& b = buffers_[matched_.layer];
        Mat ofLayer, extended;
        disparityConfidence(b.disparity, matched_.scale, matched_.disparities, b.cost, ofLayer);
        if (matched_.layer > 0)
            resize(ofLayer, extended, matched_.size + Size(matched_.extension, 0), 0, 0, INTER_LINEAR_EXACT);
        else
            extended = ofLayer;
        extended.colRange(matched_.extension, extended.cols).copyTo(confidence);
        if (matched_.isFiltered)
            confidence.setTo(Scalar(0), rejected_);
    }

    void getStageTimes(std::vector<String>& stages, std::vector<double>& milliseconds) const CV_OVERRIDE
    {
        stages = clock_.stages;
        milliseconds = clock_.milliseconds;
    }

    // cv::Algorithm
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_HDPTreeMatcher"; }

    void write(FileStorage& fs) const CV_OVERRIDE
    {
        // clang-format off
        fs << "name" << getDefaultName()
           << "minDisparity" << p_.minDisparity
           << "numDisparities" << p_.numDisparities
           << "blockSize" << p_.blockSize
           << "speckleWindowSize" << p_.speckleWindowSize
           << "speckleRange" << p_.speckleRange
           << "disp12MaxDiff" << p_.disp12MaxDiff
           << "usePrediction" << (int)p_.usePrediction
           << "useMedianPrefilter" << (int)p_.useMedianPrefilter
           << "numLayers" << p_.numLayers
           << "delta0" << p_.delta0
           << "beta" << p_.beta
           << "gamma" << p_.gamma
           << "colorTruncation" << p_.colorTruncation
           << "gradientTruncation" << p_.gradientTruncation
           << "colorWeight" << p_.colorWeight
           << "disparityMedianSize" << p_.disparityMedianSize
           << "disparityMedianPasses" << p_.disparityMedianPasses
           << "matchingCost" << p_.matchingCost
           << "disparityPrior" << p_.disparityPrior
           << "intervalMargin" << p_.intervalMargin
           << "useSubpixel" << (int)p_.useSubpixel
           << "aggregation" << p_.aggregation
           << "smallPenalty" << p_.smallPenalty
           << "largePenalty" << p_.largePenalty
           << "finestLayer" << p_.finestLayer
           << "scanlinePasses" << p_.scanlinePasses
           << "fillOcclusions" << (int)p_.fillOcclusions
           << "disparityDepth" << p_.disparityDepth
           << "useNonLocalRefinement" << (int)p_.useNonLocalRefinement;
        // clang-format on
        fs << "treeStrategy"
           << "{"
           << "strategy" << p_.treeStrategy->getDefaultName();
        p_.treeStrategy->write(fs);
        fs << "}";
        if (p_.predictionModel)
        {
            fs << "predictionModel"
               << "{";
            p_.predictionModel->write(fs);
            fs << "}";
        }
    }

    void read(const FileNode& fn) CV_OVERRIDE
    {
        if (!fn.isMap() || !fn["name"].isString() || (String)fn["name"] != getDefaultName())
            CV_Error(Error::StsParseError, "name must be " + getDefaultName());
        Parameters p; // what the file does not have gets its default
        readNumber<int>(fn, "minDisparity", [&](int value) { p.setMinDisparity(value); });
        readNumber<int>(fn, "numDisparities", [&](int value) { p.setNumDisparities(value); });
        readNumber<int>(fn, "blockSize", [&](int value) { p.setBlockSize(value); });
        readNumber<int>(fn, "speckleWindowSize", [&](int value) { p.setSpeckleWindowSize(value); });
        readNumber<int>(fn, "speckleRange", [&](int value) { p.setSpeckleRange(value); });
        readNumber<int>(fn, "disp12MaxDiff", [&](int value) { p.setDisp12MaxDiff(value); });
        readNumber<int>(fn, "usePrediction", [&](int value) { p.usePrediction = value != 0; });
        readNumber<int>(fn, "useMedianPrefilter", [&](int value) { p.useMedianPrefilter = value != 0; });
        readNumber<int>(fn, "numLayers", [&](int value) { p.setNumLayers(value); });
        readNumber<double>(fn, "delta0", [&](double value) { p.setDelta0(value); });
        readNumber<double>(fn, "beta", [&](double value) { p.setBeta(value); });
        readNumber<double>(fn, "gamma", [&](double value) { p.setGamma(value); });
        readNumber<double>(fn, "colorTruncation", [&](double value) { p.setColorTruncation(value); });
        readNumber<double>(fn, "gradientTruncation", [&](double value) { p.setGradientTruncation(value); });
        readNumber<double>(fn, "colorWeight", [&](double value) { p.setColorWeight(value); });
        readNumber<int>(fn, "disparityMedianSize", [&](int value) { p.setDisparityMedianSize(value); });
        readNumber<int>(fn, "disparityMedianPasses", [&](int value) { p.setDisparityMedianPasses(value); });
        readNumber<int>(fn, "matchingCost", [&](int value) { p.setMatchingCost(value); });
        readNumber<int>(fn, "disparityPrior", [&](int value) { p.setDisparityPrior(value); });
        readNumber<int>(fn, "intervalMargin", [&](int value) { p.setIntervalMargin(value); });
        readNumber<int>(fn, "useSubpixel", [&](int value) { p.useSubpixel = value != 0; });
        readNumber<int>(fn, "aggregation", [&](int value) { p.setAggregation(value); });
        readNumber<int>(fn, "smallPenalty", [&](int value) { p.setSmallPenalty(value); });
        readNumber<int>(fn, "largePenalty", [&](int value) { p.setLargePenalty(value); });
        readNumber<int>(fn, "finestLayer", [&](int value) { p.setFinestLayer(value); });
        readNumber<int>(fn, "scanlinePasses", [&](int value) { p.setScanlinePasses(value); });
        readNumber<int>(fn, "fillOcclusions", [&](int value) { p.fillOcclusions = value != 0; });
        readNumber<int>(fn, "disparityDepth", [&](int value) { p.setDisparityDepth(value); });
        readNumber<int>(fn, "useNonLocalRefinement", [&](int value) { p.useNonLocalRefinement = value != 0; });
        p.treeStrategy = readStrategy(fn["treeStrategy"]);
        if (!fn["predictionModel"].empty())
        {
            p.predictionModel = DisparityPredictionModel::create();
            p.predictionModel->read(fn["predictionModel"]);
        }
        p_ = p;
    }

private:
    //! What the parameters amount to for an image.
    struct LayerSettings
    {
        int layers, finestLayer;
        int extension; // columns added on the left, for pixels there to have their matches, if disparities are negative
        Ptr<DisparityPredictionModel> model;
        double delta0, beta;
        int medianSize;
        int scale; // units of a disparity in one pixel
    };

    //! The finest layer of the last pair
    struct MatchedLayer
    {
        Size size;     // of the image; empty: no pair is matched
        int extension; // columns on its left
        int layer;
        int scale;       // units of a disparity in one pixel
        int disparities; // of the layer
        bool isFiltered; // rejected_ says which pixels of the image are invalid
        MatchedLayer() : extension(0), layer(0), scale(0), disparities(0), isFiltered(false) {}
    };

    //! What the stages see of a layer
    struct LayerImages
    {
        Mat guide;       // gives the edge weights
        Mat left, right; // give the matching cost
    };

    //! Memory of a layer. What two layers share would be allocated anew for each of them.
    struct LayerBuffers
    {
        Mat guide, pixelIntv;
        Mat smallest, largest, windows;
        MatchingCost cost;
        Mat winner, residual, filtered, medianStripes, stable;
        Mat disparity; // the result
    };

    static void checkImages(const Mat& left, const Mat& right)
    {
        if (left.empty())
            CV_Error(Error::StsBadArg, "left must not be empty");
        if (left.dims != 2 || (left.type() != CV_8UC1 && left.type() != CV_8UC3))
            CV_Error(Error::StsUnsupportedFormat, "left must be CV_8UC1 or CV_8UC3");
        if (right.dims != 2 || right.size() != left.size())
            CV_Error(Error::StsUnmatchedSizes, "right must have the size of left");
        if (right.type() != left.type())
            CV_Error(Error::StsUnmatchedFormats, "right must have the type of left");
        if (std::max(left.cols, left.rows) > maxSide)
            CV_Error(Error::StsOutOfRange, format("left must be at most %d pixels wide and high, not %d x %d", maxSide,
                                                  left.cols, left.rows));
        if (left.total() * left.elemSize() > (size_t)INT_MAX)
            CV_Error(Error::StsOutOfRange, "left must have less than 2^31 bytes");
    }

    //! Of the disparities: what the caller's array has, if its type is fixed
    int outputDepth(OutputArray disparity) const
    {
        const int type = disparity.fixedType() ? disparity.type() : p_.disparityDepth;
        if (type != CV_16SC1 && type != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "disparity must be CV_16SC1 or CV_32FC1 if its type is fixed");
        return type;
    }

    LayerSettings resolve(const Mat& left) const
    {
        const Size size = left.size();
        const int64 lowest = ((int64)p_.minDisparity - 1) * DISP_SCALE;
        const int64 highest = ((int64)p_.minDisparity + p_.numDisparities - 1) * DISP_SCALE;
        if (lowest < SHRT_MIN || highest > SHRT_MAX)
            CV_Error(Error::StsOutOfRange,
                     format("minDisparity and numDisparities must keep (minDisparity - 1) * %d and "
                            "(minDisparity + numDisparities - 1) * %d in CV_16S",
                            (int)DISP_SCALE, (int)DISP_SCALE));

        if (p_.matchingCost == COST_CENSUS && p_.blockSize != 3 && p_.blockSize != 5 && p_.blockSize != 7)
            CV_Error(Error::StsOutOfRange, format("blockSize must be 3, 5 or 7 for COST_CENSUS, not %d", p_.blockSize));

        if (p_.aggregation == AGGREGATION_SCANLINES && p_.matchingCost != COST_CENSUS)
            CV_Error(Error::StsBadArg, "matchingCost must be COST_CENSUS for AGGREGATION_SCANLINES");

        if (p_.fillOcclusions && p_.matchingCost != COST_CENSUS)
            CV_Error(Error::StsBadArg, "matchingCost must be COST_CENSUS for fillOcclusions");

        if (p_.speckleWindowSize > 0 && size.area() > INT_MAX / speckleBytes)
            CV_Error(Error::StsOutOfRange,
                     format("speckleWindowSize must be 0 for images of more than %d pixels", INT_MAX / speckleBytes));

        const bool isLarge = size.width >= largeImageWidth;
        LayerSettings settings;
        settings.layers = p_.usePrediction ? countLayers(size, numLayers()) : 1;
        settings.finestLayer = std::min(p_.finestLayer, settings.layers - 1);
        settings.extension = p_.minDisparity < 0 ? (int)alignSize(-p_.minDisparity, 1 << (settings.layers - 1)) : 0;
        const int64 width = (int64)size.width + settings.extension;
        if (width > maxSide || width * size.height * (int64)left.elemSize() > INT_MAX)
            CV_Error(Error::StsOutOfRange,
                     format("minDisparity must not be %d for an image of %d x %d: as many columns are added to it",
                            p_.minDisparity, size.width, size.height));
        settings.scale = p_.useSubpixel || p_.aggregation == AGGREGATION_SCANLINES ? subpixelScale : 1;
        settings.model = p_.predictionModel;
        if (!settings.model)
            settings.model = DisparityPredictionModel::createPublished(
                isLarge ? DisparityPredictionModel::PUBLISHED_LARGE : DisparityPredictionModel::PUBLISHED_SMALL);
        if (p_.aggregation == AGGREGATION_TREES && settings.model->getNumLayers() < settings.layers - 1)
            CV_Error(Error::StsOutOfRange, format("predictionModel must have numLayers - 1 = %d layers, not %d",
                                                  settings.layers - 1, settings.model->getNumLayers()));
        settings.delta0 = p_.delta0 != AUTO ? p_.delta0 : isLarge ? 0.064 : 0.004;
        settings.beta = p_.beta != AUTO ? p_.beta : isLarge ? 0.6 : 0.95;
        settings.medianSize = p_.disparityMedianSize != AUTO ? p_.disparityMedianSize : p_.usePrediction ? 7 : 5;
        return settings;
    }

    int numLayers() const
    {
        if (p_.numLayers > 0)
            return p_.numLayers;
        int layers = p_.numLayers == AUTO && layerDisparities(p_.numDisparities, 2) >= leastTopDisparities ? 3 : 2;
        while (layerDisparities(p_.numDisparities, layers - 1) > mostTopDisparities)
            ++layers;
        return layers;
    }

    //! Section 2.1. The layers above the image are kept in a buffer; the image itself belongs to the caller.
    static void buildPyramid(const Mat& image, int layers, std::vector<Mat>& pyramid)
    {
        pyramid.resize(layers);
        pyramid[0] = image;
        for (int layer = 1; layer < layers; ++layer)
            halveImage(pyramid[layer - 1], pyramid[layer]);
    }

    void buildPyramids(const Mat& left, const Mat& right, const LayerSettings& settings,
                       std::vector<LayerImages>& images)
    {
        const bool census = p_.matchingCost == COST_CENSUS;
        Mat extended = left, shifted = right;
        if (p_.minDisparity != 0)
        {
            shiftColumns(right, p_.minDisparity, settings.extension, shiftedRight_);
            shifted = shiftedRight_;
        }
        if (settings.extension > 0)
        {
            copyMakeBorder(left, extendedLeft_, 0, 0, settings.extension, 0, BORDER_REPLICATE);
            extended = extendedLeft_;
        }
        buildPyramid(extended, settings.layers, leftPyramid_);
        if (census)
        {
            greyLevels(extended, leftGrey_);
            greyLevels(shifted, rightGrey_);
            buildPyramid(leftGrey_, settings.layers, leftGreyPyramid_);
            buildPyramid(rightGrey_, settings.layers, rightPyramid_);
        }
        else
            buildPyramid(shifted, settings.layers, rightPyramid_);
        images.resize(settings.layers);
        for (int layer = 0; layer < settings.layers; ++layer)
        {
            images[layer].guide = leftPyramid_[layer];
            images[layer].left = census ? leftGreyPyramid_[layer] : leftPyramid_[layer];
            images[layer].right = rightPyramid_[layer];
        }
        leftPyramid_[0].release(); // the caller's
        rightPyramid_[0].release();
    }

    //! Section 3: from the disparities of the layer above to those of this layer
    void matchLayer(int layer, const LayerImages& images, const LayerSettings& settings)
    {
        const int disparities = layerDisparities(p_.numDisparities, layer);
        LayerBuffers& b = buffers_[layer];
        clock_.run("matching cost", [&] {
            const MatchingCostParams params = { p_.matchingCost == COST_CENSUS, (float)p_.colorTruncation,
                                                (float)p_.gradientTruncation, (float)p_.colorWeight, p_.blockSize };
            b.cost.prepare(images.left, images.right, disparities, params);
        });
        if (layer == settings.layers - 1 || p_.aggregation == AGGREGATION_TREES)
            aggregateTrees(layer, images, settings);
        else
            aggregateScanlines(layer, images, settings);
        if (p_.useNonLocalRefinement)
            clock_.run("non-local refinement", [&] { refine(layer, images, settings); });
        clock_.run("disparity median", [&] {
            swap(b.winner, b.disparity);
            for (int pass = 0; settings.medianSize > 0 && pass < p_.disparityMedianPasses; ++pass)
            {
                medianDisparity(b.disparity, settings.medianSize, b.medianStripes, b.winner);
                swap(b.winner, b.disparity);
            }
        });
    }

    //! Sections 3.1 to 3.3
    void aggregateTrees(int layer, const LayerImages& images, const LayerSettings& settings)
    {
        const int disparities = layerDisparities(p_.numDisparities, layer);
        LayerBuffers& b = buffers_[layer];
        Mat& upper = buffers_[layer + 1].disparity;
        const Size size = images.guide.size();
        if (layer == settings.layers - 1)
            clock_.run("disparity prediction", [&] {
                b.pixelIntv.create(size, CV_16UC2);
                b.pixelIntv.setTo(Scalar(0, disparities - 1)); // the full range
            });
        else
        {
            if (p_.disparityPrior == PRIOR_SUPPORT_POINTS)
                clock_.run("support points", [&] {
                    Mat left = images.left, right = images.right;
                    if (left.depth() != CV_8U) // greyLevels()
                    {
                        left.convertTo(left, CV_8U, 1. / greyScale);
                        right.convertTo(right, CV_8U, 1. / greyScale);
                    }
                    findSupportPoints(left, right, disparities, supportPoints_, points_);
                    disparityHistogram(points_, disparities, prior_);
                });
            else
                clock_.run("disparity prediction", [&] { upperHistogram(upper, settings.scale, disparities, prior_); });
            clock_.run("disparity prediction", [&] {
                predictIntervals(*settings.model, layer, prior_, layerDisparities(p_.numDisparities, layer + 1),
                                 settings.delta0 * (1 << layer), p_.intervalMargin, intervals_);
                assignIntervals(upper, settings.scale, size, intervals_, b.pixelIntv);
            });
        }
        clock_.run("disparity forest", [&] {
            buildLayerForest(layer, images, settings);
            searchRatios_[layer] = searchRatio(forest_, disparities);
        });
        clock_.run("cost aggregation",
                   [&] { aggregateForest(forest_, b.cost, p_.gamma, settings.scale > 1, aggregation_, b.winner); });
        if (p_.fillOcclusions)
            clock_.run("occlusions", [&] {
                b.cost.censusCosts(b.winner, settings.scale, b.residual);
                fillOccluded(b.winner, b.residual, settings.scale);
            });
    }

    //! Section 3.2: forest_, from b.pixelIntv
    void buildLayerForest(int layer, const LayerImages& images, const LayerSettings& settings)
    {
        LayerBuffers& b = buffers_[layer];
        forestExtension_ = settings.extension >> layer;
        if (p_.useMedianPrefilter)
            medianBlur(images.guide, b.guide, 3);
        buildForest(p_.useMedianPrefilter ? b.guide : images.guide, b.pixelIntv, *p_.treeStrategy, settings.beta,
                    !p_.usePrediction, forestBuffers_, forest_);
    }

    //! Refines b.winner over forest_.
    void refine(int layer, const LayerImages& images, const LayerSettings& settings)
    {
        LayerBuffers& b = buffers_[layer];
        if (forest_.links.size() != b.winner.size()) // the layer has no trees of its own
        {
            b.pixelIntv.create(b.winner.size(), CV_16UC2);
            b.pixelIntv.setTo(Scalar::all(0)); // one tree
            buildLayerForest(layer, images, settings);
        }
        swap(b.winner, b.disparity);
        findStable(b.disparity, settings.scale, stableMaxDiff, b.stable);
        refineNonLocal(forest_, b.disparity, settings.scale, b.stable, p_.gamma * refinementGamma, aggregation_,
                       b.winner);
    }

    //! Predicted windows instead of trees. Each pass but the first takes its windows from the disparities of the one
    //! before, and trusts them more than those of the layer above.
    void aggregateScanlines(int layer, const LayerImages& images, const LayerSettings& settings)
    {
        const int disparities = layerDisparities(p_.numDisparities, layer);
        LayerBuffers& b = buffers_[layer];
        Mat& upper = buffers_[layer + 1].disparity;
        searchRatios_[layer] = std::min<double>(CandidateWindow::candidates, disparities) / disparities;
        for (int pass = 0; pass < p_.scanlinePasses; ++pass)
        {
            if (pass > 0)
                clock_.run("disparity median", [&] {
                    medianDisparity(b.winner, secondPassMedian, b.medianStripes, b.filtered);
                    halveDisparity(b.filtered, upper);
                });
            clock_.run("disparity prediction",
                       [&] { predictWindows(upper, disparities, b.smallest, b.largest, b.windows); });
            clock_.run("cost aggregation", [&] {
                const ScanlinePenalties penalties = { p_.smallPenalty, p_.largePenalty, pass == 0 ? 1 : 2 };
                hdp::aggregateScanlines(b.cost, images.left.size(), disparities, b.windows, penalties, scanlines_,
                                        b.winner, b.residual);
            });
            if (p_.fillOcclusions)
                clock_.run("occlusions", [&] { fillOccluded(b.winner, b.residual, settings.scale); });
        }
    }

    bool isFiltered() const { return p_.disp12MaxDiff > 0 || p_.speckleWindowSize > 0; }

    //! From candidates of the finest layer to what cv::StereoMatcher promises.
    void finish(const std::vector<LayerImages>& images, const LayerSettings& settings, Mat& disparity)
    {
        for (int layer = settings.finestLayer - 1; layer >= 0; --layer)
            upsampleDisparity(buffers_[layer + 1].disparity, settings.scale, images[layer].guide.size(),
                              buffers_[layer].disparity);
        LayerBuffers& b = buffers_[0];
        const bool toWhole = settings.scale > 1 && !p_.useSubpixel;
        if (toWhole)
            b.disparity.convertTo(b.winner, CV_16U, 1. / settings.scale);
        const Mat& extended = toWhole ? b.winner : b.disparity;
        const Mat map = extended.colRange(settings.extension, extended.cols);
        const int scale = toWhole ? 1 : settings.scale;
        const bool isFloat = disparity.depth() == CV_32F;
        if (isFloat)
            map.convertTo(disparity, CV_32F, 1. / scale, p_.minDisparity);
        Mat& fixedPoint = isFloat ? fixedPoint_ : disparity; // what the filters take
        if (!isFloat || isFiltered())
            map.convertTo(fixedPoint, CV_16S, (double)DISP_SCALE / scale, (double)p_.minDisparity * DISP_SCALE);
        if (!isFiltered())
            return;
        const short invalid = (short)((p_.minDisparity - 1) * DISP_SCALE);
        if (p_.disp12MaxDiff > 0)
            rejectOccluded(fixedPoint, p_.disp12MaxDiff, invalid);
        if (p_.speckleWindowSize > 0)
        {
            // One byte more than cv::filterSpeckles allocates: it writes there if no two pixels belong together.
            const int bytes = (int)disparity.total() * speckleBytes + 1;
            if (speckles_.cols < bytes)
                speckles_.create(1, bytes, CV_8U);
            filterSpeckles(fixedPoint, invalid, p_.speckleWindowSize, DISP_SCALE * p_.speckleRange, speckles_);
        }
        compare(fixedPoint, Scalar(invalid), rejected_, CMP_EQ);
        if (isFloat)
            disparity.setTo(Scalar(p_.minDisparity - 1), rejected_);
    }

    Ptr<TreeStrategy> readStrategy(const FileNode& fn) const
    {
        if (!fn.isMap() || !fn["strategy"].isString())
            CV_Error(Error::StsParseError, "treeStrategy must name a strategy");
        const String name = (String)fn["strategy"];
        Ptr<TreeStrategy> strategy = createTreeStrategy(name);
        if (strategy)
            strategy->read(fn);
        else if (name == p_.treeStrategy->getDefaultName()) // the caller's own, which only the caller can create
            strategy = p_.treeStrategy;
        else
            CV_Error(Error::StsParseError, "treeStrategy: set a strategy named " + name + " before reading");
        return strategy;
    }

    Parameters p_;
    std::vector<double> searchRatios_;
    StageClock clock_;
    MatchedLayer matched_;

    // Buffers that are kept between calls
    std::vector<Mat> leftPyramid_, leftGreyPyramid_, rightPyramid_;
    Mat extendedLeft_, shiftedRight_, leftGrey_, rightGrey_;
    SupportPointBuffers supportPoints_;
    Mat points_;
    std::vector<double> prior_;
    std::vector<DisparityInterval> intervals_;
    ForestBuffers forestBuffers_;
    DisparityForest forest_;
    int forestExtension_ = 0; // columns on the left of the layer's image
    AggregationBuffers aggregation_;
    ScanlineBuffers scanlines_;
    std::vector<LayerBuffers> buffers_; // one more than layers: there is nothing above the top one
    Mat fixedPoint_, rejected_, speckles_;
};

} // namespace

Ptr<HDPTreeMatcher> HDPTreeMatcher::create(int minDisparity, int numDisparities, int preset)
{
    checked(preset, preset >= PRESET_PAPER && preset <= PRESET_TREE, "preset", "one of HDPTreeMatcher::PRESET_*");
    Parameters parameters; // its defaults are those of PRESET_PAPER
    if (preset != PRESET_PAPER)
    {
        parameters.setMatchingCost(COST_CENSUS);
        parameters.setBlockSize(7);
        parameters.setGamma(20);
        parameters.useSubpixel = true;
        parameters.setDisparityMedianSize(5);
        parameters.fillOcclusions = true;
    }
    switch (preset)
    {
    case PRESET_TREE:
        parameters.setDisparityPrior(PRIOR_UPPER_LAYER);
        parameters.setIntervalMargin(1);
        parameters.setDelta0(0.02);
        parameters.setBeta(0.9);
        break;
    case PRESET_ULTRAFAST:
        parameters.setFinestLayer(1);
        // fall through
    case PRESET_FAST:
        parameters.setAggregation(AGGREGATION_SCANLINES);
        parameters.setTreeStrategy(createSegmentTree());
        parameters.setNumLayers(AUTO);
        break;
    case PRESET_QUALITY:
        parameters.setAggregation(AGGREGATION_SCANLINES);
        parameters.setTreeStrategy(createSegmentTree());
        parameters.setNumLayers(FEWEST_LAYERS);
        parameters.setScanlinePasses(2);
        parameters.setDisparityMedianSize(7);
        parameters.setDisparityMedianPasses(2);
        break;
    }
    parameters.setMinDisparity(minDisparity);
    parameters.setNumDisparities(numDisparities);
    return makePtr<HDPTreeMatcherImpl>(parameters);
}

} // namespace stereo
} // namespace cv
