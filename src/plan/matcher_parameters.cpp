// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "matcher_parameters.hpp"

#include "../scanlines/scanline_aggregation.hpp"
#include "../forest/tree_strategy.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef MatcherParameters P;
typedef HDPTreeMatcher M;

const int maxPenalty = ScanlinePenalties::largest;

bool isPositive(double value) { return std::isfinite(value) && value > 0; }
bool isNotNegative(double value) { return std::isfinite(value) && value >= 0; }
bool isIn(int value, int first, int last) { return first <= value && value <= last; }
bool isOddIn(int value, int first, int last) { return isIn(value, first, last) && value % 2 == 1; }

//! Of a valid value
template <typename T> struct Condition
{
    typedef bool (*Type)(T);
};

// clang-format off
//! The list of the parameters, in the order of a file: name, member, valid values in words and as a condition if not
//! all of them are
template <typename Visitor> void visitParameters(Visitor&& visit)
{
    visit("minDisparity", &P::minDisparity);
    visit("numDisparities", &P::numDisparities, "> 0", [](int v) { return v > 0; });
    visit("blockSize", &P::blockSize);
    visit("speckleWindowSize", &P::speckleWindowSize);
    visit("speckleRange", &P::speckleRange, ">= 0", [](int v) { return v >= 0; });
    visit("disp12MaxDiff", &P::disp12MaxDiff);
    visit("maxRowOffset", &P::maxRowOffset, ">= 0", [](int v) { return v >= 0; });
    visit("useLightAlignment", &P::useLightAlignment);
    visit("noiseThreshold", &P::noiseThreshold, "finite and >= 0", isNotNegative);
    visit("usePrediction", &P::usePrediction);
    visit("useMedianPrefilter", &P::useMedianPrefilter);
    visit("numLayers", &P::numLayers, "in 1..16", [](int v) { return isIn(v, 1, 16); });
    visit("maxTopDisparities", &P::maxTopDisparities, ">= 0", [](int v) { return v >= 0; });
    visit("delta0", &P::delta0, "in [0, 1) or AUTO", [](double v) { return v == M::AUTO || (v >= 0 && v < 1); });
    visit("beta", &P::beta, "in [0, 1] or AUTO", [](double v) { return v == M::AUTO || (v >= 0 && v <= 1); });
    visit("gamma", &P::gamma, "finite and > 0", isPositive);
    visit("colorTruncation", &P::colorTruncation, "finite and >= 0", isNotNegative);
    visit("gradientTruncation", &P::gradientTruncation, "finite and >= 0", isNotNegative);
    visit("colorWeight", &P::colorWeight, "in [0, 1]", [](double v) { return v >= 0 && v <= 1; });
    visit("disparityMedianSize", &P::disparityMedianSize, "0, 3, 5, 7 or AUTO",
          [](int v) { return v == M::AUTO || v == 0 || isOddIn(v, 3, 7); });
    visit("disparityMedianPasses", &P::disparityMedianPasses, "in 1..8", [](int v) { return isIn(v, 1, 8); });
    visit("matchingCost", &P::matchingCost, "COST_COLOR_GRADIENT or COST_CENSUS",
          [](int v) { return v == M::COST_COLOR_GRADIENT || v == M::COST_CENSUS; });
    visit("disparityPrior", &P::disparityPrior, "PRIOR_SUPPORT_POINTS or PRIOR_UPPER_LAYER",
          [](int v) { return v == M::PRIOR_SUPPORT_POINTS || v == M::PRIOR_UPPER_LAYER; });
    visit("intervalMargin", &P::intervalMargin, "in 0..64", [](int v) { return isIn(v, 0, 64); });
    visit("useSubpixel", &P::useSubpixel);
    visit("aggregation", &P::aggregation, "AGGREGATION_TREES, AGGREGATION_SCANLINES or AGGREGATION_TREE_SCANLINES",
          [](int v) { return isIn(v, M::AGGREGATION_TREES, M::AGGREGATION_TREE_SCANLINES); });
    visit("topAggregation", &P::topAggregation, "AGGREGATION_TREES or AGGREGATION_TREE_SCANLINES",
          [](int v) { return v == M::AGGREGATION_TREES || v == M::AGGREGATION_TREE_SCANLINES; });
    visit("P1", &P::P1, "in 0..100", [](int v) { return isIn(v, 0, maxPenalty); });
    visit("P2", &P::P2, "in 0..100", [](int v) { return isIn(v, 0, maxPenalty); });
    visit("finestLayer", &P::finestLayer, "in 0..15", [](int v) { return isIn(v, 0, 15); });
    visit("scanlinePasses", &P::scanlinePasses, "in 1..4", [](int v) { return isIn(v, 1, 4); });
    visit("fillOcclusions", &P::fillOcclusions);
    visit("disparityDepth", &P::disparityDepth, "CV_16S or CV_32F", [](int v) { return v == CV_16S || v == CV_32F; });
    visit("useNonLocalRefinement", &P::useNonLocalRefinement);
    visit("useTemporalPrediction", &P::useTemporalPrediction);
}
// clang-format on

template <typename T> struct ParameterSetter
{
    MatcherParameters& parameters;
    T P::*const parameter;
    const T value;

    void operator()(const char* name, T P::*member, const char* valid = "",
                    typename Condition<T>::Type isValid = nullptr) const
    {
        if (member != parameter)
            return;
        if (isValid && !isValid(value))
        {
            std::ostringstream message;
            message << name << " must be " << valid << ", not " << value;
            CV_Error(Error::StsOutOfRange, message.str());
        }
        parameters.*member = value;
    }
    template <typename Other>
    void operator()(const char*, Other P::*, const char* = "", typename Condition<Other>::Type = nullptr) const
    {
    }
};

