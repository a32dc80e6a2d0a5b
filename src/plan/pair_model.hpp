// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SRC_PAIR_MODEL_HPP
#define OPENCV_HDPSTEREO_SRC_PAIR_MODEL_HPP

#include "opencv2/hdpstereo/pair_model.hpp"

#include "../pair/pair_alignment.hpp"
#include "../pair/missing_pixels.hpp"
#include "../pair/pair_pyramids.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What a PairModel says, in the coordinates and levels of the pyramids
struct GivenPair
{
    bool isGiven = false;
    LevelFindings levels;
    GivenAlignment alignment;
};

//! Throws if a value is not valid. An empty model is.
CV_EXPORTS void checkPairModel(const PairModel& model);

//! Throws if a model that is not empty is of other images.
void checkPairModelOf(const PairModel& model, Size size, int type, int layers);

//! Size of the images that a model is of; size, if it is empty
inline Size wholeSize(const PairModel& model, Size size)
{
    return model.empty() ? size : Size(model.width, model.height);
}

//! From a model to what it says of a pair, and what is the frame of the pair's images without a model
CV_EXPORTS GivenPair toGivenPair(const PairModel& model, const PyramidPlan& plan, Size size);

/** From what was found in a pair to a model.
@param plan That of the pair.
@param size Of its images.
@param depth Of its images.
@param numDisparities Of its images.
@param floats Of its images, if they are of floats.
@param levels What was found.
@param findings What was found. */
CV_EXPORTS PairModel toPairModel(const PyramidPlan& plan, Size size, int depth, int numDisparities,
                                 const FloatLevels& floats, const LevelFindings& levels, const PairFindings& findings);

}}} // namespace cv::stereo::hdp

#endif
