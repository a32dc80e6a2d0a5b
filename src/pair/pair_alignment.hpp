// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PAIR_ALIGNMENT_HPP
#define OPENCV_HDPSTEREO_PAIR_ALIGNMENT_HPP

#include "light_alignment.hpp"
#include "pair_pyramids.hpp"
#include "row_alignment.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What alignPair() looks for
struct AlignmentSearch
{
    int numDisparities;    // of the images
    int maxRowOffset;      // 0: rows stay
    bool hasLight;         // of grey levels alone
    double noiseThreshold; // levels of 255 from which noisy images are smoothed; 0: never
    int finestLayer;       // where matching ends
};

//! What was found, about the right image's centre, and what of it was applied
struct PairAlignment
{
    RowModel rows;
    LightModel light;
    bool hasRows = false, hasLight = false;
    LayerNoise noise;
    bool isNoisy = false; // noise has reached the threshold
};

//! Memory of alignPair(), kept from pair to pair
struct AlignmentBuffers
{
    CoarseMatches coarse;
    Mat leftLevels, rightLevels, right;
    std::vector<LayerImages> smoothed;
};

/** Gives the right image the rows and the light of the left one, from the finest layer on, if that is worth it, and
smooths the grey levels of noisy pairs. The guides stay.
@param search What is looked for.
@param buffers Memory to work in.
@param images Those of buildPairPyramids(); they may change.
@param alignment Receives what was found. */
void alignPair(const AlignmentSearch& search, AlignmentBuffers& buffers, std::vector<LayerImages>& images,
               PairAlignment& alignment);

}}} // namespace cv::stereo::hdp

#endif
