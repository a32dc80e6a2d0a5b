// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Videos of which not all is as temporal prediction expects it: no map is worse than that of a single frame.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_video.hpp"

#include <functional>

namespace opencv_test { namespace {

const Size frameSize(240, 160);
const int disparities = 48, frames = 9;

//! How the i-th frame of a variant is made
struct Variant
{
    const char* name;
    std::function<double(int i)> time; // from one recorded frame to the next is 1
    std::function<void(int i, SyntheticFrame& frame)> change;
};

void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

void nothing(int, SyntheticFrame&) {}

std::function<double(int)> speed(double factor)
{
    return [=](int i) { return factor * i; };
}

std::function<void(int, SyntheticFrame&)> exposure(const std::function<double(int i)>& gain)
{
    return [=](int i, SyntheticFrame& frame) {
        frame.left.convertTo(frame.left, -1, gain(i));
        frame.right.convertTo(frame.right, -1, gain(i));
    };
}

void moveDown(int rows, Mat& image)
{
    const Mat above = image.rowRange(0, image.rows - rows).clone();
    cv::copyMakeBorder(above, image, rows, 0, 0, 0, BORDER_REPLICATE);
}

void addNoise(int i, SyntheticFrame& frame)
{
    RNG rng((uint64)i + 5);
    for (Mat* image : { &frame.left, &frame.right })
    {
        Mat noise(image->size(), CV_16S);
        rng.fill(noise, RNG::UNIFORM, -26, 27); // of a standard deviation of 15
        cv::add(*image, noise, *image, noArray(), CV_8U);
    }
}

//! Upside down
void turnOver(SyntheticFrame& frame)
{
    for (Mat* map : { &frame.left, &frame.right, &frame.truth, &frame.visible })
        cv::flip(*map, *map, 0);
}

const int randomOrder[frames] = { 4, 1, 8, 2, 6, 0, 3, 7, 5 };

const Variant variants[] = {
    { "recorded", speed(1), nothing },
    { "every2", speed(2), nothing },
    { "every3", speed(3), nothing },
    { "every4", speed(4), nothing },
    { "reversed", speed(-1), nothing },
    { "random", [](int i) { return randomOrder[i]; }, nothing },
    { "three_times", [](int i) { return i / 3; }, nothing },
    { "exposure70", speed(1), exposure([](int i) { return i % 2 ? 0.7 : 1; }) },
    { "exposure50", speed(1), exposure([](int i) { return i % 2 ? 0.5 : 1; }) },
    { "fade", speed(1), exposure([](int i) { return std::abs(1 - 2. * i / (frames - 1)); }) },
    { "noise", speed(1), [](int i, SyntheticFrame& frame) { i % 3 == 2 ? addNoise(i, frame) : (void)0; } },
    { "foreign", speed(1), [](int i, SyntheticFrame& frame) { i % 5 == 4 ? turnOver(frame) : (void)0; } },
    { "shake", speed(1),
      [](int i, SyntheticFrame& frame) {
          for (Mat* map : { &frame.left, &frame.right, &frame.truth, &frame.visible })
              moveDown(i % 2 ? 6 : 0, *map);
      } },
    { "rows", speed(1), [](int i, SyntheticFrame& frame) { moveDown(i % 2 ? 3 : 0, frame.right); } },
};

//! Percent of the visible pixels that are wrong by more than two pixels
double errorOf(const Mat& disparity, const SyntheticFrame& frame)
{
    Mat error;
    disparity.convertTo(error, CV_32F, 1. / 16);
    cv::absdiff(error, frame.truth, error);
    return 100. * cv::countNonZero((error > 2) & frame.visible) / cv::countNonZero(frame.visible);
}

typedef testing::TestWithParam<Variant> HDPStereo_SlowVideoVariants;

//! In the mean, one percent more errors, and a few pixels; in a frame, one percent of the pixels
TEST_P(HDPStereo_SlowVideoVariants, never_worse)
{
    const std::vector<Board> boards = { { Rect2d(30, 80, 60, 60), 30.6, 3 }, { Rect2d(150, 24, 60, 90), 18.45, 4 } };
    const Point3d step(0.15, 0.02, 0.0012);
    SyntheticVideo video(frameSize, 10.3, 3);
    std::vector<SyntheticFrame> rendered;
    for (int i = 0; i < frames; ++i)
    {
        rendered.push_back(video.render(i, boards, step * GetParam().time(i)));
        GetParam().change(i, rendered.back());
    }
    for (int preset : { HDPTreeMatcher::PRESET_FAST, HDPTreeMatcher::PRESET_ULTRAFAST, HDPTreeMatcher::PRESET_QUALITY,
                        HDPTreeMatcher::PRESET_TREE })
    {
        const Ptr<HDPTreeMatcher> single = HDPTreeMatcher::create(0, disparities, preset),
                                  temporal = HDPTreeMatcher::create(0, disparities, preset);
        temporal->setUseTemporalPrediction(true);
        double ofSingle = 0, ofTemporal = 0;
        for (int i = 0; i < frames; ++i)
        {
            SCOPED_TRACE(cv::format("preset %d, frame %d", preset, i));
            const SyntheticFrame& frame = rendered[i];
            const double one = errorOf(match(*single, frame.left, frame.right), frame),
                         other = errorOf(match(*temporal, frame.left, frame.right), frame);
            EXPECT_LE(other, one + 1);
            ofSingle += one / frames;
            ofTemporal += other / frames;
        }
        const double few =
            preset == HDPTreeMatcher::PRESET_ULTRAFAST ? 0.1 : 0.05; // its pixels are four times as large
        EXPECT_LE(ofTemporal, 1.01 * ofSingle + few) << "preset " << preset;
    }
}

INSTANTIATE_TEST_CASE_P(all, HDPStereo_SlowVideoVariants, testing::ValuesIn(variants));

}} // namespace opencv_test
