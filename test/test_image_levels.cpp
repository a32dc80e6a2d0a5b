// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The types of images that a pair may have: the levels that the stages get of them, and the maps.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/pair/image_levels.hpp"

#include <numeric>

namespace opencv_test { namespace {

////////////////////////////////////////////// the stage //////////////////////////////////////////////

TEST(HDPStereo_ImageLevels, grey_levels_in_quarters)
{
    RNG rng(38);
    for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(67, 31) })
        for (int type : { CV_8UC1, CV_8UC3, CV_8UC4 })
        {
            SCOPED_TRACE(testing::Message() << size << " type " << type);
            const Mat image = randomImage(rng, Size(size.width + 5, size.height + 2), type)(Rect(Point(3, 1), size));
            Mat levels;
            hdp::greyLevels(image, hdp::LevelScale(), levels);
            ASSERT_EQ(CV_16UC1, levels.type());
            ASSERT_EQ(size, levels.size());
            // What is halfway between two quarters may go either way; one channel is exact.
            const Mat_<double> exact = oracle::exactGrey(image);
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                    ASSERT_NEAR(4 * exact(y, x), levels.at<ushort>(y, x), type == CV_8UC1 ? 0 : 0.505);
        }
    for (int value = 0; value < 256; ++value) // three equal channels are grey
    {
        Mat levels;
        hdp::greyLevels(Mat(1, 1, CV_8UC3, Scalar::all(value)), hdp::LevelScale(), levels);
        EXPECT_EQ(4 * value, levels.at<ushort>(0, 0));
    }
}

TEST(HDPStereo_ImageLevels, of_16_bits)
{
    RNG rng(50);
    for (int bits = 8; bits <= 16; ++bits)
        for (const Size& size : { Size(1, 1), Size(1, 9), Size(67, 31) })
        {
            SCOPED_TRACE(testing::Message() << bits << " bits, " << size);
            const Mat image = randomImage(rng, Size(size.width + 5, size.height + 2), CV_16UC1,
                                          std::min(3 << (bits - 1), 65536))(Rect(Point(3, 1), size));
            Mat buffer, grey;
            const Mat bytes = hdp::byteLevels(image, hdp::LevelScale(bits), buffer);
            hdp::greyLevels(image, hdp::LevelScale(bits), grey);
            ASSERT_EQ(CV_8UC1, bytes.type());
            ASSERT_EQ(CV_16UC1, grey.type());
            ASSERT_EQ(size, bytes.size());
            ASSERT_EQ(size, grey.size());
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    const double level = image.at<ushort>(y, x) * 256. / (1 << bits);
                    ASSERT_EQ(std::min(std::floor(level), 255.), bytes.at<uchar>(y, x));
                    ASSERT_EQ(std::min(std::floor(4 * level), 1023.), grey.at<ushort>(y, x));
                }
        }
}

TEST(HDPStereo_ImageLevels, of_8_bits_are_the_image_without_alpha)
{
    RNG rng(51);
    Mat buffer;
    for (int type : { CV_8UC1, CV_8UC3 })
    {
        const Mat image = randomImage(rng, Size(9, 7), type);
        EXPECT_EQ(image.data, hdp::byteLevels(image, hdp::LevelScale(), buffer).data);
    }
    const Mat image = randomImage(rng, Size(9, 7), CV_8UC4);
    Mat expected;
    cv::cvtColor(image, expected, COLOR_BGRA2BGR);
    expectIdentical(expected, hdp::byteLevels(image, hdp::LevelScale(), buffer));
}

TEST(HDPStereo_ImageLevels, without_colours)
{
    RNG rng(59);
    for (int type : { CV_8UC1, CV_16UC1, CV_32FC1, CV_8UC3, CV_8UC4 })
        for (const Size& size : { Size(1, 1), Size(19, 1), Size(5, 7), Size(70, 3) })
        {
            SCOPED_TRACE(testing::Message() << "type " << type << ", " << size);
            Mat image = randomImage(rng, size, CV_8UC1);
            if (CV_MAT_CN(type) > 1)
            {
                cvtColor(image, image, CV_MAT_CN(type) == 3 ? COLOR_GRAY2BGR : COLOR_GRAY2BGRA);
                EXPECT_TRUE(hdp::hasNoColours(image));
                const Point place(rng.uniform(0, size.width), rng.uniform(0, size.height));
                image.ptr(place.y)[place.x * CV_MAT_CN(type) + rng.uniform(0, 3)] ^= 1;
                EXPECT_FALSE(hdp::hasNoColours(image)) << place;
            }
            else
            {
                image.convertTo(image, CV_MAT_DEPTH(type));
                EXPECT_TRUE(hdp::hasNoColours(image));
            }
        }
}

