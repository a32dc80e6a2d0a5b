// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Trains a cv::stereo::DisparityPredictionModel on stereo pairs with known truth. From the top layer downwards, the
// matcher finds the disparities of a layer, with the part of the model that is there already; they and the truth of the
// layer below give the next mixture. So the model learns from what it will be given.

#include <cstdio>
#include <fstream>
#include <iostream>
#include <numeric>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/layers.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"

using namespace cv;
using namespace hdp_tools;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@root           |     | folder of Middlebury or KITTI pairs with truth }"
    "{o output        |     | the model: FILE.yml, .xml or .json }"
    "{resolution      |     | of Middlebury's: full, half, third or quarter; needed if the folder has several }"
    "{fraction        | 0.5 | share of the pairs to train on; the model is tested on the others }"
    "{seed            | 0   | seed of the choice of pairs, and of the training }"
    "{layers          | 3   | layers of the matcher, the image included; the model has one mixture less. Other "
    "programs "
    "need 3 or more }"
    "{max-components  | 6   | most Gaussians of a mixture, up to 16 }"
    "{picture         |     | FILE.png for the fitted and the sampled distributions of the offsets }"
    "{threads         |     | number of threads; all processors if not given }";

//! A scene on its way down the pyramid
struct TrainingScene
{
    String name;
    Pair pair;
    bool isHeldOut;
    Mat truth, upper; // D_l and D_{l+1} of the layer in work
};

//! D_l and D_{l+1} of the scenes that are held out, or of the others
struct Samples
{
    std::vector<Mat> truths, uppers;

    Samples(const std::vector<TrainingScene>& scenes, bool heldOut)
    {
        for (const TrainingScene& scene : scenes)
            if (scene.isHeldOut == heldOut)
            {
                truths.push_back(scene.truth);
                uppers.push_back(scene.upper);
            }
    }
};

struct Offsets
{
    std::vector<int> offsets;
    std::vector<double> counts;

    explicit Offsets(const Samples& samples)
    {
        DisparityPredictionModel::countOffsets(samples.truths, samples.uppers, offsets, counts);
    }

    double total() const { return std::accumulate(counts.begin(), counts.end(), 0.); }

    double meanLogLikelihood(const DisparityPredictionModel& model, int layer) const
    {
        double sum = 0;
        for (size_t i = 0; i < offsets.size(); i++)
            sum += counts[i] * std::log(std::max(model.density(layer, offsets[i]), DBL_MIN));
        return sum / total();
    }
};

//! Pairs with truth of the only set that is left by the resolution, in random order, those to be held out last. Pairs that
//! cannot be read are named, left out and counted.
static std::vector<TrainingScene> readScenes(const CommandLineParser& parser, int& bad)
{
    const String resolution = parser.get<String>("resolution");
    std::vector<Scene> scenes = findScenes(parser.get<String>("@root"));
    scenes.erase(std::remove_if(
                     scenes.begin(), scenes.end(),
                     [&](const Scene& scene) {
        return scene.truth.empty() || (!resolution.empty() && scene.resolution != resolution);
                     }),
                 scenes.end());
    if (scenes.empty())
        fail("no pairs with truth in '" + parser.get<String>("@root") + "'" +
             (resolution.empty() ? String() : " of the resolution '" + resolution + "'"));
    for (const Scene& scene : scenes)
        if (scene.set != scenes[0].set)
            fail("there are several sets, such as " + scenes[0].set + " and " + scene.set +
                 ": choose one by its folder or by --resolution");

    RNG rng(uint64(getInteger(parser, "seed", 0, std::numeric_limits<int>::max())) + 1);
    for (size_t i = scenes.size() - 1; i > 0; i--)
        std::swap(scenes[i], scenes[size_t(rng.uniform(0, int(i) + 1))]);
    const double fraction = getNumber(parser, "fraction", 0, 1);

    std::vector<TrainingScene> result;
    for (const Scene& scene : scenes)
    {
        try
        {
            const TrainingScene read = { scene.name, readPair(scene), true, Mat(), Mat() };
            result.push_back(read);
        }
        catch (const std::exception& e)
        {
            std::cerr << "skipped " << scene.name << ": " << messageOf(e) << std::endl;
        }
    }
    bad = int(scenes.size() - result.size());
    if (result.empty())
        fail("none of the pairs can be read");
    const size_t count = size_t(std::max(cvRound(fraction * double(result.size())), 1));
    for (size_t i = 0; i < count; i++)
        result[i].isHeldOut = false;
    return result;
}

