// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"

namespace opencv_test { namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double notANumber = std::numeric_limits<double>::quiet_NaN();

void expectBadPair(const Mat& left, const Mat& right, const std::string& argument)
{
    // Not size(): a Mat of three dimensions has none.
    SCOPED_TRACE(testing::Message() << "left " << left.cols << " x " << left.rows << " type " << left.type()
                                    << ", right " << right.cols << " x " << right.rows << " type " << right.type());
    for (const System& preset : presets)
    {
        SCOPED_TRACE(preset.name);
        const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 8);
        Mat disparity;
        expectRejected([&] { matcher->compute(left, right, disparity); }, argument);
        EXPECT_TRUE(disparity.empty());

        const Mat good(12, 16, CV_8UC3, Scalar::all(7));
        EXPECT_NO_THROW(matcher->compute(good, good, disparity)) << "not usable afterwards";
    }
}

TEST(HDPStereo_BadInput, empty_images)
{
    const Mat image(12, 16, CV_8UC3, Scalar::all(7));
    expectBadPair(Mat(), Mat(), "left");
    expectBadPair(Mat(), image, "left");
    expectBadPair(image, Mat(), "right");
    expectBadPair(Mat(0, 16, CV_8UC3), Mat(0, 16, CV_8UC3), "left");
    expectBadPair(Mat(12, 0, CV_8UC1), Mat(12, 0, CV_8UC1), "left");
    Mat disparity;
    expectRejected([&] { HDPTreeMatcher::create()->compute(noArray(), image, disparity); }, "left");
    expectRejected([&] { HDPTreeMatcher::create()->compute(image, noArray(), disparity); }, "right");
    const std::vector<Mat> several(2, image);
    expectRejected([&] { HDPTreeMatcher::create()->compute(several, image, disparity); }, "left must be an image");
    expectRejected([&] { HDPTreeMatcher::create()->compute(image, several, disparity); }, "right must be an image");
}

TEST(HDPStereo_BadInput, depths_and_channels)
{
    for (int type : { CV_16UC3, CV_16UC4, CV_16SC1, CV_32FC3, CV_64FC1, CV_8SC1, CV_8UC2 })
    {
        const Mat image(12, 16, type, Scalar::all(7));
        expectBadPair(image, image, "left must be CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 or CV_32FC1");
        expectBadPair(Mat(12, 16, CV_8UC1), image, "right must have the type of left");
    }
    for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_32FC1 })
        for (int other : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_32FC1 })
            if (other != type)
                expectBadPair(Mat(12, 16, type), Mat(12, 16, other), "right must have the type of left");
    const int sizes[] = { 4, 5, 6 };
    const Mat volume(3, sizes, CV_8UC1, Scalar(0));
    expectBadPair(volume, volume, "left");
}

TEST(HDPStereo_BadInput, pairs_that_do_not_match)
{
    const Mat image(12, 16, CV_8UC3, Scalar::all(7));
    expectBadPair(image, Mat(12, 17, CV_8UC3), "right");
    expectBadPair(image, Mat(11, 16, CV_8UC3), "right");
    expectBadPair(image, Mat(16, 12, CV_8UC3), "right");
    expectBadPair(image, Mat(12, 16, CV_8UC1), "right");
}

//! What would overflow an index, here or in OpenCV's filters, is refused before anything is read or allocated: there are
//! no such pixels.
TEST(HDPStereo_BadInput, too_large_images)
{
    uchar pixel[3] = { 0 };
    const auto image = [&](int width, int height, int type) {
        return Mat(height, width, type, pixel, (size_t)width * CV_ELEM_SIZE(type));
    };
    const auto expectTooLarge = [&](int width, int height, int type, int speckleWindowSize, const char* argument) {
        SCOPED_TRACE(testing::Message() << width << " x " << height << ", type " << type);
        for (const System& preset : presets)
        {
            const Ptr<HDPTreeMatcher> matcher = createSystem(preset, 2048);
            matcher->setSpeckleWindowSize(speckleWindowSize);
            const Mat large = image(width, height, type);
            Mat disparity;
            expectRejected([&] { matcher->compute(large, large, disparity); }, argument);
            EXPECT_TRUE(disparity.empty());
        }
    };
    for (int type : { CV_8UC1, CV_8UC3 })
    {
        for (const Size& size : { Size(32768, 1), Size(1, 32768), Size(INT_MAX / 3, 1), Size(1, INT_MAX) })
            expectTooLarge(size.width, size.height, type, 0, "left");
        expectTooLarge(26000, 26000, type, 100, "speckleWindowSize");
    }
    expectTooLarge(65536, 65536, CV_8UC1, 0, "left"); // their product is 0 in an int
    expectTooLarge(32767, 32767, CV_8UC3, 0, "left");
    expectTooLarge(26755, 26755, CV_8UC3, 0, "left"); // 2^31 bytes and some
}

