// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "image_levels.hpp"
#include "image_levels.simd.hpp"
#include "pair/image_levels.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(greyRow)

const int minBits = 8, maxBits = 16; // of a level

HDP_TUNABLE(int, pixelsPerBright, 1024, "pixels",
            "of which one may be too bright: highlights and defects are fewer, parts of the scene more");
HDP_TUNABLE(double, lampShare, 1. / 128, "of all pixels",
            "that may become white: as few are lamps and what they shine on");
HDP_TUNABLE(double, sceneShare, 1. / 16, "of all pixels",
            "that would become white, for which a pair stays as it is: as many are a part of the scene");
HDP_TUNABLE(int, rowsThatTell, 64, "rows", "of a dark pair, about: more cost time and tell the same");

const int maxDoublings = 2;          // of the levels of a dark pair: more would make noise look like texture
const double steps = 64;             // to the next doubling: the brightness is exact in any format of a file
const int whiteEnd = whiteLevel + 1; // the first level that does not exist

//! How often levels are doubled for a brightness, where they are doubled at all
int doublingsOf(double brightness) { return brightness > 2 ? 2 : brightness > 1 ? 1 : 0; }

/** What levels that are doubled become, see greyLevels(): below the knee they are, above it the line to white follows.
knee: whiteEnd doubles all that it can; 0 changes nothing. */
double doubled(double level, double knee)
{
    const double twice = 2 * level;
    return twice <= knee ? twice : knee + (twice - knee) * (whiteEnd - knee) / (2 * whiteEnd - knee);
}

//! Of levels that are doubled doublingsOf(brightness) times, and not cut off
std::vector<ushort> brightnessCurve(double brightness)
{
    std::vector<ushort> curve(whiteEnd << doublingsOf(brightness));
    const double first = whiteEnd * std::min(brightness - 1, 1.), second = whiteEnd * std::max(brightness / 2 - 1, 0.);
    const double unit = whiteEnd / (double)curve.size();
    for (size_t i = 0; i < curve.size(); ++i)
        curve[i] = (ushort)std::min((int)doubled(doubled(i * unit, first), second), whiteLevel);
    return curve;
}

int shifted(int level, int times) { return times >= 0 ? level << times : level >> -times; }

//! Calls convert(from, to, width) for each row.
template <typename From, typename To, typename Convert>
void convertRows(const Mat& image, Mat& converted, const Convert& convert)
{
    parallelFor(image.rows, [&](int y) { convert(image.ptr<From>(y), converted.ptr<To>(y), image.cols); });
}

} // namespace

int bitsInUse(const Mat& left, const Mat& right, double share)
{
    int bits = minBits;
    if (left.depth() == CV_8U)
        return bits;
    Mat tooBright(left.rows, maxBits - minBits, CV_32S); // pixels of each row, for each number of bits
    parallelFor(left.rows, [&](int y) {
        const ushort *l = left.ptr<ushort>(y), *r = right.ptr<ushort>(y);
        for (int i = 0; i < tooBright.cols; ++i)
        {
            const int limit = 1 << (minBits + i);
            int count = 0;
            HDP_VECTORIZED for (int x = 0; x < left.cols; ++x) count += (l[x] >= limit) + (r[x] >= limit);
            tooBright.at<int>(y, i) = count;
        }
    });
    while (bits < maxBits && sum(tooBright.col(bits - minBits))[0] > 2. * left.total() * share / pixelsPerBright)
        ++bits;
    return bits;
}

Mat byteLevels(const Mat& image, int bits, Mat& buffer, double brightness)
{
    const int times = minBits - bits + doublingsOf(brightness);
    Mat colors = image;
    if (image.channels() == 4)
    {
        cvtColor(image, buffer, COLOR_BGRA2BGR);
        colors = buffer;
    }
    if (image.depth() == CV_8U && times == 0)
        return colors;
    const std::vector<ushort> curve = brightnessCurve(brightness);
    if (image.depth() == CV_8U)
    {
        Mat bytes(1, 256, CV_8U);
        for (int level = 0; level < 256; ++level)
            bytes.at<uchar>(level) = (uchar)(curve[level * greyScale << times] / greyScale);
        LUT(colors, bytes, buffer);
        return buffer;
    }
    buffer.create(image.size(), CV_8UC1);
    convertRows<ushort, uchar>(image, buffer, [&](const ushort* pixels, uchar* levels, int width) {
        for (int x = 0; x < width; ++x)
            levels[x] =
                (uchar)(curve[std::min(shifted(pixels[x] * greyScale, times), (int)curve.size() - 1)] / greyScale);
    });
    return buffer;
}

void greyLevels(const Mat& image, int bits, Mat& grey, double brightness)
{
    const int times = minBits - bits + doublingsOf(brightness), channels = image.channels();
    const int largest = (whiteEnd << doublingsOf(brightness)) - 1;
    const std::vector<ushort> curve = brightness > 1 ? brightnessCurve(brightness) : std::vector<ushort>();
    const auto bend = [&](ushort* levels, int width) {
        for (int x = 0; x < width && !curve.empty(); ++x)
            levels[x] = curve[levels[x]];
    };
    grey.create(image.size(), CV_16U);
    if (image.depth() == CV_16U)
    {
        return convertRows<ushort, ushort>(image, grey, [&](const ushort* pixels, ushort* levels, int width) {
            if (times > 0)
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
                    (ushort)std::min(pixels[x] * greyScale << times, largest);
            else
                HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
                    (ushort)std::min(pixels[x] * greyScale >> -times, largest);
            bend(levels, width);
        });
    }
    convertRows<uchar, ushort>(image, grey, [&](const uchar* pixels, ushort* levels, int width) {
        if (channels > 1)
            dispatched::greyRow(pixels, channels, width, times, levels);
        else
            HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)(pixels[x] * greyScale << times);
        bend(levels, width);
    });
}

double findBrightness(const Mat& left, const Mat& right, double share)
{
    if (share == 0) // nothing to be seen
        return 1;
    const int step = std::max(left.rows / rowsThatTell, 1), white = 255 * greyScale;
    double doublings = 0;
    for (int i = 1; i <= maxDoublings; ++i)
    {
        const int limit = whiteEnd >> i;
        int64 dark = 0, lost = 0, all = 0;
        for (int y = 0; y < left.rows; y += step, all += 2 * left.cols)
        {
            const ushort *l = left.ptr<ushort>(y), *r = right.ptr<ushort>(y);
            int below = 0, belowWhite = 0;
            HDP_VECTORIZED for (int x = 0; x < left.cols; ++x)
            {
                below += (l[x] < limit) + (r[x] < limit);
                belowWhite += (l[x] < white) + (r[x] < white);
            }
            dark += below;
            lost += belowWhite - below;
        }
        // Of a pair that is mostly white, what is faint there is all that there is. What has no data is black.
        const double areWhite = (double)(all - dark - lost), stays = dark - all * (1 - share);
        const double ofThem = (lost + std::max(areWhite - stays, 0.)) / (all * share);
        doublings += clamped((sceneShare - ofThem) / (sceneShare - lampShare), 0., 1.);
    }
    doublings = cvRound(doublings * steps) / steps;
    return doublings <= 1 ? 1 + doublings : 2 * doublings;
}

}}} // namespace cv::stereo::hdp
