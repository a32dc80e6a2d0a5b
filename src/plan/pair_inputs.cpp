// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_inputs.hpp"
#include "pair_plan.hpp"
#include "../base/vectorized.hpp"
#include "../pair/image_pyramid.hpp"

#include <cfloat>
#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

const int limit = (SHRT_MAX + 1) / StereoMatcher::DISP_SCALE; // of disparities in CV_16S

//! Without the type that an empty array may have
Mat toMat(InputArray array) { return array.empty() ? Mat() : array.getMat(); }

//! For messages
String typeOf(const Mat& map) { return map.dims == 2 ? typeToString(map.type()) : format("%d dimensions", map.dims); }

Mat toMask(InputArray array, const char* name)
{
    const Mat mask = toMat(array);
    if (!mask.empty() && (mask.dims != 2 || mask.type() != CV_8UC1))
        CV_Error(Error::StsUnsupportedFormat,
                 format("%s must be CV_8UC1, 0 where the image has no data, not %s", name, typeOf(mask).c_str()));
    return mask.clone();
}

//! A map of the caller in floats; if it is empty and the other of the two is not, one of NaN
Mat toLimits(const Mat& map, const Mat& other)
{
    Mat limits;
    map.convertTo(limits, CV_32F);
    return map.empty() && !other.empty() ? Mat(other.size(), CV_32F, Scalar(NAN)) : limits;
}

Mat withoutNaN(const Mat& map, float value)
{
    Mat numbers = map.clone();
    patchNaNs(numbers, value);
    return numbers;
}

void checkSize(const Mat& input, Size size, const char* name)
{
    if (!input.empty() && input.size() != size)
        CV_Error(Error::StsUnmatchedSizes, format("%s must have the size of the images, %d x %d, not %d x %d", name,
                                                  size.width, size.height, input.cols, input.rows));
}

} // namespace

Mat imageOf(InputArray array, const char* name)
{
    if (array.isMatVector() || array.isUMatVector() || array.kind() == _InputArray::STD_VECTOR_VECTOR)
        CV_Error(Error::StsBadArg, format("%s must be an image, not a vector of them", name));
    return array.getMat();
}

void setMasks(InputArray left, InputArray right, PairInputs& inputs)
{
    const Mat leftMask = toMask(left, "leftMask"), rightMask = toMask(right, "rightMask");
    inputs.leftMask = leftMask;
    inputs.rightMask = rightMask;
}

void setRange(InputArray smallestArray, InputArray largestArray, PairInputs& inputs)
{
    const Mat given[] = { toMat(smallestArray), toMat(largestArray) };
    for (const Mat& map : given)
        if (!map.empty() && (map.dims != 2 || (map.type() != CV_16SC1 && map.type() != CV_32FC1)))
            CV_Error(Error::StsUnsupportedFormat,
                     format("%s must be CV_16SC1 or CV_32FC1, disparities in pixels, not %s",
                            &map == given ? "smallest" : "largest", typeOf(map).c_str()));
    if (!given[0].empty() && !given[1].empty() &&
        (given[1].type() != given[0].type() || given[1].size() != given[0].size()))
        CV_Error(Error::StsUnmatchedSizes,
                 format("largest must have the size and type of smallest, %d x %d and %s, not %d x %d and %s",
                        given[0].cols, given[0].rows, typeOf(given[0]).c_str(), given[1].cols, given[1].rows,
                        typeOf(given[1]).c_str()));
    const Mat smallest = toLimits(given[0], given[1]), largest = toLimits(given[1], given[0]);
    const int less = smallest.empty() ? 0 : countNonZero(largest < smallest);
    if (less > 0)
        CV_Error(Error::StsOutOfRange, format("largest must not be less than smallest, as it is in %d pixels", less));
    const int beyond = smallest.empty() ? 0 : countNonZero((smallest >= limit) | (largest < -limit));
    if (beyond > 0)
        CV_Error(Error::StsOutOfRange,
                 format("smallest must be below %d and largest at least %d, as they are not in %d pixels", limit,
                        -limit, beyond));
    inputs.smallest = smallest;
    inputs.largest = largest;
    if (inputs.hasRanges())
    {
        minMaxLoc(withoutNaN(inputs.smallest, -FLT_MAX), nullptr, &inputs.highestSmallest);
        minMaxLoc(withoutNaN(inputs.largest, FLT_MAX), &inputs.lowestLargest);
    }
    ++inputs.changes;
}