TEST(HDPStereo_BadInput, output_of_a_fixed_other_type)
{
    const Mat image(12, 16, CV_8UC3, Scalar::all(7));
    Mat_<double> disparity;
    expectRejected([&] { HDPTreeMatcher::create()->compute(image, image, disparity); }, "disparity");
}

//! The memory of a video is that of the pairs before.
TEST(HDPStereo_BadInput, output_that_cannot_be_written)
{
    const SyntheticPair first = makeSyntheticPair(Size(160, 100), 20, 3),
                        second = makeSyntheticPair(Size(160, 100), 20, 4);
    const Mat small(10, 12, CV_16S), volume(std::vector<int>(3, 5), CV_16S);
    std::vector<short> list;
    std::vector<Mat> several(1);
    Mat maps[2];
    for (bool fails : { false, true })
    {
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 20);
        matcher->setUseTemporalPrediction(true);
        match(*matcher, first.left, first.right);
        if (fails)
        {
            expectRejected([&] { matcher->compute(second.left, second.right, noArray()); },
                           "disparity must be an array");
            expectRejected([&] { matcher->compute(second.left, second.right, small); },
                           "disparity must have 160 x 100 pixels, not 12 x 10");
            expectRejected([&] { matcher->compute(second.left, second.right, volume); }, "disparity must have two");
            expectRejected([&] { matcher->compute(second.left, second.right, list); }, "disparity must be a Mat");
            expectRejected([&] { matcher->compute(second.left, second.right, several); }, "disparity must be a Mat");
        }
        maps[fails] = match(*matcher, first.left, first.right).clone();
    }
    expectIdentical(maps[0], maps[1]);
}

TEST(HDPStereo_BadInput, results_that_cannot_be_written)
{
    const SyntheticPair pair = makeSyntheticPair(Size(160, 100), 20, 3);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 20);
    match(*matcher, pair.left, pair.right);
    Mat_<double> doubles;
    std::vector<uchar> list;
    const auto expectNames = [&](const String& name, const std::function<void(OutputArray)>& get) {
        expectRejected([&] { get(noArray()); }, name + " must be an array, not noArray()");
        expectRejected([&] { get(doubles); }, name + " must be CV_");
        expectRejected([&] { get(list); }, name + " must be a Mat, not a vector");
    };
    expectNames("confidence", [&](OutputArray result) { matcher->getConfidence(result); });
    expectNames("sigma", [&](OutputArray result) { matcher->getDisparitySigma(result); });
    expectNames("reasons", [&](OutputArray result) { matcher->getReasons(result); });
}

//! Layers of one column or row have no hulls of intervals.
TEST(HDPStereo_BadInput, ranges_of_narrow_images)
{
    for (const Size& size : { Size(1, 4), Size(2, 23), Size(3, 40), Size(40, 1) })
    {
        const Mat image(size, CV_8U, Scalar(9));
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 16);
        matcher->setDisparityRange(Mat(1, 1, CV_32F, Scalar(3)), noArray());
        EXPECT_EQ(size, match(*matcher, image, image).size());
    }
}

//! A bad value leaves every parameter of the matcher as it was.
template <typename Setter> void expectBadValue(const Setter& set, const std::string& argument)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(-3, 40);
    change(*matcher, [&](Params& p) { p.gamma = 17; });
    matcher->setBlockSize(3);
    const std::string before = serialized(*matcher);
    expectRejected([&] { set(*matcher); }, argument);
    EXPECT_EQ(before, serialized(*matcher)) << "a bad " << argument << " changed the matcher";
}

