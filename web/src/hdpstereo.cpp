// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// HDPTreeMatcher for JavaScript. Methods have the names of the header; images are objects of width, height and data,
// Params and Findings objects with their fields. The tree strategy is no field, but has its accessors. A PairModel is the
// text of its file.

#include <emscripten/bind.h>

#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgproc.hpp"

namespace {

using cv::stereo::HDPTreeMatcher;
using emscripten::val;

//! Does something; an exception of OpenCV becomes a JavaScript Error with its message.
template <typename Action> void run(const Action& action)
{
    std::string message;
    try
    {
        action();
    }
    catch (const cv::Exception& e)
    {
        message = e.code == cv::Error::StsNoMem ? "There is not enough memory." : e.err;
    }
    catch (const std::bad_alloc&)
    {
        message = "There is not enough memory.";
    }
    if (!message.empty())
        val::global("Error").new_(message).throw_();
}

val toJavaScript(bool value) { return val(value); }
val toJavaScript(int value) { return val(value); }
val toJavaScript(double value) { return val(value); }

template <typename T> val arrayOf(const std::vector<T>& values)
{
    val array = val::array();
    for (const T& value : values)
        array.call<void>("push", value);
    return array;
}

val toJavaScript(const std::vector<double>& values) { return arrayOf(values); }
val toJavaScript(const std::vector<std::string>& values) { return arrayOf(values); }

//! A property of an object, if it has it
template <typename T> void read(const val& object, const char* name, T& value)
{
    if (object.hasOwnProperty(name))
        value = object[name].as<T>();
}

template <typename T> val valuesOf(const cv::Mat& image)
{
    return val(emscripten::typed_memory_view(image.total() * image.channels(), image.ptr<T>()));
}

//! All values of an image, which stay where they are: an array of JavaScript's type for its depth
val valuesOf(const cv::Mat& image)
{
    switch (image.depth())
    {
    case CV_8U:
        return valuesOf<uchar>(image);
    case CV_16U:
        return valuesOf<ushort>(image);
    case CV_16S:
        return valuesOf<short>(image);
    case CV_32S:
        return valuesOf<int>(image);
    default:
        return valuesOf<float>(image);
    }
}

//! null if it is empty
val toJavaScript(const cv::Mat& image)
{
    if (image.empty())
        return val::null();
    val result = val::object();
    result.set("width", image.cols);
    result.set("height", image.rows);
    result.set("data", valuesOf(image).call<val>("slice"));
    return result;
}

/** What HDPTreeMatcher takes of an image of JavaScript: its data is a Uint8Array or Uint8ClampedArray, or a Uint16Array,
of grey levels, RGB or RGBA, or a Float32Array of one value per pixel. */
cv::Mat fromJavaScript(const val& image, const char* name)
{
    const int width = image["width"].as<int>(), height = image["height"].as<int>();
    const val data = image["data"];
    const double size = data["length"].as<double>();
    const bool isDeep = data.instanceof (val::global("Uint16Array"));
    const bool isFloat = data.instanceof (val::global("Float32Array"));
    const int channels = width > 0 && height > 0 ? cvRound(size / width / height) : 0;
    if ((channels != 1 && channels != 3 && channels != 4) || size != (double)width * height * channels)
        CV_Error(cv::Error::StsBadSize, std::string(name) + ".data must have 1, 3 or 4 values per pixel");
    cv::Mat result(height, width, CV_MAKETYPE(isFloat ? CV_32F : isDeep ? CV_16U : CV_8U, channels));
    valuesOf(result).call<void>("set", data);
    if (channels > 1 && !isFloat) // 16 bits are for grey levels
        cv::cvtColor(result, result,
                     channels == 3 ? (isDeep ? cv::COLOR_RGB2GRAY : cv::COLOR_RGB2BGR)
                                   : (isDeep ? cv::COLOR_RGBA2GRAY : cv::COLOR_RGBA2BGR));
    return result;
}

//! An image that may be left out: null; or a number
cv::Mat toInput(const val& image, const char* name)
{
    if (image.isNumber())
        return cv::Mat(1, 1, CV_64F, cv::Scalar(image.as<double>()));
    return image.isNull() || image.isUndefined() ? cv::Mat() : fromJavaScript(image, name);
}

std::shared_ptr<HDPTreeMatcher> create(int minDisparity, int numDisparities, int preset)
{
    std::shared_ptr<HDPTreeMatcher> matcher;
    run([&] { matcher = HDPTreeMatcher::create(minDisparity, numDisparities, preset); });
    return matcher;
}

//! The map, with the time that compute() took
val compute(HDPTreeMatcher& self, const val& left, const val& right)
{
    cv::Mat disparity;
    double milliseconds = 0;
    run([&] {
        const cv::Mat leftImage = fromJavaScript(left, "left"), rightImage = fromJavaScript(right, "right");
        const int64 start = cv::getTickCount();
        self.compute(leftImage, rightImage, disparity);
        milliseconds = 1000. * (double)(cv::getTickCount() - start) / cv::getTickFrequency();
    });
    val result = toJavaScript(disparity);
    result.set("milliseconds", milliseconds);
    return result;
}

//! "MST", "ST" or "RT", as the paper calls them
void setTreeStrategy(HDPTreeMatcher& self, const std::string& name)
{
    run([&] {
        if (name == "MST")
            self.setTreeStrategy(cv::stereo::createMinimumSpanningTree());
        else if (name == "ST")
            self.setTreeStrategy(cv::stereo::createSegmentTree());
        else if (name == "RT")
            self.setTreeStrategy(cv::stereo::createRandomTree());
        else
            CV_Error(cv::Error::StsBadArg, "treeStrategy must be MST, ST or RT, not " + name);
    });
}

std::string getTreeStrategy(const HDPTreeMatcher& self)
{
    for (const auto& named : { std::make_pair("MST", cv::stereo::createMinimumSpanningTree()),
                               std::make_pair("ST", cv::stereo::createSegmentTree()) })
        if (named.second->getDefaultName() == self.getTreeStrategy()->getDefaultName())
            return named.first;
    return "RT";
}

//! YAML, as PairModel::save() writes it
std::string getPairModel(const HDPTreeMatcher& self)
{
    cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << "pairModel"
            << "{";
    self.getPairModel().write(storage);
    storage << "}";
    return storage.releaseAndGetString();
}

//! The text of a file of a PairModel; null: pairs are estimated again
void setPairModel(HDPTreeMatcher& self, const val& text)
{
    run([&] {
        cv::stereo::PairModel model;
        if (!text.isNull())
        {
            const cv::FileStorage storage(text.as<std::string>(), cv::FileStorage::READ | cv::FileStorage::MEMORY);
            if (!storage["pairModel"].isMap())
                CV_Error(cv::Error::StsParseError, "pairModel is missing");
            model.read(storage["pairModel"]);
        }
        self.setPairModel(model);
    });
}

} // namespace

EMSCRIPTEN_BINDINGS(hdpstereo)
{
    // Errors are for the page.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);

    emscripten::class_<HDPTreeMatcher>("HDPTreeMatcher")
        .smart_ptr<std::shared_ptr<HDPTreeMatcher>>("HDPTreeMatcherPtr")
        .class_function("create", &create)
        .function("compute", &compute)
        .function("setTreeStrategy", &setTreeStrategy)
        .function("getTreeStrategy", &getTreeStrategy)
        .function("getPairModel", &getPairModel)
        .function("setPairModel", &setPairModel)
        .function("clear", emscripten::optional_override([](HDPTreeMatcher& self) { self.clear(); }))
#define METHODS
#include "methods.inc"
#undef METHODS
        ;
#include "methods.inc"
    emscripten::function("setNumThreads", &cv::setNumThreads);
    emscripten::function("getNumThreads", &cv::getNumThreads);
    emscripten::constant("openCVVersion", std::string(CV_VERSION));
}
