// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Training of the model, and its files in testdata/cv/hdpstereo/models.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

#include <fstream>
#include <set>

#include "opencv2/opencv_modules.hpp"

namespace opencv_test { namespace {

typedef std::vector<double> Numbers;

const float unknown = std::numeric_limits<float>::infinity();

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

//! Maps D_l and D_{l+1}
struct MapPair
{
    Mat lower, upper;
};

//! Random disparities 100 .. 299, and above each 2 x 2 pixels of the same disparity one with an offset of the mixture
MapPair sampleMixture(const Mixture& mixture, Size upperSize, RNG& rng)
{
    MapPair maps = { Mat(upperSize * 2, CV_32F), Mat(upperSize, CV_32F) };
    for (int y = 0; y < upperSize.height; ++y)
        for (int x = 0; x < upperSize.width; ++x)
        {
            double rest = rng.uniform(0., 1.);
            size_t k = 0;
            for (; k + 1 < mixture.weights.size() && rest >= mixture.weights[k]; ++k)
                rest -= mixture.weights[k];
            const int lower = rng.uniform(100, 300);
            const int offset = cvRound(mixture.means[k] + rng.gaussian(mixture.sigmas[k]));
            maps.lower(Rect(2 * x, 2 * y, 2, 2)).setTo(lower);
            maps.upper.at<float>(y, x) = (float)(lower / 2 + offset);
        }
    return maps;
}

Mixture narrowAndWide() { return Mixture{ { 0.5, -9 }, { 1, 6 }, { 0.7, 0.3 } }; }

///////////////////////////////////////////// the histogram //////////////////////////////////////////////

TEST(HDPStereo_ModelTraining, offsets_by_hand)
{
    const float u = unknown, n = std::numeric_limits<float>::quiet_NaN();
    const Mat lower = Mat_<float>({ 4, 5 }, { 7, 6,  10, u,    3, //
                                              5, -1, 10, 11,   4, //
                                              0, 1,  8,  8,    9, //
                                              n, 2,  8,  8.4f, 9 });
    const Mat upper = Mat_<float>({ 2, 2 }, { 3, 6, 0, u });
    // Above the pixels of the first two rows 3, 3, 6, 6 and again 6 (the last column is odd), of the others 0 and unknown:
    //   3 - {3, 3, 2} = {0, 0, 1}, 6 - {5, 5, 5, 1, 2} = {1, 1, 1, 5, 4}, 0 - {0, 0, 1} = {0, 0, -1}
    std::vector<int> offsets;
    Numbers counts;
    DisparityPredictionModel::countOffsets(std::vector<Mat>(1, lower), std::vector<Mat>(1, upper), offsets, counts);
    EXPECT_EQ((std::vector<int>{ -1, 0, 1, 4, 5 }), offsets);
    EXPECT_EQ((Numbers{ 1, 4, 4, 1, 1 }), counts);

    DisparityPredictionModel::countOffsets(std::vector<Mat>(3, lower), std::vector<Mat>(3, upper), offsets, counts);
    EXPECT_EQ((std::vector<int>{ -1, 0, 1, 4, 5 }), offsets);
    EXPECT_EQ((Numbers{ 3, 12, 12, 3, 3 }), counts);
}

TEST(HDPStereo_ModelTraining, rounding)
{
    const Mat lower = Mat_<float>({ 2, 2 }, { 6.6f, 7.4f, 6.f, 7.9f }), upper = Mat_<float>(1, 1, 2.6f);
    std::vector<int> offsets;
    Numbers counts;
    DisparityPredictionModel::countOffsets(std::vector<Mat>(1, lower), std::vector<Mat>(1, upper), offsets, counts);
    EXPECT_EQ(std::vector<int>{ 0 }, offsets); // 3 - floor(6 / 2) and 3 - floor(7 / 2)
    EXPECT_EQ(Numbers{ 4 }, counts);
}

////////////////////////////////////////////// bad input /////////////////////////////////////////////////

void expectUntrained(const std::vector<Mat>& lower, const std::vector<Mat>& upper, const std::string& argument,
                     int maxComponents = 2, int seed = 0)
{
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    const std::string before = serialized(*model);
    expectRejected([&] { model->train(lower, upper, maxComponents, seed); }, argument);
    EXPECT_EQ(before, serialized(*model));
}

std::vector<Mat> one(const Mat& map) { return std::vector<Mat>(1, map); }

TEST(HDPStereo_ModelTraining, bad_arguments)
{
    RNG rng(3);
    const MapPair good = sampleMixture(narrowAndWide(), Size(40, 30), rng);
    const std::vector<Mat> none;
    expectUntrained(none, none, "disparities");
    expectUntrained(one(good.lower), none, "upperDisparities");
    expectUntrained(one(good.lower), std::vector<Mat>(2, good.upper), "upperDisparities");
    expectUntrained(one(Mat()), one(good.upper), "disparities");
    expectUntrained(one(good.lower), one(Mat()), "upperDisparities");
    Mat other;
    good.lower.convertTo(other, CV_16S);
    expectUntrained(one(other), one(good.upper), "disparities must be CV_32FC1");
    good.upper.convertTo(other, CV_64F);
    expectUntrained(one(good.lower), one(other), "upperDisparities must be CV_32FC1");
    expectUntrained(one(good.lower), one(good.upper.colRange(1, 40)), "upperDisparities must have half the size");
    expectUntrained(one(good.lower), one(good.lower), "upperDisparities must have half the size");
    for (int maxComponents : { 0, -1, 65 })
        expectUntrained(one(good.lower), one(good.upper), "maxComponents", maxComponents);
    expectUntrained(one(good.lower), one(good.upper), "seed", 2, -1);
}

#ifndef HAVE_OPENCV_ML

TEST(HDPStereo_ModelTraining, needs_opencv_ml)
{
    RNG rng(3);
    const MapPair maps = sampleMixture(narrowAndWide(), Size(40, 30), rng);
    expectUntrained(one(maps.lower), one(maps.upper), "opencv_ml");
}

#else

TEST(HDPStereo_ModelTraining, degenerate_maps)
{
    RNG rng(4);
    const MapPair good = sampleMixture(narrowAndWide(), Size(40, 30), rng);
    const Mat flat(good.lower.size(), CV_32F, Scalar(20)), flatUpper(good.upper.size(), CV_32F, Scalar(11)),
        empty(good.lower.size(), CV_32F, Scalar(unknown));
    expectUntrained(one(flat), one(flatUpper), "disparities must not be all the same");
    expectUntrained(one(flat), one(good.upper), "disparities must not be all the same");
    expectUntrained(std::vector<Mat>(2, flat), std::vector<Mat>(2, good.upper), "disparities must not be all the same");
    expectUntrained(one(empty), one(good.upper), "at least 100 pixels");
    expectUntrained(one(good.lower(Rect(0, 0, 12, 12))), one(good.upper(Rect(0, 0, 6, 6))), "at least 100 pixels");
    // Halves of even disparities: the offset is 0 everywhere.
    Mat even(good.lower.size(), CV_32F), half(good.upper.size(), CV_32F);
    for (int y = 0; y < half.rows; ++y)
        for (int x = 0; x < half.cols; ++x)
        {
            half.at<float>(y, x) = (float)(x + y);
            even(Rect(2 * x, 2 * y, 2, 2)).setTo(2 * (x + y));
        }
    expectUntrained(one(even), one(half), "same offset");
    expectUntrained({ even, good.lower }, { half, good.upper }, "in either half of the maps");
    Mat huge = good.lower.clone();
    huge.at<float>(3, 5) = 1e9f;
    expectUntrained(one(huge), one(good.upper), "at most 32767");
}

//! Expects the components of a model of one layer, the heaviest first.
void expectMixture(const Mixture& expected, const Mixture& actual, double tolerance)
{
    ASSERT_EQ(expected.means.size(), actual.means.size());
    for (size_t k = 0; k < expected.means.size(); ++k)
    {
        EXPECT_NEAR(expected.means[k], actual.means[k], tolerance * expected.sigmas[k]) << "component " << k;
        EXPECT_NEAR(expected.sigmas[k], actual.sigmas[k], tolerance * expected.sigmas[k]) << "component " << k;
        EXPECT_NEAR(expected.weights[k], actual.weights[k], tolerance) << "component " << k;
    }
}

TEST(HDPStereo_SlowModelTraining, recovers_a_known_mixture)
{
    const Mixture mixtures[] = { narrowAndWide(),
                                 { { -3 }, { 2.5 }, { 1 } },
                                 { { 0.25, 15, -25 }, { 0.8, 5, 8 }, { 0.6, 0.25, 0.15 } } };
    for (const Mixture& mixture : mixtures)
        for (int maps : { 1, 3 })
        {
            SCOPED_TRACE(testing::Message() << mixture.means.size() << " components, " << maps << " maps");
            RNG rng(5);
            std::vector<Mat> lower, upper;
            for (int i = 0; i < maps; ++i)
            {
                const MapPair pair = sampleMixture(mixture, Size(160, 120), rng);
                lower.push_back(pair.lower);
                upper.push_back(pair.upper);
            }
            const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
            model->train(lower, upper, (int)mixture.means.size());
            ASSERT_EQ(1, model->getNumLayers());
            // Offsets are whole numbers: rounding adds 1 / 12 to the variance.
            Mixture rounded = mixture;
            for (double& sigma : rounded.sigmas)
                sigma = std::sqrt(sigma * sigma + 1. / 12);
            expectMixture(rounded, getLayer(*model, 0), 0.1);
        }
}

//! The density must come as near to what was sampled as the true mixture does, whatever the number of components.
TEST(HDPStereo_SlowModelTraining, chooses_enough_components)
{
    const Mixture mixture{ { 0.25, 15, -25 }, { 0.8, 5, 8 }, { 0.6, 0.25, 0.15 } };
    RNG rng(6);
    std::vector<Mat> lower, upper;
    for (int i = 0; i < 4; ++i)
    {
        const MapPair pair = sampleMixture(mixture, Size(100, 80), rng);
        lower.push_back(pair.lower);
        upper.push_back(pair.upper);
    }
    const Ptr<DisparityPredictionModel> truth = DisparityPredictionModel::create(), few = truth->create(),
                                        enough = truth->create();
    truth->addLayer(mixture.means, mixture.sigmas, mixture.weights);
    const double fewLikelihood = few->train(lower, upper, 2), likelihood = enough->train(lower, upper, 5);
    EXPECT_LE(getLayer(*few, 0).means.size(), 2u);
    EXPECT_GE(getLayer(*enough, 0).means.size(), 3u);
    EXPECT_LE(getLayer(*enough, 0).means.size(), 5u);

    std::vector<int> offsets;
    Numbers counts;
    DisparityPredictionModel::countOffsets(lower, upper, offsets, counts);
    double expected = 0, actual = 0, worse = 0, total = 0;
    for (size_t i = 0; i < offsets.size(); ++i)
    {
        total += counts[i];
        expected += counts[i] * std::log(truth->density(0, offsets[i]));
        actual += counts[i] * std::log(enough->density(0, offsets[i]));
        worse += counts[i] * std::log(few->density(0, offsets[i]));
    }
    EXPECT_GT(actual / total, expected / total - 0.02);
    EXPECT_LT(worse / total, actual / total - 0.05);
    EXPECT_NEAR(actual / total, likelihood, 0.05);
    EXPECT_NEAR(worse / total, fewLikelihood, 0.05);
}

//! More Gaussians are only taken if they make the half that they were not fitted to more likely.
TEST(HDPStereo_SlowModelTraining, components_are_chosen_by_the_other_half)
{
    bool isFewerEnough = false;
    for (int set = 0; set < 3; ++set)
    {
        RNG rng(20 + set);
        std::vector<Mat> lower, upper; // so small that each has chance peaks that the other one has not
        for (int i = 0; i < 2; ++i)
        {
            const MapPair pair = sampleMixture(Mixture{ { 0 }, { 4 }, { 1 } }, Size(8, 6), rng);
            lower.push_back(pair.lower);
            upper.push_back(pair.upper);
        }
        const Ptr<DisparityPredictionModel> few = DisparityPredictionModel::create(), more = few->create();
        const double fewLikelihood = few->train(lower, upper, 1), likelihood = more->train(lower, upper, 2);
        EXPECT_GE(likelihood, fewLikelihood);
        if (likelihood == fewLikelihood)
        {
            isFewerEnough = true;
            EXPECT_EQ(getLayer(*few, 0).means, getLayer(*more, 0).means);
        }
    }
    EXPECT_TRUE(isFewerEnough);
}

//! The seed chooses the half that the Gaussians are fitted to, and so the likelihood of the other one.
TEST(HDPStereo_ModelTraining, seed_counts)
{
    RNG rng(10);
    std::vector<Mat> lower, upper;
    for (int i = 0; i < 4; ++i)
    {
        const MapPair pair = sampleMixture(Mixture{ { 2. * i }, { 1. + i }, { 1 } }, Size(20, 15), rng);
        lower.push_back(pair.lower);
        upper.push_back(pair.upper);
    }
    std::set<double> likelihoods;
    for (int seed = 0; seed < 8; ++seed)
        likelihoods.insert(DisparityPredictionModel::create()->train(lower, upper, 1, seed));
    EXPECT_GT(likelihoods.size(), 1u);
}

//! The last row of an odd number has the pixels above the row before it, in train() as in countOffsets().
TEST(HDPStereo_ModelTraining, odd_last_row_of_a_single_map)
{
    RNG rng(11);
    const MapPair even = sampleMixture(narrowAndWide(), Size(120, 8), rng);
    MapPair maps = { Mat(17, 240, CV_32F), even.upper };
    even.lower.copyTo(maps.lower.rowRange(0, 16));
    even.lower.row(15).copyTo(maps.lower.row(16)); // the only row of the other half
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    EXPECT_NO_THROW(model->train(one(maps.lower), one(maps.upper), 1));
    EXPECT_EQ(1, model->getNumLayers());
}

//! Offsets of two values only, which a Gaussian could follow to a width of 0
TEST(HDPStereo_ModelTraining, never_a_singular_model)
{
    RNG rng(7);
    MapPair maps = sampleMixture(Mixture{ { 0 }, { 0.01 }, { 1 } }, Size(64, 48), rng);
    for (int x = 0; x < maps.upper.cols; x += 8)
        maps.upper.col(x) += 40;
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    const double likelihood = model->train(one(maps.lower), one(maps.upper), 6);
    EXPECT_TRUE(cvIsInf(likelihood) == 0 && cvIsNaN(likelihood) == 0);
    const Mixture mixture = getLayer(*model, 0);
    for (size_t k = 0; k < mixture.sigmas.size(); ++k)
        EXPECT_GE(mixture.sigmas[k], std::max(0.5, std::abs(mixture.means[k]) / 4 - 1e-9));
    double near = 0, far = 0;
    for (int offset = -200; offset <= 200; ++offset)
        (offset <= 5 && offset >= -5 ? near : far) += model->density(0, offset);
    EXPECT_NEAR(7. / 8, near, 0.02); // 1 of 8 columns is 40 off
    EXPECT_NEAR(1. / 8, far, 0.02);
}

TEST(HDPStereo_SlowModelTraining, reproducible)
{
    RNG rng(8);
    std::vector<Mat> lower, upper;
    for (int i = 0; i < 4; ++i)
    {
        const MapPair pair = sampleMixture(narrowAndWide(), Size(60, 50), rng);
        lower.push_back(pair.lower);
        upper.push_back(pair.upper);
    }
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    const double likelihood = model->train(lower, upper, 3, 17);
    const int threads = cv::getNumThreads();
    for (int run = 0; run < 2; ++run)
    {
        cv::setNumThreads(run + 1);
        theRNG().next(); // nothing but the seed counts
        const uint64 state = theRNG().state;
        const Ptr<DisparityPredictionModel> again = DisparityPredictionModel::create();
        EXPECT_EQ(likelihood, again->train(lower, upper, 3, 17));
        EXPECT_EQ(serialized(*model), serialized(*again));
        EXPECT_EQ(state, theRNG().state);
    }
    cv::setNumThreads(threads);
}

TEST(HDPStereo_ModelTraining, appends_layers_that_a_matcher_takes)
{
    RNG rng(9);
    const MapPair maps = sampleMixture(narrowAndWide(), Size(60, 50), rng);
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    for (int layer = 0; layer < 2; ++layer)
    {
        EXPECT_EQ(layer, model->getNumLayers());
        model->train(one(maps.lower), one(maps.upper), 2);
    }
    EXPECT_EQ(2, model->getNumLayers());
    EXPECT_EQ(getLayer(*model, 0).means, getLayer(*model, 1).means);

    const TemporaryFile file(".yml");
    model->save(file.name);
    EXPECT_EQ(serialized(*model), serialized(*DisparityPredictionModel::load(file.name)));

    const SyntheticPair pair = makeSyntheticPair(Size(80, 60), 16, 6);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16, HDPTreeMatcher::PRESET_PAPER);
    change(*matcher, [&](Params& p) { p.predictionModel = DisparityPredictionModel::load(file.name); });
    EXPECT_EQ(pair.left.size(), match(*matcher, pair.left, pair.right).size());
}

#endif

//////////////////////////////////////////// models in files /////////////////////////////////////////////

struct ModelFile
{
    const char* name;
    int which;
};

const ModelFile modelFiles[] = {
    { "published_large.yml", DisparityPredictionModel::PUBLISHED_LARGE },
    { "published_small.yml", DisparityPredictionModel::PUBLISHED_SMALL },
};

TEST(HDPStereo_ModelFiles, equal_to_those_built_in)
{
    for (const ModelFile& file : modelFiles)
    {
        SCOPED_TRACE(file.name);
        const Ptr<DisparityPredictionModel> builtIn = DisparityPredictionModel::createPublished(file.which);
        const Ptr<DisparityPredictionModel> read =
            DisparityPredictionModel::load(cvtest::findDataFile(std::string("hdpstereo/models/") + file.name));
        ASSERT_EQ(builtIn->getNumLayers(), read->getNumLayers());
        for (int layer = 0; layer < read->getNumLayers(); ++layer)
        {
            const Mixture expected = getLayer(*builtIn, layer), actual = getLayer(*read, layer);
            EXPECT_EQ(expected.means, actual.means);
            EXPECT_EQ(expected.sigmas, actual.sigmas);
            EXPECT_EQ(expected.weights, actual.weights);
        }
    }
}

TEST(HDPStereo_ModelFiles, trained_ones)
{
    for (const char* file : { "trained_large.yml", "trained_small.yml" })
        EXPECT_EQ(2, DisparityPredictionModel::load(cvtest::findDataFile(std::string("hdpstereo/models/") + file))
                         ->getNumLayers())
            << file;
}

TEST(HDPStereo_ModelFiles, empty_one)
{
    for (const char* extension : { ".xml", ".yml", ".json" })
    {
        const String path = tempfile(extension);
        DisparityPredictionModel::create()->save(path);
        EXPECT_EQ(0, DisparityPredictionModel::load(path)->getNumLayers()) << extension;
        std::remove(path.c_str());
    }
}

//! Reading must throw and change neither a model nor the matcher that has it.
void expectHostile(const std::string& text)
{
    SCOPED_TRACE(text.substr(0, 300));
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16, HDPTreeMatcher::PRESET_PAPER);
    const Ptr<DisparityPredictionModel> model =
        DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    change(*matcher, [&](Params& p) { p.predictionModel = model; });
    const std::string before = serialized(*matcher);
    EXPECT_THROW(deserialize(text, *model), cv::Exception);
    EXPECT_EQ(before, serialized(*matcher));
    EXPECT_EQ(model.get(), matcher->getParams().predictionModel.get());
}