TEST(HDPStereo_ImageLevels, count_of_bits)
{
    const auto bitsInUse = [](const Mat& left, const Mat& right) {
        const int bits = hdp::bitsInUse(left, right);
        EXPECT_EQ(oracle::bitsInUse(left, right), bits);
        return bits;
    };
    RNG rng(52);
    const Size size(70, 50);
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4 })
        EXPECT_EQ(8, hdp::bitsInUse(randomImage(rng, size, type), randomImage(rng, size, type)));
    for (int used = 1; used <= 16; ++used)
    {
        SCOPED_TRACE(testing::Message() << used << " bits");
        const Mat bright = randomImage(rng, size, CV_16UC1, 1 << used);
        const Mat dark = randomImage(rng, size, CV_16UC1, std::max(1 << used >> 3, 2));
        EXPECT_EQ(std::max(used, 8), bitsInUse(bright, dark));
        EXPECT_EQ(std::max(used, 8), bitsInUse(dark, bright));
        const Mat column = bright.col(3); // of 50 pixels
        EXPECT_EQ(std::max(used, 8), bitsInUse(column, column));
        for (int number : { 6, 7 }) // of white pixels, of 7000 in both images
        {
            Mat defective = dark.clone();
            for (int i = 0; i < number; ++i)
                defective.at<ushort>(500 * i) = 65535;
            EXPECT_EQ(number == 7 ? 16 : std::max(used - 3, 8), bitsInUse(dark, defective));
            EXPECT_EQ(number == 7 ? 16 : std::max(used - 3, 8), bitsInUse(defective, dark));
        }
    }
    const auto bitsInUseOf = [&](int level) {
        const Mat pixel(1, 1, CV_16UC1, Scalar(level));
        return bitsInUse(pixel, pixel);
    };
    for (int bits = 9; bits <= 16; ++bits)
    {
        EXPECT_EQ(bits - 1, bitsInUseOf((1 << (bits - 1)) - 1));
        EXPECT_EQ(bits, bitsInUseOf(1 << (bits - 1)));
    }
    EXPECT_EQ(8, bitsInUseOf(0));
    EXPECT_EQ(16, bitsInUseOf(65535));
}

//! From the documentation: a share of pixels, white ones left out, for each doubling
double expectedBrightness(const Mat& left, const Mat& right)
{
    double doublings = 0;
    for (int limit : { 512, 256 })
    {
        int lost = 0, white = 0, dark = 0;
        for (const Mat& image : { left, right })
        {
            lost += cv::countNonZero((image >= limit) & (image < 1020));
            white += cv::countNonZero(image >= 1020);
            dark += cv::countNonZero(image < limit);
        }
        lost += std::max(white - dark, 0);
        const double share = lost / (2. * left.total());
        doublings += std::min(std::max((1. / 16 - share) / (1. / 16 - 1. / 128), 0.), 1.);
    }
    return doublings <= 1 ? 1 + doublings : 2 * doublings;
}

TEST(HDPStereo_ImageLevels, brightness_of_dark_pairs)
{
    RNG rng(53);
    const Size size(64, 50);
    for (int unused = 0; unused <= 4; ++unused)
    {
        SCOPED_TRACE(testing::Message() << unused << " bits");
        const int white = 1024 >> unused; // in quarters of a level
        const Mat bright = randomImage(rng, size, CV_16UC1, white), dark = randomImage(rng, size, CV_16UC1, white / 8);
        EXPECT_EQ(1 << std::min(unused, 2), hdp::findBrightness(bright, dark));
        EXPECT_EQ(1 << std::min(unused, 2), hdp::findBrightness(dark, bright));
        for (int lamps : { 0, 50, 51, 100, 200, 300, 400, 500 }) // of 6400 pixels
            for (int level : { 260, 600, 1019, 1020, 1023 })
            {
                Mat night = dark.clone();
                for (int i = 0; i < lamps; ++i)
                    night.at<ushort>(i % size.height, 7 + i / size.height) = (ushort)level;
                const double brightness = hdp::findBrightness(night, dark);
                EXPECT_NEAR(expectedBrightness(night, dark), brightness, 1. / 64);
                EXPECT_TRUE((lamps > 50 && level < 1020) || brightness == 4);
                EXPECT_TRUE(lamps < 400 || level >= 1020 || brightness == (level < 512 ? 2 : 1));
            }
    }
}

