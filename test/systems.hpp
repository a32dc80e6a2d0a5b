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

const System presetTree = { "PRESET_TREE", "tree", createPaperMST, true, false, HDPTreeMatcher::PRESET_TREE };

//! What the contract of the matcher is tested with: the systems of the paper and the presets
inline std::vector<System> allSystems()
{
    std::vector<System> systems(paperSystems, paperSystems + sizeof(paperSystems) / sizeof(paperSystems[0]));
    systems.push_back(presetTree);
    return systems;
}

inline void setSystem(HDPTreeMatcher& matcher, const System& system)
{
    matcher.setTreeStrategy(system.createTree());
    matcher.setUsePrediction(system.usePrediction);
    matcher.setUseMedianPrefilter(system.useMedianPrefilter);
}

//! The values of PRESET_TREE
inline void setPresetTree(HDPTreeMatcher& matcher)
{
    matcher.setMatchingCost(HDPTreeMatcher::COST_CENSUS);
    matcher.setBlockSize(7);
    matcher.setDisparityPrior(HDPTreeMatcher::PRIOR_UPPER_LAYER);
    matcher.setIntervalMargin(1);
    matcher.setDelta0(0.02);
    matcher.setBeta(0.9);
    matcher.setGamma(20);
    matcher.setUseSubpixel(true);
    matcher.setDisparityMedianSize(5);
    matcher.setDisparityMedianPasses(2);
}

//! The values of PRESET_PAPER that other presets change
inline void setPresetPaper(HDPTreeMatcher& matcher)
{
    matcher.setMatchingCost(HDPTreeMatcher::COST_COLOR_GRADIENT);
    matcher.setBlockSize(1);
    matcher.setDisparityPrior(HDPTreeMatcher::PRIOR_SUPPORT_POINTS);
    matcher.setIntervalMargin(0);
    matcher.setDelta0(HDPTreeMatcher::AUTO);
    matcher.setBeta(HDPTreeMatcher::AUTO);
    matcher.setGamma(25.5);
    matcher.setUseSubpixel(false);
    matcher.setDisparityMedianSize(HDPTreeMatcher::AUTO);
    matcher.setDisparityMedianPasses(1);
}

//! By setters alone, whatever was set before
inline void configure(HDPTreeMatcher& matcher, const System& system)
{
    if (system.preset == HDPTreeMatcher::PRESET_TREE)
        setPresetTree(matcher);
    else
        setPresetPaper(matcher);
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
