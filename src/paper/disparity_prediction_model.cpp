// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "mixture_training.hpp"

#include "../base/named_values.hpp"

#include <cmath>

namespace cv { namespace stereo {

using namespace hdp;

namespace {

const int fileVersion = 1, maxLayers = 64, maxGaussians = 1024; // of a mixture

void requireRoom(const std::vector<GaussianMixture>& layers)
{
    if (layers.size() >= (size_t)maxLayers)
        CV_Error(Error::StsOutOfRange, format("a model must have at most %d layers", maxLayers));
}

//! Throws if the mixture is none, or one too many.
void append(const GaussianMixture& mixture, std::vector<GaussianMixture>& layers)
{
    requireRoom(layers);
    const std::vector<double>&means = mixture.means, &sigmas = mixture.sigmas, &weights = mixture.weights;
    if (means.empty() || means.size() > (size_t)maxGaussians)
        CV_Error(Error::StsBadArg, format("means must have from 1 to %d elements", maxGaussians));
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
    layers.push_back(mixture);
}

class DisparityPredictionModelImpl CV_FINAL : public DisparityPredictionModel
{
public:
    int getNumLayers() const CV_OVERRIDE { return (int)layers_.size(); }

    void addLayer(const std::vector<double>& means, const std::vector<double>& sigmas,
                  const std::vector<double>& weights) CV_OVERRIDE
    {
        append({ means, sigmas, weights }, layers_);
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
        requireRoom(layers_);
        std::vector<Mat> maps, uppers;
        disparities.getMatVector(maps);
        upperDisparities.getMatVector(uppers);
        GaussianMixture mixture;
        const double likelihood = trainMixture(maps, uppers, maxComponents, seed, mixture);
        append(mixture, layers_);
        return likelihood;
    }

    bool empty() const CV_OVERRIDE { return layers_.empty(); }
    void clear() CV_OVERRIDE { layers_.clear(); }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_DisparityPredictionModel"; }

    void write(FileStorage& fs) const CV_OVERRIDE
    {
        fs << "name" << getDefaultName() << "version" << fileVersion << "layerCount" << getNumLayers() << "layers"
           << "[";
        for (const GaussianMixture& layer : layers_)
            fs << "{"
               << "means" << layer.means << "sigmas" << layer.sigmas << "weights" << layer.weights << "}";
        fs << "]";
    }

    void read(const FileNode& fn) CV_OVERRIDE
    {
        if (!fn.isMap())
            CV_Error(Error::StsParseError, "a model must be a map");
        const FileNode name = fn["name"], version = fn["version"], layers = fn["layers"];
        if (!name.isString() || (String)name != getDefaultName())
            CV_Error(Error::StsParseError, "name must be " + getDefaultName());
        if (!version.isInt() || (int)version != fileVersion)
            CV_Error(Error::StsParseError, format("version must be %d", fileVersion));
        if (!layers.isSeq() && !layers.isNone()) // XML has none of an empty one
            CV_Error(Error::StsParseError, "layers must be a sequence of mixtures");
        // A file that was cut off between two layers can be read: their number reveals it.
        if (!fn["layerCount"].isInt() || (int)fn["layerCount"] != (int)layers.size())
            CV_Error(Error::StsParseError, "layerCount must be the number of layers");
        std::vector<GaussianMixture> mixtures;
        for (const FileNode layer : layers)
        {
            if (!layer.isMap())
                CV_Error(Error::StsParseError, "layers must be a sequence of mixtures");
            GaussianMixture mixture;
            const ValueReader read = { layer, "", false };
            read("means", mixture.means, true, "");
            read("sigmas", mixture.sigmas, true, "");
            read("weights", mixture.weights, true, "");
            append(mixture, mixtures);
        }
        layers_.swap(mixtures);
    }

private:
    const GaussianMixture& at(int layer) const
    {
        if (layer < 0 || layer >= getNumLayers())
            CV_Error(Error::StsOutOfRange, format("layer must be in 0..%d, not %d", getNumLayers() - 1, layer));
        return layers_[layer];
    }

    std::vector<GaussianMixture> layers_;
};

} // namespace

Ptr<DisparityPredictionModel> DisparityPredictionModel::create() { return makePtr<DisparityPredictionModelImpl>(); }

Ptr<DisparityPredictionModel> DisparityPredictionModel::createPublished(int which)
{
    if (which != PUBLISHED_LARGE && which != PUBLISHED_SMALL)
        CV_Error(Error::StsBadArg, "which must be PUBLISHED_LARGE or PUBLISHED_SMALL");
    // The mixtures of each model from layer 0 on: means, sigmas, weights
    const std::vector<GaussianMixture> largeModel = {
        { { -38.335031, 0.383928, 22.106222, 0.383928 },
          { 19.879390, 0.629609, 26.036771, 0.629609 },
          { 0.131236, 0.310989, 0.133314, 0.424460 } },
        { { 0.452982, -21.247403, 11.133451, 10.101522 },
          { 0.617757, 9.580585, 14.423702, 0.604170 },
          { 0.747561, 0.100479, 0.126690, 0.025270 } },
        { { 4.580204, 10.864041, -8.720563, 0.476397 },
          { 1.036329, 4.002217, 4.461282, 0.637942 },
          { 0.076437, 0.048733, 0.060785, 0.814045 } },
    };
    const std::vector<GaussianMixture> smallModel = {
        { { 1.049875, 0.176738, -5.205266 }, { 2.700242, 0.594091, 10.932382 }, { 0.123876, 0.705882, 0.170241 } },
        { { -0.838225, 0.174887 }, { 5.652754, 0.543740 }, { 0.218403, 0.781597 } },
    };
    const Ptr<DisparityPredictionModel> model = create();
    for (const GaussianMixture& mixture : which == PUBLISHED_LARGE ? largeModel : smallModel)
        model->addLayer(mixture.means, mixture.sigmas, mixture.weights);
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

}} // namespace cv::stereo
