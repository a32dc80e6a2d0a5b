// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

#include <mutex>

using cv::stereo::DisparityPredictionModel;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::PairModel;

namespace {

//! A matcher for any number of threads: one after the other uses it.
class Matcher
{
public:
    explicit Matcher(const cv::Ptr<HDPTreeMatcher>& matcher) : matcher_(matcher) {}

    //! Calls function(matcher), without the interpreter's lock.
    template <typename Function> void run(const Function& function)
    {
        if (isInRule()) // it would wait for itself
            throw std::runtime_error("a tree strategy must not use a matcher");
        const py::gil_scoped_release release;
        const std::lock_guard<std::mutex> lock(mutex_);
        function(*matcher_);
    }

private:
    cv::Ptr<HDPTreeMatcher> matcher_;
    std::mutex mutex_;
};

//! The value of a field in words
std::string inWords(const py::object& value)
{
    if (py::hasattr(value, "getDefaultName"))
        return py::str(value.attr("getDefaultName")());
    return py::hasattr(value, "name") ? py::str(value.attr("name")) : py::repr(value);
}

void addRepr(py::object& type, const std::vector<const char*>& fields)
{
    type.attr("__repr__") = py::cpp_function(
        [fields](const py::object& self) {
        std::string text;
        for (const char* const field : fields)
            text += (text.empty() ? "" : ", ") + std::string(field) + "=" + inWords(self.attr(field));
        return py::type::of(self).attr("__qualname__").cast<std::string>() + "(" + text + ")";
        },
        py::is_method(type));
}

//! The values of a preset, but for some fields
HDPTreeMatcher::Params createParams(int preset, const py::kwargs& fields)
{
    HDPTreeMatcher::Params params(preset);
    const py::object object = py::cast(&params, py::return_value_policy::reference);
    for (const auto& field : fields)
    {
        if (!py::hasattr(object, field.first))
            throw py::type_error("Params has no field " + field.first.cast<std::string>());
        py::setattr(object, field.first, field.second);
    }
    return params;
}

void defTreeStrategy(py::class_<HDPTreeMatcher::Params>& params, const char* documentation)
{
    params.def_property(
        "treeStrategy", [](const HDPTreeMatcher::Params& self) { return self.treeStrategy; },
        [](HDPTreeMatcher::Params& self, const py::object& strategy) { self.treeStrategy = keptStrategy(strategy); },
        documentation);
}

void defPredictionModel(py::class_<HDPTreeMatcher::Params>& params, const char* documentation)
{
    params.def_property(
        "predictionModel", [](const HDPTreeMatcher::Params& self) { return self.predictionModel; },
        [](HDPTreeMatcher::Params& self, const cv::Ptr<DisparityPredictionModel>& model) {
        self.predictionModel = model;
        },
        documentation);
}

std::unique_ptr<Matcher> create(int minDisparity, int numDisparities, int preset)
{
    return std::unique_ptr<Matcher>(new Matcher(HDPTreeMatcher::create(minDisparity, numDisparities, preset)));
}

//! sgbm: of cv2, whose types this module does not know
std::unique_ptr<Matcher> createLike(const py::object& sgbm, int preset)
{
    const auto valueOf = [&](const char* getter) {
        if (!py::hasattr(sgbm, getter))
            throw py::type_error("sgbm must be a cv2.StereoSGBM, not " + typeOf(sgbm));
        return sgbm.attr(getter)().cast<int>();
    };
    valueOf("getMode"); // which no other matcher has: cv2.StereoBM has other units
    const cv::Ptr<cv::StereoSGBM> like = cv::StereoSGBM::create(
        valueOf("getMinDisparity"), valueOf("getNumDisparities"), 3, 0, 0, valueOf("getDisp12MaxDiff"), 0, 0,
        valueOf("getSpeckleWindowSize"), valueOf("getSpeckleRange"));
    return std::unique_ptr<Matcher>(new Matcher(HDPTreeMatcher::createLike(like, preset)));
}

void addEnumeration(py::object& matcher, const char* name, const char* documentation,
                    const std::vector<std::pair<std::string, int>>& values)
{
    const py::object enumeration = py::module_::import("enum").attr("IntEnum")(
        name, values, py::arg("module") = "hdpstereo", py::arg("qualname") = std::string("HDPTreeMatcher.") + name);
    enumeration.attr("__doc__") = documentation;
    matcher.attr(name) = enumeration;
    for (const auto& value : values)
        matcher.attr(value.first.c_str()) = enumeration.attr(value.first.c_str());
}

py::object enumerator(const char* name, int value) { return py::type::of<Matcher>().attr(name)(value); }

py::array toImage(const py::object& image, const char* name)
{
    if (image.is_none())
        throw py::type_error(std::string(name) + " must be a numpy array, not None: could the image be read?");
    if (!py::isinstance<py::array>(image))
        throw py::type_error(std::string(name) + " must be a numpy array, not " + typeOf(image));
    return py::reinterpret_borrow<py::array>(image);
}

double toNumber(const py::object& number, const char* name)
{
    const double value = PyFloat_AsDouble(number.ptr());
    if (!PyErr_Occurred())
        return value;
    const bool isTooLarge = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    if (isTooLarge)
        throw py::value_error(std::string(name) + " must be finite");
    throw py::type_error(std::string(name) + " must be a real number, not " + typeOf(number));
}

//! An array that may be left out: None; or a number
cv::Mat toInput(const py::object& array, const char* name, std::vector<py::array>& kept)
{
    const bool isArray = py::isinstance<py::array>(array) && py::reinterpret_borrow<py::array>(array).ndim() > 0;
    if (!isArray && PyNumber_Check(array.ptr())) // of Python or numpy
        return cv::Mat(1, 1, CV_64F, cv::Scalar(toNumber(array, name)));
    if (array.is_none())
        return cv::Mat();
    const py::array given = toImage(array, name);
    return toMat(given.dtype().kind() == 'b' ? py::array(given.attr("view")("uint8")) : given, name, kept); // a mask
}

//! Pixels, NaN where one has no data or a filter has rejected it
cv::Mat computeFloat(Matcher& self, const cv::Mat& left, const cv::Mat& right)
{
    cv::Mat_<float> disparity; // an array of fixed type has the type of the result
    self.run([&](HDPTreeMatcher& m) {
        m.compute(left, right, disparity);
        disparity.setTo(std::numeric_limits<float>::quiet_NaN(), disparity < m.getFindings().minDisparity);
    });
    return disparity;
}

py::object computeArrays(Matcher& self, const py::object& leftArray, const py::object& rightArray,
                         const py::object& output, bool isFloat)
{
    std::vector<py::array> kept;
    const cv::Mat left = toMat(toImage(leftArray, "left"), "left", kept);
    const cv::Mat right = toMat(toImage(rightArray, "right"), "right", kept);
    cv::Mat disparity;
    if (isFloat && !output.is_none())
        throw py::value_error("as_float must be False if there is an array for the result: its type is the result's");
    if (isFloat)
        return toPython(computeFloat(self, left, right));
    if (output.is_none())
    {
        self.run([&](HDPTreeMatcher& m) { m.compute(left, right, disparity); });
        return toPython(disparity);
    }

    if (!py::isinstance<py::array>(output))
        throw py::type_error("disparity must be a numpy array");
    const py::array array = py::reinterpret_borrow<py::array>(output);
    disparity = toMat(array, "disparity", kept);
    if ((disparity.type() != CV_16SC1 && disparity.type() != CV_32FC1) || disparity.size() != left.size())
        throw py::value_error("disparity must be int16 or float32, of the size of left");
    if (disparity.data != array.data() || !array.writeable())
        throw py::value_error("disparity must be writeable, with the pixels of a row next to each other");
    const cv::Mat& fixed = disparity; // an array of fixed type has the type of the result
    self.run([&](HDPTreeMatcher& m) { m.compute(left, right, fixed); });
    return output;
}

py::object compute(Matcher& self, const py::object& left, const py::object& right, const py::object& output,
                   bool isFloat)
{
    try
    {
        return computeArrays(self, left, right, output, isFloat);
    }
    catch (const py::builtin_exception&) // of the arguments: nothing is known of a pair any more, as after other errors
    {
        const auto fail = [](HDPTreeMatcher& m) { m.compute(cv::Mat(), cv::Mat(), cv::Mat()); };
        try
        {
            self.run(fail);
        }
        catch (const std::exception&)
        {
        }
        throw;
    }
}

std::string toText(Matcher& self, const std::string& filename)
{
    std::string text;
    self.run([&](HDPTreeMatcher& m) { text = ::toText(m, filename); });
    return text;
}

cv::Ptr<cv::stereo::TreeStrategy> strategyOf(Matcher& self)
{
    cv::Ptr<cv::stereo::TreeStrategy> strategy;
    self.run([&](HDPTreeMatcher& m) { strategy = m.getTreeStrategy(); });
    return strategy;
}

} // namespace

