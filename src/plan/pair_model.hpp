// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SRC_PAIR_MODEL_HPP
#define OPENCV_HDPSTEREO_SRC_PAIR_MODEL_HPP

#include "opencv2/hdpstereo/pair_model.hpp"

#include "../pair/pair_alignment.hpp"
#include "../pair/missing_pixels.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Throws if a value is not valid. An empty model is.
void checkPairModel(const PairModel& model);

//! Throws if a model that is not empty is of other images.
void checkPairModelOf(const PairModel& model, Size size, int type, int layers);

//! From a model to what it says of a pair; if it is empty, that is the frame alone of images of this size
CV_EXPORTS GivenPair toGivenPair(const PairModel& model, const PyramidPlan& plan, Size size);

//! From what was found in a pair to a model. size, depth and numDisparities are those of its images.
CV_EXPORTS PairModel toPairModel(const PyramidPlan& plan, Size size, int depth, int numDisparities,
                                 const CompletePair& pair, const LevelFindings& levels, const PairFindings& findings);

}}} // namespace cv::stereo::hdp

#endif
