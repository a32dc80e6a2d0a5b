// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"

#include <fstream>

namespace opencv_test { namespace {

typedef std::vector<double> Numbers;

const double infinity = std::numeric_limits<double>::infinity();
const double notANumber = std::numeric_limits<double>::quiet_NaN();

struct Mixture
{
    Numbers means, sigmas, weights;
};

Mixture getLayer(const DisparityPredictionModel& model, int layer)
{
    Mixture mixture;
    model.getLayer(layer, mixture.means, mixture.sigmas, mixture.weights);
    return mixture;
}

void expectLayer(const DisparityPredictionModel& model, int layer, const Mixture& expected)
{
    const Mixture actual = getLayer(model, layer);
    EXPECT_EQ(expected.means, actual.means) << "layer " << layer;
    EXPECT_EQ(expected.sigmas, actual.sigmas) << "layer " << layer;
    EXPECT_EQ(expected.weights, actual.weights) << "layer " << layer;
}

void expectEqualModels(const DisparityPredictionModel& expected, const DisparityPredictionModel& actual)
{
    ASSERT_EQ(expected.getNumLayers(), actual.getNumLayers());
    for (int layer = 0; layer < expected.getNumLayers(); ++layer)
        expectLayer(actual, layer, getLayer(expected, layer));
}

//! Numbers that binary fractions hold, so that a file's text is known.
Ptr<DisparityPredictionModel> createTwoLayerModel()
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    model->addLayer(Numbers{ 0.625, -7.25 }, Numbers{ 1.375, 5.5 }, Numbers{ 0.75, 0.25 });
    model->addLayer(Numbers{ 0.5 }, Numbers{ 2.125 }, Numbers{ 1 });
    return model;
}

////////////////////////////////////////////// the model //////////////////////////////////////////////

TEST(HDPStereo_PredictionModel, published_parameters)
{
    const Ptr<DisparityPredictionModel> small =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    ASSERT_EQ(2, small->getNumLayers());
    const Mixture small0 = { { 1.049875, 0.176738, -5.205266 },
                             { 2.700242, 0.594091, 10.932382 },
                             { 0.123876, 0.705882, 0.170241 } };
    const Mixture small1 = { { -0.838225, 0.174887 }, { 5.652754, 0.543740 }, { 0.218403, 0.781597 } };
    expectLayer(*small, 0, small0);
    expectLayer(*small, 1, small1);

    const Ptr<DisparityPredictionModel> large =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
    ASSERT_EQ(3, large->getNumLayers());
    const Mixture large0 = { { -38.335031, 0.383928, 22.106222, 0.383928 },
                             { 19.879390, 0.629609, 26.036771, 0.629609 },
                             { 0.131236, 0.310989, 0.133314, 0.424460 } };
    const Mixture large1 = { { 0.452982, -21.247403, 11.133451, 10.101522 },
                             { 0.617757, 9.580585, 14.423702, 0.604170 },
                             { 0.747561, 0.100479, 0.126690, 0.025270 } };
    const Mixture large2 = { { 4.580204, 10.864041, -8.720563, 0.476397 },
                             { 1.036329, 4.002217, 4.461282, 0.637942 },
                             { 0.076437, 0.048733, 0.060785, 0.814045 } };
    expectLayer(*large, 0, large0);
    expectLayer(*large, 1, large1);
    expectLayer(*large, 2, large2);
}

TEST(HDPStereo_PredictionModel, density_is_the_mixture)
{
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
    for (int layer = 0; layer < model->getNumLayers(); ++layer)
    {
        double sum = 0;
        for (int i = -4000; i <= 4000; ++i)
        {
            const double offset = i / 16., density = model->density(layer, offset);
            sum += density / 16;
            ASSERT_NEAR(oracle::density(*model, layer, offset), density, 1e-12)
                << "layer " << layer << " at " << offset;
        }
        EXPECT_NEAR(1, sum, 1e-4) << "layer " << layer;
    }
}

TEST(HDPStereo_PredictionModel, layers_are_appended)
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    EXPECT_EQ(0, model->getNumLayers());
    const Mixture one = { { 0.5 }, { 2 }, { 1 } }, two = { { -1, 3 }, { 0.25, 4 }, { 0.5, 0.5 } };
    model->addLayer(one.means, one.sigmas, one.weights);
    model->addLayer(two.means, two.sigmas, two.weights);
    ASSERT_EQ(2, model->getNumLayers());
    expectLayer(*model, 0, one);
    expectLayer(*model, 1, two);
}

