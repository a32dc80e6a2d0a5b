// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

using cv::stereo::DisparityPredictionModel;

void addPredictionModel(py::module_& module)
{
    typedef DisparityPredictionModel Model;
    typedef std::vector<double> Numbers;
    py::class_<Model, cv::Ptr<Model>> model(module, "DisparityPredictionModel", R"doc(
The relation of the disparities of two consecutive pyramid layers, section 2.2 of the paper.

For each layer l it holds a Gaussian mixture over the offset of a pixel's disparity in layer l + 1 from half its
disparity in layer l. Layer 0 is the image itself. Offsets are in whole pixels of layer l + 1. A model must not be
changed by one thread while a matcher uses it in another.)doc");

    setPackage(model);
    const py::object enumeration = py::module_::import("enum").attr("IntEnum")(
        "Published",
        py::dict(py::arg("PUBLISHED_LARGE") = (int)Model::PUBLISHED_LARGE,
                 py::arg("PUBLISHED_SMALL") = (int)Model::PUBLISHED_SMALL),
        py::arg("module") = "hdpstereo", py::arg("qualname") = "DisparityPredictionModel.Published");
    enumeration.attr("__doc__") = "The models that createPublished() knows";
    model.attr("Published") = enumeration;
    model.attr("PUBLISHED_LARGE") = enumeration.attr("PUBLISHED_LARGE");
    model.attr("PUBLISHED_SMALL") = enumeration.attr("PUBLISHED_SMALL");

    model.def(py::init([] { return Model::create(); }), "A model without layers");
    model.def_static("create", &Model::create, "Creates a model without layers.");
    model.def_static("createPublished", &Model::createPublished, py::arg("which"), R"doc(
Creates one of the models of the authors' program, which the matcher uses by default.

which: DisparityPredictionModel.PUBLISHED_LARGE, for full-size Middlebury images (3 layers), or PUBLISHED_SMALL, for
half that size (2 layers).)doc");
    model.def_static(
        "load",
        [](const py::object& filename) {
        const cv::Ptr<Model> loaded = Model::create();
        readFile(filename, [&](const std::string& text) { fromText(*loaded, text); });
        return loaded;
        },
        py::arg("filename"), "Reads a model that save() has written; raises ValueError if the file does not hold one.");
    model.def(
        "save", [](const Model& self, const py::object& filename) { writeFile(filename, self); }, py::arg("filename"),
        "Writes the model to an XML, YAML or JSON file, by its extension.");
    model.def(
        "clear", [](Model& self) { self.clear(); }, "Removes all layers.");
    model.def("getNumLayers", &Model::getNumLayers,
              "Number of layers that have a mixture. A matcher of L layers needs L - 1.");
    model.def("addLayer", &Model::addLayer, py::arg("means"), py::arg("sigmas"), py::arg("weights"), R"doc(
Appends the mixture of layer getNumLayers().

means, sigmas: of each Gaussian, in pixels of layer l + 1; finite, the sigmas above 0.
weights: of each Gaussian, in [0, 1]; their sum is 1.)doc");
    model.def(
        "getLayer",
        [](const Model& self, int layer) {
        Numbers means, sigmas, weights;
        self.getLayer(layer, means, sigmas, weights);
        return py::make_tuple(toPython(means), toPython(sigmas), toPython(weights));
        },
        py::arg("layer"), "Returns means, sigmas and weights of a layer, see addLayer().");
    model.def("density", &Model::density, py::arg("layer"), py::arg("offset"), R"doc(
Returns the density of a mixture at an offset.

layer: 0 .. getNumLayers() - 1.
offset: in pixels of layer + 1, of any sign.)doc");
    model.def(
        "train",
        [](Model& self, const py::iterable& disparities, const py::iterable& upperDisparities, int maxComponents,
           int seed) {
        std::vector<py::array> kept;
        const std::vector<cv::Mat> lower = toMats(disparities, "disparities", kept),
                                   upper = toMats(upperDisparities, "upperDisparities", kept);
        const py::gil_scoped_release release;
        return self.train(lower, upper, maxComponents, seed);
        },
        py::arg("disparities"), py::arg("upperDisparities"), py::arg("maxComponents") = 6, py::arg("seed") = 0, R"doc(
Appends the mixture of layer getNumLayers(), fitted to disparity maps by expectation maximisation.

disparities: maps of the layer, usually the truth, in its pixels: a sequence of float32 arrays. What is negative or not
finite is unknown.
upperDisparities: as many maps of the layer above, in its pixels, usually those that the matcher finds there, see
HDPTreeMatcher.getLayerDisparity(): float32, of half the size.
maxComponents: largest number of Gaussians, 1 to 64.
seed: of the random choices, >= 0.

Returns the mean log-likelihood of an offset of the half of the maps that the number of Gaussians was chosen by. Raises
ValueError if there are too few offsets, and NotImplementedError without opencv_ml; the model is unchanged then.)doc");
    model.def_static(
        "countOffsets",
        [](const py::iterable& disparities, const py::iterable& upperDisparities) {
        std::vector<py::array> kept;
        std::vector<int> offsets;
        Numbers counts;
        Model::countOffsets(toMats(disparities, "disparities", kept),
                            toMats(upperDisparities, "upperDisparities", kept), offsets, counts);
        return py::make_tuple(toPython(offsets), toPython(counts));
        },
        py::arg("disparities"), py::arg("upperDisparities"),
        "Returns the offsets that train() fits a mixture to, ascending, and the number of pixels of each.");
    model.def(py::pickle([](const Model& self) { return py::make_tuple(toText(self, ".yml")); },
                         [](const py::tuple& state) {
        const cv::Ptr<Model> copy = Model::create();
        fromText(*copy, state[0].cast<std::string>());
        return copy;
    }));
}
