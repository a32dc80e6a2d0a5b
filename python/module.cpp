// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The Python module hdpstereo._hdpstereo: matchers, models and tree strategies for numpy arrays, without cv2.
#include "bindings.hpp"

//! cv::Exception in Python, with its text and without OpenCV's additions
static void translate(std::exception_ptr exception)
{
    try
    {
        if (exception)
            std::rethrow_exception(exception);
    }
    catch (const cv::Exception& e)
    {
        PyObject* type = PyExc_ValueError;
        if (e.code == cv::Error::StsNotImplemented)
            type = PyExc_NotImplementedError;
        else if (e.code == cv::Error::StsNoMem)
            type = PyExc_MemoryError;
        else if (e.code == cv::Error::StsError || e.code == cv::Error::StsInternal)
            type = PyExc_RuntimeError;
        PyErr_SetString(type, e.err.c_str());
    }
}

PYBIND11_MODULE(_hdpstereo, module)
{
    py::register_exception_translator(&translate);
    module.attr("__version__") = HDPSTEREO_VERSION;
    module.attr("CV_16S") = CV_16S;
    module.attr("CV_32F") = CV_32F;
    module.def("getNumThreads", &cv::getNumThreads, "Returns how many threads compute() uses at most.");
    module.def("setNumThreads", &cv::setNumThreads, py::arg("numThreads").noconvert(), R"doc(
Sets how many threads compute() uses at most, for all matchers of this process.

numThreads: 1 for none but the caller's; a negative number for as many as there are processors. If cv2 is loaded with the
same library of OpenCV, it is that of cv2, too.)doc");
    addTreeStrategies(module);
    addPredictionModel(module);
    addPairModel(module);
    addMatcher(module);
    addStereoRig(module);
}