struct ParameterWriter
{
    const MatcherParameters& parameters;
    FileStorage& fs;

    template <typename T>
    void operator()(const char* name, T P::*member, const char* = "", typename Condition<T>::Type = nullptr) const
    {
        fs << name << parameters.*member;
    }
    void operator()(const char* name, bool P::*member, const char* = "", bool (*)(bool) = nullptr) const
    {
        fs << name << (int)(parameters.*member);
    }
};

struct ParameterReader
{
    const FileNode& fn;
    MatcherParameters& parameters;

    void operator()(const char* name, int P::*member, const char* = "", bool (*)(int) = nullptr) const
    {
        const FileNode node = fn[name];
        if (!node.empty())
            setParameter(parameters, member, number<int>(node, name, node.isInt()));
    }
    void operator()(const char* name, double P::*member, const char* = "", bool (*)(double) = nullptr) const
    {
        const FileNode node = fn[name];
        if (!node.empty())
            setParameter(parameters, member, number<double>(node, name, node.isInt() || node.isReal()));
    }
    void operator()(const char* name, bool P::*member, const char* = "", bool (*)(bool) = nullptr) const
    {
        const FileNode node = fn[name];
        if (!node.empty())
            setParameter(parameters, member, number<int>(node, name, node.isInt()) != 0);
    }

private:
    template <typename T> static T number(const FileNode& node, const char* name, bool isNumber)
    {
        if (!isNumber)
            CV_Error(Error::StsParseError, format("%s must be a number", name));
        return (T)node;
    }
};

Ptr<TreeStrategy> readStrategy(const FileNode& fn, const Ptr<TreeStrategy>& own)
{
    if (!fn.isMap() || !fn["strategy"].isString())
        CV_Error(Error::StsParseError, "treeStrategy must name a strategy");
    const String name = (String)fn["strategy"];
    const Ptr<TreeStrategy> strategy = createTreeStrategy(name);
    if (strategy)
    {
        strategy->read(fn);
        return strategy;
    }
    if (name != own->getDefaultName()) // only the caller can create it
        CV_Error(Error::StsParseError, "treeStrategy: set a strategy named " + name + " before reading");
    return own;
}

} // namespace

MatcherParameters presetParameters(int preset)
{
    if (preset < M::PRESET_PAPER || preset > M::PRESET_TREE)
        CV_Error(Error::StsOutOfRange, format("preset must be one of HDPTreeMatcher::PRESET_*, not %d", preset));
    MatcherParameters p;
    if (preset == M::PRESET_PAPER)
        return p;

    p.maxRowOffset = 64;
    p.useLightAlignment = true;
    p.noiseThreshold = 3;
    p.matchingCost = M::COST_CENSUS;
    p.blockSize = 7;
    p.gamma = 20;
    p.useSubpixel = true;
    p.disparityMedianSize = 5;
    p.fillOcclusions = true;
    if (preset == M::PRESET_TREE)
    {
        p.numLayers = 2;
        p.maxTopDisparities = 64;
        p.aggregation = M::AGGREGATION_TREE_SCANLINES;
        p.disparityPrior = M::PRIOR_UPPER_LAYER;
        p.intervalMargin = 2;
        p.delta0 = 0.02;
        p.beta = 0.9;
        return p;
    }

    p.aggregation = M::AGGREGATION_SCANLINES;
    p.treeStrategy = createSegmentTree();
    p.topAggregation = M::AGGREGATION_TREE_SCANLINES;
    p.maxTopDisparities = 32;
    if (preset == M::PRESET_ULTRAFAST)
        p.finestLayer = 1;
    if (preset == M::PRESET_QUALITY)
    {
        p.numLayers = 2;
        p.maxTopDisparities = 48;
        p.scanlinePasses = 2;
        p.disparityMedianSize = 7;
        p.disparityMedianPasses = 2;
    }
    return p;
}

template <typename T> void setParameter(MatcherParameters& parameters, T MatcherParameters::*parameter, const T& value)
{
    const ParameterSetter<T> setter = { parameters, parameter, value };
    visitParameters(setter);
}

template void setParameter(MatcherParameters&, int MatcherParameters::*, const int&);
template void setParameter(MatcherParameters&, double MatcherParameters::*, const double&);
template void setParameter(MatcherParameters&, bool MatcherParameters::*, const bool&);

void setTreeStrategy(MatcherParameters& parameters, const Ptr<TreeStrategy>& strategy)
{
    if (!strategy)
        CV_Error(Error::StsNullPtr, "treeStrategy must not be empty");
    parameters.treeStrategy = strategy;
}

void writeParameters(const MatcherParameters& parameters, FileStorage& fs)
{
    const ParameterWriter writer = { parameters, fs };
    visitParameters(writer);
    fs << "treeStrategy"
       << "{"
       << "strategy" << parameters.treeStrategy->getDefaultName();
    parameters.treeStrategy->write(fs);
    fs << "}";
    if (parameters.predictionModel)
    {
        fs << "predictionModel"
           << "{";
        parameters.predictionModel->write(fs);
        fs << "}";
    }
}

MatcherParameters readParameters(const FileNode& fn, const Ptr<TreeStrategy>& ownStrategy)
{
    MatcherParameters p;
    const ParameterReader reader = { fn, p };
    visitParameters(reader);
    p.treeStrategy = readStrategy(fn["treeStrategy"], ownStrategy);
    if (!fn["predictionModel"].empty())
    {
        p.predictionModel = DisparityPredictionModel::create();
        p.predictionModel->read(fn["predictionModel"]);
    }
    return p;
}

}}} // namespace cv::stereo::hdp
