// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_RESULT_ARRAY_HPP
#define OPENCV_HDPSTEREO_RESULT_ARRAY_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! Throws if a result of this size cannot be written to an array.
inline void requireMat(OutputArray array, Size size, const char* name)
{
    if (!array.needed())
        CV_Error(Error::StsBadArg, format("%s must be an array, not noArray()", name));
    const int kind = array.kind();
    if (!array.isMat() && !array.isUMat() && kind != _InputArray::MATX && kind != _InputArray::CUDA_HOST_MEM)
        CV_Error(Error::StsBadArg, format("%s must be a Mat, not a vector or another array", name));
    if (array.fixedSize() && array.dims() > 2)
        CV_Error(Error::StsUnmatchedSizes, format("%s must have two dimensions, as its size is fixed", name));
    if (array.fixedSize() && array.size() != size)
        CV_Error(Error::StsUnmatchedSizes,
                 format("%s must have %d x %d pixels, not %d x %d, as its size is fixed", name, size.width, size.height,
                        array.size().width, array.size().height));
}

//! The same of this type
inline void requireMat(OutputArray array, Size size, int type, const char* name)
{
    requireMat(array, size, name);
    if (array.fixedType() && array.type() != type)
        CV_Error(Error::StsUnmatchedFormats, format("%s must be %s, not %s, which is fixed", name,
                                                    typeToString(type).c_str(), typeToString(array.type()).c_str()));
}

}}} // namespace cv::stereo::hdp

#endif
