// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_video.hpp"
#include "systems.hpp"

namespace opencv_test { namespace {

const int disparities = 48;
const Size frameSize(320, 200);

Ptr<HDPTreeMatcher> createTemporal(int preset = HDPTreeMatcher::PRESET_FAST)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, disparities, preset);
    matcher->setUseTemporalPrediction(true);
    return matcher;
}

Ptr<HDPTreeMatcher> createSingle(int preset = HDPTreeMatcher::PRESET_FAST)
{
    return HDPTreeMatcher::create(0, disparities, preset);
}

Mat matchFrame(HDPTreeMatcher& matcher, const SyntheticFrame& frame) { return match(matcher, frame.left, frame.right); }

//! Number of pixels in the area that are wrong by at least a limit
int countWrong(const Mat& disparity, const Mat& truth, double limit, Rect area = Rect(Point(), frameSize))
{
    int count = 0;
    for (int y = area.y; y < area.br().y; ++y)
        for (int x = area.x; x < area.br().x; ++x)
            count += std::abs(disparity.at<short>(y, x) / 16. - truth.at<float>(y, x)) >= limit;
    return count;
}

//! Mean error in visible pixels; what is wrong by more counts as one pixel.
double limitedError(const Mat& disparity, const SyntheticFrame& frame)
{
    Mat error;
    disparity.convertTo(error, CV_32F, 1. / 16);
    cv::absdiff(error, frame.truth, error);
    return cv::mean(cv::min(error, 1), frame.visible)[0];
}

double meanChange(const Mat& disparity, const Mat& last)
{
    return cv::norm(disparity, last, NORM_L1) / disparity.total() / 16;
}

std::vector<Board> someBoards()
{
    const Board near = { Rect2d(40, 100, 70, 80), 30.6, 3 }, far = { Rect2d(200, 30, 80, 110), 18.45, 4 };
    return { near, far };
}

//! Frames in which a square appears, moves and vanishes, before cameras that may move as well, and the areas around it
struct SquareVideo
{
    enum
    {
        frames = 14,
        first = 3, // that have the square
        last = 10
    };
    std::vector<SyntheticFrame> rendered;
    std::vector<Rect> areas;

    SquareVideo(double noise, int speed, double disparity, const Point3d& step = Point3d())
    {
        const int side = 56, marginX = 30 + speed, marginY = 20;
        const Point centre(frameSize.width / 2, frameSize.height / 2);
        SyntheticVideo video(frameSize, 10, noise);
        for (int i = 0; i < frames; ++i)
        {
            const Board square = { Rect2d(60 + speed * i, 70, side, side), disparity, 4 };
            rendered.push_back(video.render(i, std::vector<Board>(first <= i && i <= last ? 1 : 0, square), step * i));
            const double scale = 1 / (1 - i * step.z * disparity);
            const Point corner(cvRound(scale * (square.area.x - i * step.x * disparity - centre.x)) + centre.x,
                               cvRound(scale * (square.area.y - i * step.y * disparity - centre.y)) + centre.y);
            areas.push_back(Rect(corner - Point(marginX, marginY),
                                 Size(cvRound(scale * side) + 2 * marginX, cvRound(scale * side) + 2 * marginY)) &
                            Rect(Point(), frameSize));
        }
    }
};

//! Wrong pixels around the square, in all frames from its first one on. A frame may have a share of those of single
//! frames, and a few.
struct SquareErrors
{
    int single = 0, temporal = 0;

    void add(const SquareVideo& video, int preset, double share, int few)
    {
        const Ptr<HDPTreeMatcher> one = createSingle(preset), other = createTemporal(preset);
        for (int i = 0; i < SquareVideo::frames; ++i)
        {
            const SyntheticFrame& frame = video.rendered[i];
            const int wrong = countWrong(matchFrame(*one, frame), frame.truth, 2, video.areas[i]);
            const int joined = countWrong(matchFrame(*other, frame), frame.truth, 2, video.areas[i]);
            if (i < SquareVideo::first)
                continue;
            EXPECT_LE(joined, share * wrong + few) << "frame " << i;
            single += wrong;
            temporal += joined;
        }
    }
};

const int squarePresets[] = { HDPTreeMatcher::PRESET_ULTRAFAST, HDPTreeMatcher::PRESET_FAST,
                              HDPTreeMatcher::PRESET_QUALITY };

