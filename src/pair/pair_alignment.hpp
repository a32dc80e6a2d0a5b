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
struct AlignmentPlan
{
    int numDisparities;    // of the images
    int maxRowOffset;      // 0: rows stay
    bool findsLight;       // in grey levels alone
    double noiseThreshold; // noise of the finest layer above which a pair is smoothed, in levels of 255; 0: never
    int finestLayer;       // where matching ends

    bool looksForAnything() const { return maxRowOffset > 0 || findsLight || noiseThreshold > 0; }

    //! By how much the noise of the finest layer, whichever layer it was measured in, is above the threshold, in levels
    //! of 255; 0: it is not.
    CV_EXPORTS double excessNoise(const LayerNoise& noise) const;
    //! The weight of neighbours for smoothNoise(); 0: none
    CV_EXPORTS int smoothing(const LayerNoise& noise) const;
};

//! What was found in a pair, about the right image's centre, and what of it was applied
struct PairFindings : RowFindings
{
    LightModel light;
    bool hasLight = false;
};

//! What is known of a pair already, in the coordinates and levels of the pyramids
struct GivenPair
{
    bool isGiven = false;
    LevelFindings levels;
    PairFindings findings;
    ImageFrame frame; // what the models are about, in pixels of the image
};

//! Memory of alignPair(), kept from pair to pair
struct AlignmentBuffers
{
    CoarseMatches coarse;
    Mat leftLevels, rightLevels, right, mask;
    std::vector<LayerImages> smoothed;
};

//! The largest weight of a neighbour: that of the binomial filter 1 2 1
const int mostSmoothing = 64;

/** A separable filter of 3 x 3 pixels for the images of a noisy pair: along rows and columns each neighbour weighs so
many 1 / 256, the pixel the rest; the sum is rounded once.
@param image CV_16UC1, values up to 1023; its border is repeated.
@param neighbour That weight, 0..mostSmoothing. */
CV_EXPORTS void smoothNoise(const Mat& image, int neighbour, Mat& smoothed);

/** Gives the right image the rows and the light of the left one, from the finest layer on, if that is worth it, and
smooths the grey levels of noisy pairs. The guides stay.
@param images Those of buildPairPyramids(); they may change.
@param given What is known already, if it is given: nothing is looked for then. */
CV_EXPORTS void alignPair(const AlignmentPlan& plan, AlignmentBuffers& buffers, std::vector<LayerImages>& images,
                          PairFindings& findings, const GivenPair& given = GivenPair());

}}} // namespace cv::stereo::hdp

#endif