TEST(HDPStereo_PredictionModel, bad_layer_is_rejected)
{
    const Ptr<DisparityPredictionModel> model = createTwoLayerModel();
    const struct
    {
        Mixture mixture;
        const char* argument;
    } cases[] = {
        { { {}, {}, {} }, "means" },
        { { { 1, 2 }, { 1 }, { 0.5, 0.5 } }, "sigmas" },
        { { { 1, 2 }, { 1, 2 }, { 1 } }, "weights" },
        { { { notANumber }, { 1 }, { 1 } }, "means" },
        { { { -infinity }, { 1 }, { 1 } }, "means" },
        { { { 0 }, { 0 }, { 1 } }, "sigmas" },
        { { { 0 }, { -1 }, { 1 } }, "sigmas" },
        { { { 0 }, { infinity }, { 1 } }, "sigmas" },
        { { { 0 }, { notANumber }, { 1 } }, "sigmas" },
        { { { 0 }, { 1 }, { notANumber } }, "weights" },
        { { { 0 }, { 1 }, { 0.9 } }, "weights" },
        { { { 0 }, { 1 }, { 1.1 } }, "weights" },
        { { { 0, 0 }, { 1, 1 }, { 1.5, -0.5 } }, "weights" },
        { { { 0, 0 }, { 1, 1 }, { 0, 0 } }, "weights" },
        { { Numbers(1025, 0), Numbers(1025, 1), Numbers(1025, 1. / 1025) }, "means" },
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); ++i)
    {
        SCOPED_TRACE(i);
        const Mixture& m = cases[i].mixture;
        expectRejected([&] { model->addLayer(m.means, m.sigmas, m.weights); }, cases[i].argument);
        expectEqualModels(*createTwoLayerModel(), *model);
    }
}

//! What a model can have, its file can have, too.
TEST(HDPStereo_PredictionModel, largest_model)
{
    const int mostLayers = 64, most = 1024;
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    for (int layer = 0; layer < mostLayers; ++layer)
        model->addLayer(Numbers(most, 0), Numbers(most, 1), Numbers(most, 1. / most));
    expectRejected([&] { model->addLayer({ 0 }, { 1 }, { 1 }); }, "64 layers");
    expectRejected([&] { model->train(std::vector<Mat>(), std::vector<Mat>(), 1, 0); }, "64 layers");
    const Ptr<DisparityPredictionModel> read = DisparityPredictionModel::create();
    deserialize(serialized(*model), *read);
    expectEqualModels(*model, *read);
}

TEST(HDPStereo_PredictionModel, layer_out_of_range_is_rejected)
{
    const Ptr<DisparityPredictionModel> model = createTwoLayerModel();
    for (int layer : { -1, 2, INT_MIN, INT_MAX })
    {
        expectRejected([&] { model->density(layer, 0); }, "layer");
        expectRejected([&] { getLayer(*model, layer); }, "layer");
    }
    for (int which : { -1, 4 })
        expectRejected([&] { DisparityPredictionModel::createPublished(which); }, "which");
}

////////////////////////////////////////////// its files //////////////////////////////////////////////

TEST(HDPStereo_PredictionModel, write_and_read)
{
    for (const char* extension : { "yml", "xml", "json" })
        for (int which : { DisparityPredictionModel::PUBLISHED_LARGE, DisparityPredictionModel::PUBLISHED_SMALL })
        {
            const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::createPublished(which);
            const Ptr<DisparityPredictionModel> read = createTwoLayerModel();
            deserialize(serialized(*model, extension), *read);
            expectEqualModels(*model, *read);
        }
}

TEST(HDPStereo_PredictionModel, save_and_load)
{
    const Ptr<DisparityPredictionModel> model = createTwoLayerModel();
    for (const char* extension : { ".yml", ".xml", ".json", ".yml.gz" })
    {
        const TemporaryFile file(extension);
        model->save(file.name);
        expectEqualModels(*model, *DisparityPredictionModel::load(file.name));
    }
}

//! Expects that a text is not taken for a model, neither by read() nor by load().
void expectNoModel(const std::string& text)
{
    SCOPED_TRACE(text);
    const Ptr<DisparityPredictionModel> model = createTwoLayerModel();
    EXPECT_THROW(deserialize(text, *model), cv::Exception);
    expectEqualModels(*createTwoLayerModel(), *model);

    const TemporaryFile file(".yml");
    std::ofstream(file.name.c_str()) << text;
    EXPECT_THROW(DisparityPredictionModel::load(file.name), cv::Exception);
}

std::string replaced(std::string text, const std::string& what, const std::string& with)
{
    const size_t at = text.find(what);
    CV_Assert(at != std::string::npos);
    return text.replace(at, what.size(), with);
}