TEST(HDPStereo_ImageLevels, bright_pairs_stay)
{
    RNG rng(55);
    for (int white = 0; white <= 100; white += 10) // percent of the pixels
    {
        SCOPED_TRACE(testing::Message() << white << " percent");
        Mat image(40, 50, CV_16UC1);
        for (int i = 0; i < (int)image.total(); ++i)
            image.at<ushort>(i / 50, i % 50) =
                (ushort)(i % 100 < white ? rng.uniform(1020, 1024) : rng.uniform(0, 255));
        const double brightness = hdp::findBrightness(image, image);
        EXPECT_NEAR(expectedBrightness(image, image), brightness, 1. / 64);
        EXPECT_EQ(white <= 50 ? 4 : 1, brightness);
    }
}

//! Levels of 0 to 1 that are doubled below a knee, and above it on a line to white
double doubledBelow(double knee, double level)
{
    if (2 * level <= knee)
        return 2 * level;
    return knee >= 1 ? 1 : 1 - (1 - level) * (1 - knee) / (1 - knee / 2);
}

//! By how much an expected level is above one that is rounded down, in the mean and at most
struct Rounding
{
    double rest, tolerance;
};

//! What random pixels become, whose exact levels are known: bytes of their channels, and grey levels in quarters
template <typename Expected>
void expectLevels(RNG& rng, int type, const hdp::LevelScale& scale, const Expected& expected, const Rounding& ofBytes,
                  const Rounding& ofGrey)
{
    SCOPED_TRACE(testing::Message() << "type " << type << ", brightness " << scale.brightness);
    const int colors = std::min(CV_MAT_CN(type), 3);
    const Mat image = randomImage(rng, Size(37, 9), type, type == CV_16UC1 ? 4096 : 256);
    Mat buffer, grey;
    const Mat bytes = hdp::byteLevels(image, scale, buffer);
    ASSERT_EQ(colors, bytes.channels());
    hdp::greyLevels(image, scale, grey);
    Mat_<double> exact;
    if (type == CV_16UC1)
        image.convertTo(exact, CV_64F, 1. / 16);
    else
        exact = oracle::exactGrey(image);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
        {
            for (int i = 0; i < colors; ++i)
            {
                const double level = type == CV_16UC1 ? exact(y, x) : image.ptr(y)[x * image.channels() + i];
                ASSERT_NEAR(expected(level), bytes.ptr(y)[x * colors + i] + ofBytes.rest, ofBytes.tolerance);
            }
            ASSERT_NEAR(4 * expected(exact(y, x)), grey.at<ushort>(y, x) + ofGrey.rest, ofGrey.tolerance);
        }
}

TEST(HDPStereo_ImageLevels, of_dark_images)
{
    RNG rng(54);
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 })
        for (double brightness : { 1., 1.015625, 1.5, 1.984375, 2., 2.25, 3.75, 4. })
        {
            const auto expected = [&](double level) { // of 256
                const double once = doubledBelow(std::min(brightness - 1, 1.), level / 256);
                return std::min(256 * doubledBelow(std::max(brightness / 2 - 1, 0.), once), 255.75);
            };
            const hdp::LevelScale scale(type == CV_16UC1 ? 12 : 8, brightness);
            expectLevels(rng, type, scale, expected, { 0.625, 0.63 }, { type == CV_16UC1 ? 1. : 0.5, 1.01 });
        }
}

//! On a line from black to white, with all bits that the images have
TEST(HDPStereo_ImageLevels, of_low_contrast)
{
    RNG rng(60);
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 })
        for (double brightness : { 1., 2.25 })
        {
            hdp::LevelScale scale(type == CV_16UC1 ? 12 : 8, brightness);
            scale.black = 90 * 256;
            scale.white = 154 * 256;
            const auto expected = [&](double level) { // of 256
                double stretched = std::min(std::max((level - 90) / 64, 0.), 1.);
                if (brightness > 1)
                    stretched = doubledBelow(brightness / 2 - 1, doubledBelow(1, stretched));
                return std::min(256 * stretched, 255.75);
            };
            expectLevels(rng, type, scale, expected, { 0.5, 0.51 }, { 0.5, 1.1 });
        }
}