void addMatcher(py::module_& module)
{
    py::class_<Matcher> matcher(module, "HDPTreeMatcher", R"doc(
Stereo matching over disparity trees with hierarchical disparity prediction.

compute() takes a rectified pair, and returns the disparity of every pixel of the left image: a pixel (x, y) shows the
same point as (x - disparity, y) of the right one. Methods, parameters and constants are those of C++ and of cv2.stereo.

Where C++ throws an exception, ValueError is raised, with the same text. Threads may share a matcher: they wait for each
other. Each one is faster with its own.)doc");
    setPackage(matcher);
    const int defaultPreset = HDPTreeMatcher::PRESET_FAST;
    py::class_<HDPTreeMatcher::Params> paramsType(matcher, "Params", R"doc(
How to match. A preset is a value of this.

    params = HDPTreeMatcher.Params(HDPTreeMatcher.PRESET_QUALITY, finestLayer=1)
    params.gamma = 15
    matcher.setParams(params)

Values are checked by setParams().)doc");
    setPackage(paramsType);
    paramsType.def(py::init(&createParams), py::arg("preset") = defaultPreset, R"doc(
The values of a preset, but for the fields that are given by name.)doc");
    py::class_<HDPTreeMatcher::Findings> findingsType(matcher, "Findings",
                                                      "What the last compute() found out about the pair.");
    setPackage(findingsType);
    matcher.def(py::init(&create), py::arg("minDisparity"), py::arg("numDisparities"), py::arg("preset"));

    matcher.def_static("createLike", &createLike, py::arg("sgbm"), py::arg("preset") = defaultPreset, R"doc(
Creates a matcher that takes the place of a cv2.StereoSGBM.

minDisparity, numDisparities, disp12MaxDiff, speckleWindowSize and speckleRange are taken over as they are now. What
else it has is of its own algorithm, and is not taken over.

sgbm: it is read, and not kept.
preset: see create().)doc");

    matcher.def("compute", &compute, py::arg("left"), py::arg("right"), py::arg("disparity") = py::none(),
                py::arg("as_float").noconvert() = false, R"doc(
Matches a rectified pair.

left, right: images of one size and type: uint8 with one channel (grey), three (BGR) or four (BGR and alpha, which is
ignored), uint16 with one channel, of a camera of 10 to 16 bits, or float32 with one channel, NaN = no data. They are
not copied if the pixels of a row are next to each other.
disparity: an array for the result, if given: int16 or float32, of the images' size.
as_float: whether disparities are float32 in pixels, and NaN where there is no data or a filter rejects one.

Returns the disparities of the left image: int16, times 16, or float32 in pixels, see setDisparityDepth(). What a filter
rejects is (minDisparity - 1) * 16, or minDisparity - 1, with the minDisparity of getFindings() if numDisparities is 0. Raises ValueError if images or parameters do not fit.)doc");
    matcher.def(
        "clear", [](Matcher& self) { self.run([](HDPTreeMatcher& m) { m.clear(); }); },
        "Forgets the pairs before, see setUseTemporalPrediction(): the next compute() begins a video.");
    matcher.def(
        "setTreeStrategy",
        [](Matcher& self, const py::object& strategy) {
        const cv::Ptr<cv::stereo::TreeStrategy> kept = keptStrategy(strategy);
        self.run([&](HDPTreeMatcher& m) { m.setTreeStrategy(kept); });
        },
        py::arg("strategy"), "Rule 1 and Rule 2 of the spanning trees, section 3.2 of the paper, see TreeStrategy.");
    matcher.def("getTreeStrategy", &strategyOf, "See setTreeStrategy().");
    matcher.def(
        "setParams",
        [](Matcher& self, const HDPTreeMatcher::Params& params) {
        const HDPTreeMatcher::Params copy = params; // another thread may change them
        self.run([&](HDPTreeMatcher& m) { m.setParams(copy); });
        },
        py::arg("params"), R"doc(
Sets how to match, see Params.

Raises ValueError if a value is out of range; the matcher is unchanged then.)doc");
    matcher.def(
        "getParams",
        [](Matcher& self) {
        std::unique_ptr<HDPTreeMatcher::Params> params;
        self.run([&](HDPTreeMatcher& m) { params.reset(new HDPTreeMatcher::Params(m.getParams())); });
        return params;
        },
        "Returns a copy of how to match, see Params.");
    matcher.def(
        "getFindings",
        [](Matcher& self) {
        HDPTreeMatcher::Findings findings;
        self.run([&](HDPTreeMatcher& m) { findings = m.getFindings(); });
        return findings;
        },
        "Returns what the last compute() found out about the pair, see Findings.");

    matcher.def(
        "setPairModel",
        [](Matcher& self, const PairModel& model) {
        const PairModel copy = model; // another thread may change it
        self.run([&](HDPTreeMatcher& m) { m.setPairModel(copy); });
        },
        py::arg("model"), R"doc(
Sets what is known of the next pairs: nothing is estimated from them then, see PairModel.

What the model says is done, whatever maxRowOffset and useLightAlignment are; noiseThreshold is compared with its noise.
The disparity range is taken from it if numDisparities is 0. save() does not store it, and clear() does not forget it.
model: that of an earlier pair, or of a tile of it. An empty one, PairModel(): pairs are estimated again.

Raises ValueError if a value is not valid; the matcher is unchanged then.)doc");
    matcher.def(
        "getPairModel",
        [](Matcher& self) {
        PairModel model;
        self.run([&](HDPTreeMatcher& m) { model = m.getPairModel(); });
        return model;
        },
        "Returns what the last pair was matched with: estimated, or as it was set. Empty before the first compute() "
        "and after "
        "one that threw an exception.");

    matcher.attr("AUTO") = (int)HDPTreeMatcher::AUTO;
    using cv::String;
#include "matcher_methods.inc"

    matcher.def(
        "save", [](Matcher& self, const py::object& filename) { writeText(filename, toText(self, nameOf(filename))); },
        py::arg("filename"),
        "Writes all parameters, the prediction model and the name of the tree strategy to an XML, YAML or JSON file.");
    const auto read = [](Matcher& self, const py::object& filename) {
        readFile(filename, [&](const std::string& text) { self.run([&](HDPTreeMatcher& m) { fromText(m, text); }); });
    };
    matcher.def("read", read, py::arg("filename"), R"doc(
Reads what save() has written.

A file that names a strategy of your own can be read if a strategy of this name is set; it is kept. Raises ValueError if
a value is missing or not valid; the matcher is unchanged then.)doc");
    matcher.def_static(
        "load",
        [read](const py::object& filename) {
        std::unique_ptr<Matcher> loaded = create(0, 64, HDPTreeMatcher::PRESET_FAST);
        read(*loaded, filename);
        return loaded;
        },
        py::arg("filename"), "Creates a matcher from what save() has written, see read().");
    matcher.def(py::pickle(
        [](Matcher& self) {
        if (isPythonStrategy(strategyOf(self)))
            throw py::type_error("a matcher with a tree strategy that is written in Python cannot be pickled");
        return py::make_tuple(toText(self, ".yml"));
        },
        [](const py::tuple& state) {
        std::unique_ptr<Matcher> copy = create(0, 64, HDPTreeMatcher::PRESET_FAST);
        const std::string text = state[0].cast<std::string>(); // run() gives Python's lock away
        copy->run([&](HDPTreeMatcher& m) { fromText(m, text); });
        return copy;
    }));
}
