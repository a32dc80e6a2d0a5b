// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_inputs.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

Mat toMask(InputArray array, const char* name)
{
    if (array.empty())
        return Mat();
    const Mat mask = array.getMat();
    if (mask.dims != 2 || mask.type() != CV_8UC1)
        CV_Error(Error::StsUnsupportedFormat, format("%s must be CV_8UC1, 0 where the image has no data", name));
    return mask.clone();
}

void checkSize(const Mat& input, Size size, const char* name)
{
    if (!input.empty() && input.size() != size)
        CV_Error(Error::StsUnmatchedSizes, format("%s must have the size of the images, %d x %d, not %d x %d", name,
                                                  size.width, size.height, input.cols, input.rows));
}

} // namespace

void setMasks(InputArray left, InputArray right, PairInputs& inputs)
{
    const Mat leftMask = toMask(left, "leftMask"), rightMask = toMask(right, "rightMask");
    inputs.leftMask = leftMask;
    inputs.rightMask = rightMask;
}

void checkInputs(const PairInputs& inputs, Size size)
{
    checkSize(inputs.leftMask, size, "leftMask");
    checkSize(inputs.rightMask, size, "rightMask");
}

}}} // namespace cv::stereo::hdp
