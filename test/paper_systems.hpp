// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_PAPER_SYSTEMS_HPP
#define OPENCV_HDPSTEREO_TEST_PAPER_SYSTEMS_HPP

#include "test_precomp.hpp"

namespace opencv_test {

//! A system of the paper's tables.
struct PaperSystem
{
    const char* name;
    const char* fileName;
    Ptr<TreeStrategy> (*createTree)();
    bool usePrediction, useMedianPrefilter;

    bool isRandom() const { return std::string(name).find("RT") != std::string::npos; }
};

inline void PrintTo(const PaperSystem& system, std::ostream* out) { *out << system.name; }

inline Ptr<TreeStrategy> createPaperMST() { return createMinimumSpanningTree(); }
inline Ptr<TreeStrategy> createPaperST() { return createSegmentTree(); }
inline Ptr<TreeStrategy> createPaperRT() { return createRandomTree(); }

const PaperSystem paperSystems[] = {
    { "HDP+MST", "hdp_mst", createPaperMST, true, false }, { "HDP+ST", "hdp_st", createPaperST, true, false },
    { "HDP+RT", "hdp_rt", createPaperRT, true, false },    { "MST", "mst", createPaperMST, false, false },
    { "ST", "st", createPaperST, false, false },           { "RT", "rt", createPaperRT, false, false },
    { "M+MST", "m_mst", createPaperMST, false, true },     { "M+ST", "m_st", createPaperST, false, true },
    { "M+RT", "m_rt", createPaperRT, false, true },
};

//! By setters alone
inline void configure(HDPTreeMatcher& matcher, const PaperSystem& system)
{
    matcher.setTreeStrategy(system.createTree());
    matcher.setUsePrediction(system.usePrediction);
    matcher.setUseMedianPrefilter(system.useMedianPrefilter);
}

inline Ptr<HDPTreeMatcher> createSystem(const PaperSystem& system, int numDisparities)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, HDPTreeMatcher::PRESET_PAPER);
    configure(*matcher, system);
    return matcher;
}

//! A limit for each system, by its name, from a table in their order
inline double limitOf(const PaperSystem& system, const double (&limits)[9])
{
    for (int i = 0; i < 9; ++i)
        if (std::string(paperSystems[i].name) == system.name)
            return limits[i];
    CV_Error(Error::StsBadArg, "no such system");
}

} // namespace opencv_test

#endif
