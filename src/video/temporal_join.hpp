// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_JOIN_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_JOIN_HPP

#include "../cost/census_cost.hpp"
#include "temporal_prediction.hpp"

namespace cv { namespace stereo { namespace hdp {

// What the compiler needs of the constants of joinLastFrame()
const int joinFringe = 2; // pixels beside one that agrees: what disagrees there, where the motion leads, is measured;
                          // fewer leave a rim of the last frame, more drop what is right
const int maxJoinWeight = 4; // frames that a disparity counts for, at most: joinRow() divides by one more

//! What is known of a cell, for each of the two disparities that the last frame may have for it
enum TemporalEvidence
{
    COST_UNMOVED, // what it costs more than the measured one
    COST_MOVED,
    SCALE_UNMOVED, // what the measured one costs, and an offset
    SCALE_MOVED,
    EVIDENCE_CHANNELS
};

//! What a cell takes
enum TemporalChoice
{
    MEASURED,
    UNMOVED,
    MOVED,
    PLACES = 3, // mask of these
    KEPT = 4    // beside one of the last frame: its pixels that disagree with the measured ones take it, too
};

//! What costs of a row's pixels are compared of
struct ComparedRow
{
    const uchar *left, *right;        // CensusCost::leftPixels(), and rightPlane() for candidate 0 of the first pixel
    size_t planeStride;               // see CensusCost
    int planes, unseenCost;           // the cost of a match that the right image does not show
    const ushort *measured, *unmoved; // disparities, the second those of the frame before
};

//! What each pixel of a row takes, and what the camera's motion takes to it
struct TemporalRow
{
    explicit TemporalRow(int width)
        : disparity(width), detail(width), moved(width), different(width), compared(width), choices(width),
          agrees(width + 2 * joinFringe)
    {
    }
    std::vector<ushort> disparity; // of FrameMemory, as they were
    std::vector<uchar> detail;     // the same
    std::vector<int> moved;        // disparities now, of the pixels or cells
    std::vector<uchar> different;  // which sources of the cells have another disparity than the measured one
    std::vector<int> compared;     // cells that have such sources
    std::vector<uchar> choices;
    std::vector<uchar> agrees; // memory; on both sides of the row are joinFringe elements of 0
};

//! Which disparities of the frame before count as others, and what they may cost more: percent of the measured
//! disparity's scale, see TemporalEvidence. Distances are in units of a map.
struct ChoiceRule
{
    enum
    {
        KEEPS = 128, // in a share: what is taken is KEPT
        PERCENT = 127
    };
    int same;        // distance of disparities that are the same
    int maxDistance; // maxSourceDistance
    int near;        // distance from the measured one, up to which they are near
    int firstShare;  // of one that is near, and of a single frame,
    int nearShare;   // or of more frames
    int apartShare;  // of one that is not, per frame that has agreed with it; it is KEPT then
};

//! How disparities are joined, in FrameMemory's units
struct JoinRule
{
    int tolerance, maxStep;
    int maxWeight; // frames that the one before counts for, up to maxJoinWeight
};

/** Joins the disparities of a pair, before the median, with those of the frame before. Each pixel has up to three: the
measured one, that of the last frame at the same place, if the image stands still there, and that which the motion of
the camera takes there, if the image looks the same where it comes from. One of the last frame is kept unless the
measured one has lower costs in the window around, clearly lower ones if the two are near each other; of two, that which
moved, unless the other one costs no more. It moves towards the measured one if both agree, by less the more frames it
stands for; if not, it stands for fewer frames, in the end for none, and the measured one is taken. If that is so for
many of the pixels, the pair contradicts the last frame. What moved into sight of the right image is measured.
@param prediction What predictFrame() found.
@param next Receives what this frame leaves to the next one; nothing if the image is smaller than a cell, or the pair
contradicts the last frame.
@param disparity CV_16UC1, a disparity map; changed if the frame continues.
@return The prediction's verdict, or CONTRADICTED: the pair is to be matched again, as the first one of a video. */
CV_EXPORTS Verdict joinLastFrame(const CensusCost& cost, const FrameMemory& last, const FramePrediction& prediction,
                                 VideoScratch& scratch, FrameMemory& next, Mat& disparity);

/** Trusts what a video has seen for long: confidence v sqrt((n + 1) / (m + 1)), rounded, where n is the number of
frames that a disparity stands for and m the largest one of all pixels. A first frame keeps its confidence.
@param frame What the frame leaves to the next one.
@param confidence CV_8UC1 of its disparities, changed. */
CV_EXPORTS void trustStable(const FrameMemory& frame, Mat& confidence);

}}} // namespace cv::stereo::hdp

#endif
