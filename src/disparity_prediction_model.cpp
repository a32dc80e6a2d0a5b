// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"

#include "opencv2/opencv_modules.hpp"
#ifdef HAVE_OPENCV_ML
#include "opencv2/ml.hpp"
#endif

#include <cmath>
#include <map>

namespace cv {
namespace stereo {

namespace {

struct GaussianMixture
{
    std::vector<double> means, sigmas, weights;
};

GaussianMixture checkedMixture(const std::vector<double>& means, const std::vector<double>& sigmas,
                               const std::vector<double>& weights)
{
    if (means.empty())
        CV_Error(Error::StsBadArg, "means must not be empty");
    if (sigmas.size() != means.size() || weights.size() != means.size())
        CV_Error(Error::StsBadSize, "means, sigmas and weights must have the same number of elements");
    double sum = 0;
    for (size_t k = 0; k < means.size(); ++k)
    {
        if (!std::isfinite(means[k]))
            CV_Error(Error::StsOutOfRange, "means must be finite");
        if (!std::isfinite(sigmas[k]) || sigmas[k] <= 0)
            CV_Error(Error::StsOutOfRange, "sigmas must be finite and > 0");
        if (!(weights[k] >= 0 && weights[k] <= 1))
            CV_Error(Error::StsOutOfRange, "weights must be in [0, 1]");
        sum += weights[k];
    }
    if (std::abs(sum - 1) > 0.001)
        CV_Error(Error::StsOutOfRange, "the sum of weights must be 1");
    const GaussianMixture mixture = { means, sigmas, weights };
    return mixture;
}

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

//////////////////////////////////////////////// training /////////////////////////////////////////////////

typedef std::map<int, double> Histogram; // number of pixels by offset

void add(const Histogram& from, Histogram& to)
{
    for (Histogram::const_iterator bin = from.begin(); bin != from.end(); ++bin)
        to[bin->first] += bin->second;
}

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

//! Offsets of the pixels of a map that are known in both layers
Histogram histogramOf(const Mat& map, const Mat& upper)
{
    Histogram histogram;
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x)
        {
            const float disparity = map.at<float>(y, x);
            const float above = upper.at<float>(std::min(y / 2, upper.rows - 1), std::min(x / 2, upper.cols - 1));
            if (isKnown(disparity) && isKnown(above))
                ++histogram[cvRound(above) - (int)disparity / 2];
        }
    return histogram;
}

#ifdef HAVE_OPENCV_ML

const int minTrainingPixels = 100; // in each half

double countPixels(const Histogram& histogram)
{
    double sum = 0;
    for (Histogram::const_iterator bin = histogram.begin(); bin != histogram.end(); ++bin)
        sum += bin->second;
    return sum;
}

//! Whether no two known values differ.
bool areConstant(const std::vector<Mat>& maps)
{
    double smallest = DBL_MAX, largest = -1;
    for (size_t i = 0; i < maps.size(); ++i)
    {
        const Mat known = (maps[i] >= 0) & (maps[i] < std::numeric_limits<float>::infinity());
        double low = 0, high = 0;
        if (countNonZero(known) == 0)
            continue;
        minMaxLoc(maps[i], &low, &high, 0, 0, known);
        smallest = std::min(smallest, low);
        largest = std::max(largest, high);
    }
    return smallest >= largest;
}

//! Histograms of one half of the maps, chosen by seed, and of the other; of a single map, of every other band of rows.
void histogramsOfHalves(const std::vector<Mat>& maps, const std::vector<Mat>& uppers, int seed, Histogram& first,
                        Histogram& second)
{
    std::vector<Histogram> parts;
    const int band = 16;
    if (maps.size() > 1)
        for (size_t i = 0; i < maps.size(); ++i)
            parts.push_back(histogramOf(maps[i], uppers[i]));
    else
        for (int y = 0; y / 2 < uppers[0].rows; y += band)
            parts.push_back(histogramOf(maps[0].rowRange(y, std::min(y + band, maps[0].rows)),
                                        uppers[0].rowRange(y / 2, std::min((y + band) / 2, uppers[0].rows))));
    std::vector<int> order(parts.size());
    for (size_t i = 0; i < order.size(); ++i)
        order[i] = (int)i;
    RNG rng((uint64)seed + 1); // 0 is no seed
    for (size_t i = order.size() - 1; i > 0 && maps.size() > 1; --i)
        std::swap(order[i], order[rng.uniform(0, (int)i + 1)]);
    for (size_t i = 0; i < order.size(); ++i)
        add(parts[order[i]], i % 2 == 0 ? first : second);

    if (countPixels(first) < minTrainingPixels || countPixels(second) < minTrainingPixels)
        CV_Error(Error::StsBadArg, format("disparities and upperDisparities must know at least %d pixels in each half "
                                          "of the maps, not %.0f and %.0f",
                                          minTrainingPixels, countPixels(first), countPixels(second)));
    if (areConstant(maps))
        CV_Error(Error::StsBadArg, "disparities must not be all the same");
    if (first.size() < 2 || second.size() < 2)
        CV_Error(Error::StsBadArg, "upperDisparities must not all have the same offset from half of disparities");
}

double meanLogLikelihood(const GaussianMixture& mixture, const Histogram& histogram)
{
    double sum = 0;
    for (Histogram::const_iterator bin = histogram.begin(); bin != histogram.end(); ++bin)
        sum += bin->second * std::log(std::max(densityOf(mixture, bin->first), DBL_MIN));
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
Mat_<double> quantiles(const Histogram& histogram)
{
    Mat_<double> samples(trainingSamples, 1);
    const double step = countPixels(histogram) / trainingSamples;
    double before = 0; // pixels of smaller offsets
    int i = 0;
    for (Histogram::const_iterator bin = histogram.begin(); bin != histogram.end(); ++bin)
    {
        for (; i < trainingSamples && (i + 0.5) * step < before + bin->second; ++i)
            samples(i) = bin->first - 0.5 + ((i + 0.5) * step - before) / bin->second;
        before += bin->second;
    }
    for (; i < trainingSamples; ++i) // rounding
        samples(i) = histogram.rbegin()->first + 0.5;
    return samples;
}

//! What the EM algorithm begins with: components of one mean and of widths that double, or of one width and means that
//! are far from each other (k-means++).
void initialize(const Mat_<double>& samples, bool nested, RNG& rng, Mat_<double>& means, std::vector<Mat>& variances)
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
    initialize(samples, nested, rng, initialMeans, initialVariances);
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

//! The most likely of several runs
GaussianMixture fitMixture(const Histogram& histogram, int components, int seed)
{
    const Mat_<double> samples = quantiles(histogram);
    RNG rng((uint64)seed + 1); // 0 is no seed
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

#endif

class DisparityPredictionModelImpl CV_FINAL : public DisparityPredictionModel
{
public:
    int getNumLayers() const CV_OVERRIDE { return (int)layers_.size(); }

    void addLayer(const std::vector<double>& means, const std::vector<double>& sigmas,
                  const std::vector<double>& weights) CV_OVERRIDE
    {
        layers_.push_back(checkedMixture(means, sigmas, weights));
    }

    void getLayer(int layer, std::vector<double>& means, std::vector<double>& sigmas,
                  std::vector<double>& weights) const CV_OVERRIDE
    {
        const GaussianMixture& mixture = at(layer);
        means = mixture.means;
        sigmas = mixture.sigmas;
        weights = mixture.weights;
    }

    double density(int layer, double offset) const CV_OVERRIDE { return densityOf(at(layer), offset); }

    double train(InputArrayOfArrays disparities, InputArrayOfArrays upperDisparities, int maxComponents,
                 int seed) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();
        if (maxComponents < 1 || maxComponents > 64)
            CV_Error(Error::StsOutOfRange, format("maxComponents must be in 1..64, not %d", maxComponents));
        if (seed < 0)
            CV_Error(Error::StsOutOfRange, format("seed must be >= 0, not %d", seed));
        std::vector<Mat> maps, uppers;
        disparities.getMatVector(maps);
        upperDisparities.getMatVector(uppers);
        checkMaps(maps, uppers);
#ifdef HAVE_OPENCV_ML
        Histogram fitted, heldOut;
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
        add(heldOut, fitted);
        const GaussianMixture mixture = fitMixture(fitted, bestComponents, seed);
        layers_.push_back(checkedMixture(mixture.means, mixture.sigmas, mixture.weights));
        return best;
#else
        CV_Error(Error::StsNotImplemented, "train() needs opencv_ml, which this library was built without");
#endif
    }

    bool empty() const CV_OVERRIDE { return layers_.empty(); }
    void clear() CV_OVERRIDE { layers_.clear(); }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_DisparityPredictionModel"; }

    void write(FileStorage& fs) const CV_OVERRIDE
    {
        fs << "name" << getDefaultName() << "version" << fileVersion << "layerCount" << getNumLayers() << "layers"
           << "[";
        for (size_t l = 0; l < layers_.size(); ++l)
            fs << "{"
               << "means" << layers_[l].means << "sigmas" << layers_[l].sigmas << "weights" << layers_[l].weights
               << "}";
        fs << "]";
    }

    void read(const FileNode& fn) CV_OVERRIDE
    {
        const FileNode name = fn["name"], version = fn["version"], layers = fn["layers"];
        if (!name.isString() || (String)name != getDefaultName())
            CV_Error(Error::StsParseError, "name must be " + getDefaultName());
        if (!version.isInt() || (int)version != fileVersion)
            CV_Error(Error::StsParseError, format("version must be %d", (int)fileVersion));
        if (!layers.isSeq() || layers.size() > maxLayers)
            CV_Error(Error::StsParseError, format("layers must be a sequence of at most %d mixtures", (int)maxLayers));
        // A file that ends between two layers is well-formed.
        if (!fn["layerCount"].isInt() || (int)fn["layerCount"] != (int)layers.size())
            CV_Error(Error::StsParseError, "layerCount must be the number of layers");
        std::vector<GaussianMixture> read;
        for (FileNodeIterator it = layers.begin(); it != layers.end(); ++it)
        {
            const FileNode layer = *it;
            read.push_back(checkedMixture(readNumbers(layer, "means"), readNumbers(layer, "sigmas"),
                                          readNumbers(layer, "weights")));
        }
        layers_.swap(read);
    }

private:
    enum
    {
        fileVersion = 1,
        maxLayers = 64,
        maxFileComponents = 1024
    };

    static std::vector<double> readNumbers(const FileNode& layer, const char* key)
    {
        const FileNode node = layer.isMap() ? layer[key] : FileNode();
        if (node.isInt() || node.isReal()) // a sequence of one number in XML
            return std::vector<double>(1, (double)node);
        if (!node.isSeq() || node.size() > maxFileComponents)
            CV_Error(Error::StsParseError,
                     format("%s must be a sequence of at most %d numbers", key, (int)maxFileComponents));
        std::vector<double> numbers;
        for (FileNodeIterator it = node.begin(); it != node.end(); ++it)
        {
            if (!(*it).isInt() && !(*it).isReal())
                CV_Error(Error::StsParseError, format("%s must hold numbers only", key));
            numbers.push_back((double)*it);
        }
        return numbers;
    }

    const GaussianMixture& at(int layer) const
    {
        if (layer < 0 || layer >= getNumLayers())
            CV_Error(Error::StsOutOfRange, format("layer must be in 0..%d, not %d", getNumLayers() - 1, layer));
        return layers_[layer];
    }

    std::vector<GaussianMixture> layers_;
};

} // namespace

void DisparityPredictionModel::countOffsets(InputArrayOfArrays disparities, InputArrayOfArrays upperDisparities,
                                            std::vector<int>& offsets, std::vector<double>& counts)
{
    std::vector<Mat> maps, uppers;
    disparities.getMatVector(maps);
    upperDisparities.getMatVector(uppers);
    checkMaps(maps, uppers);
    Histogram histogram;
    for (size_t i = 0; i < maps.size(); ++i)
        add(histogramOf(maps[i], uppers[i]), histogram);
    offsets.clear();
    counts.clear();
    for (Histogram::const_iterator bin = histogram.begin(); bin != histogram.end(); ++bin)
    {
        offsets.push_back(bin->first);
        counts.push_back(bin->second);
    }
}

Ptr<DisparityPredictionModel> DisparityPredictionModel::create() { return makePtr<DisparityPredictionModelImpl>(); }

Ptr<DisparityPredictionModel> DisparityPredictionModel::createPublished(int which)
{
    // The mixtures of each model from layer 0 on: means, sigmas, weights
    const struct
    {
        int which;
        GaussianMixture mixture;
    } layers[] = {
        { PUBLISHED_LARGE,
          { { -38.335031, 0.383928, 22.106222, 0.383928 },
            { 19.879390, 0.629609, 26.036771, 0.629609 },
            { 0.131236, 0.310989, 0.133314, 0.424460 } } },
        { PUBLISHED_LARGE,
          { { 0.452982, -21.247403, 11.133451, 10.101522 },
            { 0.617757, 9.580585, 14.423702, 0.604170 },
            { 0.747561, 0.100479, 0.126690, 0.025270 } } },
        { PUBLISHED_LARGE,
          { { 4.580204, 10.864041, -8.720563, 0.476397 },
            { 1.036329, 4.002217, 4.461282, 0.637942 },
            { 0.076437, 0.048733, 0.060785, 0.814045 } } },
        { PUBLISHED_SMALL,
          { { 1.049875, 0.176738, -5.205266 }, { 2.700242, 0.594091, 10.932382 }, { 0.123876, 0.705882, 0.170241 } } },
        { PUBLISHED_SMALL, { { -0.838225, 0.174887 }, { 5.652754, 0.543740 }, { 0.218403, 0.781597 } } },
    };
    const Ptr<DisparityPredictionModel> model = create();
    for (const auto& layer : layers)
        if (layer.which == which)
            model->addLayer(layer.mixture.means, layer.mixture.sigmas, layer.mixture.weights);
    if (model->empty())
        CV_Error(Error::StsBadArg, "which must be PUBLISHED_LARGE or PUBLISHED_SMALL");
    return model;
}

Ptr<DisparityPredictionModel> DisparityPredictionModel::load(const String& filename)
{
    Ptr<DisparityPredictionModel> model = create();
    try
    {
        FileStorage fs(filename, FileStorage::READ);
        if (!fs.isOpened())
            CV_Error(Error::StsObjectNotFound, "cannot read it");
        model->read(fs.getFirstTopLevelNode());
    }
    catch (const cv::Exception& e) // the parser's do not name the file
    {
        CV_Error(e.code, "filename: '" + filename + "' does not hold a model: " + e.err);
    }
    return model;
}

} // namespace stereo
} // namespace cv