TEST(HDPStereo_BadInput, setters)
{
    for (int bad : { -1, INT_MIN })
        expectBadValue([bad](HDPTreeMatcher& m) { m.setNumDisparities(bad); }, "numDisparities");
    for (int bad : { -1, INT_MIN })
    {
        expectBadValue([bad](HDPTreeMatcher& m) { m.setSpeckleRange(bad); }, "speckleRange");
        expectBadValue(inParams([bad](Params& p) { p.maxTopDisparities = bad; }), "maxTopDisparities");
        expectBadValue([bad](HDPTreeMatcher& m) { m.setMaxRowOffset(bad); }, "maxRowOffset");
    }
    for (int bad : { 0, -1, 17, INT_MAX, INT_MIN })
        expectBadValue(inParams([bad](Params& p) { p.numLayers = bad; }), "numLayers");
    for (int bad : { 0, -1, 5, INT_MAX, INT_MIN })
        expectBadValue(inParams([bad](Params& p) { p.scanlinePasses = bad; }), "scanlinePasses");
    for (int bad : { -1, 16, INT_MAX, INT_MIN })
        expectBadValue(inParams([bad](Params& p) { p.finestLayer = bad; }), "finestLayer");
    for (int bad : { -1, 101, INT_MAX, INT_MIN })
    {
        expectBadValue(inParams([bad](Params& p) { p.P1 = bad; }), "P1");
        expectBadValue(inParams([bad](Params& p) { p.P2 = bad; }), "P2");
    }
    for (int bad : { 1, 2, 4, 6, 8, 9, 31, -2, -3, INT_MAX, INT_MIN })
        expectBadValue(inParams([bad](Params& p) { p.disparityMedianSize = bad; }), "disparityMedianSize");
    for (int bad : { -1, 2, INT_MAX, INT_MIN })
    {
        expectBadValue(inParams([bad](Params& p) { p.matchingCost = bad; }), "matchingCost");
        expectBadValue(inParams([bad](Params& p) { p.disparityPrior = bad; }), "disparityPrior");
    }
    for (int bad : { -1, 3, INT_MAX, INT_MIN })
    {
        expectBadValue(inParams([bad](Params& p) { p.aggregation = bad; }), "aggregation");
        expectBadValue(inParams([bad](Params& p) { p.topAggregation = bad; }), "topAggregation");
    }
    for (int bad : { -1, 65, INT_MAX, INT_MIN })
        expectBadValue(inParams([bad](Params& p) { p.intervalMargin = bad; }), "intervalMargin");
    for (double bad : { -0.5, 1., 2., infinity, -infinity, notANumber })
        expectBadValue(inParams([bad](Params& p) { p.delta0 = bad; }), "delta0");
    for (double bad : { -0.5, 1.0001, 2., infinity, -infinity, notANumber })
        expectBadValue(inParams([bad](Params& p) { p.beta = bad; }), "beta");
    for (double bad : { 0., -1., infinity, -infinity, notANumber })
        expectBadValue(inParams([bad](Params& p) { p.gamma = bad; }), "gamma");
    for (double bad : { -1., infinity, -infinity, notANumber })
    {
        expectBadValue(inParams([bad](Params& p) { p.colorTruncation = bad; }), "colorTruncation");
        expectBadValue(inParams([bad](Params& p) { p.gradientTruncation = bad; }), "gradientTruncation");
    }
    for (double bad : { -0.1, 1.1, infinity, -infinity, notANumber })
        expectBadValue(inParams([bad](Params& p) { p.colorWeight = bad; }), "colorWeight");
    expectBadValue([](HDPTreeMatcher& m) { m.setTreeStrategy(Ptr<TreeStrategy>()); }, "treeStrategy");
    expectBadValue(inParams([](Params& p) { p.treeStrategy = Ptr<TreeStrategy>(); }), "treeStrategy");
    expectBadValue(inParams([](Params& p) { p.finestLayer = 1, p.P2 = 101; }), "P2 must be in 0..100, not 101");
}

TEST(HDPStereo_BadInput, create)
{
    for (int bad : { -1, INT_MIN })
        expectRejected([bad] { HDPTreeMatcher::create(0, bad); }, "numDisparities");
    for (int bad : { -1, 5, 1000, INT_MAX, INT_MIN })
    {
        expectRejected([bad] { HDPTreeMatcher::create(0, 64, bad); }, "preset");
        expectRejected([bad] { Params params(bad); }, "preset");
        expectRejected([bad] { HDPTreeMatcher::createLike(StereoSGBM::create(), bad); }, "preset");
    }
    expectRejected([] { HDPTreeMatcher::createLike(Ptr<StereoSGBM>()); }, "sgbm");
}

