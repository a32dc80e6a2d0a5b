// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

namespace {

//! The depth of a Mat, or -1
int depthOf(const py::dtype& type)
{
    static const struct
    {
        int depth;
        py::dtype type;
    } depths[] = { { CV_8U, py::dtype::of<uchar>() },   { CV_8S, py::dtype::of<schar>() },
                   { CV_16U, py::dtype::of<ushort>() }, { CV_16S, py::dtype::of<short>() },
                   { CV_32S, py::dtype::of<int>() },    { CV_32F, py::dtype::of<float>() },
                   { CV_64F, py::dtype::of<double>() } };
    for (const auto& known : depths)
        if (type.equal(known.type))
            return known.depth;
    return -1;
}

std::string describe(const py::array& array)
{
    return py::str("an array of {} with shape {}").format(array.dtype(), array.attr("shape")).cast<std::string>();
}

} // namespace

cv::Mat toMat(const py::array& array, const char* name, std::vector<py::array>& kept)
{
    if (py::isinstance(array, py::module_::import("numpy").attr("ma").attr("MaskedArray"))) // which is a py::array, too
        throw py::type_error(std::string(name) + " must be a plain array, not a masked one: its mask would be ignored");
    const int depth = depthOf(array.dtype());
    const py::ssize_t dimensions = array.ndim();
    const py::ssize_t channels = dimensions == 3 ? array.shape(2) : 1;
    if (depth < 0 || dimensions < 2 || dimensions > 3 || channels < 1 || channels > CV_CN_MAX ||
        array.shape(0) > INT_MAX || array.shape(1) > INT_MAX)
        throw py::value_error(std::string(name) +
                              " must be an array of uint8, int8, uint16, int16, int32, float32 or float64 and two or "
                              "three dimensions, not " +
                              describe(array));

    // Rows may be apart, as long as they do not overlap; pixels may not.
    const py::ssize_t size = array.itemsize(), columns = array.shape(1);
    const bool isLaidOut =
        (channels == 1 || array.strides(2) == size) && (columns == 1 || array.strides(1) == size * channels) &&
        (array.shape(0) == 1 || (array.strides(0) >= size * channels * columns && array.strides(0) % size == 0));
    const py::array pixels = isLaidOut ? array : py::array::ensure(array, py::array::c_style);
    kept.push_back(pixels);
    const size_t step = pixels.shape(0) == 1 || pixels.size() == 0 ? (size_t)cv::Mat::AUTO_STEP : pixels.strides(0);
    return cv::Mat((int)pixels.shape(0), (int)columns, CV_MAKETYPE(depth, (int)channels),
                   const_cast<void*>(pixels.data()), step);
}

std::vector<cv::Mat> toMats(const py::iterable& arrays, const char* name, std::vector<py::array>& kept)
{
    std::vector<cv::Mat> mats;
    for (const py::handle& item : arrays)
    {
        if (!py::isinstance<py::array>(item))
            throw py::type_error(std::string(name) + " must be a sequence of numpy arrays");
        mats.push_back(toMat(py::reinterpret_borrow<py::array>(item), name, kept));
    }
    return mats;
}

py::object toPython(const cv::Mat& mat)
{
    if (mat.empty())
        return py::none();
    static const char* const types[] = { "uint8", "int8", "uint16", "int16", "int32", "float32", "float64" };
    std::vector<py::ssize_t> shape = { mat.rows, mat.cols };
    std::vector<py::ssize_t> strides = { (py::ssize_t)mat.step[0], (py::ssize_t)mat.elemSize() };
    if (mat.channels() > 1)
    {
        shape.push_back(mat.channels());
        strides.push_back((py::ssize_t)mat.elemSize1());
    }
    const py::capsule owner(new cv::Mat(mat), [](void* p) { delete static_cast<cv::Mat*>(p); });
    return py::array(py::dtype(types[mat.depth()]), shape, strides, mat.data, owner);
}
