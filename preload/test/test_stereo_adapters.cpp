// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The adapters beside the matchers of OpenCV whose place they take, and beside HDPTreeMatcher, whose maps they return.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"

#include "stereo_adapters.hpp"

namespace opencv_test {
namespace {

Ptr<StereoSGBM> adapted(Ptr<StereoSGBM> matcher, int preset = HDPTreeMatcher::PRESET_FAST)
{
    hdpstereoAdaptSGBM(matcher, preset);
    return matcher;
}

Ptr<StereoBM> adapted(Ptr<StereoBM> matcher, int preset = HDPTreeMatcher::PRESET_FAST)
{
    hdpstereoAdaptBM(matcher, preset);
    return matcher;
}

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(203, 121), 30, 3);
    return pair;
}

Mat grey(const Mat& image)
{
    Mat result;
    cv::cvtColor(image, result, COLOR_BGR2GRAY);
    return result;
}

//! A setter and a getter
template <class Matcher> struct Parameter
{
    const char* name;
    void (Matcher::*set)(int);
    int (Matcher::*get)() const;
};

#define HDP_TESTED(Matcher, Name)                                                                                      \
    {                                                                                                                  \
#Name, &Matcher::set##Name, &Matcher::get##Name                                                                \
    }

const Parameter<cv::StereoMatcher> commonParameters[] = {
    HDP_TESTED(cv::StereoMatcher, MinDisparity),      HDP_TESTED(cv::StereoMatcher, NumDisparities),
    HDP_TESTED(cv::StereoMatcher, BlockSize),         HDP_TESTED(cv::StereoMatcher, Disp12MaxDiff),
    HDP_TESTED(cv::StereoMatcher, SpeckleWindowSize), HDP_TESTED(cv::StereoMatcher, SpeckleRange)
};
const Parameter<StereoSGBM> parametersOfSGBM[] = { HDP_TESTED(StereoSGBM, PreFilterCap),
                                                   HDP_TESTED(StereoSGBM, UniquenessRatio), HDP_TESTED(StereoSGBM, P1),
                                                   HDP_TESTED(StereoSGBM, P2), HDP_TESTED(StereoSGBM, Mode) };
const Parameter<StereoBM> parametersOfBM[] = {
    HDP_TESTED(StereoBM, PreFilterType),   HDP_TESTED(StereoBM, PreFilterSize),
    HDP_TESTED(StereoBM, PreFilterCap),    HDP_TESTED(StereoBM, TextureThreshold),
    HDP_TESTED(StereoBM, UniquenessRatio), HDP_TESTED(StereoBM, SmallerBlockSize)
};

//! Expects the same of all getters and of write(), for OpenCV's matcher and the adapter.
template <class Matcher, class Parameters>
void expectSame(const Matcher& own, const Matcher& adapter, const Parameters& parameters)
{
    for (const Parameter<cv::StereoMatcher>& parameter : commonParameters)
        EXPECT_EQ((own.*parameter.get)(), (adapter.*parameter.get)()) << parameter.name;
    for (const Parameter<Matcher>& parameter : parameters)
        EXPECT_EQ((own.*parameter.get)(), (adapter.*parameter.get)()) << parameter.name;
    EXPECT_EQ(serialized(own), serialized(adapter));
    EXPECT_EQ(own.getDefaultName(), adapter.getDefaultName());
    EXPECT_EQ(own.empty(), adapter.empty());
}

//! Sets each parameter to several values, valid ones and others, and expects both to know the same.
template <class Matcher, class Parameters>
void checkParameters(Matcher& own, Matcher& adapter, const Parameters& parameters)
{
    expectSame(own, adapter, parameters);
    for (int value : { 7, 0, -3, 1, 62, 1000000, INT_MIN, INT_MAX })
    {
        int i = 0; // no two parameters have the same value
        for (const Parameter<cv::StereoMatcher>& parameter : commonParameters)
        {
            (own.*parameter.set)(value ^ ++i);
            (adapter.*parameter.set)(value ^ i);
        }
        for (const Parameter<Matcher>& parameter : parameters)
        {
            (own.*parameter.set)(value ^ ++i);
            (adapter.*parameter.set)(value ^ i);
        }
        SCOPED_TRACE(value);
        expectSame(own, adapter, parameters);
    }
}

TEST(HDPStereo_StereoAdapters, parameters_of_sgbm)
{
    const Ptr<StereoSGBM> own = StereoSGBM::create(-3, 48, 9, 100, 500, 2, 31, 12, 70, 3, StereoSGBM::MODE_HH);
    const Ptr<StereoSGBM> adapter =
        adapted(StereoSGBM::create(-3, 48, 9, 100, 500, 2, 31, 12, 70, 3, StereoSGBM::MODE_HH));
    EXPECT_EQ(12, adapter->getUniquenessRatio());
    checkParameters(*own, *adapter, parametersOfSGBM);
    const Ptr<StereoSGBM> byDefault = StereoSGBM::create();
    expectSame(*byDefault, *adapted(StereoSGBM::create()), parametersOfSGBM);
}

