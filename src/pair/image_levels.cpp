// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "image_levels.hpp"
#include "image_levels.simd.hpp"
#include "pair/image_levels.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt
#include "../base/dispatch.hpp"
#include "../base/tunable.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(greyRow)

const int minBits = 8, maxBits = 16; // of a level

HDP_TUNABLE(int, pixelsPerBright, 1024, "pixels",
            "of which one may be too bright: highlights and defects are fewer, parts of the scene more");
HDP_TUNABLE(int, pixelsPerLamp, 128, "pixels",
            "of a dark pair, of which one may become white: as few are lamps and what they shine on");
HDP_TUNABLE(int, maxUnusedBits, 2, "bits",
            "by which a dark pair is brightened: more would make noise look like texture");
HDP_TUNABLE(int, rowsThatTell, 64, "rows", "of a dark pair, about: more cost time and tell the same");

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

int countBits(const Mat& left, const Mat& right, double share)
{
    int bits = minBits;
    if (left.depth() == CV_8U)
        return bits;
    Mat tooBright(left.rows, maxBits - minBits, CV_32S); // pixels of each row, for each number of bits
    parallel_for_(Range(0, left.rows), [&](const Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
        {
            const ushort *l = left.ptr<ushort>(y), *r = right.ptr<ushort>(y);
            for (int i = 0; i < tooBright.cols; ++i)
            {
                const int limit = 1 << (minBits + i);
                int count = 0;
                HDP_VECTORIZED for (int x = 0; x < left.cols; ++x) count += (l[x] >= limit) + (r[x] >= limit);
                tooBright.at<int>(y, i) = count;
            }
        }
    });
    while (bits < maxBits && sum(tooBright.col(bits - minBits))[0] > 2. * left.total() * share / pixelsPerBright)
        ++bits;
    return bits;
}

Mat byteLevels(const Mat& image, int bits, Mat& buffer)
{
    const int channels = image.channels(), times = minBits - bits;
    if (image.depth() == CV_16U)
    {
        buffer.create(image.size(), CV_8UC1);
        convertRows<ushort, uchar>(image, buffer, [=](const ushort* pixels, uchar* levels, int width) {
            if (times > 0)
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (uchar)std::min(pixels[x] << times, 255);
            else
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (uchar)std::min(pixels[x] >> -times, 255);
        });
        return buffer;
    }
    Mat colors = image;
    if (channels == 4)
    {
        cvtColor(image, buffer, COLOR_BGRA2BGR);
        colors = buffer;
    }
    if (times == 0)
        return colors;
    buffer.create(colors.size(), colors.type());
    convertRows<uchar, uchar>(colors, buffer, [=](const uchar* pixels, uchar* levels, int width) {
        const int count = width * std::min(channels, 3);
        HDP_VECTORIZED for (int i = 0; i < count; ++i) levels[i] = (uchar)std::min(pixels[i] << times, 255);
    });
    return buffer;
}

void greyLevels(const Mat& image, int bits, Mat& grey)
{
    const int times = minBits - bits;
    grey.create(image.size(), CV_16U);
    if (image.depth() == CV_16U)
    {
        return convertRows<ushort, ushort>(image, grey, [=](const ushort* pixels, ushort* levels, int width) {
            if (times > 0)
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
                    (ushort)std::min(pixels[x] * greyScale << times, whiteLevel);
            else
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
                    (ushort)std::min(pixels[x] * greyScale >> -times, whiteLevel);
        });
    }
    const int channels = image.channels();
    convertRows<uchar, ushort>(image, grey, [=](const uchar* pixels, ushort* levels, int width) {
        if (channels > 1)
            return dispatched::greyRow(pixels, channels, width, times, levels);
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
            (ushort)std::min(pixels[x] * greyScale << times, whiteLevel);
    });
}

int countUnusedBits(const Mat& left, const Mat& right, double share)
{
    const int step = std::max(left.rows / rowsThatTell, 1);
    int unused = 0;
    for (; unused < maxUnusedBits; ++unused)
    {
        const int limit = 256 * greyScale >> (unused + 1);
        int64 bright = 0, all = 0;
        for (int y = 0; y < left.rows; y += step, all += 2 * left.cols)
        {
            const ushort *l = left.ptr<ushort>(y), *r = right.ptr<ushort>(y);
            int count = 0;
            HDP_VECTORIZED for (int x = 0; x < left.cols; ++x) count += (l[x] >= limit) + (r[x] >= limit);
            bright += count;
        }
        if ((double)(bright * pixelsPerLamp) > all * share)
            break;
    }
    return unused;
}

}}} // namespace cv::stereo::hdp
