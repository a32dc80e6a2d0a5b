// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "perf_precomp.hpp"

// The matcher and OpenCV's own ones on the same pairs. A short run:
//   opencv_perf_hdpstereo --gtest_param_filter='*640x480*' --perf_min_samples=1 --perf_force_samples=1
// The 24 megapixels, which take minutes and 2 GB, are left out unless asked for:
//   opencv_perf_hdpstereo --gtest_param_filter='*6000x4000*' --test_tag_enable=verylong

namespace opencv_test { namespace {

using namespace perf;
using namespace testing;

const Size sizes[] = { szVGA, sz720p, Size(1390, 1110) };
const Size allSizes[] = { szVGA, sz720p, Size(1390, 1110), Size(6000, 4000) };

//! The range to be searched grows with the image: 64, 128, 256 and 1024 for the four sizes.
int numDisparitiesFor(Size size)
{
    return size.width <= 640 ? 64 : size.width <= 1280 ? 128 : size.width <= 1390 ? 256 : 1024;
}

//! Skips the test if the size is too large for a usual round.
void applySizeTag(Size size)
{
    if (size.width > 1390)
        applyTestTag(CV_TEST_TAG_VERYLONG);
}

//! Noise at three scales. With a contrast of 1 a rough surface, with 0 a smooth one of nearly one color.
Mat makeTexture(RNG& rng, Size size, double contrast)
{
    const int red = rng.uniform(60, 190), green = rng.uniform(60, 190), blue = rng.uniform(60, 190);
    Mat texture(size, CV_32FC3, Scalar(blue, green, red));
    const int scales[] = { 1, 4, 32 };
    const double amplitudes[] = { 10 * contrast, 25 * contrast, 6 + 20 * contrast };
    for (int i = 0; i < 3; i++)
    {
        Mat noise(size.height / scales[i] + 1, size.width / scales[i] + 1, CV_32FC3);
        rng.fill(noise, RNG::NORMAL, Scalar::all(0), Scalar::all(amplitudes[i]));
        resize(noise, noise, size, 0, 0, INTER_CUBIC);
        texture += noise;
    }
    GaussianBlur(texture, texture, Size(3, 3), 0.7);
    return texture;
}

//! Draws a plane with the disparity a * x + b * y + c at pixel (x, y) of the left image into both images.
void drawPlane(const Mat& texture, const Mat& shape, double a, double b, double c, Mat& left, Mat& right)
{
    texture.copyTo(left, shape);
    const Matx23d leftToRight(1 - a, -b, -c, 0, 1, 0);
    Mat rightTexture, rightShape;
    warpAffine(texture, rightTexture, leftToRight, right.size(), INTER_LINEAR, BORDER_REFLECT);
    warpAffine(shape, rightShape, leftToRight, right.size(), INTER_NEAREST);
    rightTexture.copyTo(right, rightShape);
}

//! A slanted background, and in front of it slanted ellipses, rough and smooth in turns; with the cameras' noise.
void makePair(Size size, int numDisparities, Mat& left, Mat& right)
{
    RNG rng(20150928);
    const double range = numDisparities - 1;
    Mat left32(size, CV_32FC3), right32(size, CV_32FC3);
    // The background goes on to the right of the left image.
    const double a = 0.15 * range / size.width;
    Mat everywhere(size, CV_8UC1, Scalar(255));
    drawPlane(makeTexture(rng, size, 0.6), everywhere, a, 0, 0.1 * range, left32, right32);
    const int columns = cvCeil(0.1 * range + a * size.width);
    makeTexture(rng, Size(columns, size.height), 0.6).copyTo(right32.colRange(size.width - columns, size.width));

    const int count = 12;
    for (int i = 0; i < count; i++) // the nearest last
    {
        const double nearness = 0.3 + 0.5 * i / count;
        const int y = rng.uniform(0, size.height), x = rng.uniform(size.width / 8, size.width);
        const int tall = rng.uniform(size.height / 16, size.height / 4);
        const int wide = rng.uniform(size.width / 16, size.width / 6);
        const Point center(x, y);
        const Size axes(wide, tall);
        Mat shape = Mat::zeros(size, CV_8UC1);
        ellipse(shape, center, axes, rng.uniform(0., 180.), 0, 360, Scalar(255), FILLED);
        const double slantX = rng.uniform(-0.1, 0.1) * range / axes.width / 2;
        const double slantY = rng.uniform(-0.1, 0.1) * range / axes.height / 2;
        drawPlane(makeTexture(rng, size, i % 2 ? 0.05 : 0.8), shape, slantX, slantY,
                  nearness * range - slantX * center.x - slantY * center.y, left32, right32);
    }
    Mat noise(size, CV_32FC3);
    rng.fill(noise, RNG::NORMAL, Scalar::all(0), Scalar::all(1.5));
    Mat(left32 + noise).convertTo(left, CV_8U);
    rng.fill(noise, RNG::NORMAL, Scalar::all(0), Scalar::all(1.5));
    Mat(right32 + noise).convertTo(right, CV_8U);
}

enum
{
    MST,
    ST,
    RT
};
CV_ENUM(Tree, MST, ST, RT)

Ptr<TreeStrategy> createTree(int tree)
{
    return tree == MST ? createMinimumSpanningTree() : tree == ST ? createSegmentTree() : createRandomTree();
}

CV_ENUM(Preset, HDPTreeMatcher::PRESET_ULTRAFAST, HDPTreeMatcher::PRESET_FAST, HDPTreeMatcher::PRESET_QUALITY,
        HDPTreeMatcher::PRESET_TREE, HDPTreeMatcher::PRESET_PAPER)

typedef tuple<Size, Preset> PresetParams;
typedef TestBaseWithParam<PresetParams> Perf_HDPTreeMatcher_Preset;

PERF_TEST_P(Perf_HDPTreeMatcher_Preset, compute, Combine(ValuesIn(allSizes), Preset::all()))
{
    const Size size = get<0>(GetParam());
    const int numDisparities = numDisparitiesFor(size);
    applySizeTag(size);

    Mat left, right, disparity(size, CV_16SC1);
    makePair(size, numDisparities, left, right);
    Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, get<1>(GetParam()));