TEST(HDPStereo_StereoAdapters, parameters_of_bm)
{
    const Ptr<StereoBM> own = StereoBM::create(48, 15), adapter = adapted(StereoBM::create(48, 15));
    checkParameters(*own, *adapter, parametersOfBM);
    EXPECT_TRUE(adapter->getROI1().empty() && adapter->getROI2().empty());
    adapter->setROI1(Rect(1, 2, 3, 4));
    adapter->setROI2(Rect(5, 6, 7, 8));
    EXPECT_EQ(Rect(1, 2, 3, 4), adapter->getROI1());
    EXPECT_EQ(Rect(5, 6, 7, 8), adapter->getROI2());
    const Ptr<StereoBM> byDefault = StereoBM::create();
    expectSame(*byDefault, *adapted(StereoBM::create()), parametersOfBM);
}

//! Files of OpenCV's matcher and of the adapter are the same ones.
TEST(HDPStereo_StereoAdapters, files)
{
    const Ptr<StereoSGBM> own = StereoSGBM::create(5, 80, 3, 10, 40, 1, 15, 5, 30, 2, StereoSGBM::MODE_SGBM_3WAY);
    const Ptr<StereoSGBM> adapter = adapted(StereoSGBM::create());
    deserialize(serialized(*own), *adapter);
    expectSame(*own, *adapter, parametersOfSGBM);

    const TemporaryFile ownFile(".yml"), adapterFile(".yml");
    own->save(ownFile.name);
    adapter->save(adapterFile.name);
    const auto content = [](const String& name) {
        std::ifstream file(name);
        return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    };
    EXPECT_FALSE(content(ownFile.name).empty());
    EXPECT_EQ(content(ownFile.name), content(adapterFile.name));
    const Ptr<StereoSGBM> read = adapted(StereoSGBM::create());
    {
        FileStorage fs(ownFile.name, FileStorage::READ);
        read->read(fs.getFirstTopLevelNode());
    }
    expectSame(*own, *read, parametersOfSGBM);

    EXPECT_THROW(deserialize(serialized(*StereoBM::create()), *adapter), cv::Exception); // as own->read() does
    expectSame(*own, *adapter, parametersOfSGBM);
    adapter->clear();
    expectSame(*own, *adapter, parametersOfSGBM);
}

TEST(HDPStereo_StereoAdapters, maps_are_those_of_the_preset)
{
    for (const Mat& left : { testPair().left, grey(testPair().left) })
    {
        const Mat right = left.channels() == 3 ? testPair().right : grey(testPair().right);
        for (const System& system : presets)
        {
            SCOPED_TRACE(testing::Message() << system.name << ", " << left.channels() << " channels");
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(2, 33, system.preset);
            const Mat dense = match(*matcher, left, right);
            matcher->setDisp12MaxDiff(1);
            matcher->setSpeckleWindowSize(60);
            matcher->setSpeckleRange(2);
            const Mat filtered = match(*matcher, left, right);
            ASSERT_GT(cv::countNonZero(filtered == (2 - 1) * 16), 0);

            const Ptr<StereoSGBM> adapter = adapted(StereoSGBM::create(2, 33, 5), system.preset);
            expectIdentical(dense, match(*adapter, left, right));
            adapter->setDisp12MaxDiff(1);
            adapter->setSpeckleWindowSize(60);
            adapter->setSpeckleRange(2);
            // Without effect, as the size of the block
            adapter->setP1(1);
            adapter->setP2(2000);
            adapter->setUniquenessRatio(50);
            adapter->setPreFilterCap(5);
            adapter->setMode(StereoSGBM::MODE_HH4);
            Mat map(left.size(), CV_32F); // as StereoSGBM, it makes another type of it
            adapter->compute(left, right, map);
            expectIdentical(filtered, map);
            expectIdentical(filtered, match(*HDPTreeMatcher::createLike(adapter, system.preset), left, right));
        }
    }
}

//! What StereoSGBM takes, and returns without an exception
TEST(HDPStereo_StereoAdapters, takes_what_sgbm_takes)
{
    const SyntheticPair& pair = testPair();
    const Mat left = grey(pair.left), right = grey(pair.right);
    for (int numDisparities : { 1, 16, 17, 100, 256 })
        for (int minDisparity : { -40, 0, 9 })
        {
            SCOPED_TRACE(testing::Message() << minDisparity << ", " << numDisparities);
            const Ptr<StereoSGBM> own =
                StereoSGBM::create(minDisparity, numDisparities, 0, 0, 0, INT_MIN, -1, 200, INT_MAX, INT_MIN, 77);
            const Ptr<StereoSGBM> adapter =
                adapted(StereoSGBM::create(minDisparity, numDisparities, 0, 0, 0, INT_MIN, -1, 200, 1000, INT_MIN, 77));
            if (numDisparities >= 16)
                own->setSpeckleWindowSize(0), match(*own, left, right);
            const Mat map = match(*adapter, left, right);
            EXPECT_EQ(CV_16SC1, map.type());
            EXPECT_EQ(left.size(), map.size());
        }

    UMat umat;
    adapted(StereoSGBM::create(0, 32))->compute(left.getUMat(ACCESS_READ), right.getUMat(ACCESS_READ), umat);
    expectIdentical(match(*adapted(StereoSGBM::create(0, 32)), left, right), umat.getMat(ACCESS_READ));
}

