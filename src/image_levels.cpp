// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "precomp.hpp"
#include "image_levels.hpp"
#include "image_levels.simd.hpp"
#include "image_levels.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv {
namespace stereo {
namespace hdp {

namespace {

void dispatchGrey(const uchar* pixels, int channels, int width, ushort* levels)
{
    CV_CPU_DISPATCH(greyRow, (pixels, channels, width, levels), CV_CPU_DISPATCH_MODES_ALL);
}

const int fewestBits = 8, mostBits = 16;
const int pixelsPerBright = 1024; // of so many pixels one may be too bright, as highlights and defective ones are

//! Calls convert(from, to, width) for each row.
template <typename From, typename To, typename Convert>
void convertRows(const Mat& image, Mat& converted, const Convert& convert)
{
    parallel_for_(Range(0, image.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            convert(image.ptr<From>(y), converted.ptr<To>(y), image.cols);
    });
}

} // namespace

int countBits(const Mat& left, const Mat& right)
{
    int bits = fewestBits;
    if (left.depth() == CV_8U)
        return bits;
    Mat tooBright(left.rows, mostBits - fewestBits, CV_32S); // pixels of each row, for each number of bits
    parallel_for_(Range(0, left.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort *l = left.ptr<ushort>(y), *r = right.ptr<ushort>(y);
            for (int i = 0; i < tooBright.cols; ++i)
            {
                const int limit = 1 << (fewestBits + i);
                int count = 0;
                HDP_VECTORIZED for (int x = 0; x < left.cols; ++x) count += (l[x] >= limit) + (r[x] >= limit);
                tooBright.at<int>(y, i) = count;
            }
        }
    });
    while (bits < mostBits && sum(tooBright.col(bits - fewestBits))[0] > 2. * left.total() / pixelsPerBright)
        ++bits;
    return bits;
}

Mat byteLevels(const Mat& image, int bits, Mat& buffer)
{
    if (image.type() == CV_8UC1 || image.type() == CV_8UC3)
        return image;
    if (image.type() == CV_8UC4)
    {
        cvtColor(image, buffer, COLOR_BGRA2BGR);
        return buffer;
    }
    buffer.create(image.size(), CV_8UC1);
    const int shift = bits - fewestBits;
    convertRows<ushort, uchar>(image, buffer, [=](const ushort* pixels, uchar* levels, int width) {
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (uchar)std::min(pixels[x] >> shift, 255);
    });
    return buffer;
}

void greyLevels(const Mat& image, int bits, Mat& grey)
{
    grey.create(image.size(), CV_16U);
    if (image.depth() == CV_16U)
    {
        const int shift = bits - fewestBits;
        return convertRows<ushort, ushort>(image, grey, [=](const ushort* pixels, ushort* levels, int width) {
            HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
                (ushort)std::min(pixels[x] * greyScale >> shift, 256 * greyScale - 1);
        });
    }
    const int channels = image.channels();
    convertRows<uchar, ushort>(image, grey, [=](const uchar* pixels, ushort* levels, int width) {
        if (channels > 1)
            return dispatchGrey(pixels, channels, width, levels);
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)(pixels[x] * greyScale);
    });
}

} // namespace hdp
} // namespace stereo
} // namespace cv