//! The square leaves no traces: around it are no more errors than in single frames.
TEST(HDPStereo_SlowTemporalPrediction, moving_square)
{
    SquareErrors errors[3];
    const int few = 30; // of about 10000 pixels: what one frame may have more
    for (double noise : { 0., 2. })
        for (int speed : { 3, 8 })
        {
            const SquareVideo video(noise, speed, 26);
            for (int i = 0; i < 3; ++i)
            {
                SCOPED_TRACE(cv::format("preset %d, noise %.0f, %d pixels per frame", squarePresets[i], noise, speed));
                errors[i].add(video, squarePresets[i], 1.05, few);
            }
        }
    for (const SquareErrors& sum : errors)
        EXPECT_LE(sum.temporal, 1.05 * sum.single);
}

//! Before moving cameras, its borders are up to a pixel off: 40 percent more errors in sum.
TEST(HDPStereo_SlowTemporalPrediction, moving_square_and_camera)
{
    SquareErrors errors[3];
    const int few = 130; // of about 10000 pixels: what one frame may have more
    for (const Point3d& step : { Point3d(), Point3d(0.12, 0, 0), Point3d(0, 0, -0.0008) })
        for (double noise : { 0., 5. })
            for (double disparity : { 14., 26. })
            {
                const SquareVideo video(noise, 3, disparity, step);
                for (int i = 0; i < 3; ++i)
                    errors[i].add(video, squarePresets[i], 1.4, few);
            }
    for (const SquareErrors& sum : errors)
        EXPECT_LE(sum.temporal, 1.4 * sum.single);
}

//! A scene that stands still under noise hardly flickers, and has about as few errors as single frames, whose census
//! tolerates noise.
TEST(HDPStereo_SlowTemporalPrediction, noise)
{
    for (const System& preset : presets)
    {
        if (preset.preset == HDPTreeMatcher::PRESET_PAPER)
            continue; // has no census
        SCOPED_TRACE(preset.name);
        double flickerOfSingle = 0, flickerOfTemporal = 0, ofSingle = 0, ofTemporal = 0;
        for (int noise : { 5, 6, 7, 8 })
        {
            SyntheticVideo video(frameSize, 10.3, noise);
            const Ptr<HDPTreeMatcher> single = createSingle(preset.preset), temporal = createTemporal(preset.preset);
            Mat lastSingle, lastTemporal;
            for (int i = 0; i < 10; ++i)
            {
                const SyntheticFrame frame = video.render(i, someBoards());
                const Mat a = matchFrame(*single, frame), b = matchFrame(*temporal, frame);
                if (i >= 5)
                {
                    flickerOfSingle += meanChange(a, lastSingle);
                    flickerOfTemporal += meanChange(b, lastTemporal);
                    ofSingle += limitedError(a, frame);
                    ofTemporal += limitedError(b, frame);
                }
                else if (i == 0)
                    expectIdentical(a, b);
                lastSingle = a;
                lastTemporal = b;
            }
        }
        EXPECT_LE(flickerOfTemporal, 0.3 * flickerOfSingle);
        EXPECT_LE(ofTemporal, 1.05 * ofSingle);
    }
}

//! The camera moves past and towards a scene.
TEST(HDPStereo_SlowTemporalPrediction, moving_camera)
{
    const Point3d steps[] = { Point3d(0.12, 0, 0), Point3d(0.05, -0.04, 0.0006), Point3d(0, 0, -0.0008) };
    for (const Point3d& step : steps)
    {
        SCOPED_TRACE(cv::format("(%g, %g, %g)", step.x, step.y, step.z));
        SyntheticVideo video(frameSize, 10.3, 4);
        const Ptr<HDPTreeMatcher> single = createSingle(), temporal = createTemporal();
        double ofSingle = 0, ofTemporal = 0;
        for (int i = 0; i < 12; ++i)
        {
            const SyntheticFrame frame = video.render(i, someBoards(), step * i);
            const Mat a = matchFrame(*single, frame), b = matchFrame(*temporal, frame);
            if (i >= 4)
            {
                ofSingle += limitedError(a, frame);
                ofTemporal += limitedError(b, frame);
            }
        }
        EXPECT_LE(ofTemporal, 0.99 * ofSingle);
    }
}