//! Whatever the ends are, as a PairModel may have them
TEST(HDPStereo_ImageLevels, of_any_ends)
{
    Mat bytes(1, 256, CV_8U), grey, buffer;
    std::iota(bytes.ptr(), bytes.ptr() + 256, (uchar)0);
    for (int contrast = 1; contrast <= hdp::LevelScale::end; contrast *= 4)
        for (double brightness : { 1., 1.3, 2., 4. })
        {
            SCOPED_TRACE(testing::Message() << "contrast " << contrast << ", brightness " << brightness);
            hdp::LevelScale scale(8, brightness);
            scale.black = std::min(100 * 256, hdp::LevelScale::end - contrast);
            scale.white = scale.black + contrast;
            hdp::greyLevels(bytes, scale, grey);
            const Mat ofBytes = hdp::byteLevels(bytes, scale, buffer);
            const ushort* const levels = grey.ptr<ushort>();
            for (int i = 0; i < 256; ++i)
            {
                ASSERT_EQ(levels[i] / 4, ofBytes.ptr()[i]) << i;
                ASSERT_LE(levels[std::max(i - 1, 0)], levels[i]) << i;
                if (256 * i <= scale.black)
                {
                    ASSERT_EQ(0, levels[i]) << i;
                }
                else if (256 * i >= scale.white)
                {
                    ASSERT_EQ(hdp::whiteLevel, levels[i]) << i;
                }
            }
        }
}

//! The ends of levels that all are in first..last, of 256
hdp::LevelScale endsOf(int type, double first, double last, const hdp::PairMasks& masks = hdp::PairMasks())
{
    RNG rng(61);
    const double unit = type == CV_16UC1 ? 16 : 1; // of 12 bits
    Mat images[2];
    for (Mat& image : images)
    {
        image.create(Size(80, 60), type);
        rng.fill(image, RNG::UNIFORM, Scalar::all(first * unit), Scalar::all(last * unit + 1));
        image.row(0) = Scalar::all(first * unit);
        image.row(1) = Scalar::all(last * unit);
        if (!masks.left.empty()) // other levels, which are no data
            image.setTo(Scalar::all(255 * unit), masks.left == 0);
    }
    hdp::LevelScale scale(type == CV_16UC1 ? 12 : 8);
    hdp::findEnds(images[0], images[1], masks, scale);
    return scale;
}

TEST(HDPStereo_ImageLevels, ends_of_low_contrast)
{
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 })
    {
        SCOPED_TRACE(testing::Message() << "type " << type);
        const hdp::LevelScale full = endsOf(type, 8, 245);
        EXPECT_FALSE(full.isStretched()) << full.black << " " << full.white;

        const hdp::LevelScale hazy = endsOf(type, 90, 200); // and a sixth of 110 at each end
        EXPECT_NEAR(71.7, hazy.black / 256., 0.6);
        EXPECT_NEAR(218.3, hazy.white / 256., 0.6);
        const hdp::LevelScale dark = endsOf(type, 3, 100);
        EXPECT_EQ(0, dark.black);
        EXPECT_NEAR(116.2, dark.white / 256., 0.6);

        for (double level : { 3., 120., 253. }) // at least a quarter of all levels
        {
            const hdp::LevelScale constant = endsOf(type, level, level);
            EXPECT_EQ(64 * 256, constant.white - constant.black);
            EXPECT_LE(constant.black, level * 256);
            EXPECT_GE(constant.white, level * 256);
            EXPECT_GE(constant.black, 0);
            EXPECT_LE(constant.white, +hdp::LevelScale::end);
        }
        Mat lit(80, 60, CV_8U, Scalar(255)), times16; // white in any number of bits
        Mat unlit = lit.rowRange(5, 80);
        cvtest::randUni(theRNG(), unlit, Scalar(90), Scalar(201));
        lit.convertTo(times16, CV_16U, 16);
        hdp::LevelScale ofLit, ofTimes16(12);
        hdp::findEnds(lit, lit, hdp::PairMasks(), ofLit);
        hdp::findEnds(times16, times16, hdp::PairMasks(), ofTimes16);
        EXPECT_TRUE(ofLit.isStretched());
        EXPECT_EQ(ofLit.black, ofTimes16.black);
        EXPECT_EQ(ofLit.white, ofTimes16.white);
        for (double level : { 0., 256. - 1 / 16. }) // black and white have nothing to lose
            EXPECT_FALSE(endsOf(type, std::min(level, type == CV_16UC1 ? level : 255.), level).isStretched()) << level;
        hdp::PairMasks masks = { Mat(60, 80, CV_8U, Scalar(255)), Mat(60, 80, CV_8U, Scalar(255)) };
        masks.left.rowRange(30, 60).setTo(0);
        masks.right.rowRange(30, 60).setTo(0);
        EXPECT_EQ(hazy.black, endsOf(type, 90, 200, masks).black);
        EXPECT_EQ(hazy.white, endsOf(type, 90, 200, masks).white);
    }
    Mat few(60, 80, CV_8UC1, Scalar(100)), many = few.clone(); // of 9600 pixels, one in 1024 may be outside
    few.row(5).colRange(0, 9).setTo(1);
    many.row(5).colRange(0, 10).setTo(1);
    few.row(7).setTo(0);
    hdp::LevelScale scale;
    hdp::findEnds(few, few.clone().setTo(100), hdp::PairMasks(), scale);
    EXPECT_LT(0, scale.black);
    hdp::findEnds(many, few, hdp::PairMasks(), scale);
    EXPECT_EQ(0, scale.black);
    const hdp::LevelScale before = scale;
    const Mat nothing(60, 80, CV_8U, Scalar(0));
    hdp::findEnds(few, many, { nothing, nothing }, scale); // no data
    EXPECT_EQ(before.black, scale.black);
    EXPECT_EQ(before.white, scale.white);
    // A colour that is full is not cut off, however grey the others are.
    Mat red(60, 80, CV_8UC3, Scalar(100, 110, 120));
    red.rowRange(0, 9).setTo(Scalar(0, 0, 255));
    hdp::findEnds(red, red, hdp::PairMasks(), scale);
    EXPECT_FALSE(scale.isStretched());
}

