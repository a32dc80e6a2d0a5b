// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "mixture_training.hpp"

#include "opencv2/opencv_modules.hpp"
#ifdef HAVE_OPENCV_ML
#include "opencv2/ml.hpp"
#endif

#include <cmath>
#include <map>
#include <set>

namespace cv { namespace stereo {
namespace hdp {

namespace {

typedef std::map<int, double> OffsetHistogram; // number of pixels by offset

//! Throws if the maps are not as DisparityPredictionModel wants them.
void checkMaps(const std::vector<Mat>& maps, const std::vector<Mat>& uppers)
{
    if (maps.empty())
        CV_Error(Error::StsBadArg, "disparities must not be empty");
    if (uppers.size() != maps.size())
        CV_Error(Error::StsUnmatchedSizes, "upperDisparities must have as many maps as disparities");
    for (size_t i = 0; i < maps.size(); ++i)
    {
        const Mat &map = maps[i], &upper = uppers[i];
        if (map.empty() || map.dims != 2 || map.type() != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "disparities must be CV_32FC1 and not empty");
        if (upper.empty() || upper.dims != 2 || upper.type() != CV_32FC1)
            CV_Error(Error::StsUnsupportedFormat, "upperDisparities must be CV_32FC1 and not empty");
        if ((upper.cols != map.cols / 2 && upper.cols != (map.cols + 1) / 2) ||
            (upper.rows != map.rows / 2 && upper.rows != (map.rows + 1) / 2))
            CV_Error(Error::StsUnmatchedSizes, "upperDisparities must have half the size of disparities");
    }
}

//! Whether a disparity is known; throws if it is not possible.
bool isKnown(float disparity)
{
    const float limit = 32767;
    if (!(disparity >= 0 && std::isfinite(disparity)))
        return false;
    if (disparity > limit)
        CV_Error(Error::StsOutOfRange, "disparities and upperDisparities must be at most 32767");
    return true;
}

//! Counts the offsets of the pixels in some rows of a map that are known in both layers.
void addOffsets(const Mat& map, const Mat& upper, const Range& rows, OffsetHistogram& histogram)
{
    for (int y = rows.start; y < rows.end; ++y)
        for (int x = 0; x < map.cols; ++x)
        {
            const float disparity = map.at<float>(y, x);
            const float above = upper.at<float>(std::min(y / 2, upper.rows - 1), std::min(x / 2, upper.cols - 1));
            if (isKnown(disparity) && isKnown(above))
                ++histogram[cvRound(above) - (int)disparity / 2];
        }
}

const int minTrainingPixels = 100; // in each half

double countPixels(const OffsetHistogram& histogram)
{
    double sum = 0;
    for (const auto& bin : histogram)
        sum += bin.second;
    return sum;
}

//! Whether no two known values differ.
bool areConstant(const std::vector<Mat>& maps)
{
    std::set<float> values;
    for (const Mat& map : maps)
        for (const float disparity : Mat_<float>(map))
            if (values.size() < 2 && isKnown(disparity))
                values.insert(disparity);
    return values.size() < 2;
}

//! Histograms of one half of the maps, chosen by seed, and of the other; of a single map, of every other band of rows.
void histogramsOfHalves(const std::vector<Mat>& maps, const std::vector<Mat>& uppers, int seed, OffsetHistogram& first,
                        OffsetHistogram& second)
{
    std::vector<std::pair<size_t, Range>> parts; // maps, and rows of them
    for (size_t i = 0; i < maps.size(); ++i)
    {
        const int rows = maps[i].rows, band = maps.size() > 1 ? rows : 16;
        for (int y = 0; y < rows; y += band)
            parts.push_back(std::make_pair(i, Range(y, std::min(y + band, rows))));
    }
    RNG rng((uint64)seed + 1); // RNG(0) is RNG(0xffffffff): seeds begin with 1
    for (size_t i = maps.size() - 1; i > 0; --i)
        std::swap(parts[i], parts[rng.uniform(0, (int)i + 1)]);
    for (size_t i = 0; i < parts.size(); ++i)
        addOffsets(maps[parts[i].first], uppers[parts[i].first], parts[i].second, i % 2 == 0 ? first : second);

    if (countPixels(first) < minTrainingPixels || countPixels(second) < minTrainingPixels)
        CV_Error(Error::StsBadArg, format("disparities and upperDisparities must know at least %d pixels in each half "
                                          "of the maps, not %.0f and %.0f",
                                          minTrainingPixels, countPixels(first), countPixels(second)));
    if (areConstant(maps))
        CV_Error(Error::StsBadArg, "disparities must not be all the same");
    if (first.size() < 2 || second.size() < 2)
        CV_Error(
            Error::StsBadArg,
            "upperDisparities must not all have the same offset from half of disparities in either half of the maps");
}

double meanLogLikelihood(const GaussianMixture& mixture, const OffsetHistogram& histogram)
{
    double sum = 0;
    for (const auto& bin : histogram)
        sum += bin.second * std::log(std::max(densityOf(mixture, bin.first), DBL_MIN));
    return sum / countPixels(histogram);
}

const int trainingSamples = 1500; // of the histogram, for cv::ml::EM, which knows no weights
const int restarts = 3;

// Below half a pixel, the densities at whole offsets do not add up to about 1 any more; and offsets that are all the
// same would make a singular component. Gross errors are many by chance at one offset, where a textureless surface of a
// single scene was matched wrongly: that is no rule for other scenes, so the wider off, the broader a component is.
const double minSigma = 0.5;
const double minRelativeSigma = 0.25; // of the mean

//! Quantiles of the histogram, each offset spread evenly over the pixel around it: no two samples are the same.
Mat_<double> quantiles(const OffsetHistogram& histogram)
{
    Mat_<double> samples(trainingSamples, 1);
    const double step = countPixels(histogram) / trainingSamples;
    double before = 0; // pixels of smaller offsets
    int i = 0;
    for (const auto& bin : histogram)
    {
        for (; i < trainingSamples && (i + 0.5) * step < before + bin.second; ++i)
            samples(i) = bin.first - 0.5 + ((i + 0.5) * step - before) / bin.second;
        before += bin.second;
    }
    for (; i < trainingSamples; ++i) // rounding
        samples(i) = histogram.rbegin()->first + 0.5;
    return samples;
}

#ifdef HAVE_OPENCV_ML

//! What the EM algorithm begins with. nested: components of one mean, the median, and of widths in a geometric series
//! from minSigma to about the range; otherwise of one width, and of means that are far from each other (k-means++).
//! Samples ascend; means has a row per component, and variances is empty before.
void initialComponents(const Mat_<double>& samples, bool nested, RNG& rng, Mat_<double>& means,
                       std::vector<Mat>& variances)
{
    const int components = means.rows;
    const double range = samples(samples.rows - 1) - samples(0), spread = std::max(range / (2 * components), 1.);
    Mat_<double> distances(samples.rows, 1, DBL_MAX);
    for (int k = 0; k < components; ++k)
    {
        const double width = nested ? minSigma * std::pow(std::max(range, 2.), (double)k / components) : spread;
        variances.push_back(Mat_<double>(1, 1, width * width));
        int chosen = samples.rows / 2;
        if (!nested && k == 0)
            chosen = rng.uniform(0, samples.rows);
        else if (!nested)
        {
            double rest = rng.uniform(0., sum(distances)[0]);
            for (chosen = 0; chosen + 1 < samples.rows && rest >= distances(chosen); ++chosen)
                rest -= distances(chosen);
        }
        means(k) = samples(chosen);
        for (int i = 0; i < samples.rows; ++i)
            distances(i) = std::min(distances(i), std::pow(samples(i) - means(k), 2));
    }
}

//! One run of the EM algorithm; fails if it has no valid result.
bool runEM(const Mat_<double>& samples, int components, bool nested, RNG& rng, GaussianMixture& mixture)
{
    Mat_<double> initialMeans(components, 1);
    std::vector<Mat> initialVariances;
    initialComponents(samples, nested, rng, initialMeans, initialVariances);
    const Ptr<ml::EM> em = ml::EM::create();
    em->setClustersNumber(components);
    em->setCovarianceMatrixType(ml::EM::COV_MAT_DIAGONAL);
    em->setTermCriteria(TermCriteria(TermCriteria::COUNT + TermCriteria::EPS, 100, 1e-6));
    // All three are given, or it would begin with cv::kmeans, which changes cv::theRNG().
    const Mat_<double> initialWeights(1, components, 1. / components);
    if (!em->trainE(samples, initialMeans, initialVariances, initialWeights))
        return false;
    const Mat_<double> means = em->getMeans(), weights = em->getWeights();
    std::vector<Mat> variances;
    em->getCovs(variances);

    std::vector<std::pair<double, int>> order; // the largest weight first
    double total = 0;
    for (int k = 0; k < components; ++k)
        if (weights(k) * trainingSamples >= 1) // else there is not even a sample for it
        {
            order.push_back(std::make_pair(-weights(k), k));
            total += weights(k);
        }
    std::sort(order.begin(), order.end());
    mixture = GaussianMixture();
    for (size_t i = 0; i < order.size(); ++i)
    {
        const int k = order[i].second;
        // Spreading the samples over a pixel has added its variance of 1/12.
        const double variance = variances[k].at<double>(0, 0) - 1. / 12;
        mixture.means.push_back(means(k));
        const double smallest = std::max(minSigma, minRelativeSigma * std::abs(means(k)));
        mixture.sigmas.push_back(std::sqrt(std::max(variance, smallest * smallest)));
        mixture.weights.push_back(weights(k) / total);
        if (!std::isfinite(means(k)) || !std::isfinite(variance))
            return false;
    }
    return !order.empty();
}

#else

bool runEM(const Mat_<double>&, int, bool, RNG&, GaussianMixture&)
{
    CV_Error(Error::StsNotImplemented, "train() needs opencv_ml, which this library was built without");
}

#endif

//! The most likely of several runs
GaussianMixture fitMixture(const OffsetHistogram& histogram, int components, int seed)
{
    const Mat_<double> samples = quantiles(histogram);
    RNG rng((uint64)seed + 1); // RNG(0) is RNG(0xffffffff): seeds begin with 1
    GaussianMixture best;
    double bestLikelihood = -DBL_MAX;
    for (int restart = 0; restart < (components == 1 ? 1 : restarts); ++restart)
    {
        GaussianMixture mixture;
        if (!runEM(samples, components, restart == 0, rng, mixture))
            continue;
        const double likelihood = meanLogLikelihood(mixture, histogram);
        if (likelihood > bestLikelihood)
        {
            best = mixture;
            bestLikelihood = likelihood;
        }
    }
    if (best.means.empty())
        CV_Error(Error::StsNoConv, format("no mixture of %d components can be fitted", components));
    return best;
}

} // namespace

double densityOf(const GaussianMixture& mixture, double offset)
{
    double sum = 0;
    for (size_t k = 0; k < mixture.means.size(); ++k)
    {
        const double z = (offset - mixture.means[k]) / mixture.sigmas[k];
        sum += mixture.weights[k] * std::exp(-0.5 * z * z) / (mixture.sigmas[k] * std::sqrt(2 * CV_PI));
    }
    return sum;
}

double trainMixture(const std::vector<Mat>& maps, const std::vector<Mat>& uppers, int maxComponents, int seed,
                    GaussianMixture& mixture)
{
    checkMaps(maps, uppers);
    OffsetHistogram fitted, heldOut;
    histogramsOfHalves(maps, uppers, seed, fitted, heldOut);
    double best = -DBL_MAX;
    int bestComponents = 1;
    for (int components = 1; components <= maxComponents; ++components)
    {
        const double likelihood = meanLogLikelihood(fitMixture(fitted, components, seed), heldOut);
        if (likelihood > best)
        {
            best = likelihood;
            bestComponents = components;
        }
    }
    for (const auto& bin : heldOut)
        fitted[bin.first] += bin.second;
    mixture = fitMixture(fitted, bestComponents, seed);
    return best;
}

} // namespace hdp

void DisparityPredictionModel::countOffsets(InputArrayOfArrays disparities, InputArrayOfArrays upperDisparities,
                                            std::vector<int>& offsets, std::vector<double>& counts)
{
    std::vector<Mat> maps, uppers;
    disparities.getMatVector(maps);
    upperDisparities.getMatVector(uppers);
    hdp::checkMaps(maps, uppers);
    hdp::OffsetHistogram histogram;
    for (size_t i = 0; i < maps.size(); ++i)
        hdp::addOffsets(maps[i], uppers[i], Range(0, maps[i].rows), histogram);
    offsets.clear();
    counts.clear();
    for (const auto& bin : histogram)
    {
        offsets.push_back(bin.first);
        counts.push_back(bin.second);
    }
}

}} // namespace cv::stereo
