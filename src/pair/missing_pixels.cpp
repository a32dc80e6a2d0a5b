// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "missing_pixels.hpp"

#include "../base/vectorized.hpp"
#include "image_levels.hpp"

#include <cfloat>
#include <cstring>
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

//! A mask of 0 and 255 from that of the caller, and where the image has numbers
Mat maskOf(const Mat& image, const Mat& given)
{
    Mat mask = given.empty() ? Mat(image.size(), CV_8U, Scalar(255)) : Mat(given != 0);
    if (image.depth() == CV_32F)
        mask &= (image - image) == 0; // neither infinite nor NaN
    return mask;
}

//! Fills the pixels of a row that have no data; returns whether others have. pixel: bytes of one
bool fillRow(uchar* row, const uchar* has, int width, size_t pixel)
{
    const uchar* const end = has + width;
    for (const uchar* begin = std::find(has, end, 0); begin < end; begin = std::find(begin, end, 0))
    {
        const uchar* const next = std::find_if(begin, end, [](uchar data) { return data != 0; });
        const int first = (int)(begin - has), count = (int)(next - begin);
        if (count == width)
            return false;
        const int fromLeft = first == 0 ? 0 : next == end ? count : (count + 1) / 2;
        for (int i = 0; i < count; ++i)
            std::memcpy(row + (first + i) * pixel, row + (i < fromLeft ? first - 1 : first + count) * pixel, pixel);
        begin = next;
    }
    return true;
}

//! Fills pixels without data along their rows, and rows without any from the nearest one that has some. image: 8 or 16
//! bits, any number of channels; mask: CV_8UC1, 255 where there is data, else 0
void fillMissing(const Mat& image, const Mat& mask, Mat& filled)
{
    std::vector<uchar> has(image.rows);
    image.copyTo(filled);
    parallelForRows(image.size(),
                    [&](int y) { has[y] = fillRow(filled.ptr(y), mask.ptr(y), image.cols, image.elemSize()); });
    std::vector<int> rows(image.rows); // that each one is taken from
    std::iota(rows.begin(), rows.end(), 0);
    if (!fillRow(reinterpret_cast<uchar*>(rows.data()), has.data(), image.rows, sizeof(int)))
        filled.setTo(Scalar::all(0));
    for (int y = 0; y < image.rows; ++y)
        if (rows[y] != y)
            filled.row(rows[y]).copyTo(filled.row(y));
}

//! The levels that become black and white: the lowest and the highest one with data, but for outliers
FloatLevels findLevels(const Mat& left, const Mat& right, const PairMasks& masks)
{
    std::vector<float> values;
    values.reserve(2 * left.total());
    const Mat images[2] = { left, right }, valid[2] = { masks.left, masks.right };
    for (int i = 0; i < 2; ++i)
        for (int y = 0; y < left.rows; ++y)
            for (int x = 0; x < left.cols; ++x)
                if (valid[i].ptr(y)[x])
                    values.push_back(images[i].ptr<float>(y)[x]);
    FloatLevels floats = { 0, 0 };
    if (values.empty())
        return floats;
    const size_t outliers = values.size() / pixelsPerOutlier;
    const auto low = values.begin() + outliers, high = values.end() - 1 - outliers;
    std::nth_element(values.begin(), low, values.end());
    floats.black = *low;
    std::nth_element(low, high, values.end());
    floats.white = *high;
    return floats;
}

//! Levels of CV_32FC1 in CV_16UC1, 0 where there is no data; all are black if floats' black and white are the same.
void wholeLevels(const Mat& image, const Mat& mask, const FloatLevels& floats, Mat& levels)
{
    const double range = floats.white - floats.black, scale = range > FLT_MIN ? USHRT_MAX / range : 0;
    levels.create(image.size(), CV_16U);
    parallelForRows(image.size(), [&](int y) {
        const float* const row = image.ptr<float>(y);
        const uchar* const has = mask.ptr(y);
        ushort* const level = levels.ptr<ushort>(y);
        for (int x = 0; x < image.cols; ++x)
            level[x] = (ushort)(has[x] ? clamped((row[x] - floats.black) * scale, 0., 65535.) + 0.5 : 0);
    });
}

} // namespace

void completePair(const Mat& left, const Mat& right, const Mat& leftMask, const Mat& rightMask, const PairModel& model,
                  CompletePair& complete)
{
    complete.left = left;
    complete.right = right;
    complete.masks = PairMasks();
    complete.floats = FloatLevels();
    complete.borderLevel = 0;
    const bool isFloat = left.depth() == CV_32F, isMasked = !leftMask.empty() || !rightMask.empty();
    PairMasks masks;
    if (isFloat || isMasked)
        masks = { maskOf(left, leftMask), maskOf(right, rightMask) };
    else if (model.empty())
        complete.borderLevel = findBorders(left, right, masks);
    else if (model.borderLevel > 0)
    {
        const ImageFrame frame(Size(model.width, model.height), Point(model.x, model.y));
        complete.borderLevel = model.borderLevel;
        maskBorders(left, model.borderLevel, frame, masks.left);
        maskBorders(right, model.borderLevel, frame, masks.right);
    }
    if (masks.isEmpty())
        return;
    if (isFloat)
    {
        complete.floats = model.empty() ? findLevels(left, right, masks) : FloatLevels{ model.black, model.white };
        wholeLevels(left, masks.left, complete.floats, complete.left);
        wholeLevels(right, masks.right, complete.floats, complete.right);
    }
    if (countNonZero(masks.left) == (int)left.total() && countNonZero(masks.right) == (int)right.total())
        return;
    fillMissing(complete.left, masks.left, complete.filled[0]);
    fillMissing(complete.right, masks.right, complete.filled[1]);
    complete.left = complete.filled[0];
    complete.right = complete.filled[1];
    complete.masks = masks;
}

}}} // namespace cv::stereo::hdp