std::string modelText(int version, const std::string& layers, int layerCount = 1)
{
    return cv::format(
               "%%YAML:1.0\n---\nname: hdpstereo_DisparityPredictionModel\nversion: %d\nlayerCount: %d\nlayers: ",
               version, layerCount) +
           layers + "\n";
}

TEST(HDPStereo_ModelFiles, hostile_ones_change_nothing)
{
    const std::string good = "[ { means: [ 0. ], sigmas: [ 1. ], weights: [ 1. ] } ]";
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    deserialize(modelText(1, good), *model);
    EXPECT_EQ(1, model->getNumLayers());

    for (int version : { 0, 2, -1, 2147483647 })
        expectHostile(modelText(version, good));
    // Nothing is wrong with these but their number.
    std::string zeros, ones, layers = "[ ";
    for (int k = 0; k < 5000; ++k)
    {
        zeros += ", 0.";
        ones += ", 1.";
    }
    for (int l = 0; l < 200; ++l)
        layers += std::string(l ? ", " : "") + "{ means: [ 0. ], sigmas: [ 1. ], weights: [ 1. ] }";
    layers += " ]";
    expectHostile(
        modelText(1, "[ { means: [ 0." + zeros + " ], sigmas: [ 1." + ones + " ], weights: [ 1." + zeros + " ] } ]"));
    expectHostile(modelText(1, layers, 200));
    for (int layerCount : { 0, 2, -1, 2147483647 })
        expectHostile(modelText(1, good, layerCount));
    for (const char* layer :
         { "{ means: [ .Nan ], sigmas: [ 1. ], weights: [ 1. ] }",
           "{ means: [ 0. ], sigmas: [ -1. ], weights: [ 1. ] }", "{ means: [ 0. ], sigmas: [ 0. ], weights: [ 1. ] }",
           "{ means: [ 0. ], sigmas: [ .Inf ], weights: [ 1. ] }",
           "{ means: [ 0. ], sigmas: [ 1. ], weights: [ .Nan ] }", "{ means: [ 0. ], sigmas: [ 1. ] }",
           "{ means: [ 0., 1. ], sigmas: [ 1., 1. ], weights: [ 1. ] }", "{ means: [ ], sigmas: [ ], weights: [ ] }",
           "{ means: text, sigmas: [ 1. ], weights: [ 1. ] }", "[ 0., 1., 1. ]", "7" })
        expectHostile(modelText(1, std::string("[ ") + layer + " ]"));
    expectHostile(modelText(1, "7"));
    expectHostile(serialized(*HDPTreeMatcher::create()));
    expectHostile(serialized(*StereoBM::create()));
}