////////////////////////////////////////////// the matcher //////////////////////////////////////////////

const int numDisparities = 16;

//! A pair in grey
SyntheticPair greyPair(int seed)
{
    SyntheticPair pair = makeSyntheticPair(Size(131, 83), numDisparities, seed);
    cv::cvtColor(pair.left, pair.left, COLOR_BGR2GRAY);
    cv::cvtColor(pair.right, pair.right, COLOR_BGR2GRAY);
    return pair;
}

Mat inWords(const Mat& image, int factor)
{
    Mat result;
    image.convertTo(result, CV_16U, factor);
    return result;
}

//! Disparities and confidence
std::vector<Mat> results(HDPTreeMatcher& matcher, InputArray left, InputArray right)
{
    std::vector<Mat> maps(2);
    matcher.compute(left, right, maps[0]);
    matcher.getConfidence(maps[1]);
    return maps;
}

void expectSameResults(HDPTreeMatcher& matcher, const std::vector<Mat>& expected, InputArray left, InputArray right)
{
    const std::vector<Mat> actual = results(matcher, left, right);
    for (size_t i = 0; i < expected.size(); ++i)
        expectIdentical(expected[i], actual[i]);
}

//! The share of pixels, in percent, that are wrong by a pixel or more
double wrong(HDPTreeMatcher& matcher, const Mat& left, const Mat& right, const Mat& truth)
{
    Mat disparity;
    match(matcher, left, right).convertTo(disparity, CV_32F, 1. / 16);
    return 100. * cv::countNonZero(cv::abs(disparity - truth) >= 1) / (double)truth.total();
}

TEST(HDPStereo_ImageTypes, alpha_is_ignored)
{
    const SyntheticPair pair = makeSyntheticPair(Size(131, 83), numDisparities, 21);
    RNG rng(53);
    Mat left, right;
    cv::merge(std::vector<Mat>{ pair.left, randomImage(rng, pair.left.size(), CV_8UC1) }, left);
    cv::merge(std::vector<Mat>{ pair.right, randomImage(rng, pair.left.size(), CV_8UC1) }, right);
    const Mat before = left.clone();
    for (const System& system : allSystems())
        for (int minDisparity : { 0, -5 })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", from " << minDisparity);
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities, minDisparity);
            expectSameResults(*matcher, results(*matcher, pair.left, pair.right), left, right);
        }
    expectIdentical(before, left);
}

TEST(HDPStereo_ImageTypes, grey_levels_as_colours)
{
    const SyntheticPair pair = greyPair(24);
    Mat left, right;
    cvtColor(pair.left, left, COLOR_GRAY2BGR);
    cvtColor(pair.right, right, COLOR_GRAY2BGR);
    for (const System& system : allSystems())
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
        expectSameResults(*matcher, results(*matcher, pair.left, pair.right), left, right);
    }
}

//! The upper 8 of a number of bits
Mat upperLevels(const Mat& image, int bits)
{
    Mat levels(image.size(), CV_8U);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            levels.at<uchar>(y, x) = (uchar)(image.at<ushort>(y, x) >> (bits - 8));
    return levels;
}

