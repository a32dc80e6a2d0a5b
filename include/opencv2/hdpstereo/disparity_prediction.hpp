// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_DISPARITY_PREDICTION_HPP
#define OPENCV_HDPSTEREO_DISPARITY_PREDICTION_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief The relation of the disparities of two consecutive pyramid layers: the Hierarchical Disparity Prediction
Model of @cite Luo2015HDP , section 2.2.

For each layer l it holds a Gaussian mixture over the offset \f$o = D_{l+1} - \lfloor D_l / 2 \rfloor\f$ of
a pixel's disparity in layer l + 1 from half its disparity in layer l, so that
\f$P(D_{l+1} = i | D_l = j) = GMM_l(i - \lfloor j / 2 \rfloor)\f$. Layer 0 is the image itself. Offsets are
in whole pixels of layer l + 1.

A model is saved by cv::Algorithm::save() and read by load(); clear() removes its layers. read() throws cv::Exception
unless the file holds a model of at most 64 layers of at most 1024 Gaussians, and leaves the model as it was.
 */
class CV_EXPORTS_W DisparityPredictionModel : public Algorithm
{
public:
    //! The models that createPublished() knows, those of the authors' program
    enum Published
    {
        PUBLISHED_LARGE = 0, //!< Middlebury 2006 at full size (about 1390 x 1110); 3 layers
        PUBLISHED_SMALL = 1  //!< Middlebury 2006 at half size (about 695 x 555); 2 layers
    };

    /** @brief Number of layers that have a mixture. A matcher of L layers needs L - 1. */
    CV_WRAP virtual int getNumLayers() const = 0;

    /** @brief Appends the mixture of layer getNumLayers(), of at most 64.
    @param means Means \f$\mu_l(k)\f$ in pixels of layer l + 1: vector of K finite numbers, K from 1 to 1024.
    @param sigmas Standard deviations \f$\sigma_l(k)\f$ in the same unit: K finite numbers > 0.
    @param weights Mixing coefficients \f$\pi_l(k)\f$: K numbers in [0, 1], their sum 1 within 0.001.
    @throws cv::Exception if an argument is invalid; the model is unchanged.
     */
    CV_WRAP virtual void addLayer(const std::vector<double>& means, const std::vector<double>& sigmas,
                                  const std::vector<double>& weights) = 0;

    /** @brief Returns the mixture of a layer, see addLayer().
    @param layer 0 .. getNumLayers() - 1.
    @param means, sigmas, weights Receive K numbers each.
    @throws cv::Exception if there is no such layer.
     */
    CV_WRAP virtual void getLayer(int layer, CV_OUT std::vector<double>& means, CV_OUT std::vector<double>& sigmas,
                                  CV_OUT std::vector<double>& weights) const = 0;

    /** @brief Returns \f$GMM_l(o)\f$, the density of a mixture at an offset.
    @param layer 0 .. getNumLayers() - 1.
    @param offset o in pixels of layer + 1, of any sign.
    @return Density per pixel of offset, >= 0.
    @throws cv::Exception if there is no such layer.
     */
    CV_WRAP virtual double density(int layer, double offset) const = 0;

    /** @brief Appends the mixture of layer l = getNumLayers(), fitted to disparity maps by expectation maximisation.

    A pixel of layer l and the pixel above it, at half its coordinates, give an offset
    \f$D_{l+1} - \lfloor D_l / 2 \rfloor\f$, where \f$D_l\f$ is rounded down, as the paper's \f$d_l\f$ is, and
    \f$D_{l+1}\f$ to the nearest whole number. The offsets of half of the maps are fitted
    with 1 .. maxComponents Gaussians; the number that makes the other half most likely is fitted to all of them.
    The result depends on the arguments alone. A standard deviation is at least 0.5 pixels: below that, the densities at
    whole offsets do not add up to about 1, and equal offsets give a singular Gaussian. It is also at least a quarter of
    the mean: many gross errors of a single scene at one offset are no rule for other scenes.
    @param disparities Maps of \f$D_l\f$ in pixels of layer l, usually the truth: one or more CV_32FC1 Mats. A value
    that is negative or not finite is unknown, and left out.
    @param upperDisparities As many maps of \f$D_{l+1}\f$ in pixels of layer l + 1, usually those that the matcher
    finds there: CV_32FC1, of half the size, rounded up or down. Disparities of both are at most 32767.
    @param maxComponents Largest number of Gaussians, 1..64.
    @param seed Seed of the choice of halves and of the starts of the fit, >= 0.
    @return Mean log-likelihood of an offset of the half that the number of Gaussians was chosen by.
    @throws cv::Exception if an argument is invalid, if one of the halves has fewer than 100 offsets, or equal ones
    only, if all \f$D_l\f$ are equal, or if the library was built without opencv_ml, which only this method needs; the
    model is unchanged.
     */
    CV_WRAP virtual double train(InputArrayOfArrays disparities, InputArrayOfArrays upperDisparities,
                                 int maxComponents = 6, int seed = 0) = 0;

    /** @brief Returns the histogram of offsets that train() fits a mixture to.
    @param disparities, upperDisparities Maps as for train().
    @param offsets Receives the offsets that occur, ascending.
    @param counts Receives the number of pixels of each.
    @throws cv::Exception if a map is invalid, see train().
     */
    CV_WRAP static void countOffsets(InputArrayOfArrays disparities, InputArrayOfArrays upperDisparities,
                                     CV_OUT std::vector<int>& offsets, CV_OUT std::vector<double>& counts);

    /** @brief Creates a model without layers. */
    CV_WRAP static Ptr<DisparityPredictionModel> create();

    /** @brief Creates one of the models that come with the module.

    The matcher uses them by default. testdata/cv/hdpstereo/models has them as files, beside two that train() has fitted
    to six scenes of the same data.
    @param which One of DisparityPredictionModel::Published.
    @throws cv::Exception if there is no such model.
     */
    CV_WRAP static Ptr<DisparityPredictionModel> createPublished(int which);

    /** @brief Reads a model that was written by save() or write().
    @param filename XML, YAML or JSON file of cv::FileStorage.
    @throws cv::Exception if the file cannot be read or does not hold a model.
     */
    CV_WRAP static Ptr<DisparityPredictionModel> load(const String& filename);
};

//! @}

} // namespace stereo
} // namespace cv

#endif