//! Texture as faint as the noise looks the same where it was and where it is. It must not lag behind a camera that moves
//! forward; up to a quarter more errors are left.
TEST(HDPStereo_SlowTemporalPrediction, faint_texture)
{
    const Board near = { Rect2d(20, 80, 110, 90), 26, 3 }, far = { Rect2d(170, 20, 110, 120), 21, 4 };
    for (int preset : squarePresets)
    {
        double ofSingle = 0, ofTemporal = 0;
        for (double back : { 6.3, 8.8, 10.3 })
        {
            SyntheticVideo video(frameSize, back, 2.5, 0.08);
            const Ptr<HDPTreeMatcher> single = createSingle(preset), temporal = createTemporal(preset);
            for (int i = 0; i < 11; ++i)
            {
                const SyntheticFrame frame = video.render(i, { near, far }, Point3d(0, 0, 0.0015 * i));
                const Mat a = matchFrame(*single, frame), b = matchFrame(*temporal, frame);
                ofSingle += i < 5 ? 0 : limitedError(a, frame);
                ofTemporal += i < 5 ? 0 : limitedError(b, frame);
            }
        }
        EXPECT_LE(ofTemporal, 1.3 * ofSingle) << "preset " << preset;
    }
}

//! What comes into sight of the right image, as the camera pans, is measured: a guess from the last frame is none.
TEST(HDPStereo_SlowTemporalPrediction, comes_into_sight)
{
    const int speed = 5, frames = 10;
    int ofSingle = 0, ofTemporal = 0;
    for (int preset : squarePresets)
    {
        SyntheticVideo video(Size(frameSize.width + speed * frames, frameSize.height), 14.3, 4);
        const Ptr<HDPTreeMatcher> single = createSingle(preset), temporal = createTemporal(preset);
        for (int i = 0; i < frames; ++i)
        {
            SyntheticFrame frame = video.render(i, someBoards());
            const Rect view(Point(speed * (frames - i), 0), frameSize), border(15, 0, 25, frameSize.height);
            for (Mat* map : { &frame.left, &frame.right, &frame.truth })
                *map = (*map)(view).clone();
            ofSingle += countWrong(matchFrame(*single, frame), frame.truth, 1, border);
            ofTemporal += countWrong(matchFrame(*temporal, frame), frame.truth, 1, border);
        }
    }
    EXPECT_LE(ofTemporal, ofSingle);
}

//! The first frame after a cut is that of a matcher which has seen nothing else.
TEST(HDPStereo_TemporalPrediction, cut)
{
    SyntheticVideo before(frameSize, 10, 2), after(frameSize, 22, 2);
    const Ptr<HDPTreeMatcher> temporal = createTemporal();
    for (int i = 0; i < 4; ++i)
        matchFrame(*temporal, before.render(i, someBoards()));
    const SyntheticFrame frame = after.render(10, someBoards(), Point3d(40, 25, 0));
    expectIdentical(matchFrame(*createSingle(), frame), matchFrame(*temporal, frame));
}

//! What was wrong once does not stay wrong: the first frame after it is that of a matcher which has seen nothing else.
TEST(HDPStereo_TemporalPrediction, wrong_pair)
{
    SyntheticVideo video(frameSize, 10, 2), other(frameSize, 30, 2);
    const Ptr<HDPTreeMatcher> single = createSingle(), temporal = createTemporal();
    matchFrame(*temporal, video.render(0, someBoards()));
    match(*temporal, video.render(1).left, other.render(1).right); // of which nothing matches
    int ofSingle = 0, ofTemporal = 0;
    for (int i = 2; i < 12; ++i)
    {
        const SyntheticFrame frame = video.render(i, someBoards());
        const Mat expected = matchFrame(*single, frame), actual = matchFrame(*temporal, frame);
        if (i == 2)
            expectIdentical(expected, actual);
        ofSingle += countWrong(expected, frame.truth, 1);
        ofTemporal += countWrong(actual, frame.truth, 1);
    }
    EXPECT_LE(ofTemporal, 1.05 * ofSingle);
}