TEST(HDPStereo_SlowImageTypes, eight_bits_in_words_of_16)
{
    const SyntheticPair pair = greyPair(22);
    const Mat darkLeft = pair.left / 3, darkRight = pair.right / 3, coarseLeft = pair.left & 0xf0,
              coarseRight = pair.right & 0xf0; // whose lowest bits are 0
    const Mat pairs[][2] = {
        { pair.left, pair.right }, { darkLeft, pair.right }, { pair.left, darkRight }, { coarseLeft, coarseRight }
    };
    for (const System& system : allSystems())
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities, -3);
        for (size_t i = 0; i < 4; ++i)
        {
            const Mat &left = pairs[i][0], &right = pairs[i][1];
            ASSERT_GT(cv::countNonZero(left >= 128) + cv::countNonZero(right >= 128), (int)left.total() / 512);
            const std::vector<Mat> expected = results(*matcher, left, right);
            for (int k = 0; k <= 8; ++k)
            {
                SCOPED_TRACE(testing::Message() << system.name << ", pair " << i << ", times 2^" << k);
                expectSameResults(*matcher, expected, inWords(left, 1 << k), inWords(right, 1 << k));
            }
        }
    }
}

//! Levels from 32 to 63 are the brightest, so wider words hold up to 4 times the contrast.
TEST(HDPStereo_ImageTypes, dark_images_gain_contrast)
{
    const SyntheticPair pair = greyPair(24);
    const Mat left = pair.left / 4, right = pair.right / 4;
    ASSERT_GT(cv::countNonZero(left >= 32) + cv::countNonZero(right >= 32), (int)left.total() / 512);
    for (const System& system : allSystems())
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
        std::vector<Mat> expected;
        for (int k = 0; k <= 10; ++k)
        {
            SCOPED_TRACE(testing::Message() << system.name << ", times 2^" << k);
            if (k <= 2)
                expected = results(*matcher, left * (1 << k), right * (1 << k));
            expectSameResults(*matcher, expected, inWords(left, 1 << k), inWords(right, 1 << k));
        }
    }
}

//! With the census, a quarter of the light gives a map as good as all of it; what is found is in levels that are full.
TEST(HDPStereo_ImageTypes, dark_pairs_are_brightened)
{
    const int darkness = 4;
    const SyntheticPair pair = makeSyntheticPair(Size(320, 240), numDisparities, 25);
    const Mat left = pair.left / darkness, right = 0.8 * pair.right / darkness; // of other light
    for (const System& preset : presets)
    {
        if (preset.preset == HDPTreeMatcher::PRESET_PAPER)
            continue; // has no census
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, numDisparities);
        const double error = wrong(*matcher, left * darkness, right * darkness, pair.truth);
        const HDPTreeMatcher::Findings bright = matcher->getFindings();
        EXPECT_LE(wrong(*matcher, left, right, pair.truth), 1.1 * error + 0.3);
        const HDPTreeMatcher::Findings dark = matcher->getFindings();
        EXPECT_EQ(bright.isLightChanged, dark.isLightChanged);
        EXPECT_NEAR(1, dark.noise / bright.noise, 0.5);
        for (double level : { 0.2, 0.6 }) // 1 is white
        {
            const auto aligned = [](const std::vector<double>& m, double r) {
                return ((m[9] * r + m[8]) * r + m[0]) * r + m[7];
            };
            EXPECT_NEAR(aligned(bright.light, level), aligned(dark.light, level), 0.06);
        }
    }
}

//! Percentage of wrong pixels in a dark pair of faint texture, beside a square of highlights that takes a share of it.
//! level: of the highlights; 0: texture of 120 to 239
double errorBesideHighlights(HDPTreeMatcher& matcher, int seed, double share, int level)
{
    const int candidates = 32, margin = 8;
    const SyntheticPair pair = makeSyntheticPair(Size(320, 240), candidates, seed);
    Mat left = (pair.left * 0.08 + Scalar::all(83)) * 0.3, right = (pair.right * 0.08 + Scalar::all(83)) * 0.3, map;
    const int side = cvRound(std::sqrt(share * left.total())), most = cvRound(std::sqrt(0.05 * left.total()));
    const Point corner(120 + 10 * (seed % 5), 60 + 9 * (seed % 7)), moved(candidates / 2, 0);
    RNG rng(seed);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            left.at<Vec3b>(corner + Point(x, y)) = right.at<Vec3b>(corner + Point(x, y) - moved) =
                Vec3b::all((uchar)(level > 0 ? level : rng.uniform(120, 240)));
    match(matcher, left, right).convertTo(map, CV_32F, 1. / 16);
    Mat counts(left.size(), CV_8U, Scalar(255));
    counts(Rect(corner.x - candidates - margin, corner.y - margin, most + candidates + 2 * margin, most + 2 * margin))
        .setTo(0);
    return 100. * cv::countNonZero((cv::abs(map - pair.truth) >= 1) & counts) / cv::countNonZero(counts);
}

