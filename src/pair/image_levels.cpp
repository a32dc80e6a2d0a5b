// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "image_levels.hpp"
#include "image_levels.simd.hpp"
#include "pair/image_levels.simd_declarations.hpp" // of the instruction sets, by CMakeLists.txt

#include <numeric>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_DISPATCH(greyRow)
HDP_DISPATCH(stretchRow)

const int minBits = 8, maxBits = 16;       // of a level
const int matchedBits = 10, fullBits = 14; // of one that is matched, and of one that will be stretched

HDP_TUNABLE(double, lampShare, 1. / 128, "of all pixels",
            "that may become white: as few are lamps and what they shine on");
HDP_TUNABLE(double, sceneShare, 1. / 16, "of all pixels",
            "that would become white, for which a pair stays as it is: as many are a part of the scene");
HDP_TUNABLE(int, rowsThatTell, 64, "rows",
            "of an image, and twice as many columns, about: more cost time and tell the same");
HDP_TUNABLE(int, margin, 6, "shares of the contrast",
            "of which one is left at each end: more leaves faint texture, less cuts off what few pixels have");

const int maxDoublings = 2;          // of the contrast of a pair, or of its levels: more makes noise look like texture
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

/** What levels of an image become, in whole numbers. They are doubled first: as often as they are brightened, or, if
they are stretched, so often that none of their bits is lost. */
struct Conversion
{
    int doublings;
    bool isStretched;
    int black, gain;                // what is stretched: (level - black) * gain / 65536
    std::vector<ushort> brightened; // of levels that are doubled doublingsOf(brightness) times, and not cut off

    explicit Conversion(const LevelScale& scale)
        : doublings(scale.isStretched() ? fullBits - matchedBits : doublingsOf(scale.brightness)),
          isStretched(scale.isStretched()), black(scale.black >> (maxBits - fullBits)),
          brightened(whiteEnd << doublingsOf(scale.brightness))
    {
        const double b = scale.brightness, unit = whiteEnd / (double)brightened.size();
        const double contrast = (scale.white - scale.black) / (double)LevelScale::end;
        gain = cvRound((1 << 16) / (contrast * unit * (1 << doublings)));
        const double first = whiteEnd * std::min(b - 1, 1.), second = whiteEnd * std::max(b / 2 - 1, 0.);
        for (size_t i = 0; i < brightened.size(); ++i)
            brightened[i] = (ushort)std::min((int)doubled(doubled(i * unit, first), second), whiteLevel);
    }

    //! Levels that are doubled, in place
    void operator()(ushort* levels, int width) const
    {
        if (isStretched)
            dispatched::stretchRow(levels, width, black, gain, (int)brightened.size() - 1);
        if ((int)brightened.size() > whiteEnd)
            for (int x = 0; x < width; ++x)
                levels[x] = brightened[levels[x]];
    }
};

//! Levels of the darkest and of the brightest channel of each pixel, below LevelScale::end, counted in steps of 16.
//! Pixels that are black or white have nothing to lose.
struct LevelCounts
{
    static const int step = 16;
    std::vector<int> darkest, brightest;

    LevelCounts() : darkest(LevelScale::end / step), brightest(darkest) {}

    template <typename T> void add(const Mat& image, const Mat& mask, int bits)
    {
        const int rowStep = std::max(image.rows / rowsThatTell, 1),
                  columnStep = std::max(image.cols / (2 * rowsThatTell), 1);
        const int channels = image.channels(), shift = maxBits - bits, most = (1 << bits) - 1;
        const int white = 255 << (bits - minBits); // the same for levels of 8 bits that are multiplied
        const bool isColour = channels > 1;        // alpha does not count
        for (int y = 0; y < image.rows; y += rowStep)
            for (int x = 0; x < image.cols; x += columnStep)
            {
                if (!mask.empty() && mask.at<uchar>(y, x) == 0)
                    continue;
                const T* const p = image.ptr<T>(y) + (ptrdiff_t)x * channels;
                const int low = isColour ? std::min(p[0], std::min(p[1], p[2])) : p[0],
                          high = isColour ? std::max(p[0], std::max(p[1], p[2])) : p[0];
                if (high > 0)
                    ++darkest[(std::min(low, most) << shift) / step];
                if (low < white)
                    ++brightest[(std::min(high, most) << shift) / step];
            }
    }

    //! The first step up to which there are more pixels than outliers
    static int firstOf(const std::vector<int>& counts)
    {
        const int outliers = std::accumulate(counts.begin(), counts.end(), 0) / pixelsPerOutlier;
        int first = 0;
        for (int below = counts[0]; below <= outliers && first + 1 < (int)counts.size(); below += counts[first])
            ++first;
        return first;
    }
};

