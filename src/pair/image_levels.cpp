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

//! Pixels of a pair that are not below each of some levels, in every row or every step-th one
std::vector<double> countFrom(const std::vector<int>& levels, const Mat& left, const Mat& right, int step)
{
    const int width = left.cols;
    Mat ofRows((left.rows + step - 1) / step, (int)levels.size(), CV_32S);
    parallelFor(ofRows.rows, [&](int i) {
        const ushort *l = left.ptr<ushort>(i * step), *r = right.ptr<ushort>(i * step);
        for (int k = 0; k < ofRows.cols; ++k)
        {
            const int level = levels[k];
            int count = 0;
            HDP_VECTORIZED for (int x = 0; x < width; ++x) count += (l[x] >= level) + (r[x] >= level);
            ofRows.at<int>(i, k) = count;
        }
    });
    std::vector<double> counts;
    for (int k = 0; k < ofRows.cols; ++k)
        counts.push_back(sum(ofRows.col(k))[0]);
    return counts;
}

//! How often levels of so many bits are doubled to become those of 8 bits, brightened; negative: halved
int timesDoubled(int bits, double brightness) { return minBits - bits + doublingsOf(brightness); }

//! The grey levels of a row, see greyLevels(). times: see timesDoubled(), curve: see brightnessCurve()
void greyRow(const Mat& image, int y, int times, const std::vector<ushort>& curve, ushort* levels)
{
    const int width = image.cols, up = std::max(times, 0), down = std::max(-times, 0), end = (int)curve.size();
    const uchar* const bytes = image.ptr(y);
    const ushort* const words = image.ptr<ushort>(y);
    if (image.depth() == CV_16U)
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
            (ushort)std::min(words[x] * greyScale << up >> down, end - 1);
    else if (image.channels() > 1)
        dispatched::greyRow(bytes, image.channels(), width, times, levels);
    else
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)(bytes[x] * greyScale << up);
    for (int x = 0; x < width && end > whiteEnd; ++x)
        levels[x] = curve[levels[x]];
}

} // namespace

int bitsInUse(const Mat& left, const Mat& right, double share)
{
    int bits = minBits;
    if (left.depth() == CV_8U)
        return bits;
    std::vector<int> ends; // of the levels of minBits bits and more
    for (int i = minBits; i < maxBits; ++i)
        ends.push_back(1 << i);
    const std::vector<double> tooBright = countFrom(ends, left, right, 1);
    while (bits < maxBits && tooBright[bits - minBits] > 2. * left.total() * share / pixelsPerBright)
        ++bits;
    return bits;
}

bool hasNoColours(const Mat& image)
{
    const int channels = image.channels(), width = image.cols;
    for (int y = 0; y < image.rows && channels > 1; ++y) // a few rows tell of most images with colours
    {
        const uchar* const row = image.ptr(y);
        uchar differences = 0;
        HDP_VECTORIZED for (int x = 0; x < width; ++x) differences |=
            (uchar)((row[channels * x] ^ row[channels * x + 1]) | (row[channels * x + 1] ^ row[channels * x + 2]));
        if (differences != 0)
            return false;
    }
    return true;
}

Mat byteLevels(const Mat& image, int bits, Mat& buffer, double brightness)
{
    const int times = timesDoubled(bits, brightness);
    const std::vector<ushort> curve = brightnessCurve(brightness);
    if (image.depth() == CV_16U)
    {
        buffer.create(image.size(), CV_8UC1);
        parallelForRows(image.size(), std::vector<ushort>(image.cols), [&](int y, std::vector<ushort>& levels) {
            greyRow(image, y, times, curve, levels.data());
            const int width = image.cols; // local, as stores of bytes may alias all else
            const ushort* const row = levels.data();
            uchar* const bytes = buffer.ptr(y);
            HDP_VECTORIZED for (int x = 0; x < width; ++x) bytes[x] = (uchar)(row[x] / greyScale);
        });
        return buffer;
    }
    Mat colors = image;
    if (image.channels() == 4)
    {
        cvtColor(image, buffer, COLOR_BGRA2BGR);
        colors = buffer;
    }
    if (times == 0)
        return colors;
    Mat bytes(1, 256, CV_8U);
    for (int level = 0; level < 256; ++level)
        bytes.at<uchar>(level) = (uchar)(curve[level * greyScale << times] / greyScale);
    LUT(colors, bytes, buffer);
    return buffer;
}

void greyLevels(const Mat& image, int bits, Mat& grey, double brightness)
{
    const int times = timesDoubled(bits, brightness);
    const std::vector<ushort> curve = brightnessCurve(brightness);
    grey.create(image.size(), CV_16U);
    parallelForRows(image.size(), [&](int y) { greyRow(image, y, times, curve, grey.ptr<ushort>(y)); });
}

double findBrightness(const Mat& left, const Mat& right, double share)
{
    if (share == 0) // nothing to be seen
        return 1;
    const int step = std::max(left.rows / rowsThatTell, 1), white = 255 * greyScale;
    const double all = 2. * left.cols * ((left.rows + step - 1) / step);
    std::vector<int> ends(1, white); // then those of the levels that are doubled once or more
    for (int i = 1; i <= maxDoublings; ++i)
        ends.push_back(whiteEnd >> i);
    const std::vector<double> bright = countFrom(ends, left, right, step);
    const double areWhite = bright[0];
    double doublings = 0;
    for (int i = 1; i <= maxDoublings; ++i)
    {
        const double dark = all - bright[i], lost = bright[i] - areWhite;
        // Of a pair that is mostly white, what is faint there is all that there is. What has no data is black.
        const double stays = dark - all * (1 - share);
        const double ofThem = (lost + std::max(areWhite - stays, 0.)) / (all * share);
        doublings += clamped((sceneShare - ofThem) / (sceneShare - lampShare), 0., 1.);
    }
    doublings = cvRound(doublings * steps) / steps;
    return doublings <= 1 ? 1 + doublings : 2 * doublings;
}

}}} // namespace cv::stereo::hdp