//! The larger highlights are, the less is brightened: no size changes much. White ones do not matter.
TEST(HDPStereo_SlowImageTypes, highlights_in_dark_pairs)
{
    const int seeds = 4;
    for (int preset : { +HDPTreeMatcher::PRESET_FAST, +HDPTreeMatcher::PRESET_QUALITY })
        for (int level : { 255, 0 })
        {
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 32, preset);
            double first = 0, before = 0;
            for (double percent : { 0., 0.5, 0.75, 0.8, 0.9, 1., 1.5, 2., 2.5, 3., 3.5, 4., 4.5, 5. })
            {
                SCOPED_TRACE(testing::Message() << "preset " << preset << ", level " << level << ", " << percent);
                double error = 0;
                for (int seed = 0; seed < seeds; ++seed)
                    error += errorBesideHighlights(*matcher, 60 + seed, percent / 100, level) / seeds;
                if (percent == 0)
                    first = before = error;
                EXPECT_LE(error, level == 255 ? 1.1 * first : 100); // white ones
                EXPECT_NEAR(before, error, 1.5);
                before = error;
            }
        }
}

//! A frame of a video is as bright as it is by itself, and still joined with the one before.
TEST(HDPStereo_ImageTypes, brightness_of_a_video)
{
    const SyntheticPair pair = makeSyntheticPair(Size(320, 240), numDisparities, 26);
    Mat grey;
    cv::cvtColor(pair.left, grey, COLOR_BGR2GRAY);
    std::vector<uchar> levels(grey.begin<uchar>(), grey.end<uchar>());
    std::sort(levels.begin(), levels.end());
    const double bright = levels[levels.size() * 127 / 128];
    for (const auto& step : { Vec2d(129, 125), Vec2d(125, 129) })
    {
        SCOPED_TRACE(testing::Message() << step);
        const Ptr<HDPTreeMatcher> video = HDPTreeMatcher::create(0, numDisparities),
                                  single = HDPTreeMatcher::create(0, numDisparities);
        video->setUseTemporalPrediction(true);
        match(*video, pair.left * (step[0] / bright), pair.right * (step[0] / bright));
        const Mat left = pair.left * (step[1] / bright), right = pair.right * (step[1] / bright);
        const Mat joined = match(*video, left, right), alone = match(*single, left, right);
        EXPECT_EQ(single->getPairModel().brightness, video->getPairModel().brightness);
        EXPECT_LT(0, countDifferent(alone, joined)) << "joined with the frame before";
        const auto countWrong = [&](const Mat& disparity) {
            Mat inPixels;
            disparity.convertTo(inPixels, CV_32F, 1. / 16);
            return countNonZero(abs(inPixels - pair.truth) > 2);
        };
        EXPECT_LE(countWrong(joined), 1.1 * countWrong(alone) + 20);
    }
}

//! The mean error of a preset on grey levels of 12 bits, which are those of colours, and on the upper 8 of the bits.
//! contrast: 1 has about all levels, less the brightest ones.
Vec2d errorsOf12And8Bits(const System& system, double contrast)
{
    const int pairs = 24;
    const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
    Vec2d errors;
    for (int i = 0; i < pairs; ++i)
    {
        const SyntheticPair pair = makeSyntheticPair(Size(131, 83), numDisparities, 23 + i);
        Mat left, right;
        oracle::exactGrey(pair.left).convertTo(left, CV_16U, 16 * contrast, 4079 * (1 - contrast));
        oracle::exactGrey(pair.right).convertTo(right, CV_16U, 16 * contrast, 4079 * (1 - contrast));
        const Mat left8 = upperLevels(left, 12), right8 = upperLevels(right, 12);
        errors += Vec2d(wrong(*matcher, left, right, pair.truth), wrong(*matcher, left8, right8, pair.truth));
        if (system.preset == HDPTreeMatcher::PRESET_PAPER) // its cost has 8 bits
            expectSameResults(*matcher, results(*matcher, left8, right8), left, right);
    }
    return errors / pairs;
}

