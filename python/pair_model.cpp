// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

using cv::stereo::PairModel;

namespace {

std::string toText(const PairModel& model, const std::string& filename)
{
    cv::FileStorage storage(filename, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << "pairModel"
            << "{";
    model.write(storage);
    storage << "}";
    return storage.releaseAndGetString();
}

PairModel fromText(const std::string& text)
{
    const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    PairModel model;
    model.read(storage["pairModel"]);
    return model;
}

//! Fields of numbers are numpy arrays, read-only.
void defNumbers(py::class_<PairModel>& type, const char* name, std::vector<double> PairModel::*field,
                const char* documentation)
{
    type.def_property(
        name, [field](const PairModel& self) { return readOnly(toPython(self.*field)); }, setterOf(type, name, field),
        documentation);
}

template <typename Value>
void defField(py::class_<PairModel>& type, const char* name, Value PairModel::*field, const char* documentation)
{
    type.def_property(
        name, [field](const PairModel& self) { return self.*field; }, setterOf(type, name, field), documentation);
}

void defFields(py::class_<PairModel>& type)
{
    defField(type, "width", &PairModel::width, "of the images, in pixels, > 0; 0: the model is empty");
    defField(type, "height", &PairModel::height, "of the images, in pixels, > 0");
    defField(type, "depth", &PairModel::depth, "of the images: 0 for uint8, 2 for uint16, 5 for float32");
    defField(type, "x", &PairModel::x, "first column of the tile that is matched, >= 0; 0 without tiles");
    defField(type, "y", &PairModel::y, "first row of the tile, >= 0");
    defField(type, "tileWidth", &PairModel::tileWidth, "of the tile, in pixels, > 0; width without tiles");
    defField(type, "tileHeight", &PairModel::tileHeight, "of the tile, in pixels, > 0");
    defField(type, "minDisparity", &PairModel::minDisparity,
             "that the images were matched with; a matcher keeps its own range");
    defField(type, "numDisparities", &PairModel::numDisparities, "that the images were matched with, > 0");
    defField(type, "addedColumns", &PairModel::addedColumns,
             "that a negative minDisparity added on the left of the images, >= 0");
    defNumbers(type, "rows", &PairModel::rows, "coefficients of HDPTreeMatcher.Findings.rows: 5 finite numbers");
    defField(type, "areRowsMoved", &PairModel::areRowsMoved, "whether the rows of the right image are moved by them");
    defNumbers(type, "light", &PairModel::light,
               "coefficients of HDPTreeMatcher.Findings.light: 10 numbers, -10^6..10^6");
    defField(type, "isLightChanged", &PairModel::isLightChanged,
             "whether the light of the right image is changed by them, for COST_CENSUS");
    defField(type, "rowError", &PairModel::rowError, "HDPTreeMatcher.Findings.rowError, 0..2^24 pixels; 0: unknown");
    defField(type, "noise", &PairModel::noise, "as HDPTreeMatcher.Findings.noise, of noiseLayer: 0..10000");
    defField(type, "noiseLayer", &PairModel::noiseLayer, "layer in which it was measured, 0 to 15; 0 is the image");
    defField(type, "black", &PairModel::black, "level that is matched as black: finite, >= 0 without floats");
    defField(type, "white", &PairModel::white,
             "level that is matched as white, >= black; black: whole levels stay as they are");
    defField(type, "borderLevel", &PairModel::borderLevel,
             "level that ends black borders of the images, which are no data, 0 to 65535; 0: there are none");
    defField(type, "bits", &PairModel::bits, "that levels of uint16 have: 8 to 16. For uint8 8");
    defField(type, "brightness", &PairModel::brightness, "what a dark pair is brightened by, for COST_CENSUS: 1..4");
    defField(type, "isGrey", &PairModel::isGrey,
             "whether the left image has no colours: edges are those of its grey levels then, for COST_CENSUS");
    defField(type, "leftBlockStart", &PairModel::leftBlockStart,
             "first column, 0 to 7, of a block of JPEG compression in the left image");
    defField(type, "leftBlockStep", &PairModel::leftBlockStep,
             "mean step between its blocks in grey levels of 0 to 255; 0: there are none");
    defField(type, "rightBlockStart", &PairModel::rightBlockStart,
             "first column, 0 to 7, of a block of JPEG compression in the right image");
    defField(type, "rightBlockStep", &PairModel::rightBlockStep,
             "mean step between its blocks in grey levels of 0 to 255; 0: there are none");
}

} // namespace

void addPairModel(py::module_& module)
{
    py::class_<PairModel> type(module, "PairModel", R"doc(
All that HDPTreeMatcher.compute() estimates from a pair before it is matched, as one value.

HDPTreeMatcher.getPairModel() returns that of the last pair. HDPTreeMatcher.setPairModel() sets it for the next ones,
and nothing is estimated from these: the frames of one rig, or the tiles of one pair.

    matcher.compute(left, right)
    model = matcher.getPairModel()
    matcher.setPairModel(model.tile(x, y, width, height))
    disparity = matcher.compute(left[y:y + height, x:x + width], right[y:y + height, x:x + width])

Points of the right image are counted from the centre of the image as it is matched: moved to the right by minDisparity,
with addedColumns more on the left. The arrays rows and light are copies, and read-only: assign others.)doc");
    setPackage(type);
    type.def(py::init<>(), "An empty model, of no images");
    type.def("empty", &PairModel::empty, "Returns whether the model is of no images.");
    type.def("tile", (PairModel(PairModel::*)(int, int, int, int) const) & PairModel::tile, py::arg("x"), py::arg("y"),
             py::arg("tileWidth"), py::arg("tileHeight"), R"doc(
Returns the model for a part of the images.

x, y: first column and row of the tile in the whole images: multiples of 2^(layers - 1), or compute() raises
ValueError. 32 is one for up to 6 layers.
tileWidth, tileHeight: of the tile, > 0.

Raises ValueError if the model is empty, or the tile not inside of the images.)doc");
    type.def("enlarged", &PairModel::enlarged, py::arg("times"), py::arg("width"), py::arg("height"), R"doc(
Returns the model for images that this one's are a reduction of, by means of squares of pixels.

For images that are too large to be matched at once: rows and light are found in the reduced pair.

times: how often the images were halved, 0 to 15; minDisparity and numDisparities, too.
width, height: of the larger images: this model's times 2^times, or up to 2^times - 1 more.

Raises ValueError if the model is empty or of a tile, or sizes do not fit.)doc");
    defFields(type);
    type.def("__repr__", [](const PairModel& m) {
        return m.empty() ? std::string("PairModel()")
                         : cv::format("<PairModel of %d x %d pixels, tile of %d x %d at (%d, %d)>", m.width, m.height,
                                      m.tileWidth, m.tileHeight, m.x, m.y);
    });
    type.def(
        "save",
        [](const PairModel& self, const py::object& filename) { writeText(filename, toText(self, nameOf(filename))); },
        py::arg("filename"), "Writes the model to an XML, YAML or JSON file, by its extension.");
    type.def_static(
        "load",
        [](const py::object& filename) {
        PairModel loaded;
        readFile(filename, [&](const std::string& text) { loaded = fromText(text); });
        return loaded;
        },
        py::arg("filename"), "Reads what save() has written; raises ValueError if a value is missing or not valid.");
    type.def(py::pickle([](const PairModel& self) { return py::make_tuple(toText(self, ".yml")); },
                        [](const py::tuple& state) { return fromText(state[0].cast<std::string>()); }));
}
