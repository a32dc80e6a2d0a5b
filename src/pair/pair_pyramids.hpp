// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PAIR_PYRAMIDS_HPP
#define OPENCV_HDPSTEREO_PAIR_PYRAMIDS_HPP

#include "block_smoothing.hpp"
#include "image_levels.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Largest width and height of an image: cv::filterSpeckles has 16-bit coordinates, and edges are numbered by int.
const int maxSide = SHRT_MAX;

//! Throws cv::Exception if the images are no pair that can be matched.
void checkPair(const Mat& left, const Mat& right);

//! What the stages see of a layer
struct LayerImages
{
    Mat colours;     // of the left image, or its grey levels, in 8 bits
    Mat guide;       // gives the edge weights: the colours, or the grey levels of greyLevels() where there are none
    Mat left, right; // give the matching cost; a candidate counts from minDisparity
    PairMasks masks; // of both
};

//! What there is to know of the levels of a pair
struct LevelFindings
{
    LevelScale scale;
    bool isGrey = false;               // whether the left image has no colours
    BlockGrid leftBlocks, rightBlocks; // of JPEG compression
};

//! Memory of the pyramids of an image
struct ImagePyramids
{
    Mat moved, bytes, levels;
    std::vector<Mat> colours, matched, mask; // no colours of the right image
};

//! Memory of the pyramids of a pair, kept from pair to pair
struct PairPyramids
{
    ImagePyramids left, right;
    LevelFindings levels; // found, or given
};

//! What buildPairPyramids() builds
struct PyramidPlan
{
    int minDisparity;   // what candidate 0 stands for
    int extension;      // columns added on the left of both images, so that the first ones have their matches if
                        // disparities are negative; a multiple of 2^(layers - 1)
    int layers;         // their number
    bool isCensus;      // whether the matching cost gets grey levels, see greyLevels(), instead of byteLevels()
    bool smoothsBlocks; // of grey levels, see smoothBlocks()
    int wholeWidth;     // of the image that the pair is a tile of; 0: its own
    bool findsEnds;     // of the levels, see findEnds(); those of floats are known
};

/** The pyramids of a pair (section 2.1), for candidates that count from 0. For the census, a pair of low contrast is
stretched, see findEnds(), and a dark one brightened, see findBrightness(): what counts in levels, as edges, noise and
thresholds do, is then as if it were well exposed.
@param left,right CV_8UC1, CV_8UC3, CV_8UC4 or CV_16UC1.
@param masks Theirs; what has no data does not count where levels are.
@param pyramids Memory to work in; receives what was found.
@param given What is known already: nothing is looked for then. */
CV_EXPORTS void buildPairPyramids(const Mat& left, const Mat& right, const PairMasks& masks, const PyramidPlan& plan,
                                  PairPyramids& pyramids, std::vector<LayerImages>& images,
                                  const LevelFindings* given = nullptr);

//! An image with more columns on the left, the right one moved by minDisparity, so that candidates count from 0:
//! shifted(x + extension) = image(x - minDisparity), the nearest column where there is none. Itself if it stays.
CV_EXPORTS Mat shiftColumns(const Mat& image, int minDisparity, int extension, Mat& memory);

}}} // namespace cv::stereo::hdp

#endif