//! How many pixels of a pair are at each of some levels or above, in every step-th row
std::vector<double> countFrom(const std::vector<int>& levels, const Mat& left, const Mat& right, int step)
{
    const int width = left.cols;
    Mat ofRows((left.rows + step - 1) / step, (int)levels.size(), CV_64F);
    parallelFor(ofRows.rows, [&](int i) {
        const ushort *l = left.ptr<ushort>(i * step), *r = right.ptr<ushort>(i * step);
        for (int k = 0; k < ofRows.cols; ++k)
        {
            const int level = levels[k];
            int count = 0;
            HDP_VECTORIZED for (int x = 0; x < width; ++x) count += (l[x] >= level) + (r[x] >= level);
            ofRows.at<double>(i, k) = count;
        }
    });
    std::vector<double> counts;
    reduce(ofRows, counts, 0, REDUCE_SUM);
    return counts;
}

//! The grey levels of a row, see greyLevels()
void levelsOfRow(const Mat& image, int y, int bits, const Conversion& convert, ushort* levels)
{
    const int times = minBits - bits + convert.doublings, up = std::max(times, 0), down = std::max(-times, 0);
    const int width = image.cols, white = (whiteEnd << convert.doublings) - 1;
    const uchar* const bytes = image.ptr(y);
    const ushort* const words = image.ptr<ushort>(y);
    if (image.depth() == CV_16U)
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] =
            (ushort)std::min(words[x] * greyScale << up >> down, white);
    else if (image.channels() > 1)
        dispatched::greyRow(bytes, image.channels(), width, times, levels);
    else
        HDP_VECTORIZED for (int x = 0; x < width; ++x) levels[x] = (ushort)(bytes[x] * greyScale << up);
    convert(levels, width);
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
    while (bits < maxBits && tooBright[bits - minBits] > 2. * left.total() * share / pixelsPerOutlier)
        ++bits;
    return bits;
}

bool hasNoColours(const Mat& image)
{
    const int channels = image.channels(), width = image.cols;
    if (channels == 1)
        return true;
    for (int y = 0; y < image.rows; ++y) // a few rows tell of most images with colours
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

Mat byteLevels(const Mat& image, const LevelScale& scale, Mat& buffer)
{
    const Conversion convert(scale);
    if (image.depth() == CV_16U)
    {
        buffer.create(image.size(), CV_8UC1);
        parallelForRows(image.size(), std::vector<ushort>(image.cols), [&](int y, std::vector<ushort>& levels) {
            levelsOfRow(image, y, scale.bits, convert, levels.data());
            const int width = image.cols; // local, as stores of bytes may alias all else
            const ushort* const row = levels.data();
            uchar* const bytes = buffer.ptr(y);
            HDP_VECTORIZED for (int x = 0; x < width; ++x) bytes[x] = (uchar)(row[x] / greyScale);
        });
        return buffer;
    }
    Mat colours = image;
    if (image.channels() == 4)
    {
        cvtColor(image, buffer, COLOR_BGRA2BGR);
        colours = buffer;
    }
    if (convert.doublings == 0)
        return colours;
    std::vector<ushort> levels(256);
    Mat bytes(1, 256, CV_8U);
    std::iota(bytes.ptr(), bytes.ptr() + 256, (uchar)0);
    levelsOfRow(bytes, 0, minBits, convert, levels.data());
    for (int level = 0; level < 256; ++level)
        bytes.at<uchar>(level) = (uchar)(levels[level] / greyScale);
    LUT(colours, bytes, buffer);
    return buffer;
}

void greyLevels(const Mat& image, const LevelScale& scale, Mat& grey)
{
    const Conversion convert(scale);
    grey.create(image.size(), CV_16U);
    parallelForRows(image.size(), [&](int y) { levelsOfRow(image, y, scale.bits, convert, grey.ptr<ushort>(y)); });
}

void findEnds(const Mat& left, const Mat& right, const PairMasks& masks, LevelScale& scale)
{
    LevelCounts ofImages[2], &counts = ofImages[0]; // then of both
    const Mat *const images[] = { &left, &right }, *const hasData[] = { &masks.left, &masks.right };
    const auto add = left.depth() == CV_8U ? &LevelCounts::add<uchar> : &LevelCounts::add<ushort>;
    parallelFor(2, [&](int i) { (ofImages[i].*add)(*images[i], *hasData[i], scale.bits); });
    cv::add(counts.darkest, ofImages[1].darkest, counts.darkest);
    cv::add(counts.brightest, ofImages[1].brightest, counts.brightest);
    const int black = LevelCounts::firstOf(counts.darkest) * LevelCounts::step;
    std::reverse(counts.brightest.begin(), counts.brightest.end());
    const int white = LevelScale::end - LevelCounts::firstOf(counts.brightest) * LevelCounts::step;
    if (white <= black) // no pixel counts
        return;
    const int least = LevelScale::end >> maxDoublings, contrast = white - black,
              rest = std::max(contrast / margin, (least - contrast + 1) / 2); // at each end
    scale.black = clamped(black - rest, 0, LevelScale::end - least);
    scale.white = clamped(white + rest, scale.black + least, +LevelScale::end);
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