TEST(HDPStereo_ModelFiles, truncated_ones_change_nothing)
{
    const std::string text =
        serialized(*DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE));
    // From the last number on, nothing but brackets is missing, which the parser may forgive.
    const size_t last = text.find_last_of("0123456789");
    for (size_t length = 0; length < last - 40; length += 7)
        expectHostile(text.substr(0, length));
}

TEST(HDPStereo_ModelFiles, exceptions_name_the_file)
{
    const TemporaryFile foreign(".yml"), other(".yml");
    std::ofstream(foreign.name.c_str()) << "root:x:0:0\n";
    HDPTreeMatcher::create()->save(other.name);
    for (const std::string& name : { foreign.name, other.name, foreign.name + ".none" })
        expectRejected([&] { DisparityPredictionModel::load(name); }, "filename: '" + name + "'");
    const TemporaryFile number(".yml");
    for (const char* text : { "%YAML:1.0\n---\na: 5\n", "%YAML:1.0\n---\n- 5\n" }) // no maps
    {
        std::ofstream(number.name.c_str()) << text;
        expectRejected([&] { DisparityPredictionModel::load(number.name); }, "a model must be a map");
    }
}

//! A matcher says that a model is too small before it works, and is as it was.
TEST(HDPStereo_ModelFiles, model_without_enough_layers)
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    deserialize(modelText(1, "[ { means: [ 0. ], sigmas: [ 1. ], weights: [ 1. ] } ]"), *model);
    const SyntheticPair pair = makeSyntheticPair(Size(80, 60), 16, 6);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16, HDPTreeMatcher::PRESET_PAPER);
    change(*matcher, [&](Params& p) { p.predictionModel = model; });
    Mat disparity(3, 3, CV_8U, Scalar(9));
    expectRejected([&] { matcher->compute(pair.left, pair.right, disparity); }, "predictionModel");
    EXPECT_EQ(9 * 9, sum(disparity)[0]);
    change(*matcher, [&](Params& p) { p.numLayers = 2; });
    EXPECT_NO_THROW(matcher->compute(pair.left, pair.right, disparity));
}

}} // namespace opencv_test