static String listNames(const std::vector<TrainingScene>& scenes, bool heldOut)
{
    String list;
    for (const TrainingScene& scene : scenes)
        if (scene.isHeldOut == heldOut)
            list += (list.empty() ? "" : ",") + scene.name;
    return list.empty() ? "none" : list;
}

//! The paper's system HDP+MST
static Ptr<stereo::HDPTreeMatcher> createMatcher(const Pair& pair, int layers,
                                                 const Ptr<DisparityPredictionModel>& model, int finestLayer = 0)
{
    const Ptr<stereo::HDPTreeMatcher> matcher =
        stereo::HDPTreeMatcher::create(0, pair.disparities.size(), stereo::HDPTreeMatcher::PRESET_PAPER);
    stereo::HDPTreeMatcher::Params params(stereo::HDPTreeMatcher::PRESET_PAPER);
    params.numLayers = layers;
    params.predictionModel = model;
    params.finestLayer = finestLayer;
    matcher->setParams(params);
    return matcher;
}

//! A mixture, the only one of a model or any, put below those of another model
static Ptr<DisparityPredictionModel> putBelow(const DisparityPredictionModel& mixture,
                                              const DisparityPredictionModel& above)
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    std::vector<double> means, sigmas, weights;
    mixture.getLayer(0, means, sigmas, weights);
    model->addLayer(means, sigmas, weights);
    for (int layer = 0; layer < above.getNumLayers(); layer++)
    {
        above.getLayer(layer, means, sigmas, weights);
        model->addLayer(means, sigmas, weights);
    }
    return model;
}

//! Finds D_{l+1} by the matcher with the mixtures above this layer, and D_l by the truth.
static void matchAbove(TrainingScene& scene, int layer, int layers, const Ptr<DisparityPredictionModel>& above)
{
    Ptr<DisparityPredictionModel> model = above;
    for (int l = 0; l <= layer; l++) // mixtures of layers that are not matched
        model = putBelow(*publishedModel(0), *model);
    const Pair& pair = scene.pair;
    const Ptr<stereo::HDPTreeMatcher> matcher = createMatcher(pair, layers, model, layer + 1);
    Mat disparity;
    matcher->compute(pair.left, pair.right, disparity);
    matcher->getLayerDisparity(layer + 1, scene.upper);
    if (scene.upper.empty())
        fail(format("an image of %d x %d pixels has no %d layers", pair.left.cols, pair.left.rows, layers));
    scene.truth = truthOfLayer(pair.truth, layer);
    // The pyramid leaves out the last column and row of an odd number.
    scene.truth = scene.truth(Rect(0, 0, scene.upper.cols * 2, scene.upper.rows * 2));
}

static Table modelTable(const DisparityPredictionModel& model)
{
    Table table;
    table.title = "Trained mixtures, in pixels of the layer above";
    table.header = { "layer", "mean", "standard deviation", "weight" };
    for (int layer = 0; layer < model.getNumLayers(); layer++)
    {
        std::vector<double> means, sigmas, weights;
        model.getLayer(layer, means, sigmas, weights);
        for (size_t k = 0; k < means.size(); k++)
        {
            table.addRow(format("%d", layer));
            table.addNumber(means[k], "%.4f");
            table.addNumber(sigmas[k], "%.4f");
            table.addNumber(weights[k], "%.4f");
        }
    }
    return table;
}