void setPrior(InputArray disparityArray, InputArray sigmaArray, PairInputs& inputs)
{
    const Mat disparity = toMat(disparityArray).clone();
    Mat sigma = disparity.empty() ? Mat() : toMat(sigmaArray).clone();
    if (!disparity.empty() && (disparity.dims != 2 || disparity.type() != CV_32FC1))
        CV_Error(Error::StsUnsupportedFormat,
                 format("disparity must be CV_32FC1, in pixels, NaN where nothing is known, not %s",
                        typeOf(disparity).c_str()));
    const bool isNumber = sigma.type() == CV_64FC1 && (sigma.total() == 1 || sigma.size() == Size(1, 4)); // or a Scalar
    if (isNumber)
        sigma = Mat(disparity.size(), CV_32F, Scalar(sigma.at<double>(0)));
    if (!disparity.empty() && (sigma.type() != CV_32FC1 || sigma.size() != disparity.size()))
        CV_Error(Error::StsUnmatchedSizes,
                 format("sigma must be a number, or CV_32FC1 of the size of disparity, %d x %d, not %s of %d x %d",
                        disparity.cols, disparity.rows, typeOf(sigma).c_str(), sigma.cols, sigma.rows));
    if (!disparity.empty() && countNonZero((disparity == disparity) & ~((sigma >= 0) & (sigma <= FLT_MAX))) > 0)
        CV_Error(Error::StsOutOfRange, "sigma must be finite and >= 0 where there is a disparity");
    inputs.prior = disparity;
    inputs.sigma = sigma;
    ++inputs.changes;
}

Range rangeOf(const PairInputs& inputs, int width)
{
    if (!inputs.hasRanges() || !checkRange(inputs.smallest) || !checkRange(inputs.largest)) // not all are limited
        return Range();
    double first, last;
    minMaxLoc(inputs.smallest, &first, nullptr);
    minMaxLoc(inputs.largest, nullptr, &last);
    const double most = std::min(width, limit) - 1;
    const int start = cvFloor(clamped(first, -most, most));
    return Range(start, cvCeil(clamped(last, (double)start, most)) + 1);
}

void checkInputs(const PairInputs& inputs, Size size)
{
    checkSize(inputs.leftMask, size, "leftMask");
    checkSize(inputs.rightMask, size, "rightMask");
    checkSize(inputs.prior, size, "the disparity of the prior");
    if (inputs.smallest.cols > size.width || inputs.smallest.rows > size.height)
        CV_Error(Error::StsUnmatchedSizes,
                 format("smallest and largest must have at most the size of the images, %d x %d, not %d x %d",
                        size.width, size.height, inputs.smallest.cols, inputs.smallest.rows));
}

void takeKnown(const PairInputs& inputs, const PairPlan& plan, KnownDisparities& known)
{
    const OutputPlan& output = plan.output;
    const int first = output.minDisparity, numDisparities = plan.numDisparities;
    std::vector<int> key = { inputs.changes,   plan.size.width,    plan.size.height, first,
                             numDisparities,   output.extension,   output.isWhole,   plan.top().hasFractions,
                             plan.top().layer, plan.finest().layer };
    for (const LayerPlan& layer : plan.layers)
        key.push_back(layer.seesBelow);
    if (known.key == key)
        return;
    known.key.clear();
    std::vector<int> counts;
    for (int layer = 0; layer <= plan.top().layer; ++layer)
        counts.push_back(layerDisparities(numDisparities, layer, plan.top().hasFractions));
    expandRanges(inputs.smallest, inputs.largest, plan.size, Range(first, first + numDisparities - 1), output.isWhole,
                 known.ranges);
    buildIntervals(known.ranges, first, output.extension, counts, known.units, known.intervals);
    known.hulls.resize(known.intervals.size());
    known.candidates.resize(known.intervals.size());
    if (plan.hasRanges)
        for (const LayerPlan& layer : plan.layers)
        {
            const Mat& intervals = known.intervals[layer.layer];
            known.candidates[layer.layer] =
                layer.seesBelow ? doubleIntervals(intervals, layer.numDisparities) : intervals;
            halveIntervals(intervals, known.hulls[layer.layer]);
        }
    known.points.resize(counts.size());
    if (plan.hasPrior)
        for (const LayerPlan& layer : plan.layers)
            pointsOfLayer(inputs.prior, inputs.sigma, first, output.extension, layer.layer, counts[layer.layer],
                          known.points[layer.layer]);
    known.key = key;
}

}}} // namespace cv::stereo::hdp
