// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP
#define OPENCV_HDPSTEREO_TEMPORAL_PREDICTION_HPP

#include "camera_motion.hpp"
#include "census_cost.hpp"
#include "disparity_units.hpp"

namespace cv {
namespace stereo {
namespace hdp {

//! The constants of joinLastFrame()
struct TemporalJoin
{
    enum
    {
        cell = 2,            // side of the squares that decide together, in pixels
        block = 8,           // side of the squares that move together, in pixels
        window = 7,          // side of the square that costs are compared over, in cells
        sameDisparity = 1,   // in pixels: costs of disparities no farther apart are not compared
        costOffset = 8,      // in bits of a census of 24, see the next three
        stillShare = 40,     // percent of the measured disparity's cost, and costOffset, by which that of the last
        unmovedShare = 60,   // frame's may be larger: with a camera at rest; at the same place with one that moved;
        movedShare = 26,     // where its motion leads
        tolerance = 4,       // between disparities that agree, in pixels of the image
        maxStep = 1,         // towards the measured disparity, before it is divided by the weight, in pixels
        maxCount = 4,        // frames that a disparity may stand for
        maxUnmovedCount = 2, // and for its weight, if the camera moved: a disparity at the same place,
        maxMovedCount = 1,   // and one where the motion leads
        stillness = 3,       // grey levels by which a cell that stands still changes less
        noiseFactor = 4,     // with a camera at rest: it changes less than this times the median of all
        contrastShare = 70,  // or than this percentage of the contrast around
        cutShare = 60        // percent of its contrast by which a coarse image changes at a cut
    };
};

//! What a frame leaves to the next
struct TemporalFrame
{
    Mat disparity;         // CV_16UC1, a disparity map; empty: there is no such frame
    Mat detail;            // CV_8UC1: four more bits of each disparity, and the number of frames it stands for
    std::vector<Mat> grey; // CV_8UC1: the pyramid of the left image from cells on

    enum
    {
        detailBits = 4,
        countMask = (1 << detailBits) - 1,
        scale = subpixelScale << detailBits // of disparities with all their bits: means over frames need them
    };
    static CV_ALWAYS_INLINE int finer(int disparity, int detail)
    {
        return (disparity << detailBits) + (detail >> detailBits) - (1 << (detailBits - 1)); // they were rounded
    }
};

//! How the motion of the camera changes the disparity of what is now at (x, y):
//! before = now / (ofX x + ofY y + ofDisparity now + constant). Disparities are in pixels.
struct DisparityChange
{
    float ofX, ofY, ofDisparity, constant;
    float minDisparity, largest; // of a map, which counts from minDisparity; the next two do as well

    CV_ALWAYS_INLINE float ofRow(int y) const { return ofY * y + constant; }
    //! place: ofX x + ofRow(y)
    CV_ALWAYS_INLINE float now(float before, float place) const
    {
        const float old = before + minDisparity, w = 1 - ofDisparity * old;
        const float positive = w > 0.1f ? w : 0.1f; // less is at the camera or behind it
        const float disparity = old * place / positive - minDisparity;
        const float notNegative = disparity > 0 ? disparity : 0;
        return notNegative < largest ? notNegative : largest;
    }
};

//! How disparities are joined, in TemporalFrame's units; see TemporalJoin.
struct JoinRule
{
    int tolerance, maxStep, maxWeight, maxCount;
};

//! What the disparities of a map stand for
struct TemporalLayer
{
    int scale;           // pixels of the image in a side of a pixel
    double minDisparity; // that a map counts from, in pixels of the layer
    int largest;         // of a map, in its units

    bool operator==(const TemporalLayer& other) const
    {
        return scale == other.scale && minDisparity == other.minDisparity && largest == other.largest;
    }
};

//! What joinLastFrame() knows of the video, and memory that is kept from pair to pair
struct TemporalState
{
    TemporalFrame last, next;
    TemporalLayer layer = TemporalLayer(); // of the last frame
    CameraMotion motion;                   // to the last frame, in pixels of the layer

    std::vector<TrackedPoint> points;
    Mat halved;
    Mat shifts;   // CV_16SC2 of blocks: from a pixel to where it was
    Mat sources;  // CV_8UC1 of cells
    Mat evidence; // CV_16SC4 of cells
    Mat choices;  // CV_8UC1 of cells
    Mat smooth[2], change[2], contrast[2];

    //! Forgets the last frame.
    void clear() { last.disparity.release(); }
};

/** Joins the disparities of a pair, before the median, with those of the frame before. Each pixel has up to three: the
measured one, that of the last frame at the same place, if the image stands still there, and that which the motion of the
camera takes there. One of the last frame is kept unless the measured one has clearly lower costs in the window around. It
moves towards the measured one if both agree, by less the more frames it stands for; if not, it stands for fewer frames,
in the end for none, and the measured one is taken.

The first frame, one of another size or range, and one that shows another scene begin anew.
@param left The layer's left image, see greyLevels().
@param cost The layer's census cost.
@param layer What the disparities stand for.
@param state What is known of the video; changed.
@param disparity CV_16UC1, a disparity map; changed. */
CV_EXPORTS void joinLastFrame(const Mat& left, const CensusCost& cost, const TemporalLayer& layer, TemporalState& state,
                              Mat& disparity);

} // namespace hdp
} // namespace stereo
} // namespace cv

#endif