TEST(HDPStereo_StereoAdapters, rejects_what_sgbm_rejects)
{
    const Mat image = grey(testPair().left);
    const Ptr<StereoSGBM> own = StereoSGBM::create(0, 32), adapter = adapted(StereoSGBM::create(0, 32));
    const Mat others[] = { Mat(), testPair().left, image.colRange(1, image.cols).clone(), Mat(image.size(), CV_16U) };
    for (const Mat& other : others)
    {
        Mat map;
        EXPECT_THROW(own->compute(image, other, map), cv::Exception);
        Mat before = Mat::ones(2, 3, CV_16S), kept = before;
        EXPECT_THROW(adapter->compute(image, other, kept), cv::Exception);
        expectIdentical(Mat::ones(2, 3, CV_16S), kept);
    }
    adapter->setNumDisparities(0);
    expectRejected([&] { match(*adapter, image, image); }, "numDisparities");
    adapter->setNumDisparities(32);
    EXPECT_EQ(image.size(), match(*adapter, image, image).size());
}

TEST(HDPStereo_StereoAdapters, bm_has_units_of_its_own)
{
    const Mat left = grey(testPair().left), right = grey(testPair().right);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    const Ptr<StereoBM> adapter = adapted(StereoBM::create(48, 15));
    const Mat dense = match(*matcher, left, right);
    expectIdentical(dense, match(*adapter, left, right)); // disp12MaxDiff -1: no check

    matcher->setDisp12MaxDiff(1);
    const Mat checked = match(*matcher, left, right);
    for (int maxDiff : { 0, 1 })
    {
        adapter->setDisp12MaxDiff(maxDiff);
        expectIdentical(checked, match(*adapter, left, right));
    }

    matcher->setSpeckleWindowSize(60);
    adapter->setSpeckleWindowSize(60);
    for (int range : { 0, 1, 3 })
    {
        matcher->setSpeckleRange(range);
        adapter->setSpeckleRange(16 * range);
        const Mat filtered = match(*matcher, left, right);
        EXPECT_GT(countDifferent(checked, filtered), 0);
        expectIdentical(filtered, match(*adapter, left, right));
        adapter->setSpeckleRange(std::max(16 * range - 15, 0));
        expectIdentical(filtered, match(*adapter, left, right));
    }
    adapter->setSpeckleRange(-1);
    expectIdentical(checked, match(*adapter, left, right));

    Mat_<float> pixels;
    adapter->compute(left, right, pixels);
    Mat expected;
    checked.convertTo(expected, CV_32F, 1. / 16);
    expectIdentical(expected, pixels);
}

TEST(HDPStereo_StereoAdapters, regions_of_bm)
{
    const Mat left = grey(testPair().left), right = grey(testPair().right);
    const Rect roi(20, 10, 150, 90), whole(Point(), left.size());
    const Ptr<StereoBM> adapter = adapted(StereoBM::create(32, 9));
    const Mat dense = match(*adapter, left, right);
    for (int which : { 1, 2, 3 })
    {
        adapter->setROI1(which & 1 ? roi : Rect());
        adapter->setROI2(which & 2 ? roi : Rect());
        const Rect valid = cv::getValidDisparityROI(which & 1 ? roi : whole, which & 2 ? roi : whole, 0, 32, 9);
        Mat expected(left.size(), CV_16S, Scalar(-16));
        dense(valid).copyTo(expected(valid));
        expectIdentical(expected, match(*adapter, left, right));
        Mat_<float> pixels;
        adapter->compute(left, right, pixels);
        expected.convertTo(expected, CV_32F, 1. / 16);
        expectIdentical(expected, pixels);
    }
    adapter->setROI1(Rect(0, 0, 5, 5)); // nothing is valid
    EXPECT_EQ(left.size().area(), cv::countNonZero(match(*adapter, left, right) == -16));
}

TEST(HDPStereo_StereoAdapters, no_such_preset)
{
    Ptr<StereoSGBM> matcher = StereoSGBM::create();
    const Ptr<StereoSGBM> before = matcher;
    EXPECT_THROW(hdpstereoAdaptSGBM(matcher, 99), cv::Exception);
    EXPECT_EQ(before, matcher);
}

} // namespace
} // namespace opencv_test