//! The census of faint texture gains by two more bits; where the upper 8 bits tell all, they do no harm.
TEST(HDPStereo_SlowImageTypes, bits_below_the_eighth)
{
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Vec2d full = errorsOf12And8Bits(system, 1), faint = errorsOf12And8Bits(system, 0.025); // of 6 levels
        EXPECT_LE(full[0], full[1] + 0.15); // percent of the pixels
        const double limit = system.preset == HDPTreeMatcher::PRESET_PAPER       ? 1
                             : system.preset == HDPTreeMatcher::PRESET_ULTRAFAST ? 1.05 // half of the pixels are wrong
                                                                                 : 0.5;
        EXPECT_LE(faint[0], limit * faint[1]);
    }
}

//! 256 of the 4096 levels of a camera of 12 bits, without and with defective pixels
TEST(HDPStereo_ImageTypes, dark_images_of_12_bits)
{
    const SyntheticPair pair = greyPair(24);
    const Mat left = inWords(pair.left, 1), right = inWords(pair.right, 1);
    Mat defective = left.clone();
    for (int i = 0; i < 9; ++i)
        defective.at<ushort>(9 * i, 14 * i) = 4095;
    const Mat left8 = upperLevels(left, 12), right8 = upperLevels(right, 12);
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
        matcher->setNoiseThreshold(0); // texture as fine as this counts as noise
        const double error = wrong(*matcher, pair.left, pair.right, pair.truth);
        EXPECT_EQ(error, wrong(*matcher, left, right, pair.truth));
        EXPECT_LT(wrong(*matcher, defective, right, pair.truth), 1.05 * error + 0.5);
        // The bits that such cameras are said to have, 4 of them in use: stretched, but coarse
        EXPECT_LT(error, wrong(*matcher, left8, right8, pair.truth));
    }
}

//! Haze, a black level of the sensor, an exposure that fills a part of the bits: as well as full contrast
TEST(HDPStereo_ImageTypes, low_contrast)
{
    const SyntheticPair pair = greyPair(26);
    for (const System& system : presets)
    {
        if (system.preset == HDPTreeMatcher::PRESET_PAPER) // its levels are the images'
            continue;
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
        const double error = wrong(*matcher, pair.left, pair.right, pair.truth);
        for (const Vec2d& change : { Vec2d(0.3, 100), Vec2d(0.1, 30), Vec2d(0.56, 0) })
        {
            Mat left, right;
            pair.left.convertTo(left, CV_16U, 256 * change[0], 256 * change[1]);
            pair.right.convertTo(right, CV_16U, 256 * change[0], 256 * change[1]);
            EXPECT_LE(wrong(*matcher, left, right, pair.truth), 1.1 * error + 0.5) << change;
            left.convertTo(left, CV_8U, 1. / 256);
            right.convertTo(right, CV_8U, 1. / 256);
            EXPECT_LE(wrong(*matcher, left, right, pair.truth), 1.3 * error + 0.5) << change;
        }
    }
}

TEST(HDPStereo_ImageTypes, regions_and_kinds_of_arrays)
{
    const SyntheticPair pair = greyPair(25);
    const Mat left = inWords(pair.left, 11), right = inWords(pair.right, 11);
    Mat larger(left.rows + 4, left.cols + 7, CV_16UC1, Scalar(65535));
    const Mat region = larger(Rect(Point(5, 1), left.size()));
    left.copyTo(region);
    const Mat_<ushort> typed = left;
    for (const System& system : presets)
        for (int minDisparity : { 0, -9 })
        {
            SCOPED_TRACE(cv::format("%s from %d on", system.name, minDisparity));
            const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
            matcher->setMinDisparity(minDisparity);
            const std::vector<Mat> expected = results(*matcher, left, right);
            expectSameResults(*matcher, expected, region, right);
            expectSameResults(*matcher, expected, typed, right.getUMat(ACCESS_READ));
        }
    EXPECT_EQ(65535, larger.at<ushort>(0, 0));
}

TEST(HDPStereo_ImageTypes, any_number_of_threads)
{
    const SyntheticPair pair = greyPair(26);
    const int threads = cv::getNumThreads();
    for (const System& system : presets)
    {
        const Ptr<HDPTreeMatcher> matcher = createSystem(system, numDisparities);
        const Mat left = inWords(pair.left, 37), right = inWords(pair.right, 37);
        cv::setNumThreads(1);
        const std::vector<Mat> expected = results(*matcher, left, right);
        for (int n : { 2, 5 })
        {
            cv::setNumThreads(n);
            expectSameResults(*matcher, expected, left, right);
        }
        cv::setNumThreads(threads);
    }
}

}} // namespace opencv_test