//! Sampled offsets of a layer as bars and their mixture, a model's only one, as a line, over a logarithmic scale
static Mat distributionPicture(const Offsets& sampled, const DisparityPredictionModel& mixture, int layer)
{
    const int width = 900, height = 320, left = 60, right = 20, top = 40, bottom = 40, lowestPower = -6;
    const int reach = 60; // offsets
    const auto column = [&](double offset) {
        return left + (offset + reach + 0.5) / (2 * reach + 1) * (width - left - right);
    };
    const auto row = [&](double probability) {
        const double power = std::max(std::log10(std::max(probability, 1e-300)), double(lowestPower));
        return top + power / lowestPower * (height - top - bottom);
    };
    Mat picture(height, width, CV_8UC3, Scalar::all(255));
    for (int power = lowestPower; power <= 0; power++)
    {
        const int y = cvRound(row(std::pow(10., power)));
        line(picture, Point(left, y), Point(width - right, y), Scalar::all(220));
        putText(picture, format("1e%d", power), Point(8, y + 4), FONT_HERSHEY_SIMPLEX, 0.4, Scalar::all(0), 1, LINE_AA);
    }
    for (size_t i = 0; i < sampled.offsets.size(); i++)
    {
        const int offset = sampled.offsets[i];
        if (std::abs(offset) <= reach)
            rectangle(picture, Point(cvRound(column(offset - 0.35)), cvRound(row(sampled.counts[i] / sampled.total()))),
                      Point(cvRound(column(offset + 0.35)), height - bottom), Scalar(220, 190, 150), FILLED);
    }
    std::vector<Point> curve;
    for (int step = -10 * reach; step <= 10 * reach; step++)
        curve.push_back(Point(cvRound(column(0.1 * step)), cvRound(row(mixture.density(0, 0.1 * step)))));
    polylines(picture, curve, false, Scalar(0, 0, 200), 2, LINE_AA);
    for (int offset = -reach; offset <= reach; offset += 10)
        putText(picture, format("%d", offset), Point(cvRound(column(offset)) - 8, height - 20), FONT_HERSHEY_SIMPLEX,
                0.4, Scalar::all(0), 1, LINE_AA);
    putText(picture,
            format("layer %d: share of each offset D%d - floor(D%d / 2), sampled (bars) and fitted (line)", layer,
                   layer + 1, layer),
            Point(left, 22), FONT_HERSHEY_SIMPLEX, 0.5, Scalar::all(0), 1, LINE_AA);
    return picture;
}

//! The main score of HDP+MST on the scenes that are held out
static Table errorTable(const std::vector<TrainingScene>& scenes,
                        const std::vector<Ptr<DisparityPredictionModel>>& models, int layers)
{
    Table table;
    table.title = "HDP+MST on the pairs that are held out, in percent (Middlebury: err>=2 or bad 2.0, KITTI: D1)";
    table.header = { "scene", "trained", "published" };
    std::vector<double> all[2];
    for (const TrainingScene& scene : scenes)
    {
        if (!scene.isHeldOut)
            continue;
        std::vector<double> errors;
        for (size_t m = 0; m < models.size(); m++)
        {
            const Pair& pair = scene.pair;
            Mat disparity16;
            createMatcher(pair, layers, models[m])->compute(pair.left, pair.right, disparity16);
            errors.push_back(mainScore(scoreMap(toPixels(disparity16, 0), pair), pair.protocol));
            all[m].push_back(errors.back());
        }
        table.addRow(scene.name);
        table.addNumbers(errors);
    }
    table.addRow(format("mean of %d", int(all[0].size())));
    table.addNumbers({ meanOf(all[0]), meanOf(all[1]) });
    return table;
}

//! Before the work, not after it; leaves what is there as it is.
static void requireWritable(const String& path)
{
    const bool isNew = !utils::fs::exists(path);
    if (!std::ofstream(path.c_str(), std::ios::app))
        fail("cannot write '" + path + "'");
    if (isNew)
        std::remove(path.c_str());
}