TEST(HDPStereo_PredictionModel, malformed_file_is_rejected)
{
    expectNoModel("");
    expectNoModel("%YAML:1.0\n---\n");
    expectNoModel("%YAML:1.0\n---\nsomething: 1\n");
    expectNoModel("%YAML:1.0\n---\nsomething: { means: [ 0. ], sigmas: [ 1. ], weights: [ 1. ] }\n");
    expectNoModel("not a model at all");
    EXPECT_THROW(DisparityPredictionModel::load(cv::tempfile("_missing.yml")), cv::Exception);
    EXPECT_THROW(DisparityPredictionModel::load(""), cv::Exception);
    const Ptr<DisparityPredictionModel> model = createTwoLayerModel();
    EXPECT_THROW(model->read(FileNode()), cv::Exception);
    expectEqualModels(*createTwoLayerModel(), *model);

    const std::string text = serialized(*model);
    deserialize(text, *model); // the unchanged text is fine
    expectNoModel(text.substr(0, text.find("sigmas")));
    expectNoModel(replaced(text, model->getDefaultName(), "my_object"));
    for (const char* key : { "name", "layerCount", "layers", "means", "sigmas", "weights" })
        expectNoModel(replaced(text, key, "other"));
    const struct
    {
        const char *number, *shortNumber; // as OpenCV 4.6 and 4.10 write it
        const char* values[8];
    } hostile[] = {
        { "6.2500000000000000e-01",
          "0.625",
          { ".Nan", ".Inf", "-.Inf", "text", "\"0.5\"", "[ 1., 2. ]", "1., 2.", 0 } },
        { "1.3750000000000000e+00",
          "1.375",
          { ".Nan", ".Inf", "0.", "-1.375", "\"1.375\"", "{ a: 1. }", "1., 2.", 0 } },
        { "7.5000000000000000e-01", "0.75", { ".Nan", ".Inf", "-0.75", "0.", "1e300", "\"0.75\"", "0.5, 0.25", 0 } },
    };
    for (const auto& h : hostile)
        for (const char* const* value = h.values; *value; ++value)
        {
            const bool isShort = text.find(h.number) == std::string::npos;
            expectNoModel(replaced(text, isShort ? h.shortNumber : h.number, *value));
        }
}

//////////////////////////////////////////// the intervals ////////////////////////////////////////////

void testIntervals(const DisparityPredictionModel& model, int layer, const Numbers& prior, int upperDisparities,
                   double delta, int margin = 0)
{
    SCOPED_TRACE(testing::Message() << "layer " << layer << ", disparities " << prior.size() << " of "
                                    << upperDisparities << ", delta " << delta << ", margin " << margin);
    std::vector<hdp::DisparityInterval> intervals;
    hdp::predictIntervals(model, layer, prior, upperDisparities, delta, margin, intervals);
    const Mat_<double> posterior = oracle::posterior(model, layer, prior, upperDisparities);
    ASSERT_EQ((size_t)upperDisparities, intervals.size());
    for (int i = 0; i < upperDisparities; ++i)
    {
        const hdp::DisparityInterval expected = oracle::pixelInterval(posterior.row(i), delta, margin);
        ASSERT_EQ(expected.empty(), intervals[i].empty()) << "row " << i;
        if (!expected.empty())
        {
            ASSERT_EQ(expected.first, intervals[i].first) << "row " << i;
            ASSERT_EQ(expected.last, intervals[i].last) << "row " << i;
        }
    }
}

Numbers randomPrior(RNG& rng, int size, int zerosOutOf10)
{
    Numbers prior(size);
    for (double& p : prior)
        p = rng.uniform(0, 10) < zerosOutOf10 ? 0 : rng.uniform(1, 1000);
    return prior;
}

TEST(HDPStereo_PixelIntervals, literal_criterion_on_the_full_matrix)
{
    RNG rng(10);
    for (int which : { DisparityPredictionModel::PUBLISHED_LARGE, DisparityPredictionModel::PUBLISHED_SMALL })
    {
        const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::createPublished(which);
        for (int layer = 0; layer < model->getNumLayers(); ++layer)
            for (int disparities : { 1, 2, 3, 17, 64, 129, 256 })
                for (double delta : { 0., 0.001, 0.004, 0.016, 0.064, 0.128, 0.3, 0.5, 0.9 })
                    for (int zeros : { 0, 5, 9 })
                        testIntervals(*model, layer, randomPrior(rng, disparities, zeros), (disparities - 1) / 2 + 1,
                                      delta);
    }
}

