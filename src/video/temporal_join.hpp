// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_JOIN_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_JOIN_HPP

#include "../cost/census_cost.hpp"
#include "temporal_sources.hpp"

namespace cv { namespace stereo { namespace hdp {

//! The constants of joinLastFrame()
struct TemporalJoin
{
    enum
    {
        window = 7,        // side of the square that costs are compared over, in cells
        sameDisparity = 1, // in pixels: costs of disparities no farther apart are not compared
        costOffset = 6,    // in bits of a census of 24
        keptShare = 26,  // percent of the measured disparity's cost, and costOffset, by which the last frame's may cost
        movedShare = 60, // more; the same if the camera moved. A wrong pair contradicts its neighbours by more than
        wrongShare = 33, // this, which also limits what the second frame takes from the first one
        contradictedShare = 30, // percent of the cells with a source: if more of them contradict, a pair was wrong
        fringe = 2,          // pixels beside one that agrees: what disagrees there, where the motion leads, is measured
        driftStep = 12,      // from a cell that corrects the predicted disparities to the next
        tolerance = 4,       // between disparities that agree, in pixels of the image
        maxStep = 1,         // towards the measured disparity, before it is divided by the weight, in pixels
        maxCount = 4,        // frames that a disparity may stand for
        maxUnmovedCount = 2, // and for its weight, if the camera moved: a disparity at the same place,
        maxMovedCount = 1    // and one where the motion leads
    };
};

//! Of a cell, for the two disparities that the last frame may have for it
enum TemporalEvidence
{
    COST_UNMOVED, // what it costs more than the measured one
    COST_MOVED,
    SCALE_UNMOVED, // what the measured one costs, and costOffset
    SCALE_MOVED,
    EVIDENCE_CHANNELS
};

//! What a cell takes
enum TemporalChoice
{
    MEASURED,
    UNMOVED,
    MOVED
};

//! What costs of a row's pixels are compared of
struct ComparedRow
{
    const uchar *left, *right;        // CensusCost::leftPixels(), and rightPlane() for candidate 0 of the first pixel
    size_t planeStride;               // see CensusCost
    int planes, unseenCost;           // the cost of a match that the right image does not show
    const ushort *measured, *unmoved; // disparities, the second those of the frame before
};

//! What each pixel of a row takes, and what the frame before has for it
struct TemporalRow
{
    uchar* agrees; // memory; on both sides of the row are TemporalJoin::fringe elements of 0
    const uchar* choices;
    const int *unmoved, *moved; // disparities
    const uchar *unmovedCounts, *movedCounts;
};

//! How disparities are joined, in TemporalFrame's units; see TemporalJoin.
struct JoinRule
{
    int tolerance, maxStep, maxUnmovedWeight, maxMovedWeight, maxCount;
};

/** Joins the disparities of a pair, before the median, with those of the frame before. Each pixel has up to three: the
measured one, that of the last frame at the same place, if the image stands still there, and that which the motion of
the camera takes there, if the image looks the same where it comes from. One of the last frame is kept unless the
measured one has clearly lower costs in the window around. It moves towards the measured one if both agree, by less the
more frames it stands for; if not, it stands for fewer frames, in the end for none, and the measured one is taken. If
that is so for many of the pixels, the video begins anew.
@param cost The layer's census cost.
@param state What followVideo() found; this frame becomes the last one.
@param disparity CV_16UC1, a disparity map; changed. */
CV_EXPORTS void joinLastFrame(const CensusCost& cost, TemporalState& state, Mat& disparity);

}}} // namespace cv::stereo::hdp

#endif