//! Before moving cameras, too: from the next frame on there are no more errors than in single frames.
TEST(HDPStereo_SlowTemporalPrediction, wrong_pair_and_camera)
{
    for (const Point3d& step : { Point3d(0.12, 0, 0), Point3d(0, 0, -0.0008) })
        for (int preset : squarePresets)
        {
            SCOPED_TRACE(cv::format("preset %d, (%g, %g, %g)", preset, step.x, step.y, step.z));
            SyntheticVideo video(frameSize, 10, 4), other(frameSize, 30, 4);
            const Ptr<HDPTreeMatcher> single = createSingle(preset), temporal = createTemporal(preset);
            const int wrong = 5;
            int ofSingle = 0, ofTemporal = 0;
            for (int i = 0; i < 12; ++i)
            {
                const SyntheticFrame frame = video.render(i, someBoards(), step * i);
                if (i == wrong)
                {
                    match(*temporal, frame.left, other.render(i).right);
                    continue;
                }
                const Mat expected = matchFrame(*single, frame), actual = matchFrame(*temporal, frame);
                if (i < wrong)
                    continue;
                ofSingle += countWrong(expected, frame.truth, 2);
                ofTemporal += countWrong(actual, frame.truth, 2);
            }
            EXPECT_LE(ofTemporal, 1.05 * ofSingle);
        }
}

//! A video that stands still neither drifts nor freezes.
TEST(HDPStereo_SlowTemporalPrediction, thousand_frames)
{
    const Size size(96, 64);
    const Board board = { Rect2d(45, 20, 30, 30), 22, 3 };
    SyntheticVideo still(size, 8, 0), noisy(size, 8, 3);
    const Ptr<HDPTreeMatcher> single = createSingle(), temporal = createTemporal();
    const SyntheticFrame frame = still.render(0);
    const Mat alone = matchFrame(*single, frame);
    Mat expected;
    for (int i = 0; i < 1000; ++i)
    {
        const Mat disparity = matchFrame(*temporal, frame);
        if (i == 99) // what the last frame predicts counts more than in a single one: its fractions are smoother
        {
            expected = disparity.clone();
            EXPECT_LE(cv::countNonZero(cv::abs(alone - expected) > 0.25 * 16), size.area() / 1000);
        }
        else if (i % 100 == 99)
            expectIdentical(expected, disparity);
    }

    std::vector<SyntheticFrame> frames;
    for (int i = 0; i < 20; ++i)
        frames.push_back(noisy.render(i));
    const Rect all(Point(), size);
    double early = 0, late = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const SyntheticFrame& next = frames[(i * 7 + i / 20) % 20];
        const Mat disparity = matchFrame(*temporal, next);
        double& sum = i < 500 ? early : late;
        if (i % 500 >= 400)
            sum += countWrong(disparity, next.truth, 0.5, all);
    }
    EXPECT_NEAR(late, early, 0.1 * early + 100);
    const SyntheticFrame changed = noisy.render(1, std::vector<Board>(1, board));
    EXPECT_LE(countWrong(matchFrame(*temporal, changed), changed.truth, 1, all),
              1.05 * countWrong(matchFrame(*single, changed), changed.truth, 1, all) + 10);
}

TEST(HDPStereo_TemporalPrediction, begins_anew)
{
    SyntheticVideo video(frameSize, 10.3, 4);
    const SyntheticFrame first = video.render(0, someBoards()), second = video.render(1, someBoards());
    const Mat alone = matchFrame(*createSingle(), second);
    const auto expectAnew = [&](const std::function<void(HDPTreeMatcher&)>& interrupt, bool expected) {
        const Ptr<HDPTreeMatcher> matcher = createTemporal();
        matchFrame(*matcher, first);
        interrupt(*matcher);
        EXPECT_EQ(expected, countDifferent(alone, matchFrame(*matcher, second)) == 0);
    };
    const auto computes = [&](HDPTreeMatcher& m) { matchFrame(m, first); };
    const auto nothing = [](HDPTreeMatcher&) {};
    expectAnew(nothing, false);
    expectAnew([](HDPTreeMatcher& m) { m.clear(); }, true);
    expectAnew([](HDPTreeMatcher& m) { deserialize(serialized(m), m); }, true);
    expectAnew([&](HDPTreeMatcher& m) { match(m, first.left.rowRange(0, 120), first.right.rowRange(0, 120)); }, true);
    expectAnew(
        [&](HDPTreeMatcher& m) {
        m.setUseTemporalPrediction(false);
        computes(m);
        m.setUseTemporalPrediction(true);
        },
        true);
    expectAnew(
        [&](HDPTreeMatcher& m) {
        m.setNumDisparities(disparities + 16);
        computes(m);
        m.setNumDisparities(disparities);
        },
        true);
    expectAnew(
        [&](HDPTreeMatcher& m) {
        m.setMinDisparity(1);
        computes(m);
        m.setMinDisparity(0);
        },
        true);
    expectAnew(
        [&](HDPTreeMatcher& m) {
        change(m, [&](Params& p) { p.finestLayer = 1; });
        computes(m);
        change(m, [&](Params& p) { p.finestLayer = 0; });
        },
        true);
    // What fails changes nothing.
    expectAnew([&](HDPTreeMatcher& m) { EXPECT_ANY_THROW(match(m, first.left, first.right.rowRange(0, 50))); }, false);
}