TEST(HDPStereo_PixelIntervals, margin_on_both_sides)
{
    RNG rng(34);
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    for (int disparities : { 1, 2, 17, 64, 255 })
        for (double delta : { 0.004, 0.02, 0.3 })
            for (int margin : { 1, 2, 7, 64 })
                for (int zeros : { 0, 9 })
                    testIntervals(*model, rng.uniform(0, 2), randomPrior(rng, disparities, zeros),
                                  (disparities - 1) / 2 + 1, delta, margin);

    std::vector<hdp::DisparityInterval> without, with;
    hdp::predictIntervals(*model, 0, Numbers(64, 1), 32, 0.02, 0, without);
    hdp::predictIntervals(*model, 0, Numbers(64, 1), 32, 0.02, 3, with);
    for (int i = 0; i < 32; ++i)
    {
        EXPECT_EQ(std::max(without[i].first - 3, 0), with[i].first);
        EXPECT_EQ(std::min(without[i].last + 3, 63), with[i].last);
    }
}

TEST(HDPStereo_PixelIntervals, rows_without_probability_are_empty)
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    model->addLayer(Numbers{ 0 }, Numbers{ 0.01 }, Numbers{ 1 }); // offsets other than 0 underflow
    Numbers prior(40, 1);
    prior[10] = prior[11] = 0; // all that D_{l+1} = 5 can come from
    testIntervals(*model, 0, prior, 20, 0.01);
    std::vector<hdp::DisparityInterval> intervals;
    hdp::predictIntervals(*model, 0, prior, 20, 0.01, 0, intervals);
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(i == 5 ? 0 : 2, intervals[i].size()) << i;
    testIntervals(*model, 0, Numbers(40, 0), 20, 0.01);
    for (int margin : { 1, 64 }) // what is empty stays it
    {
        testIntervals(*model, 0, prior, 20, 0.01, margin);
        testIntervals(*model, 0, Numbers(40, 0), 20, 0.01, margin);
    }
}

TEST(HDPStereo_PixelIntervals, the_larger_delta_the_shorter)
{
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    const Numbers uniform(128, 1);
    std::vector<hdp::DisparityInterval> wide, narrow;
    hdp::predictIntervals(*model, 0, uniform, 64, 0.004, 0, wide);
    hdp::predictIntervals(*model, 0, uniform, 64, 0.064, 0, narrow);
    for (int i = 0; i < 64; ++i)
    {
        EXPECT_GT(wide[i].size(), narrow[i].size());
        EXPECT_LE(narrow[i].first, 2 * i + 1); // both hold what half the disparity says
        EXPECT_GE(narrow[i].last, 2 * i);
    }
}

TEST(HDPStereo_PixelIntervals, prior_from_the_layer_above)
{
    RNG rng(35);
    for (const Size& size : { Size(1, 1), Size(1, 9), Size(30, 20) })
        for (int numDisparities : { 1, 2, 3, 16, 31, 300 })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << numDisparities << " disparities");
            const int largest = (numDisparities - 1) / 2;
            const Mat upper = randomImage(rng, size, CV_16UC1, hdp::subpixelScale * largest + 1);
            Numbers histogram(5, 7.); // a buffer of another size
            hdp::upperHistogram(upper, numDisparities, histogram);
            EXPECT_EQ(oracle::upperHistogram(upper, numDisparities), histogram);
        }
}

TEST(HDPStereo_PixelIntervals, assigned_from_the_pixel_above)
{
    RNG rng(11);
    std::vector<hdp::DisparityInterval> intervals;
    for (int i = 0; i < 50; ++i)
    {
        const hdp::DisparityInterval interval = { (ushort)rng.uniform(0, 100), (ushort)rng.uniform(0, 100) };
        intervals.push_back(interval);
    }
    for (const Size& size : { Size(2, 2), Size(3, 2), Size(2, 5), Size(40, 30), Size(41, 31) })
    {
        SCOPED_TRACE(testing::Message() << size);
        const Mat upper =
            randomImage(rng, Size(size.width / 2, size.height / 2), CV_16UC1, 49 * hdp::subpixelScale + 1);
        Mat assigned;
        hdp::assignIntervals(upper, size, intervals, assigned);
        Mat expected(size, CV_16UC2);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const ushort above =
                    upper.at<ushort>(oracle::clamped(y / 2, upper.rows), oracle::clamped(x / 2, upper.cols));
                const int nearest = (int)std::floor((double)above / hdp::subpixelScale + 0.5);
                expected.at<Vec2w>(y, x) = Vec2w(intervals[nearest].first, intervals[nearest].last);
            }
        expectIdentical(expected, assigned);
    }
}

}} // namespace opencv_test
