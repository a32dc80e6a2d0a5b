// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Videos of which not all is as temporal prediction expects it.

#ifndef OPENCV_HDPSTEREO_TOOLS_VIDEO_VARIANTS_HPP
#define OPENCV_HDPSTEREO_TOOLS_VIDEO_VARIANTS_HPP

#include <vector>

#include "pair.hpp"

namespace hdp_tools {

//! A frame of a variant: which one of the recorded frames it is, and what is done with it
struct VariantFrame
{
    int index;               // of the recorded frame
    double gain = 1;         // of the levels of both images
    double noise = 0;        // standard deviation of noise in both images, in levels of 255
    int rows = 0;            // that the picture moves down by, in both images
    int rightRows = 0;       // that the right image moves down by, beside that
    bool isReversed = false; // upside down: another scene, whose truth is known
    cv::Rect part;           // of the picture, which is shown alone; empty: all of it

    explicit VariantFrame(int recorded = 0) : index(recorded) {}
};

struct VideoVariant
{
    String name;
    std::vector<VariantFrame> frames;
};

/** Variants of a recorded video.

- recorded: as it is; every2, every3, every4: with so much more motion between frames; reversed; random: in random
  order; three-times: each frame three times
- exposure.7, exposure.5: each second frame is so much darker; fade: to black and back; noise15: each third frame is
  noisy, its standard deviation is the number
- foreign: each fifth frame is of another scene, which is the video upside down; shake6: each second frame is so many
  rows lower; rows3: the right image of each second frame is

@param list Names, separated by commas; all of them if it is empty.
@param frames Number of recorded frames. */
std::vector<VideoVariant> selectVariants(const String& list, int frames);

/** A pair as the video of a camera that pans over it: parts of one size, which move by a step in pixels from frame to
frame. So the truth of the pair is that of each frame.
@param index Of the recorded frame.
@param size Of the images.
@param step In pixels, to the right and down.
@param frames Their number. */
std::vector<VariantFrame> panOver(int index, const cv::Size& size, const cv::Point& step, int frames);

//! Does with a recorded frame what a variant does with it.
void changeFrame(const VariantFrame& frame, cv::RNG& rng, Pair& pair);

} // namespace hdp_tools

#endif
