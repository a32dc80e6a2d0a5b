// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_OUTPUT_HPP
#define OPENCV_HDPSTEREO_DISPARITY_OUTPUT_HPP

#include "opencv2/hdpstereo/hdp_tree_matcher.hpp"

#include "../cost/matching_cost.hpp"
#include "../pair/disparity_ranges.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Bytes per pixel of the memory of cv::filterSpeckles, which counts them by int
const int speckleBytes = 9;

//! What outputDisparity() makes of the finest layer
struct OutputPlan
{
    int minDisparity;
    int extension;   // columns of the layers that the image does not have, in pixels of the image
    int finestLayer; // 0: the image
    bool isWhole;    // whether disparities are rounded to whole pixels
    int disp12MaxDiff, speckleWindowSize, speckleRange; // as of cv::StereoMatcher; <= 0: no filter
};

//! All pixels that are invalid after outputDisparity() has rejected some for a reason
struct Rejected
{
    HDPTreeMatcher::Reason reason;
    Mat pixels; // CV_8UC1, 255 where
};

//! Memory that is kept from pair to pair
struct OutputBuffers
{
    std::vector<Rejected> rejected; // in the order of what was done; empty if nothing could be
    std::vector<Mat> enlarged;
    Mat whole, fixedPoint, speckles;
};

//! The depth of the map: that of the caller's array, if its type is fixed. Throws if the map cannot be written there.
int depthOfOutput(OutputArray disparity, Size size, int usual);

//! The map of a layer of this size from that of the one above: bilinear inside a surface, its pixel's own at its border
CV_EXPORTS void upsampleDisparity(const Mat& upper, Size size, Mat& disparity);

/** From the disparities of the finest layer to what cv::StereoMatcher promises: those of every pixel of the image, from
minDisparity on, less those without data and what the left-right check and the speckle filter reject.
@param finest CV_16UC1 of the finest layer's size, a disparity map.
@param buffers Memory to work in; receives what was rejected.
@param disparity CV_16SC1 or CV_32FC1 of the image's size; receives the result.
@param mask Of the image, CV_8UC1, 0 where it has no data; empty: it has everywhere.
@param ranges What each pixel may have: the nearest of that, or nothing. */
CV_EXPORTS void outputDisparity(const Mat& finest, const OutputPlan& plan, OutputBuffers& buffers, Mat& disparity,
                                const Mat& mask = Mat(), const PixelRanges& ranges = PixelRanges());

//! By how much outputDisparity() moves disparities into the ranges of their pixels, in pixels: CV_32FC1 of the image's
//! size
CV_EXPORTS Mat movedIntoRanges(const Mat& finest, const OutputPlan& plan, Size size, const PixelRanges& ranges);

/** Whether the right image shows the pixels of a layer: REASON_MATCHED, REASON_OCCLUDED or REASON_OUTSIDE, see
HDPTreeMatcher::Reason, CV_8UC1.
@param disparity,limits Of the layer: pixels without data hide none.
@param plan Where the layer lies in the image.
@param width Of the image. */
CV_EXPORTS void findReasons(const Mat& disparity, const OutputPlan& plan, int width, const CostLimits& limits,
                            Mat& reasons);

}}} // namespace cv::stereo::hdp

#endif
