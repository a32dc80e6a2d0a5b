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
const System presetTree = { "PRESET_TREE", "tree", createPaperST, true, false, HDPTreeMatcher::PRESET_TREE };

const System presets[] = { presetPaper, presetFast, presetUltrafast, presetQuality, presetTree };

//! What the contract of the matcher is tested with: the systems of the paper and the presets
inline std::vector<System> allSystems()
{
    std::vector<System> systems(std::begin(paperSystems), std::end(paperSystems));
    systems.insert(systems.end(), std::begin(presets) + 1, std::end(presets)); // the first is one of the paper's
    return systems;
}

inline HDPTreeMatcher::Params paramsOf(const System& system)
{
    HDPTreeMatcher::Params params(system.preset);
    params.treeStrategy = system.createTree();
    params.usePrediction = system.usePrediction;
    params.useMedianPrefilter = system.useMedianPrefilter;
    return params;
}

inline Ptr<HDPTreeMatcher> createSystem(const System& system, int numDisparities, int minDisparity = 0)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparity, numDisparities, system.preset);
    matcher->setParams(paramsOf(system));
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
