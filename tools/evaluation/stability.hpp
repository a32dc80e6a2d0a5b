// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What changes that must not matter do to a map: errors, the pixels that move, and where they are.

#ifndef OPENCV_HDPSTEREO_TOOLS_STABILITY_HPP
#define OPENCV_HDPSTEREO_TOOLS_STABILITY_HPP

#include <vector>

#include "harmless_changes.hpp"
#include "methods.hpp"
#include "scores.hpp"

namespace hdp_tools {

//! Pixels by the confidence that the map as it is has for them
struct ConfidenceCounts
{
    double pixels[256], unstable[256];

    ConfidenceCounts();
    void add(const ConfidenceCounts& other);

    //! Of the most confident pixels, in percent. part: their share of all. What has the same confidence is in no order.
    double unstableShare(double part) const;

    //! Pearson's correlation of the confidence with being unstable; NO_SCORE if one of them is always the same.
    double correlation() const;
};

//! Of a method on a pair. Errors are main scores, NO_SCORE without truth; shares are percentages, means over the changes.
struct Stability
{
    double cleanError;
    std::vector<double> errors;      // by change
    std::vector<double> cleanErrors; // by change: of the pair as it is, on the pixels that the change has left
    std::vector<double> unstable;    // by change: of the visible pixels, those that move by more than 1 pixel
    double bare, edge;               // of the visible pixels: unstable ones on bare surfaces, and at depth edges
    double inBlobs;                  // of the visible pixels: those in connected ones of more than 0.2 % of the image
    double occluded;                 // of the occluded pixels, the unstable ones
    ConfidenceCounts confidence;     // of the visible pixels, of all changes; nothing if the method has none

    //! The change with the largest error, the first of them; -1 if there is no error
    int worstChange() const;

    //! The change that makes the error so different that another map must have won: by more than 1.5 x and 1 point. The
    //! one with the largest ratio; -1 if there is none.
    int bistableChange() const;
};

Stability measureStability(const Method& method, const Pair& pair, const std::vector<HarmlessChange>& changes,
                           const String& scene);

// ---- The kinds of pixels

/** Pixels that both images show: the judged ones, of KITTI those that no nearer one hides. Without truth, the map as it
is says what hides what. */
Mat visiblePixels(const Pair& pair, const Mat& clean);

//! Pixels within 4 of a step of the truth: by more than 2 disparities, and by more than 1 for each pixel that it takes
Mat edgePixels(const Mat& truth);

//! Pixels without texture: levels change by at most 2 from column to column, mean of 9 x 9 pixels.
Mat barePixels(const Mat& image);

/** Pixels whose disparity moves by more than 1 pixel. Those that have none before or after are not among them.
@param clean Map of the pair as it is.
@param restored By restoreMap(). Of the mirror, the pixel of the right image which the map comes to is looked at. */
Mat unstablePixels(const HarmlessChange& change, const Mat& clean, const Mat& restored);

//! Those of a mask that are connected to more than this share of all its pixels, by sides or corners
Mat largeBlobs(const Mat& mask, double share);

} // namespace hdp_tools

#endif
