// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifdef HAVE_OPENCV_HDPSTEREO

//! An empty pointer is None in Python. (The generated conversion makes an object of it that crashes when it is used.)
static PyObject* pyopencv_from(const cv::Ptr<cv::stereo::DisparityPredictionModel>& model)
{
    if (!model)
        Py_RETURN_NONE;
    return pyopencv_stereo_DisparityPredictionModel_Instance(model);
}

#endif