//! Layers of images of different sizes may have the same one.
TEST(HDPStereo_TemporalPrediction, begins_anew_with_another_size_of_images)
{
    SyntheticVideo video(frameSize, 10.3, 4);
    const SyntheticFrame first = video.render(0, someBoards()), second = video.render(1, someBoards());
    const auto matchPart = [](HDPTreeMatcher& m, const SyntheticFrame& frame, int lost) {
        const Range columns(0, frame.left.cols / 2 * 2 - lost);
        return match(m, frame.left.colRange(columns), frame.right.colRange(columns)).clone();
    };
    const auto createHalf = [](const Ptr<HDPTreeMatcher>& matcher) {
        change(*matcher, [](Params& p) { p.finestLayer = 1; });
        return matcher;
    };
    const Ptr<HDPTreeMatcher> matcher = createHalf(createTemporal());
    matchPart(*matcher, first, 2);
    expectIdentical(matchPart(*createHalf(createSingle()), second, 1), matchPart(*matcher, second, 1));
}

TEST(HDPStereo_TemporalPrediction, needs_the_census)
{
    const Ptr<HDPTreeMatcher> matcher = createTemporal(HDPTreeMatcher::PRESET_PAPER);
    const SyntheticFrame frame = SyntheticVideo(Size(60, 40), 5, 0).render(0);
    expectRejected([&] { matchFrame(*matcher, frame); }, "useTemporalPrediction");
    change(*matcher, [&](Params& p) { p.matchingCost = HDPTreeMatcher::COST_CENSUS; });
    EXPECT_NO_THROW(matchFrame(*matcher, frame));
}

//! Strips that cannot be halved as often as their longer side
TEST(HDPStereo_TemporalPrediction, strips)
{
    for (const Size size : { Size(700, 2), Size(700, 3), Size(2, 700), Size(3, 700) })
    {
        SyntheticVideo video(size, 6, 4);
        const Ptr<HDPTreeMatcher> matcher = createTemporal(HDPTreeMatcher::PRESET_FAST);
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(size, matchFrame(*matcher, video.render(i)).size());
    }
}

//! Any preset and any size, down to one pixel; the same for any number of threads
TEST(HDPStereo_SlowTemporalPrediction, sizes_and_threads)
{
    for (const System& preset : presets)
        for (const Size size :
             { frameSize, Size(131, 270), Size(37, 29), Size(9, 8), Size(2, 3), Size(40, 1), Size(1, 1) })
        {
            SCOPED_TRACE(preset.name + cv::format(", %d x %d", size.width, size.height));
            SyntheticVideo video(size, 6, 4);
            std::vector<Ptr<HDPTreeMatcher>> matchers;
            for (int i = 0; i < 3; ++i)
            {
                matchers.push_back(createTemporal(preset.preset));
                change(*matchers[i], [&](Params& p) { p.matchingCost = HDPTreeMatcher::COST_CENSUS; });
                matchers[i]->setMinDisparity(-5);
                matchers[i]->setBlockSize(preset.preset == HDPTreeMatcher::PRESET_TREE ? 5 : 7);
            }
            for (int i = 0; i < 5; ++i)
            {
                const SyntheticFrame frame =
                    video.render(i, someBoards(), Point3d(0.1, 0.05, 0.002) * std::max(i - 2, 0));
                Mat maps[3];
                for (int k = 0; k < 3; ++k)
                {
                    const ScopedThreads threads(2 * k + 1);
                    maps[k] = matchFrame(*matchers[k], frame);
                }
                expectIdentical(maps[0], maps[1]);
                expectIdentical(maps[0], maps[2]);
                double least, most;
                cv::minMaxLoc(maps[0], &least, &most);
                EXPECT_GE(least, -5 * 16);
                EXPECT_LE(most, (disparities - 6) * 16);
            }
        }
}

}} // namespace opencv_test