    declare.in(left, right).out(disparity);
    TEST_CYCLE() matcher->compute(left, right, disparity);

    SANITY_CHECK_NOTHING();
}

//! Each pixel may have half of the disparities, about those of its own map.
PERF_TEST_P(Perf_HDPTreeMatcher_Preset, half_of_the_disparities, Combine(ValuesIn(sizes), Preset::all()))
{
    const Size size = get<0>(GetParam());
    const int numDisparities = numDisparitiesFor(size);

    Mat left, right, disparity(size, CV_16SC1), smallest;
    makePair(size, numDisparities, left, right);
    Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, get<1>(GetParam()));
    matcher->compute(left, right, disparity);
    disparity.convertTo(smallest, CV_16S, 1. / StereoMatcher::DISP_SCALE, -numDisparities / 4);
    smallest = min(max(smallest, 0), numDisparities / 2);
    matcher->setDisparityRange(smallest, smallest + (numDisparities / 2 - 1));

    declare.in(left, right).out(disparity);
    TEST_CYCLE() matcher->compute(left, right, disparity);

    SANITY_CHECK_NOTHING();
}

typedef tuple<Size, Tree, bool> HDPTreeMatcherParams; // size, tree, prediction
typedef TestBaseWithParam<HDPTreeMatcherParams> Perf_HDPTreeMatcher;

PERF_TEST_P(Perf_HDPTreeMatcher, compute, Combine(ValuesIn(sizes), Tree::all(), Values(true, false)))
{
    const Size size = get<0>(GetParam());
    const bool usePrediction = get<2>(GetParam());
    const int numDisparities = numDisparitiesFor(size);

    Mat left, right, disparity(size, CV_16SC1);
    makePair(size, numDisparities, left, right);
    Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, HDPTreeMatcher::PRESET_PAPER);
    HDPTreeMatcher::Params params(HDPTreeMatcher::PRESET_PAPER);
    params.treeStrategy = createTree(get<1>(GetParam()));
    params.usePrediction = usePrediction;
    matcher->setParams(params);

    declare.in(left, right).out(disparity);
    if (!usePrediction) // many seconds at full size
        declare.time(60).iterations(size.width <= 640 ? 10 : 3);
    TEST_CYCLE() matcher->compute(left, right, disparity);

    SANITY_CHECK_NOTHING();
}

CV_ENUM(SGBMMode, StereoSGBM::MODE_SGBM, StereoSGBM::MODE_SGBM_3WAY)

typedef tuple<Size, SGBMMode> SGBMParams;
typedef TestBaseWithParam<SGBMParams> Perf_StereoSGBM;

PERF_TEST_P(Perf_StereoSGBM, compute, Combine(ValuesIn(allSizes), SGBMMode::all()))
{
    const Size size = get<0>(GetParam());
    const int numDisparities = numDisparitiesFor(size);
    applySizeTag(size);

    Mat left, right, disparity(size, CV_16SC1);
    makePair(size, numDisparities, left, right);
    const int blockSize = 3, P1 = 8 * 3 * blockSize * blockSize, P2 = 4 * P1;
    Ptr<StereoSGBM> matcher =
        StereoSGBM::create(0, numDisparities, blockSize, P1, P2, 0, 0, 0, 0, 0, get<1>(GetParam()));

    declare.in(left, right).out(disparity);
    TEST_CYCLE() matcher->compute(left, right, disparity);

    SANITY_CHECK_NOTHING();
}

typedef TestBaseWithParam<Size> Perf_StereoBM;

PERF_TEST_P(Perf_StereoBM, compute, ValuesIn(allSizes))
{
    const Size size = GetParam();
    const int numDisparities = numDisparitiesFor(size);
    applySizeTag(size);

    Mat left, right, disparity(size, CV_16SC1);
    makePair(size, numDisparities, left, right);
    cvtColor(left, left, COLOR_BGR2GRAY);
    cvtColor(right, right, COLOR_BGR2GRAY);
    Ptr<StereoBM> matcher = StereoBM::create(numDisparities, 15);

    declare.in(left, right).out(disparity);
    TEST_CYCLE() matcher->compute(left, right, disparity);

    SANITY_CHECK_NOTHING();
}

}} // namespace opencv_test
