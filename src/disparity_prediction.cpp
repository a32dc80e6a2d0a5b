// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "disparity_prediction.hpp"

#include <cmath>

namespace cv {
namespace stereo {
namespace hdp {

namespace {

//! PixelIntv of a row of P(D_l | D_{l+1}), up to a factor.
DisparityInterval growInterval(const std::vector<double>& row, double delta, int margin)
{
    const int mode = (int)(std::max_element(row.begin(), row.end()) - row.begin());
    if (!(row[mode] > 0))
    {
        const DisparityInterval empty = { 1, 0 };
        return empty;
    }
    int first = mode, last = mode;
    double selected = row[mode]; // c of the criterion
    for (bool grown = true; grown;)
    {
        grown = false;
        if (first > 0 && row[first - 1] > delta * (selected + row[first - 1]))
        {
            selected += row[--first];
            grown = true;
        }
        if (last + 1 < (int)row.size() && row[last + 1] > delta * (selected + row[last + 1]))
        {
            selected += row[++last];
            grown = true;
        }
    }
    const DisparityInterval interval = { (ushort)std::max(first - margin, 0),
                                         (ushort)std::min(last + margin, (int)row.size() - 1) };
    return interval;
}

//! Of a disparity times scale.
int wholeDisparity(int disparity, int scale) { return (disparity + scale / 2) / scale; }

} // namespace

void predictIntervals(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior,
                      int upperDisparities, double delta, int margin, std::vector<DisparityInterval>& intervals)
{
    const int disparities = (int)prior.size();
    // P(D_{l+1} = i | D_l = j) depends on i - floor(j / 2) alone.
    const int lowestOffset = -((disparities - 1) / 2);
    std::vector<double> gmm(upperDisparities - lowestOffset);
    for (size_t k = 0; k < gmm.size(); ++k)
        gmm[k] = model.density(layer, lowestOffset + (int)k);

    intervals.resize(upperDisparities);
    parallel_for_(Range(0, upperDisparities), [&](const Range& range) {
        std::vector<double> row(disparities);
        for (int i = range.start; i < range.end; ++i)
        {
            for (int j = 0; j < disparities; ++j)
                row[j] = gmm[i - j / 2 - lowestOffset] * prior[j];
            intervals[i] = growInterval(row, delta, margin);
        }
    });
}

void upperHistogram(const Mat& upper, int scale, int numDisparities, std::vector<double>& histogram)
{
    std::vector<double> pixels((numDisparities + 1) / 2);
    for (int y = 0; y < upper.rows; ++y)
        for (int x = 0; x < upper.cols; ++x)
            ++pixels[wholeDisparity(upper.at<ushort>(y, x), scale)];
    histogram.resize(numDisparities);
    for (int d = 0; d < numDisparities; ++d)
        histogram[d] = pixels[d / 2] + (double)upper.total() / pixels.size();
}

void assignIntervals(const Mat& upper, int scale, Size size, const std::vector<DisparityInterval>& intervals,
                     Mat& pixelIntv)
{
    pixelIntv.create(size, CV_16UC2);
    parallel_for_(Range(0, size.height), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort* above = upper.ptr<ushort>(std::min(y / 2, upper.rows - 1));
            DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
            for (int x = 0; x < size.width; ++x)
                interval[x] = intervals[wholeDisparity(above[std::min(x / 2, upper.cols - 1)], scale)];
        }
    });
}

} // namespace hdp

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

    double density(int layer, double offset) const CV_OVERRIDE
    {
        const GaussianMixture& mixture = at(layer);
        double sum = 0;
        for (size_t k = 0; k < mixture.means.size(); ++k)
        {
            const double z = (offset - mixture.means[k]) / mixture.sigmas[k];
            sum += mixture.weights[k] * std::exp(-0.5 * z * z) / (mixture.sigmas[k] * std::sqrt(2 * CV_PI));
        }
        return sum;
    }

    bool empty() const CV_OVERRIDE { return layers_.empty(); }
    void clear() CV_OVERRIDE { layers_.clear(); }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_DisparityPredictionModel"; }

    void write(FileStorage& fs) const CV_OVERRIDE
    {
        fs << "name" << getDefaultName() << "version" << fileVersion << "layers"
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
        maxComponents = 1024
    };

    static std::vector<double> readNumbers(const FileNode& layer, const char* key)
    {
        const FileNode node = layer.isMap() ? layer[key] : FileNode();
        if (node.isInt() || node.isReal()) // a sequence of one number in XML
            return std::vector<double>(1, (double)node);
        if (!node.isSeq() || node.size() > maxComponents)
            CV_Error(Error::StsParseError,
                     format("%s must be a sequence of at most %d numbers", key, (int)maxComponents));
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

template <size_t K>
void addPublishedLayer(DisparityPredictionModel& model, const double (&means)[K], const double (&sigmas)[K],
                       const double (&weights)[K])
{
    model.addLayer(std::vector<double>(means, means + K), std::vector<double>(sigmas, sigmas + K),
                   std::vector<double>(weights, weights + K));
}

} // namespace

Ptr<DisparityPredictionModel> DisparityPredictionModel::create() { return makePtr<DisparityPredictionModelImpl>(); }

Ptr<DisparityPredictionModel> DisparityPredictionModel::createPublished(int which)
{
    Ptr<DisparityPredictionModel> model = create();
    if (which == PUBLISHED_LARGE)
    {
        const double means0[] = { -38.335031, 0.383928, 22.106222, 0.383928 };
        const double sigmas0[] = { 19.879390, 0.629609, 26.036771, 0.629609 };
        const double weights0[] = { 0.131236, 0.310989, 0.133314, 0.424460 };
        const double means1[] = { 0.452982, -21.247403, 11.133451, 10.101522 };
        const double sigmas1[] = { 0.617757, 9.580585, 14.423702, 0.604170 };
        const double weights1[] = { 0.747561, 0.100479, 0.126690, 0.025270 };
        const double means2[] = { 4.580204, 10.864041, -8.720563, 0.476397 };
        const double sigmas2[] = { 1.036329, 4.002217, 4.461282, 0.637942 };
        const double weights2[] = { 0.076437, 0.048733, 0.060785, 0.814045 };
        addPublishedLayer(*model, means0, sigmas0, weights0);
        addPublishedLayer(*model, means1, sigmas1, weights1);
        addPublishedLayer(*model, means2, sigmas2, weights2);
    }
    else if (which == PUBLISHED_SMALL)
    {
        const double means0[] = { 1.049875, 0.176738, -5.205266 };
        const double sigmas0[] = { 2.700242, 0.594091, 10.932382 };
        const double weights0[] = { 0.123876, 0.705882, 0.170241 };
        const double means1[] = { -0.838225, 0.174887 };
        const double sigmas1[] = { 5.652754, 0.543740 };
        const double weights1[] = { 0.218403, 0.781597 };
        addPublishedLayer(*model, means0, sigmas0, weights0);
        addPublishedLayer(*model, means1, sigmas1, weights1);
    }
    else
        CV_Error(Error::StsBadArg, "which must be PUBLISHED_LARGE or PUBLISHED_SMALL");
    return model;
}

Ptr<DisparityPredictionModel> DisparityPredictionModel::load(const String& filename)
{
    FileStorage fs(filename, FileStorage::READ);
    if (!fs.isOpened())
        CV_Error(Error::StsObjectNotFound, "filename: cannot read " + filename);
    Ptr<DisparityPredictionModel> model = create();
    model->read(fs.getFirstTopLevelNode());
    return model;
}

} // namespace stereo
} // namespace cv
