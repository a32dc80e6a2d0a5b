// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "missing_pixels.hpp"

#include "../base/vectorized.hpp"

#include <cstring>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, pixelsPerOutlier, 1024, "pixels",
            "of a pair of floats, of which one may be too dark and one too bright: defects and highlights are fewer");

//! A mask of 0 and 255 from that of the caller, and where the image has numbers
Mat maskOf(const Mat& image, const Mat& given)
{
    Mat mask;
    if (given.empty())
        mask = Mat(image.size(), CV_8U, Scalar(255));
    else
        compare(given, Scalar(0), mask, CMP_NE);
    if (image.depth() == CV_32F)
        mask &= (image - image) == 0; // neither infinite nor NaN
    return mask;
}

//! Of a row that has data. pixel: bytes
void fillRow(const uchar* image, const uchar* mask, int width, size_t pixel, uchar* filled)
{
    const auto repeat = [&](int from, int begin, int end) {
        for (int x = begin; x < end; ++x)
            std::memcpy(filled + x * pixel, image + from * pixel, pixel);
    };
    int last = -1; // with data
    for (int x = 0; x <= width; ++x)
    {
        if (x < width && !mask[x])
            continue;
        const int first = last + 1, middle = last < 0 ? first : x == width ? width : (first + x + 1) / 2;
        if (last >= 0)
            repeat(last, first, middle);
        if (x == width)
            break;
        repeat(x, middle, x + 1);
        last = x;
    }
}

} // namespace

void fillMissing(const Mat& image, const Mat& mask, Mat& filled)
{
    const int rows = image.rows;
    filled.create(image.size(), image.type());
    std::vector<uchar> has(rows);
    parallelFor(rows, [&](int y) {
        has[y] = std::memchr(mask.ptr(y), 255, (size_t)mask.cols) != nullptr;
        if (has[y])
            fillRow(image.ptr(y), mask.ptr(y), image.cols, image.elemSize(), filled.ptr(y));
    });
    std::vector<int> above(rows), below(rows); // the nearest rows with data, or far away
    for (int y = 0, last = -2 * rows; y < rows; ++y)
        above[y] = last = has[y] ? y : last;
    for (int y = rows - 1, last = 3 * rows; y >= 0; --y)
        below[y] = last = has[y] ? y : last;
    for (int y = 0; y < rows; ++y)
    {
        const int nearest = y - above[y] <= below[y] - y ? above[y] : below[y];
        if (nearest < 0 || nearest >= rows)
            filled.row(y).setTo(Scalar::all(0));
        else if (nearest != y)
            filled.row(nearest).copyTo(filled.row(y));
    }
}

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

void wholeLevels(const Mat& image, const Mat& mask, const FloatLevels& floats, Mat& levels)
{
    const double scale = floats.white > floats.black ? USHRT_MAX / (floats.white - floats.black) : 0;
    levels.create(image.size(), CV_16U);
    parallelFor(image.rows, [&](int y) {
        const float* const row = image.ptr<float>(y);
        const uchar* const has = mask.ptr(y);
        ushort* const level = levels.ptr<ushort>(y);
        for (int x = 0; x < image.cols; ++x)
            level[x] = (ushort)(has[x] ? clamped((row[x] - floats.black) * scale, 0., 65535.) + 0.5 : 0);
    });
}

void completePair(const Mat& left, const Mat& right, const Mat& leftMask, const Mat& rightMask,
                  const FloatLevels* given, CompletePair& complete)
{
    complete.left = left;
    complete.right = right;
    complete.masks = PairMasks();
    complete.floats = FloatLevels();
    const bool isFloat = left.depth() == CV_32F;
    if (!isFloat && leftMask.empty() && rightMask.empty())
        return;
    const PairMasks masks = { maskOf(left, leftMask), maskOf(right, rightMask) };
    if (isFloat)
    {
        complete.floats = given ? *given : findLevels(left, right, masks);
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
