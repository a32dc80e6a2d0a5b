// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Changes of a pair that must not matter: the scene is the same, and so should be the map. By means over them, what an
// idea is worth can be told from what single decisions did by luck.

#ifndef OPENCV_HDPSTEREO_TOOLS_HARMLESS_CHANGES_HPP
#define OPENCV_HDPSTEREO_TOOLS_HARMLESS_CHANGES_HPP

#include <vector>

#include "bad_cameras.hpp"
#include "pair.hpp"

namespace hdp_tools {

struct HarmlessChange
{
    String name;        // for --changes, and in the tables
    ImageChange levels; // of each image, if not null
    int left, top;      // columns and rows that are cut off
    int move;           // columns to the right and rows down, by which both images move
    double scale;       // of width and height
    bool isFlipped;     // upside down
    bool isMirrored;    // left to right; the images are exchanged, as in a mirror
    int moreDisparities;

    HarmlessChange();
};

/** The changes of a list of names that is separated by commas, in this order; each once. A name with a number takes any
other number, too.

- noise.5: Gaussian noise of this standard deviation, in levels, in both images
- gamma1.05, gamma.95: of both images
- jpeg95: both images by this quality
- left1, left2, left4, left8: so many columns are cut off both images at the left
- top1, top2, top4: so many rows are cut off at the top
- move1: both images are moved right by so many columns and down by as many rows; their borders are repeated
- scale.98: width and height of both images times this
- flip: both images upside down
- mirror: both images left to right, and exchanged: the map is that of the right image
- range1, range16: so many disparities more
- bits12: grey levels of so many bits, from colours whose bits below the eighth are random; OpenCV's matchers get the
  upper eight
- clean: the pair as it is, to have it among the others

Noise and random bits are the same in every run: they start from the names of scene and change.

@param option The name of the option, for messages.
*/
std::vector<HarmlessChange> selectChanges(const String& option, const String& list);

//! Those of --changes=LIST; all 18 for --changes alone. None without the option, and if it has no default.
std::vector<HarmlessChange> selectChanges(const cv::CommandLineParser& parser);

//! The names of the 18 changes above; "clean" is none.
extern const char* const ALL_CHANGES;

/** Images and disparities of the changed pair; its truth is empty. Pictures of 16 bit become those of 8 bit first.
@param scene What the noise starts from. */
Pair changePair(const HarmlessChange& change, const Pair& pair, const String& scene);

/** Brings a map of the changed pair back to the frame of the pair: that of the left image, or of the right one if the
change is the mirror. Pixels that were cut off have no disparity. */
Mat restoreMap(const HarmlessChange& change, const Mat& disparity, cv::Size size);

//! As restoreMap() for any picture; pixels that were cut off are 0.
Mat restorePicture(const HarmlessChange& change, const Mat& picture, cv::Size size);

//! Pixels that the change has left, with what the right image shows of them. disparity: of the pair's left image.
Mat keptPixels(const HarmlessChange& change, const Mat& disparity);

/** What a restored map is judged by: the truth of the pair, and the judged pixels that the change has left. Of the
mirror: the truth of the right image. Where the set has none, this is the left truth, as the right image sees it: only
pixels that the left image shows, too, are judged. Fails if no pixel is left. */
Pair truthOfChanged(const HarmlessChange& change, const Pair& pair);

//! What the right image sees of the pixels of a map: of those that come to one pixel, the nearest.
Mat warpToRight(const Mat& disparity, const Mat& pixels);

} // namespace hdp_tools

#endif
