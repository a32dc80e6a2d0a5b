// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_SYSTEMS_HPP
#define OPENCV_HDPSTEREO_TEST_SYSTEMS_HPP

#include "test_precomp.hpp"

namespace opencv_test {

//! A system of the paper's tables, or a preset
struct System
{
    const char* name;
    const char* fileName;
    Ptr<TreeStrategy> (*createTree)();
    bool usePrediction, useMedianPrefilter;
    int preset;

    bool isRandom() const { return std::string(name).find("RT") != std::string::npos; }
};

inline void PrintTo(const System& system, std::ostream* out) { *out << system.name; }

inline Ptr<TreeStrategy> createPaperMST() { return createMinimumSpanningTree(); }
inline Ptr<TreeStrategy> createPaperST() { return createSegmentTree(); }
inline Ptr<TreeStrategy> createPaperRT() { return createRandomTree(); }

const System paperSystems[] = {
    { "HDP+MST", "hdp_mst", createPaperMST, true, false, HDPTreeMatcher::PRESET_PAPER },
    { "HDP+ST", "hdp_st", createPaperST, true, false, HDPTreeMatcher::PRESET_PAPER },
    { "HDP+RT", "hdp_rt", createPaperRT, true, false, HDPTreeMatcher::PRESET_PAPER },
    { "MST", "mst", createPaperMST, false, false, HDPTreeMatcher::PRESET_PAPER },
    { "ST", "st", createPaperST, false, false, HDPTreeMatcher::PRESET_PAPER },
    { "RT", "rt", createPaperRT, false, false, HDPTreeMatcher::PRESET_PAPER },
    { "M+MST", "m_mst", createPaperMST, false, true, HDPTreeMatcher::PRESET_PAPER },
    { "M+ST", "m_st", createPaperST, false, true, HDPTreeMatcher::PRESET_PAPER },
    { "M+RT", "m_rt", createPaperRT, false, true, HDPTreeMatcher::PRESET_PAPER },
};

const System presetPaper = paperSystems[0];
const System presetFast = { "PRESET_FAST", "fast", createPaperST, true, false, HDPTreeMatcher::PRESET_FAST };
const System presetUltrafast = {
    "PRESET_ULTRAFAST", "ultrafast", createPaperST, true, false, HDPTreeMatcher::PRESET_ULTRAFAST
};
const System presetQuality = {
    "PRESET_QUALITY", "quality", createPaperST, true, false, HDPTreeMatcher::PRESET_QUALITY
};
const System presetTree = { "PRESET_TREE", "tree", createPaperMST, true, false, HDPTreeMatcher::PRESET_TREE };

const System presets[] = { presetPaper, presetFast, presetUltrafast, presetQuality, presetTree };

//! What the contract of the matcher is tested with: the systems of the paper and the presets
inline std::vector<System> allSystems()
{
    std::vector<System> systems(std::begin(paperSystems), std::end(paperSystems));
    systems.insert(systems.end(), std::begin(presets) + 1, std::end(presets)); // the first is one of the paper's
    return systems;
}

inline void setSystem(HDPTreeMatcher& matcher, const System& system)
{
    matcher.setTreeStrategy(system.createTree());
    matcher.setUsePrediction(system.usePrediction);
    matcher.setUseMedianPrefilter(system.useMedianPrefilter);
}

//! The values of a preset, whatever was set before
inline void setPreset(HDPTreeMatcher& matcher, int preset)
{
    const bool isPaper = preset == HDPTreeMatcher::PRESET_PAPER, isTree = preset == HDPTreeMatcher::PRESET_TREE;
    const bool hasScanlines = !isPaper && !isTree;
    matcher.setMatchingCost(isPaper ? HDPTreeMatcher::COST_COLOR_GRADIENT : HDPTreeMatcher::COST_CENSUS);
    matcher.setBlockSize(isPaper ? 1 : 7);
    matcher.setGamma(isPaper ? 25.5 : 20);
    matcher.setUseSubpixel(!isPaper);
    const bool isQuality = preset == HDPTreeMatcher::PRESET_QUALITY;
    matcher.setDisparityMedianSize(isPaper ? (int)HDPTreeMatcher::AUTO : isQuality ? 7 : 5);
    matcher.setDisparityMedianPasses(preset == HDPTreeMatcher::PRESET_QUALITY ? 2 : 1);
    matcher.setAggregation(hasScanlines ? HDPTreeMatcher::AGGREGATION_SCANLINES
                           : isTree     ? HDPTreeMatcher::AGGREGATION_TREE_SCANLINES
                                        : HDPTreeMatcher::AGGREGATION_TREES);
    matcher.setTopAggregation(hasScanlines ? HDPTreeMatcher::AGGREGATION_TREE_SCANLINES
                                           : HDPTreeMatcher::AGGREGATION_TREES);
    matcher.setNumLayers(isQuality || isTree ? 2 : 3);
    matcher.setMaxTopDisparities(isPaper ? 0 : isTree ? 64 : isQuality ? 48 : 32);
    matcher.setMaxRowOffset(isPaper ? 0 : 64);
    matcher.setUseLightAlignment(!isPaper);
    matcher.setNoiseThreshold(isPaper ? 0 : 3);
    matcher.setFinestLayer(preset == HDPTreeMatcher::PRESET_ULTRAFAST ? 1 : 0);
    matcher.setDisparityPrior(isTree ? HDPTreeMatcher::PRIOR_UPPER_LAYER : HDPTreeMatcher::PRIOR_SUPPORT_POINTS);
    matcher.setIntervalMargin(isTree ? 2 : 0);
    matcher.setDelta0(isTree ? 0.02 : (double)HDPTreeMatcher::AUTO);
    matcher.setBeta(isTree ? 0.9 : (double)HDPTreeMatcher::AUTO);
    matcher.setP1(16);
    matcher.setP2(65);
    matcher.setScanlinePasses(preset == HDPTreeMatcher::PRESET_QUALITY ? 2 : 1);
    matcher.setUseNonLocalRefinement(false);
    matcher.setUseTemporalPrediction(false);
    matcher.setFillOcclusions(!isPaper);
}

//! By setters alone, whatever was set before
inline void configure(HDPTreeMatcher& matcher, const System& system)
{
    setPreset(matcher, system.preset);
    setSystem(matcher, system);
}

inline Ptr<HDPTreeMatcher> createSystem(const System& system, int numDisparities, int minDisparity = 0)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, numDisparities, system.preset);
    setSystem(*matcher, system);
    return matcher;
}

//! A limit for each system, by its name, from a table in their order
inline double limitOf(const System& system, const double (&limits)[9])
{
    for (int i = 0; i < 9; ++i)
        if (std::string(paperSystems[i].name) == system.name)
            return limits[i];
    CV_Error(Error::StsBadArg, "no such system");
}

} // namespace opencv_test

#endif
