// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_PLAN_TEXT_HPP
#define OPENCV_HDPSTEREO_TEST_PLAN_TEXT_HPP

#include "test_precomp.hpp"
#include "../src/plan/pair_plan.hpp"

namespace opencv_test {

//! All members of a plan: two plans are equal if their texts are. A new member belongs here;
//! HDPStereo_Plan.every_parameter_has_an_effect fails if one is missed that a parameter decides.
inline std::string textOf(const hdp::LayerPlan& p)
{
    std::ostringstream text;
    text << "layer " << p.layer << " top " << p.isTop << " finest " << p.isFinest << " disparities " << p.numDisparities
         << " max " << p.maxDisparity << " fractions " << p.hasFractions << " method " << (int)p.method << "\n  cost "
         << p.cost.isCensus << " " << p.cost.windowSide << " tolerance " << p.cost.tolerance << " truncation "
         << p.cost.colorGradient.colorTruncation << " " << p.cost.colorGradient.gradientTruncation << " weight "
         << p.cost.colorGradient.colorWeight << " sees below " << p.seesBelow << " smooths guide " << p.smoothsGuide
         << "\n  trees: prior " << (int)p.trees.prior << " upper " << p.trees.upperDisparities << " delta "
         << p.trees.delta << " margin " << p.trees.margin << " beta " << p.trees.beta << " links " << p.trees.linksTrees
         << " gamma " << p.trees.gamma << " refinement " << p.trees.refinementGamma << "\n  volume "
         << p.volumePenalties.small << " " << p.volumePenalties.large << " " << p.volumePenalties.gamma << " range "
         << p.rangePenalties.small << " " << p.rangePenalties.large << " " << p.rangePenalties.leastLarge << " "
         << p.rangePenalties.gamma << " " << p.rangePenalties.priorDistance << " " << p.rangePenalties.maxPrior
         << "\n  passes";
    for (const hdp::ScanlinePenalties& pass : p.passes)
        text << " [" << pass.small << " " << pass.large << " slopes " << pass.edgeSlope << " " << pass.borderSlope
             << " prior " << pass.prior << " nearer " << pass.nearer << " noise " << pass.edgeNoise << "]";
    text << " smoothness " << p.smoothness.radius << " " << p.smoothness.least << " " << p.smoothness.most
         << "\n  checks last frame " << p.checksLastFrame << " prefers it " << p.prefersLastFrame << " fills "
         << p.fillsOcclusions << " median " << p.medianSize << " thin structures " << p.restoresThinStructures
         << " votes " << p.votesAtEdges << " smooths " << p.surfaceDifference << " noise " << p.noise << "\n";
    return text.str();
}

inline std::string textOf(const hdp::PairPlan& p)
{
    std::ostringstream text;
    text << p.size << " pyramids " << p.pyramids.minDisparity << " " << p.pyramids.extension << " " << p.pyramids.layers
         << " " << p.pyramids.isCensus << " " << p.pyramids.smoothsBlocks << "\nalignment "
         << p.alignment.numDisparities << " " << p.alignment.maxRowOffset << " " << p.alignment.findsLight << " "
         << p.alignment.noiseThreshold << " " << p.alignment.finestLayer << " ranges " << p.hasRanges << " prior "
         << p.hasPrior << " follows video " << p.followsVideo << " looks for range " << p.looksForRange << "\nstrategy "
         << (void*)p.treeStrategy.get() << " model " << (p.predictionModel ? p.predictionModel->getNumLayers() : 0)
         << "\noutput " << p.output.minDisparity << " " << p.output.extension << " " << p.output.finestLayer << " "
         << p.output.isWhole << " " << p.output.disp12MaxDiff << " " << p.output.speckleWindowSize << " "
         << p.output.speckleRange << "\n";
    const hdp::ImageFrame& frame = p.given.frame;
    text << "given " << p.given.isGiven << " frame " << frame.whole << " " << frame.origin << "\n";
    for (const hdp::LayerPlan& layer : p.layers)
        text << textOf(layer);
    return text.str();
}

} // namespace opencv_test

#endif