TEST(HDPStereo_BadInput, disparities_that_do_not_fit_into_16_bit)
{
    const Mat image(12, 16, CV_8UC1, Scalar(7));
    const int good[][2] = { { 0, 2048 }, { -2047, 4095 }, { 2047, 1 }, { -2047, 1 } };
    for (const int* range : good)
        for (const System& preset : presets)
        {
            SCOPED_TRACE(testing::Message() << range[1] << " from " << range[0] << ", " << preset.name);
            const Mat disparity = match(*createSystem(preset, range[1], range[0]), image, image);
            EXPECT_EQ(16 * range[0], disparity.at<short>(6, 8)); // a tie of all: the lowest
        }
    const int bad[][2] = { { 0, 2049 },    { 1, 2048 },     { -2048, 1 },    { 2048, 1 },
                           { 0, INT_MAX }, { INT_MAX, 16 }, { INT_MIN, 16 }, { INT_MAX, INT_MAX } };
    for (const int* range : bad)
    {
        SCOPED_TRACE(testing::Message() << range[1] << " from " << range[0]);
        for (const System& preset : presets)
            expectRejected([&] { match(*createSystem(preset, range[1], range[0]), image, image); }, "isparities");
    }
}

TEST(HDPStereo_BadInput, scanlines_without_census)
{
    const Mat image(12, 16, CV_8UC1, Scalar(7));
    const Ptr<HDPTreeMatcher> matcher = createSystem(presetFast, 8);
    change(*matcher, [&](Params& p) { p.matchingCost = HDPTreeMatcher::COST_COLOR_GRADIENT; });
    expectRejected([&] { match(*matcher, image, image); },
                   "matchingCost must be COST_CENSUS for an aggregation by scanlines");
    change(*matcher, [&](Params& p) { p.aggregation = HDPTreeMatcher::AGGREGATION_TREE_SCANLINES; });
    expectRejected([&] { match(*matcher, image, image); }, "for an aggregation by scanlines");
    change(*matcher, [&](Params& p) { p.aggregation = HDPTreeMatcher::AGGREGATION_TREES; });
    expectRejected([&] { match(*matcher, image, image); }, "fillOcclusions");
    change(*matcher, [&](Params& p) { p.fillOcclusions = false; });
    EXPECT_NO_THROW(match(*matcher, image, image));
}

TEST(HDPStereo_BadInput, model_with_too_few_layers)
{
    const Mat image(24, 32, CV_8UC3, Scalar::all(7));
    const Ptr<HDPTreeMatcher> matcher = createSystem(presetPaper, 8);
    change(*matcher, [&](Params& p) { p.predictionModel = DisparityPredictionModel::create(); });
    expectRejected([&] { match(*matcher, image, image); }, "predictionModel");
    change(*matcher, [&](Params& p) {
        p.predictionModel = DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_SMALL);
    });
    EXPECT_NO_THROW(match(*matcher, image, image));
    change(*matcher, [&](Params& p) { p.numLayers = 4; });
    expectRejected([&] { match(*matcher, image, image); }, "predictionModel");
    change(*matcher, [&](Params& p) {
        p.predictionModel = Ptr<DisparityPredictionModel>(); // of the published ones only the large has 3 layers
    });
    expectRejected([&] { match(*matcher, image, image); }, "predictionModel");
    change(*matcher, [&](Params& p) {
        p.predictionModel = DisparityPredictionModel::createPublished(DisparityPredictionModel::PUBLISHED_LARGE);
    });
    EXPECT_NO_THROW(match(*matcher, image, image));

    change(*matcher, [&](Params& p) { p.predictionModel = DisparityPredictionModel::create(); });
    EXPECT_NO_THROW(match(*matcher, image.row(0), image.row(0))) << "one layer only";
    change(*matcher, [&](Params& p) { p.usePrediction = false; });
    EXPECT_NO_THROW(match(*matcher, image, image));
}

}} // namespace opencv_test
