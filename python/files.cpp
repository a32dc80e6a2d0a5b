// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

// Python opens the files: its errors say what is wrong with a name.

std::string toText(const cv::Algorithm& algorithm, const std::string& filename)
{
    cv::FileStorage storage(filename, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << algorithm.getDefaultName() << "{";
    algorithm.write(storage);
    storage << "}";
    return storage.releaseAndGetString();
}

void fromText(cv::Algorithm& algorithm, const std::string& text)
{
    const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    algorithm.read(storage.getFirstTopLevelNode());
}

std::string nameOf(const py::object& filename)
{
    return py::module_::import("os").attr("fspath")(filename).cast<std::string>();
}

std::string nameOfFile(const py::object& filename)
{
    const std::string name = nameOf(filename); // no descriptor, which open() would close
    py::module_::import("io").attr("open")(filename).attr("close")();
    return name;
}

void writeText(const py::object& filename, const std::string& text)
{
    const std::string name = nameOf(filename);
    if (name.size() > 3 && name.compare(name.size() - 3, 3, ".gz") == 0)
        throw py::value_error("filename: '" + name + "': only C++ writes compressed files, leave out .gz");
    const py::object file = py::module_::import("io").attr("open")(filename, "w", py::arg("encoding") = "utf-8");
    file.attr("write")(text);
    file.attr("close")();
}

void writeFile(const py::object& filename, const cv::Algorithm& algorithm)
{
    writeText(filename, toText(algorithm, nameOf(filename)));
}

void readFile(const py::object& filename, const std::function<void(const std::string& text)>& read)
{
    const std::string name = nameOf(filename); // no descriptor, which open() would close
    const py::object file = py::module_::import("io").attr("open")(filename, "r", py::arg("encoding") = "utf-8");
    try
    {
        const std::string text = file.attr("read")().cast<std::string>();
        file.attr("close")();
        read(text);
    }
    catch (const py::error_already_set& e)
    {
        file.attr("close")();
        if (!e.matches(PyExc_UnicodeDecodeError))
            throw;
        throw py::value_error("filename: '" + name + "': it must be text in UTF-8, not compressed");
    }
    catch (const cv::Exception& e) // which does not know the name
    {
        CV_Error(e.code, "filename: '" + name + "': " + e.err);
    }
}
