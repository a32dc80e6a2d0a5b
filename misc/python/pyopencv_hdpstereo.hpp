// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifdef HAVE_OPENCV_HDPSTEREO

//! The name that generated code has for an argument of this type
typedef cv::stereo::HDPTreeMatcher::Params HDPTreeMatcher_Params;

//! An empty pointer is None in Python. (The generated conversion makes an object of it that crashes when it is used.)
static PyObject* pyopencv_from(const cv::Ptr<cv::stereo::DisparityPredictionModel>& model)
{
    if (!model)
        Py_RETURN_NONE;
    return pyopencv_stereo_DisparityPredictionModel_Instance(model);
}

//! None is an empty pointer. (The conversion of OpenCV leaves a field as it was.)
static bool pyopencv_to_safe(PyObject* object, cv::Ptr<cv::stereo::DisparityPredictionModel>& model,
                             const ArgInfo& info)
{
    if (object == Py_None)
        model = cv::Ptr<cv::stereo::DisparityPredictionModel>();
    return pyopencv_to_safe<cv::Ptr<cv::stereo::DisparityPredictionModel>>(object, model, info);
}

#endif
