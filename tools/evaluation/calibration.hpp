// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Whether what a matcher says of its errors is true

#ifndef OPENCV_HDPSTEREO_TOOLS_CALIBRATION_HPP
#define OPENCV_HDPSTEREO_TOOLS_CALIBRATION_HPP

#include <set>

#include "datasets.hpp"
#include "methods.hpp"
#include "tables.hpp"

namespace hdp_tools {

/** Of the pixels with a HDPTreeMatcher::getDisparitySigma() of some level, the share whose error is within it, by sets:
68 % if it is true.
@param method Whose matcher is an HDPTreeMatcher.
@param scenes With truth.
@param numDisparities 0: those of the dataset.
@param bad See forEachPair().
@return Without rows if no scene was matched. */
Table calibrationTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities,
                       std::set<String>& bad);

//! The curves of such a table as SVG, a line per set, over the percents that are aimed at
String calibrationPlot(const Table& table);

//! Pixels by their confidence
class ConfidenceErrors
{
public:
    ConfidenceErrors() : pixels_(256), wrong_(256) {}

    /** Adds the pixels of known truth.
    @param confidence CV_8UC1.
    @param disparity CV_32FC1 in pixels, not finite where there is none, which is wrong.
    @param truth As Pair::truth. */
    void add(const Mat& confidence, const Mat& disparity, const Mat& truth);

    // In percent, by the least confidence, 0 to 255.

    //! The pixels that have it; NO_SCORE if there are no pixels.
    double share(int least) const;
    //! Of these, the ones that are wrong by more than a pixel; NO_SCORE if they are too few.
    double wrong(int least) const;

private:
    std::vector<double> pixels_, wrong_;
};

//! What values of HDPTreeMatcher::getConfidence() mean, by sets; arguments as of calibrationTable().
Table confidenceErrorsTable(const Method& method, const std::vector<Scene>& scenes, int numDisparities,
                            std::set<String>& bad);

} // namespace hdp_tools

#endif
