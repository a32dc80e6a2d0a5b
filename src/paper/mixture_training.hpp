// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MIXTURE_TRAINING_HPP
#define OPENCV_HDPSTEREO_MIXTURE_TRAINING_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! GMM_l of section 2.2
struct GaussianMixture
{
    std::vector<double> means, sigmas, weights;
};

double densityOf(const GaussianMixture& mixture, double offset);

//! See DisparityPredictionModel::train(), whose maxComponents and seed have been checked. Returns what it returns.
double trainMixture(const std::vector<Mat>& maps, const std::vector<Mat>& uppers, int maxComponents, int seed,
                    GaussianMixture& mixture);

}}} // namespace cv::stereo::hdp

#endif
