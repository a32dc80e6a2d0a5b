// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PYTHON_BINDINGS_HPP
#define OPENCV_HDPSTEREO_PYTHON_BINDINGS_HPP

#include <functional>
#include <type_traits>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "opencv2/hdpstereo.hpp"

#if CV_VERSION_MAJOR < 5 // from then on it is std::shared_ptr itself
PYBIND11_DECLARE_HOLDER_TYPE(T, cv::Ptr<T>)
#endif

namespace py = pybind11;

// Each adds its classes and functions to the module.
void addTreeStrategies(py::module_& module);
void addPredictionModel(py::module_& module);
void addPairModel(py::module_& module);
void addMatcher(py::module_& module);
void addStereoRig(py::module_& module);

//! The class is known as one of the package, not of the module in it.
inline void setPackage(py::object& type) { type.attr("__module__") = "hdpstereo"; }

//! Whether this thread is in a rule of a strategy that is written in Python
bool isInRule();

//! For the matcher: of a strategy that is written in Python, the pointer keeps the object.
cv::Ptr<cv::stereo::TreeStrategy> keptStrategy(const py::object& strategy);

//! Whether a strategy is written in Python
bool isPythonStrategy(const cv::Ptr<cv::stereo::TreeStrategy>& strategy);

// Arrays

//! A numpy array as a Mat, of the same memory where the layout allows it. name: of the argument, for errors. kept:
//! receives what the Mat's memory belongs to.
cv::Mat toMat(const py::array& array, const char* name, std::vector<py::array>& kept);

std::vector<cv::Mat> toMats(const py::iterable& arrays, const char* name, std::vector<py::array>& kept);

//! A numpy array of the Mat's memory; None if it is empty.
py::object toPython(const cv::Mat& mat);

template <typename T> py::array_t<T> toPython(const std::vector<T>& values)
{
    return py::array_t<T>((py::ssize_t)values.size(), values.data());
}

//! None if there are none
template <typename T> py::object listToPython(const std::vector<T>& values)
{
    return values.empty() ? py::object(py::none()) : py::object(toPython(values));
}

//! Of a copy, which nobody else sees: writing into it is an error. None stays.
inline py::object readOnly(const py::object& array)
{
    if (!array.is_none())
        array.attr("setflags")(py::arg("write") = false);
    return array;
}

inline std::vector<cv::String> toPython(const std::vector<cv::String>& values) { return values; }
inline int toPython(int value) { return value; }
inline bool toPython(bool value) { return value; }
inline double toPython(double value) { return value; }

inline std::string typeOf(const py::object& object)
{
    return py::type::of(object).attr("__name__").cast<std::string>();
}

template <typename Value> const char* kindOf()
{
    return std::is_same<Value, bool>::value ? "a bool" : std::is_same<Value, int>::value ? "an int" : "a number";
}

//! The setter of a field. An int is taken from what is one alone: pybind11 would cut the fractions of numpy's floats
//! off, and take None for False.
template <typename Class, typename Value>
py::cpp_function setterOf(const py::object& type, const std::string& name, Value Class::*field)
{
    const auto set = [name, field](Class& self, const py::object& value) {
        const bool isNumber = std::is_arithmetic<Value>::value;
        py::detail::make_caster<Value> caster;
        if ((isNumber && value.is_none()) || !caster.load(value, !std::is_same<Value, int>::value))
            throw py::type_error(name +
                                 (isNumber ? std::string(" must be ") + kindOf<Value>() + ", not " : " cannot be ") +
                                 typeOf(value));
        self.*field = py::detail::cast_op<Value>(caster);
    };
    return py::cpp_function(set, py::is_method(type), py::arg("value"));
}

// Files

//! What write() stores, as the text of a file of this name (XML, YAML or JSON by its extension)
std::string toText(const cv::Algorithm& algorithm, const std::string& filename);

//! Calls read() for what toText() has made; throws cv::Exception.
void fromText(cv::Algorithm& algorithm, const std::string& text);

//! The name of a file, which may be a path object
std::string nameOf(const py::object& filename);
//! The same of a file that can be read; raises OSError, as open() does
std::string nameOfFile(const py::object& filename);

//! Throws for a name of a compressed file.
void writeText(const py::object& filename, const std::string& text);
void writeFile(const py::object& filename, const cv::Algorithm& algorithm);

//! Calls read() with the text of a file; its cv::Exception gets the name. So does the error if the file is no text.
void readFile(const py::object& filename, const std::function<void(const std::string& text)>& read);

#endif
