// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The disparity maps of the paper's nine systems and of the presets, compared with those in testdata/cv/hdpstereo,
// which are found through OPENCV_TEST_DATA_PATH=<checkout>/testdata: PAIR_SYSTEM.png, whole disparities in 8 bit or, of a
// matcher with sub-pixel ones, disparities times 16 in 16 bit. The pairs are not stored:
// "synthetic" is generated, and "aloe" is the Aloe pair of OpenCV's samples, reduced to a quarter of its width.
//
// To make the maps again, after a change that is meant to change them and with all other tests passing:
//
//   export OPENCV_SAMPLES_DATA_PATH=<OpenCV's source>/samples/data
//   export HDPSTEREO_WRITE_REFERENCE=<checkout>/testdata/cv/hdpstereo
//   opencv_test_hdpstereo --gtest_filter='HDPStereo_ReferenceOutput*'
//
// The maps are the same on every machine, for any instruction set and number of threads, so they are compared to the bit.
// Input that differs is another matter: the aloe maps are skipped where the JPEG decoder gives other pixels than
// libjpeg-turbo.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "systems.hpp"
#include "synthetic_pair.hpp"
#include "synthetic_video.hpp"

namespace opencv_test { namespace {

//! Compares a matcher's map with its reference, or writes it.
void checkReference(const std::string& name, HDPTreeMatcher& matcher, const Mat& left, const Mat& right)
{
    Mat map;
    if (matcher.getParams().useSubpixel)
        match(matcher, left, right).convertTo(map, CV_16U);
    else
        match(matcher, left, right).convertTo(map, CV_8U, 1. / StereoMatcher::DISP_SCALE);
    if (const char* folder = std::getenv("HDPSTEREO_WRITE_REFERENCE"))
    {
        const std::string path = std::string(folder) + "/" + name;
        ASSERT_TRUE(cv::imwrite(path, map)) << "cannot write " << path;
        throw SkipTestException("written: " + path);
    }
    const Mat reference = cv::imread(cvtest::findDataFile("hdpstereo/" + name), IMREAD_UNCHANGED);
    ASSERT_FALSE(reference.empty());
    expectIdentical(reference, map);
}

//! FNV-1a of the pixels of a continuous image
uint64 checksum(const Mat& image)
{
    uint64 hash = 14695981039346656037ULL;
    for (const uchar* p = image.datastart; p != image.dataend; ++p)
        hash = (hash ^ *p) * 1099511628211ULL;
    return hash;
}

//! Means of 4 x 4 pixels of a picture of OpenCV's samples, in steps that are the same in every version of OpenCV
Mat readReduced(const std::string& name, uint64 expected)
{
    const Mat reduced = oracle::halve(oracle::halve(readSample(name, IMREAD_COLOR)));
    if (checksum(reduced) != expected)
        throw SkipTestException(cv::format("the JPEG decoder gives other pixels of %s, of checksum %llu", name.c_str(),
                                           (unsigned long long)checksum(reduced)));
    return reduced;
}

typedef testing::TestWithParam<System> HDPStereo_ReferenceOutput;
typedef testing::TestWithParam<System> HDPStereo_ReferenceOutputAloe;

//! The paper's systems, and the default preset: 277 rows are two stripes of scanlines.
std::vector<System> systemsOfAloe()
{
    std::vector<System> systems(std::begin(paperSystems), std::end(paperSystems));
    systems.push_back(presetFast);
    return systems;
}

TEST_P(HDPStereo_ReferenceOutput, synthetic)
{
    const SyntheticPair pair = makeSyntheticPair(Size(160, 120), 32, 100);
    checkReference(std::string("synthetic_") + GetParam().fileName + ".png", *createSystem(GetParam(), 32), pair.left,
                   pair.right);
}

TEST_P(HDPStereo_ReferenceOutputAloe, aloe)
{
    const Mat left = readReduced("aloeL.jpg", 17099323032531505918ULL),
              right = readReduced("aloeR.jpg", 9001120562101999804ULL);
    checkReference(std::string("aloe_") + GetParam().fileName + ".png", *createSystem(GetParam(), 64), left, right);
}

struct VideoCase
{
    const char* name;
    bool isMoving;
    int numDisparities;
};

//! The last frame of a video
typedef testing::TestWithParam<VideoCase> HDPStereo_ReferenceOutputVideo;

TEST_P(HDPStereo_ReferenceOutputVideo, temporal_prediction)
{
    const VideoCase& param = GetParam();
    const Size size(160, 120);
    const Board board = { Rect2d(60, 30, 50, 60), 18, 3 };
    SyntheticVideo video(size, 8.3, 3);
    const Ptr<HDPTreeMatcher> matcher = createSystem(presetFast, param.numDisparities);
    matcher->setUseTemporalPrediction(true);
    const auto render = [&](int i) {
        return video.render(i, std::vector<Board>(1, board), Point3d(0.1, 0.05, 0.0005) * (param.isMoving ? i : 0));
    };
    for (int i = 0; i < 4; ++i)
        match(*matcher, render(i).left, render(i).right);
    const SyntheticFrame last = render(4);
    checkReference(param.name, *matcher, last.left, last.right);
}

const VideoCase videoCases[] = { { "video_still.png", false, 32 },
                                 { "video_moving.png", true, 32 },
                                 { "video_three_layers.png", true, 64 } };

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_ReferenceOutputVideo, testing::ValuesIn(videoCases));
INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_ReferenceOutput, testing::ValuesIn(allSystems()));
INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_ReferenceOutputAloe, testing::ValuesIn(systemsOfAloe()));

}} // namespace opencv_test