//! The exit status
static int run(const CommandLineParser& parser)
{
    if (!parser.has("@root") || !parser.has("output"))
        fail("a folder and -o MODEL.yml are needed, see --help");
    const String output = parser.get<String>("output"), picture = parser.get<String>("picture");
    if (!hasExtension(output, ".yml") && !hasExtension(output, ".yaml") && !hasExtension(output, ".xml") &&
        !hasExtension(output, ".json"))
        fail("-o " + output + ": neither a .yml nor an .xml nor a .json file");
    if (!picture.empty() && !haveImageWriter(picture))
        fail("--picture=" + picture + ": not a kind of image that can be written");
    setThreads(parser);
    const int seed = getInteger(parser, "seed", 0, std::numeric_limits<int>::max());
    const int layers = getInteger(parser, "layers", 2, 8);
    const int maxComponents = getInteger(parser, "max-components", 1, 16);

    int bad = 0;
    std::vector<TrainingScene> scenes = readScenes(parser, bad);
    requireWritable(output);
    if (!picture.empty())
        requireWritable(picture);
    const bool hasHeldOut = scenes.back().isHeldOut;
    std::cout << "trained on " << listNames(scenes, false) << "\nheld out   " << listNames(scenes, true) << "\n\n";

    const Ptr<DisparityPredictionModel> published = publishedModel(scenes[0].pair.left.cols);
    Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    Table likelihoods;
    likelihoods.title = "Mean log-likelihood of an offset";
    likelihoods.header = { "layer",
                           "Gaussians",
                           "trained on: pixels",
                           "trained on: this model",
                           "held out: pixels",
                           "held out: this model",
                           "held out: published model" };
    std::vector<Mat> pictures;
    for (int layer = layers - 2; layer >= 0; layer--)
    {
        for (size_t i = 0; i < scenes.size(); i++)
        {
            std::cerr << format("layer %d: matching %d of %d, %s", layer + 1, int(i) + 1, int(scenes.size()),
                                scenes[i].name.c_str())
                      << std::endl;
            matchAbove(scenes[i], layer, layers, model);
        }
        const Samples training(scenes, false);
        const Ptr<DisparityPredictionModel> mixture = DisparityPredictionModel::create();
        mixture->train(training.truths, training.uppers, maxComponents, seed);
        model = putBelow(*mixture, *model);

        const Offsets sampled(training);
        std::vector<double> means, sigmas, weights;
        mixture->getLayer(0, means, sigmas, weights);
        likelihoods.addRow(format("%d", layer));
        likelihoods.addText(format("%d", int(means.size())));
        likelihoods.addNumber(sampled.total(), "%.0f");
        likelihoods.addNumber(sampled.meanLogLikelihood(*mixture, 0), "%.4f");
        if (hasHeldOut)
        {
            const Offsets heldOut((Samples(scenes, true)));
            likelihoods.addNumber(heldOut.total(), "%.0f");
            likelihoods.addNumber(heldOut.meanLogLikelihood(*mixture, 0), "%.4f");
            likelihoods.addNumber(
                layer < published->getNumLayers() ? heldOut.meanLogLikelihood(*published, layer) : NO_SCORE, "%.4f");
        }
        else
            for (int i = 0; i < 3; i++)
                likelihoods.addNumber(NO_SCORE);
        pictures.insert(pictures.begin(), distributionPicture(sampled, *mixture, layer));
    }
    std::cout << toMarkdown(modelTable(*model)) << "\n" << toMarkdown(likelihoods) << std::endl;
    try
    {
        model->save(output);
        // save() does not notice a full disk. What has no size, such as a device, may have no end either.
        CV_Assert(std::ifstream(output, std::ios::ate).tellg() > 0);
        DisparityPredictionModel::load(output);
    }
    catch (const cv::Exception&)
    {
        fail("cannot write '" + output + "'");
    }
    std::cout << "written " << output << std::endl;
    if (!picture.empty())
    {
        Mat all;
        vconcat(pictures, all);
        writeImage(picture, all);
        std::cout << "written " << picture << std::endl;
    }
    if (hasHeldOut && published->getNumLayers() < layers - 1)
        std::cout << "\nno table of errors: the published model is of " << published->getNumLayers() + 1 << " layers"
                  << std::endl;
    else if (hasHeldOut)
        std::cout << "\n" << toMarkdown(errorTable(scenes, { model, published }, layers)) << std::endl;
    if (bad > 0)
        std::cerr << bad << " of " << scenes.size() + size_t(bad) << " pairs were skipped, see above" << std::endl;
    return bad > 0 ? 2 : 0;
}

int main(int argc, char** argv)
{
    // "-o FILE" as other programs have it; the parser only knows "-o=FILE".
    std::vector<String> arguments(argv, argv + argc);
    for (size_t i = 1; i + 1 < arguments.size(); i++)
        if (arguments[i] == "-o")
        {
            arguments[i] += "=" + arguments[i + 1];
            arguments.erase(arguments.begin() + std::ptrdiff_t(i) + 1);
        }
    std::vector<const char*> pointers;
    for (const String& argument : arguments)
        pointers.push_back(argument.c_str());
    return runProgram(int(pointers.size()), pointers.data(), KEYS,
                      "Trains a disparity prediction model on stereo pairs with known truth.\n"
                      "Exit status: 0 if all is well, 2 if a pair was skipped, 1 on other errors.\n",
                      {}, 1, run);
}
